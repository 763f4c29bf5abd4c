//! A rigid cylinder pressed on an elastic block, and moved along it: Hertz's line contact, and
//! Cattaneo and Mindlin's stick zone.
//!
//! K. L. Johnson, "Contact Mechanics" (1985), sections 4.2 and 7.2: with E* = E/(1 - nu^2) and P
//! the load per length,
//!
//! ```text
//! a = 2 sqrt(P R/(pi E*))        p(x) = p0 sqrt(1 - x^2/a^2), p0 = 2 P/(pi a)
//! c/a = sqrt(1 - Q/(mu P))       q(x) = mu p(x) - mu p0 (c/a) sqrt(1 - x^2/c^2) where |x| < c
//! ```

use super::*;
use cpu_time::ThreadTime;
use fretwork::solve::SolverOptions;
use nalgebra::Vector2;

/// The usual benchmark of a rail and a wheel: G 82 GPa, nu 0.28, R 500 mm, where a is 1 mm under
/// 178.9 N/mm.
const STEEL: Elasticity = Elasticity {
    young: 2.0 * 82e9 * 1.28,
    poisson: 0.28,
    density: 7800.0,
};

const RADIUS: f64 = 0.5;
const A: f64 = 1e-3;
/// Step of a thousandth of a second: waves cross the bodies in a hundredth of it, and the velocity
/// that the load would give the cylinder without contacts, against which the error of the solver is
/// measured, is still small.
const STEP: f64 = 1e-3;
/// Extent of the bodies (m).
const FAR: f64 = 40.0 * A;
const MU: f64 = 0.3;

/// E* of two bodies of steel, or of a steel body and a rigid one (Pa).
fn modulus(counter: Counter) -> f64 {
    match counter {
        Counter::Rigid => STEEL.plane_strain(),
        Counter::Steel => 0.5 * STEEL.plane_strain(),
    }
}

/// The body pressed on the block.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Counter {
    /// A rigid disk without friction: with friction, shear tractions due to the load alone would
    /// raise the pressure.
    Rigid,
    /// A cylinder of equal steel; the block is its mirror image.
    Steel,
}

/// Load per length for the half-width A (N/m).
fn load(counter: Counter) -> f64 {
    std::f64::consts::PI * modulus(counter) * A * A / (4.0 * RADIUS)
}

/// Coordinates along the contact, even within it, and away from it, with `n` elements over the
/// half-width.
fn coordinates(n: usize) -> [Vec<f64>; 2] {
    let size = A / n as f64;
    let outside = graded(1.5 * A, FAR, size, 1.25);
    let left = outside.iter().skip(1).map(|x| -x).rev();
    let middle = even(-1.5 * A, 1.5 * A, 3 * n);
    let right = outside.iter().skip(1).copied();
    let x = left.chain(middle).chain(right).collect();
    [x, graded(0.0, FAR, size, 1.15)]
}

/// The cylinder at rest under its load and a tangential force along x, given as a fraction of mu P.
/// The block has `n` elements over the half-width, a cylinder of steel `finer` quarters of that
/// number. The solution is static: steps are long against all waves.
fn pressed(counter: Counter, n: usize, finer: usize, share: f64) -> Simulation<Dim2> {
    pressed_as(counter, n, finer, share, |lines, _| {
        BlockGrid::new(lines).unwrap()
    })
}

/// Columns that reach through all rows.
fn whole(lines: &[Vec<f64>], _: &str) -> BlockGrid {
    BlockGrid::new(lines).unwrap()
}

/// Columns that join with the distance from a side.
fn joined(lines: &[Vec<f64>], from: &str) -> BlockGrid {
    BlockGrid::coarsened(lines, &Coarsening { from, ratio: 1.0 }, 1_000_000).unwrap()
}

/// Does as [`pressed`] with cells that the last argument makes from coordinates, counted from the
/// side of that name.
fn pressed_as(
    counter: Counter,
    n: usize,
    finer: usize,
    share: f64,
    cells: fn(&[Vec<f64>], &str) -> BlockGrid,
) -> Simulation<Dim2> {
    let normal = load(counter);
    let ramp = |from: f64, to: f64| TimeFunction::Ramp {
        from: 0.0,
        to,
        start: from,
        end: from + 10.0 * STEP,
    };
    let (down, along) = (ramp(0.0, -normal), ramp(12.0 * STEP, share * MU * normal));
    let floor = "(name: \"far\", material: \"m0\", shapes: [HalfSpace(normal: [0.0, 1.0])], position: [0.0, -1.0]),";
    let disk = format!(
        "(name: \"cylinder\", material: \"m0\", shapes: [Balls([([0.0, 0.0], {RADIUS:?})])], position: [0.0, {RADIUS:?}], \
         dofs: (x: Fixed, y: Force(Ramp(from: 0.0, to: {:?}, start: 0.0, end: {:?})), rz: Fixed)),",
        -normal,
        10.0 * STEP
    );
    let rigid = counter == Counter::Rigid;
    let mut s = scene::<Dim2>(&Sketch {
        bodies: if rigid { disk } else { floor.to_owned() },
        mu: if rigid { 0.0 } else { MU },
        // The number of sweeps grows with the square of the number of points.
        solver: "tolerance: 1e-12, norm: Velocity, method: Newton,".to_owned(),
        ..sketch(STEP, 1.0)
    });
    let [x, y] = coordinates(n);
    let below: Vec<f64> = y.iter().map(|y| -y).rev().collect();
    let held = [support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)])];
    let grid = cells(&[x, below], "top");
    let mut flat = body(mapped_grid::<Dim2>(&grid, |p| *p).unwrap(), STEEL, &held);
    flat.touching = if rigid {
        Touching::Points("top")
    } else {
        Touching::Surface("top")
    };
    add(&mut s, flat);
    if !rigid {
        let round = |p: &Vector2<f64>| {
            let sagitta = RADIUS - (RADIUS * RADIUS - p.x * p.x).sqrt();
            Vector2::new(p.x, p.y + sagitta * (1.0 - p.y / FAR))
        };
        let [x, y] = coordinates(finer * n / 4);
        let grid = cells(&[x, y], "bottom");
        let mesh = mapped_grid::<Dim2>(&grid, round).unwrap();
        let driven = [support(
            "top",
            &[Some(Dof::Force(along)), Some(Dof::Force(down))],
        )];
        let mut cylinder = body(mesh, STEEL, &driven);
        cylinder.name = "cylinder";
        cylinder.touching = Touching::Points("bottom");
        add(&mut s, cylinder);
    }
    s
}

/// Position along x (m), pressure and shear traction (Pa) on the lower body at each touching point.
fn tractions(s: &Simulation<Dim2>, n: usize) -> Vec<[f64; 3]> {
    let length = A / n as f64 * s.options.scheme.h;
    let contacts = s.state.network.contacts.iter();
    let mut out: Vec<[f64; 3]> = contacts
        .filter(|c| c.impulse[1] != 0.0)
        .map(|c| {
            // The impulse on the candidate, which is above.
            let n = c.normal;
            let x = s.state.bodies.position[c.bodies[0] as usize][0] + c.arms[0][0];
            let along = c.impulse[0] * n[1] - c.impulse[1] * n[0];
            [x, c.impulse.dot(&n) / length, -along * n[1].abs() / length]
        })
        .collect();
    out.sort_by(|a, b| a[0].total_cmp(&b[0]));
    out
}

/// Root mean square of the difference from a closed form (Pa).
fn off(tractions: &[[f64; 3]], which: usize, expected: impl Fn(f64) -> f64) -> f64 {
    let squares = tractions
        .iter()
        .map(|t| (t[which] - expected(t[0])).powi(2));
    (squares.sum::<f64>() / tractions.len() as f64).sqrt()
}

fn ellipse(x: f64, half: f64) -> f64 {
    (1.0 - (x / half).powi(2)).max(0.0).sqrt()
}

/// The half-width of an elliptic distribution from its second moment, P a^2/4.
fn half_width(tractions: &[[f64; 3]]) -> f64 {
    let moment: f64 = tractions.iter().map(|t| t[1] * t[0] * t[0]).sum();
    let total: f64 = tractions.iter().map(|t| t[1]).sum();
    2.0 * (moment / total).sqrt()
}

fn hertz(counter: Counter) {
    if counter == Counter::Steel {
        near(178.9e3, load(counter), 1e-3);
    }
    let p0 = 2.0 * load(counter) / (std::f64::consts::PI * A);
    let [mut widths, mut errors] = [Vec::new(), Vec::new()];
    for n in [4, 8, 16, 32] {
        let mut s = pressed(counter, n, 4, 0.0);
        go(&mut s, 12);
        let found = tractions(&s, n);
        let total: f64 = found.iter().map(|t| t[1] * A / n as f64).sum();
        near(load(counter), total, 1e-4);
        widths.push(half_width(&found) / A - 1.0);
        errors.push(off(&found, 1, |x| p0 * ellipse(x, A)) / p0);
    }
    println!("{counter:?}: a {widths:?} p {errors:?}");
    // The pressure converges at least with first order, since its edge lies between two points. The
    // bodies are 40 a high, not half-spaces.
    assert!(errors[3] < 0.01, "{errors:?}");
    assert!(errors.windows(2).all(|e| e[1] < 0.6 * e[0]), "{errors:?}");
    assert!(widths[3].abs() < 0.005, "{widths:?}");
}

#[test]
fn hertz_on_a_rigid_cylinder() {
    hertz(Counter::Rigid);
}

#[test]
fn hertz_between_two_bodies() {
    hertz(Counter::Steel);
}

/// With the default solver, whose error is measured against velocities that the load would give the
/// cylinder, no point has another pressure than with a tight tolerance.
#[test]
fn defaults_have_the_pressure_of_each_point() {
    let p0 = 2.0 * load(Counter::Steel) / (std::f64::consts::PI * A);
    let [tight, default] = [false, true].map(|default| {
        let mut s = pressed(Counter::Steel, 8, 4, 0.0);
        if default {
            s.options.solver = SolverOptions::default();
        }
        go(&mut s, 12);
        tractions(&s, 8)
    });
    assert_eq!(tight.len(), default.len());
    let differ = tight.iter().zip(&default).map(|(a, b)| (a[1] - b[1]).abs());
    let most = differ.fold(0.0, f64::max) / p0;
    println!("{most:e} of p0 at most");
    assert!(most < 0.005, "{most}");
}

/// If points lie anywhere on the segments of the other body, pressures of single points are still
/// those of Hertz: a contact acts on the mean place that a point faces over the segments at it.
#[test]
fn meshes_that_do_not_match_have_the_pressure() {
    let p0 = 2.0 * load(Counter::Steel) / (std::f64::consts::PI * A);
    for finer in [2, 3, 4, 5, 7] {
        let mut s = pressed(Counter::Steel, 16, finer, 0.0);
        go(&mut s, 12);
        let n = 4 * finer;
        let found = tractions(&s, n);
        let total: f64 = found.iter().map(|t| t[1] * A / n as f64).sum();
        let error = off(&found, 1, |x| p0 * ellipse(x, A)) / p0;
        let worst = found.iter().filter(|t| t[0].abs() < 0.9 * A);
        let worst = worst.map(|t| (t[1] / (p0 * ellipse(t[0], A)) - 1.0).abs());
        let worst = worst.fold(0.0, f64::max);
        println!(
            "{finer} to 4: a {:.4}, p off by {error:.4} of p0, {worst:.4} at most within 0.9 a",
            half_width(&found) / A
        );
        near(load(Counter::Steel), total, 1e-4);
        near(A, half_width(&found), 0.01);
        assert!(error < 0.3 / n as f64, "{error}");
    }
}

#[test]
fn cattaneo_and_mindlin() {
    let p0 = 2.0 * load(Counter::Steel) / (std::f64::consts::PI * A);
    for (share, finer) in [(0.36, 4), (0.75, 4), (0.36, 5), (0.75, 5), (0.75, 3)] {
        let stuck = (1.0_f64 - share).sqrt();
        let mut s = pressed(Counter::Steel, 20, finer, share);
        go(&mut s, 24);
        closes(&s, 1e-6);
        let found = tractions(&s, 5 * finer);
        // The bodies have moved along a little.
        let centre = found.iter().map(|t| t[0] * t[1]).sum::<f64>()
            / found.iter().map(|t| t[1]).sum::<f64>();
        let found: Vec<[f64; 3]> = found.iter().map(|t| [t[0] - centre, t[1], t[2]]).collect();
        let expected = |x: f64| MU * p0 * (ellipse(x, A) - stuck * ellipse(x, stuck * A));
        let error = off(&found, 2, expected) / (MU * p0);
        // The second moment of the shear is mu P (a^2 - c^4/a^2)/4.
        let second = |which: usize| found.iter().map(|t| t[which] * t[0] * t[0]).sum::<f64>();
        let c = (1.0 - second(2) / (MU * second(1))).powf(0.25);
        println!("{share}, {finer} to 4: c/a {c} for {stuck}, q off by {error:e}");
        near(stuck, c, 0.02);
        assert!(error < 0.02, "{share}: {error}");
    }
}

/// Columns of cells that join with the depth give an equal result with fewer unknowns.
#[test]
fn hertz_on_cells_that_double_with_the_depth() {
    let p0 = 2.0 * load(Counter::Steel) / (std::f64::consts::PI * A);
    for n in [16, 32] {
        let [whole, joined] = [whole, joined].map(|cells| {
            let clock = ThreadTime::now();
            let mut s = pressed_as(Counter::Steel, n, 4, 0.0, cells);
            go(&mut s, 12);
            let seconds = clock.elapsed().as_secs_f64();
            let systems = (0..2).map(|k| s.state.systems.get(k).unwrap());
            let unknowns: usize = systems.map(|system| system.freedoms()).sum();
            let found = tractions(&s, n);
            let total: f64 = found.iter().map(|t| t[1] * A / n as f64).sum();
            near(load(Counter::Steel), total, 1e-4);
            let error = off(&found, 1, |x| p0 * ellipse(x, A)) / p0;
            let sunk = -holder(&s, 1, "top", 1).displacement;
            println!(
                "{n} over a: {unknowns} unknowns, {seconds:.2} s, a off by {:e}, p by {error:e} of p0, sunk {sunk:e} m",
                half_width(&found) / A - 1.0
            );
            (unknowns as f64, seconds, half_width(&found), error, sunk)
        });
        println!(
            "{n} over a: {:.2} of the unknowns, {:.2} of the time",
            joined.0 / whole.0,
            joined.1 / whole.1
        );
        assert!(joined.0 < 0.6 * whole.0);
        near(A, joined.2, 0.005);
        near(whole.2, joined.2, 0.002);
        assert!(joined.3 < 0.25 / n as f64, "{}", joined.3);
        near(whole.4, joined.4, 0.001);
    }
}
