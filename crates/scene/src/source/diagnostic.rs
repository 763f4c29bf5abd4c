//! Errors in input files, with location, expected value and suggestion.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use ariadne::{Config, IndexType, Label, Report, ReportKind};

use super::nearest::nearest;

/// Length in characters above which lines are not shown, since the location could not be found in
/// them.
const LONGEST_LINE: usize = 400;

/// Number of lines of a text above which only the one-line form is given.
const MAX_LINES: usize = 200_000;

/// An error in an input, with its location.
///
/// Displayed as one line, `file:line:column: error: message; expected ...; help`, followed by the
/// source line with the location marked; see [`InputError::render`].
#[derive(Debug, Clone, thiserror::Error)]
#[error("{}", self.render(false))]
pub struct InputError {
    /// File or argument that contains the error.
    pub file: String,
    /// The line, from 1; 0 if the error has no location in a file.
    pub line: usize,
    /// The column in characters, from 1; 0 if there is no line.
    pub column: usize,
    /// Description of the error.
    pub message: String,
    /// Description of valid input.
    pub expected: Option<String>,
    /// A suggestion, such as "did you mean `mu`?".
    pub help: Option<String>,
    context: Box<Context>,
}

#[derive(Debug, Clone, Default)]
struct Context {
    text: Option<Arc<str>>,
    span: Range<usize>,
    /// The `--set` argument that contained the text, and the byte range in it.
    set: Option<(String, Range<usize>)>,
    note: Option<String>,
}

impl InputError {
    /// Makes an error at the bytes `span` of a text.
    pub fn at(file: &str, text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        Self::within(file, text.into(), span, message.into())
    }

    /// Creates an error at a range of bytes of a shared text.
    pub(super) fn within(file: &str, text: Arc<str>, span: Range<usize>, message: String) -> Self {
        let start = boundary(&text, span.start);
        let span = start..boundary(&text, span.end).max(start);
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self {
            file: file.into(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message,
            expected: None,
            help: None,
            context: Box::new(Context {
                text: Some(text),
                span,
                ..Context::default()
            }),
        }
    }

    /// Makes an error about a whole file or argument.
    pub fn about(subject: impl fmt::Display, message: impl Into<String>) -> Self {
        Self {
            file: subject.to_string(),
            line: 0,
            column: 0,
            message: message.into(),
            expected: None,
            help: None,
            context: Box::default(),
        }
    }

    /// Makes an error about a command line argument, quoted as written.
    pub fn argument(argument: impl fmt::Display, message: impl Into<String>) -> Self {
        Self::about(argument, message)
    }

    /// Makes an error for a file that cannot be read; suggests a file of a similar name.
    pub fn file(path: &Path, error: &std::io::Error) -> Self {
        use std::io::ErrorKind;
        let why = match error.kind() {
            ErrorKind::NotFound => "there is no such file".to_owned(),
            ErrorKind::PermissionDenied => "permission to read it is missing".to_owned(),
            ErrorKind::IsADirectory => "it is a folder, not a file".to_owned(),
            _ => error.to_string(),
        };
        let refused = Self::about(path.display(), format!("cannot be read: {why}"));
        match similar_file(path).filter(|_| error.kind() == ErrorKind::NotFound) {
            Some(similar) => refused.help(format!("did you mean `{similar}`?")),
            None => refused,
        }
    }

    /// Creates the error of a file that cannot be read.
    pub fn unreadable(path: &Path, error: &std::io::Error) -> Self {
        Self::file(path, error)
    }

    /// Adds a description of valid input.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    /// Adds a suggestion.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Suggests the nearest candidate if one is close enough.
    #[must_use]
    pub fn did_you_mean(self, name: Option<&str>) -> Self {
        match name {
            Some(name) => self.help(format!("did you mean `{name}`?")),
            None => self,
        }
    }

    /// Adds a remark, shown below the source line.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.context.note = Some(note.into());
        self
    }

    /// Records that the text came from these bytes of a `--set` argument.
    #[must_use]
    pub(super) fn brought_by(mut self, argument: &str, span: Range<usize>) -> Self {
        self.context.set = Some((argument.to_owned(), span));
        self
    }

    /// Returns the message without its location.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Returns line and column, if the error has a location in a file.
    pub fn position(&self) -> Option<(usize, usize)> {
        (self.line > 0).then_some((self.line, self.column))
    }

    /// Returns file and message, for use within another message.
    pub fn in_short(&self) -> String {
        super::clean(&format!("{} {}", self.file, self.message))
    }

    /// Returns file, message and suggestion in one line.
    pub fn in_a_sentence(&self) -> String {
        match &self.help {
            Some(help) => format!("{}; {}", self.in_short(), super::clean(help)),
            None => self.in_short(),
        }
    }

    /// Returns file, line and message, for use as the end of another message.
    pub fn with_line(&self) -> String {
        let line = self.position().map(|(line, _)| format!(" line {line}:"));
        let text = format!(
            "{}:{} {}",
            self.file,
            line.unwrap_or_default(),
            self.message
        );
        super::clean(&text)
    }

    /// Returns whether the error concerns a whole file: it is missing, unreadable or empty.
    pub fn is_about_a_whole_file(&self) -> bool {
        self.context
            .text
            .as_ref()
            .is_none_or(|text| text.is_empty())
    }

    /// Returns the byte range in the file, if the error has a location in a file.
    pub fn span(&self) -> Option<Range<usize>> {
        (self.line > 0).then(|| self.context.span.clone())
    }

    /// Returns the `--set` argument that contained the text.
    pub fn set(&self) -> Option<&str> {
        self.context.set.as_ref().map(|(set, _)| set.as_str())
    }

    /// Returns the error on one line.
    pub fn compact(&self) -> String {
        self.one_line("error")
    }

    /// Returns on one line what is no error, but to be looked at.
    pub fn as_doubt(&self) -> String {
        self.one_line("doubt")
    }

    fn one_line(&self, kind: &str) -> String {
        let mut line = match self.position() {
            Some((line, column)) => format!("{}:{line}:{column}: ", self.file),
            None => format!("{}: ", self.file),
        };
        line.push_str(&format!("{kind}: {}", self.message));
        if let Some(set) = self.set() {
            line.push_str(&format!(" (from `--set {set}`)"));
        }
        for part in [
            self.expected
                .as_ref()
                .map(|expected| format!("expected {expected}")),
            self.help.clone(),
        ]
        .iter()
        .flatten()
        {
            line.push_str("; ");
            line.push_str(part);
        }
        super::clean(&line)
    }

    /// Returns the error on one line, followed by the source line with the location marked; with
    /// terminal colours if `colour`.
    pub fn render(&self, colour: bool) -> String {
        let mut out = if colour {
            let line = self.compact();
            line.replacen(" error: ", " \x1b[1;31merror:\x1b[0m ", 1)
        } else {
            self.compact()
        };
        let label = match &self.expected {
            Some(expected) => format!("expected {expected}"),
            None => "here".to_owned(),
        };
        let context = &*self.context;
        let mut pictures = Vec::new();
        if let Some((set, span)) = &context.set {
            let argument = format!("--set {set}");
            let span = span.start + 6..span.end + 6;
            pictures.push(picture(
                "command line",
                &argument,
                &span,
                &label,
                None,
                colour,
            ));
            if let Some(text) = &context.text {
                pictures.push(picture(
                    &self.file,
                    text,
                    &context.span,
                    "set here",
                    context.note.as_deref(),
                    colour,
                ));
            }
        } else if let Some(text) = &context.text {
            pictures.push(picture(
                &self.file,
                text,
                &context.span,
                &label,
                context.note.as_deref(),
                colour,
            ));
        }
        for drawn in pictures.iter().flatten() {
            out.push('\n');
            out.push_str(drawn);
        }
        out
    }
}

/// The source line with the location marked, as drawn by ariadne.
fn picture(
    file: &str,
    text: &str,
    span: &Range<usize>,
    label: &str,
    note: Option<&str>,
    colour: bool,
) -> Option<String> {
    let file = &*super::clean(file);
    let begin = boundary(text, span.start);
    let start = text[..begin].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[begin..]
        .find('\n')
        .map_or(text.len(), |length| begin + length);
    // Only this line is passed on. Characters that ariadne interprets as a line break, or a
    // terminal as a control sequence, are replaced by blanks one by one.
    let clean = |c: char| match c {
        '\t' => c,
        '\u{2028}' | '\u{2029}' => ' ',
        c if super::commands_a_terminal(c) => ' ',
        c => c,
    };
    let mut line: String = text[start..end].chars().map(clean).collect();
    if line.chars().count() > LONGEST_LINE {
        return None;
    }
    // A character to point at beyond the end of the line.
    line.push(' ');
    let from = text[start..begin].chars().count();
    let stop = boundary(text, span.end).clamp(begin, end);
    let to = from + text[begin..stop].chars().count().max(1);
    let number = text[..start].matches('\n').count();
    if number > MAX_LINES {
        return None;
    }
    // ariadne numbers the lines of its input, so the lines before are added as empty ones.
    line.insert_str(0, &"\n".repeat(number));
    let (from, to) = (from + number, to + number);
    let config = Config::default()
        .with_color(colour)
        .with_index_type(IndexType::Char);
    let mut report = Report::build(ReportKind::Error, (file, from..to))
        .with_config(config)
        .with_label(Label::new((file, from..to)).with_message(super::clean(label)));
    if let Some(note) = note {
        report = report.with_note(super::clean(note));
    }
    let lines = ariadne::Source::from(line);
    let mut drawn = Vec::new();
    report.finish().write((file, lines), &mut drawn).ok()?;
    let drawn = String::from_utf8(drawn).ok()?;
    // The first line repeats the one-line form and is dropped.
    let (_, body) = drawn.split_once('\n')?;
    let lines: Vec<&str> = body.lines().map(str::trim_end).collect();
    Some(lines.join("\n").trim_end().to_owned())
}

/// The last character boundary at or before byte `at`.
fn boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// Returns a file in the same folder with a name similar to that of the missing one.
fn similar_file(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let folder = path.parent()?;
    let listed = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let names: Vec<String> = std::fs::read_dir(listed)
        .ok()?
        .take(10_000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    let similar = nearest(name, names.iter().map(String::as_str))?;
    Some(folder.join(similar).display().to_string())
}
