//! Bonds in a run: every method gives the motion of the sweeps over bodies, which solve a contact
//! and its bond together.

use fretwork::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use fretwork::solve::Problem;
use fretwork::solve::form::{ContactForm, Elastic};
use fretwork::solve::local::solver::Method;
use fretwork::solve::{AutoState, SolverOptions, solve};

const RADIUS: f64 = 0.1;

/// A pile of balls in rows of 5, 4, 3 on a floor, pressed down and pushed sideways. Every contact
/// is bonded with `stiff` times the inverse of its W_nn; some bonds act in tension only. With
/// `blocks` contacts have levers and the inertia differs by axis.
fn pile<S: Space>(stiff: f64, blocks: bool) -> (Problem<S>, Vec<ContactForm<S>>) {
    let mut problem = Problem::<S>::default();
    let along = |x: f64, y: f64| {
        let mut v = S::Vector::zero();
        (v[0], v[1]) = (x, y);
        v
    };
    let mut places = Vec::new();
    for row in 0..3usize {
        for k in 0..5 - row {
            let x = RADIUS * (2.0 * k as f64 + row as f64);
            places.push(along(x, RADIUS * (1.0 + 3f64.sqrt() * row as f64)));
            let push = 0.05 * ((3 * row + k) as f64).sin();
            let mut mass = S::Vector::zero();
            for d in 0..S::D {
                mass[d] = 1.0;
            }
            let v = along(0.2 + push, -1.0);
            let mut inverse = S::Tensor::uniform(2.5 / RADIUS.powi(2));
            if blocks {
                let skew = S::Spin::from_slice(&[0.6 / RADIUS, 0.9 / RADIUS, -0.4 / RADIUS]);
                inverse = inverse + S::Tensor::dyad(&skew, &skew);
            }
            problem.push_body(v, S::Spin::zero(), mass, inverse, RADIUS);
        }
    }
    let floor = places.len() as u32;
    problem.push_body(
        S::Vector::zero(),
        S::Spin::zero(),
        S::Vector::zero(),
        S::Tensor::uniform(0.0),
        1.0,
    );
    let mut forms = Vec::new();
    let mut join = |bodies: [u32; 2], normal: S::Vector| {
        let k = forms.len() as f64;
        let moved = if bodies[1] == floor { 1.0 } else { 2.0 };
        let b = stiff / moved;
        let mut pull = S::Vector::zero();
        for d in 0..S::D {
            pull[d] = 0.02 * b * (1.7 * k + d as f64).cos();
        }
        let mut lever = S::Vector::zero();
        if blocks {
            let [t1, t2] = S::tangents(&normal);
            lever = t1 * (0.3 * RADIUS * k.cos()) + t2 * (0.2 * RADIUS * k.sin());
        }
        let form = ContactForm::<S> {
            bodies,
            normal,
            arms: [normal * -RADIUS + lever, normal * RADIUS + lever],
            central: !blocks,
            apart: false,
            shift_n: 0.0,
            shift_t: S::Tangent::zero(),
            friction: 0.1,
            tension: if forms.len() % 4 == 1 { 0.05 } else { 0.0 },
            cohesion: 0.0,
            elastic: Some(Elastic {
                a_n: 0.05 * b * k.sin(),
                a_t: S::tangential(&normal, &pull),
                b_n: b,
                b_t: 0.5 * b,
                tension_only: forms.len() % 3 != 0,
                ..Elastic::none()
            }),
            compliance: [0.0; 2],
            impulse: S::Vector::zero(),
        };
        problem.push(&form);
        forms.push(form);
    };
    for (i, a) in places.iter().enumerate() {
        for (j, b) in places.iter().enumerate().skip(i + 1) {
            let d = *a - *b;
            if d.norm() < 2.01 * RADIUS {
                join([i as u32, j as u32], d * (1.0 / d.norm()));
            }
        }
        if a[1] < 1.01 * RADIUS {
            join([i as u32, floor], along(0.0, 1.0));
        }
    }
    (problem, forms)
}

/// Velocities and spins (times the radius) of the bodies by a method.
fn by<S: Space>(stiff: f64, blocks: bool, method: Method, tolerance: f64) -> Vec<f64> {
    let (mut problem, forms) = pile::<S>(stiff, blocks);
    let options = SolverOptions {
        tolerance,
        max_iterations: 100_000,
        method,
        ..SolverOptions::default()
    };
    let report = solve(
        &mut problem,
        &forms,
        &[],
        &options,
        None,
        &mut AutoState::default(),
    );
    let name = method.name();
    assert!(report.converged, "{name} at {stiff}: {:e}", report.error);
    let mut out = Vec::new();
    for body in 0..problem.solver_bodies.len() {
        let (v, w) = problem.velocity(body);
        out.extend((0..S::D).map(|k| v[k]));
        out.extend((0..S::Spin::N).map(|k| RADIUS * w[k]));
    }
    out
}

fn agree<S: Space>(stiff: f64, blocks: bool, methods: &[Method]) {
    let known = by::<S>(stiff, blocks, Method::Nlgs, 1e-12);
    let size = known.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for method in methods.iter().copied() {
        let found = by::<S>(stiff, blocks, method, 1e-8);
        let far = found.iter().zip(&known).map(|(a, b)| (a - b).abs());
        let far = far.fold(0.0f64, f64::max);
        let name = method.name();
        // The error is relative to impulses over masses, which are larger than the velocities.
        assert!(far <= 1e-5 * size, "{name} at {stiff}: {far:e} of {size:e}");
    }
}

/// Friction is low, since at 0.3 the pile has several solutions, and each method finds a different
/// one.
fn every_method<S: Space>(blocks: bool) {
    // Where levers couple the directions, gradient methods stop at the root of the round-off
    // (2e-8).
    let methods: Vec<Method> = Method::ALL
        .iter()
        .copied()
        .filter(|m| !(blocks && matches!(m.name(), "pg" | "apgd" | "cpg" | "pcpg")))
        .collect();
    for stiff in [0.1, 1.0, 10.0] {
        agree::<S>(stiff, blocks, &methods);
    }
    // Gradient methods and symmetric sweeps have two unknowns for a bond and its contact, which
    // only methods that factorise separate well.
    let factorise = [Method::Newton, Method::Interior];
    agree::<S>(100.0, blocks, &factorise);
}

#[test]
fn a_bonded_pile_in_the_plane() {
    every_method::<Dim2>(false);
}

#[test]
fn a_bonded_pile_in_space() {
    every_method::<Dim3>(false);
}

#[test]
fn a_bonded_pile_of_blocks() {
    every_method::<Dim2>(true);
    every_method::<Dim3>(true);
}
