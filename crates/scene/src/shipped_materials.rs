//! The shipped material files, compiled into the program for use when they are not found beside a
//! case.

/// Names and texts of `materials/*.ron`.
pub const FILES: [(&str, &str); 17] = [
    (
        "benchmark_grain",
        include_str!("../../../materials/benchmark_grain.ron"),
    ),
    ("clay", include_str!("../../../materials/clay.ron")),
    (
        "contact_polymer",
        include_str!("../../../materials/contact_polymer.ron"),
    ),
    (
        "contact_steel",
        include_str!("../../../materials/contact_steel.ron"),
    ),
    (
        "glass_bead",
        include_str!("../../../materials/glass_bead.ron"),
    ),
    ("granite", include_str!("../../../materials/granite.ron")),
    (
        "magnetite",
        include_str!("../../../materials/magnetite.ron"),
    ),
    (
        "molybdenum_disulfide",
        include_str!("../../../materials/molybdenum_disulfide.ron"),
    ),
    (
        "oxide_third_body",
        include_str!("../../../materials/oxide_third_body.ron"),
    ),
    (
        "rail_steel_r260",
        include_str!("../../../materials/rail_steel_r260.ron"),
    ),
    (
        "rail_steel_r350ht",
        include_str!("../../../materials/rail_steel_r350ht.ron"),
    ),
    ("sand", include_str!("../../../materials/sand.ron")),
    (
        "verification_grain",
        include_str!("../../../materials/verification_grain.ron"),
    ),
    (
        "verification_oxide",
        include_str!("../../../materials/verification_oxide.ron"),
    ),
    (
        "verification_rubber",
        include_str!("../../../materials/verification_rubber.ron"),
    ),
    (
        "verification_steel",
        include_str!("../../../materials/verification_steel.ron"),
    ),
    (
        "wheel_steel_er7",
        include_str!("../../../materials/wheel_steel_er7.ron"),
    ),
];

/// Returns the text of a shipped file by its name.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|f| f.0 == name).map(|f| f.1)
}

#[cfg(test)]
mod tests {
    #[test]
    fn all_shipped_files_are_kept() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../materials");
        let mut names: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|e| {
                e.unwrap()
                    .path()
                    .file_stem()
                    .unwrap()
                    .to_str()
                    .unwrap()
                    .to_owned()
            })
            .collect();
        names.sort();
        assert_eq!(names, super::FILES.map(|f| f.0));
    }
}
