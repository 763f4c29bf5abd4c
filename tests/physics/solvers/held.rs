//! Contacts of bodies that are held in some or all directions: a spring, a bond, damping and
//! friction have an impulse that follows from the imposed velocities, without any mass. Every row
//! and every method is compared with the laws.

use fretwork::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use fretwork::solve::Problem;
use fretwork::solve::form::{ContactForm, Elastic};
use fretwork::solve::local::solver::Method;
use fretwork::solve::{AutoState, MomentForm, SolverOptions, solve};

/// Number of pairs of bodies, more than a register has lanes.
const PAIRS: usize = 21;

/// Response of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    /// A unilateral spring with friction, which sticks at every third contact.
    Spring,
    /// A bond, which only pulls at every third contact.
    Bond,
    /// Spring and bond.
    Both,
    /// A rigid contact with attraction and shear cohesion.
    Cohesion,
}

/// Free motions of the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moves {
    Not,
    /// Rotation about axes across the contact's normal, at a fixed position.
    Turns,
    /// Motion along the last axis.
    Along,
}

fn vector<S: Space>(of: impl Fn(usize) -> f64) -> S::Vector {
    let mut out = S::Vector::zero();
    for k in 0..S::D {
        out[k] = of(k);
    }
    out
}

/// A wave of the number of a pair, between -1 and 1.
fn wave(pair: usize, of: f64) -> f64 {
    (1.3 * pair as f64 + of).sin()
}

fn contact<S: Space>(pair: usize, answer: Answer, central: bool) -> ContactForm<S> {
    let along = vector::<S>(|k| wave(pair, 3.0 * k as f64 + 0.2));
    let normal = along * (1.0 / along.norm());
    let aside = |of: f64| S::tangential(&normal, &vector::<S>(|k| wave(pair, of + 2.0 * k as f64)));
    let [t1, _] = S::tangents(&normal);
    let lever = if central { S::Vector::zero() } else { t1 * 0.3 };
    let bond = Elastic {
        a_n: 0.4 * wave(pair, 1.0),
        a_t: aside(5.0) * 0.3,
        b_n: 0.5,
        b_t: 0.3,
        tension_only: pair.is_multiple_of(3),
        ..Elastic::none()
    };
    let sprung = matches!(answer, Answer::Spring | Answer::Both);
    let cohesive = answer == Answer::Cohesion;
    ContactForm {
        bodies: [2 * pair as u32, 2 * pair as u32 + 1],
        normal,
        arms: [lever - normal, lever + normal],
        central,
        apart: false,
        shift_n: if cohesive { 2.0 } else { 0.3 * wave(pair, 2.0) },
        shift_t: if sprung {
            aside(6.0) * 0.2
        } else {
            S::Tangent::zero()
        },
        friction: if pair % 3 == 1 { 2.0 } else { 0.3 },
        tension: if cohesive || pair.is_multiple_of(4) {
            0.2
        } else {
            0.0
        },
        cohesion: if cohesive { 0.1 } else { 0.0 },
        elastic: matches!(answer, Answer::Bond | Answer::Both).then_some(bond),
        compliance: if sprung { [0.7, 1.1] } else { [0.0; 2] },
        // The impulse of the previous step belongs to other conditions.
        impulse: normal * 9.0 + S::tangent_vector(&normal, &(aside(7.0) * 4.0)),
    }
}

struct Posed<S: Space> {
    problem: Problem<S>,
    forms: Vec<ContactForm<S>>,
    moments: Vec<MomentForm<S>>,
}

fn posed<S: Space>(answer: Answer, moves: Moves, central: bool, moment: bool) -> Posed<S> {
    let mut problem = Problem::<S>::default();
    for body in 0..2 * PAIRS {
        let v = vector::<S>(|k| wave(body, 4.0 + k as f64));
        let mut w = S::Spin::zero();
        for k in 0..S::Spin::N {
            w[k] = wave(body, 8.0 + k as f64);
        }
        let mass = vector::<S>(|k| f64::from(moves == Moves::Along && k + 1 == S::D));
        let turns = if moves == Moves::Turns { 0.8 } else { 0.0 };
        problem.push_body(v, w, mass, S::Tensor::uniform(turns), 1.0);
    }
    let forms: Vec<_> = (0..PAIRS)
        .map(|k| contact::<S>(k, answer, central))
        .collect();
    problem.push_all(&forms, false);
    let moments: Vec<_> = (0..PAIRS)
        .filter(|_| moment)
        .map(|k| {
            let mut a = S::Spin::zero();
            a[0] = 0.2;
            MomentForm {
                contact: k as u32,
                rolling: 0.05,
                spinning: 0.02,
                a,
                b_twist: 0.3,
                b_bend: 0.4,
                loss_twist: 0.0,
                loss_bend: 0.0,
                moment: S::Spin::zero(),
            }
        })
        .collect();
    for form in &moments {
        problem.push_moment(form, &forms[form.contact as usize]);
    }
    Posed {
        problem,
        forms,
        moments,
    }
}

/// The relative velocity of a contact at the velocities of the bodies.
fn relative<S: Space>(problem: &Problem<S>, form: &ContactForm<S>) -> S::Vector {
    let [a, b] = [0, 1].map(|side| {
        let (v, w) = problem.velocity(form.bodies[side] as usize);
        v + S::spin_velocity(&w, &form.arms[side])
    });
    a - b
}

/// Deviation of the impulse of a contact from its laws at the present velocities.
fn off<S: Space>(problem: &Problem<S>, form: &ContactForm<S>, k: usize) -> f64 {
    let (u, n, p) = (
        relative(problem, form),
        form.normal,
        problem.solution(k).impulse,
    );
    let (un, ut) = (n.dot(&u), S::tangential(&n, &u));
    let (mut pn, mut pt) = (n.dot(&p), S::tangential(&n, &p));
    if let Some(e) = &form.elastic {
        let pull = -(e.a_n + e.b_n * un);
        pn -= if e.tension_only { pull.min(0.0) } else { pull };
        pt += e.a_t + ut * e.b_t;
    }
    let [c_n, c_t] = form.compliance;
    // A rigid contact between held bodies carries no pressure.
    let pressed = if c_n > 0.0 {
        (-(un + form.shift_n) / c_n).max(-form.tension)
    } else {
        -form.tension
    };
    let bound = form.friction * (pressed + form.tension) + form.cohesion;
    let slide = ut + form.shift_t;
    let limited = if c_t > 0.0 {
        (slide * (-1.0 / c_t)).limited(bound)
    } else if slide.norm() > 0.0 {
        slide * (-bound / slide.norm())
    } else {
        S::Tangent::zero()
    };
    (pn - pressed).abs() + (pt - limited).norm()
}

fn every_method<S: Space>(answer: Answer, moves: Moves, central: bool, moment: bool) {
    for method in Method::ALL.iter().copied() {
        let name = method.name();
        // A problem that a method does not support is rejected before.
        let rotation_or_cohesion = moment || answer == Answer::Cohesion;
        if rotation_or_cohesion && matches!(name, "newton" | "interior") {
            continue;
        }
        // Gradient methods converge slowly if the directions of a block differ much.
        let gradient = matches!(name, "pg" | "cpg" | "pcpg" | "apgd");
        if gradient && moves != Moves::Not {
            continue;
        }
        let Posed {
            mut problem,
            forms,
            moments,
        } = posed::<S>(answer, moves, central, moment);
        let options = SolverOptions {
            tolerance: 1e-8,
            max_iterations: 20_000,
            method,
            ..SolverOptions::default()
        };
        let report = solve(
            &mut problem,
            &forms,
            &moments,
            &options,
            None,
            &mut AutoState::default(),
        );
        let case = format!("{answer:?} {moves:?} {central} {name}");
        assert!(report.error < 1e-7, "{case}: {:e}", report.error);
        for (k, form) in forms.iter().enumerate() {
            let off = off(&problem, form, k);
            assert!(off < 1e-5, "{case}: contact {k} is off by {off:e}");
        }
        for (form, found) in moments.iter().zip(problem.moments()) {
            let contact = &forms[form.contact as usize];
            let [i, j] = contact.bodies.map(|b| problem.velocity(b as usize).1);
            let (twist, bend) = S::split_spin(&contact.normal, &(i - j));
            let p = problem.solution(form.contact as usize).impulse;
            let pressed = contact.normal.dot(&p).max(0.0);
            let wanted = -(form.a
                + S::spin_about(&contact.normal, twist * form.b_twist)
                + bend * form.b_bend)
                - S::spin_about(
                    &contact.normal,
                    form.spinning * pressed * twist.signum() * f64::from(u8::from(twist != 0.0)),
                )
                - bend * (form.rolling * pressed / bend.norm());
            let off = (found.moment - wanted).norm();
            assert!(
                off < 1e-5,
                "{case}: moment {} is off by {off:e}",
                form.contact
            );
        }
    }
}

fn everything<S: Space>() {
    for answer in [Answer::Spring, Answer::Bond, Answer::Both, Answer::Cohesion] {
        for central in [true, false] {
            every_method::<S>(answer, Moves::Not, central, false);
        }
    }
    for central in [true, false] {
        every_method::<S>(Answer::Spring, Moves::Not, central, true);
    }
}

#[test]
fn springs_bonds_and_friction_between_held_bodies_in_the_plane() {
    everything::<Dim2>();
}

#[test]
fn springs_bonds_and_friction_between_held_bodies_in_space() {
    everything::<Dim3>();
}

/// Bodies can only rotate, or only move along an axis: the laws hold at the velocities that the
/// solver finds.
#[test]
fn contacts_of_bodies_that_are_held_in_part() {
    fn of<S: Space>() {
        every_method::<S>(Answer::Spring, Moves::Turns, true, false);
        every_method::<S>(Answer::Bond, Moves::Turns, true, false);
        every_method::<S>(Answer::Spring, Moves::Along, false, false);
    }
    of::<Dim2>();
    of::<Dim3>();
}
