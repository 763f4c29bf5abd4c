//! Sanitizing of text from files and plugins before it is printed to a terminal.
//!
//! A title with escape sequences could clear the screen, set the window's title or hide lines of
//! the output; bidirectional control characters could display other words than the file contains.

/// Returns whether a terminal interprets a character as a control sequence, or as a change of text
/// direction.
pub fn commands_a_terminal(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Returns the text on one line, with such characters replaced by blanks.
pub fn clean(text: &str) -> String {
    let plain = |c| if commands_a_terminal(c) { ' ' } else { c };
    text.chars().map(plain).collect()
}

/// Replaces control characters except line breaks and tabs by spaces.
pub fn clean_lines(text: &str) -> String {
    let plain = |c| match c {
        '\n' | '\t' => c,
        c if commands_a_terminal(c) => ' ',
        c => c,
    };
    text.chars().map(plain).collect()
}

/// Returns JSON with such characters escaped: `serde_json` does not escape characters beyond ASCII.
pub fn clean_json(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if c != '\n' && commands_a_terminal(c) {
            out.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            out.push(c);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_commands_the_terminal() {
        let title = "a\u{1b}[2Jb\u{9b}31mc\rd\u{202e}e\u{7f}";
        assert_eq!(clean(title), "a [2Jb 31mc d e ");
        assert_eq!(clean_lines("a\tb\nc\u{1b}]0;x\u{7}"), "a\tb\nc ]0;x ");
        let json = serde_json::to_string(title).unwrap_or_default();
        let clean = clean_json(&json);
        assert!(!clean.chars().any(commands_a_terminal));
        assert_eq!(
            serde_json::from_str::<String>(&clean).ok().as_deref(),
            Some(title)
        );
    }
}
