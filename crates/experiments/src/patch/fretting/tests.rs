//! Fretting by the command: maps, lines, forces and many cycles, against closed forms.

use crate::Error;
use crate::patch::tests::{folder, laws, near, solved};
use crate::patch::{Outcome, page};
use crate::patch::{PatchFile, solve};
use fretwork_rolling::running::Regime;
use fretwork_view::Block;

const MU: f64 = 0.6;

/// A ball of steel of nu 0 on a plane, with an interface and the rest of the file.
fn ball(name: &str, interface: &str, rest: &str) -> Result<Outcome, Error> {
    let text = format!(
        r#"(
            name: "a ball", materials: {{"ball": "simple"}},
            bodies: ((material: "ball", radius: 50 mm, across: 50 mm), (material: "ball")),
            interfaces: [(name: "dry", between: ("ball", "ball"), {interface})],
            load: 100 N, cells: 24, {rest}
        )"#
    );
    solved(name, &text)
}

const COULOMB: &str = r#"contact: "coulomb", parameters: (contact: {"mu": 0.6})"#;
const WEARS: &str = r#"contact: "coulomb", wear: "archard", parameters: (contact: {"mu": 0.6}, wear: {"k": 1e-14})"#;

fn failed(found: Result<Outcome, Error>) -> String {
    match found {
        Ok(outcome) => panic!("{}", outcome.answer.text()),
        Err(error) => error.to_string(),
    }
}

/// Displacement of Mindlin's sphere at the onset of gross slip under a load (K. L. Johnson, Contact
/// Mechanics, 1985, 7.4), at nu = 0.
fn gross(load: f64, mu: f64) -> f64 {
    let radius = f64::cbrt(3.0 * load * 0.05 / (4.0 * 100e9));
    3.0 * mu * load / (16.0 * radius) * 2.0 * 2.0 / 100e9
}

/// The boundaries of a map are Mindlin's within the error that is given, and so are force, energy
/// and the volume worn, k P s; A at the onset is 1/5. Members make the places between their onsets
/// mixed.
#[test]
fn a_map_has_the_boundaries_of_mindlin() {
    let rest = "motion: Fretting(map: (load: (from: 50 N, to: 200 N, count: 2), amplitude: (from: 0.05 um, to: 20 um, count: 6), cells: 24)), members: [(contact: {\"mu\": 0.3})]";
    let outcome = ball("map", WEARS, rest).unwrap();
    let map = outcome.answer.map.as_ref().unwrap();
    for (edges, row) in map.edges.iter().zip(&map.places) {
        let [onset, low] = [MU, 0.3].map(|mu| gross(edges.load, mu));
        let found = edges.gross_slip;
        assert!(
            (found.value - onset).abs() < 2.0 * found.error + 0.01 * onset,
            "{found:?}"
        );
        assert!(found.error < 0.1 * onset, "{found:?}");
        near(edges.energy_ratio.value, onset, 0.06);
        near(edges.at_onset[0], 0.2, 0.05);
        let [from, to] = edges.mixed.unwrap();
        near(from, low, 0.05);
        near(to, onset, 0.05);
        for place in row {
            let c = &place.conditions;
            let amplitude = c.amplitude[0];
            let slides = amplitude > found.value;
            assert_eq!(c.stuck == 0.0, slides, "{place:?}");
            let mixed = amplitude > from && amplitude <= to;
            assert_eq!(place.mixed, mixed, "{place:?}");
            if slides {
                near(c.amplitude[1], MU * edges.load, 1e-6);
                let d = amplitude / onset;
                near(c.energy, (4.0 * d - 3.2) * MU * edges.load * onset, 0.05);
                near(c.worn[0], 1e-14 * c.energy / MU, 1e-6);
            }
        }
    }
    let all = map.places.iter().flatten();
    assert!(all.clone().any(|p| p.regime == Regime::Stick));
    assert!(all.clone().any(|p| p.regime == Regime::GrossSlip));
    let text = outcome.answer.text();
    assert!(text.contains("gross slip begins at"), "{text}");
    assert!(text.contains("mixed between"), "{text}");
}

/// Cracks and wear on a map, by a strength that is known.
#[test]
fn a_map_has_the_response_of_the_material() {
    let cracks = "cracks: (strength: \"30NCD16\", block: 20 um, depth: 1 um)";
    let rest = format!(
        "motion: Fretting(map: (load: (from: 100 N, to: 800 N, count: 2), amplitude: (from: 0.05 um, to: 50 um, count: 3), cells: 24), {cracks})"
    );
    let outcome = ball("response", WEARS, &rest).unwrap();
    let map = outcome.answer.map.as_ref().unwrap();
    for (edges, row) in map.edges.iter().zip(&map.places) {
        let [crack, wear] = edges.damage.unwrap();
        for place in row {
            let amplitude = place.conditions.amplitude[0];
            assert_eq!(place.crack.unwrap() >= 1.0, amplitude > crack, "{place:?}");
            assert_eq!(place.worn.unwrap() >= 1e-6, amplitude > wear, "{place:?}");
            // 250,000 cycles of the strength.
            near(place.worn.unwrap(), 250e3 * place.conditions.worn[1], 1e-9);
        }
    }
    let refused = |from: &str, to: &str| failed(ball("refuses", WEARS, &rest.replace(from, to)));
    let unknown = refused("30NCD16", "cheese");
    assert!(unknown.contains("30NCD16, 6082-T6"), "{unknown}");
    let other = refused("block:", "cycles: 1e7, block:");
    assert!(other.contains("leave `cycles` out"), "{other}");
    let nothing = failed(ball("no-wear", COULOMB, &rest));
    assert!(
        nothing.contains("give the interface a wear law"),
        "{nothing}"
    );
}

/// A force has the displacement of Mindlin; one that friction does not hold is refused.
#[test]
fn strokes_by_force_have_mindlins_displacement() {
    let outcome = ball("force", COULOMB, "motion: Fretting(force: 30 N, steps: 4)").unwrap();
    let point = &outcome.answer.points[0];
    near(point.adhesion, 0.3, 1e-5);
    let expected = (1.0 - 0.5f64.powf(2.0 / 3.0)) * gross(100.0, MU);
    let found = point.stroke.unwrap().displacement;
    assert!(
        (found.value - expected).abs() < 2.0 * found.error + 0.01 * expected,
        "{found:?}"
    );
    let text = failed(ball(
        "too-much",
        COULOMB,
        "motion: Fretting(force: 61 N, steps: 4)",
    ));
    assert!(text.contains("take a lower force"), "{text}");
    let both = "motion: Fretting(force: 30 N, amplitude: 1 um)";
    let text = failed(ball("both", COULOMB, both));
    assert!(text.contains("not both"), "{text}");
    let text = failed(ball("none", COULOMB, "motion: Fretting()"));
    assert!(text.contains("there is no stroke"), "{text}");
    let falling = r#"contact: "rail-falling-friction""#;
    let text = failed(ball("time", falling, "motion: Fretting(amplitude: 1 um)"));
    assert!(text.contains("give `frequency`, or `speed`"), "{text}");
    let rolls = r#"contact: "coulomb", wear: "t-gamma""#;
    let text = failed(ball("rolled", rolls, "motion: Fretting(amplitude: 1 um)"));
    assert!(text.contains("over the distance rolled"), "{text}");
}

/// A cylinder on a plane is a line contact of its length: Hertz, Cattaneo and the energy ratio of a
/// strip.
#[test]
fn a_cylinder_is_a_strip() {
    let text = |length: &str, motion: &str| {
        format!(
            r#"(
            name: "a cylinder", materials: {{"steel": "simple"}},
            bodies: ((material: "steel", radius: 50 mm), (material: "steel")),
            interfaces: [(name: "dry", between: ("steel", "steel"), contact: "coulomb", parameters: (contact: {{"mu": 0.6}}))],
            {length} load: 1 kN, cells: 128, motion: {motion}
        )"#
        )
    };
    let outcome = solved(
        "strip",
        &text("length: 10 mm,", "Fretting(force: 450 N, steps: 4)"),
    );
    let outcome = outcome.unwrap();
    let half = f64::sqrt(4.0 * 1e5 * 0.05 / (std::f64::consts::PI * 100e9));
    near(
        outcome.answer.pressure,
        2e5 / (std::f64::consts::PI * half),
        0.01,
    );
    // Pressure, traction and slip are curves, with the pressure of the middle at the top.
    let sections = page::maps(&outcome);
    let mut titles = Vec::new();
    for block in &sections[0].blocks {
        let Block::Figure(chart) = block else {
            panic!("{block:?}");
        };
        assert!(chart.field.is_none(), "{}", chart.title);
        titles.push(chart.title.as_str());
        let points = &chart.series[0].points;
        let touching = points.iter().map(|p| p.0.abs()).fold(0.0, f64::max);
        near(touching, 1e3 * half, 0.05);
        if chart.title == "pressure" {
            let most = points.iter().map(|p| p.1).fold(0.0, f64::max);
            near(most, 1e-6 * outcome.answer.pressure, 1e-12);
        }
    }
    assert_eq!(titles.first(), Some(&"pressure"), "{titles:?}");
    assert!(titles.len() > 1, "{titles:?}");
    let point = &outcome.answer.points[0];
    // sqrt(1 - Q/(mu P)) of the width sticks.
    let stuck = point.stroke.unwrap().stuck;
    assert!((stuck.value - 0.5).abs() < 0.03, "{stuck:?}");
    let map = "Fretting(map: (load: (from: 0.5 kN, to: 1 kN, count: 2), amplitude: (from: 1 um, to: 20 um, count: 3), cells: 96))";
    let outcome = solved("strips", &text("length: 10 mm,", map)).unwrap();
    let map = outcome.answer.map.unwrap();
    let edges = map.edges[1];
    let closed = 0.25 / (f64::ln(2.0 * 10e-3 / half) + 0.5);
    near(edges.at_onset[0], closed, 0.05);
    near(edges.energy_ratio.value, edges.gross_slip.value, 0.05);
    let endless = failed(solved("endless", &text("", "Fretting(force: 450 N)")));
    assert!(
        endless.contains("a cylinder on a plane has a `length`"),
        "{endless}"
    );
}

/// Debris takes friction from bare to covered, volumes close, and the worn volume is Archard's.
#[test]
fn debris_changes_friction_over_the_cycles() {
    let interface = r#"contact: "debris-friction", wear: "archard", parameters: (
        contact: {"mu_bare": 0.3, "mu_covered": 0.6, "thickness": 1e-9}, wear: {"k": 1e-15})"#;
    let rest =
        "motion: Fretting(amplitude: 20 um, steps: 4, frequency: 20 Hz, cycles: (count: 2000))";
    let outcome = ball("debris", interface, rest).unwrap();
    let history = &outcome.answer.cycles[0];
    let (first, end) = (&history.scars[0], history.end());
    near(first.amplitude[1], 0.3 * 100.0, 1e-3);
    near(end.amplitude[1], 0.6 * 100.0, 0.02);
    assert!(end.unaccounted() < 1e-12 && end.ejected == 0.0);
    let most = 1e-15 * 100.0 * 4.0 * 20e-6 * 2000.0;
    assert!(
        end.volume < most && end.volume > 0.85 * most,
        "{} {most}",
        end.volume
    );
    assert!(outcome.answer.text().contains("mm3 have left"));
    let nothing = "motion: Fretting(amplitude: 20 um, cycles: (count: 10))";
    let text = failed(ball("nothing", COULOMB, nothing));
    assert!(text.contains("nothing changes"), "{text}");
}

/// A table that ends at 1 m/s is left by strokes of 2 m/s that slide, not by those that stick: maps
/// tell at how many places, cycles for how much of the time.
#[test]
fn maps_and_cycles_tell_that_a_table_is_left() {
    let folder = folder("left");
    std::fs::write(
        folder.join("mu.csv"),
        "slip_rate [m/s],friction\n0,0.5\n1,0.5\n",
    )
    .unwrap();
    let path = folder.join("patch.ron");
    let of = |rest: &str| {
        let text = format!(
            r#"(
                name: "a ball", materials: {{"ball": "simple"}},
                bodies: ((material: "ball", radius: 50 mm, across: 50 mm), (material: "ball")),
                interfaces: [(name: "dry", between: ("ball", "ball"), contact: "tabulated", tables: (contact: "mu.csv"))],
                load: 100 N, cells: 12, {rest}
            )"#
        );
        std::fs::write(&path, text).unwrap();
        let file = PatchFile::read(&path).unwrap();
        solve(&file, &laws(), &mut |_, _| ()).unwrap_or_else(|e| panic!("{e}"))
    };
    let map = of(
        "speed: 2 m/s, motion: Fretting(map: (load: (from: 50 N, to: 100 N, count: 2), amplitude: (from: 0.01 um, to: 40 um, count: 2), cells: 12))",
    );
    let found = map.answer.map.as_ref().unwrap();
    for row in &found.places {
        let outside: Vec<bool> = row.iter().map(|p| p.outside).collect();
        assert_eq!(outside, [false, true]);
    }
    let text = map.answer.text();
    assert!(text.contains("is left at 50.0 % of the places"), "{text}");
    assert!(text.contains("1 of 1 results have notes"), "{text}");
    for (frequency, left) in [("25 kHz", true), ("1 Hz", false)] {
        let rest = format!(
            "motion: Fretting(amplitude: 20 um, steps: 4, frequency: {frequency}, cycles: (count: 4))"
        );
        let cycles = of(&rest);
        let notes = &cycles.answer.cycles[0].notes;
        assert_eq!(
            notes
                .iter()
                .any(|n| n.contains("NOT IN RANGE: the `table`")),
            left,
            "{notes:?}"
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
