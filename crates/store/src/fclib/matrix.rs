//! FCLIB matrix group: sizes, a storage code, and three arrays.
//!
//! `nz` >= 0: triplets, with `nz` their number; -1: compressed columns; -2: compressed rows. In
//! triplets `p` holds columns and `i` rows, as in CSparse and in every file written by Siconos. The
//! comment in `fclib.h` states the opposite; a file that follows it is recognised if its indices
//! are valid only in that order.

use super::FclibError;
use super::source::Source;
use fretwork_core::solve::local::Csr;

/// A matrix as stored in the file.
pub struct StoredMatrix {
    name: String,
    rows: usize,
    columns: usize,
    nz: i64,
    p: Vec<i64>,
    i: Vec<i64>,
    x: Vec<f64>,
}

/// Meaning of the two index arrays of triplets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// p columns, i rows, as in CSparse.
    Columns,
    /// p rows, i columns, as in the comment of the header.
    Rows,
}

impl StoredMatrix {
    /// Reads the arrays; the sizes must match those of the problem's vectors.
    ///
    /// # Errors
    /// A dataset is missing, damaged, or not of the expected size.
    pub fn read(source: &Source, name: &str, expected: (usize, usize)) -> Result<Self, FclibError> {
        if !source.has_group(name) {
            let reason = "the layout requires this matrix";
            return Err(FclibError::missing(source.path(), name, reason));
        }
        let (rows, columns) = expected;
        let wrong = |(part, reason): (&str, String)| {
            FclibError::wrong(source.path(), &format!("{name}/{part}"), reason)
        };
        let (nz, nzmax) = read_sizes(source, name, expected)?;
        // Some writers omit the arrays if the matrix has no entries.
        let empty = nz == 0 || (nz < 0 && nzmax == 0);
        let arrays = ["p", "i", "x"].map(|part| format!("{name}/{part}"));
        let present = |k: usize| !empty || source.has(&arrays[k]);
        let integers = |k: usize| match present(k) {
            true => source.integers(&arrays[k]),
            false => Ok(Vec::new()),
        };
        let (mut p, mut i) = (integers(0)?, integers(1)?);
        let mut x = match present(2) {
            true => source.reals(&arrays[2])?,
            false => Vec::new(),
        };
        let lines = match nz {
            -1 => columns,
            _ => rows,
        };
        if nz < 0 && empty && p.is_empty() {
            p = vec![0; lines + 1];
        }
        let count = entries(nz, &mut p, lines).map_err(|reason| wrong(("p", reason)))?;
        for (part, have) in [("i", i.len()), ("x", x.len())] {
            if have < count {
                let reason = format!("{have} entries, but {count} are expected");
                return Err(wrong((part, reason)));
            }
        }
        i.truncate(count);
        x.truncate(count);
        Ok(Self {
            name: name.to_owned(),
            rows,
            columns,
            nz,
            p,
            i,
            x,
        })
    }

    /// Returns the order of the triplets if their indices are valid in one order only.
    ///
    /// # Errors
    /// The indices are valid in neither order: one of them is outside the matrix.
    pub fn order(&self, source: &Source) -> Result<Option<Order>, FclibError> {
        if self.nz < 0 {
            return Ok(None);
        }
        let fits = |indices: &[i64], size: usize| {
            indices
                .iter()
                .all(|k| usize::try_from(*k).is_ok_and(|k| k < size))
        };
        let columns = fits(&self.p, self.columns) && fits(&self.i, self.rows);
        let rows = fits(&self.p, self.rows) && fits(&self.i, self.columns);
        match (columns, rows) {
            (true, true) => Ok(None),
            (true, false) => Ok(Some(Order::Columns)),
            (false, true) => Ok(Some(Order::Rows)),
            (false, false) => Err(self.outside(source, Order::Columns)),
        }
    }

    /// Converts to compressed rows; repeated entries are added.
    ///
    /// # Errors
    /// An index is outside the matrix, or a sum exceeds the range of a double.
    pub fn into_csr(self, source: &Source, order: Order) -> Result<Csr, FclibError> {
        let (lines, ends) = if self.nz < 0 {
            (&[][..], &self.p[..])
        } else {
            (&self.p[..], &[][..])
        };
        let mut line = 0;
        let mut entries = Vec::with_capacity(self.x.len());
        for (k, x) in self.x.iter().enumerate() {
            let pair = match self.nz {
                -1 | -2 => {
                    while ends[line + 1] as usize <= k {
                        line += 1;
                    }
                    if self.nz == -1 {
                        (self.i[k], line as i64)
                    } else {
                        (line as i64, self.i[k])
                    }
                }
                _ if order == Order::Columns => (self.i[k], lines[k]),
                _ => (lines[k], self.i[k]),
            };
            match (usize::try_from(pair.0), usize::try_from(pair.1)) {
                (Ok(r), Ok(c)) if r < self.rows && c < self.columns => {
                    entries.push((r as u32, c as u32, *x));
                }
                _ => return Err(self.outside(source, order)),
            }
        }
        let csr = Csr::from_triplets(self.rows, self.columns, &entries);
        if csr.values.iter().all(|x| x.is_finite()) {
            return Ok(csr);
        }
        let reason = "repeated entries add up beyond the range of a double";
        Err(FclibError::wrong(
            source.path(),
            &format!("{}/x", self.name),
            reason,
        ))
    }

    fn outside(&self, source: &Source, order: Order) -> FclibError {
        let out = |indices: &[i64], size: usize| {
            let wrong = |k: &&i64| usize::try_from(**k).map_or(true, |k| k >= size);
            indices.iter().find(wrong).map(|k| (*k, size))
        };
        let (of_p, of_i) = match (self.nz, order) {
            (-1, _) => (usize::MAX, self.rows),
            (-2, _) => (usize::MAX, self.columns),
            (_, Order::Columns) => (self.columns, self.rows),
            (_, Order::Rows) => (self.rows, self.columns),
        };
        let at = |part: &str| format!("{}/{part}", self.name);
        let (place, (index, size)) = match (out(&self.p, of_p), out(&self.i, of_i)) {
            (Some(found), _) => (at("p"), found),
            (_, Some(found)) => (at("i"), found),
            _ => (at("i"), (-1, 0)),
        };
        let reason = format!(
            "index {index} is outside the matrix of {} rows and {} columns: it must be 0 or more and below {size}",
            self.rows, self.columns
        );
        FclibError::wrong(source.path(), &place, reason)
    }
}

/// Checks the number of rows and columns, and reads the storage code and the capacity for entries.
fn read_sizes(
    source: &Source,
    name: &str,
    (rows, columns): (usize, usize),
) -> Result<(i64, i64), FclibError> {
    let at = |part: &str| format!("{name}/{part}");
    let wrong =
        |part: &str, reason: String| Err(FclibError::wrong(source.path(), &at(part), reason));
    for (part, what, size) in [("m", "rows", rows), ("n", "columns", columns)] {
        let found = source.integer(&at(part))?;
        if usize::try_from(found) != Ok(size) {
            let reason = format!("{found} {what}, but the vectors make it {size}");
            return wrong(part, reason);
        }
    }
    let nz = source.integer(&at("nz"))?;
    if nz < -2 {
        let reason = format!(
            "is {nz}; it must be -1 (compressed columns), -2 (compressed rows), or the number of triplets"
        );
        return wrong("nz", reason);
    }
    let nzmax = source.integer(&at("nzmax"))?;
    if nzmax < nz.max(0) {
        let reason = format!("is {nzmax}; it must be the number of entries or more");
        return wrong("nzmax", reason);
    }
    Ok((nz, nzmax))
}

/// Number of entries, from the storage code and the array `p`: the indices of triplets, which are
/// cut to their number, or the pointers of compressed lines.
fn entries(nz: i64, p: &mut Vec<i64>, lines: usize) -> Result<usize, String> {
    if nz >= 0 {
        if p.len() < nz as usize {
            return Err(format!("{} column indices for {nz} triplets", p.len()));
        }
        p.truncate(nz as usize);
        return Ok(nz as usize);
    }
    if p.len() != lines + 1 {
        let count = p.len();
        return Err(format!("{count} pointers, but {} are expected", lines + 1));
    }
    if p[0] != 0 || p.windows(2).any(|w| w[1] < w[0]) {
        return Err("the pointers must begin with 0 and never decrease".to_owned());
    }
    Ok(p[lines] as usize)
}

/// Determines the order of the triplets of a whole file, since a writer uses one order.
///
/// # Errors
/// An index is outside its matrix in either order, or two matrices require different orders.
pub fn order(source: &Source, matrices: &[&StoredMatrix]) -> Result<Order, FclibError> {
    let mut known: Option<(Order, &str)> = None;
    for matrix in matrices {
        match (matrix.order(source)?, known) {
            (Some(order), None) => known = Some((order, &matrix.name)),
            (Some(order), Some((other, name))) if order != other => {
                let reason = format!(
                    "its indices fit only with rows and columns the other way round than in {name}"
                );
                return Err(FclibError::wrong(source.path(), &matrix.name, reason));
            }
            _ => {}
        }
    }
    Ok(known.map_or(Order::Columns, |k| k.0))
}
