//! What a law promises, tested on the one-contact bench.
//!
//! A law is composed with plain partners (frictionless contact, a linear bond), driven along paths at the
//! opening where it does something, and each promise gives a line: kept, broken or not made, with the
//! number that decided.

mod apart;
mod bond;
mod border;
mod rig;
mod static_memory;
mod surface;

pub use apart::{CERTIFY_APART, certify_apart, certify_asked};

use crate::laws::kind::CheckSet;
use crate::laws::{LawError, Loaded, Plugin, SearchPath};
use rig::Rig;
use serde::{Deserialize, Deserializer, Serialize};

/// How a promise came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Kept.
    Pass,
    /// Broken.
    Fail,
    /// Not made by this law.
    Skip,
}

/// One promise.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Line {
    /// Its name.
    pub check: String,
    /// How it came out.
    pub outcome: Outcome,
    /// The number that decided; what it is, the text says. Infinity is written as null.
    #[serde(deserialize_with = "null_is_infinite")]
    pub number: f64,
    /// What was measured.
    pub text: String,
}

impl Line {
    fn judged(check: &str, kept: bool, number: f64, text: impl Into<String>) -> Self {
        let outcome = if kept { Outcome::Pass } else { Outcome::Fail };
        Self {
            check: check.to_owned(),
            outcome,
            number,
            text: text.into(),
        }
    }

    /// Kept when the number is at most `limit`.
    fn below(check: &str, number: f64, limit: f64, text: impl Into<String>) -> Self {
        let text = format!("{}; at most {limit:e}", text.into());
        Self::judged(check, number <= limit, number, text)
    }

    fn skip(check: &str, why: impl Into<String>) -> Self {
        Self {
            check: check.to_owned(),
            outcome: Outcome::Skip,
            number: 0.0,
            text: why.into(),
        }
    }

    fn failed(check: &str, e: &LawError) -> Self {
        Self::judged(check, false, f64::INFINITY, e.to_string())
    }
}

fn null_is_infinite<'a, D: Deserializer<'a>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// What happens while a law is tested.
enum Event<'a> {
    /// A check begins.
    Begins(&'a str),
    /// It gave this line.
    Line(&'a Line),
}

/// The lines of a certificate as they are written.
struct Book<'a> {
    lines: Vec<Line>,
    /// Whom the law is tested with, at the end of each line.
    partner: String,
    tell: &'a mut dyn FnMut(Event<'_>),
}

type Check = fn(&mut Rig) -> Result<Line, LawError>;

impl Book<'_> {
    /// Makes checks, each whatever became of the one before it.
    fn make(&mut self, rig: &mut Rig, checks: &[(&str, Check)]) {
        for (name, check) in checks {
            (self.tell)(Event::Begins(name));
            let line = check(rig).unwrap_or_else(|e| Line::failed(name, &e));
            self.write(line);
        }
    }

    fn write(&mut self, line: Line) {
        let text = format!("{}{}", line.text, self.partner);
        let line = Line { text, ..line };
        (self.tell)(Event::Line(&line));
        self.lines.push(line);
    }
}

/// What was found of a law.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Kind of the law.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Hash of the library.
    pub sha256: String,
    /// The library.
    pub library: String,
    /// The promises.
    pub lines: Vec<Line>,
}

impl Certificate {
    /// Whether no promise was broken.
    pub fn certified(&self) -> bool {
        self.lines.iter().all(|l| l.outcome != Outcome::Fail)
    }
}

/// Tests a law with these parameters; partners are taken from the search path, with their defaults. A damage law meets
/// `cohesion` where that is given: what it promises depends on the bond's stiffness.
///
/// # Errors
/// A partner is missing, or the parameters do not suit the law. What the law itself does wrong is a line.
pub fn certify(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&Loaded>,
    path: &SearchPath,
) -> Result<Certificate, LawError> {
    certify_telling(
        plugin,
        parameters,
        cohesion,
        path,
        &border::CHECKS,
        &mut |_| {},
    )
}

/// As [`certify`], without what parameters cannot change: for laws whose code is known, such as the shipped ones.
///
/// # Errors
/// As [`certify`].
pub fn certify_parameters(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&Loaded>,
    path: &SearchPath,
) -> Result<Certificate, LawError> {
    let checks = &border::OF_PARAMETERS;
    certify_telling(plugin, parameters, cohesion, path, checks, &mut |_| {})
}

fn certify_telling(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&Loaded>,
    path: &SearchPath,
    border: &[(&str, Check)],
    tell: &mut dyn FnMut(Event<'_>),
) -> Result<Certificate, LawError> {
    const SCALE: &str = "runs on the bench";
    plugin.validate(parameters)?;
    let mut book = Book {
        lines: Vec::new(),
        partner: String::new(),
        tell,
    };
    let rigs = Rig::all(plugin, parameters, cohesion, path)?;
    for (k, mut rig) in rigs.into_iter().enumerate() {
        if k == 0 && border.len() == border::CHECKS.len() {
            book.make(&mut rig, &[border::FIRST]);
            if book.lines.iter().any(|l| l.outcome == Outcome::Fail) {
                break;
            }
        }
        book.partner = rig.partner().to_owned();
        (book.tell)(Event::Begins(SCALE));
        match (rig.find_scale(), plugin.kind.spec().certificate.checks) {
            (Err(e), _) => book.write(Line::failed(SCALE, &e)),
            (Ok(()), CheckSet::Bond) if rig.opens() => book.make(&mut rig, &bond::CHECKS),
            (Ok(()), checks) => book.make(&mut rig, surface::checks(checks)),
        }
        if k == 0 {
            book.partner.clear();
            book.make(&mut rig, border);
        }
    }
    Ok(Certificate::of(plugin, book.lines))
}

impl Certificate {
    fn of(plugin: &Plugin, lines: Vec<Line>) -> Self {
        Self {
            kind: plugin.kind.to_string(),
            name: plugin.name.clone(),
            version: plugin.version.clone(),
            sha256: plugin.sha256.clone(),
            library: plugin.path.display().to_string(),
            lines,
        }
    }
}
