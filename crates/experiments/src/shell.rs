//! Words for a POSIX shell.

/// Returns a word, quoted where a shell would otherwise interpret it.
pub fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// Returns the words of a command as text.
pub fn command<'a>(words: impl IntoIterator<Item = &'a String>) -> String {
    let quoted: Vec<String> = words.into_iter().map(|w| quote(w)).collect();
    quoted.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_read_them_otherwise() {
        assert_eq!(quote("time.step=1e-4"), "time.step=1e-4");
        assert_eq!(quote("a case.ron"), "'a case.ron'");
        assert_eq!(quote("x=[\"it's\"]"), "'x=[\"it'\\''s\"]'");
        assert_eq!(quote(""), "''");
    }
}
