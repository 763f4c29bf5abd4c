//! The runs of windows: a study of the case for each time that the windows follow the patch.

use super::Runs;
use super::spec::ThirdBodySpec;
use super::window::Window;
use crate::Error;
use crate::runs::stored::{FinishedRun, summary};
use crate::study::execute::{execute, missing};
use crate::study::plan::{Location, Plan, Point};
use crate::study::rows::{DONE, status};
use crate::study::spec::StudyFile;
use fretwork_observe::wear::WearSummary;
use fretwork_rolling::slider::{Fitted, StripHistory};
use std::path::PathBuf;
use std::sync::atomic::Ordering;

/// Parts of the passage with a coefficient of friction each.
pub const PARTS: usize = 20;

/// A strip that is run.
#[derive(Debug)]
pub struct Wanted {
    /// Its name.
    pub name: String,
    /// What it undergoes.
    pub course: StripHistory,
}

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Ran {
    /// The layer.
    pub fitted: Fitted,
    /// Specific wear rates of first bodies, k (1/Pa).
    pub wear: Vec<(String, f64)>,
}

/// Runs that are made, or wait to be made elsewhere.
pub enum Made {
    /// For each strip those of its seeds.
    All(Vec<Vec<Ran>>),
    /// The study whose runs are missing, its folder, and their number.
    Missing(PathBuf, PathBuf, usize),
}

/// Makes the runs of strips that are missing.
///
/// # Errors
/// The case refuses a load or a slip, or a run fails.
pub fn make(
    window: &Window,
    spec: &ThirdBodySpec,
    wanted: &[Wanted],
    number: usize,
    runs: &Runs<'_>,
) -> Result<Made, Error> {
    let study = runs.out.join(format!("windows_{number}.ron"));
    let out = runs.out.join(format!("windows_{number}"));
    let text = text(window, spec, wanted, number)?;
    std::fs::create_dir_all(&out).map_err(|e| Error::write(&out, &e))?;
    std::fs::write(&study, text).map_err(|e| Error::write(&study, &e))?;
    let cache = runs.out.join("runs");
    let plan = Plan::new(
        &StudyFile::read(&study)?,
        Location {
            out: &out,
            cache: Some(&cache),
            setup: runs.setup,
        },
    )?;
    plan.keep()?;
    let open = missing(&plan);
    if !open.is_empty() {
        (runs.say)(&format!(
            "windows, time {number}: {} strips x {} seeds, {} of {} runs are to be made",
            wanted.len(),
            plan.seeds.len(),
            open.len(),
            plan.count()
        ));
        if !runs.make {
            return Ok(Made::Missing(study, out, open.len()));
        }
    }
    let say = |point: &Point, run: &FinishedRun| {
        (runs.say)(&format!(
            "  {}: {} in {:.0} s",
            plan.words(point),
            status(Some(run)).0,
            run.wall
        ));
    };
    execute(&plan, open, runs.jobs, runs.limit, runs.stop, &say)?;
    if runs.stop.load(Ordering::Relaxed) {
        return Err(Error::Failed(
            "interrupted: finished runs are kept; the same command continues".into(),
        ));
    }
    let all: Vec<Point> = plan.points().collect();
    let of = |point: &Point| -> Result<Ran, Error> {
        let place = plan.launcher.place(&point.run);
        let run = plan.launcher.ended_in(&place);
        let (word, why) = status(run.as_ref());
        let fail = |why: &str| {
            Error::Failed(format!(
                "the window {}: {why} ({})",
                plan.words(point),
                place.display()
            ))
        };
        if word != DONE {
            return Err(fail(&format!("{word}: {why}")));
        }
        let course = window.course(&place);
        let fitted = course.and_then(|c| Fitted::of(&c, PARTS));
        Ok(Ran {
            fitted: fitted.ok_or_else(|| fail("it has no friction along its slip"))?,
            wear: WearSummary::rates(&summary(&place)),
        })
    };
    let all: Vec<Ran> = all.iter().map(of).collect::<Result<_, _>>()?;
    Ok(Made::All(
        all.chunks(plan.seeds.len()).map(<[_]>::to_vec).collect(),
    ))
}

/// Returns the text of a study of the strips.
fn text(
    window: &Window,
    spec: &ThirdBodySpec,
    wanted: &[Wanted],
    number: usize,
) -> Result<String, Error> {
    let case = std::path::absolute(&window.case);
    let case = case.map_err(|e| Error::write(&window.case, &e))?;
    let mut out = format!(
        "// Windows of the strips of a patch, the time {number} that they follow it.\n(\n    title: {:?},\n    case: {:?},\n    set: {:?},\n    seeds: {},\n    factors: [Options(name: \"strip\", options: [\n",
        format!("{}, in strips of a patch", window.name),
        case.display().to_string(),
        spec.set,
        spec.seeds
    );
    for strip in wanted {
        let sets = window.sets(&strip.course);
        out += &format!("        (name: {:?}, set: {sets:?}),\n", strip.name);
    }
    Ok(out + "    ])],\n)\n")
}
