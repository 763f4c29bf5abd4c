//! Laws of a material: the material's name selects the parameters of the laws at its contacts.

use fretwork::geometry::space::Dim2;
use fretwork::scene::load;
use fretwork::step::Simulation;
use std::path::{Path, PathBuf};

/// Makes a folder with a copy of the sliding block, and materials of these names and laws.
fn folder(name: &str, materials: &[(&str, &str)]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("fretwork-laws-{name}-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("materials")).unwrap();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/verification/worn_slide.ron");
    std::fs::copy(case, folder.join("case.ron")).unwrap();
    for (material, laws) in materials {
        let text =
            format!("(doc: \"{material}\", density: (value: 1000.0, source: \"test\"),{laws})\n");
        std::fs::write(folder.join(format!("materials/{material}.ron")), text).unwrap();
    }
    folder
}

/// Returns the block that slides on a profile, of this material, with these parameters of the
/// interface.
fn slides(folder: &Path, material: &str, parameters: &str) -> Result<Simulation<Dim2>, String> {
    let sets = [
        format!("materials.grain={material}"),
        "interfaces.grain.parameters_from=grain".to_owned(),
        format!("interfaces.grain.parameters={parameters}"),
        "bodies.0.wears=None".to_owned(),
    ];
    load(&folder.join("case.ron"), &sets)
        .and_then(|loaded| loaded.build_in::<Dim2>(&fretwork::shipped::search_path()))
        .map_err(|e| e.to_string())
}

/// Volume worn (m³/m) after 0.1 s.
fn worn(mut simulation: Simulation<Dim2>) -> f64 {
    let steps = (0..100).map(|_| simulation.step().unwrap().totals.worn_first);
    steps.sum()
}

fn laws(k: f64) -> String {
    format!(
        "laws: (contact: {{\"coulomb\": {{\"mu\": (value: 0.3, source: \"test\")}}}}, wear: {{\"archard\": {{\"k\": (value: {k:e}, source: \"test\")}}}})"
    )
}

#[test]
fn the_name_of_a_material_chooses_the_parameters_of_its_laws() {
    let folder = folder("choice", &[("soft", &laws(2e-8)), ("hard", &laws(1e-8))]);
    let from_file = "(contact: {}, wear: {})";
    let soft = worn(slides(&folder, "soft", from_file).unwrap());
    let hard = worn(slides(&folder, "hard", from_file).unwrap());
    // The volume is V = k F s.
    assert!(
        hard > 0.0 && (soft / hard - 2.0).abs() < 1e-12,
        "{soft} {hard}"
    );
    // Values in the case take precedence.
    let own = worn(slides(&folder, "soft", "(contact: {}, wear: {\"k\": 1e-8})").unwrap());
    assert_eq!(own, hard);
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn laws_of_a_material_that_are_missing_or_wrong_are_refused_at_their_place() {
    let bad = "laws: (contact: {\"coulomb\": {\"mu\": (value: 0.3, unit: \"GPa\", source: \"test\")}}, wear: {\"archard\": {\"k\": (value: 1e-8, source: \"test\")}})";
    let folder = folder("refused", &[("none", ""), ("bad", bad)]);
    let said = |material| slides(&folder, material, "(contact: {}, wear: {})").unwrap_err();
    let none = said("none");
    assert!(
        none.contains("the file `none.ron` of the material `grain` has no `laws`"),
        "{none}"
    );
    // The material does not belong to the case.
    let sets = [
        "materials.grain=bad",
        "interfaces.grain.parameters_from=none",
    ];
    let loaded = load(&folder.join("case.ron"), &sets.map(str::to_owned)).unwrap();
    let built = loaded.build_in::<Dim2>(&fretwork::shipped::search_path());
    let file = built.err().unwrap().to_string();
    assert!(
        file.contains("`none.ron` is the file of a material") && file.contains("(grain)"),
        "{file}"
    );
    let wrong = said("bad");
    assert!(
        wrong.contains("bad.ron:1:") && wrong.contains("GPa"),
        "{wrong}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}
