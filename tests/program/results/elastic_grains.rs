//! Fields inside deformable grains in `results.h5`: they agree with the other files of the run, and
//! with a rigid motion.

use super::meshes::{Field, legacy};
use super::{folder, run};
use fretwork::record::results::Reader;

/// A disk at rest on the floor, and a square far above it that leaves the period and spins.
const CASE: &str = r#"(
    name: "two grains", dimension: 2, time: (step: 1e-4, end: 0.04, theta: 0.5), gravity: [0.0, -10.0],
    periodic: (x: 1.0), detection: (alert: 1e-4, skin: 1e-3),
    materials: {"other": "contact_steel", "soft": "contact_polymer"},
    interfaces: [
        (name: "grains", between: ("soft", "soft"), contact: "coulomb", parameters: (contact: {"mu": 0.3})),
        (name: "floor", between: ("soft", "other"), contact: "coulomb", parameters: (contact: {"mu": 0.3})),
    ],
    bodies: [(name: "floor", material: "other", shapes: [HalfSpace(normal: [0.0, 1.0], at: [0.0, 0.0])])],
    grains: [
        List(material: "soft", grains: [(at: [0.5, 0.0499], radius: 0.05)]),
        Polygons(material: "soft", grains: [
            (at: [0.9, 0.5], points: [(-0.05,-0.05), (0.05,-0.05), (0.05,0.05), (-0.05,0.05)], velocity: [4.7, 0.2], spin: [2.0]),
        ]),
    ],
    elastic_grains: [(material: "soft", elements: 3, damping: (mass: 0.0, stiffness: 1e-5))],
    output: (frames: 0, views: 4, figures: false),
)"#;

fn pairs(numbers: &[f64]) -> Vec<[f64; 2]> {
    numbers.chunks_exact(3).map(|x| [x[0], x[1]]).collect()
}

#[test]
fn fields_of_grains_are_those_of_the_other_files_and_of_their_motion() {
    let out = folder("elastic-grains");
    std::fs::create_dir_all(&out).unwrap();
    let case = out.join("case.ron");
    std::fs::write(&case, CASE).unwrap();
    let results = out.join("results");
    let sets = ["--set", "uncertainty.repeats=0"];
    let (output, _) = run(case.to_str().unwrap(), &results, &sets);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let reader = Reader::open(&results.join("results.h5")).unwrap();
    let group = "views/elastic_grains/soft".to_owned();
    let grains = Field {
        reader: &reader,
        group: group.clone(),
    };
    assert_eq!(grains.states(), 5);
    assert!(results.join("elastic_grains_soft.vtkhdf").exists());
    // At the end grains have the deformation and stress of the legacy file, and its positions up to
    // the period.
    let file = results.join("elastic_grains.vtk");
    let deformation = grains.last("Point", "deformation", 3);
    let count = deformation.len() / 3;
    assert_eq!(deformation, legacy(&file, "VECTORS displacement", count));
    let stress = grains.last("Cell", "stress", 6);
    let tensors = legacy(&file, "TENSORS stress", stress.len() / 2);
    for (own, legacy) in stress.chunks_exact(6).zip(tensors.chunks_exact(9)) {
        assert_eq!(own, [0, 4, 8, 1, 5, 2].map(|k| legacy[k]));
    }
    let start = pairs(
        &reader
            .numbers(&format!("{group}/Points"), (0, count), 3)
            .unwrap(),
    );
    let now = pairs(&legacy(&file, "POINTS", count));
    let way = pairs(&grains.last("Point", "displacement", 3));
    let bodies = reader.whole(&format!("{group}/PointData/body"), (0, count));
    let bodies = bodies.unwrap();
    let square = *bodies.last().unwrap();
    assert_ne!(bodies[0], square);
    for (k, body) in bodies.iter().enumerate() {
        // The square moved from 0.9 to 1.09, where the period ends at 1.
        let shift = if *body == square { 1.0 } else { 0.0 };
        for axis in 0..2 {
            let at = start[k][axis] + way[k][axis] + if axis == 0 { shift } else { 0.0 };
            assert!((at - now[k][axis]).abs() < 1e-12, "{at} {}", now[k][axis]);
        }
    }
    // The square moves rigidly, v = V + w x r, without stress; the disk on the floor has stress.
    let cells = stress.len() / 6;
    let of_cells = reader.whole(&format!("{group}/CellData/body"), (0, cells));
    let of_cells = of_cells.unwrap();
    let von_mises = grains.last("Cell", "von_mises", 1);
    let most = |wanted: bool| {
        let own = von_mises.iter().zip(&of_cells);
        let own = own.filter(|(_, body)| (**body == square) == wanted);
        own.map(|(x, _)| *x).fold(0.0, f64::max)
    };
    assert!(
        most(true) < 1e-9 * most(false),
        "{} {}",
        most(true),
        most(false)
    );
    let times = reader.numbers(&format!("{group}/Steps/Values"), (0, 5), 1);
    for (state, time) in times.unwrap().into_iter().enumerate() {
        let velocity = pairs(&grains.values("Point", "velocity", 3, state));
        let centre = [0.9 + 4.7 * time, 0.5 + 0.2 * time - 5.0 * time * time];
        let way = pairs(&grains.values("Point", "displacement", 3, state));
        let period = (centre[0] / 1.0_f64).floor();
        for k in (0..count).filter(|k| bodies[*k] == square) {
            let at = [0, 1].map(|axis| start[k][axis] + way[k][axis] - centre[axis]);
            let own = [
                4.7 - 2.0 * at[1],
                0.2 - 10.0 * time + 2.0 * (at[0] + period),
            ];
            for axis in 0..2 {
                let off = (velocity[k][axis] - own[axis]).abs();
                assert!(off < 1e-9, "state {state}: {:?} {own:?}", velocity[k]);
            }
        }
    }
    std::fs::remove_dir_all(out).ok();
}
