//! The Gauss-Seidel sweep gives bit-identical results on any number of threads.

use fretwork::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use fretwork::solve::nlgs::{prepare, solve, sweeps};
use fretwork::solve::{ContactForm, Problem, SolverOptions};

/// Balls of a square lattice, pressed down on a floor: `side` to the power of the dimension.
fn lattice<S: Space>(side: u32) -> Problem<S> {
    let count = side.pow(S::D as u32);
    let mut p = Problem::default();
    let mut gravity = S::Vector::zero();
    gravity[S::D - 1] = -1.0;
    for k in 0..count {
        let wave = f64::from(k * k % 997) / 997.0;
        let mut v = gravity;
        v[0] = wave - 0.5;
        let mut mass = S::Vector::zero();
        for d in 0..S::D {
            mass[d] = 1.0 + 0.2 * wave;
        }
        let inertia = mass[0] / S::BALL_INERTIA;
        p.push_body(v, S::Spin::zero(), mass, S::Tensor::uniform(inertia), 1.0);
    }
    let null = S::Vector::zero();
    p.push_body(null, S::Spin::zero(), null, S::Tensor::uniform(0.0), 1.0);
    for k in 0..count {
        for d in 0..S::D {
            let step = side.pow(d as u32);
            let mut normal = S::Vector::zero();
            if k / step % side + 1 < side {
                normal[d] = -1.0;
                p.push(&contact([k, k + step], normal));
            }
            if d == S::D - 1 && k / step == 0 {
                normal[d] = 1.0;
                p.push(&contact([k, count], normal));
            }
        }
    }
    p
}

fn contact<S: Space>(bodies: [u32; 2], normal: S::Vector) -> ContactForm<S> {
    ContactForm {
        bodies,
        normal,
        arms: [-normal, normal],
        friction: 0.3,
        ..ContactForm::default()
    }
}

fn bits<S: Space>(p: &Problem<S>) -> Vec<u64> {
    let mut out = Vec::new();
    for body in &p.solver_bodies {
        out.extend(body.v.padded().map(f64::to_bits));
        out.extend(body.s.padded().map(f64::to_bits));
    }
    for k in 0..p.contacts() {
        out.extend(p.solution(k).impulse.padded().map(f64::to_bits));
    }
    out
}

fn check<S: Space>(side: u32) {
    let mut one = lattice::<S>(side);
    // The scene has many blocks of 512 contacts and more.
    assert!(one.contacts() > 20_000);
    prepare(&mut one);
    sweeps(&mut one, 20, 1.2, false);
    let whole = SolverOptions {
        max_iterations: 30,
        parallel: true,
        ..SolverOptions::default()
    };
    let mut solved = lattice::<S>(side);
    let alone = SolverOptions {
        parallel: false,
        ..whole
    };
    let report = solve(&mut solved, &alone);
    for threads in [2, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut many = lattice::<S>(side);
            prepare(&mut many);
            sweeps(&mut many, 20, 1.2, true);
            assert!(bits(&one) == bits(&many));
            let mut many = lattice::<S>(side);
            assert_eq!(solve(&mut many, &whole), report);
            assert!(bits(&solved) == bits(&many));
        });
    }
}

#[test]
fn threads_do_not_change_the_bits_of_disks() {
    check::<Dim2>(110);
}

#[test]
fn threads_do_not_change_the_bits_of_spheres() {
    check::<Dim3>(21);
}
