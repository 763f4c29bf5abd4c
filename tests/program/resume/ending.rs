//! Final output of a run: reasons not to trust it before any number, on the terminal, in the
//! summary and over pictures.

use super::common::{Folder, Job, said};
use serde_json::Value;
use std::path::Path;

const CASE: &str = "verification/energy";

fn read(out: &Path) -> Value {
    let text = std::fs::read_to_string(out.join("summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Height of a picture, from its header.
fn height(path: &Path) -> u32 {
    let bytes = std::fs::read(path).unwrap();
    u32::from_be_bytes(bytes[20..24].try_into().unwrap())
}

fn sentences(value: &Value) -> Vec<&str> {
    let list = value.as_array().unwrap().iter();
    list.map(|w| w.as_str().unwrap()).collect()
}

#[test]
fn a_run_that_missed_the_tolerance_says_so_first() {
    let sound = Job {
        case: CASE,
        sets: &["output.frames=1"],
    };
    let hasty = Job {
        sets: &["output.frames=1", "solver.max_iterations=2"],
        ..sound
    };
    let (good, bad) = (Folder::new("ending-good"), Folder::new("ending-bad"));
    let text = sound.done(&good.0, &["--strict"]);
    assert!(!text.contains("TRUSTWORTHY"), "{text}");
    let summary = read(&good.0);
    assert_eq!(summary["trustworthy"], true, "{:?}", summary["reasons"]);
    assert!(sentences(&summary["reasons"]).is_empty());

    // Exit codes are unchanged, except that --strict makes it 1.
    let output = hasty.run(&bad.0, &[]);
    let text = said(&output, 0);
    let end = String::from_utf8_lossy(&output.stdout);
    let after = end.find("energy.ron: ").unwrap();
    let end = &end[after..].split_once('\n').unwrap().1;
    assert!(end.starts_with("NOT TRUSTWORTHY\n"), "{end}");
    let place = |what: &str| end.find(what).unwrap_or_else(|| panic!("no {what}: {end}"));
    assert!(
        place("NOT CONVERGED: ") < place("friction coefficient"),
        "{text}"
    );
    let summary = read(&bad.0);
    assert_eq!(summary["trustworthy"], false);
    let missed = summary["solver"]["unconverged_steps"].as_u64().unwrap();
    let sentence = format!("NOT CONVERGED: {missed} of 1000 steps");
    let (reasons, warnings) = (
        sentences(&summary["reasons"]),
        sentences(&summary["warnings"]),
    );
    assert!(
        missed > 0 && reasons.iter().any(|r| r.starts_with(&sentence)),
        "{reasons:?}"
    );
    assert_eq!(reasons, warnings[..reasons.len()]);
    let strict = said(&hasty.run(&bad.0, &["--resume", "--strict"]), 1);
    assert!(
        strict.contains("is finished") && strict.contains("not trustworthy, NOT CONVERGED"),
        "{strict}"
    );
    let strict = said(&hasty.run(&bad.0, &["--strict", "--json"]), 1);
    assert!(strict.contains("\"trustworthy\": false"), "{strict}");

    // The band is above the pictures, whatever they show.
    for name in [
        "energy.png",
        "fretting_loops.png",
        "frames/frame_00001000.png",
    ] {
        let [with, without] = [&bad.0, &good.0].map(|f| height(&f.join(name)));
        assert!(with > without, "{name}: {with} {without}");
    }
}

/// Student's interval over the later half of the cycles follows from the list in the summary, and k
/// from the other numbers.
#[test]
fn the_interval_of_friction_is_that_of_the_cycles_in_the_file() {
    let job = Job {
        case: CASE,
        sets: &[
            "time.end=0.2",
            "output.frames=0",
            "output.figures=false",
            "uncertainty.repeats=3",
        ],
    };
    let out = Folder::new("ending-interval");
    let text = job.done(&out.0, &[]);
    let summary = read(&out.0);
    let cycles = summary["cycles"].as_array().unwrap().iter();
    let complete = cycles.filter(|c| c["complete"] == true);
    let mu: Vec<f64> = complete
        .map(|c| c["friction_coefficient"].as_f64().unwrap())
        .collect();
    assert_eq!(mu.len(), 4);
    // The later half would be two cycles: three are used, and t(2, 0.975) = 4.302653.
    let mu = &mu[1..];
    let mean = mu.iter().sum::<f64>() / 3.0;
    let square: f64 = mu.iter().map(|m| (m - mean).powi(2)).sum();
    let half = 4.302_652_73 * (square / 2.0 / 3.0).sqrt();
    let known = &summary["uncertainty"]["friction_coefficient"];
    assert!((known["value"].as_f64().unwrap() / mean - 1.0).abs() < 1e-12);
    assert_eq!(known["value"], summary["friction_coefficient"]);
    assert!((known["scatter"].as_f64().unwrap() / half - 1.0).abs() < 1e-6);
    // These half-widths are from repeated steps.
    assert!(known["step"].as_f64().unwrap() >= 0.0 && known["tolerance"].as_f64().unwrap() >= 0.0);
    assert!(text.contains("within this sample (3 cycles)"), "{text}");
    let damage = &summary["uncertainty"]["damage_ratio"];
    assert_eq!(damage["value"], summary["damage_ratio"]);
    assert!(damage["scatter"].is_null());
}
