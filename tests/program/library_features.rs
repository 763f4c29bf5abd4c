//! Crates that a program links with the library: those of each feature, and no others. The test
//! calls `cargo tree`, which reads the manifests and the lock file.

use std::collections::BTreeSet;
use std::process::Command;

/// Each feature with the features that it requires and a crate that only it links.
const FEATURES: [(&str, &[&str], &[&str]); 6] = [
    ("laws", &[], &["fretwork-laws"]),
    ("results", &[], &["fretwork-store", "rust-hdf5"]),
    (
        "view",
        &["results"],
        &[
            "fretwork-view",
            "ab_glyph",
            "epaint_default_fonts",
            "tiny-skia",
        ],
    ),
    ("experiments", &["view"], &["fretwork-experiments"]),
    ("parquet", &["experiments"], &["parquet"]),
    (
        "program",
        &["laws", "parquet"],
        &[
            "clap",
            "clap_complete",
            "clap_mangen",
            "indicatif",
            "lsp-server",
            "signal-hook",
        ],
    ),
];

/// All crates that the library links with some features.
fn linked(features: &str) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(env!("CARGO_MANIFEST_DIR"));
    cargo.args("tree --offline --package fretwork --edges normal --prefix none".split(' '));
    cargo.args(["--no-default-features", "--features", features]);
    let answer = cargo.output().unwrap();
    let error = String::from_utf8_lossy(&answer.stderr);
    assert!(answer.status.success(), "{error}");
    let tree = String::from_utf8(answer.stdout).unwrap();
    let names = tree.lines().filter_map(|line| line.split(' ').next());
    names.map(str::to_owned).collect()
}

/// A feature and all features that it requires.
fn asked(feature: &str) -> BTreeSet<&'static str> {
    let known = FEATURES.iter().find(|f| f.0 == feature);
    let (name, on, _) = known.unwrap_or_else(|| panic!("no feature {feature}"));
    on.iter().flat_map(|f| asked(f)).chain([*name]).collect()
}

#[test]
fn each_feature_brings_its_crates_and_the_library_none_of_them() {
    let sets = FEATURES.iter().map(|(name, ..)| asked(name));
    for features in sets.chain([BTreeSet::new(), BTreeSet::from(["laws", "results"])]) {
        let linked = linked(&features.iter().copied().collect::<Vec<_>>().join(","));
        assert!(linked.contains("fretwork-scene"), "{linked:?}");
        for (name, _, brings) in FEATURES {
            for library in brings {
                let found = linked.contains(*library);
                let wanted = features.contains(name);
                assert_eq!(found, wanted, "{library} with {features:?}");
            }
        }
    }
}

/// The features of the manifest are those of the page on the library.
#[test]
fn the_page_explains_each_feature() {
    let page = include_str!("../../docs/library.md");
    let manifest = include_str!("../../Cargo.toml");
    let features = manifest.split("[features]").nth(1).unwrap();
    let features = features.split("\n[").next().unwrap();
    let named = features.lines().filter_map(|line| line.split_once(" = ["));
    let named: BTreeSet<&str> = named.map(|(name, _)| name).collect();
    let known = FEATURES.iter().map(|f| f.0).chain(["default"]);
    assert_eq!(named, known.collect());
    for (feature, ..) in FEATURES {
        assert!(page.contains(&format!("| `{feature}` |")), "{feature}");
    }
}
