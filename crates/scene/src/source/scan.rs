//! Error-tolerant scanner from RON text to a [`Tree`].

use std::ops::Range;

use super::tree::{Entry, Group, MAX_DEPTH, Node, Shape, SyntaxError, Tree, ValueKind};
use crate::{quantity, units};

/// Scans `text`; the first malformed position is recorded and scanning continues.
pub(super) fn scan(text: &str) -> Tree {
    let mut scanner = Scanner {
        text,
        at: 0,
        fault: None,
        too_deep: None,
    };
    scanner.headers();
    let root = scanner.value(0);
    scanner.blank();
    if root.is_some() && scanner.at < text.len() {
        scanner.fault(scanner.here(), "unexpected text after the end of the value");
    }
    Tree {
        root,
        fault: scanner.fault,
        too_deep: scanner.too_deep,
    }
}

/// Whether `c` may start an identifier.
pub(super) fn starts_word(c: char) -> bool {
    c == '_' || c.is_alphabetic()
}

fn continues_word(c: char) -> bool {
    c == '_' || c.is_alphanumeric()
}

/// White space as defined by RON.
fn is_blank(c: char) -> bool {
    matches!(
        c,
        ' ' | '\t'..='\r' | '\u{85}' | '\u{200E}' | '\u{200F}' | '\u{2028}' | '\u{2029}'
    )
}

/// Whether a value may begin with a character.
fn begins_value(c: char) -> bool {
    c.is_ascii_digit() || matches!(c, '-' | '+' | '.' | '"' | '(' | '[' | '{') || starts_word(c)
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    fault: Option<SyntaxError>,
    too_deep: Option<usize>,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Returns the byte range of the next character.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.peek().map_or(0, char::len_utf8)
    }

    /// Records an error. Only the first is kept, since later ones are mostly consequences of it.
    fn fault(&mut self, span: Range<usize>, message: impl Into<String>) {
        self.record(span, message.into(), false);
    }

    /// Records an error that is the cause wherever the parser stops.
    fn cause(&mut self, span: Range<usize>, message: impl Into<String>) {
        self.record(span, message.into(), true);
    }

    fn record(&mut self, span: Range<usize>, message: String, cause: bool) {
        if self.fault.is_none() {
            self.fault = Some(SyntaxError {
                at: self.at,
                span,
                message,
                cause,
            });
        }
    }

    fn skip_while(&mut self, keep: impl Fn(char) -> bool) {
        let rest = self.rest();
        self.at += rest.find(|c| !keep(c)).unwrap_or(rest.len());
    }

    /// Skips white space and comments.
    fn blank(&mut self) {
        loop {
            self.skip_while(is_blank);
            if self.rest().starts_with("//") {
                self.skip_while(|c| c != '\n');
            } else if self.rest().starts_with("/*") {
                self.block_comment();
            } else {
                return;
            }
        }
    }

    fn block_comment(&mut self) {
        let start = self.at;
        let mut depth = 0_usize;
        while let Some(found) = self.rest().find(['/', '*']) {
            self.at += found;
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                self.at += 2;
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return;
                }
            } else {
                self.at += 1;
            }
        }
        self.at = start;
        self.fault(start..start + 2, "this comment is never closed by `*/`");
        self.at = self.text.len();
    }

    /// Skips `#![enable(...)]` and similar headers.
    fn headers(&mut self) {
        loop {
            self.blank();
            if !self.rest().starts_with('#') {
                return;
            }
            let start = self.at;
            loop {
                match self.peek() {
                    Some('"') => self.string(),
                    Some(']') => {
                        self.at += 1;
                        break;
                    }
                    Some(c) => self.at += c.len_utf8(),
                    None => {
                        self.fault(start..start + 1, "this `#![...]` header is never closed");
                        return;
                    }
                }
            }
        }
    }

    fn value(&mut self, depth: usize) -> Option<Node> {
        self.blank();
        let start = self.at;
        let kind = match self.peek()? {
            ')' | ']' | '}' | ',' | ':' => return None,
            '(' | '[' | '{' => return self.group(start, None, depth),
            '"' => {
                self.string();
                ValueKind::Text
            }
            '\'' => self.character(),
            '0'..='9' | '+' | '-' | '.' => self.number(),
            'r' if self.raw_string(1) => ValueKind::Text,
            'b' if self.rest().starts_with("br") && self.raw_string(2) => ValueKind::Other,
            'b' if self.rest().starts_with("b\"") => {
                self.at += 1;
                self.string();
                ValueKind::Other
            }
            'b' if self.rest().starts_with("b'") => {
                self.at += 1;
                self.character();
                ValueKind::Other
            }
            c if starts_word(c) => {
                self.word();
                let name = start..self.at;
                self.blank();
                if self.peek() == Some('(') {
                    return self.group(start, Some(name), depth);
                }
                self.at = name.end;
                match &self.text[name] {
                    "inf" | "NaN" | "inff32" | "inff64" | "NaNf32" | "NaNf64" => ValueKind::Number,
                    _ => ValueKind::Word,
                }
            }
            c => {
                self.unexpected(c);
                self.at += c.len_utf8();
                self.skip_while(|c| !is_blank(c) && !"()[]{},:\"'".contains(c));
                ValueKind::Other
            }
        };
        Some(Node {
            span: start..self.at,
            kind,
        })
    }

    /// Scans a number, with its unit if it has one.
    fn number(&mut self) -> ValueKind {
        let start = self.at;
        let (end, all) = quantity::parts(self.rest());
        let adjacent = &self.rest()[end..];
        // RON has types and bases as part of a number: `1.0f64`, `0x1f`.
        let typed = ["f", "i", "u"].iter().any(|kind| {
            let width = adjacent.strip_prefix(kind);
            width.is_some_and(|w| ["8", "16", "32", "64"].iter().any(|n| w.starts_with(n)))
        });
        let based = ["0x", "0b", "0o"]
            .iter()
            .any(|base| self.rest().trim_start_matches(['+', '-']).starts_with(base));
        // An exponent without digits is no unit.
        let exponent = all == end + 1 && adjacent.starts_with(['e', 'E']);
        if all > end && !typed && !based && !exponent {
            let blanks = adjacent.len() - adjacent.trim_start().len();
            self.at += all;
            return ValueKind::Quantity(start + end + blanks..self.at);
        }
        self.skip_while(|c| continues_word(c) || matches!(c, '.' | '+' | '-'));
        ValueKind::Number
    }

    /// Records a character that begins no value.
    fn unexpected(&mut self, c: char) {
        let message = match c {
            '#' => "a comment begins with `//`, not with `#`".to_owned(),
            '=' => "a name and its value have `:` between them, not `=`".to_owned(),
            ';' => "values have `,` between them, not `;`".to_owned(),
            '\u{201c}' | '\u{201d}' | '\u{201e}' | '\u{2018}' | '\u{2019}' | '\u{ab}' | '`' => {
                format!("a text has straight double quotes, `\"...\"`, not `{c}`")
            }
            '\u{2212}' | '\u{2013}' => format!("a minus is `-`, not `{c}`"),
            '$' => {
                let message = "an expression stands in quotes: `\"${...}\"`";
                self.cause(self.here(), message);
                return;
            }
            c => format!("unexpected character {c:?}"),
        };
        self.fault(self.here(), message);
    }

    /// Scans an identifier, raw (`r#name`) or plain, whose first character was checked by the
    /// caller.
    fn word(&mut self) {
        if self.rest().starts_with("r#") {
            self.at += 2;
            self.skip_while(|c| continues_word(c) || matches!(c, '.' | '+' | '-'));
        } else {
            self.skip_while(continues_word);
        }
    }

    fn string(&mut self) {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let mut at = start + 1;
        while let Some(byte) = bytes.get(at) {
            at += match byte {
                b'"' => {
                    self.at = at + 1;
                    return;
                }
                b'\\' => 2,
                _ => 1,
            };
        }
        self.fault(start..start + 1, "this string is never closed by `\"`");
        self.at = self.text.len();
    }

    /// Scans `#*"..."#*` after a prefix; returns false without advancing if there is none.
    fn raw_string(&mut self, prefix: usize) -> bool {
        let body = &self.rest()[prefix..];
        let hashes = body.bytes().take_while(|&byte| byte == b'#').count();
        if !body[hashes..].starts_with('"') {
            return false;
        }
        let open = prefix + hashes + 1;
        let close = format!("\"{}", &body[..hashes]);
        if let Some(found) = self.rest()[open..].find(&close) {
            self.at += open + found + close.len();
        } else {
            let span = self.at..self.at + open;
            self.fault(span, format!("this string is never closed by `{close}`"));
            self.at = self.text.len();
        }
        true
    }

    fn character(&mut self) -> ValueKind {
        let rest = self.rest();
        let body = &rest[1..];
        let length = if let Some(escape) = body.strip_prefix('\\') {
            let kind = escape.chars().next().map_or(0, char::len_utf8);
            escape[kind..].find('\'').map(|found| 1 + kind + found)
        } else {
            body.chars().next().map(char::len_utf8)
        };
        match length {
            Some(length) if length <= 12 && body[length..].starts_with('\'') => {
                self.at += length + 2;
                ValueKind::Char
            }
            _ => {
                let line = body.lines().next().unwrap_or_default();
                let text = line.split_once('\'').map(|(text, _)| text);
                let message = match text.filter(|text| !text.is_empty()) {
                    Some(text) => format!(
                        "a text has double quotes: write `\"{}\"`",
                        super::set::shorten(text)
                    ),
                    None => "this `'` begins a character and is never closed; a text has double quotes, `\"...\"`".to_owned(),
                };
                self.fault(self.here(), message);
                self.at += 1 + text.map_or(0, |text| text.len() + 1);
                ValueKind::Other
            }
        }
    }

    /// Scans a bracketed group; the next character is its opening bracket.
    fn group(&mut self, start: usize, name: Option<Range<usize>>, depth: usize) -> Option<Node> {
        if depth >= MAX_DEPTH {
            self.too_deep.get_or_insert(self.at);
            self.at = self.text.len();
            return None;
        }
        let open = self.at;
        let (opener, closer, mut shape) = match self.peek()? {
            '[' => ('[', ']', Shape::List),
            '{' => ('{', '}', Shape::Map),
            _ => ('(', ')', Shape::Tuple),
        };
        self.at += 1;
        let mut entries = Vec::new();
        loop {
            self.blank();
            match self.peek() {
                None => {
                    let message = format!("this `{opener}` is never closed by `{closer}`");
                    self.fault(open..open + 1, message);
                    break;
                }
                Some(c) if c == closer => {
                    self.at += 1;
                    break;
                }
                Some(c @ (')' | ']' | '}')) => {
                    let message = format!("`{c}` does not close the `{opener}` before it");
                    self.fault(self.here(), message);
                    // The bracket is not consumed: it most probably closes an outer group.
                    break;
                }
                Some(c @ (',' | ':')) => {
                    self.fault(self.here(), format!("a value is missing before this `{c}`"));
                    self.at += 1;
                    continue;
                }
                Some(_) => {}
            }
            if let Some(entry) = self.entry(shape, depth + 1) {
                if entry.key.is_some() && shape == Shape::Tuple {
                    shape = Shape::Struct;
                }
                entries.push(entry);
            }
            self.blank();
            match self.peek() {
                Some(',') => {
                    self.at += 1;
                    self.decimal_comma(&entries, shape, name.is_some());
                }
                Some(')' | ']' | '}') | None => {}
                // A list has no names, so that an earlier list was not closed.
                Some(':') if shape == Shape::List => {
                    let message = format!("this `{opener}` is not closed by `{closer}`");
                    self.cause(open..open + 1, message);
                }
                Some(_) => self.separator(entries.last(), shape),
            }
        }
        entries.shrink_to_fit();
        Some(Node {
            span: start..self.at,
            kind: ValueKind::Group(Box::new(Group {
                shape,
                name,
                open,
                entries,
            })),
        })
    }

    /// Records what stands after a value in place of a comma.
    fn separator(&mut self, before: Option<&Entry>, shape: Shape) {
        let word = before.filter(|e| e.key.is_none() && matches!(e.value.kind, ValueKind::Word));
        let name = word.map(|e| &self.text[e.value.span.clone()]);
        let kind = before.map(|e| &e.value.kind);
        let number = matches!(kind, Some(ValueKind::Number));
        let written = before.map(|e| &self.text[e.value.span.clone()]);
        let text = written.filter(|_| matches!(kind, Some(ValueKind::Text)));
        let variant = written.filter(|_| matches!(kind, Some(ValueKind::Word)));
        let named = matches!(shape, Shape::Tuple | Shape::Struct);
        let next = self.peek();
        let symbol = matches!(next, Some('=' | ';' | '#'));
        let message = match (next, name) {
            (Some(c), _) if symbol => return self.skip_unexpected(c),
            (Some(sign @ ('/' | '*')), _) if number => self.after_number(sign, written),
            (Some(c), Some(name)) if named && begins_value(c) => {
                format!("a colon is missing after `{name}`")
            }
            (Some(c), None) if variant.is_some() && (c.is_ascii_digit() || "+-.".contains(c)) => {
                let variant = variant.unwrap_or_default();
                format!("the value of `{variant}` stands in parentheses: `{variant}(...)`")
            }
            (Some(_), None) if text.is_some_and(|text| text.contains('\n')) => {
                let begins = before.map_or(0, |e| e.value.span.start);
                let message = "this text runs over several lines: is its closing `\"` missing?";
                return self.fault(begins..begins + 1, message);
            }
            _ => "a comma is missing before this".to_owned(),
        };
        self.fault(self.here(), message);
    }

    /// Says what to write for a number with an operation after it, `1e-13/Pa` or `1/1000`.
    fn after_number(&self, sign: char, number: Option<&str>) -> String {
        let number = number.unwrap_or_default();
        let rest = &self.rest()[1..];
        let word = match rest.starts_with('(') {
            true => rest.find(')').map(|end| end + 1),
            false => rest.find(|c: char| is_blank(c) || "()[]{},:\"'/*".contains(c)),
        };
        let unit = &rest[..word.unwrap_or(rest.len())];
        let named = unit.starts_with(|c: char| c.is_alphabetic() || c == '(');
        match sign == '/' && named && units::known(&format!("1/{unit}")).is_ok() {
            true => format!(
                "a unit stands after a blank, and begins with 1 here: write `{number} 1/{unit}`"
            ),
            false => "a value is one number, without arithmetic: write the result".to_owned(),
        }
    }

    /// Records a decimal comma, `step: 0,001`: digits follow it directly where a name must follow.
    fn decimal_comma(&mut self, entries: &[Entry], shape: Shape, variant: bool) {
        let Some(entry) = entries.last() else { return };
        let named = shape == Shape::Struct && entry.key.is_some();
        let alone = shape == Shape::Tuple && variant && entries.len() == 1;
        let number = matches!(entry.value.kind, ValueKind::Number);
        let follows = entry.value.span.end + 1 == self.at;
        let digits = self.peek().is_some_and(|c| c.is_ascii_digit());
        if !(number && follows && digits && (named || alone)) {
            return;
        }
        let length = quantity::parts(self.rest()).0;
        let (start, end) = (entry.value.span.start, self.at + length);
        let written = &self.text[start..end];
        let message = format!(
            "`{written}` has a decimal comma; write `{}`",
            written.replacen(',', ".", 1)
        );
        self.cause(start..end, message);
    }

    /// Records a character that stands for another, and what is after it as a value of its own; a
    /// comment up to the end of its line.
    fn skip_unexpected(&mut self, c: char) {
        self.unexpected(c);
        if c == '#' {
            self.skip_while(|c| c != '\n');
        } else {
            self.at += c.len_utf8();
        }
    }

    /// Scans one element: `name: value` in parentheses, `key: value` in braces, or a value.
    fn entry(&mut self, shape: Shape, depth: usize) -> Option<Entry> {
        let start = self.at;
        let key = match shape {
            Shape::List => None,
            Shape::Map => Some(self.value(depth)?.span),
            Shape::Tuple | Shape::Struct => self.field_name(),
        };
        if key.is_some() {
            self.blank();
            if self.peek() == Some(':') {
                self.at += 1;
            } else {
                self.fault(self.here(), "a colon is missing before this");
            }
        } else {
            self.at = start;
        }
        let Some(value) = self.value(depth) else {
            if let Some(key) = key {
                let message = format!("a value is missing after `{}:`", &self.text[key.clone()]);
                self.fault(key, message);
            }
            return None;
        };
        Some(Entry { key, value })
    }

    /// Returns the byte range of a field name that is followed by a colon, if there is one.
    fn field_name(&mut self) -> Option<Range<usize>> {
        let start = self.at;
        if !self.peek().is_some_and(starts_word) || self.rest().starts_with("r\"") {
            return None;
        }
        self.word();
        let name = start..self.at;
        self.blank();
        (self.peek() == Some(':')).then_some(name)
    }
}
