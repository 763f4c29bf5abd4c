//! Runs that choose their step and tolerance, compared with fixed settings.

use super::{Folder, frontier_is_what_nothing_dominates, number, settings, study};

/// A case without an accuracy is its own fixed setting; a run with an accuracy of a tenth of a per
/// cent refines its step until it is nearer to the reference with a sixteenth of the step.
#[test]
fn runs_that_choose_their_settings_are_compared_with_fixed_ones() {
    let folder = Folder::new("accuracy");
    let out = folder.out();
    let case = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/fretting_scar.ron");
    let found = study(&[
        case,
        "--set",
        "time.step=2e-3",
        "--set",
        "solver.tolerance=1e-4",
        "--setting",
        "accuracy",
        "--vary",
        "time.step=1.25e-4,2e-3",
        "--output",
        "energetic_coefficient=0.3%",
        "--seeds",
        "1",
        "--budget",
        "10m",
        "--out",
        &out,
    ]);
    let all = settings(&found);
    let named = |name: &str| {
        let found = all.iter().find(|s| s["setting"] == name);
        found.unwrap_or_else(|| panic!("no {name} in {all:#?}"))
    };
    let error = |name: &str| number(named(name), "/outputs/energetic_coefficient/error/mean").abs();
    assert_eq!(
        named("accuracy 0.001")["sets"],
        serde_json::json!(["accuracy=0.001"])
    );
    for share in ["0.03", "0.01", "0.003"] {
        assert!(named(&format!("accuracy {share}"))["failed"].is_null());
    }
    let (own, chosen) = (error("the case's own"), error("accuracy 0.001"));
    assert!(own > 0.003 && chosen < 0.5 * own, "{own} and {chosen}");
    frontier_is_what_nothing_dominates(&found, "energetic_coefficient");
}
