//! Names that a case gives and that columns, files and groups of the results take.

use super::case::Case;
use super::source::ValidationError;

/// Longest name (bytes): with what is put before and after it, it is still the name of a file.
const LONGEST: usize = 100;

/// Names that are devices on some systems, with any extension.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];

/// Checks names that stand in columns and files: of bodies, materials, interfaces and phases. Those of measures and of deformable
/// bodies are [words](word_fault).
///
/// # Errors
/// The first name that cannot be one, with its path.
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
        if name.chars().any(char::is_control) {
            return Err(ValidationError::new(path, CONTROL));
        }
    }
    Ok(())
}

const CONTROL: &str = "a name has no control characters, such as the end of a line";

/// Why a text cannot be the name of a body or a material: a part of the names of columns and files.
fn fault(name: &str) -> Option<String> {
    if name.chars().any(char::is_control) {
        return Some(CONTROL.into());
    }
    let parts = "it is a part of the names of columns and files";
    if let Some(c) = name.chars().find(|c| r#"/\:*?"<>|"#.contains(*c)) {
        return Some(format!(
            "the name `{name}` has a `{c}`, and {parts}: leave it out"
        ));
    }
    let begins = name.chars().next().is_some_and(|c| !".=+-@ ".contains(c));
    if !begins || name.ends_with([' ', '.']) {
        return Some(format!(
            "`{name}` is no name, as {parts}: it begins with a letter, a digit or `_`, and does not end with a space or a point"
        ));
    }
    too_long(name).or_else(|| device(name))
}

/// Why a text cannot be a word by which columns and files are named.
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
        for good in ["floor", "roue élastique", "a (left), b.2", "3_x"] {
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
}
