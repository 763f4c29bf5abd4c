//! A sparse matrix by rows.

/// Compressed sparse rows: the columns of a row increase and are unique.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Csr {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Start of each row; `rows + 1` values.
    pub starts: Vec<usize>,
    /// Column of each entry.
    pub indices: Vec<u32>,
    /// Value of each entry.
    pub values: Vec<f64>,
}

impl Csr {
    /// Builds a matrix from (row, column, value) in any order; duplicate entries are added.
    ///
    /// # Panics
    /// Panics if an index is outside the matrix.
    pub fn from_triplets(rows: usize, columns: usize, triplets: &[(u32, u32, f64)]) -> Self {
        let mut starts = vec![0usize; rows + 1];
        for (r, c, _) in triplets {
            assert!((*r as usize) < rows && (*c as usize) < columns);
            starts[*r as usize + 1] += 1;
        }
        for r in 0..rows {
            starts[r + 1] += starts[r];
        }
        let mut entries = vec![(0u32, 0.0f64); triplets.len()];
        let mut next = starts.clone();
        for (r, c, x) in triplets {
            let slot = &mut next[*r as usize];
            entries[*slot] = (*c, *x);
            *slot += 1;
        }
        let mut out = Self {
            rows,
            columns,
            starts: Vec::with_capacity(rows + 1),
            indices: Vec::with_capacity(entries.len()),
            values: Vec::with_capacity(entries.len()),
        };
        out.starts.push(0);
        for r in 0..rows {
            let row = &mut entries[starts[r]..starts[r + 1]];
            row.sort_by_key(|e| e.0);
            let first = out.indices.len();
            for (c, x) in row {
                let again = out.indices.len() > first && out.indices.last() == Some(c);
                match out.values.last_mut().filter(|_| again) {
                    Some(sum) => *sum += *x,
                    None => {
                        out.indices.push(*c);
                        out.values.push(*x);
                    }
                }
            }
            out.starts.push(out.indices.len());
        }
        out
    }

    /// Iterates over (column, value) of a row.
    pub fn row(&self, r: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.starts[r]..self.starts[r + 1];
        let columns = self.indices[range.clone()].iter().map(|c| *c as usize);
        columns.zip(self.values[range].iter().copied())
    }

    /// Computes y = A x.
    pub fn apply(&self, x: &[f64], y: &mut [f64]) {
        for (r, y) in y.iter_mut().enumerate() {
            *y = self.row(r).map(|(c, a)| a * x[c]).sum();
        }
    }

    /// Returns the transpose.
    #[must_use]
    pub fn transpose(&self) -> Self {
        let entries: Vec<(u32, u32, f64)> = (0..self.rows)
            .flat_map(|r| self.row(r).map(move |(c, x)| (c as u32, r as u32, x)))
            .collect();
        Self::from_triplets(self.columns, self.rows, &entries)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adds_what_stands_twice_and_sorts() {
        let a = Csr::from_triplets(2, 3, &[(1, 2, 1.0), (0, 1, 2.0), (1, 0, 3.0), (1, 2, 4.0)]);
        assert_eq!(a.row(0).collect::<Vec<_>>(), [(1, 2.0)]);
        assert_eq!(a.row(1).collect::<Vec<_>>(), [(0, 3.0), (2, 5.0)]);
        assert_eq!(a.transpose().transpose(), a);
        let mut y = [0.0; 2];
        a.apply(&[1.0, 1.0, 2.0], &mut y);
        assert_eq!(y, [2.0, 13.0]);
    }
}
