//! What a law promises, tested on the one-contact bench.
//!
//! A law is composed with plain partners (frictionless contact, a linear bond), driven along paths at the
//! opening where it does something, and each promise gives a line: kept, broken or not made, with the
//! number that decided.

mod bond;
mod border;
mod rig;
mod surface;

use crate::laws::{Kind, LawError, Loaded, Plugin, SearchPath};
use rig::Rig;
use serde::Serialize;

/// How a promise came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
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
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Its name.
    pub check: &'static str,
    /// How it came out.
    pub outcome: Outcome,
    /// The number that decided; what it is, the text says.
    pub number: f64,
    /// What was measured.
    pub text: String,
}

impl Line {
    fn judged(check: &'static str, kept: bool, number: f64, text: impl Into<String>) -> Self {
        let outcome = if kept { Outcome::Pass } else { Outcome::Fail };
        Self {
            check,
            outcome,
            number,
            text: text.into(),
        }
    }

    /// Kept when the number is at most `limit`.
    fn below(check: &'static str, number: f64, limit: f64, text: impl Into<String>) -> Self {
        let text = format!("{}; at most {limit:e}", text.into());
        Self::judged(check, number <= limit, number, text)
    }

    fn skip(check: &'static str, why: impl Into<String>) -> Self {
        Self {
            check,
            outcome: Outcome::Skip,
            number: 0.0,
            text: why.into(),
        }
    }

    fn failed(check: &'static str, e: &LawError) -> Self {
        Self::judged(check, false, f64::INFINITY, e.to_string())
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
    plugin.validate(parameters)?;
    let mut lines = Vec::new();
    let kind = plugin.kind;
    for (k, mut rig) in Rig::all(plugin, parameters, cohesion, path)?
        .into_iter()
        .enumerate()
    {
        let scale = match rig.find_scale() {
            Ok(()) => Ok(()),
            Err(e) => Err(Line::failed("runs on the bench", &e)),
        };
        let found = match (scale, kind) {
            (Err(line), _) => vec![line],
            (Ok(()), Kind::Cohesion | Kind::Damage) if rig.opens() => bond::checks(&mut rig),
            (Ok(()), _) => surface::checks(&mut rig),
        };
        let partner = rig.partner().to_owned();
        lines.extend(found.into_iter().map(|line| Line {
            text: format!("{}{partner}", line.text),
            ..line
        }));
        if k == 0 {
            lines.extend(border::checks(&mut rig));
        }
    }
    Ok(Certificate {
        kind: kind.to_string(),
        name: plugin.name.clone(),
        version: plugin.version.clone(),
        sha256: plugin.sha256.clone(),
        library: plugin.path.display().to_string(),
        lines,
    })
}
