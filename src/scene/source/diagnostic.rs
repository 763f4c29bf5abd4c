//! An error in an input: what, where, what was expected, the nearest valid name.

use ariadne::{Config, IndexType, Label, Report, ReportKind, Source as Text};
use std::fmt;
use std::ops::Range;
use std::path::Path;

/// What is wrong with an input; shown with file, line and column.
#[derive(Clone, Debug)]
pub struct InputError(Box<Details>);

#[derive(Clone, Debug)]
struct Details {
    file: String,
    text: Option<String>,
    span: Range<usize>,
    message: String,
    expected: Option<String>,
    help: Option<String>,
}

impl InputError {
    /// At bytes of a text.
    pub fn at(file: &str, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let end = span.end.min(text.len());
        Self(Box::new(Details {
            file: file.to_owned(),
            text: Some(text.to_owned()),
            span: span.start.min(end)..end,
            message: message.into(),
            expected: None,
            help: None,
        }))
    }

    /// About a whole file or an argument.
    pub fn about(subject: impl fmt::Display, message: impl Into<String>) -> Self {
        Self(Box::new(Details {
            file: subject.to_string(),
            text: None,
            span: 0..0,
            message: message.into(),
            expected: None,
            help: None,
        }))
    }

    /// A file that cannot be read.
    pub fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        let why = match error.kind() {
            std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
            std::io::ErrorKind::PermissionDenied => "permission to read it is missing".to_owned(),
            std::io::ErrorKind::IsADirectory => "it is a folder, not a file".to_owned(),
            _ => error.to_string(),
        };
        Self::about(path.display(), format!("cannot be read: {why}"))
    }

    /// Adds what was expected.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.0.expected = Some(expected.into());
        self
    }

    /// Adds a proposal.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.0.help = Some(help.into());
        self
    }

    /// Proposes a name, where there is one near enough.
    #[must_use]
    pub fn did_you_mean(self, name: Option<&str>) -> Self {
        match name {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// Line and column, from 1, in characters.
    pub fn position(&self) -> Option<(usize, usize)> {
        let text = self.0.text.as_deref()?;
        let before = text.get(..self.0.span.start)?;
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        Some((line, column))
    }

    /// The message alone.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// One line for machines, then the place in the text for people.
    pub fn render(&self, colour: bool) -> String {
        let mut out = self.to_string();
        let Some(text) = &self.0.text else { return out };
        let file = self.0.file.as_str();
        // ariadne wants a character to point at.
        let mut span = self.0.span.clone();
        if span.is_empty() {
            span.end = (span.start + 1).min(text.len());
        }
        let config = Config::default()
            .with_color(colour)
            .with_index_type(IndexType::Byte);
        let label = self
            .0
            .expected
            .as_ref()
            .map_or("here".to_owned(), |e| format!("expected {e}"));
        let report = Report::build(ReportKind::Error, (file, span.clone()))
            .with_config(config)
            .with_message(&self.0.message)
            .with_label(Label::new((file, span)).with_message(label))
            .finish();
        let mut picture = Vec::new();
        if report
            .write((file, Text::from(text.as_str())), &mut picture)
            .is_ok()
        {
            out.push('\n');
            out.push_str(String::from_utf8_lossy(&picture).trim_end());
        }
        out
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let d = &self.0;
        match self.position() {
            Some((line, column)) => write!(f, "{}:{line}:{column}: error: {}", d.file, d.message)?,
            None => write!(f, "{}: error: {}", d.file, d.message)?,
        }
        if let Some(expected) = &d.expected {
            write!(f, "; expected {expected}")?;
        }
        if let Some(help) = &d.help {
            write!(f, "; {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for InputError {}

/// The candidate that a misspelt name most likely means, if any is near.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let fold = |s: &str| s.to_lowercase().replace(['-', '_', ' '], "");
    let wanted = fold(name);
    candidates
        .into_iter()
        .map(|c| (strsim::damerau_levenshtein(&fold(c), &wanted), c))
        .min()
        .filter(|(distance, c)| *distance <= (c.chars().count().max(3)) / 2)
        .map(|(_, c)| c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "(\n  µ: 1,\n  é: x,\n)";
        let at = text.find('x').unwrap();
        let error = InputError::at("a.ron", text, at..at + 1, "wrong");
        assert_eq!(error.position(), Some((3, 6)));
        assert_eq!(error.to_string(), "a.ron:3:6: error: wrong");
        assert!(error.render(false).contains("é: x"));
    }

    #[test]
    fn near_names_are_offered_and_far_ones_not() {
        let names = ["frequency", "amplitude", "elastic-bond"];
        assert_eq!(nearest("amplitud", names), Some("amplitude"));
        assert_eq!(nearest("Elastic_Bond", names), Some("elastic-bond"));
        assert_eq!(nearest("zzz", names), None);
    }
}
