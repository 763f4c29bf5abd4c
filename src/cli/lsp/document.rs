//! An open file: its path and text, and places in it.

use lsp_types::{Position, Range, Uri};
use std::path::PathBuf;

/// An open file.
pub struct Document {
    /// Path of the file, or the name of a text that is in no file.
    pub path: PathBuf,
    /// The text in the editor.
    pub text: String,
}

impl Document {
    /// The file of an address.
    pub fn new(uri: &Uri, mut text: String) -> Self {
        // The byte order mark is no part of the first line.
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        let path = uri.path().as_estr().decode().into_string();
        let path = path.map_or_else(|_| uri.as_str().to_owned(), |path| path.into_owned());
        // `/C:/case.ron` on Windows.
        let drive = path.get(2..3) == Some(":") && cfg!(windows);
        let path = if drive { &path[1..] } else { &path };
        Self {
            path: PathBuf::from(path),
            text,
        }
    }

    /// Returns the byte of a position, whose columns count UTF-16 units.
    pub fn byte(&self, position: Position) -> usize {
        let lines = self.text.split_inclusive('\n');
        let start: usize = lines.take(position.line as usize).map(str::len).sum();
        let line = self.text[start..].split('\n').next().unwrap_or_default();
        let mut column = 0;
        for (at, c) in line.char_indices() {
            if column >= position.character as usize {
                return start + at;
            }
            column += c.len_utf16();
        }
        start + line.len()
    }

    /// Returns the position of a byte.
    pub fn position(&self, byte: usize) -> Position {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &self.text[..byte];
        let line = before.rsplit('\n').next().unwrap_or_default();
        let column: usize = line.chars().map(char::len_utf16).sum();
        Position::new(before.matches('\n').count() as u32, column as u32)
    }

    /// Returns the range of bytes.
    pub fn range(&self, span: &std::ops::Range<usize>) -> Range {
        Range::new(self.position(span.start), self.position(span.end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_utf_16_units() {
        let text = "(\n  a: \"\u{1f600}\u{b5}\", b\n)";
        let uri: Uri = "file:///tmp/a%20case.ron".parse().unwrap();
        let document = Document::new(&uri, text.to_owned());
        assert_eq!(document.path, PathBuf::from("/tmp/a case.ron"));
        let byte = text.find("b\n").unwrap();
        assert_eq!(document.position(byte), Position::new(1, 12));
        for (at, _) in text.char_indices() {
            assert_eq!(document.byte(document.position(at)), at);
        }
        assert_eq!(document.byte(Position::new(9, 9)), text.len());
    }
}
