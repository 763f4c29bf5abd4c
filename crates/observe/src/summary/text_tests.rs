use super::*;
use crate::cycle::{Cycle, SlipRegime};
use crate::first_bodies::BodyWear;
use crate::fretting;
use crate::friction::Cycles;
use crate::friction_report;
use crate::quantity::unit::{ENERGY, METRE, ONE};
use crate::summary::Uncertainty;
use crate::warning::Warning;
use crate::wear::WearSummary;

/// Returns fifty cycles of a fretting test with damage and wear, partial slip at first and gross
/// slip at the end.
fn fretting() -> Summary {
    let cycle = |k: u32| Cycle {
        cycle: k,
        complete: true,
        friction_coefficient: (k >= 10).then(|| 0.4 + 1e-3 * f64::from(k * 7 % 5)),
        energetic_coefficient: 0.4,
        friction_from_dissipation: 0.41,
        normal_force: 1e3,
        tangential_amplitude: 550.0,
        work: 2e-3,
        energy_ratio: if k < 10 { 0.1 } else { 0.8 },
        regime: if k < 10 {
            SlipRegime::Partial
        } else {
            SlipRegime::Gross
        },
        wear_volume: 1e-15,
        ..Cycle::default()
    };
    let mut cycles = Cycles::new(0.0, Some(1.0), 50.0);
    cycles.list = (1..=50).map(cycle).collect();
    let mut found = Findings::new(3);
    found.begin(Topic::Energy, Role::Detail);
    let work = found.add("energy.external_work", 0.11, ENERGY, "work");
    work.secondary("external work");
    found.begin(Topic::Damage, Role::Detail);
    let ratio = found.add("damage_ratio", 0.3, ONE, "broken over made");
    ratio
        .headline("damage ratio")
        .remark("(12 of 40 bonds broken)");
    let body = |name: &str, volume: f64| BodyWear {
        body: name.to_owned(),
        volume,
        depth_mean: Some(1e-7),
        depth_max: Some(3e-7),
        specific_rate: Some(volume / 10.0),
        archard_coefficient: None,
        hardness: None,
    };
    let wear = WearSummary {
        volume_first_bodies: 5e-14,
        bodies: vec![body("rail", 3e-14), body("wheel", 2e-14)],
        ..WearSummary::default()
    };
    wear.report(true, "between grains", &mut found);
    friction_report::report(
        &cycles,
        fretting::FrettingOutcome::new(&cycles.list),
        &mut found,
    );
    for k in 0..31 {
        found.measure(&format!("layer_{k:02}"), 1.0, METRE, "a measure");
    }
    found.finding("layer", "it flows", "how the layer flows");
    Uncertainty::new(&found, crate::error_estimate::Repeats::default()).report(&mut found);
    let mut summary = Summary::default();
    summary.run.case = "wheel on rail".to_owned();
    summary.run.dimension = 3;
    summary.found = found;
    summary.check();
    summary
}

fn place(text: &str, what: &str) -> usize {
    text.find(what)
        .unwrap_or_else(|| panic!("no `{what}` in:\n{text}"))
}

#[test]
fn the_end_of_a_run_has_at_most_14_lines_of_100_columns_in_their_order() {
    let mut summary = fretting();
    let long =
        "the steps are too long, and this sentence says more than a line holds; it goes on, and on";
    let warnings = [
        "NOT STEADY",
        "NOT UNIQUE",
        "COARSE DRIVE",
        "ERROR NOT KNOWN",
    ];
    let notes = warnings.map(|of| Warning::note(of, long));
    summary.found.warn(notes);
    summary
        .found
        .warn([Warning::serious("NOT CONVERGED", "12 of 6000 steps")]);
    summary.check();
    let text = summary.text(false);
    assert!(
        text.starts_with("NOT TRUSTWORTHY\n  NOT CONVERGED: 12 of 6000 steps\n"),
        "{text}"
    );
    let order = [
        "NOT CONVERGED",
        "  friction   ",
        "  wear       ",
        "  damage     ",
        "  regime     ",
        "  measures   ",
        "  look at    1 NOT STEADY",
        "             2 ",
        "             3 ",
        "  run        ",
    ];
    let places: Vec<usize> = order.iter().map(|w| place(&text, w)).collect();
    assert!(places.is_sorted(), "{places:?}\n{text}");
    assert!(text.lines().count() <= 14, "{text}");
    assert!(text.lines().all(|l| l.chars().count() <= 100), "{text}");
    assert!(!text.contains("             4 "), "{text}");
}

#[test]
fn a_trusted_run_begins_with_its_grade_and_what_is_known_of_the_error() {
    let mut summary = fretting();
    summary.run.sample.random = true;
    summary.run.sample.seeds = Some("one seed".to_owned());
    summary.check();
    assert_eq!(summary.run.grade, crate::summary::Grade::Consistent);
    let text = summary.text(false);
    // For k in 26..=50 each of 0.400 to 0.404 occurs five times: mean 0.402, deviation 1e-3
    // sqrt(2 * 25/24), t(24, 0.975) = 2.0639: 0.000596.
    assert!(
        text.starts_with(
            "CONSISTENT: ledgers close, steps converged; error of friction coefficient not known to be small\n"
        ),
        "{text}"
    );
    let says = &summary.run.grade_sentence;
    assert_eq!(
        says,
        "error of friction coefficient not known by step, tolerance, seeds; known: within this sample (25 cycles) 0.15 %"
    );
    place(
        &text,
        "friction coefficient 0.4020 +- 0.00060, mean of cycles 26 to 50",
    );
    let rate = place(
        &text,
        "wear       rail 3.000e-5 mm3, k 3.000e-6 mm3/(N m); wheel 2.000e-5",
    );
    assert!(
        rate < place(&text, "wear of first bodies 5.000e-5"),
        "{text}"
    );
    place(&text, "wear per energy 0.0005000 mm3/J");
    place(&text, "damage ratio 0.3000");
    place(&text, "gross slip in cycle 50; mixed over all cycles");
    place(&text, "look at    1 one seed");
    assert!(!text.contains("layer_30"), "{text}");
}

#[test]
fn a_result_with_a_large_half_width_is_not_determined() {
    let mut summary = fretting();
    let estimate = crate::quantity::Estimate {
        value: Some(0.3),
        step: Some(0.19),
        tolerance: Some(0.04),
        ..crate::quantity::Estimate::default()
    };
    summary.found.estimate("damage_ratio", &estimate);
    summary.check();
    let text = summary.text(false);
    // The root of the sum of squares of 0.19 and 0.04.
    place(&text, "damage ratio not determined: 0.3000 +- 0.19");
    place(
        &text,
        "damage ratio is not determined: step may change 63 %",
    );
    place(
        &summary.text(true),
        "not determined: 0.3000 +- 0.19 (step) +- 0.040 (tolerance)",
    );
}

/// The file has the number of the terminal, with what it is of.
#[test]
fn friction_is_one_number_on_the_terminal_and_in_the_file() {
    let summary = fretting();
    let file = serde_json::to_value(&summary).unwrap();
    let mean = file["friction_coefficient"].as_f64().unwrap();
    assert!((mean - 0.402).abs() < 1e-12, "{mean}");
    let estimate = &file["uncertainty"]["friction_coefficient"];
    assert_eq!(estimate["value"], file["friction_coefficient"]);
    assert_eq!(estimate["statistic"], "mean of cycles 26 to 50");
    // Cycle 50 by itself.
    assert_eq!(file["cycles"][49]["friction_coefficient"], 0.4);
    let text = summary.text(true);
    let mut lines = text.lines().map(str::trim_start);
    let line = lines.find(|line| line.starts_with("friction coefficient"));
    assert!(line.is_some_and(|line| line.contains("0.4020") && !line.contains("in cycle 50")));
}

#[test]
fn results_have_units_and_intervals() {
    let text = fretting().text(true);
    assert!(!text.contains("NOT TRUSTWORTHY"));
    place(
        &text,
        "0.4020 +- 0.00060 (within this sample (25 cycles); 95 %, Student, cycles 26 to 50",
    );
    place(
        &text,
        "0.5500 in cycle 50, the last complete one: largest |Q| over mean P",
    );
    place(&text, "50 complete; none (partial slip) in the first");
    place(&text, "gross slip in cycle 50; mixed over all cycles");
    place(
        &text,
        "3.000e-5 mm3, k 3.000e-6 mm3/(N m); 100.0 nm deep on average where worn, 300.0 nm at most",
    );
    place(&text, "external work          110.0 mJ");
    place(
        &text,
        "damage ratio           0.3000 (12 of 40 bonds broken)",
    );
}

#[test]
fn all_there_is_comes_on_request() {
    let text = fretting().text(true);
    for what in [
        "layer_30",
        "cycle 1 ",
        "cycle 50",
        "estimate of the error",
        "made with",
    ] {
        place(&text, what);
    }
    assert!(!text.contains("cycle 25"), "{text}");
}
