//! Reports of a run on its heat: an account that does not close, half-spaces, laws that are not
//! called, laws with their own clock.

use crate::scene;
use fretwork::geometry::space::Dim2;
use fretwork::record::heat::HeatChecks;
use fretwork::record::statistics::Table;
use fretwork::record::summary::Uncertainty;
use fretwork::record::{RunEnd, Summary, run_observers};
use fretwork::scene::{Built, LoadedCase};
use std::process::Command;
use std::time::Duration;

fn built(case: &str, sets: &[&str]) -> (LoadedCase, Built) {
    let fixed = ["output.figures=false", "uncertainty.repeats=0"];
    let sets = [&fixed[..], sets].concat();
    let loaded = scene::loaded(&format!("verification/thermal/{case}"), &sets);
    let built = scene::built(&loaded);
    (loaded, built)
}

fn ran((loaded, built): (LoadedCase, Built)) -> Summary {
    scene::finished(&loaded, built, |_| {})
}

fn residual(summary: &Summary) -> f64 {
    let found = &summary.found;
    found.number("measures.heat_residual_relative").unwrap()
}

/// Warnings of a category.
fn of<'a>(summary: &'a Summary, category: &str) -> Vec<&'a String> {
    let start = format!("{category}: ");
    let all = summary.run.warnings.iter();
    all.filter(|w| w.starts_with(&start)).collect()
}

#[test]
fn an_account_of_heat_that_does_not_close_is_a_reason() {
    let summary = ran(built("half_space", &[]));
    assert!(residual(&summary) < 1e-9);
    assert!(summary.run.trustworthy, "{:?}", summary.run.warnings);
    // A joule without a source is added to the ten that flow.
    let (loaded, mut built) = built("half_space", &[]);
    let heat = built.simulation.get_mut::<Dim2>().unwrap();
    let heat = heat.state.heat.as_mut().unwrap();
    heat.ledger.imposed += 1.0;
    let summary = ran((loaded, built));
    let off = residual(&summary);
    assert!((off - 1.0 / 11.0).abs() < 1e-6, "{off}");
    assert!(!summary.run.trustworthy);
    let reasons: Vec<&String> = summary.run.reasons.iter().collect();
    assert_eq!(reasons, of(&summary, "HEAT DOES NOT ADD UP"));
    assert!(reasons[0].contains("9.1e-2"), "{reasons:?}");
}

#[test]
fn a_transport_law_without_heat_is_told_once() {
    let with = ran(built("two_half_spaces", &["time.end=1e-4"]));
    assert!(of(&with, "NO HEAT").is_empty(), "{:?}", with.run.warnings);
    let without = ["time.end=1e-4", "heat=None"];
    let summary = ran(built("two_half_spaces", &without));
    let reported = of(&summary, "NO HEAT");
    assert_eq!(reported.len(), 1);
    assert!(
        reported[0].contains("transport law of `contact`") && reported[0].contains("`heat: ()`")
    );
    assert!(summary.run.trustworthy, "{:?}", summary.run.reasons);
}

#[test]
fn half_spaces_that_heat_reaches_the_depth_of_are_told() {
    let reach = (50.0f64 / (450.0 * 7850.0) * 1e-2).sqrt();
    for (depth, reported) in [(None, false), (Some(4.1), false), (Some(3.0), true)] {
        let depth = depth.map(|d: f64| d * reach);
        let set = format!("heat.bodies.rail.store.depth={depth:?}");
        let summary = ran(built("half_space", &[&set]));
        let found = &summary.found.get::<HeatChecks>().unwrap().half_spaces[0];
        assert!((found.reach / reach - 1.0).abs() < 1e-9);
        let given = depth.unwrap_or(6.0 * reach);
        // The depth is rounded to the next point of the grid.
        assert!((given..1.3 * given).contains(&found.depth), "{found:?}");
        let notes = of(&summary, "SHALLOW HALF-SPACES");
        assert_eq!(notes.len(), usize::from(reported), "{notes:?}");
        assert!(notes.iter().all(|n| n.contains("`rail`")));
    }
}

/// Both corners of the block conduct equally, and one of them is beside the range of the floor.
#[test]
fn heat_that_contacts_conduct_beside_half_spaces_is_told() {
    let summary = ran(built("two_half_spaces", &["time.end=1e-4"]));
    assert!(of(&summary, "HEAT OUT OF RANGE").is_empty());
    let sets = [
        "time.end=1e-4",
        "heat.bodies.floor.store.over=[(-0.5e-3, 1.5e-3)]",
    ];
    let summary = ran(built("two_half_spaces", &sets));
    let spaces = &summary.found.get::<HeatChecks>().unwrap().half_spaces;
    let shares: Vec<f64> = spaces.iter().map(|h| h.outside).collect();
    assert!((shares[0] - 0.5).abs() < 1e-9 && shares[1] == 0.0);
    let reported = of(&summary, "HEAT OUT OF RANGE");
    assert_eq!(reported.len(), 1);
    assert!(reported[0].contains("50 % for `floor`") && reported[0].contains("`over`"));
}

/// Of the friction at the two corners of a block that does not conduct, that of the rear corner is
/// beside the range.
#[test]
fn heat_that_contacts_put_in_beside_half_spaces_is_that_of_their_friction() {
    let (loaded, built) = built(
        "two_half_spaces",
        &[
            "interfaces.0.contact=\"coulomb\"",
            "interfaces.0.parameters.contact={\"mu\": 0.5}",
            "interfaces.0.parameters.transport={\"thermal\": 0.0, \"reach\": 1e-6}",
            "bodies.1.dofs.x=Velocity(Constant(0.1))",
            "heat.shares.impact=0.0",
            "heat.bodies.floor.store.over=[(-0.5e-3, 1.5e-3)]",
        ],
    );
    let mut s = built.simulation.into_dimension::<Dim2>().unwrap();
    let mut observers = run_observers(&loaded, &s);
    observers.begin(&mut s);
    for _ in 0..100 {
        let report = s.step().unwrap();
        observers.after_step(&s, &report);
    }
    let table = Table::new(observers.columns(), 2);
    let end = RunEnd {
        simulation: &s,
        table: &table,
        title: "test",
        uncertainty: &Uncertainty::default(),
        wall: Duration::ZERO,
    };
    let found = observers.report(&end);
    let floor = s.body_named("floor").unwrap() as u32;
    let (mut beside, mut all) = (0.0, 0.0);
    for contact in &s.state.network.contacts {
        let side = usize::from(contact.bodies[1] == floor);
        assert_eq!(contact.bodies[side], floor);
        all += contact.friction_work;
        if contact.arms[side].x < -0.5e-3 {
            beside += contact.friction_work;
        }
    }
    assert!(beside > 0.0 && beside < all);
    let found = found.number("heat.half_spaces.0.outside").unwrap();
    assert!(
        (found - beside / all).abs() < 1e-9,
        "{found} {beside} {all}"
    );
}

#[test]
fn laws_that_count_time_of_the_mechanics_are_told_where_heat_has_a_clock() {
    let check = |sets: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args([
                "check",
                "cases/verification/thermal/cubic.ron",
                "--no-timing",
                "--verbose",
            ])
            .args(sets.iter().flat_map(|s| ["--set", s]))
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let reported = text.lines().filter(|l| l.contains("MECHANICAL TIME"));
        reported.map(str::to_owned).collect::<Vec<_>>()
    };
    let laws = [
        "interfaces.0.transport=oxide-film",
        "interfaces.0.wear=Some(\"oxidation\")",
    ];
    assert!(check(&[]).is_empty());
    let reported = check(&laws);
    assert_eq!(reported.len(), 2, "{reported:?}");
    assert!(
        reported
            .iter()
            .any(|t| t.contains("transport law `oxide-film` of `steel`"))
    );
    assert!(
        reported
            .iter()
            .any(|t| t.contains("wear law `oxidation` of `steel`"))
    );
    assert!(check(&[&laws[..], &["heat.clock=1.0"]].concat()).is_empty());
}
