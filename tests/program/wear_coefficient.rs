//! Wear coefficients from K and the hardness of the materials: wear depends on the steel.

use fretwork::scene::material::{Material, Sourced};
use fretwork::scene::{Built, LoadedCase, load};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// A block slides on a profile: the wear law has the parameters `wear`, and the two materials have
/// these hardnesses.
fn slides(wear: &str, law: &str, hardness: [Option<(f64, &str)>; 2]) -> Result<Built, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/worn_slide.ron");
    let sets = [
        r#"materials={"soft": "soft", "hard": "hard"}"#,
        r#"interfaces.0.between=("soft", "hard")"#,
        r#"bodies.0.material="soft""#,
        r#"bodies.1.material="hard""#,
        "bodies.0.wears=None",
        &format!("interfaces.0.wear={law:?}"),
        &format!("interfaces.0.parameters.wear={wear}"),
    ]
    .map(str::to_owned);
    let mut loaded: LoadedCase = load(&path, &sets).map_err(|e| e.to_string())?;
    for (name, hardness) in ["soft", "hard"].into_iter().zip(hardness) {
        let sourced = |value, unit: &str| Sourced {
            value,
            unit: unit.to_owned(),
            range: None,
            motion: None,
            source: "test".to_owned(),
        };
        let given = hardness.map(|(value, unit)| ("hardness".to_owned(), sourced(value, unit)));
        let material = Material {
            doc: name.to_owned(),
            class: None,
            also: Vec::new(),
            density: sourced(1000.0, "kg/m^3"),
            properties: BTreeMap::from_iter(given),
            laws: None,
        };
        loaded = loaded
            .with_material(name, &material)
            .map_err(|e| e.to_string())?;
    }
    loaded
        .build(&fretwork::shipped::search_path())
        .map_err(|e| e.to_string())
}

/// Volume worn (m³/m) after 0.3 s.
fn worn(mut built: Built) -> f64 {
    let mut sum = 0.0;
    for _ in 0..300 {
        sum += built.simulation.step().unwrap().totals.worn_first;
    }
    sum
}

const SOFT: Option<(f64, &str)> = Some((260.0, "HBW"));
const HARD: Option<(f64, &str)> = Some((8.7, "GPa"));

#[test]
fn twice_the_hardness_wears_half_the_volume() {
    let wear = r#"{"K": 3e-4}"#;
    let at = |hardness| {
        let built = slides(wear, "archard", hardness).unwrap();
        assert_eq!(built.wear_coefficients.len(), 1);
        worn(built)
    };
    let (once, twice) = (at([SOFT, HARD]), at([Some((520.0, "HBW")), HARD]));
    assert!(once > 0.0);
    assert!((twice / once - 0.5).abs() < 1e-12, "{twice} {once}");
    // The result equals k = K/H: the softer material counts, at either position, and even if the
    // other has no hardness.
    let k = 3e-4 / (260.0 * 9.80665e6);
    let by_hand = worn(slides(&format!(r#"{{"k": {k:e}}}"#), "archard", [None, None]).unwrap());
    for hardness in [[SOFT, HARD], [HARD, SOFT], [SOFT, None], [None, SOFT]] {
        assert!((at(hardness) / by_hand - 1.0).abs() < 1e-12);
    }
}

/// In sliding with friction, E_d = mu F s: alpha = K/(mu H) wears the volume K F s/H.
#[test]
fn the_energy_law_wears_the_same_in_sliding() {
    let wear = r#"{"K": 3e-4}"#;
    let archard = worn(slides(wear, "archard", [SOFT, HARD]).unwrap());
    let energy = slides(wear, "dissipated-energy", [SOFT, HARD]).unwrap();
    assert_eq!(energy.wear_coefficients[0].friction, Some(0.3));
    assert!((worn(energy) / archard - 1.0).abs() < 1e-6);
}

#[test]
fn what_has_no_hardness_is_refused() {
    for (wear, law, hardness, words) in [
        (
            r#"{"K": 3e-4}"#,
            "archard",
            [None, None],
            "neither `soft` nor `hard` has one",
        ),
        (
            r#"{"K": 3e-4}"#,
            "archard",
            [Some((50.0, "HRC")), HARD],
            "no pressure; give it in HBW",
        ),
        (
            r#"{"K": 3e-4, "k": 1e-13}"#,
            "archard",
            [SOFT, HARD],
            "both `K` and `k`",
        ),
        (r#"{"K": 3.0}"#, "archard", [SOFT, HARD], "between 0 and 1"),
        (
            r#"{"K": (value: 3e-4, unit: "1/Pa")}"#,
            "archard",
            [SOFT, HARD],
            "pure number",
        ),
        (
            r#"{"K": 3e-4}"#,
            "t-gamma",
            [SOFT, HARD],
            "no parameter `K`",
        ),
    ] {
        let said = slides(wear, law, hardness).map(|_| ()).unwrap_err();
        assert!(said.contains(words), "{wear} {law}: {said}");
    }
}

/// The shipped cases take k from their steels, and `check` says how.
#[test]
fn another_steel_changes_the_coefficient_of_a_case() {
    let check = |sets: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args([
                "check",
                "--no-timing",
                "--verbose",
                "cases/wheel_rail_creep.ron",
            ])
            .args(sets.iter().flat_map(|s| ["--set", s]))
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let line = text
            .lines()
            .find(|l| l.contains("wear coefficient") && l.contains("rail_oxide"));
        line.unwrap_or_else(|| panic!("{text}{}", String::from_utf8_lossy(&output.stderr)))
            .to_owned()
    };
    let r260 = check(&[]);
    assert!(
        r260.contains("k = 1.1766e-13 1/Pa = K/H, K = 3e-4"),
        "{r260}"
    );
    assert!(
        r260.contains("(260 HBW) of `rail_steel`, the softer material"),
        "{r260}"
    );
    let r350 = check(&["materials.rail_steel=rail_steel_r350ht"]);
    assert!(
        r350.contains("k = 8.7404e-14 1/Pa") && r350.contains("350 HBW"),
        "{r350}"
    );
    // The case's own k wins over the K of the file.
    let own = ["interfaces.rail_oxide.parameters.wear={\"k\": 1e-13}"];
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args([
            "check",
            "--no-timing",
            "--verbose",
            "cases/wheel_rail_creep.ron",
            "--set",
            own[0],
        ])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        output.status.success() && !text.contains("rail_oxide, archard: k"),
        "{text}"
    );
}
