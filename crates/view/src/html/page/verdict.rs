//! The verdict at the top of a page, and the warnings.

use super::escape;
use crate::html::folder::RunFolder;
use serde_json::Value;

/// The verdict of a run on itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// All checks passed, and the error of the headline is known and small.
    ErrorKnown,
    /// All checks passed; the error of the headline is large or not known.
    Consistent,
    /// All checks passed, and there are no notes, in a run of a version without grades.
    Trustworthy,
    /// All checks passed, with notes.
    Noted,
    /// A check failed.
    Not,
    /// The run did not end, or its summary is missing.
    Unknown,
}

impl Verdict {
    /// The verdict of a run.
    pub fn of(run: &RunFolder) -> Self {
        let notes = run.summary["warnings"]
            .as_array()
            .is_some_and(|w| !w.is_empty());
        match run.summary["grade"].as_str() {
            Some("error known") => return Self::ErrorKnown,
            Some("consistent") => return Self::Consistent,
            _ => {}
        }
        match run.summary["trustworthy"].as_bool() {
            Some(true) if notes => Self::Noted,
            Some(true) => Self::Trustworthy,
            Some(false) => Self::Not,
            None => Self::Unknown,
        }
    }

    /// CSS class of the verdict.
    pub fn class(self) -> &'static str {
        match self {
            Self::ErrorKnown | Self::Trustworthy => "good",
            Self::Consistent | Self::Noted => "noted",
            Self::Not => "bad",
            Self::Unknown => "unknown",
        }
    }

    /// Text of the verdict.
    pub fn words(self) -> &'static str {
        match self {
            Self::ErrorKnown => "Error known",
            Self::Consistent => "Consistent",
            Self::Trustworthy => "Trustworthy",
            Self::Noted => "Trustworthy, with notes",
            Self::Not => "Not trustworthy",
            Self::Unknown => "Not finished",
        }
    }

    fn sentence(self) -> &'static str {
        match self {
            Self::ErrorKnown => {
                "The ledgers close, the steps converged, every check passed, and the error of the main result is known \
                 and at most 5 %."
            }
            Self::Consistent => {
                "The ledgers close, the steps converged, and every check passed. The error of the main result is not \
                 known to be small."
            }
            Self::Trustworthy => {
                "The run finished, and every check of convergence, energy, motion and laws passed."
            }
            Self::Noted => {
                "The run finished, and every check of convergence, energy, motion and laws passed. Read the notes before \
                 using the numbers."
            }
            Self::Not => {
                "At least one check failed. What to change stands with each reason; results below may be wrong."
            }
            Self::Unknown => {
                "The run did not write its summary, so nothing was checked. What was recorded is shown as it is."
            }
        }
    }
}

fn texts(list: &Value) -> Vec<&str> {
    list.as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect()
}

/// Returns the verdict with its reasons, notes and gaps, the worst first.
pub(crate) fn html(run: &RunFolder, gaps: &[String]) -> String {
    let verdict = Verdict::of(run);
    let mut out = format!(
        "<div class=\"verdict {}\" role=\"status\">\n<p class=\"headline\">{}</p>\n<p>{}</p>\n",
        verdict.class(),
        verdict.words(),
        verdict.sentence()
    );
    let known = run.summary["grade_sentence"].as_str();
    if let Some(known) = known.filter(|_| verdict != Verdict::Unknown) {
        out += &format!("<p class=\"known\">{}.</p>\n", escape(&capital(known)));
    }
    if let Some(seeds) = run.summary["sample"]["seeds"].as_str() {
        out += &format!("<p class=\"known\">{}.</p>\n", with_code(&capital(seeds)));
    }
    let reasons = texts(&run.summary["reasons"]);
    let warnings = texts(&run.summary["warnings"]);
    let notes = warnings.iter().filter(|w| !reasons.contains(w));
    let mut items: Vec<(&str, &str)> = reasons.iter().map(|r| ("reason", *r)).collect();
    items.extend(gaps.iter().map(|g| ("gap", g.as_str())));
    items.extend(notes.map(|n| ("note", *n)));
    // What comes after the third is folded: the picture and the main results follow.
    let shown = items.len().min(UNFOLDED);
    out += &list(&items[..shown]);
    let rest = &items[shown..];
    if !rest.is_empty() {
        out += &format!(
            "<details><summary>{} more</summary>\n{}</details>\n",
            rest.len(),
            list(rest)
        );
    }
    out + "</div>\n"
}

/// Number of warnings that are not folded.
const UNFOLDED: usize = 3;

fn list(items: &[(&str, &str)]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: String = items
        .iter()
        .map(|(class, text)| format!("<li class=\"{class}\">{}</li>\n", item(text)))
        .collect();
    format!("<ul class=\"warnings\">\n{items}</ul>\n")
}

/// A sentence that begins with a capital.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// Returns a warning with its keyword, as in `NOT CONVERGED: ...`, in bold.
pub(crate) fn item(text: &str) -> String {
    let key = text.split_once(':').filter(|(key, _)| {
        key.chars().all(|c| c.is_ascii_uppercase() || c == ' ') && !key.is_empty()
    });
    match key {
        Some((key, rest)) => format!("<strong>{}</strong>:{}", escape(key), with_code(rest)),
        None => with_code(text),
    }
}

/// A text whose parts between backticks are code.
fn with_code(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return escape(text);
    }
    let part = |(k, part): (usize, &&str)| match k % 2 {
        0 => escape(part),
        _ => format!("<code>{}</code>", escape(part)),
    };
    parts.iter().enumerate().map(part).collect()
}
