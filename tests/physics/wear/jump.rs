//! Jumps over cycles, against runs that compute every cycle.

use fretwork::geometry::space::Dim2;
use fretwork::laws::SearchPath;
use fretwork::record::jump::JumpSummary;
use fretwork::record::{RunOptions, Summary, run};
use fretwork::scene::load;
use std::path::{Path, PathBuf};

/// Runs a case into a folder of its own; its summary, and the depths of the scar of `flat` if there is one (m).
fn ran(case: &str, name: &str, sets: &[&str]) -> (Summary, Vec<f64>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{case}.ron"));
    let mut all = vec![
        "output.figures=false".to_owned(),
        "output.frames=0".to_owned(),
        "uncertainty.repeats=0".to_owned(),
    ];
    all.extend(sets.iter().map(|s| (*s).to_owned()));
    let loaded = load(&path, &all).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<Dim2>(&SearchPath::new(&[]));
    let built = built.unwrap_or_else(|e| panic!("{e}"));
    let out: PathBuf =
        std::env::temp_dir().join(format!("fretwork-jump-{name}-{}", std::process::id()));
    let options = RunOptions {
        out: out.clone(),
        threads: 1,
    };
    let summary = run(&loaded, built, &options, &mut |_| ()).unwrap_or_else(|e| panic!("{e}"));
    let text = std::fs::read_to_string(out.join("scar_flat.csv")).unwrap_or_default();
    let depth = |line: &str| line.rsplit(',').next().and_then(|x| x.parse().ok());
    let depths = text.lines().skip(1).filter_map(depth).collect();
    let _ = std::fs::remove_dir_all(&out);
    (summary, depths)
}

fn refused(case: &str, sets: &[&str]) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("cases/{case}.ron"));
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    match load(&path, &sets) {
        Ok(_) => panic!("{sets:?} was taken"),
        Err(e) => e.to_string(),
    }
}

/// The bound of the comparison that the field makes: Cruzado et al. (2012) keep a hundred cycles within 4 %.
const BOUND: f64 = 0.04;

/// The jump of a run that stands for 1000 cycles with a twentieth of the steps of the full one.
fn twenty_times_fewer<'a>(jumped: &'a Summary, full: &Summary) -> &'a JumpSummary {
    let jump = jumped.jump.as_ref().unwrap();
    assert_eq!(jump.represented_cycles, 1000);
    let steps = (jumped.steps, full.steps);
    assert!(20 * steps.0 <= steps.1, "{steps:?}");
    jump
}

/// Wear of the cylinder on a flat: volume, largest depth and profile of the run that computes every cycle.
#[test]
fn a_scar_by_jumps_is_the_scar_of_all_cycles() {
    let (jumped, profile) = ran("fretting_wear_jump", "scar", &[]);
    let (full, expected) = ran("fretting_wear_jump", "scar-full", &["jump=None"]);
    let jump = twenty_times_fewer(&jumped, &full);
    assert!(full.jump.is_none());
    let volume = jump.wear_volume / full.wear.volume_first_bodies - 1.0;
    let most = |d: &[f64]| d.iter().copied().fold(0.0, f64::max);
    let deepest = most(&profile) / most(&expected) - 1.0;
    let differ = profile.iter().zip(&expected).map(|(a, b)| (a - b).abs());
    let form = differ.clone().sum::<f64>() / expected.iter().sum::<f64>();
    let farthest = differ.fold(0.0, f64::max) / most(&expected);
    let truly = volume.abs() + form;
    println!(
        "{} steps for {}: volume {volume:.1e}, deepest {deepest:.1e}, profile {form:.1e}, farthest {farthest:.1e}; estimated {:.1e}",
        jumped.steps,
        full.steps,
        jump.error_estimate.unwrap()
    );
    assert!(volume.abs() < BOUND && deepest.abs() < BOUND && form < BOUND);
    let estimate = jump.error_estimate.unwrap();
    assert!(estimate > 0.5 * truly, "{estimate} {truly}");
    assert!(estimate < 10.0 * truly.max(0.01));
    assert!(jumped.energy_residual_relative < 1e-12);
    // V against E_d is of all cycles: k/mu, as Archard's volume is k P times the path, and E_d mu P times it.
    let [a, b] = [&jumped, &full].map(|s| s.fretting.as_ref().unwrap());
    assert!(
        (a.energy / b.energy - 1.0).abs() < BOUND,
        "{} {}",
        a.energy,
        b.energy
    );
    let alpha = a.alpha.unwrap().value;
    assert!((alpha / (1.5e-12 / 0.6) - 1.0).abs() < 0.02, "{alpha}");
    assert!((jumped.wear.Qs / full.wear.Qs - 1.0).abs() < BOUND);
}

/// Damage of a bond under cycles of force, which grows ever faster as the bond weakens.
#[test]
fn the_damage_of_a_bond_by_jumps_is_that_of_all_cycles() {
    let (jumped, _) = ran("verification/bond_fatigue", "bond", &[]);
    let (full, _) = ran("verification/bond_fatigue", "bond-full", &["jump=None"]);
    let jump = twenty_times_fewer(&jumped, &full);
    let error = jumped.mean_damage / full.mean_damage - 1.0;
    println!(
        "{} steps for {}: D {:.5} for {:.5}, {error:.1e}; estimated {:.1e}; {:?}",
        jumped.steps,
        full.steps,
        jumped.mean_damage,
        full.mean_damage,
        jump.error_estimate.unwrap(),
        jump.jumps
    );
    // Far from linear: the first cycle's rate would give less than three quarters of it.
    assert!(full.mean_damage > 0.2 && full.mean_damage < 0.9);
    assert!(error.abs() < BOUND);
    let estimate = jump.error_estimate.unwrap();
    assert!(estimate > error.abs() && estimate < 1.5 * BOUND);
    let [a, b] = [&jumped, &full].map(|s| s.fretting.as_ref().unwrap().energy);
    println!("E_d {:.1e}", a / b - 1.0);
    assert!((a / b - 1.0).abs() < BOUND, "{a} {b}");
    // The travel that the law counts, and the traction at which it last turned.
    assert_eq!(jump.not_jumped.len(), 2, "{:?}", jump.not_jumped);
    assert!(jumped.energy_residual_relative < 1e-12);
}

/// A bond that breaks does so about the cycle at which it breaks without jumps, and its energy is booked.
#[test]
fn a_bond_that_breaks_in_a_jump_closes_the_ledger() {
    let soft = "interfaces.0.parameters.damage.length=0.4";
    let wear = "interfaces.0.wear=\"broken-bonds\"";
    let (jumped, _) = ran("verification/bond_fatigue", "breaks", &[soft, wear]);
    assert_eq!(jumped.broken, 1);
    // A jump that broke the bond was off by something, and says so.
    let estimate = jumped.jump.as_ref().unwrap().error_estimate;
    assert!(estimate.is_some_and(|e| e > 0.0), "{estimate:?}");
    // What a bond gives when it breaks it gives once, however many cycles the step stands for.
    let once = jumped.wear.volume_third_body;
    let (full, _) = ran(
        "verification/bond_fatigue",
        "breaks-full",
        &[soft, wear, "jump=None"],
    );
    assert_eq!(full.broken, 1);
    assert!(once > 0.0 && (once / full.wear.volume_third_body - 1.0).abs() < 1e-12);
    assert!(
        jumped.energy_residual_relative < 1e-12,
        "{}",
        jumped.energy_residual_relative
    );
}

/// Surfaces that follow seldom follow at once within a jump; the load is the case's, so the volume is Archard's whatever they do.
#[test]
fn surfaces_that_follow_seldom_do_so_at_once_in_a_jump() {
    let sets = ["bodies.flat.wears.every=40", "jump.cycles=300"];
    let (seldom, _) = ran("fretting_wear_jump", "seldom", &sets);
    let (often, _) = ran("fretting_wear_jump", "often", &["jump.cycles=300"]);
    let [a, b] = [&seldom, &often].map(|s| s.scars[0].depth);
    println!("depth {:.1e} of that which follows every step", a / b - 1.0);
    assert!((a / b - 1.0).abs() < 0.1, "{a} {b}");
}

#[test]
fn at_most_one_cycle_is_no_jump() {
    let sets = ["jump.at_most=1", "jump.cycles=12"];
    let (summary, _) = ran("verification/bond_fatigue", "none", &sets);
    let jump = summary.jump.unwrap();
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

/// Pressure of a line contact of two like half-planes with a gap at equal strips (Pa), under a load (N/m): Flamant's displacements of
/// strips (Johnson, section 2.4), and strips without pull.
fn pressures(gap: &[f64], size: f64, load: f64, modulus: f64) -> Vec<f64> {
    // int ln|x - s| ds over a strip at a distance x.
    let integral = |x: f64| {
        let part = |y: f64| if y == 0.0 { 0.0 } else { y * y.abs().ln() - y };
        part(x + 0.5 * size) - part(x - 0.5 * size)
    };
    let influence = |i: usize, j: usize| {
        -2.0 / (std::f64::consts::PI * modulus) * integral(size * (i as f64 - j as f64))
    };
    let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
    let mut touching: Vec<usize> = (0..gap.len()).filter(|k| gap[*k] < lowest + 1e-5).collect();
    for _ in 0..100 {
        // Displacements C - gap of what touches, with the load: the last unknown is C.
        let n = touching.len();
        let mut rows: Vec<Vec<f64>> = touching
            .iter()
            .map(|i| {
                let of = touching.iter().map(|j| influence(*i, *j));
                of.chain([-1.0, -gap[*i]]).collect()
            })
            .collect();
        rows.push([vec![size; n], vec![0.0, load]].concat());
        for k in 0..=n {
            let pivot = (k..=n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()));
            rows.swap(k, pivot.unwrap());
            let row = rows[k].clone();
            for other in &mut rows[k + 1..] {
                let factor = other[k] / row[k];
                for (x, y) in other.iter_mut().zip(&row).skip(k) {
                    *x -= factor * y;
                }
            }
        }
        let mut found = vec![0.0; n + 1];
        for k in (0..=n).rev() {
            let sum: f64 = (k + 1..=n).map(|j| rows[k][j] * found[j]).sum();
            found[k] = (rows[k][n + 1] - sum) / rows[k][k];
        }
        let mut all = vec![0.0; gap.len()];
        for (k, p) in touching.iter().zip(&found) {
            all[*k] = *p;
        }
        let overlaps = |i: usize| {
            let moved: f64 = touching.iter().map(|j| influence(i, *j) * all[*j]).sum();
            found[n] - gap[i] - moved > 1e-14
        };
        let next: Vec<usize> = (0..gap.len())
            .filter(|k| all[*k] > 0.0 || (all[*k] == 0.0 && overlaps(*k)))
            .collect();
        if next == touching {
            return all;
        }
        touching = next;
    }
    panic!("no set of strips");
}

/// Jumps carry the wear of a half-space, without a law of damage. Archard's law on a half-plane, integrated from Flamant's displacements
/// and the path of slip of one cycle, has the same scar.
#[test]
fn the_scar_of_a_half_space_by_jumps_is_that_of_an_integration() {
    let (size, load, radius, amplitude, k) = (5e-5, 2.4e5, 0.1, 1.5e-5, 2.4e-13);
    let cycles = 2000.0;
    let modulus = 0.5 * 209.92e9 / (1.0 - 0.28 * 0.28);
    let sets = [
        "name=\"scar\"",
        "time=(step: 2.5e-3, end: 30.01, theta: 1.0)",
        "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", wear: \"archard\", \
          parameters: (contact: {\"mu\": 0.35}, wear: {\"k\": 2.4e-13}))]",
        "half_spaces=[\
          (name: \"flat\", material: \"steel\", x: (from: -1.25e-3, to: 1.25e-3, size: 5e-5), depth: 0.02, touches: Surface, wears: (thickness: 1e-3)),\
          (name: \"cyl\", material: \"steel\", side: Above, x: (from: -1.25e-3, to: 1.25e-3, size: 5e-5), depth: 0.02, profile: Summit(x: 0.1), mass: 10.0,\
           dofs: (x: Displacement(Sine(amplitude: 1.5e-5, frequency: 20.0, start: 0.01)), y: Force(Ramp(from: 0.0, to: -2.4e5, start: 0.0, end: 8e-3))), touches: Points)]",
        "friction=(body: \"cyl\", along: 0, normal: 1, start: 0.01)",
        "jump=(after: 3, at_most: 1000, tolerance: 0.02, cycles: 2000)",
    ];
    let (summary, depths) = ran("fretting_wear_elastic", "half-space", &sets);
    let jump = summary.jump.as_ref().unwrap();
    assert_eq!(jump.represented_cycles, 2000);
    assert!(summary.steps < 20 * 2000 / 10, "{}", summary.steps);
    // The path of slip of a cycle is its heat over mu P.
    let of_cycle = summary.cycles[1].work;
    let path = of_cycle / (0.35 * load);
    assert!(path > 3.0 * amplitude && path < 4.0 * amplitude, "{path:e}");
    let volume = jump.wear_volume / (k * load * path * cycles);
    let n = depths.len();
    let place = |j: usize| (j as f64 - 0.5 * (n as f64 - 1.0)) * size;
    let mut worn = vec![0.0; n];
    let at_once = 5.0;
    for _ in 0..(cycles / at_once) as usize {
        let mut change = vec![0.0; n];
        let places = 4;
        for j in 0..places {
            // Equal parts of the path.
            let shift = 0.25 * path * (2.0 * (f64::from(j) + 0.5) / f64::from(places) - 1.0);
            let gap: Vec<f64> = (0..n)
                .map(|j| (place(j) - shift).powi(2) / (2.0 * radius) + worn[j])
                .collect();
            for (c, p) in change.iter_mut().zip(pressures(&gap, size, load, modulus)) {
                *c += k * p * path * at_once / f64::from(places);
            }
        }
        worn.iter_mut().zip(&change).for_each(|(w, c)| *w += c);
    }
    let most = |d: &[f64]| d.iter().copied().fold(0.0, f64::max);
    let deepest = most(&depths) / most(&worn);
    let differ: f64 = depths.iter().zip(&worn).map(|(a, b)| (a - b).abs()).sum();
    let form = differ / worn.iter().sum::<f64>();
    println!(
        "{} steps: volume {volume:.4}, deepest {deepest:.4} of {:e} m, profile off by {form:.4}; estimated {:?}",
        summary.steps,
        most(&worn),
        jump.error_estimate
    );
    assert!((volume - 1.0).abs() < 0.02 && (deepest - 1.0).abs() < 0.02 && form < 0.05);
}

/// Drives of what holds deformable bodies repeat with each cycle too.
#[test]
fn drives_of_holders_that_do_not_repeat_are_refused() {
    let jump = "jump=(after: 3, at_most: 50)";
    let load =
        "half_spaces.cylinder.dofs.y=Force(Ramp(from: 0.0, to: -178.9e3, start: 0.0, end: 50.0))";
    let told = refused("fretting_wear_elastic", &[jump, load]);
    assert!(told.contains("its ramp lasts until"), "{told}");
}
