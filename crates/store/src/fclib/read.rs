//! Reader of FCLIB problems.

use super::matrix::{StoredMatrix, order};
use super::source::Source;
use super::{FclibError, Global, Info, Local, Problem};
use fretwork_core::solve::local::{Equalities, GlobalProblem, LocalProblem, Multipliers};
use std::path::Path;

/// Reads the problem of a file: the global one if both are present, as FCLIB's own reader does.
///
/// # Errors
/// The file is missing, not HDF5, without an FCLIB problem, damaged, or its sizes, indices or
/// values are inconsistent; the message names the group or dataset.
pub fn read(path: &Path) -> Result<Problem, FclibError> {
    let source = Source::open(path)?;
    if source.has_group("/fclib_global") {
        Ok(Problem::Global(global(&source)?))
    } else if source.has_group("/fclib_local") {
        Ok(Problem::Local(local(&source)?))
    } else if source.has_group("/fclib_global_rolling") {
        Err(FclibError::Unsupported {
            path: path.to_owned(),
            place: "/fclib_global_rolling".to_owned(),
            reason:
                "problems with rolling friction are not solved here; without it, write the problem \
                     as /fclib_global, leaving out mu_r and the rows of rolling"
                    .to_owned(),
        })
    } else {
        Err(FclibError::NoProblem {
            path: path.to_owned(),
        })
    }
}

fn local(source: &Source) -> Result<Local, FclibError> {
    let at = |part: &str| format!("/fclib_local/{part}");
    let dimension = dimension(source, &at("spacedim"))?;
    let q = source.reals(&at("vectors/q"))?;
    let mu = friction(
        source,
        &at("vectors/mu"),
        dimension,
        (&at("vectors/q"), q.len()),
    )?;
    let m = q.len();
    let w = StoredMatrix::read(source, &at("W"), (m, m))?;
    let both = match (source.has_group(&at("V")), source.has_group(&at("R"))) {
        (false, false) => None,
        (true, true) => {
            let s = source.reals(&at("vectors/s"))?;
            let v = StoredMatrix::read(source, &at("V"), (m, s.len()))?;
            let r = StoredMatrix::read(source, &at("R"), (s.len(), s.len()))?;
            Some((v, r, s))
        }
        (v, _) => {
            let absent = if v { "R" } else { "V" };
            let reason = "V, R and s are given together or not at all";
            return Err(FclibError::missing(source.path(), &at(absent), reason));
        }
    };
    let mut all = vec![&w];
    if let Some((v, r, _)) = &both {
        all.extend([v, r]);
    }
    let order = order(source, &all)?;
    let multipliers = match both {
        Some((v, r, s)) if !s.is_empty() => Some(Multipliers {
            v: v.into_csr(source, order)?,
            r: r.into_csr(source, order)?,
            s,
        }),
        _ => None,
    };
    let problem = LocalProblem {
        dimension,
        w: w.into_csr(source, order)?,
        q,
        mu,
    };
    Ok(Local {
        problem,
        multipliers,
        info: info(source, "/fclib_local"),
    })
}

fn global(source: &Source) -> Result<Global, FclibError> {
    let at = |part: &str| format!("/fclib_global/{part}");
    let dimension = dimension(source, &at("spacedim"))?;
    let f = source.reals(&at("vectors/f"))?;
    let w = source.reals(&at("vectors/w"))?;
    let mu = friction(
        source,
        &at("vectors/mu"),
        dimension,
        (&at("vectors/w"), w.len()),
    )?;
    let n = f.len();
    let m = StoredMatrix::read(source, &at("M"), (n, n))?;
    let h = StoredMatrix::read(source, &at("H"), (n, w.len()))?;
    let constraints = if source.has_group(&at("G")) {
        let b = source.reals(&at("vectors/b"))?;
        Some((StoredMatrix::read(source, &at("G"), (n, b.len()))?, b))
    } else {
        None
    };
    let mut all = vec![&h, &m];
    all.extend(constraints.iter().map(|c| &c.0));
    let order = order(source, &all)?;
    let equalities = match constraints {
        Some((g, b)) if !b.is_empty() => Some(Equalities {
            g: g.into_csr(source, order)?,
            b,
        }),
        _ => None,
    };
    let problem = GlobalProblem {
        dimension,
        m: m.into_csr(source, order)?,
        h: h.into_csr(source, order)?,
        f,
        w,
        mu,
        equalities,
    };
    Ok(Global {
        problem,
        info: info(source, "/fclib_global"),
    })
}

fn dimension(source: &Source, place: &str) -> Result<usize, FclibError> {
    match source.integer(place)? {
        2 => Ok(2),
        3 => Ok(3),
        other => {
            let reason = format!("is {other}; it must be 2 or 3");
            Err(FclibError::wrong(source.path(), place, reason))
        }
    }
}

/// Reads the friction coefficients, whose number must be the length of the vector divided by
/// `dimension`.
fn friction(
    source: &Source,
    place: &str,
    dimension: usize,
    beside: (&str, usize),
) -> Result<Vec<f64>, FclibError> {
    let mu = source.reals(place)?;
    if mu.len().checked_mul(dimension) != Some(beside.1) {
        let reason = format!(
            "{} coefficients, but {} holds {} numbers: {dimension} per contact are expected",
            mu.len(),
            beside.0,
            beside.1
        );
        return Err(FclibError::wrong(source.path(), place, reason));
    }
    match mu.iter().position(|mu| *mu < 0.0) {
        None => Ok(mu),
        Some(c) => {
            let reason = format!(
                "the friction coefficient of contact {c} (counted from 0) is {}; it must be 0 or more",
                mu[c]
            );
            Err(FclibError::wrong(source.path(), place, reason))
        }
    }
}

fn info(source: &Source, group: &str) -> Info {
    let text = |name: &str| source.text(&format!("{group}/info/{name}"));
    Info {
        title: text("title"),
        description: text("description"),
        math_info: text("math_info"),
    }
}
