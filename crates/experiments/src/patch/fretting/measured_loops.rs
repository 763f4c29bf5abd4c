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
    /// Whole cycles in the file.
    pub cycles: usize,
    /// Half of the range of the displacement in the last cycle (m).
    pub displacement: f64,
    /// Half of the range of the force in the last cycle (N).
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
    ///
    /// A record begins with the first loading and may have several cycles, of which the last is
    /// taken; a file with one cycle is closed from its last point to its first.
    fn of(name: String, points: Vec<[f64; 2]>) -> Option<Self> {
        let (last, cycles) = last_cycle(&points)?;
        let (_, displacement) = half_range(last, 0)?;
        let (_, force) = half_range(last, 1)?;
        if last.len() < 3 {
            return None;
        }
        let pairs = last.iter().zip(last.iter().cycle().skip(1));
        let area: f64 = pairs
            .map(|(a, b)| 0.5 * (a[1] + b[1]) * (b[0] - a[0]))
            .sum();
        let energy = area.abs();
        Some(Self {
            cycles,
            name,
            displacement,
            force,
            energy,
            energy_ratio: energy / (4.0 * force * displacement),
            points,
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

/// The middle of a coordinate of some points, and half of its range; `None` if it is constant.
fn half_range(points: &[[f64; 2]], axis: usize) -> Option<(f64, f64)> {
    let values = || points.iter().map(|p| p[axis]);
    let (least, most) = (values().reduce(f64::min)?, values().reduce(f64::max)?);
    (most > least).then_some((0.5 * (least + most), 0.5 * (most - least)))
}

/// Returns the points of the last whole cycle, between two ends of the stroke on one side, and the
/// number of cycles; all points where no cycle is whole. An end is the farthest point between two
/// visits of the other outer quarter of the range, so that noise makes none.
fn last_cycle(points: &[[f64; 2]]) -> Option<(&[[f64; 2]], usize)> {
    let (middle, half) = half_range(points, 0)?;
    let ends_of = |side: f64| {
        let out = |k: usize| side * (points[k][0] - middle) / half;
        let mut ends: Vec<usize> = Vec::new();
        let mut away = true;
        for k in 0..points.len() {
            match (out(k), ends.last_mut()) {
                (o, _) if o < -0.5 => away = true,
                (o, _) if o > 0.5 && away => {
                    away = false;
                    ends.push(k);
                }
                (o, Some(end)) if !away && o > out(*end) => *end = k,
                _ => {}
            }
        }
        // A record may begin or stop before an end.
        ends.retain(|k| out(*k) > 0.9);
        ends
    };
    let sides = [1.0, -1.0].map(ends_of);
    let cycles = sides.iter().map(|ends| ends.len().saturating_sub(1)).max();
    let pair = |ends: &Vec<usize>| match ends.as_slice() {
        [.., from, to] => Some((*from, *to)),
        _ => None,
    };
    let last = sides.iter().filter_map(pair).max_by_key(|(_, to)| *to);
    let last = last.map_or(points, |(from, to)| &points[from..=to]);
    Some((last, cycles.unwrap_or(0).max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loop of gross slip at Q under a stiffness k before it slips is a parallelogram of the
    /// area 4 Q (delta - Q/k). The record has its first loading, cycles of 400 points, and a noise
    /// of displacement by which neighbouring points change places.
    #[test]
    fn energy_is_that_of_the_last_cycle_of_a_noisy_record() {
        let (delta, q, k, per_cycle) = (20e-6, 100.0, 20e6, 400);
        let energy = 4.0 * q * (delta - q / k);
        for (quarters, cycles, noise, within) in [
            (5, 1, 0.0, 1e-3),
            (6, 1, 0.0, 1e-3),
            (8, 1, 0.0, 1e-3),
            (13, 3, 0.0, 1e-3),
            (13, 3, 0.5e-6, 0.01),
            (16, 3, 0.5e-6, 0.01),
        ] {
            let (mut force, mut before): (f64, f64) = (0.0, 0.0);
            let mut points = Vec::new();
            for n in 0..=quarters * per_cycle / 4 {
                let turn = 2.0 * std::f64::consts::PI * f64::from(n) / f64::from(per_cycle);
                let place = delta * turn.sin();
                force = (force + k * (place - before)).clamp(-q, q);
                before = place;
                let shake = noise * (12.9898 * f64::from(n)).sin();
                points.push([place + shake, force]);
            }
            let found = MeasuredLoop::of("rig".into(), points).unwrap();
            let off = found.energy / energy - 1.0;
            assert!(
                off.abs() < within,
                "{quarters} quarters, noise {noise}: {off}"
            );
            assert_eq!(
                (found.force, found.cycles),
                (q, cycles),
                "{quarters} quarters"
            );
        }
    }

    #[test]
    fn one_cycle_is_closed_from_its_end_to_its_beginning() {
        let (delta, q, lag) = (20e-6, 100.0, 5e-6);
        let cycle = [
            [-delta + 2.0 * lag, q],
            [delta, q],
            [delta - 2.0 * lag, -q],
            [-delta, -q],
        ];
        let found = MeasuredLoop::of("rig".into(), cycle.to_vec()).unwrap();
        let energy = 4.0 * q * (delta - lag);
        assert!((found.energy / energy - 1.0).abs() < 1e-12, "{found:?}");
        assert_eq!(found.cycles, 1);
        assert!((found.energy_ratio - 0.75).abs() < 1e-12);
        let line = vec![[0.0, 1.0], [1e-6, 1.0], [2e-6, 1.0]];
        assert!(MeasuredLoop::of("flat".into(), line).is_none());
    }
}
