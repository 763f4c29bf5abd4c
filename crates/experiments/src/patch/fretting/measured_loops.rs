//! Measured loops of force against displacement, beside those of the strokes.

use crate::patch::PatchFile;
use crate::patch::columns::column;
use crate::patch::text::add_line;
use fretwork_observe::quantity::{number, quantity};
use fretwork_scene::measured::MeasuredTable;
use fretwork_scene::source::InputError;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The file of a measured loop.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoopSpec {
    /// A CSV file with headings that have units, relative to the file of the patch.
    pub file: PathBuf,
    /// What it is; the name of the file by default.
    #[serde(default)]
    pub name: Option<String>,
    /// Heading of the displacement.
    #[serde(default = "displacement")]
    pub displacement: String,
    /// Heading of the force.
    #[serde(default = "force")]
    pub force: String,
}

fn displacement() -> String {
    "delta".into()
}

fn force() -> String {
    "Q".into()
}

/// A measured loop.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredLoop {
    /// What it is.
    pub name: String,
    /// Displacement (m) and force (N) in the order of the file.
    pub points: Vec<[f64; 2]>,
    /// Cycles in the file.
    pub cycles: usize,
    /// Half of the range of the displacement (m).
    pub displacement: f64,
    /// Half of the range of the force (N).
    pub force: f64,
    /// Energy of the last cycle, the area of its loop (J).
    pub energy: f64,
    /// A, the energy over 4 Q delta.
    pub energy_ratio: f64,
}

/// Reads the measured loops of a file.
///
/// # Errors
/// A file or a column is missing, a heading has no unit, or the points are no loop.
pub fn read(file: &PatchFile) -> Result<Vec<MeasuredLoop>, InputError> {
    let specs = file.spec.loops.iter().enumerate();
    specs.map(|(k, spec)| read_one(file, k, spec)).collect()
}

fn read_one(file: &PatchFile, k: usize, spec: &LoopSpec) -> Result<MeasuredLoop, InputError> {
    let at = format!("loops.{k}.file");
    let table = MeasuredTable::read(&file.beside(&spec.file));
    let table = table.map_err(|e| file.source.named_at(&at, e))?;
    let of = |name: &str, unit: &str| column(&file.source, &at, &table, (name, unit));
    let pairs = of(&spec.displacement, "m")?.into_iter();
    let points: Vec<[f64; 2]> = pairs
        .zip(of(&spec.force, "N")?)
        .map(|(d, q)| [d, q])
        .collect();
    let stem = || spec.file.file_stem().unwrap_or_default().to_string_lossy();
    let name = spec.name.clone().unwrap_or_else(|| stem().into_owned());
    MeasuredLoop::of(name, points).ok_or_else(|| {
        let why =
            "these points are no loop: displacement and force go to and fro in at least three";
        file.source.error_at(&at, why)
    })
}

impl MeasuredLoop {
    /// A loop through these points; `None` if they do not go to and fro.
    fn of(name: String, points: Vec<[f64; 2]>) -> Option<Self> {
        let half = |axis: usize| {
            let values = || points.iter().map(|p| p[axis]);
            let (least, most) = (values().reduce(f64::min)?, values().reduce(f64::max)?);
            (most > least).then_some((0.5 * (least + most), 0.5 * (most - least)))
        };
        let ((middle, displacement), (_, force)) = (half(0)?, half(1)?);
        if points.len() < 3 {
            return None;
        }
        let rises =
            |k: &usize| points[*k][0] <= middle && points[(k + 1) % points.len()][0] > middle;
        let rises: Vec<usize> = (0..points.len()).filter(rises).collect();
        // A record begins with the first loading, so that the last cycle is taken; a file with one
        // cycle is closed from its last point to its first.
        let last = match rises.as_slice() {
            [.., from, to] => &points[from + 1..=*to],
            _ => &points[..],
        };
        let pairs = last.iter().zip(last.iter().cycle().skip(1));
        let area: f64 = pairs
            .map(|(a, b)| 0.5 * (a[1] + b[1]) * (b[0] - a[0]))
            .sum();
        let (energy, cycles) = (area.abs(), rises.len().max(1));
        Some(Self {
            name,
            points,
            cycles,
            displacement,
            force,
            energy,
            energy_ratio: energy / (4.0 * force * displacement),
        })
    }

    /// Returns its lines of the answer.
    pub fn text(&self) -> String {
        let mut out = format!("measured: {}", self.name);
        let cycles = match self.cycles {
            1 => String::new(),
            n => format!(", the last of {n}"),
        };
        add_line(&mut out, "amplitude", &quantity(self.displacement, "m"));
        add_line(&mut out, "force", &quantity(self.force, "N"));
        let energy = format!("{}{cycles}", quantity(self.energy, "J"));
        add_line(&mut out, "energy of a cycle", &energy);
        let ratio = format!("A = E/(4 Q delta) {}", number(self.energy_ratio, 3));
        add_line(&mut out, "loop", &ratio);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of gross slip under Coulomb's law has E = 4 Q delta, a parallelogram of a
    /// stiffness k has E = 4 Q (delta - Q/k).
    #[test]
    fn energy_is_the_area_of_a_cycle() {
        let (delta, q, lag) = (20e-6, 100.0, 5e-6);
        let cycle = [
            [-delta + 2.0 * lag, q],
            [delta, q],
            [delta - 2.0 * lag, -q],
            [-delta, -q],
        ];
        for count in [1, 3] {
            // The first loading, where there are several.
            let mut points = vec![[0.0, 0.0]; usize::from(count > 1)];
            points.extend(cycle.repeat(count));
            let found = MeasuredLoop::of("rig".into(), points).unwrap();
            let energy = 4.0 * q * (delta - lag);
            assert!((found.energy / energy - 1.0).abs() < 1e-12, "{found:?}");
            assert_eq!((found.cycles, found.force), (count, q));
            assert!((found.energy_ratio - 0.75).abs() < 1e-12);
        }
        let line = vec![[0.0, 1.0], [1e-6, 1.0], [2e-6, 1.0]];
        assert!(MeasuredLoop::of("flat".into(), line).is_none());
    }
}
