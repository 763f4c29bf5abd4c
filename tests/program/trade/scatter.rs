//! Errors distinguished from scatter: that of seeds, and that of chaotic collisions without seeds.

use super::{Folder, HEAP, frontier_is_what_nothing_dominates, number, settings, study};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Disks are thrown at each other in a box. Nothing is random, but every collision of disks
/// amplifies a difference.
const BILLIARD: &str = r#"(
    name: "a billiard",
    dimension: 2,
    time: (step: 1e-3, end: 3.0),
    solver: (tolerance: 1e-6, max_iterations: 5000),
    materials: {"glass": "glass_bead"},
    interfaces: [(name: "all", between: ("glass", "glass"), contact: "coulomb",
        parameters: (contact: {"mu": 0.0, "restitution_n": 0.98}))],
    bodies: [
        (name: "floor", material: "glass", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (name: "left", material: "glass", shapes: [HalfSpace(normal: [1.0, 0.0])]),
        (name: "right", material: "glass", shapes: [HalfSpace(normal: [-1.0, 0.0])], position: [1.0, 0.0]),
        (name: "top", material: "glass", shapes: [HalfSpace(normal: [0.0, -1.0])], position: [0.0, 1.0]),
    ],
    grains: [List(material: "glass", grains: [
        (at: [0.21, 0.20], radius: 0.09, velocity: [2.0, 0.4]), (at: [0.55, 0.18], radius: 0.09, velocity: [-1.0, 0.9]),
        (at: [0.82, 0.27], radius: 0.09, velocity: [-1.5, 0.2]), (at: [0.18, 0.53], radius: 0.09, velocity: [0.7, -1.6]),
        (at: [0.51, 0.48], radius: 0.09, velocity: [1.1, 1.3]), (at: [0.80, 0.55], radius: 0.09, velocity: [-0.6, -1.2]),
        (at: [0.23, 0.82], radius: 0.09, velocity: [1.4, -0.8]), (at: [0.54, 0.79], radius: 0.09, velocity: [0.3, 1.7]),
        (at: [0.83, 0.84], radius: 0.09, velocity: [-0.9, -0.5]),
    ])],
    output: (every: 100),
)"#;

#[test]
fn errors_are_told_from_scatter() {
    let folder = Folder::new("heap");
    let (case, out) = (folder.file("heap.ron", HEAP), folder.out());
    let found = study(&[
        &case,
        "--vary",
        "time.step=2.5e-4,5e-4,1e-3",
        "--output",
        "energy.friction=5%",
        "--output",
        "statistics.potential:last=1e-2",
        "--seeds",
        "3",
        "--jobs",
        "2",
        "--budget",
        "5m",
        "--out",
        &out,
    ]);
    assert_eq!(
        (&found["random"], &found["complete"]),
        (&true.into(), &true.into())
    );
    assert_eq!(found["seeds"], serde_json::json!([3, 4, 5]));
    assert_eq!(found["runs"]["fresh"], 9);
    // The expected values are computed here from the files of the runs.
    let mut friction: BTreeMap<(String, u64), f64> = BTreeMap::new();
    for entry in std::fs::read_dir(Path::new(&out).join("runs")).unwrap_or_else(|e| panic!("{e}")) {
        let place = entry.unwrap_or_else(|e| panic!("{e}")).path();
        let read = |name: &str| -> Value {
            let text = std::fs::read_to_string(place.join(name)).unwrap_or_default();
            serde_json::from_str(&text).unwrap_or_default()
        };
        let (run, summary) = (read("run.json"), read("summary.json"));
        let seed = run["seed"].as_u64().unwrap_or(0);
        friction.insert(
            (run["sets"].to_string(), seed),
            number(&summary, "/energy/friction"),
        );
    }
    let by_seed = |s: &Value| -> Vec<f64> {
        (3..6)
            .map(|seed| friction[&(s["sets"].to_string(), seed)])
            .collect()
    };
    let all = settings(&found);
    let reference = all
        .iter()
        .find(|s| s["reference"] == true)
        .map(by_seed)
        .unwrap_or_default();
    let scale = reference.iter().sum::<f64>() / 3.0;
    let mut hidden = 0;
    for s in all.iter().filter(|s| s["reference"] == false) {
        let d: Vec<f64> = by_seed(s)
            .iter()
            .zip(&reference)
            .map(|(a, b)| (a - b) / scale)
            .collect();
        let mean = d.iter().sum::<f64>() / 3.0;
        let sd = (d.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
        // Student's t of 95 % and two degrees of freedom is 4.303.
        let half = 4.3027 * sd / 3f64.sqrt();
        let close = |path: &str, x: f64| {
            let got = number(s, &format!("/outputs/energy.friction{path}"));
            assert!(
                (got - x).abs() <= 1e-4 * x.abs() + 1e-12,
                "{path}: {got} and {x}"
            );
        };
        close("/error/mean", mean);
        close("/error/half_width", half);
        close("/at_most", mean.abs() + half);
        let reported = s.pointer("/outputs/energy.friction/distinguishable_from_zero");
        assert_eq!(reported.and_then(Value::as_bool), Some(mean.abs() > half));
        hidden += usize::from(mean.abs() <= half);
    }
    frontier_is_what_nothing_dominates(&found, "energy.friction");
    assert!(
        hidden > 0,
        "chance hides no error here: the test shows nothing"
    );
}

/// If nothing is random and collisions are chaotic, runs whose steps differ by parts in 1e10
/// replace seeds; a bond that opens is not chaotic, see above.
#[test]
fn chaos_without_draws_has_intervals() {
    let folder = Folder::new("billiard");
    let (case, out) = (folder.file("billiard.ron", BILLIARD), folder.out());
    let found = study(&[
        &case,
        "--vary",
        "time.step=1e-3,2e-3",
        "--output",
        "energy.impact=1%",
        "--seeds",
        "3",
        "--budget",
        "5m",
        "--out",
        &out,
    ]);
    assert_eq!(
        (&found["random"], &found["nudged"], &found["complete"]),
        (&Value::Bool(true), &Value::Bool(true), &Value::Bool(true))
    );
    let notes = found["notes"].to_string();
    assert!(notes.contains("contacts are chaotic"), "{notes}");
    for s in settings(&found) {
        assert_eq!(s["seeds"], 3);
        if s["reference"] == false {
            assert!(number(&s, "/outputs/energy.impact/error/half_width") > 0.0);
        }
    }
}
