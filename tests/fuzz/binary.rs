//! HDF5 files: contact problems of FCLIB, and results of a run; and the bytes of a state in a
//! checkpoint.

use crate::campaign::Campaign;
use crate::cases::files;
use crate::mutate;
use fretwork::geometry::space::Dim2;
use fretwork::record::checkpoint::Frame;
use fretwork::record::encoding::{decode, encode};
use fretwork::record::fclib;
use fretwork::record::results::{PreviousResults, state};
use fretwork::scene::{LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork::step::State;
use rand::RngExt;
use rand_pcg::Pcg64;
use std::path::{Path, PathBuf};
use std::process::Command;

const CASE: &str = r#"(
    name: "a small run",
    dimension: 2,
    time: (step: 1e-4, end: 2e-3),
    gravity: [0.0, -9.81],
    materials: {"grain": "verification_grain"},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "coulomb")],
    bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])],
    grains: [List(material: "grain", grains: [
        (at: [0.0, 0.0100], radius: 0.01), (at: [0.021, 0.01], radius: 0.01), (at: [0.04, 0.03], radius: 0.01),
    ])],
    output: (frames: 0, views: 3, figures: false, checkpoint: Steps(5)),
)"#;

fn small(folder: &Path) -> PathBuf {
    std::fs::create_dir_all(folder.join("materials")).unwrap();
    let material = Path::new(env!("CARGO_MANIFEST_DIR")).join("materials/verification_grain.ron");
    std::fs::copy(material, folder.join("materials/verification_grain.ron")).unwrap();
    let case = folder.join("small.ron");
    std::fs::write(&case, CASE).unwrap();
    case
}

fn damaged(name: &'static str, seeds: Vec<Vec<u8>>) -> impl FnMut(&mut Pcg64) -> (String, Vec<u8>) {
    move |rng| {
        let seed = &seeds[rng.random_range(0..seeds.len())];
        let other = &seeds[rng.random_range(0..seeds.len())];
        (name.to_owned(), mutate::bytes(seed, other, rng))
    }
}

#[test]
fn damaged_contact_problems() {
    let campaign = Campaign {
        kind: "contact problems",
        count: 500,
        scene: 0,
        taken: true,
    };
    let folder = campaign.folder();
    let seeds: Vec<Vec<u8>> = files("tests/fclib", &["hdf5"])
        .iter()
        .map(|p| std::fs::read(p).unwrap())
        .collect();
    campaign.run(&folder, damaged("problem.hdf5", seeds), |path| {
        let solution = fclib::read_solution(path).is_ok();
        match fclib::read(path) {
            Ok(_) => solution,
            Err(error) => {
                assert!(!error.to_string().is_empty());
                false
            }
        }
    });
}

/// Returns the bytes of the results of a run of the case.
fn results(case: &Path, folder: &Path) -> Vec<u8> {
    let done = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .args(["run", case.to_str().unwrap(), "--force", "--out"])
        .arg(folder.join("out"))
        .env_remove("FRETWORK_PLUGIN_PATH")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    std::fs::read(folder.join("out/results.h5")).unwrap()
}

#[test]
fn damaged_results() {
    let campaign = Campaign {
        kind: "results",
        count: 500,
        scene: 0,
        taken: true,
    };
    let folder = campaign.folder();
    let case = small(&folder);
    let whole = results(&case, &folder);
    campaign.run(&folder, damaged("results.h5", vec![whole]), |path| {
        let last = state::read(path, None, 2);
        let first = state::read(path, Some(0), 2);
        let other = state::read(path, Some(usize::MAX), 3);
        assert!(other.is_err());
        let Ok(kept) = PreviousResults::open(path) else {
            return last.is_ok() && first.is_ok();
        };
        for slot in kept.checkpoints().into_iter().flatten().flatten() {
            drop(Frame::read(&slot));
        }
        let names = ["time".to_owned(), "kinetic".to_owned()];
        for rows in [1, 5, 1 << 30, usize::MAX] {
            drop(kept.statistics(&names, rows));
        }
        last.is_ok() && first.is_ok()
    });
}

/// Returns the case with other grains, in a dimension.
fn with(dimension: usize, grains: &str) -> String {
    let from = CASE.find("grains: [List").unwrap();
    let to = CASE.find("    output:").unwrap();
    let case = format!("{}grains: [{grains}],\n{}", &CASE[..from], &CASE[to..]);
    match dimension {
        2 => case,
        _ => case
            .replace("dimension: 2", "dimension: 3")
            .replace("0.0, -9.81", "0.0, 0.0, -9.81")
            .replace("0.0, 1.0", "0.0, 0.0, 1.0"),
    }
}

const PLANE: &str = r#"Polygons(material: "grain", grains: [(at: [0.0, 0.011], regular: (6, 0.01)), (at: [0.03, 0.012], regular: (3, 0.01), rounding: 1e-3)]),
    Clusters(material: "grain", grains: [(at: [0.06, 0.01], shapes: [Balls([([0.0, 0.0], 0.006)]), Capsule(from: (0.0, 0.0), to: (0.01, 0.0), radius: 0.004)])])"#;
const SOLID: &str = r#"Polyhedra(material: "grain", grains: [(at: [0.0, 0.0, 0.011], size: (0.02, 0.02, 0.02)), (at: [0.03, 0.0, 0.012], size: (0.01, 0.02, 0.02), rounding: 1e-3)]),
    Clusters(material: "grain", grains: [(at: [0.06, 0.0, 0.01], shapes: [Balls([([0.0, 0.0, 0.0], 0.006)]), Capsule(from: (0.0, 0.0, 0.0), to: (0.01, 0.0, 0.0), radius: 0.004)])])"#;

/// Grains of every shape are read from damaged results.
#[test]
fn damaged_shapes() {
    let campaign = Campaign {
        kind: "shapes",
        count: 500,
        scene: 0,
        taken: true,
    };
    let folder = campaign.folder();
    let case = small(&folder);
    let mut seeds = Vec::new();
    let mut begun = Vec::new();
    for (dimension, grains) in [(2, PLANE), (3, SOLID)] {
        std::fs::write(&case, with(dimension, grains)).unwrap();
        seeds.push(results(&case, &folder));
        let begins = folder.join(format!("begins_{dimension}.ron"));
        let state = r#"State(results: "last-results.h5", material: "grain")"#;
        std::fs::write(&begins, with(dimension, state)).unwrap();
        begun.push(begins);
    }
    let laws = search_path();
    campaign.run(&folder, damaged("results.h5", seeds), move |_| {
        let built = begun.iter().map(|case| loaded(case).build(&laws).is_ok());
        built.filter(|taken| *taken).count() == 1
    });
}

fn loaded(case: &Path) -> LoadedCase {
    load(case, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// The bytes behind a checkpoint's checksum are decoded, and restored into a scene of the same
/// case.
#[test]
fn damaged_states() {
    let campaign = Campaign {
        kind: "states",
        count: 500,
        scene: 0,
        taken: true,
    };
    let folder = campaign.folder();
    let case = small(&folder);
    let laws = search_path();
    let mut built = loaded(&case).build_in::<Dim2>(&laws).unwrap();
    (0..5).for_each(|_| built.step().map(drop).unwrap());
    let whole = encode(&built.state).unwrap();
    campaign.run(&folder, damaged("state", vec![whole]), move |path| {
        let bytes = std::fs::read(path).unwrap();
        let Ok(saved) = decode::<State<Dim2>>(&bytes) else {
            return false;
        };
        let mut again = loaded(&case).build_in::<Dim2>(&laws).unwrap();
        let taken = again.restore(saved);
        if taken {
            // An accepted state can be stepped: numbers may be wrong, indices and lengths are not.
            for _ in 0..2 {
                drop(again.step());
            }
        }
        taken
    });
}
