//! Cases and material files are read, built into a scene, and stepped twice.

use crate::campaign::Campaign;
use crate::mutate;
use fretwork::laws::SearchPath;
use fretwork::scene::{Built, load};
use fretwork::shipped::search_path;
use fretwork::step::Coupling;
use rand::RngExt;
use std::path::{Path, PathBuf};

/// Memory that a scene may hold beyond the limit for readers of its file (bytes).
const SCENE: usize = 2 << 30;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files of a folder of the project with one of these endings, sorted by name.
pub fn files(folder: &str, endings: &[&str]) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let mut found: Vec<PathBuf> = entries
        .map(|e| e.unwrap().path())
        .filter(|p| {
            p.is_file()
                && p.extension()
                    .is_some_and(|e| endings.iter().any(|x| e == *x))
        })
        .collect();
    found.sort();
    found
}

fn texts(paths: &[PathBuf]) -> Vec<String> {
    paths
        .iter()
        .map(|p| std::fs::read_to_string(p).unwrap())
        .collect()
}

/// The shipped cases.
fn shipped() -> Vec<PathBuf> {
    ["cases", "cases/verification", "cases/benchmarks"]
        .iter()
        .flat_map(|folder| files(folder, &["ron"]))
        .collect()
}

/// Copies materials, and files named by cases, to the folder of the inputs.
pub fn furnish(folder: &Path) {
    std::fs::create_dir_all(folder.join("materials")).unwrap();
    for path in files("materials", &["ron"]) {
        let name = path.file_name().unwrap();
        std::fs::copy(&path, folder.join("materials").join(name)).unwrap();
    }
    for from in ["cases", "cases/verification", "cases/benchmarks"] {
        for path in files(from, &["csv", "obj", "txt", "stl"]) {
            std::fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        }
    }
}

/// Makes two steps with the limits of this test on iterations, since those of a case may be very
/// large.
fn steps(mut built: Built) {
    let s = &mut built.simulation;
    let options = s.options_mut();
    options.solver.max_iterations = options.solver.max_iterations.min(20);
    if let Coupling::Implicit { max_iterations, .. } = &mut options.coupling {
        *max_iterations = (*max_iterations).min(3);
    }
    for _ in 0..2 {
        if s.step().is_err() {
            return;
        }
    }
}

/// Whether an input is a valid case.
pub fn tried(case: &Path, laws: &SearchPath) -> bool {
    match load(case, &[]).and_then(|loaded| loaded.build(laws)) {
        Ok(built) => steps(built),
        Err(error) => {
            assert!(!error.message.is_empty() && !error.to_string().is_empty());
            // The message is rendered as for a user, with the line marked.
            assert!(!error.render(false).is_empty());
            return false;
        }
    }
    true
}

#[test]
fn damaged_cases() {
    let campaign = Campaign {
        kind: "cases",
        count: 200,
        scene: SCENE,
        taken: true,
    };
    let folder = campaign.folder();
    furnish(&folder);
    let seeds = texts(&shipped());
    let laws = search_path();
    let make = |rng: &mut rand_pcg::Pcg64| {
        let seed = rng.random_range(0..seeds.len());
        (
            "case.ron".to_owned(),
            mutate::text(&seeds[seed], &seeds, rng),
        )
    };
    campaign.run(&folder, make, move |case| tried(case, &laws));
}

#[test]
fn damaged_materials() {
    let campaign = Campaign {
        kind: "materials",
        count: 300,
        scene: SCENE,
        taken: true,
    };
    let folder = campaign.folder();
    furnish(&folder);
    let of_laws = std::fs::read_to_string(root().join("cases/wheel_rail_degradable.ron")).unwrap();
    assert!(of_laws.contains("\"oxide_third_body\""));
    let case = folder.join("case.ron");
    std::fs::write(&case, of_laws).unwrap();
    let names = ["oxide_third_body", "rail_steel_r260", "wheel_steel_er7"];
    let seeds = texts(&files("materials", &["ron"]));
    let own: Vec<String> = names
        .iter()
        .map(|n| std::fs::read_to_string(root().join(format!("materials/{n}.ron"))).unwrap())
        .collect();
    let laws = search_path();
    let make = |rng: &mut rand_pcg::Pcg64| {
        let k = rng.random_range(0..names.len());
        (
            format!("{}.ron", names[k]),
            mutate::text(&own[k], &seeds, rng),
        )
    };
    let shelf = folder.join("materials");
    campaign.run(&folder, make, move |file| {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let name = name.trim_start_matches("last-").to_owned();
        let whole = root().join("materials").join(&name);
        std::fs::copy(file, shelf.join(&name)).unwrap();
        let taken = tried(&case, &laws);
        std::fs::copy(whole, shelf.join(&name)).unwrap();
        taken
    });
}
