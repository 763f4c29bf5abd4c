//! Writer of FCLIB problems.

use super::target::Target;
use super::{FclibError, Global, Info, Local, Problem};
use fretwork_core::solve::local::{Csr, GlobalProblem, LocalProblem};
use std::path::Path;

/// Writes a local problem: W in compressed rows, with increasing columns. Every block of two
/// contacts that has an entry is written in full, and diagonal blocks always are, as Siconos does.
///
/// # Errors
/// The file cannot be written, or a size exceeds the 32 bits of the layout.
pub fn write_local(
    path: &Path,
    problem: &LocalProblem,
    title: &str,
    description: &str,
) -> Result<(), FclibError> {
    complete(path, |file| {
        local(file, problem, &described(title, description), None)
    })
}

/// Writes a global problem: every matrix as triplets, the only storage that Siconos' reader accepts
/// there.
///
/// # Errors
/// The file cannot be written, or a size exceeds the 32 bits of the layout.
pub fn write_global(
    path: &Path,
    problem: &GlobalProblem,
    title: &str,
    description: &str,
) -> Result<(), FclibError> {
    complete(path, |file| {
        global(file, problem, &described(title, description))
    })
}

/// Writes a problem, with matrices as in [`write_local`] and [`write_global`].
///
/// # Errors
/// The file cannot be written, or a size exceeds the 32 bits of the layout.
pub fn write(path: &Path, problem: &Problem) -> Result<(), FclibError> {
    complete(path, |file| put(file, problem))
}

pub fn put(file: &Target, problem: &Problem) -> Result<(), FclibError> {
    match problem {
        Problem::Local(l) => local(file, &l.problem, &l.info, Some(l)),
        Problem::Global(Global { problem, info }) => global(file, problem, info),
    }
}

/// Writes a file and completes it. If this fails, no file is left.
pub fn complete(
    path: &Path,
    fill: impl FnOnce(&Target) -> Result<(), FclibError>,
) -> Result<(), FclibError> {
    let file = Target::create(path)?;
    match fill(&file) {
        Ok(()) => file.close(),
        Err(e) => {
            file.discard();
            Err(e)
        }
    }
}

fn described(title: &str, description: &str) -> Info {
    Info {
        title: Some(title.to_owned()),
        description: Some(description.to_owned()),
        math_info: None,
    }
}

fn local(
    file: &Target,
    problem: &LocalProblem,
    info: &Info,
    more: Option<&Local>,
) -> Result<(), FclibError> {
    let multipliers = more.and_then(|l| l.multipliers.as_ref());
    file.group("/fclib_local")?;
    file.integer("/fclib_local/spacedim", problem.dimension as i64)?;
    rows(
        file,
        "/fclib_local/W",
        &full_blocks(&problem.w, problem.dimension),
    )?;
    if let Some(m) = multipliers {
        rows(file, "/fclib_local/V", &m.v)?;
        rows(file, "/fclib_local/R", &m.r)?;
    }
    file.group("/fclib_local/vectors")?;
    file.reals("/fclib_local/vectors/q", &problem.q)?;
    file.reals("/fclib_local/vectors/mu", &problem.mu)?;
    if let Some(m) = multipliers {
        file.reals("/fclib_local/vectors/s", &m.s)?;
    }
    about(file, "/fclib_local/info", info)
}

fn global(file: &Target, problem: &GlobalProblem, info: &Info) -> Result<(), FclibError> {
    file.group("/fclib_global")?;
    file.integer("/fclib_global/spacedim", problem.dimension as i64)?;
    triplets(file, "/fclib_global/M", &problem.m)?;
    triplets(file, "/fclib_global/H", &problem.h)?;
    if let Some(e) = &problem.equalities {
        triplets(file, "/fclib_global/G", &e.g)?;
    }
    file.group("/fclib_global/vectors")?;
    file.reals("/fclib_global/vectors/f", &problem.f)?;
    file.reals("/fclib_global/vectors/w", &problem.w)?;
    file.reals("/fclib_global/vectors/mu", &problem.mu)?;
    if let Some(e) = &problem.equalities {
        file.reals("/fclib_global/vectors/b", &e.b)?;
    }
    about(file, "/fclib_global/info", info)
}

fn about(file: &Target, group: &str, info: &Info) -> Result<(), FclibError> {
    if *info == Info::default() {
        return Ok(());
    }
    file.group(group)?;
    // FCLIB's reader requires all three texts if the group exists.
    for (name, text) in [
        ("title", &info.title),
        ("description", &info.description),
        ("math_info", &info.math_info),
    ] {
        let text = text.as_deref().unwrap_or("unknown");
        file.text(&format!("{group}/{name}"), text)?;
    }
    Ok(())
}

fn sizes(file: &Target, name: &str, a: &Csr, nz: i64) -> Result<(), FclibError> {
    file.group(name)?;
    for (part, value) in [
        ("nzmax", a.values.len() as i64),
        ("m", a.rows as i64),
        ("n", a.columns as i64),
        ("nz", nz),
    ] {
        file.integer(&format!("{name}/{part}"), value)?;
    }
    Ok(())
}

fn rows(file: &Target, name: &str, a: &Csr) -> Result<(), FclibError> {
    sizes(file, name, a, -2)?;
    file.integers(&format!("{name}/p"), a.starts.iter().map(|s| *s as i64))?;
    file.integers(
        &format!("{name}/i"),
        a.indices.iter().map(|c| i64::from(*c)),
    )?;
    file.reals(&format!("{name}/x"), &a.values)
}

fn triplets(file: &Target, name: &str, a: &Csr) -> Result<(), FclibError> {
    sizes(file, name, a, a.values.len() as i64)?;
    let rows =
        (0..a.rows).flat_map(|r| std::iter::repeat_n(r as i64, a.starts[r + 1] - a.starts[r]));
    file.integers(
        &format!("{name}/p"),
        a.indices.iter().map(|c| i64::from(*c)),
    )?;
    file.integers(&format!("{name}/i"), rows)?;
    file.reals(&format!("{name}/x"), &a.values)
}

/// W with explicit zeros in blocks that have some entries.
fn full_blocks(w: &Csr, dimension: usize) -> Csr {
    let mut out = Csr {
        rows: w.rows,
        columns: w.columns,
        starts: vec![0],
        ..Csr::default()
    };
    for c in 0..w.rows / dimension {
        let lines = c * dimension..(c + 1) * dimension;
        let mut blocks: Vec<usize> = lines
            .clone()
            .flat_map(|r| w.row(r).map(|(k, _)| k / dimension))
            .chain([c])
            .collect();
        blocks.sort_unstable();
        blocks.dedup();
        for r in lines {
            let mut entries = w.row(r).peekable();
            for column in blocks
                .iter()
                .flat_map(|b| b * dimension..(b + 1) * dimension)
            {
                let value = entries.next_if(|e| e.0 == column).map_or(0.0, |e| e.1);
                out.indices.push(column as u32);
                out.values.push(value);
            }
            out.starts.push(out.indices.len());
        }
    }
    out
}
