//! Where things stand in a RON text: a tree of nodes with byte spans, addressed by dotted paths.

use std::ops::Range;

/// Deepest nesting accepted.
pub const MOST_LEVELS: usize = 64;

/// A value in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Bytes of the value, its variant's name included.
    pub span: Range<usize>,
    /// What stands inside.
    pub inside: Inside,
}

/// The content of a node.
#[derive(Clone, Debug, PartialEq)]
pub enum Inside {
    /// A number, text, word.
    Scalar,
    /// Named members, with the span of each name and the byte after the opening bracket.
    Members {
        members: Vec<(String, Range<usize>, Node)>,
        open: usize,
        quoted: bool,
    },
    /// A list or tuple.
    Items(Vec<Node>),
}

/// The text is nested too deeply (byte where it happens).
#[derive(Debug, PartialEq)]
pub struct TooDeep(pub usize);

/// Reads a text as far as it can be understood; `ron` reports what is malformed.
///
/// # Errors
/// More than [`MOST_LEVELS`] levels.
pub fn read(text: &str) -> Result<Node, TooDeep> {
    let mut scanner = Scanner {
        bytes: text.as_bytes(),
        at: 0,
    };
    scanner.skip();
    while scanner.peek() == Some(b'#') {
        // #![enable(...)]
        while scanner.peek().is_some_and(|c| c != b']') {
            scanner.at += 1;
        }
        scanner.at += 1;
        scanner.skip();
    }
    scanner.value(0)
}

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
}

fn is_word(c: u8) -> bool {
    c.is_ascii_alphanumeric() || c == b'_'
}

impl Scanner<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn starts(&self, text: &str) -> bool {
        self.bytes[self.at.min(self.bytes.len())..].starts_with(text.as_bytes())
    }

    /// White space and comments.
    fn skip(&mut self) {
        loop {
            if self.starts("//") {
                while self.peek().is_some_and(|c| c != b'\n') {
                    self.at += 1;
                }
            } else if self.starts("/*") {
                let mut depth = 0;
                while self.at < self.bytes.len() {
                    if self.starts("/*") {
                        depth += 1;
                        self.at += 2;
                    } else if self.starts("*/") {
                        depth -= 1;
                        self.at += 2;
                        if depth == 0 {
                            break;
                        }
                    } else {
                        self.at += 1;
                    }
                }
            } else if self.peek().is_some_and(|c| c.is_ascii_whitespace()) {
                self.at += 1;
            } else {
                return;
            }
        }
    }

    fn word(&mut self) -> String {
        let start = self.at;
        while self.peek().is_some_and(is_word) {
            self.at += 1;
        }
        String::from_utf8_lossy(&self.bytes[start..self.at]).into_owned()
    }

    fn string(&mut self) {
        self.at += 1;
        while let Some(c) = self.peek() {
            self.at += 1;
            match c {
                b'\\' => self.at += 1,
                b'"' => return,
                _ => {}
            }
        }
    }

    fn raw_string(&mut self) {
        self.at += 1;
        let start = self.at;
        while self.peek() == Some(b'#') {
            self.at += 1;
        }
        let end = format!("\"{}", "#".repeat(self.at - start));
        self.at += 1;
        while self.at < self.bytes.len() && !self.starts(&end) {
            self.at += 1;
        }
        self.at += end.len();
    }

    fn value(&mut self, level: usize) -> Result<Node, TooDeep> {
        if level > MOST_LEVELS {
            return Err(TooDeep(self.at));
        }
        self.skip();
        let start = self.at;
        let inside = match self.peek() {
            Some(b'"') => {
                self.string();
                Inside::Scalar
            }
            Some(b'r') if self.starts("r\"") || self.starts("r#") => {
                self.raw_string();
                Inside::Scalar
            }
            Some(b'(') => self.bracket(b')', level)?,
            Some(b'[') => self.bracket(b']', level)?,
            Some(b'{') => self.bracket(b'}', level)?,
            Some(c) if c.is_ascii_alphabetic() || c == b'_' => {
                self.word();
                let end = self.at;
                self.skip();
                if self.peek() == Some(b'(') {
                    self.bracket(b')', level)?
                } else {
                    self.at = end;
                    Inside::Scalar
                }
            }
            _ => {
                while self
                    .peek()
                    .is_some_and(|c| !c.is_ascii_whitespace() && !b",)]}:".contains(&c))
                {
                    self.at += 1;
                }
                Inside::Scalar
            }
        };
        let end = self.at.min(self.bytes.len());
        Ok(Node {
            span: start.min(end)..end,
            inside,
        })
    }

    fn bracket(&mut self, close: u8, level: usize) -> Result<Inside, TooDeep> {
        self.at += 1;
        let open = self.at;
        let mut members = Vec::new();
        let mut items = Vec::new();
        loop {
            self.skip();
            match self.peek() {
                None => break,
                Some(c) if c == close => {
                    self.at += 1;
                    break;
                }
                Some(b',') => {
                    self.at += 1;
                    continue;
                }
                Some(b')' | b']' | b'}' | b':') => {
                    // Malformed: ron will say so.
                    self.at += 1;
                    continue;
                }
                Some(_) => {}
            }
            let before = self.at;
            let first = self.value(level + 1)?;
            self.skip();
            if self.peek() == Some(b':') && close != b']' {
                self.at += 1;
                let name = String::from_utf8_lossy(&self.bytes[first.span.clone()])
                    .trim_matches('"')
                    .to_owned();
                let value = self.value(level + 1)?;
                members.push((name, first.span, value));
            } else {
                items.push(first);
            }
            if self.at == before {
                self.at += 1;
            }
        }
        self.at = self.at.min(self.bytes.len());
        if members.is_empty() && (close != b'}' && !items.is_empty() || close == b']') {
            return Ok(Inside::Items(items));
        }
        Ok(Inside::Members {
            members,
            open,
            quoted: close == b'}',
        })
    }
}

impl Node {
    /// The member or item of this name: a member, an index, or the item whose `name` member is this.
    pub fn child<'a>(&'a self, name: &str, text: &str) -> Option<&'a Node> {
        match &self.inside {
            Inside::Scalar => None,
            Inside::Members { members, .. } => members.iter().find(|m| m.0 == name).map(|m| &m.2),
            Inside::Items(items) => {
                if let Ok(k) = name.parse::<usize>() {
                    return items.get(k);
                }
                let named = items.iter().find(|item| {
                    item.child("name", text)
                        .is_some_and(|n| text[n.span.clone()].trim_matches('"') == name)
                });
                // Some(x), Sine(...): a single value is transparent.
                named.or_else(|| match items.as_slice() {
                    [only] => only.child(name, text),
                    _ => None,
                })
            }
        }
    }

    /// The names one step down.
    pub fn children(&self, text: &str) -> Vec<String> {
        match &self.inside {
            Inside::Scalar => Vec::new(),
            Inside::Members { members, .. } => members.iter().map(|m| m.0.clone()).collect(),
            Inside::Items(items) => items
                .iter()
                .enumerate()
                .map(|(k, item)| match item.child("name", text) {
                    Some(n) => text[n.span.clone()].trim_matches('"').to_owned(),
                    None => k.to_string(),
                })
                .collect(),
        }
    }

    /// Follows a dotted path as far as it goes: the deepest node and how many components were used.
    pub fn follow<'a>(&'a self, path: &[&str], text: &str) -> (&'a Node, usize) {
        let mut node = self;
        for (k, name) in path.iter().enumerate() {
            match node.child(name, text) {
                Some(child) => node = child,
                None => return (node, k),
            }
        }
        (node, path.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASE: &str = "#![enable(implicit_some)]\n// (a comment: {\nCase(\n  a: 1.5, /* [ */ b: \"x ( y\",\n  list: [(name: \"wheel\", m: 2), (name: \"rail\", m: 3)],\n  f: Sine(amplitude: 2e-5, frequency: 50),\n  g: Some(Ramp((from: 1))), h: {\"mu\": 0.3},\n)";

    fn at(path: &str) -> &'static str {
        let tree = read(CASE).unwrap();
        let parts: Vec<&str> = path.split('.').collect();
        let (node, used) = tree.follow(&parts, CASE);
        assert_eq!(used, parts.len(), "{path}");
        &CASE[node.span.clone()]
    }

    #[test]
    fn paths_lead_to_values() {
        assert_eq!(at("a"), "1.5");
        assert_eq!(at("b"), "\"x ( y\"");
        assert_eq!(at("list.1.m"), "3");
        assert_eq!(at("list.wheel.m"), "2");
        assert_eq!(at("f.frequency"), "50");
        assert_eq!(at("g.from"), "1");
        assert_eq!(at("h.mu"), "0.3");
    }

    #[test]
    fn depth_is_bounded() {
        assert!(read(&"(".repeat(100_000)).is_err());
    }

    #[test]
    fn garbage_is_survived() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        for _ in 0..5000 {
            let mut bytes = CASE.as_bytes().to_vec();
            for _ in 0..rng.random_range(1..6) {
                let k = rng.random_range(0..bytes.len());
                bytes[k] = b"(){}[],:\"#/*r\\ a0"[rng.random_range(0..17)];
            }
            let _ = read(&String::from_utf8_lossy(&bytes));
        }
    }
}
