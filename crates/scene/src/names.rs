//! Names in a case that are also names of columns, files and groups of the results.

use super::case::Case;
use super::source::ValidationError;

/// Longest name (bytes) that is still a file name with all prefixes and suffixes.
const LONGEST: usize = 100;

/// Names that are devices on some systems, with any extension.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// Checks names that are used in columns and files: of bodies, materials, interfaces and phases.
/// Names of measures and of deformable bodies must be [words](word_fault).
///
/// # Errors
/// Returns the first invalid name, with its path.
pub(super) fn check(case: &Case) -> Result<(), ValidationError> {
    let bodies = case.bodies.iter().enumerate();
    let bodies = bodies.map(|(k, b)| (format!("bodies.{k}.name"), b.name.as_str()));
    let materials = case.materials.keys();
    let materials = materials.map(|name| (format!("materials.{name}"), name.as_str()));
    for (path, name) in bodies.chain(materials) {
        if let Some(fault) = fault(name) {
            return Err(ValidationError::new(path, fault));
        }
    }
    let interfaces = case.interfaces.iter().enumerate();
    let interfaces = interfaces.map(|(k, i)| (format!("interfaces.{k}.name"), &i.name));
    let phases = case.phases.iter().enumerate();
    let phases = phases.map(|(k, p)| (format!("phases.{k}.name"), &p.name));
    for (path, name) in interfaces.chain(phases) {
        if let Some(fault) = invisible_characters(name) {
            return Err(ValidationError::new(path, fault));
        }
    }
    Ok(())
}

/// Returns why a text cannot be a displayed name: it has characters that are invisible, or that
/// reverse or end lines.
pub fn invisible_characters(name: &str) -> Option<String> {
    let unseen = name.chars().find(|c| is_unseen(*c))?;
    let code = u32::from(unseen);
    Some(format!(
        "a name has no control, format or separator characters, such as the end of a line; this one has U+{code:04X}: leave it out"
    ))
}

/// Returns whether a character is a control character, a separator other than the space, or a
/// format character (the categories Cc, Z and Cf of Unicode).
fn is_unseen(c: char) -> bool {
    let separates = c.is_whitespace() && c != ' ';
    let formats = matches!(c,
        '\u{ad}' | '\u{600}'..='\u{605}' | '\u{61c}' | '\u{6dd}' | '\u{70f}' | '\u{890}' | '\u{891}' | '\u{8e2}' | '\u{180e}'
        | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}'
        | '\u{110bd}' | '\u{110cd}' | '\u{13430}'..='\u{1343f}' | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}'
        | '\u{e0001}' | '\u{e0020}'..='\u{e007f}');
    c.is_control() || separates || formats
}

/// Returns why a text cannot be the name of a body or a material, which is part of the names of
/// columns and files.
fn fault(name: &str) -> Option<String> {
    if let Some(fault) = invisible_characters(name) {
        return Some(fault);
    }
    let parts = "it is a part of the names of columns and files";
    if let Some(c) = name.chars().find(|c| r#"/\:*?"<>|"#.contains(*c)) {
        return Some(format!(
            "the name `{name}` has a `{c}`, and {parts}: leave it out"
        ));
    }
    let first = name.chars().next();
    let begins = first.is_some_and(|c| c.is_alphanumeric() || c == '_');
    if !begins || name.ends_with([' ', '.']) {
        return Some(format!(
            "`{name}` is no name, as {parts}: it begins with a letter, a digit or `_`, and does not end with a space or a point"
        ));
    }
    too_long(name).or_else(|| device(name))
}

/// Returns why a text cannot be a word that names columns and files.
pub(super) fn word_fault(name: &str) -> Option<String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || name.starts_with('-') || !name.chars().all(plain) {
        let message = "a name is made of letters, digits, `-` and `_`, and does not begin with `-`: it names columns and files";
        return Some(message.into());
    }
    too_long(name).or_else(|| device(name))
}

fn too_long(name: &str) -> Option<String> {
    let length = name.len();
    (length > LONGEST).then(|| {
        format!("a name has at most {LONGEST} bytes, as it names files; this one has {length}")
    })
}

fn device(name: &str) -> Option<String> {
    let stem = name.split('.').next().unwrap_or(name).to_ascii_lowercase();
    let numbered = |kind: &str| {
        let rest = stem.strip_prefix(kind);
        rest.is_some_and(|n| n.len() == 1 && n.bytes().all(|b| b.is_ascii_digit()))
    };
    let one = DEVICES.contains(&stem.as_str()) || numbered("com") || numbered("lpt");
    one.then(|| format!("`{name}` is a device on some systems, and no file; take another name"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_parts_of_names_of_files() {
        for good in [
            "floor",
            "roue élastique",
            "a (left), b.2",
            "3_x",
            "_a",
            "轮",
        ] {
            assert_eq!(fault(good), None, "{good}");
        }
        let long = "x".repeat(LONGEST + 1);
        let bad = [
            "wheel/rail",
            "/abs",
            "a\\b",
            "c:",
            "",
            ".",
            "..",
            ".hidden",
            "=1+1",
            "#a",
            "{a}",
            "$(x)",
            "'=1",
            "\u{3000}",
            "a\u{3000}b",
            "a\u{202e}b",
            "a\u{2028}b",
            "a\u{200b}",
            "\u{feff}a",
            "@x",
            "a\nb",
            "a ",
            "NUL",
            "com1.x",
            &long,
        ];
        for bad in bad {
            assert!(fault(bad).is_some(), "{bad:?}");
        }
        for bad in ["-a", "é", "a b", "a.b", "lpt9", &long] {
            assert!(word_fault(bad).is_some(), "{bad:?}");
        }
        assert_eq!(word_fault("com_1-x"), None);
    }

    #[test]
    fn names_that_are_shown_are_seen_as_they_are() {
        for good in ["", "a b", "=1+1", "roue élastique", "轮 (left)"] {
            assert_eq!(invisible_characters(good), None, "{good}");
        }
        let unseen = [
            '\n',
            '\t',
            '\u{85}',
            '\u{a0}',
            '\u{ad}',
            '\u{2028}',
            '\u{2029}',
            '\u{202e}',
            '\u{2066}',
            '\u{200b}',
            '\u{3000}',
            '\u{feff}',
            '\u{e0041}',
        ];
        for c in unseen {
            let said = invisible_characters(&format!("a{c}b")).unwrap_or_else(|| panic!("{c:?}"));
            assert!(said.contains(&format!("U+{:04X}", u32::from(c))), "{said}");
        }
    }
}
