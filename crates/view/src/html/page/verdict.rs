//! The verdict at the top of a page, and the warnings.

use super::escape;
use crate::html::folder::RunFolder;
use serde_json::Value;

/// The verdict of a run on itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// All checks passed, and there are no notes.
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
            Self::Trustworthy => "good",
            Self::Noted => "noted",
            Self::Not => "bad",
            Self::Unknown => "unknown",
        }
    }

    /// Text of the verdict.
    pub fn words(self) -> &'static str {
        match self {
            Self::Trustworthy => "Trustworthy",
            Self::Noted => "Trustworthy, with notes",
            Self::Not => "Not trustworthy",
            Self::Unknown => "Not finished",
        }
    }

    fn sentence(self) -> &'static str {
        match self {
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
    let reasons = texts(&run.summary["reasons"]);
    let warnings = texts(&run.summary["warnings"]);
    let notes = warnings.iter().filter(|w| !reasons.contains(w));
    let mut items: Vec<(&str, &str)> = reasons.iter().map(|r| ("reason", *r)).collect();
    items.extend(gaps.iter().map(|g| ("gap", g.as_str())));
    items.extend(notes.map(|n| ("note", *n)));
    if !items.is_empty() {
        out += "<ul class=\"warnings\">\n";
        for (class, text) in items {
            out += &format!("<li class=\"{class}\">{}</li>\n", item(text));
        }
        out += "</ul>\n";
    }
    out + "</div>\n"
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
