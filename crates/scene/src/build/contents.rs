//! Complete content of a case: its own text in normal form, and the content of the files that it
//! names.

use super::LoadedCase;
use crate::source::{InputError, Node, Tree, ValueKind};
use std::collections::BTreeSet;
use std::path::Path;

impl LoadedCase {
    /// Returns the case in the spelling of [`Case::to_ron`](crate::Case::to_ron), and name and
    /// content of each file that one of its texts names: materials, parameters, profiles, meshes,
    /// samples, and the summary of another run. Two cases with equal contents are the same scene
    /// with the same laws, which is known without building it.
    ///
    /// # Errors
    /// The case cannot be written as text.
    pub fn contents(&self) -> Result<Vec<(String, Vec<u8>)>, InputError> {
        let case = self.case.to_ron()?;
        let tree = Tree::of(&case);
        let mut texts = BTreeSet::new();
        if let Some(root) = &tree.root {
            collect(root, &case, &mut texts);
        }
        let library = self.material_library();
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let mut out = Vec::new();
        for name in texts {
            if let Ok(source) = library.read(&name) {
                out.push((name.clone(), source.text().as_bytes().to_vec()));
            }
            let path = folder.join(&name);
            let path = if path.is_dir() {
                path.join("summary.json")
            } else if path.ends_with("results.h5") {
                path.with_file_name("summary.json")
            } else {
                path
            };
            if let Ok(bytes) = std::fs::read(path) {
                out.push((name, bytes));
            }
        }
        out.insert(0, ("case".to_owned(), case.into_bytes()));
        Ok(out)
    }
}

/// The texts in a value.
fn collect(node: &Node, text: &str, out: &mut BTreeSet<String>) {
    match &node.kind {
        ValueKind::Text => out.extend(node.string(text)),
        ValueKind::Group(group) => {
            for entry in &group.entries {
                collect(&entry.value, text, out);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use crate::load_text;

    const CASE: &str = r#"(
        name: "a", dimension: 2, time: (step: 1e-3, end: 0.1), materials: {"steel": "hard"}, interfaces: [],
        grains: [List(material: "steel", grains: [(at: [0.0, 0.0], radius: 0.01)])],
    )"#;

    /// Another spelling has the same contents; another value, or another text of a file, has
    /// different contents.
    #[test]
    fn contents_tell_cases_apart_and_not_spellings() {
        let folder = std::env::temp_dir().join(format!("fretwork-contents-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("materials")).unwrap();
        let material = folder.join("materials/hard.ron");
        let write = |density: &str| {
            let text = format!(r#"(density: (value: {density}, unit: "kg/m^3", source: "here"))"#);
            std::fs::write(&material, text).unwrap();
        };
        write("7800.0");
        let of = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
            let loaded = load_text("a.ron", CASE, &folder, &sets).unwrap();
            loaded.contents().unwrap()
        };
        let base = of(&[]);
        assert_eq!(base.len(), 2);
        assert_eq!(base, of(&["time.end=1e-1", "seed=0"]));
        assert_ne!(base, of(&["time.end=0.2"]));
        write("7900.0");
        assert_ne!(base, of(&[]));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
