//! Ratio of the energy that broken bonds release to the energy that their laws declare.

use crate::scene;
use fretwork::geometry::space::Space;
use fretwork::laws::Interface;
use fretwork::laws::bench::Bench;
use fretwork::scene::{Dim2, Dim3, LoadedCase, load_text};
use fretwork_observe::fracture::{FractureSummary, InterfaceBonds, Reference};
use fretwork_observe::summary::Summary;
use std::path::Path;

/// Parameters of the MAC bonds of the verification cases: w (J/m^2), u_0 = sqrt(w/C) (m), speed of
/// the grip (m/s).
const W: f64 = 0.1;
const U0: f64 = 3.162_277_660_168_379_5e-7;
const SPEED: f64 = 0.045;
/// Critical opening over u_0, at which a hundredth of the peak traction is left.
const CRITICAL: f64 = 4.641_588_833_612_779;

fn summary(case: &str, sets: &[String]) -> Summary {
    let file = format!(
        "{}/cases/verification/{case}.ron",
        env!("CARGO_MANIFEST_DIR")
    );
    let sets = [sets, &without_files()].concat();
    let loaded = fretwork::scene::load(Path::new(&file), &sets).unwrap_or_else(|e| panic!("{e}"));
    run(&loaded)
}

/// Settings of a run that writes few files.
fn without_files() -> [String; 4] {
    [
        "output.frames=0",
        "output.views=0",
        "output.figures=false",
        "uncertainty.repeats=0",
    ]
    .map(String::from)
}

fn run(loaded: &LoadedCase) -> Summary {
    scene::finished(loaded, scene::built(loaded), |_| {})
}

/// Pulls one bond in steps of an opening (m) beyond its break, with the given damage law and
/// coupling.
fn pulled(case: &str, opening: f64, sets: &[&str]) -> (InterfaceBonds, Summary) {
    let step = opening / SPEED;
    let mut all = vec![
        format!("time.step={step:e}"),
        format!("time.end={:e}", (1.2e-5 / SPEED).max(4.0 * step)),
    ];
    all.extend(sets.iter().map(|s| (*s).to_owned()));
    let summary = summary(case, &all);
    let found = summary.found.get::<FractureSummary>().unwrap();
    assert_eq!(found.interfaces.len(), 1, "{found:?}");
    let bond = found.interfaces[0].clone();
    assert_eq!((bond.broken, bond.torn), (1, 0), "{bond:?}");
    (bond, summary)
}

/// The damage that a step uses in its impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Used {
    /// The damage at the start of the step.
    Start,
    /// The mean of start and end: at a constant speed the prediction is exact.
    Mean,
    /// The damage at the end of the step.
    End,
}

impl Used {
    const ALL: [Self; 3] = [Self::Start, Self::Mean, Self::End];

    /// The corresponding coupling of a case.
    fn coupling(self) -> &'static str {
        match self {
            Self::Start => "coupling=Explicit",
            Self::Mean => "coupling=Midpoint",
            Self::End => "coupling=Implicit(tolerance: 1e-12, max_iterations: 50)",
        }
    }

    fn beta(self, start: f64, end: f64) -> f64 {
        match self {
            Self::Start => start,
            Self::Mean => 0.5 * (start + end),
            Self::End => end,
        }
    }
}

/// Ratio of released energy to w of a MAC bond (b = 0) that is opened in steps of d u_0 and breaks
/// below `broken`: beta = (u_0/u)^2 from u_0 on. The stored energy is beta^2 C u^2/2. A step
/// reduces it, at the opening at its start, to the value with the damage used in the impulse, and,
/// at the opening at its end, to the value with the new damage.
fn overshoot(d: f64, broken: f64, used: Used) -> f64 {
    overshoot_from(0.0, d, broken, used)
}

/// Does as [`overshoot`] for a bond that begins, undamaged, at the opening `start` times u_0.
fn overshoot_from(start: f64, d: f64, broken: f64, used: Used) -> f64 {
    let (mut beta, mut u, mut sum) = (1.0f64, start, 0.0);
    while beta > 0.0 {
        let next = u + d;
        let mut after = beta.min(1.0 / (next * next));
        if after < broken {
            after = 0.0;
        }
        let used = used.beta(beta, after);
        sum += 0.5
            * ((beta * beta - used * used) * u * u + (used * used - after * after) * next * next);
        (beta, u) = (after, next);
    }
    sum
}

const CUT: &str = "interfaces.grain.parameters.damage.beta_broken=1e-3";

/// In modes I, II and mixed a slow pull releases the declared energy, w less the tail of
/// beta_broken/2, with an error of first order in the step: d u_0 times 0.66 by the closed form.
#[test]
fn a_slow_pull_releases_what_the_law_declares() {
    for case in ["bond_mode_1", "bond_mode_2", "bond_mixed"] {
        for used in Used::ALL {
            let d = 0.01;
            let sets = [CUT, used.coupling()];
            let (bond, summary) = pulled(case, d * U0, &sets);
            assert_eq!(bond.reference, Reference::Declared, "{case}");
            let ratio = bond.released_over_declared.unwrap();
            assert!((ratio - 1.0).abs() < 0.01, "{case} {used:?}: {ratio}");
            let exact = overshoot(d, 1e-3, used);
            assert!(
                (ratio / exact - 1.0).abs() < 1e-4,
                "{case} {used:?}: {ratio} for {exact}"
            );
            // The area is 0.5 m^2.
            assert!((bond.declared.unwrap() / (0.5 * W) - 1.0).abs() < 1e-12);
            assert_eq!(bond.broken_at_once, Some(0.0));
            let slide = bond.slide_mean.unwrap() * CRITICAL / d;
            assert!((slide - 1.0).abs() < 1e-2, "{case}: slide {slide}");
            let whole = summary
                .found
                .get::<FractureSummary>()
                .unwrap()
                .released_over_declared;
            assert_eq!(whole, Some(ratio));
            assert!(warning(&summary).is_none(), "{:?}", summary.run.warnings);
        }
    }
}

fn warning(summary: &Summary) -> Option<&String> {
    let mut warnings = summary.run.warnings.iter();
    warnings.find(|w| w.starts_with("BONDS NOT RESOLVED"))
}

/// In steps of 0.2 to 5 critical openings a bond releases the energy of its overshoot, with each
/// coupling; the run reports that it is not resolved.
#[test]
fn a_bond_pulled_in_large_steps_releases_what_the_overshoot_says() {
    for criticals in [0.2, 1.0, 2.0, 5.0] {
        for used in Used::ALL {
            let d = criticals * CRITICAL;
            let sets = [CUT, used.coupling()];
            let (bond, summary) = pulled("bond_mode_1", d * U0, &sets);
            let ratio = bond.released_over_declared.unwrap();
            let exact = overshoot(d, 1e-3, used);
            assert!(
                (ratio - exact).abs() < 1e-6 * exact.max(1.0),
                "{criticals} {used:?}: {ratio} for {exact}"
            );
            let largest = bond.slide_largest.unwrap();
            assert!((largest / criticals - 1.0).abs() < 1e-2, "{largest}");
            let text = warning(&summary).unwrap_or_else(|| panic!("{:?}", summary.run.warnings));
            assert!(text.contains("take a smaller time.step"), "{text}");
        }
    }
}

/// A bond that one step takes from no damage beyond its break is counted; for a brittle bond this
/// is no error of the step.
#[test]
fn bonds_that_break_within_one_step_are_counted() {
    let wide = [
        "interfaces.grain.parameters.damage.beta_broken=0.05",
        "coupling=Explicit",
    ];
    let (bond, summary) = pulled("bond_mode_1", CRITICAL * U0, &wide);
    assert_eq!(bond.broken_at_once, Some(1.0));
    // This is the energy stored at beta = 1.
    let exact = 0.5 * CRITICAL * CRITICAL / (1.0 - 0.05 / 2.0);
    let ratio = bond.released_over_declared.unwrap();
    assert!((ratio / exact - 1.0).abs() < 1e-3, "{ratio} for {exact}");
    let text = warning(&summary).unwrap();
    assert!(
        text.contains("100 % of them broke within one step"),
        "{text}"
    );
    // The brittle bond has strength s and, in a slow pull, the energy s^2/(2 k), since the law
    // declares none.
    let brittle = [
        "interfaces.grain.cohesion=elastic-bond",
        "interfaces.grain.damage=mohr-coulomb-brittle",
        "interfaces.grain.parameters.cohesion={\"k_n\": 1e12, \"k_t\": 1e12}",
        "interfaces.grain.parameters.damage={\"tensile_strength\": 1e6, \"cohesion\": 1e6, \"friction\": 0.0}",
        "coupling=Explicit",
    ];
    let (bond, summary) = pulled("bond_mode_1", 1.0004e-8, &brittle);
    assert!(bond.reference == Reference::SlowPull && bond.comparable);
    assert_eq!(bond.broken_at_once, Some(1.0));
    // The bond breaks at the first step beyond 1 um, of which a step is a hundredth.
    let exact = 1.0004f64.powi(2);
    let ratio = bond.released_over_declared.unwrap();
    assert!((ratio / exact - 1.0).abs() < 2e-3, "{ratio} for {exact}");
    assert!(warning(&summary).is_none(), "{:?}", summary.run.warnings);
    // With friction the strength depends on the pressure, so there is no reference.
    let pressed = [
        brittle[0],
        brittle[1],
        brittle[2],
        "interfaces.grain.parameters.damage={\"tensile_strength\": 1e6, \"cohesion\": 1e6, \"friction\": 0.4}",
    ];
    let (bond, summary) = pulled("bond_mode_1", 1e-7, &pressed);
    assert!(bond.reference == Reference::SlowPull && !bond.comparable);
    let whole = summary
        .found
        .get::<FractureSummary>()
        .unwrap()
        .released_over_declared;
    assert_eq!(whole, None);
}

/// A slow pull on the bench gives the closed forms of laws that declare an energy, at any angle.
#[test]
fn a_slow_pull_on_the_bench_is_the_fracture_energy() {
    let found = |law: &str| -> Interface {
        let sets = [law, CUT];
        let sets = if law.is_empty() { &sets[1..] } else { &sets };
        scene::case::<Dim2>("verification/bond_mode_1", sets).laws[0].clone()
    };
    let mac = found("");
    let mut bench = Bench::new(mac.clone(), 2, 0.5);
    for angle in [0.0, 0.3, 0.8, std::f64::consts::FRAC_PI_2] {
        let energy = bench.slow_fracture_energy(angle).unwrap().unwrap();
        assert_eq!(mac.declared_fracture_energy(angle), Some(W));
        let exact = W * (1.0 - 1e-3 / 2.0);
        assert!((energy / exact - 1.0).abs() < 1e-3, "{angle}: {energy}");
    }
    assert!(bench.fracture_energy_is_constant().unwrap());
    // With viscosity the energy depends on the speed; in a slow pull it is w.
    let viscous = found("interfaces.grain.parameters.damage.b=1e-6");
    assert_eq!(viscous.declared_fracture_energy(0.0), None);
    let mut bench = Bench::new(viscous, 2, 0.5);
    let energy = bench.slow_fracture_energy(0.0).unwrap().unwrap();
    assert!((energy / W - 1.0).abs() < 2e-3, "{energy}");
    assert!(!bench.fracture_energy_is_constant().unwrap());
}

/// A bond that begins at its gap of u_0/2 has an energy from the start, which its fracture
/// contains: it still releases w.
#[test]
fn a_bond_that_begins_at_its_gap_releases_its_fracture_energy() {
    let gap = 2.0 + 0.5 * U0;
    let place = format!("bodies.1.position=[0.0, {gap:?}]");
    let sets = [CUT, "interfaces.grain.bond_opening=Gap", place.as_str()];
    let (bond, _) = pulled("bond_mode_1", 0.01 * U0, &sets);
    let ratio = bond.released_over_declared.unwrap();
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    // If it begins beyond u_0, at n u_0, its energy is n^2 w/2 at once, and the tail takes w/(2
    // n^2): more than the law's energy, which is no error. The gap is found in the middle of the
    // first step.
    let (n, d) = (2.0, 0.01);
    let place = format!("bodies.1.position=[0.0, {:?}]", 2.0 + n * U0);
    let sets = [
        CUT,
        "interfaces.grain.bond_opening=Gap",
        place.as_str(),
        "coupling=Explicit",
    ];
    let (bond, summary) = pulled("bond_mode_1", d * U0, &sets);
    let ratio = bond.released_over_declared.unwrap();
    let exact = overshoot_from(n + 0.5 * d, d, 1e-3, Used::Start);
    assert!((ratio / exact - 1.0).abs() < 1e-4, "{ratio} for {exact}");
    let slow = 0.5 * (n * n + 1.0 / (n * n));
    assert!((ratio / slow - 1.0).abs() < 0.02, "{ratio} for {slow}");
    assert!(!bond.comparable && warning(&summary).is_none());
}

/// Rotates a parallel bond in bending or twist alone until it breaks, in steps of an angle (rad);
/// returns the released energy and the report on it.
fn turned<S: Space>(motion: &str, last: f64, steps: u32) -> (InterfaceBonds, Option<String>) {
    let more = |sign: f64| {
        let to = sign * last;
        motion.replace(
            "ANGLE",
            &format!("Displacement(Ramp(from: 0, to: {to:e}, start: 0, end: 0.1))"),
        )
    };
    let at = if S::D == 2 {
        "0.2, 0.0"
    } else {
        "0.2, 0.0, 0.0"
    };
    let ball = if S::D == 2 {
        "[0.0, 0.0], 0.1"
    } else {
        "[0.0, 0.0, 0.0], 0.1"
    };
    // The radius of the bond is then the reduced radius of the balls, 0.05 m.
    let factor = if S::D == 2 { 2.0 } else { 1.0 };
    let text = format!(
        r#"(
    name: "turned", dimension: {}, time: (step: {:e}, end: 0.1),
    detection: (alert: 1e-3, skin: 0.05),
    materials: {{"grain": "verification_grain"}},
    interfaces: [(name: "grain", between: ("grain", "grain"), contact: "frictionless", cohesion: "parallel-bond", area_factor: {factor},
        parameters: (cohesion: {{"k_n": 1e10, "k_t": 1e10, "sigma_c": 1e6, "tau_c": 1e6}}))],
    bodies: [
        (name: "a", material: "grain", shapes: [Balls([({ball})])], dofs: ({})),
        (name: "b", material: "grain", position: [{at}], shapes: [Balls([({ball})])], dofs: ({})),
    ],
)"#,
        S::D,
        0.1 / f64::from(steps),
        more(-0.5),
        more(0.5)
    );
    let loaded = load_text("turned.ron", &text, Path::new("."), &without_files());
    let summary = run(&loaded.unwrap_or_else(|e| panic!("{e}\n{text}")));
    let found = summary.found.get::<FractureSummary>().unwrap();
    (found.interfaces[0].clone(), found.warning())
}

/// A bond that breaks by bending or twist stores sigma^2 R/(3 k_n) per depth in 2D, pi sigma^2
/// R^2/(8 k_n) by bending and pi tau^2 R^2/(4 k_t) by twist in 3D. This is less than the energy of
/// an opening, and does not indicate a step that is too large. It is compared with a pull with an
/// equal rotation.
#[test]
fn bonds_broken_by_rotation_are_compared_with_what_turns_them() {
    let (stress, stiffness, steps) = (1e6f64, 1e10, 2000);
    let check = |bond: &InterfaceBonds, reported: &Option<String>, energy: f64| {
        assert!(bond.broken == 1 && bond.comparable, "{bond:?}");
        // The bond breaks in the step after the critical angle, which takes more than a thousand
        // steps.
        let ratio = bond.released / energy;
        assert!(
            (1.0 - 1e-9..1.0 + 3e-3).contains(&ratio),
            "{ratio}: {bond:?}"
        );
        let ratio = bond.released_over_declared.unwrap();
        assert!((ratio - 1.0).abs() < 4e-3, "{ratio}: {bond:?}");
        assert_eq!(*reported, None);
    };
    // The bond's radius R follows from its area; it breaks at the angle stress/(stiffness R).
    let area = |s: usize| {
        let radius = 0.05;
        if s == 2 {
            2.0 * radius
        } else {
            std::f64::consts::PI * radius * radius
        }
    };
    let energy_opened = 0.5 * stress * stress / stiffness;
    let r = 0.05;
    let critical = stress / (stiffness * r);
    let (bond, reported) = turned::<Dim2>("rz: ANGLE", 1.5 * critical, steps);
    check(&bond, &reported, energy_opened * area(2) / 3.0);
    let (bond, reported) = turned::<Dim3>("rz: ANGLE", 1.5 * critical, steps);
    check(&bond, &reported, energy_opened * area(3) / 4.0);
    let (bond, reported) = turned::<Dim3>("rx: ANGLE", 1.5 * critical, steps);
    check(&bond, &reported, energy_opened * area(3) / 2.0);
}
