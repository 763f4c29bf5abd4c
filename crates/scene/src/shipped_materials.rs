//! The shipped material files, compiled into the program for use when they are not found beside a
//! case.

/// Names and texts of `materials/*.ron`, in the order of the names: the list is made by `build.rs`.
pub const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shipped_materials.rs"));

/// Returns the text of a shipped file by its name.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|f| f.0 == name).map(|f| f.1)
}

#[cfg(test)]
mod tests {
    #[test]
    fn all_shipped_files_are_kept() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../materials");
        let mut files: Vec<(String, String)> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| {
                let path = entry.unwrap().path();
                let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
                (name, std::fs::read_to_string(path).unwrap())
            })
            .collect();
        files.sort();
        assert!(files.len() > 40);
        let kept = super::FILES.iter();
        let kept: Vec<_> = kept.map(|f| (f.0.to_owned(), f.1.to_owned())).collect();
        assert_eq!(kept, files);
    }
}
