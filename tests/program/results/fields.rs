//! A field that is registered here, and nowhere else, is in `results.h5` with its unit and its
//! description.

use super::folder;
use fretwork::fields::{Field, id_fields};
use fretwork::geometry::space::{Dim3, Space};
use fretwork::record::{RunOptions, run};
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use hdf5::H5File;
use std::path::Path;

/// Registers two fields, runs the case and reads their values in the last state.
fn ran<S: Space>(loaded: &LoadedCase, mut built: Built, out: &Path) {
    let s = built.simulation.get_mut::<S>().unwrap();
    let age = |s: &Simulation<S>, c: &fretwork::contact::Contact<S>| s.state.time - c.formed_at;
    let age = Field::number("age", "s", "time since the contact formed", age);
    s.fields.contacts.add(age);
    let names = id_fields(s);
    names.into_iter().for_each(|f| s.fields.contacts.add(f));
    s.fields.grains.add(Field::number(
        "kinetic_energy",
        "J",
        "of translation",
        |s, g: &fretwork::fields::GrainPart<S>| kinetic(s, g.body as usize),
    ));
    let options = RunOptions {
        out: out.to_owned(),
        threads: 1,
    };
    let summary = run(loaded, built, &options, &mut |_| {}).unwrap();
    let file = H5File::open(out.join("results.h5")).unwrap();
    let numbers = |name: &str| file.dataset(name).unwrap().read_raw::<f64>().unwrap();
    let ages = numbers("views/contacts/CellData/age");
    let gaps = numbers("views/contacts/CellData/gap");
    let end = summary.found.number("time").unwrap();
    assert!(!ages.is_empty() && ages.len() == gaps.len());
    assert!(ages.iter().all(|a| (0.0..=end).contains(a)));
    assert!(ages.iter().any(|a| *a > 0.0));
    // Energies agree with the recorded velocities, for grains of equal mass.
    let energies = numbers("views/grains/PointData/kinetic_energy");
    let squares: Vec<f64> = {
        let axes =
            ["x", "y", "z"].map(|a| numbers(&format!("views/grains/PointData/velocity_{a}")));
        (0..energies.len())
            .map(|k| axes.iter().map(|v| v[k] * v[k]).sum())
            .collect()
    };
    let mass = energies.iter().zip(&squares).filter(|(_, v)| **v > 1e-20);
    let masses: Vec<f64> = mass.map(|(e, v)| 2.0 * e / v).collect();
    assert!(masses.len() > 2, "nothing moved");
    assert!(masses.iter().all(|m| (m / masses[0] - 1.0).abs() < 1e-12));
    for (name, unit, doc) in [
        (
            "contacts/CellData/age",
            "s",
            "time since the contact formed",
        ),
        ("grains/PointData/kinetic_energy", "J", "of translation"),
    ] {
        let set = file.dataset(&format!("views/{name}")).unwrap();
        assert_eq!(set.attr("unit").unwrap().read_string().unwrap(), unit);
        assert_eq!(set.attr("doc").unwrap().read_string().unwrap(), doc);
    }
    let whole = file.dataset("views/contacts/CellData/contactor_1").unwrap();
    let whole = whole.read_raw::<i64>().unwrap();
    assert!(whole.len() == ages.len() && whole.iter().all(|n| *n == 0));
    std::fs::remove_dir_all(out).ok();
}

fn kinetic<S: Space>(s: &Simulation<S>, body: usize) -> f64 {
    use fretwork::geometry::space::VectorLike;
    let v = &s.state.bodies.velocity[body];
    0.5 * s.state.bodies.mass[body] * v.dot(v)
}

#[test]
fn a_registered_field_is_in_the_results() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/newton_cradle.ron");
    let loaded = load(&path, &["output.frames=0".to_owned()]).unwrap();
    let out = folder("fields");
    ran::<Dim3>(&loaded, loaded.build(&search_path()).unwrap(), &out);
}
