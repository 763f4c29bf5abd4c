//! The layers are crates, so an import upwards does not compile. This test reads their manifests,
//! so that no layer depends on one above it, and no library brings HDF5 or fonts into the core.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Crates that a crate of mathematics does not need.
const BESIDE_NUMBERS: [&str; 7] = [
    "rust-hdf5",
    "clap",
    "ron",
    "ariadne",
    "csv",
    "tiny-skia",
    "libloading",
];

/// Each layer, the layers that it may name, and libraries that must not be among its direct or
/// indirect dependencies.
const LAYERS: [(&str, &[&str], &[&str]); 10] = [
    ("math", &[], &BESIDE_NUMBERS),
    (
        "core",
        &["math"],
        &[
            "rust-hdf5",
            "clap",
            "indicatif",
            "ab_glyph",
            "tiny-skia",
            "epaint_default_fonts",
            "ron",
            "ariadne",
            "csv",
            "fretwork-laws",
        ],
    ),
    (
        "elastic",
        &["core"],
        &["rust-hdf5", "clap", "ron", "ariadne", "csv", "tiny-skia"],
    ),
    (
        "rolling",
        &["elastic", "math"],
        &["rust-hdf5", "clap", "ron", "ariadne", "csv", "tiny-skia"],
    ),
    (
        "sample",
        &["core"],
        &["rust-hdf5", "clap", "ron", "ariadne", "csv", "tiny-skia"],
    ),
    (
        "scene",
        &["core", "elastic", "sample"],
        &["rust-hdf5", "clap", "ab_glyph", "tiny-skia"],
    ),
    (
        "observe",
        &["core", "math", "scene"],
        &["rust-hdf5", "clap", "ab_glyph", "tiny-skia"],
    ),
    (
        "store",
        &["core", "observe", "scene"],
        &["clap", "ab_glyph", "tiny-skia"],
    ),
    ("view", &["core", "observe", "scene", "store"], &["clap"]),
    (
        "experiments",
        &[
            "core", "elastic", "math", "observe", "rolling", "scene", "store", "view",
        ],
        &["clap", "indicatif"],
    ),
];

/// Names in the normal dependencies of a manifest.
fn dependencies(manifest: &str) -> BTreeSet<String> {
    let mut out = BTreeSet::new();
    let mut counts = false;
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            counts = line == "[dependencies]" || line.ends_with(".dependencies]");
        } else if counts && let Some((name, _)) = line.split_once(['=', '.', ' ']) {
            out.insert(name.trim().to_owned());
        }
    }
    out
}

/// Dependencies of every package of the lock file, by its name; several versions of one package are
/// combined.
fn locked(lock: &str) -> BTreeMap<&str, BTreeSet<&str>> {
    let mut out: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    let mut name = "";
    for line in lock.lines() {
        if let Some(rest) = line.strip_prefix("name = ") {
            name = rest.trim_matches('"');
            out.entry(name).or_default();
        } else if let Some(rest) = line.strip_prefix(" \"") {
            let package = rest.trim_end_matches(['"', ',']);
            let package = package.split(' ').next().unwrap_or(package);
            out.entry(name).or_default().insert(package);
        }
    }
    out
}

/// A package and all its dependencies, direct and indirect.
fn closure<'a>(of: &'a str, locked: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> BTreeSet<&'a str> {
    let (mut known, mut open) = (BTreeSet::new(), vec![of]);
    while let Some(package) = open.pop() {
        if known.insert(package) {
            open.extend(locked.get(package).into_iter().flatten());
        }
    }
    known
}

fn read(file: &str) -> String {
    let path = format!("{}/{file}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

#[test]
fn layers_name_only_what_is_below_them() {
    for (layer, below, _) in LAYERS {
        let named = dependencies(&read(&format!("crates/{layer}/Cargo.toml")));
        assert!(named.len() > 2, "{layer}: {named:?}");
        let ours: BTreeSet<&str> = named
            .iter()
            .filter_map(|n| n.strip_prefix("fretwork-"))
            .collect();
        let allowed: BTreeSet<&str> = below.iter().copied().chain(["abi"]).collect();
        assert!(ours.is_subset(&allowed), "{layer} names {ours:?}");
        assert!(!named.contains("fretwork"), "{layer} names the program");
    }
    let known: BTreeSet<&str> = LAYERS.iter().map(|l| l.0).collect();
    let crates = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/crates")).unwrap();
    for entry in crates {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(
            known.contains(name.as_str()),
            "crates/{name} is no known layer"
        );
    }
}

#[test]
fn lower_layers_bring_no_files_pictures_or_command_line() {
    let lock = read("Cargo.lock");
    let locked = locked(&lock);
    for library in ["rust-hdf5", "clap", "tiny-skia", "ron"] {
        // HDF5 is a dependency of the program, so that the search below can find it.
        assert!(closure("fretwork", &locked).contains(library), "{library}");
    }
    for (layer, _, refused) in LAYERS {
        let package = format!("fretwork-{layer}");
        assert!(locked.contains_key(package.as_str()), "{package}");
        let brings = closure(&package, &locked);
        for library in refused {
            assert!(!brings.contains(library), "{package} brings {library}");
        }
    }
}

/// Modules of the core, each after those that it may name.
const MODULES: [&str; 21] = [
    "out_of_memory",
    "huge_pages",
    "threads",
    "encoding",
    "program",
    "unit",
    "lanes",
    "geometry",
    "bodies",
    "contact",
    "solve",
    "laws",
    "certify",
    "energy",
    "momentum",
    "wear",
    "heat",
    "step",
    "process",
    "view",
    "assembly",
];

/// Modules of the core that a file's code names.
fn named(text: &str) -> impl Iterator<Item = &str> {
    let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
    code.flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.split(|c: char| !(c.is_alphanumeric() || c == '_')))
        .filter_map(|mut words| words.next())
}

fn source_files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            source_files(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// No module of the core names one above it, so there is no cycle between them.
#[test]
fn modules_of_the_core_name_those_below_them() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/crates/core/src"));
    let place = |name: &str| MODULES.iter().position(|m| *m == name);
    let (mut files, mut seen) = (Vec::new(), BTreeSet::new());
    source_files(root, &mut files);
    for file in files {
        let inside = file.strip_prefix(root).unwrap();
        let own = inside.components().next().unwrap().as_os_str();
        let own = own.to_string_lossy().trim_end_matches(".rs").to_owned();
        if own == "lib" {
            continue;
        }
        let above = place(&own).unwrap_or_else(|| panic!("the module {own} has no place"));
        // Unit tests may build scenes with modules above.
        if inside.ends_with("tests.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        for name in named(text) {
            // Macros are at the root of the crate.
            if name == "commit_hook" {
                continue;
            }
            let below = place(name);
            assert!(
                below.is_some_and(|below| below <= above),
                "{}: crate::{name}",
                inside.display()
            );
            seen.insert((own.clone(), name.to_owned()));
        }
    }
    assert!(seen.contains(&("step".to_owned(), "laws".to_owned())));
}

/// The list of the stages of a step names nothing that only some scenes have: such features act at
/// stages.
#[test]
fn the_stepper_names_no_feature() {
    let text = read("crates/core/src/step/one_step.rs").to_lowercase();
    let features = [
        "wear",
        "worn",
        "heat",
        "thermal",
        "temperature",
        "expansion",
        "system",
        "circuit",
        "jump",
        "mean_place",
        "mean place",
        "recession",
        "scar",
        "debris",
    ];
    for word in features {
        assert!(!text.contains(word), "one_step.rs names `{word}`");
    }
    for moment in ["at_start", "before_detection", "after_solve", "after_move"] {
        assert!(text.contains(moment), "{moment}");
    }
}

/// Folders of the step, each after those that it may name.
const STAGES: [&str; 5] = ["motion", "detection", "control", "problem", "ledger"];

/// Files of the step that contain only data.
const DATA: [&str; 5] = ["options", "error", "report", "state", "workspace"];

/// No stage of the step names one after it, and files of data do not name the simulation.
#[test]
fn stages_of_the_step_name_those_before_them() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/crates/core/src/step"));
    let mut seen = BTreeSet::new();
    for (place, stage) in STAGES.iter().enumerate() {
        let mut files = Vec::new();
        source_files(&root.join(stage), &mut files);
        for file in files {
            let text = std::fs::read_to_string(&file).unwrap();
            let is_folder = file.ends_with("mod.rs");
            for (other, name) in STAGES.iter().enumerate() {
                let by_path = text.contains(&format!("step::{name}::"));
                let beside = is_folder && text.contains(&format!("use super::{name}::"));
                if by_path || beside {
                    assert!(other <= place, "{}: {name}", file.display());
                    seen.insert((*stage, *name));
                }
            }
        }
    }
    assert!(seen.contains(&("problem", "detection")), "{seen:?}");
    for name in DATA {
        let text = std::fs::read_to_string(root.join(format!("{name}.rs"))).unwrap();
        let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
        for line in code {
            assert!(!line.contains("Simulation"), "{name}.rs: {line}");
        }
    }
}

/// Files above the core and elastic that are generic over the dimension, with the reason.
const GENERIC: [(&str, &str); 6] = [
    ("crates/sample/src/deposit.rs", "generates numbers only"),
    (
        "crates/scene/src/build/mod.rs",
        "gives the simulation of a known dimension",
    ),
    (
        "crates/scene/src/build/elastic_grains.rs",
        "gives grains that were generated meshes of their shapes",
    ),
    (
        "crates/scene/src/build/deformed.rs",
        "takes deformed grains over from another run",
    ),
    (
        "crates/store/src/checkpoint/identity.rs",
        "hashes the state itself",
    ),
    ("python/src/columns.rs", "shows arrays without a copy"),
];

/// Above the core and elastic a run is read without its dimension, but for the files of
/// [`GENERIC`].
#[test]
fn layers_above_the_core_have_no_dimension() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut generic = BTreeSet::new();
    for layer in [
        "crates/sample/src",
        "crates/scene/src",
        "crates/observe/src",
        "crates/store/src",
        "crates/view/src",
        "crates/experiments/src",
        "src",
        "python/src",
    ] {
        let mut files = Vec::new();
        source_files(&root.join(layer), &mut files);
        assert!(files.len() > 5, "{layer}");
        for file in files {
            let text = std::fs::read_to_string(&file).unwrap();
            let text = text.split("#[cfg(test)]\nmod tests").next().unwrap();
            let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
            let words = [
                ": Space>",
                ": Space,",
                ": Space +",
                "Simulation<",
                "in_dimension!",
            ];
            if code.clone().any(|l| words.iter().any(|w| l.contains(w))) {
                let inside = file.strip_prefix(root).unwrap();
                generic.insert(inside.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    let allowed = GENERIC.iter().map(|(file, _)| (*file).to_owned());
    assert_eq!(generic, allowed.collect());
}
