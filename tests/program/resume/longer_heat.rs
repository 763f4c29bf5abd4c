//! Extended runs with thermal half-spaces: the depth that follows from `time.end` does not change.

use super::common::{Folder, Job, said, same};
use serde_json::Value;
use std::path::Path;

const CASE: &str = "verification/thermal/half_space";

fn summary(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn depth(summary: &Value) -> f64 {
    summary["heat"]["half_spaces"][0]["depth"].as_f64().unwrap()
}

fn shallow(summary: &Value) -> bool {
    let mut warnings = summary["warnings"].as_array().unwrap().iter();
    warnings.any(|w| w.as_str().unwrap().starts_with("SHALLOW HALF-SPACES: "))
}

/// Temperature rise of the surface (K) and that of a half-space, 2 q sqrt(t/pi)/e.
fn rise(out: &Path, time: f64) -> [f64; 2] {
    let text = std::fs::read_to_string(out.join("surface_temperature_rail.csv")).unwrap();
    let last = text.lines().last().unwrap().rsplit_once(',').unwrap().1;
    let effusivity = (50.0f64 * 450.0 * 7850.0).sqrt();
    let exact = 2.0 * 1e6 * (time / std::f64::consts::PI).sqrt() / effusivity;
    [last.parse::<f64>().unwrap() - 300.0, exact]
}

#[test]
fn a_half_space_keeps_the_depth_that_its_run_began_with() {
    let begun = Folder::new("heat-begun");
    let sets = ["output.checkpoint=Steps(50)", "output.frames=1"];
    let job = Job {
        case: CASE,
        sets: &sets,
    };
    job.done(&begun.0, &[]);
    let first = summary(&begun.0);
    assert!(!shallow(&first), "{}", first["warnings"]);
    // The depth is 4.9 diffusion lengths, and then 3.
    for (end, reported) in [("1.5e-2", false), ("4e-2", true)] {
        let out = begun.copied(&format!("heat-{end}"));
        let end_set = format!("time.end={end}");
        let later = [&sets[..], &[end_set.as_str()]].concat();
        let job = Job {
            case: CASE,
            sets: &later,
        };
        job.done(&out.0, &["--resume"]);
        let now = summary(&out.0);
        let time: f64 = end.parse().unwrap();
        assert!((now["time"].as_f64().unwrap() / time - 1.0).abs() < 1e-9);
        assert_eq!(depth(&now), depth(&first));
        assert_eq!(shallow(&now), reported, "{}", now["warnings"]);
        let [found, exact] = rise(&out.0, time);
        assert!((found / exact - 1.0).abs() < 2e-2, "{found} {exact}");
    }
    // Another grid is another case.
    let other = [&sets[..], &["heat.bodies.rail.store.depth=Some(1e-2)"]].concat();
    let job = Job {
        case: CASE,
        sets: &other,
    };
    let reported = said(&job.run(&begun.0, &["--resume"]), 2);
    assert!(reported.contains("heat.bodies.rail.store"), "{reported}");
}

#[test]
fn with_a_depth_the_bits_are_those_of_a_run_with_the_later_end() {
    let (whole, out) = (Folder::new("heat-whole"), Folder::new("heat-longer"));
    let sets = |end| {
        [
            "heat.bodies.rail.store.depth=Some(2e-2)",
            "output.checkpoint=Steps(50)",
            // The times of views and frames follow from the first end.
            "output.frames=0",
            "output.views=0",
            end,
        ]
    };
    let (first, later) = (sets("time.end=1e-2"), sets("time.end=2e-2"));
    let job = |sets| Job { case: CASE, sets };
    job(&later).done(&whole.0, &[]);
    job(&first).done(&out.0, &[]);
    job(&later).done(&out.0, &["--resume"]);
    same(&whole.0, &out.0);
}
