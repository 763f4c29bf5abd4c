//! A window of a third body that undergoes what material of a strip of the patch does: its case
//! with another load and another slip.
//!
//! The window is compacted as its case does it, under the largest pressure of the strip, since the
//! layer has passed before. While it is, the moved body is free along the slip: held, it would lock
//! in a shear stress that biases small slips. It then enters the patch, with the pressure of the
//! leading edge, and passes it in the time of the case.

use super::spec::ThirdBodySpec;
use crate::patch::PatchFile;
use crate::runs::window;
use crate::{Error, load};
use fretwork_core::bodies::{Dof, TimeFunction};
use fretwork_rolling::slider::StripHistory;
use std::path::{Path, PathBuf};

/// Pressure at the edges over the largest one of a strip, below which a window would fall apart.
const LEAST: f64 = 0.03;
/// Share of the time of the passage in which the window goes from the compaction to the leading
/// edge.
const ENTERS: f64 = 0.04;
/// Names of the axes in a case.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The window.
#[derive(Debug)]
pub struct Window {
    /// Its case.
    pub case: PathBuf,
    /// Title of the case.
    pub name: String,
    /// Length (m), over which forces per length are pressures.
    length: f64,
    /// The moved body.
    body: String,
    along: &'static str,
    normal: &'static str,
    /// Times from which the window enters the patch, passes it, and has left it (s).
    times: [f64; 3],
    /// Load of the compaction over its last value, by time (s).
    compaction: Vec<(f64, f64)>,
    /// Sign of the load.
    sign: f64,
}

impl Window {
    /// Reads the case of the windows of a patch.
    ///
    /// # Errors
    /// The case is refused, or is no window with a friction test whose load is a force.
    pub fn read(file: &PatchFile, spec: &ThirdBodySpec) -> Result<Self, Error> {
        let case = file.beside(&spec.case);
        let named = |e| file.source.named_at("third_body.case", e);
        let loaded = load(&case, &spec.set).map_err(named)?;
        let fail = |why: &str| {
            let name = spec.case.display();
            let why = format!("the case {name} is no window of a third body: {why}");
            Error::Input(file.source.error_at("third_body.case", why))
        };
        let found = &loaded.case;
        let test = found.friction.as_ref();
        let test = test.ok_or_else(|| fail("give it `friction`, with the body that slips"))?;
        if found.dimension as usize != 2 {
            return Err(fail(
                "it is in three dimensions, and strips slip in a plane",
            ));
        }
        let length = window::area(found).filter(|l| *l > 0.0);
        let length = length.ok_or_else(|| fail("give it a period along the slip (`periodic`)"))?;
        let body = found.bodies.iter().find(|b| b.name == test.body);
        let body = body.ok_or_else(|| fail("the body of its friction test is no first body"))?;
        let dof = |axis: usize| {
            if axis == 0 {
                &body.dofs.x
            } else {
                &body.dofs.y
            }
        };
        if !matches!(dof(test.along), Dof::Displacement(_) | Dof::Velocity(_)) {
            return Err(fail("the body of its friction test has no imposed motion"));
        }
        let Dof::Force(load) = dof(test.normal) else {
            return Err(fail(
                "the load on the body of its friction test is no `Force`",
            ));
        };
        let points = match load {
            TimeFunction::Constant(value) => vec![(0.0, *value)],
            TimeFunction::Ramp {
                from,
                to,
                start,
                end,
            } => vec![(*start, *from), (*end, *to)],
            TimeFunction::Table(points) => points.clone(),
            TimeFunction::Sine { .. } => return Err(fail("its load oscillates")),
        };
        let (start, end) = (test.start, found.time.end);
        let last = load.value(start);
        if !(end > start && last != 0.0) {
            return Err(fail("there is no load, or no time, for the slip"));
        }
        let before = points.into_iter().filter(|(t, _)| *t < start);
        Ok(Self {
            case,
            name: found.name.clone(),
            length,
            body: test.body.clone(),
            along: AXES[test.along],
            normal: AXES[test.normal],
            times: [start, start + ENTERS * (end - start), end],
            compaction: before.map(|(t, f)| (t, f / last)).collect(),
            sign: last.signum(),
        })
    }

    /// Returns the changes of the case by which it undergoes a course.
    pub fn sets(&self, course: &StripHistory) -> Vec<String> {
        let [enters, begins, ends] = self.times;
        let most = course.pressure.iter().copied().fold(0.0, f64::max);
        let time = |place: f64| begins + 0.5 * (place + 1.0) * (ends - begins);
        let force = |pressure: f64| self.sign * self.length * pressure;
        let compaction = self.compaction.iter().map(|(t, f)| (*t, f * force(most)));
        let passage = course.place.iter().zip(&course.pressure);
        let passage = passage.map(|(x, p)| (time(*x), force(p.max(LEAST * most))));
        let load = compaction.chain([(enters, force(most))]).chain(passage);
        let first = course.path.first().copied().unwrap_or_default();
        let slip = course.place.iter().zip(&course.path);
        let slip = slip.map(|(x, d)| (time(*x), d - first));
        let (body, along, normal) = (&self.body, self.along, self.normal);
        vec![
            format!(
                "bodies.{body}.dofs.{along}=Stages([(until: {begins:e}, drive: Free), (drive: Displacement({}))])",
                table(slip)
            ),
            format!("bodies.{body}.dofs.{normal}=Force({})", table(load)),
            format!("friction.start={begins:e}"),
            "uncertainty=(repeats: 0)".to_owned(),
        ]
    }

    /// Returns the course that a run had; `None` where it recorded none.
    pub fn course(&self, folder: &Path) -> Option<StripHistory> {
        let [_, begins, ends] = self.times;
        let rows = window::FrictionCourse::read(folder, begins)?;
        let place = |t: f64| 2.0 * (t - begins) / (ends - begins) - 1.0;
        let from = rows.delta[0];
        let over = |forces: &[f64]| forces.iter().map(|f| f / self.length).collect();
        Some(StripHistory {
            place: rows.time.iter().map(|t| place(*t)).collect(),
            path: rows.delta.iter().map(|d| d - from).collect(),
            pressure: over(&rows.normal),
            traction: over(&rows.tangential),
        })
    }
}

/// Returns a table over time with six digits.
fn table(points: impl Iterator<Item = (f64, f64)>) -> String {
    let points: Vec<String> = points.map(|(t, v)| format!("({t:.6e}, {v:.5e})")).collect();
    format!("Table([{}])", points.join(", "))
}
