//! Errors of a study compared with a closed form, and the effect of failed runs.

use super::{
    BOND, Folder, HEAP, RELEASED, call, frontier_is_what_nothing_dominates, number, set_to,
    settings, study,
};
use serde_json::Value;
use std::path::Path;

const STEPS: &str = "time.step=4e-8,8e-8,1.6e-7,3.2e-7";

#[test]
fn errors_fall_with_the_step_against_a_closed_form() {
    let folder = Folder::new("bond");
    let out = folder.out();
    let exact = format!("energy.fracture={RELEASED}");
    let base = [
        "--set",
        "time.step=4e-8",
        "--set",
        "coupling=Explicit",
        "--vary",
        STEPS,
        "--budget",
        "5m",
        "--out",
        &out,
    ];
    let common = [&[BOND][..], &base].concat();
    let found = study(
        &[
            &common[..],
            &["--output", "energy.fracture=1%", "--exact", &exact],
        ]
        .concat(),
    );
    assert_eq!(found["complete"], true);
    assert_eq!(found["random"], false, "nothing in this case is drawn");
    assert_eq!(found["runs"]["fresh"], 4);
    let mut errors: Vec<(f64, f64)> = settings(&found)
        .iter()
        .map(|s| {
            let step = set_to(s, "time.step").unwrap_or(4e-8);
            (step, number(s, "/outputs/energy.fracture/error/mean"))
        })
        .collect();
    errors.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(errors.len(), 4);
    // Damage is coupled explicitly: the method is of first order, so halving the step halves the
    // error.
    for pair in errors.windows(2) {
        let ratio = pair[1].1 / pair[0].1;
        assert!((1.7..2.3).contains(&ratio), "{errors:?}");
    }
    assert!(errors[0].1.abs() < 5e-3, "{errors:?}");
    frontier_is_what_nothing_dominates(&found, "energy.fracture");
    // The cheapest setting for 1 % is the cheapest within 1 % of the exact value.
    let within: Vec<Value> = settings(&found)
        .into_iter()
        .filter(|s| number(s, "/outputs/energy.fracture/error/mean").abs() <= 0.01)
        .collect();
    let cheapest = within
        .iter()
        .min_by(|a, b| number(a, "/seconds").total_cmp(&number(b, "/seconds")));
    assert_eq!(
        found["cheapest"][0]["setting"],
        cheapest.unwrap_or(&Value::Null)["setting"]
    );
    assert_eq!(found["cheapest"][0]["holds"], true);
    let table = std::fs::read_to_string(Path::new(&out).join("trade.csv")).unwrap_or_default();
    assert_eq!(table.lines().count(), 5, "{table}");
    let picture = std::fs::read(Path::new(&out).join("trade.png")).unwrap_or_default();
    assert!(picture.starts_with(b"\x89PNG") && picture.len() > 5000);

    // The study is repeated without the exact value, from the existing runs: the reference's own
    // error is the difference to its neighbour, and the claims must agree with the exact value.
    let again = study(&[&common[..], &["--output", "energy.fracture=1%"]].concat());
    assert_eq!(
        (&again["runs"]["fresh"], &again["runs"]["reused"]),
        (&0.into(), &4.into())
    );
    let own = number(&again, "/outputs/0/reference_error_at_most");
    let truth = errors[0].1;
    assert!(
        (own - (errors[1].1 - truth)).abs() < 1e-2 * own.abs(),
        "{own} {errors:?}"
    );
    for s in settings(&again) {
        let step = set_to(&s, "time.step").unwrap_or(4e-8);
        let error = errors
            .iter()
            .find(|e| (e.0 - step).abs() < 1e-3 * step)
            .map_or(f64::NAN, |e| e.1);
        let bound = number(&s, "/outputs/energy.fracture/at_most_with_reference");
        assert!(error.abs() <= bound * 1.05, "{error} against {bound}");
        assert!(
            bound <= 1.3 * error.abs(),
            "{bound} says nothing of {error}"
        );
    }
    // An error that the reference itself does not reach is not claimed.
    let fine = study(&[&common[..], &["--output", "energy.fracture=0.1%"]].concat());
    assert_eq!(fine["cheapest"][0]["holds"], false);
}

#[test]
fn failed_runs_are_marked_and_kept_off_the_frontier() {
    let folder = Folder::new("failed");
    let (case, out) = (folder.file("heap.ron", HEAP), folder.out());
    let common = [
        &case[..],
        "--output",
        "energy.friction=5%",
        "--seeds",
        "2",
        "--budget",
        "5m",
        "--out",
        &out,
    ];
    let found = study(&[&common[..], &["--vary", "solver.max_iterations=5000,1"]].concat());
    let all = settings(&found);
    let failed: Vec<&Value> = all.iter().filter(|s| !s["failed"].is_null()).collect();
    assert_eq!((all.len(), failed.len()), (2, 1));
    assert!(failed[0]["failed"].to_string().contains("did not converge"));
    let flag = failed[0]
        .pointer("/outputs/energy.friction/frontier")
        .and_then(Value::as_bool);
    assert_ne!(flag, Some(true));
    frontier_is_what_nothing_dominates(&found, "energy.friction");
    // Without a reference there is nothing to compare with.
    let output = call(&[&common[..], &["--vary", "solver.max_iterations=1,2"]].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("the reference") && said.contains("did not converge"),
        "{said}"
    );
}
