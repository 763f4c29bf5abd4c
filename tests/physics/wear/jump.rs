//! Jumps over cycles, compared with runs that compute every cycle.

use crate::scene;
use fretwork::record::Summary;
use fretwork::record::jump::JumpSummary;
use fretwork::scene::load;

/// The summary of a case, and the depths of the scar of `flat` if there is one (m).
fn ran(case: &str, sets: &[&str]) -> (Summary, Vec<f64>) {
    let sets = [&["output.figures=false", "output.frames=0"], sets].concat();
    let mut depths: Vec<f64> = Vec::new();
    let summary = scene::ran(case, &sets, |out| {
        let text = std::fs::read_to_string(out.join("scar_flat.csv")).unwrap_or_default();
        let depth = |line: &str| line.rsplit(',').next().and_then(|x| x.parse::<f64>().ok());
        depths.extend(text.lines().skip(1).filter_map(depth));
    });
    (summary, depths)
}

fn number(summary: &Summary, name: &str) -> f64 {
    let found = summary.found.number(name);
    found.unwrap_or_else(|| panic!("no {name}"))
}

fn refused(case: &str, sets: &[&str]) -> String {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    match load(&scene::file(case), &sets) {
        Ok(_) => panic!("{sets:?} was taken"),
        Err(e) => e.to_string(),
    }
}

/// Bound of the comparison from the literature: Cruzado et al. (2012) stay within 4 % over a
/// hundred cycles.
const BOUND: f64 = 0.04;

/// The jumps of a run over 1000 cycles with a twentieth of the steps of the full run.
fn twenty_times_fewer<'a>(jumped: &'a Summary, full: &Summary) -> &'a JumpSummary {
    let jump = jumped.found.get::<JumpSummary>().unwrap();
    assert_eq!(jump.represented_cycles, 1000);
    let steps = [jumped, full].map(|s| s.found.number("steps").unwrap());
    assert!(20.0 * steps[0] <= steps[1], "{steps:?}");
    jump
}

/// Wear of the cylinder on a flat: volume, largest depth and profile are compared with the run that
/// computes every cycle.
#[test]
fn a_scar_by_jumps_is_the_scar_of_all_cycles() {
    let (jumped, profile) = ran("fretting_wear_jump", &[]);
    let (full, expected) = ran("fretting_wear_jump", &["jump=None"]);
    let jump = twenty_times_fewer(&jumped, &full);
    assert!(full.found.get::<JumpSummary>().is_none());
    let volume = jump.wear_volume / number(&full, "wear.volume_first_bodies") - 1.0;
    let most = |d: &[f64]| d.iter().copied().fold(0.0, f64::max);
    let deepest = most(&profile) / most(&expected) - 1.0;
    let differ = profile.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    let form = differ.clone().sum::<f64>() / expected.iter().sum::<f64>();
    let farthest = differ.fold(0.0, f64::max) / most(&expected);
    let truly = volume.abs() + form;
    println!(
        "{} steps for {}: volume {volume:.1e}, deepest {deepest:.1e}, profile {form:.1e}, farthest {farthest:.1e}; estimated {:.1e}",
        number(&jumped, "steps"),
        number(&full, "steps"),
        jump.error_estimate.unwrap()
    );
    assert!(volume.abs() < BOUND && deepest.abs() < BOUND && form < BOUND);
    let estimate = jump.error_estimate.unwrap();
    assert!(estimate > 0.5 * truly, "{estimate} {truly}");
    assert!(estimate < 10.0 * truly.max(0.01));
    assert!(number(&jumped, "energy_residual_relative") < 1e-12);
    // The ratio of V to E_d covers all cycles: it is k/mu, since Archard's volume is k P times the
    // path, and E_d is mu P times it.
    let [a, b] = [&jumped, &full].map(|s| number(s, "fretting.energy"));
    assert!((a / b - 1.0).abs() < BOUND, "{a} {b}");
    let alpha = number(&jumped, "fretting.alpha.value");
    assert!((alpha / (1.5e-12 / 0.6) - 1.0).abs() < 0.02, "{alpha}");
    assert!((number(&jumped, "wear.Qs") / number(&full, "wear.Qs") - 1.0).abs() < BOUND);
}

/// Damage of a bond under cycles of force grows faster and faster as the bond weakens.
#[test]
fn the_damage_of_a_bond_by_jumps_is_that_of_all_cycles() {
    let (jumped, _) = ran("verification/bond_fatigue", &[]);
    let (full, _) = ran("verification/bond_fatigue", &["jump=None"]);
    let jump = twenty_times_fewer(&jumped, &full);
    let error = number(&jumped, "mean_damage") / number(&full, "mean_damage") - 1.0;
    println!(
        "{} steps for {}: D {:.5} for {:.5}, {error:.1e}; estimated {:.1e}; {:?}",
        number(&jumped, "steps"),
        number(&full, "steps"),
        number(&jumped, "mean_damage"),
        number(&full, "mean_damage"),
        jump.error_estimate.unwrap(),
        jump.jumps
    );
    // The growth is far from linear: the rate of the first cycle would give less than three
    // quarters of it.
    assert!(number(&full, "mean_damage") > 0.2 && number(&full, "mean_damage") < 0.9);
    assert!(error.abs() < BOUND);
    let estimate = jump.error_estimate.unwrap();
    assert!(estimate > error.abs() && estimate < 1.5 * BOUND);
    let [a, b] = [&jumped, &full].map(|s| number(s, "fretting.energy"));
    println!("E_d {:.1e}", a / b - 1.0);
    assert!((a / b - 1.0).abs() < BOUND, "{a} {b}");
    // Two variables are not extrapolated: the travel that the law counts, and the traction at the
    // last reversal.
    assert_eq!(jump.not_jumped.len(), 2, "{:?}", jump.not_jumped);
    assert!(number(&jumped, "energy_residual_relative") < 1e-12);
}

/// A bond breaks at about the cycle at which it breaks without jumps, and its energy is booked.
#[test]
fn a_bond_that_breaks_in_a_jump_closes_the_ledger() {
    let soft = "interfaces.0.parameters.damage.length=0.4";
    let wear = "interfaces.0.wear=\"broken-bonds\"";
    let (jumped, _) = ran("verification/bond_fatigue", &[soft, wear]);
    assert_eq!(number(&jumped, "broken"), 1.0);
    // A jump in which the bond broke has an error, which it reports.
    let estimate = jumped.found.get::<JumpSummary>().unwrap().error_estimate;
    assert!(estimate.is_some_and(|e| e > 0.0), "{estimate:?}");
    // A bond releases its energy once, however many cycles the step represents.
    let once = number(&jumped, "wear.volume_third_body");
    let (full, _) = ran("verification/bond_fatigue", &[soft, wear, "jump=None"]);
    assert_eq!(number(&full, "broken"), 1.0);
    assert!(once > 0.0 && (once / number(&full, "wear.volume_third_body") - 1.0).abs() < 1e-12);
    assert!(
        number(&jumped, "energy_residual_relative") < 1e-12,
        "{}",
        number(&jumped, "energy_residual_relative")
    );
}

/// Surfaces that are updated rarely are updated at once within a jump; the load is imposed, so the
/// volume is Archard's in any case.
#[test]
fn surfaces_that_follow_seldom_do_so_at_once_in_a_jump() {
    let sets = ["bodies.flat.wears.every=40", "jump.cycles=300"];
    let (seldom, _) = ran("fretting_wear_jump", &sets);
    let (often, _) = ran("fretting_wear_jump", &["jump.cycles=300"]);
    let [a, b] = [&seldom, &often].map(|s| s.found.number("scars.0.depth").unwrap());
    println!("depth {:.1e} of that which follows every step", a / b - 1.0);
    assert!((a / b - 1.0).abs() < 0.1, "{a} {b}");
}

#[test]
fn at_most_one_cycle_is_no_jump() {
    let sets = ["jump.at_most=1", "jump.cycles=12"];
    let (summary, _) = ran("verification/bond_fatigue", &sets);
    let jump = summary.found.get::<JumpSummary>().unwrap();
    assert_eq!((jump.computed_cycles, jump.represented_cycles), (12, 12));
    assert!(jump.jumps.is_empty());
}

#[test]
fn jumps_that_mean_nothing_are_refused() {
    let scar = |sets: &[&str]| refused("fretting_wear_jump", sets);
    for (sets, says) in [
        (&["friction=None"][..], "without `friction` there are none"),
        (
            &["bodies.cylinder.dofs.x=Velocity(Constant(1.0))"],
            "has no period",
        ),
        (
            &["bodies.flat.wears=None"],
            "no body `wears` and no interface has a damage law",
        ),
        (&["jump.at_most=0"], "must be at least 1"),
        (&["jump.control=0"], "must be at least 1"),
        (&["jump.after=0"], "checked against the cycle before it"),
        (&["jump.cycles=0"], "must be at least 1"),
        (&["jump.tolerance=0.0"], "must be positive, got 0"),
        (&["jump.growth=-1.0"], "must be positive, got -1"),
        (
            &["time.step=3e-3"],
            "choose a time.step that divides the cycle",
        ),
        (&["jump.at_most=4294967295"], "at most 100000"),
        (
            &["friction.period=0.013"],
            "its sine turns 0.65 times in a cycle",
        ),
        (
            &["bodies.cylinder.dofs.y=Force(Sine(amplitude: 9e4, frequency: 0.5, offset: -1e5))"],
            "its sine turns 0.01 times in a cycle",
        ),
        (
            &["bodies.cylinder.dofs.y=Force(Ramp(from: 0.0, to: -1e5, start: 0.0, end: 5.0))"],
            "its ramp lasts until 5e0 s",
        ),
        (
            &[
                "bodies.cylinder.dofs.x=Velocity(Constant(1e-3))",
                "friction.period=0.02",
            ],
            "it continues in one direction",
        ),
        (
            &["phases=[(name: \"a\", until: Time(10.0)), (name: \"b\")]"],
            "phases follow the simulated time",
        ),
        (&["circuit=(bases: [\"flat\"])"], "leave one of the two out"),
    ] {
        let said = scar(sets);
        assert!(said.contains(says), "{sets:?}: {said}");
        assert!(said.contains("fretting_wear_jump.ron:"), "{said}");
    }
}

/// Wear of a half-space is sufficient for jumps, without a damage law.
#[test]
fn wear_of_half_spaces_may_jump() {
    scene::loaded("fretting_wear_elastic", &["jump=(after: 3, at_most: 50)"]);
}

/// Drives of holders of deformable bodies must repeat with each cycle too.
#[test]
fn drives_of_holders_that_do_not_repeat_are_refused() {
    let jump = "jump=(after: 3, at_most: 50)";
    let load =
        "half_spaces.cylinder.dofs.y=Force(Ramp(from: 0.0, to: -178.9e3, start: 0.0, end: 50.0))";
    let reported = refused("fretting_wear_elastic", &[jump, load]);
    assert!(reported.contains("its ramp lasts until"), "{reported}");
}
