//! Surfaces that wear: the volume that laws book is the removed volume, and contacts follow the
//! surface.

use crate::scene;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;
use fretwork::wear::{ScarForm, shape};

fn scene<S: Space>(name: &str, sets: &[&str]) -> Simulation<S> {
    let mut s = scene::case::<S>(name, sets);
    s.state.network.dissipation = Some(Vec::new());
    s
}

/// The integral of height over the surface of a body: by trapezia, by prisms.
fn under<S: Space>(s: &Simulation<S>) -> f64 {
    let outline = s.shapes.surfaces[0].shape.outline();
    if S::D == 2 {
        let trapezium = |w: &[S::Vector]| 0.5 * (w[1][0] - w[0][0]) * (w[0][1] + w[1][1]);
        return outline[0].windows(2).map(trapezium).sum();
    }
    let prism = |t: &Vec<S::Vector>| {
        let (u, v) = (t[1] - t[0], t[2] - t[0]);
        0.5 * (u[0] * v[1] - u[1] * v[0]) * (t[0][2] + t[1][2] + t[2][2]) / 3.0
    };
    outline.iter().map(prism).sum()
}

/// Normal force, slip, work of friction and area of each contact of a step.
struct SlidingPart {
    force: f64,
    slip: f64,
    work: f64,
    area: f64,
}

/// Runs a case and sums the volume of a law over contacts and steps; compares it with the scar and
/// the surface, and closes the ledger. The slip is the displacement of the slider along the
/// contact, since it does not rotate.
fn worn<S: Space>(
    name: &str,
    sets: &[&str],
    law: impl Fn(f64, &SlidingPart) -> f64,
) -> Simulation<S> {
    let mut s = scene::<S>(name, sets);
    let slider = s.state.bodies.driven[1].body as usize;
    let steps = (0.5 / s.options.scheme.h).round() as usize;
    let before = under(&s);
    let (mut expected, mut booked) = (0.0, 0.0);
    for _ in 0..steps {
        let from = s.state.bodies.position[slider];
        booked += s.step().unwrap_or_else(|e| panic!("{e}")).totals.worn_first;
        let way = s.state.bodies.position[slider] - from;
        let spent = s.state.network.dissipation.as_ref().unwrap();
        for (c, spent) in s.state.network.contacts.iter().zip(spent) {
            let rubbed = SlidingPart {
                force: c.impulse.dot(&c.normal) / s.options.scheme.h,
                slip: S::tangential(&c.normal, &way).norm(),
                work: spent.friction,
                area: s.laws[c.law as usize].area.area(S::D, c.radius),
            };
            expected += law(s.options.scheme.h, &rubbed);
        }
    }
    let gone = before - under(&s);
    let scar = &s.state.scars[0];
    for (what, volume) in [("booked", booked), ("scar", scar.volume()), ("gone", gone)] {
        assert!(
            (volume / expected - 1.0).abs() < 1e-10,
            "{name} {what}: {volume:e} of {expected:e}"
        );
    }
    assert!(scar.deepest() > 1e-6, "{}", scar.deepest());
    let residual = s.state.energy.relative_residual();
    assert!(residual.abs() < 1e-9, "{name}: {residual:e}");
    println!(
        "{name} {sets:?}: V {expected:.6e}, gone {:.1e} off, residual {residual:.1e}",
        gone / expected - 1.0
    );
    s
}

fn archard(k: f64) -> impl Fn(f64, &SlidingPart) -> f64 {
    move |_, r| k * r.force.max(0.0) * r.slip
}

#[test]
fn archards_volume_is_gone_from_a_profile() {
    let s = worn::<Dim2>("verification/worn_slide", &[], archard(1e-8));
    // With a flat profile, 2000 N/m over 0.35 m give 7e-6 m^2; the result agrees within some per
    // cent.
    assert!((s.state.scars[0].volume() / 7e-6 - 1.0).abs() < 0.05);
}

#[test]
fn archards_volume_is_gone_from_a_height_field() {
    worn::<Dim3>("verification/worn_slide_3d", &[], archard(1e-9));
}

#[test]
fn surfaces_that_follow_every_tenth_step_lose_the_same_volume() {
    worn::<Dim2>(
        "verification/worn_slide",
        &["bodies.rail.wears.every=10"],
        archard(1e-8),
    );
}

const ENERGY: &str = "interfaces.0.wear=\"dissipated-energy\"";

#[test]
fn volume_is_alpha_times_the_energy_of_the_ledger() {
    let alpha = 1e-8;
    let sets = [ENERGY, "interfaces.0.parameters.wear={\"alpha\": 1e-8}"];
    let s = worn::<Dim2>("verification/worn_slide", &sets, |_, r| {
        alpha * r.work.max(0.0)
    });
    let ratio = s.state.scars[0].volume() / (alpha * s.state.energy.friction);
    assert!((ratio - 1.0).abs() < 1e-10, "{ratio}");
    let s = worn::<Dim3>("verification/worn_slide_3d", &sets, |_, r| {
        alpha * r.work.max(0.0)
    });
    let ratio = s.state.scars[0].volume() / (alpha * s.state.energy.friction);
    assert!((ratio - 1.0).abs() < 1e-10, "{ratio}");
}

/// The regimes of the map of R8T on 900A (R. Lewis, R. S. Dwyer-Joyce, Proc. IMechE J 218 (2004)
/// 467-478), mass per metre rolled and area against T gamma/A: 5.3 x up to 10.4 N/mm^2, 55 up to
/// 77.2, then 61.9 more for each N/mm^2, in ug/(m mm^2).
#[test]
fn t_gamma_wears_by_its_map() {
    for (speed, density, load, severe) in [(1.0, 785.0, -2e6, false), (1e-5, 7.85e-3, -150.0, true)]
    {
        let in_severe = std::cell::Cell::new(0);
        let map = |h: f64, r: &SlidingPart| {
            let swept = r.area * speed * h;
            let x = r.work.max(0.0) / swept;
            let mass = if x < 10.4e6 {
                5.3e-9 * x
            } else {
                in_severe.set(in_severe.get() + 1);
                0.055 + 61.9e-9 * (x - 77.2e6).max(0.0)
            };
            mass * swept / density
        };
        let law = format!(
            "interfaces.0.parameters.wear={{\"speed\": {speed:e}, \"density\": {density:e}}}"
        );
        let load = format!("bodies.block.dofs.y=Force(Constant({load:e}))");
        let sets = ["interfaces.0.wear=\"t-gamma\"", &law, &load];
        worn::<Dim2>("verification/worn_slide", &sets, map);
        // The severe case is in that regime when one contact takes the load, in at least four steps
        // of five.
        assert_eq!(in_severe.get() > 400, severe, "{}", in_severe.get());
    }
}

/// A flat block that slides back and forth under load sinks by V over its length plus the stroke.
#[test]
fn a_block_sinks_into_what_it_covers() {
    let (width, amplitude, spacing) = (0.02, 0.002, 2e-4);
    let points: Vec<String> = (-150..=150)
        .map(|k| format!("({:e}, 0.0)", spacing * f64::from(k)))
        .collect();
    let points = format!("bodies.rail.shapes.0.points=[{}]", points.join(","));
    let half = 0.5 * width;
    let shape = format!(
        "bodies.block.shapes=[Polygon(points: [(-{half}, -{half}), ({half}, -{half}), ({half}, {half}), (-{half}, {half})])]"
    );
    let at = format!("bodies.block.position=[0.0, {half}]");
    let moved = "bodies.block.dofs.x=Displacement(Sine(amplitude: 0.002, frequency: 10.0))";
    let load = "bodies.block.dofs.y=Force(Constant(-1e5))";
    let law = "interfaces.0.parameters.wear.k=7.5e-11";
    let sets = [
        &points,
        &shape,
        &at,
        moved,
        load,
        law,
        "detection.skin=0.004",
        "detection.alert=2e-4",
    ];
    let mut s = scene::<Dim2>("verification/worn_slide", &sets);
    for _ in 0..4_000 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let b = s.state.bodies.driven[1].body as usize;
    let (sunk, volume) = (
        half - s.state.bodies.position[b][1],
        s.state.scars[0].volume(),
    );
    let expected = volume / (width + 2.0 * amplitude);
    println!(
        "sunk {sunk:.6e} m, V/length {expected:.6e} m, ledger {:.1e}",
        s.state.energy.relative_residual()
    );
    // The ends of the stroke are covered only for a moment, which gives a segment more or less at
    // each end.
    assert!((sunk / expected - 1.0).abs() < 0.05, "{sunk} {expected}");
    assert!(s.state.energy.relative_residual().abs() < 1e-9);
    // The work of the load went into friction and into the sinking.
    let o = shape::outline(&s.state.scars[0].along());
    assert_eq!(o.form, ScarForm::U);
    assert!((o.to - o.from - width - 2.0 * amplitude).abs() < 4.0 * spacing);
}

/// The scar of a cylinder of radius R that moves by a to each side under Archard's law, with the
/// half-width b > a. The contact moves from edge to edge during the stroke, x = u b/a, so that the
/// whole scar deepens evenly; its slope at x is that of the cylinder, (x - u)/R. The scar is
/// therefore a parabola of curvature (1 - a/b)/R, of depth b (b - a)/(2 R) and of area 2 b^2 (b -
/// a)/(3 R): the shape of the cylinder if a is small compared with b.
#[test]
fn the_scar_of_a_cylinder_tends_to_its_form() {
    let (radius, a) = (0.05f64, 2e-4);
    let mut s = scene::<Dim2>("fretting_scar", &[]);
    let cylinder = s.state.bodies.driven[1].body as usize;
    let mut curvatures = Vec::new();
    for cycle in 1..=50 {
        let mut high = f64::NEG_INFINITY;
        for _ in 0..200 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
            high = high.max(s.state.bodies.position[cylinder][1]);
        }
        let volume = s.state.scars[0].volume();
        let (mut low, mut up) = (a, 1e-2);
        for _ in 0..100 {
            let b = 0.5 * (low + up);
            if 2.0 * b * b * (b - a) / (3.0 * radius) < volume {
                low = b;
            } else {
                up = b;
            }
        }
        let (b, depth) = (low, low * (low - a) / (2.0 * radius));
        if cycle % 10 != 0 {
            continue;
        }
        let mut off = 0.0f64;
        for (v, d) in s.state.scars[0].vertices() {
            let parabola = depth * (1.0 - (v.at[0] / b).powi(2));
            off = off.max((d - parabola.max(0.0)).abs());
        }
        let sunk = radius - s.state.bodies.position[cylinder][1];
        let rides = high - s.state.bodies.position[cylinder][1];
        println!(
            "{cycle} cycles: b {b:.3e}, depth {depth:.4e}, sunk {sunk:.4e}, form off by {:.3} of it, rides up {rides:.2e} of {:.2e}",
            off / depth,
            a * (b - a) / (2.0 * radius)
        );
        assert!((sunk / depth - 1.0).abs() < 0.03, "{sunk} {depth}");
        assert!(off < 0.1 * depth, "{off} of {depth}");
        curvatures.push(1.0 - a / b);
    }
    assert!(curvatures.windows(2).all(|w| w[0] < w[1] && w[1] < 1.0));
    let o = shape::outline(&s.state.scars[0].along());
    assert_eq!(o.form, ScarForm::U);
    // The volume is k N s, where the slip is that of the cylinder except for its rise.
    let kns = 3e-11 * 1e5 * 200.0 * a;
    let volume = s.state.scars[0].volume();
    assert!((volume / kns - 1.0).abs() < 0.01, "{volume} {kns}");
    assert!(s.state.energy.relative_residual().abs() < 1e-9);
}

/// A punch 4 mm wide is driven 2 mm above its face: friction turns it onto its leading edge, and
/// the scar is deeper at both sides than in the middle. If it cannot rotate, the scar is flat, and
/// the punch sinks by V over width plus stroke.
#[test]
fn a_punch_that_rocks_wears_a_w_and_one_that_is_held_a_u() {
    let form = |sets: &[&str]| {
        let mut s = scene::<Dim2>("punch_scar", sets);
        for _ in 0..4000 {
            s.step().unwrap_or_else(|e| panic!("{e}"));
        }
        (
            shape::outline(&s.state.scars[0].along()),
            s.state.scars[0].volume(),
        )
    };
    let (rocks, _) = form(&["time.step=5e-5"]);
    println!("{rocks:?}");
    assert_eq!(rocks.form, ScarForm::W);
    assert!(rocks.sides.iter().all(|side| rocks.middle < 0.75 * side));
    let (held, volume) = form(&["time.step=5e-5", "bodies.punch.dofs.rz=Fixed"]);
    println!("{held:?}");
    assert_eq!(held.form, ScarForm::U);
    assert!((held.middle / (volume / 4.4e-3) - 1.0).abs() < 0.05);
}

/// If the motion reverses within a step, friction supplies energy: it is subtracted from the work
/// of later steps in the law, and the volume remains that of the ledger's energy.
#[test]
fn volume_is_alpha_times_the_energy_where_the_motion_turns() {
    let sets = [ENERGY, "interfaces.0.parameters.wear={\"alpha\": 5e-11}"];
    let mut s = scene::case::<Dim2>("fretting_scar", &sets);
    let (mut volume, mut given) = (0.0, 0);
    while s.state.time < 0.1 {
        let totals = s.step().unwrap().totals;
        volume += totals.worn_first;
        given += u32::from(totals.friction < 0.0);
    }
    assert!(given > 5, "the motion turned {given} times");
    let ratio = volume / (5e-11 * s.state.energy.friction);
    assert!((ratio - 1.0).abs() < 1e-10, "{ratio}");
}
