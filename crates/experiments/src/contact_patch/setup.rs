//! Under which conditions a run was made: materials of its first bodies, load, motion, and all
//! inputs of its case.

use crate::runs::window::{self, since};
use fretwork_scene::source::Source;
use fretwork_scene::{Case, inputs};
use fretwork_store::results::Reader;
use std::path::Path;

/// Groups of inputs that change no result of a run, or only its sample.
const NO_MATTER: [&str; 6] = ["seed", "name", "doc", "output", "uncertainty", "measures"];

/// The case of a run, from its results.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Setup {
    /// Names of the materials of its first bodies, sorted.
    pub materials: Vec<String>,
    /// Area of a periodic window (m²; 2D m); `None` if the contact is not periodic.
    pub area: Option<f64>,
    /// Dimension.
    pub dimension: usize,
    /// Start of the friction test (s).
    pub start: f64,
    /// Paths and values of all inputs that may change the result.
    inputs: Vec<(String, String)>,
}

impl Setup {
    /// Reads the case in the results of a run.
    ///
    /// # Errors
    /// Returns why the case is not known, as the end of a sentence.
    pub fn read(folder: &Path) -> Result<Self, String> {
        let reader = Reader::open(&folder.join("results.h5")).map_err(|_| {
            "it has no results.h5 that can be read, which holds its case".to_owned()
        })?;
        let text = reader.texts("case").into_iter().next();
        Self::of(&text.ok_or("its results.h5 does not hold its case")?)
            .map_err(|_| "this version does not read the case in its results.h5".to_owned())
    }

    /// Reads the text of a case.
    ///
    /// # Errors
    /// It is no case.
    pub(super) fn of(text: &str) -> Result<Self, String> {
        let source = Source::from_text("case", text);
        let case = Case::read(&source).map_err(|e| e.to_string())?;
        let bodies = case.bodies.iter().map(|b| &b.material);
        let half_spaces = case.half_spaces.iter().map(|b| &b.material);
        let elastic = case.elastic.iter().map(|b| &b.material);
        let all = bodies.chain(half_spaces).chain(elastic);
        let file = |name: &String| case.materials.get(name).unwrap_or(name).clone();
        let mut materials: Vec<String> = all.map(file).collect();
        materials.sort();
        materials.dedup();
        let dimension = case.dimension as usize;
        let area = window::area(&case);
        let matters = |path: &str| !NO_MATTER.contains(&path.split('.').next().unwrap_or(path));
        let inputs = inputs::of(text)?.into_iter();
        let inputs = inputs.filter(|i| matters(&i.path));
        Ok(Self {
            materials,
            area,
            dimension,
            start: case.friction.as_ref().map_or(0.0, |test| test.start),
            inputs: inputs.map(|i| (i.path, i.value)).collect(),
        })
    }

    /// Returns the paths of inputs that differ from those of another run, the seed left out.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let lacks = |of: &Self, input: &(String, String)| !of.inputs.contains(input);
        let mut out: Vec<String> = Vec::new();
        for (of, against) in [(self, other), (other, self)] {
            let paths = of.inputs.iter().filter(|i| lacks(against, i));
            for (path, _) in paths {
                if !out.contains(path) {
                    out.push(path.clone());
                }
            }
        }
        out
    }
}

/// Motion of the moved body in the friction test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motion {
    /// Whether it goes to and fro.
    pub reciprocates: bool,
    /// Amplitude of the motion to and fro, or length of that in one direction (m).
    pub slip: f64,
    /// Mean speed (m/s).
    pub speed: f64,
}

impl Motion {
    /// Reads the motion from the statistics of a run.
    pub fn read(folder: &Path, reciprocates: bool, start: f64) -> Option<Self> {
        let (time, delta) = (
            since(folder, "time", start)?,
            since(folder, "delta", start)?,
        );
        Self::of(&time, &delta, reciprocates)
    }

    fn of(time: &[f64], delta: &[f64], reciprocates: bool) -> Option<Self> {
        let path: f64 = delta.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
        let low = delta.iter().copied().fold(f64::INFINITY, f64::min);
        let high = delta.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lasted = time.last()? - time.first()?;
        (lasted > 0.0 && path > 0.0).then(|| Self {
            reciprocates,
            slip: if reciprocates {
                0.5 * (high - low)
            } else {
                path
            },
            speed: path / lasted,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = r#"(
        name: "window", dimension: 2, seed: 1, time: (step: 1e-3, end: 0.1), periodic: (x: 4e-4),
        materials: {"rail": "rail_steel_r260", "wheel": "wheel_steel_er7"}, interfaces: [],
        bodies: [
            (name: "low", material: "rail", shapes: [HalfSpace(normal: [0.0, 1.0])]),
            (name: "high", material: "wheel", shapes: [HalfSpace(normal: [0.0, -1.0])]),
        ],
        friction: (body: "high", along: 0, normal: 1, start: 0.02),
    )"#;

    #[test]
    fn a_case_gives_materials_and_area_and_differs_by_more_than_its_seed() {
        let one = Setup::of(CASE).unwrap();
        assert_eq!(one.materials, ["rail_steel_r260", "wheel_steel_er7"]);
        assert_eq!((one.area, one.start, one.dimension), (Some(4e-4), 0.02, 2));
        let with = |from: &str, to: &str| Setup::of(&CASE.replace(from, to)).unwrap();
        assert!(one.differences(&with("seed: 1", "seed: 2")).is_empty());
        assert_eq!(one.differences(&with("4e-4", "2e-4")), ["periodic.x"]);
        assert_eq!(with("periodic: (x: 4e-4),", "").area, None);
    }

    #[test]
    fn a_motion_has_a_slip_and_a_speed() {
        let one_way = Motion::of(&[0.0, 1.0, 2.0], &[0.0, 1.0, 4.0], false).unwrap();
        assert_eq!((one_way.slip, one_way.speed), (4.0, 2.0));
        let to_and_fro = Motion::of(&[0.0, 1.0, 2.0], &[1.0, -1.0, 1.0], true).unwrap();
        assert_eq!((to_and_fro.slip, to_and_fro.speed), (1.0, 2.0));
        assert_eq!(Motion::of(&[0.0, 1.0], &[0.0, 0.0], false), None);
    }
}
