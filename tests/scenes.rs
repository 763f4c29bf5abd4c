//! Silo, drum and plane shear, smaller than in `cases/`: what an expert would look at first.

use fretwork::geometry::space::Plane;
use fretwork::laws::SearchPath;
use fretwork::record::{RunOptions, Summary, run};
use fretwork::scene::build::Built;
use fretwork::scene::{Loaded, load};
use fretwork::step::Simulation;
use std::path::{Path, PathBuf};

const G: f64 = 9.81;

fn case(name: &str, sets: &[&str]) -> (Loaded, Built<Plane>) {
    let path = format!("{}/cases/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    let loaded = load(Path::new(&path), &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<Plane>(&SearchPath::new(&[]));
    let built = built.unwrap_or_else(|e| panic!("{e}"));
    (loaded, built)
}

/// Runs a case to its end, in a folder that is left for `look` and then removed.
fn finished(name: &str, sets: &[&str], look: impl FnOnce(&Path)) -> Summary {
    let (loaded, built) = case(name, sets);
    let out: PathBuf = std::env::temp_dir().join(format!("fretwork-{name}-{}", std::process::id()));
    let options = RunOptions {
        out: out.clone(),
        threads: 1,
    };
    let summary = run(&loaded, built, &options, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
    look(&out);
    let _ = std::fs::remove_dir_all(out);
    summary
}

fn place(s: &Simulation<Plane>, name: &str) -> usize {
    let found = s.bodies.driven.iter().position(|d| d.name == name);
    found.unwrap_or_else(|| panic!("a body named {name}"))
}

fn held(s: &Simulation<Plane>) -> f64 {
    let grains =
        (0..s.bodies.len()).filter(|b| s.bodies.driven.iter().all(|d| d.body as usize != *b));
    let inside = grains.filter(|b| s.bodies.position[*b].y > 0.0);
    inside.map(|b| s.bodies.mass[b]).sum()
}

/// While the gate is lowered slowly gate and walls carry the weight together, the walls a good part of it (Janssen). Opened, the silo
/// discharges at a rate that does not depend on how much it holds, and of Beverloo's size.
#[test]
fn a_silo_saturates_and_drains_at_a_constant_rate() {
    let (_, built) = case("silo", &["grains.0.count=600", "grains.0.high=[0.16,0.5]"]);
    let mut s = built.simulation;
    let all = held(&s);
    let [gate_at, left, right] = ["gate", "left", "right"].map(|n| place(&s, n));
    let (mut gate, mut walls, mut count) = (0.0, 0.0, 0.0);
    while s.control.phase() < 3 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        let begun = s.control.begun().last();
        if begun.is_some_and(|b| b.name == "lower" && s.time > b.start + 0.03) {
            let up = |k: usize| -s.received[k].0.y / s.scheme.h;
            (gate, walls) = (gate + up(gate_at), walls + up(left) + up(right));
            count += 1.0;
        }
    }
    let weight = all * G;
    let (gate, walls) = (gate / count / weight, walls / count / weight);
    println!("gate {gate:.3}, walls {walls:.3} of the weight");
    assert!((gate + walls - 1.0).abs() < 0.03, "{gate} + {walls}");
    assert!(gate < 0.9 && walls > 0.1, "{gate} and {walls}");
    let start = s.time;
    let mut times = Vec::new();
    let parts = [0.9, 0.7, 0.5];
    while times.len() < parts.len() && s.time < start + 4.0 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
        if held(&s) < parts[times.len()] * all {
            times.push(s.time);
        }
    }
    assert_eq!(times.len(), parts.len(), "the silo drains");
    let [early, late] = [0, 1].map(|k| 0.2 * all / (times[k + 1] - times[k]));
    // C rho_bulk sqrt(g) (A - k d)^(3/2) with C = 0.58, k = 1.4, a bulk density of 0.8 that of glass.
    let beverloo = 0.58 * 2500.0 * 0.8 * G.sqrt() * (0.064f64 - 1.4 * 0.008).powf(1.5);
    println!("rates {early:.2} and {late:.2} kg/(m s), Beverloo {beverloo:.2}");
    // Each is a flow of 120 grains, which comes in bursts.
    assert!((early / late - 1.0).abs() < 0.25, "{early} and {late}");
    assert!((0.5..2.0).contains(&(early / beverloo)));
}

/// The rheology of da Cruz et al. (2005) at one inertial number, from the contacts between the walls; the servo
/// keeps the pressure.
#[test]
fn plane_shear_has_the_friction_of_its_inertial_number() {
    let sets = [
        "output.frames=0",
        "output.views=0",
        "output.figures=false",
        "phases.shear.until=After(1.4)",
    ];
    let summary = finished("plane_shear", &sets, |_| {});
    let m = |name: &str| summary.measures[&format!("bulk_{name}")];
    let (i, mu, phi, p) = (m("I"), m("mu"), m("phi"), m("p"));
    println!(
        "I {i:.4}: mu {mu:.3} ({:.3}), phi {phi:.3} ({:.3}), p {p:.0}",
        0.25 + 1.1 * i,
        0.81 - 0.31 * i
    );
    assert!((0.01..0.2).contains(&i), "{i}");
    assert!((p / 1000.0 - 1.0).abs() < 0.05, "{p}");
    assert!((mu - 0.25 - 1.1 * i).abs() < 0.04, "{mu} at {i}");
    assert!((phi - 0.81 + 0.31 * i).abs() < 0.02, "{phi} at {i}");
    let phases: Vec<_> = summary.phases.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(phases, ["press", "shear"]);
}

/// A bed in a turning drum keeps an angle; below its flowing layer it turns with the drum, and on the surface
/// grains run down.
#[test]
fn a_drum_has_a_steady_slope_over_a_turning_bed() {
    let sets = [
        "grains.0.count=380",
        "grains.0.radius=(3e-3,3.6e-3)",
        "time.step=1e-3",
        "phases.turn.until=After(2.4)",
        "measures.centre.bins=11",
        "measures.centre.start=1.4",
        "measures.slope.start=1.4",
        "output.frames=0",
        "output.views=0",
    ];
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let summary = finished("rotating_drum_2d", &sets, |out| {
        let text = std::fs::read_to_string(out.join("centre.csv")).unwrap_or_default();
        for line in text.lines().skip(1) {
            rows.push(
                line.split(',')
                    .map(|x| x.parse().unwrap_or(f64::NAN))
                    .collect(),
            );
        }
        assert!(out.join("centre.png").exists() && out.join("slope.png").exists());
    });
    let slope = summary.measures["slope"].to_degrees();
    println!("slope {slope:.1} degrees");
    assert!((12.0..35.0).contains(&slope), "{slope}");
    // Slices: y, solid fraction, velocity along the slope and across, spin.
    let filled: Vec<_> = rows.iter().filter(|r| r[1] > 0.3).collect();
    let (deep, top) = (filled[0], filled[filled.len() - 1]);
    println!("{rows:?}");
    // Up the slope at the wall, as the drum: -omega y with y < 0.
    let rigid = -0.63 * deep[0];
    assert!(
        (deep[2] / rigid - 1.0).abs() < 0.2,
        "{} and {rigid}",
        deep[2]
    );
    assert!(top[2] < 0.0, "the surface flows down: {}", top[2]);
}
