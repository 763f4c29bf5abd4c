//! Newton in velocities compared with Gauss-Seidel, and from any start.

use super::{Solve, Start, barrier, solve};
use crate::geometry::space::{Dim2, Dim3, Space, VectorLike};
use crate::solve::form::{ContactForm, Elastic};
use crate::solve::{MomentForm, Problem, Report, SolverOptions, nlgs};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A problem with its forms.
struct Case<S: Space> {
    problem: Problem<S>,
    forms: Vec<ContactForm<S>>,
    moments: Vec<MomentForm<S>>,
}

/// Random bodies with random contacts of springs of which some are bonded, and a few bodies that do
/// not move: 3 contacts for each body. `inertia` multiplies masses.
fn random<S: Space>(seed: u64, inertia: f64) -> Case<S> {
    const BODIES: u32 = 60;
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut problem = Problem::<S>::default();
    let mut any = |scale: f64| scale * rng.random_range(-1.0..1.0);
    fn vector<V: VectorLike>(mut any: impl FnMut() -> f64) -> V {
        let mut v = V::zero();
        (0..V::N).for_each(|k| v[k] = any());
        v
    }
    for b in 0..BODIES {
        let moves = if b < 4 { 0.0 } else { 1.0 / inertia };
        let (v, w) = if b < 4 {
            (S::Vector::zero(), S::Spin::zero())
        } else {
            (vector(|| any(1.0)), vector(|| any(1.0)))
        };
        let mut mass = S::Vector::zero();
        (0..S::D).for_each(|k| mass[k] = moves * (1.5 + any(0.5)));
        use crate::geometry::space::MatrixLike;
        let spin = S::Tensor::uniform(moves * (4.0 + any(2.0)));
        problem.push_body(v, w, mass, spin, 0.5);
    }
    let (mut forms, mut moments) = (Vec::new(), Vec::new());
    for k in 0..3 * BODIES {
        let one = 4 + k % (BODIES - 4);
        let other = (one + 1 + k / 7) % BODIES;
        let direction: S::Vector = vector(|| any(1.0));
        let normal = direction * (1.0 / direction.norm());
        let bonded = k % 3 == 0;
        let elastic = bonded.then(|| Elastic {
            a_n: any(0.5),
            a_t: S::tangential(&normal, &vector(|| any(0.5))),
            b_n: 2.0 + any(1.0),
            b_t: 2.0 + any(1.0),
            tension_only: k % 2 == 0,
            ..Elastic::none()
        });
        let form = ContactForm {
            bodies: [one, other],
            normal,
            arms: [vector(|| any(0.5)), vector(|| any(0.5))],
            central: false,
            shift_n: any(0.2),
            shift_t: S::tangential(&normal, &vector(|| any(0.2))),
            friction: 0.4 + any(0.3),
            tension: 0.1 + any(0.1),
            cohesion: if k % 5 == 0 { 0.05 } else { 0.0 },
            elastic,
            compliance: [0.02 + any(0.015), 0.03 + any(0.02)],
            ..ContactForm::default()
        };
        problem.push(&form);
        if bonded {
            moments.push(MomentForm {
                contact: k,
                rolling: 0.0,
                spinning: 0.0,
                a: vector(|| any(0.1)),
                b_twist: 0.5,
                b_bend: 0.8,
                loss_twist: 0.0,
                loss_bend: 0.0,
                moment: S::Spin::zero(),
            });
        }
        forms.push(form);
    }
    for form in &moments {
        problem.push_moment(form, &forms[form.contact as usize]);
    }
    Case {
        problem,
        forms,
        moments,
    }
}

impl<S: Space> Case<S> {
    /// Solves from bodies that all move at one speed along the first axis.
    fn solve(&mut self, tolerance: f64, speed: f64) -> Report {
        self.solve_by(tolerance, speed, false)
    }

    fn solve_by(&mut self, tolerance: f64, speed: f64, barrier_alone: bool) -> Report {
        let options = SolverOptions {
            tolerance,
            ..SolverOptions::default()
        };
        let bodies = self.problem.solver_bodies.len();
        let mut velocity = vec![S::Vector::zero(); bodies];
        velocity.iter_mut().for_each(|v| v[0] = speed);
        let start = Start {
            velocity: &velocity,
            spin: &vec![S::Spin::zero(); bodies],
        };
        nlgs::arrange(&mut self.problem, &options);
        let problem = &mut self.problem;
        if barrier_alone {
            let mut solve = Solve::new(problem, &self.forms, &self.moments, &options);
            let begin = solve.balance.start(problem, Some(&start));
            barrier::solve(&mut solve, problem, &begin);
            return solve.best.report;
        }
        solve(problem, &self.forms, &self.moments, Some(&start), &options)
    }

    fn velocities(&self) -> Vec<f64> {
        let bodies = 0..self.problem.solver_bodies.len();
        let of = |b| {
            let (v, w) = self.problem.velocity(b);
            let [v, w] = [v.padded(), w.padded()];
            [v, w].concat()
        };
        bodies.flat_map(of).collect()
    }
}

fn agrees_with_gauss_seidel<S: Space>() {
    for seed in 0..4 {
        let mut swept = random::<S>(seed, 1.0);
        let options = SolverOptions {
            tolerance: 1e-13,
            max_iterations: 100_000,
            ..SolverOptions::default()
        };
        assert!(nlgs::solve(&mut swept.problem, &options).converged);
        for speed in [0.0, 100.0] {
            let mut newton = random::<S>(seed, 1.0);
            let report = newton.solve(1e-13, speed);
            assert!(
                report.converged && report.iterations < 60,
                "{seed} {report:?}"
            );
            for (a, b) in swept.velocities().iter().zip(newton.velocities()) {
                assert!((a - b).abs() < 1e-9, "{seed}: {a} {b}");
            }
        }
    }
}

#[test]
fn velocities_are_those_of_gauss_seidel_in_2d() {
    agrees_with_gauss_seidel::<Dim2>();
}

#[test]
fn velocities_are_those_of_gauss_seidel_in_3d() {
    agrees_with_gauss_seidel::<Dim3>();
}

/// The interior point method needs no good start, and no Newton before it.
#[test]
fn interior_points_lead_to_the_solution_from_afar() {
    for (seed, speed) in [(0, 0.0), (1, 1e3), (2, -1e3), (3, 1e6)] {
        let mut plane = random::<Dim2>(seed, 1.0);
        let mut space = random::<Dim3>(seed, 1.0);
        for report in [
            plane.solve_by(1e-10, speed, true),
            space.solve_by(1e-10, speed, true),
        ] {
            assert!(report.converged, "{seed} {speed} {report:?}");
        }
    }
}

/// A ball that touches a plane and one above it, all at rest, are loaded in the step: the springs
/// carried nothing before.
#[test]
fn bodies_that_touch_at_rest_are_loaded() {
    use nalgebra::{Matrix1, Vector1, Vector2};
    let mut problem = Problem::<Dim2>::default();
    let down = Vector2::new(0.0, -0.01);
    for moves in [0.0, 1.0, 1.0] {
        let (spin, inertia) = (Vector1::new(0.0), Matrix1::new(2.0 * moves));
        problem.push_body(down * moves, spin, Vector2::repeat(moves), inertia, 1.0);
    }
    let form = |one: u32| ContactForm {
        bodies: [one, one - 1],
        normal: Vector2::new(0.0, 1.0),
        arms: [Vector2::new(0.0, -1.0), Vector2::new(0.0, 1.0)],
        friction: 0.5,
        compliance: [1e-3, 1e-3],
        ..ContactForm::default()
    };
    let forms = vec![form(1), form(2)];
    forms.iter().for_each(|form| problem.push(form));
    let mut case = Case {
        problem,
        forms,
        moments: Vec::new(),
    };
    let report = case.solve_by(1e-10, 0.0, true);
    assert!(report.converged, "{report:?}");
    // u = v_free + p - q with masses of 1 kg, and c p = -u for the springs.
    let [p, q] = [0, 1].map(|k| case.problem.solution(k).impulse[1]);
    let u = [p - q - 0.01, q - 0.01];
    assert!((u[0] + 1e-3 * p).abs() < 1e-9, "{p} {q}");
    assert!((u[1] - u[0] + 1e-3 * q).abs() < 1e-9, "{p} {q}");
}

/// Bodies a million times lighter take at most a few tens of iterations more.
#[test]
fn iterations_do_not_grow_as_inertia_falls() {
    let iterations = |inertia| {
        let mut case = random::<Dim2>(1, inertia);
        let report = case.solve(1e-10, 0.0);
        assert!(report.converged, "{report:?}");
        report.iterations
    };
    let [heavy, light] = [1.0, 1e-6].map(iterations);
    assert!(light <= heavy + 40, "{heavy} {light}");
}
