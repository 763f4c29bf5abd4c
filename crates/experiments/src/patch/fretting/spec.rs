//! Fretting in the file of a patch: strokes, maps, cracks and many cycles.

use crate::patch::spec::{Numbers, PatchFile, positive};
use fretwork_observe::quantity::quantity;
use fretwork_rolling::Amplitude;
use fretwork_scene::InputError;
use fretwork_scene::material::NumberSpec;
use serde::Deserialize;

/// Strokes back and forth along the motion.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrettingSpec {
    /// Amplitudes of the displacement of distant points (m), a number or a list.
    #[serde(default)]
    pub amplitude: Numbers,
    /// Amplitudes of the force along the motion (N), in place of those of displacement.
    #[serde(default)]
    pub force: Numbers,
    /// Steps of a quarter of a cycle.
    #[serde(default = "steps")]
    pub steps: usize,
    /// Cycles in a second (Hz), in place of the `speed` of the patch.
    #[serde(default)]
    pub frequency: Option<NumberSpec>,
    /// Map of running conditions.
    #[serde(default)]
    pub map: Option<MapSpec>,
    /// Cracks below the surface, on the map.
    #[serde(default)]
    pub cracks: Option<CracksSpec>,
    /// Many cycles of each stroke.
    #[serde(default)]
    pub cycles: Option<CyclesSpec>,
}

fn steps() -> usize {
    20
}

/// Axes of a map, each with numbers in equal ratios.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapSpec {
    /// Loads (N).
    pub load: RangeSpec,
    /// Amplitudes of displacement (m).
    pub amplitude: RangeSpec,
    /// Cells along each side.
    #[serde(default = "map_cells")]
    pub cells: usize,
}

fn map_cells() -> usize {
    32
}

/// Numbers in equal ratios.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RangeSpec {
    /// First number.
    pub from: NumberSpec,
    /// Last number.
    pub to: NumberSpec,
    /// How many.
    pub count: usize,
}

/// A criterion for cracks.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CracksSpec {
    /// Material whose strength under many cycles is known.
    pub strength: String,
    /// `crossland` or `swt`.
    #[serde(default = "crossland")]
    pub criterion: String,
    /// Side of the block of material over which stresses are averaged (m).
    pub block: NumberSpec,
    /// Number of cycles; that of the strength by default.
    #[serde(default)]
    pub cycles: Option<f64>,
    /// Depth of wear after them that counts (m).
    pub depth: NumberSpec,
    /// Material of the body that cracks, by its name in the file; the first body by default.
    #[serde(default)]
    pub body: Option<String>,
    /// Stress of that body along the motion far from the patch, at the largest displacement (Pa).
    #[serde(default)]
    pub bulk: Option<NumberSpec>,
}

fn crossland() -> String {
    "crossland".into()
}

/// Many cycles.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CyclesSpec {
    /// How many.
    pub count: f64,
    /// Error of a jump over what it changes, above which it is halved.
    #[serde(default = "share")]
    pub error: f64,
    /// Way of slip over which a part 1/e of the debris leaves (m); without it none leaves.
    #[serde(default)]
    pub ejection: Option<NumberSpec>,
}

fn share() -> f64 {
    0.02
}

/// A stroke to be solved.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeDrive {
    /// Half of its range.
    pub amplitude: Amplitude,
    /// Steps of a quarter of a cycle.
    pub steps: usize,
    /// Time of a step (s), where the file tells it.
    pub step: Option<f64>,
    /// Path of the amplitude in the file.
    pub path: String,
}

/// Fewest and most steps of a quarter of a cycle.
const STEPS: [usize; 2] = [2, 1000];

/// Returns the strokes of all points.
///
/// # Errors
/// A number is out of range, or there is no stroke.
pub fn drives(file: &PatchFile, spec: &FrettingSpec) -> Result<Vec<StrokeDrive>, InputError> {
    let source = &file.source;
    let read = |path: &str, numbers: &Numbers, unit: &str| -> Result<Vec<f64>, InputError> {
        let list = numbers.0.iter().enumerate();
        let one = |(k, n)| positive(source, &numbers.path(path, k), n, unit);
        list.map(one).collect()
    };
    let amplitudes = read("motion.amplitude", &spec.amplitude, "m")?;
    let forces = read("motion.force", &spec.force, "N")?;
    let [fewest, most] = STEPS;
    if !(fewest..=most).contains(&spec.steps) {
        let text = format!("{fewest} to {most} steps are expected");
        return Err(source.error_at("motion.steps", text));
    }
    if !amplitudes.is_empty() && !forces.is_empty() {
        return Err(source.error_at(
            "motion.force",
            "give amplitudes of displacement, `amplitude`, or of force, `force`, not both",
        ));
    }
    if amplitudes.is_empty() && forces.is_empty() && spec.map.is_none() {
        return Err(source.error_at(
            "motion",
            "there is no stroke: give `amplitude`, `force` or a `map`",
        ));
    }
    if spec.cracks.is_some() && spec.map.is_none() {
        return Err(source.error_at(
            "motion.cracks",
            "cracks are those of a map: give a `map` of loads and amplitudes",
        ));
    }
    if spec.cycles.is_some() && amplitudes.is_empty() && forces.is_empty() {
        return Err(source.error_at(
            "motion.cycles",
            "cycles are those of a stroke: give `amplitude` or `force`",
        ));
    }
    let steps = spec.steps as f64;
    let frequency = spec.frequency.as_ref();
    let frequency = frequency
        .map(|f| positive(source, "motion.frequency", f, "Hz"))
        .transpose()?;
    let speed = file.spec.speed.as_ref();
    let speed = speed
        .map(|s| positive(source, "speed", s, "m/s"))
        .transpose()?;
    if frequency.is_some() && speed.is_some() {
        return Err(source.error_at(
            "motion.frequency",
            "give the mean speed of the stroke, `speed`, or its `frequency`, not both",
        ));
    }
    let by_frequency = frequency.map(|f| 1.0 / (4.0 * f * steps));
    let displaced = amplitudes.iter().enumerate().map(|(k, size)| StrokeDrive {
        path: spec.amplitude.path("motion.amplitude", k),
        amplitude: Amplitude::Displacement(*size),
        steps: spec.steps,
        step: by_frequency.or(speed.map(|v| size / (v * steps))),
    });
    let forced = forces.iter().enumerate().map(|(k, size)| StrokeDrive {
        path: spec.force.path("motion.force", k),
        amplitude: Amplitude::Force(*size),
        steps: spec.steps,
        step: by_frequency,
    });
    Ok(displaced.chain(forced).collect())
}

impl RangeSpec {
    /// Returns the numbers, ascending.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn numbers(
        &self,
        file: &PatchFile,
        path: &str,
        unit: &str,
    ) -> Result<Vec<f64>, InputError> {
        let source = &file.source;
        let from = positive(source, &format!("{path}.from"), &self.from, unit)?;
        let to = positive(source, &format!("{path}.to"), &self.to, unit)?;
        if !(2..=200).contains(&self.count) {
            let text = format!("{} numbers: 2 to 200 are expected", self.count);
            return Err(source.error_at(&format!("{path}.count"), text));
        }
        if from >= to {
            return Err(source.error_at(
                &format!("{path}.to"),
                format!(
                    "the last number, {}, must be above the first, {}",
                    quantity(to, unit),
                    quantity(from, unit)
                ),
            ));
        }
        let ratio = to / from;
        let last = (self.count - 1) as f64;
        let at = |k: usize| from * ratio.powf(k as f64 / last);
        Ok((0..self.count).map(at).collect())
    }
}
