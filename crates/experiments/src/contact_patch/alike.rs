//! Whether runs of a window may give the friction coefficient of a patch: they differ from each
//! other in their seed alone, are trustworthy, and have materials, pressure and motion of the
//! patch. What differs is refused, or accepted by name and then said.

use super::question::Question;
use super::runs::{Runs, WindowRun};
use super::slip::Window;
use super::{Contact, Theory};
use fretwork_observe::quantity::quantity;
use fretwork_observe::quantity::unit::FORCE;
use serde::Serialize;

/// What may differ between runs and a patch if the question accepts it, with its meaning.
pub const ACCEPTABLE: [(&str, &str); 5] = [
    ("untrusted", "runs that are not trustworthy"),
    (
        "inputs",
        "runs that differ from each other in more than their seed",
    ),
    ("materials", "runs of other materials"),
    ("pressure", "runs under another pressure"),
    ("drive", "runs with another motion or slip"),
];

/// Largest relative difference of the pressure of a run from the range between the mean and the
/// largest pressure of the patch.
const PRESSURE: f64 = 0.1;

/// Largest ratio of the slip of a run to that of the patch, either way.
const SLIP: f64 = 1.25;

/// What to do about a run whose case is not known.
const UNKNOWN: &str = "keep results.h5 beside summary.json, or make the run again";

/// Conditions of the runs from which a friction coefficient is.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Conditions {
    /// Materials of the first bodies.
    pub materials: Vec<String>,
    /// Mean pressure on the window (Pa).
    pub pressure: Option<f64>,
    /// Whether the runs move to and fro.
    pub reciprocates: Option<bool>,
    /// Amplitude of the motion to and fro, or length of that in one direction (m).
    pub slip: Option<f64>,
    /// Mean speed (m/s).
    pub speed: Option<f64>,
}

impl Conditions {
    fn of(run: &WindowRun) -> Self {
        let motion = run.motion.as_ref();
        Self {
            materials: run
                .setup
                .as_ref()
                .map_or(Vec::new(), |s| s.materials.clone()),
            pressure: pressure(run),
            reciprocates: motion.map(|m| m.reciprocates),
            slip: motion.map(|m| m.slip),
            speed: motion.map(|m| m.speed),
        }
    }
}

/// Mean pressure on the window of a run (Pa).
fn pressure(run: &WindowRun) -> Option<f64> {
    let area = run.setup.as_ref().ok()?.area?;
    Some(run.normal_force?.abs() / area)
}

/// Something in which runs differ from each other or from the patch.
struct Difference {
    /// What must be accepted.
    what: &'static str,
    /// Heading of its warning.
    heading: &'static str,
    /// The difference, in a sentence.
    text: String,
    /// What to change; empty if nothing but other runs helps.
    advice: String,
}

/// Collects differences, and decides which are refused.
struct Differences<'a> {
    accepted: &'a [String],
    list: Vec<Difference>,
}

impl<'a> Differences<'a> {
    /// Checks the names that a question accepts.
    fn new(question: &'a Question) -> Result<Self, String> {
        let known = || ACCEPTABLE.iter().map(|(name, _)| *name);
        let unknown = question
            .accept
            .iter()
            .find(|a| !known().any(|k| k == a.trim()));
        match unknown {
            Some(name) => Err(format!(
                "accept: `{name}` is none of {}",
                known().collect::<Vec<_>>().join(", ")
            )),
            None => Ok(Self {
                accepted: &question.accept,
                list: Vec::new(),
            }),
        }
    }

    fn add(&mut self, what: &'static str, heading: &'static str, text: String, advice: &str) {
        let advice = advice.to_owned();
        self.list.push(Difference {
            what,
            heading,
            text,
            advice,
        });
    }

    /// Returns the warnings on what is accepted.
    ///
    /// # Errors
    /// Something is not accepted; the sentence names all of it.
    fn decide(self) -> Result<Vec<String>, String> {
        let accepted = |d: &Difference| self.accepted.iter().any(|a| a.trim() == d.what);
        let (noted, refused): (Vec<_>, Vec<_>) = self.list.iter().partition(|d| accepted(d));
        if refused.is_empty() {
            let note = |d: &&Difference| format!("{}: {}", d.heading, d.text);
            return Ok(noted.iter().map(note).collect());
        }
        let reason = |d: &&Difference| match d.advice.as_str() {
            "" => d.text.clone(),
            advice => format!("{} ({advice})", d.text),
        };
        let reasons: Vec<String> = refused.iter().map(reason).collect();
        let mut what: Vec<&str> = refused.iter().map(|d| d.what).collect();
        what.dedup();
        Err(format!(
            "friction of runs: {}; to take them all the same, give `--accept {}`",
            reasons.join("; "),
            what.join(",")
        ))
    }
}

/// Compares runs with each other and with the patch, in all but their motion; returns their
/// conditions and warnings.
///
/// # Errors
/// A difference that the question does not accept.
pub(super) fn compare(
    question: &Question,
    contact: &Contact,
    runs: &Runs,
) -> Result<(Option<Conditions>, Vec<String>), String> {
    let mut found = Differences::new(question)?;
    for run in &runs.list {
        if let Some(doubts) = &run.doubts {
            let why = doubts.first().map_or("it gives no reason", String::as_str);
            let text = format!("{} is not trustworthy: {why}", run.folder.display());
            let advice = "mend what it names, and run it again";
            found.add("untrusted", "NOT TRUSTED", text, advice);
        }
    }
    let Some((first, others)) = runs.list.split_first() else {
        return Ok((None, Vec::new()));
    };
    for other in others {
        if let (Ok(one), Ok(two)) = (&first.setup, &other.setup) {
            let paths = one.differences(two);
            if !paths.is_empty() {
                let shown = paths.iter().take(4).map(|p| format!("`{p}`"));
                let more = if paths.len() > 4 { " and more" } else { "" };
                let text = format!(
                    "{} and {} differ in more than their seed, in {}{more}, so that their scatter is not that of samples",
                    first.folder.display(),
                    other.folder.display(),
                    shown.collect::<Vec<_>>().join(", ")
                );
                let advice = "give runs of one case that differ in `seed` alone";
                found.add("inputs", "INPUTS DIFFER", text, advice);
            }
        }
    }
    for run in distinct(runs) {
        materials(question, run, &mut found);
        under(contact, run, &mut found);
    }
    let mut notes = found.decide()?;
    for run in &runs.list {
        let (folder, unsure) = (run.folder.display(), run.unsure.iter());
        notes.extend(unsure.map(|what| format!("ERROR NOT KNOWN: {folder}: {what}")));
    }
    Ok((Some(Conditions::of(first)), notes))
}

/// Returns the first run, and those whose case is another than by its seed.
fn distinct(runs: &Runs) -> impl Iterator<Item = &WindowRun> {
    let first = runs.list.first();
    let others = runs.list.iter().skip(1);
    first
        .into_iter()
        .chain(others.filter(move |run| first.is_none_or(|first| first.setup != run.setup)))
}

fn materials(question: &Question, run: &WindowRun, found: &mut Differences<'_>) {
    let mut asked: Vec<&str> = question.material.iter().map(String::as_str).collect();
    asked.sort_unstable();
    asked.dedup();
    let folder = run.folder.display();
    let text = match &run.setup {
        Err(why) => format!("whether {folder} has the materials of the patch is not known: {why}"),
        Ok(_) if asked.is_empty() => format!(
            "whether {folder} has the materials of the patch is not known: the patch has moduli alone; name its materials"
        ),
        Ok(setup) if setup.materials == asked => return,
        Ok(setup) => format!(
            "the first bodies of {folder} are of {}, those of the patch of {}",
            setup.materials.join(" and "),
            asked.join(" and ")
        ),
    };
    let advice = match &run.setup {
        Ok(_) if !asked.is_empty() => "run its case with --set materials.NAME=MATERIAL",
        Ok(_) => "",
        Err(_) => UNKNOWN,
    };
    found.add("materials", "OTHER MATERIALS", text, advice);
}

fn under(contact: &Contact, run: &WindowRun, found: &mut Differences<'_>) {
    let folder = run.folder.display();
    let (mean, most) = (contact.mean_pressure(), contact.pressure());
    let pascal = |p: f64| quantity(p, "Pa");
    let (text, advice) = match (pressure(run), &run.setup) {
        (Some(p), _) if p > (1.0 - PRESSURE) * mean && p < (1.0 + PRESSURE) * most => return,
        (Some(p), Ok(setup)) => {
            let load = most * setup.area.unwrap_or_default();
            let unit = FORCE.symbol(setup.dimension);
            (
                format!(
                    "{folder} is under {}, the patch under {} in the mean and {} in its middle",
                    pascal(p),
                    pascal(mean),
                    pascal(most)
                ),
                format!("run its case with a load of {}", quantity(load, unit)),
            )
        }
        (_, Err(why)) => (
            format!("the mean pressure in {folder} is not known: {why}"),
            UNKNOWN.to_owned(),
        ),
        (None, Ok(_)) => (
            format!(
                "the mean pressure in {folder} is not known: it is no periodic window with a normal force"
            ),
            "give its case `periodic` and a body with a normal force".to_owned(),
        ),
    };
    found.add("pressure", "OTHER PRESSURE", text, &advice);
}

/// Compares the motion of the runs with the slip of the patch; of a patch without creepage or
/// displacement, the motions of the runs with each other, and their direction with that of rolling.
/// Returns warnings.
///
/// # Errors
/// A difference that the question does not accept.
pub(super) fn drive(
    question: &Question,
    runs: &Runs,
    window: &Window,
) -> Result<Vec<String>, String> {
    let mut found = Differences::new(question)?;
    let rolls = question.creepage.is_some();
    let Some(slip) = &window.slip else {
        among_themselves(question, runs, &mut found);
        let mut notes = found.decide()?;
        notes.extend(not_compared(runs));
        return Ok(notes);
    };
    for run in distinct(runs) {
        let folder = run.folder.display();
        let Some(motion) = run.motion else {
            let text =
                format!("how {folder} moves is not known: its statistics have no displacement");
            let advice = "keep statistics.csv beside summary.json";
            found.add("drive", "OTHER DRIVE", text, advice);
            continue;
        };
        if motion.reciprocates == rolls || !near(motion.slip, slip.value) {
            let text = format!(
                "{folder} slips {}, the patch {}",
                way(motion.reciprocates, motion.slip),
                way(!rolls, slip.value)
            );
            found.add(
                "drive",
                "OTHER DRIVE",
                text,
                "give its case the slip of the patch",
            );
        }
    }
    found.decide()
}

/// Whether two slips (m) are the same but for [`SLIP`].
fn near(one: f64, other: f64) -> bool {
    let ratio = one / other;
    ratio < SLIP && ratio > 1.0 / SLIP
}

/// Returns a slip (m) with its direction in words.
fn way(reciprocates: bool, slip: f64) -> String {
    let length = quantity(slip, "m");
    match reciprocates {
        true => format!("to and fro by +-{length}"),
        false => format!("one way by {length}"),
    }
}

/// Compares the motions of runs with each other, and those to and fro with a patch that rolls.
fn among_themselves(question: &Question, runs: &Runs, found: &mut Differences<'_>) {
    let heading = "OTHER DRIVE";
    let moving: Vec<_> = distinct(runs)
        .filter_map(|run| Some((run.folder.display(), run.motion?)))
        .collect();
    if question.speed.is_some() {
        for (folder, motion) in moving.iter().filter(|(_, m)| m.reciprocates) {
            let moves = way(true, motion.slip);
            let text = format!("{folder} slips {moves}, and the patch rolls in one direction");
            found.add("drive", heading, text, "give runs that slip one way");
        }
    }
    let Some(((first, one), others)) = moving.split_first() else {
        return;
    };
    for (other, two) in others {
        if one.reciprocates != two.reciprocates || !near(one.slip, two.slip) {
            let text = format!(
                "{first} slips {}, {other} {}",
                way(one.reciprocates, one.slip),
                way(two.reciprocates, two.slip)
            );
            let advice = "give runs of one motion, or the patch its creepage or displacement";
            found.add("drive", heading, text, advice);
        }
    }
}

/// Returns a note that the motion of runs was not compared with a patch whose own is not given.
fn not_compared(runs: &Runs) -> Option<String> {
    let run = runs.list.first()?;
    let moves = run.motion.map(|m| way(m.reciprocates, m.slip));
    Some(format!(
        "DRIVE NOT COMPARED: the patch has neither creepage nor displacement, and {} slips {}; give one of them",
        run.folder.display(),
        moves.as_deref().unwrap_or("in a way that is not known"),
    ))
}

impl Contact {
    /// Returns the mean pressure (Pa).
    pub(super) fn mean_pressure(&self) -> f64 {
        match &self.theory {
            Theory::Line(line) => self.load / (2.0 * line.half_width),
            Theory::Point(point) => self.load / point.area(),
        }
    }
}
