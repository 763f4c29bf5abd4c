//! Masses as nodes of systems compared with rigid bodies, and sweeps compared with products of W.

use super::*;
use crate::bodies::Nodes;
use crate::geometry::space::Dim2;
use crate::solve::chosen;
use crate::solve::error::Norm;
use crate::solve::nlgs::{self, SolverOptions};
use crate::solve::standard::Standard;
use nalgebra::{Matrix1, Matrix2, Vector1, Vector2};

fn form(bodies: [u32; 2], normal: Vector2<f64>) -> ContactForm<Dim2> {
    ContactForm {
        bodies,
        normal,
        arms: [Vector2::zeros(); 2],
        central: false,
        friction: 0.3,
        ..ContactForm::default()
    }
}

/// Masses of the bodies (kg).
const MASSES: [f64; 3] = [2.0, 0.5, 3.0];

/// Velocity of a body or node without contacts (m/s).
fn free(k: usize) -> Vector2<f64> {
    Vector2::new(0.3 - 0.2 * k as f64, -1.0 - 0.1 * k as f64)
}

/// A stack of three bodies that do not rotate on a fixed plane, as rigid bodies or as nodes of one
/// system.
fn stack(rigid: bool) -> (Problem<Dim2>, Vec<ContactForm<Dim2>>) {
    let mut problem = Problem::default();
    for (k, mass) in MASSES.iter().enumerate() {
        let inverse = if rigid { 1.0 / mass } else { 0.0 };
        let (mass, turned) = (Vector2::new(inverse, inverse), Matrix1::zeros());
        problem.push_body(free(k), Vector1::zeros(), mass, turned, 0.1);
    }
    let (still, turned) = (Vector2::zeros(), Matrix1::zeros());
    problem.push_body(still, Vector1::zeros(), still, turned, 0.1);
    if !rigid {
        let blocks = (0..9).map(|at| {
            let inverse = if at % 4 == 0 {
                1.0 / MASSES[at / 4]
            } else {
                0.0
            };
            Matrix2::from_diagonal_element(inverse)
        });
        let free = (0..3).map(free).collect();
        problem.push_system(NodalSystem::new(
            vec![4, 5, 7],
            free,
            &blocks.collect::<Vec<_>>(),
        ));
    }
    let node = |k: usize| match k {
        3 => Side::Rigid {
            body: 3,
            arm: Vector2::zeros(),
        },
        _ => Side::Nodes {
            system: 0,
            nodes: Nodes::one([4, 5, 7][k]),
        },
    };
    let mut forms = Vec::new();
    // The contacts are in the order of the iteration: contacts that share no body come first.
    for (k, below) in [(0, 3), (2, 1), (1, 0)] {
        let form = form([k as u32, below as u32], Vector2::new(0.0, 1.0));
        if rigid {
            problem.push(&form);
        } else {
            assert!(problem.push_between(&form, &[node(k), node(below)]));
        }
        forms.push(form);
    }
    (problem, forms)
}

/// The scale of the solver's error is the same for a mass as a body and as a node.
#[test]
fn errors_of_nodes_and_bodies_are_measured_alike() {
    for norm in [Norm::Balance, Norm::Velocity] {
        for sweeps in 1..6 {
            let options = SolverOptions {
                norm,
                tolerance: 0.0,
                max_iterations: sweeps,
                test_every: 1,
                ..SolverOptions::default()
            };
            let error = |rigid: bool| nlgs::solve(&mut stack(rigid).0, &options).error;
            let (body, node) = (error(true), error(false));
            assert!(body > 0.0, "{norm:?} {sweeps}");
            assert!(
                (node / body - 1.0).abs() < 1e-9,
                "{norm:?} {sweeps}: {body} {node}"
            );
        }
    }
}

#[test]
fn motions_of_nodes_count_as_those_of_bodies() {
    let [of_bodies, of_nodes] = [true, false].map(|rigid| {
        let (mut problem, forms) = stack(rigid);
        nlgs::solve(&mut problem, &SolverOptions::default());
        chosen::hyperstaticity(&problem, &forms)
    });
    assert!(of_bodies > 0.0);
    assert_eq!(of_bodies, of_nodes);
}

/// A rigid disk and a fixed plane touch two systems of full compliance, which also touch each
/// other, at weighted sums of nodes. Relative velocities are the same from W as a matrix, from
/// products without the matrix, and from updates contact by contact.
#[test]
fn matrix_products_and_sweeps_agree() {
    let mut problem = Problem::<Dim2>::default();
    let length = 0.2;
    let disk = (Vector2::new(0.5, 0.5), Matrix1::new(30.0));
    problem.push_body(free(0), Vector1::new(1.5), disk.0, disk.1, length);
    for _ in 0..3 {
        // The plane and the bodies that represent the systems, which move with them.
        let (still, turned) = (Vector2::zeros(), Matrix1::zeros());
        problem.push_body(
            Vector2::new(9.0, 9.0),
            Vector1::new(9.0),
            still,
            turned,
            0.1,
        );
    }
    problem.free[1] = (Vector2::zeros(), Vector1::zeros());
    for count in [3usize, 2] {
        let blocks = (0..count * count).map(|at| {
            let (a, b) = (at / count, at % count);
            let off = 0.1 / (1.0 + (a as f64 - b as f64).abs());
            let own = if a == b { 1.0 } else { 0.0 };
            let shear = 0.02 * (a as f64 - b as f64);
            Matrix2::new(own + off, shear, shear, 2.0 * own - off)
        });
        let free = (0..count).map(free).collect();
        let ids = (0..count as u32).collect();
        problem.push_system(NodalSystem::new(ids, free, &blocks.collect::<Vec<_>>()));
    }
    assert_eq!(problem.systems[0].block(0, 2).entry(0, 1), -0.04);
    let side = |system: u32, terms: &[(u32, f64)]| Side::Nodes {
        system,
        nodes: Nodes::sum(terms).unwrap(),
    };
    let arm = Vector2::new(0.05, -0.2);
    let rigid = |body: u32| Side::Rigid { body, arm };
    let oblique = Vector2::new(0.6, 0.8);
    let upright = Vector2::new(0.0, 1.0);
    let contacts = [
        (
            [0, 2],
            upright,
            [rigid(0), side(0, &[(0, 0.25), (1, 0.75)])],
        ),
        ([2, 1], oblique, [side(0, &[(2, 1.0)]), rigid(1)]),
        (
            [3, 2],
            upright,
            [side(1, &[(0, 0.5), (1, 0.5)]), side(0, &[(1, 1.0)])],
        ),
        (
            [2, 2],
            oblique,
            [side(0, &[(0, 1.0)]), side(0, &[(2, 1.0)])],
        ),
        ([0, 3], oblique, [rigid(0), side(1, &[(1, 1.0)])]),
    ];
    let mut forms = Vec::new();
    for (bodies, normal, sides) in contacts {
        let form = ContactForm {
            arms: [arm, arm],
            ..form(bodies, normal)
        };
        assert!(problem.push_between(&form, &sides));
        forms.push(form);
    }
    let impulses: Vec<_> = (0..5u8)
        .map(|k| Vector2::new(0.3 * f64::from(k) - 0.4, 1.0 - 0.1 * f64::from(k)))
        .collect();
    let given: Vec<_> = impulses.iter().copied().map(Some).collect();
    problem.adopt(&given, &[]);
    let swept = problem.relative_velocities_of_systems();

    let standard = Standard::<Dim2, 2>::new(&problem, &forms, &[]);
    let (w, q) = standard.operator();
    let local = forms.iter().zip(&impulses).map(|(form, p)| {
        let [t, _] = Dim2::tangents(&form.normal);
        [form.normal.dot(p), t.dot(p)]
    });
    let p: Vec<[f64; 2]> = local.collect();
    let (mut products, mut rows) = (q.to_vec(), q.to_vec());
    w.velocity(&p, q, &mut products);
    w.matrix().unwrap().velocity(&p, q, &mut rows);
    for (k, form) in forms.iter().enumerate() {
        let [t, _] = Dim2::tangents(&form.normal);
        let expected = [form.normal.dot(&swept[k]), t.dot(&swept[k])];
        for i in 0..2 {
            assert!(
                (products[k][i] - expected[i]).abs() < 1e-13,
                "{k} {products:?} {swept:?}"
            );
            assert!(
                (rows[k][i] - expected[i]).abs() < 1e-13,
                "{k} {rows:?} {swept:?}"
            );
        }
    }
}
