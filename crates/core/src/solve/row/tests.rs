//! Processing several contacts at a time, with any vector instructions of this machine, gives the
//! same bits as one by one.

use super::visit::{Free, Load, MeasureErrors, Update, Visit, visit_one_by_one, visit_with};
use super::{Bonded, Full, Plain, RigidBodies, Row, RowKind, SolverBodies, SolverBody, Unbonded};
use crate::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use crate::lanes::InstructionSet;
use crate::solve::form::{ContactForm, Elastic, Mobility};

/// Returns a pseudo-random number between -1 and 1.
fn wave(k: usize, of: u32) -> f64 {
    (1.7 * k as f64 + 0.9 * f64::from(of * of % 101)).sin()
}

/// Bodies with velocities and masses of any order of magnitude; every fourteenth is fixed, some
/// pairs are fixed, and some bodies can only rotate.
fn solver_bodies<S: Space>(count: u32) -> Vec<SolverBody<S>> {
    let body = |at: u32| {
        let fixed = at % 14 == 1 || at / 2 % 23 == 5;
        let turns = at / 2 % 29 == 7;
        let heavy = if at % 31 == 4 { 1e-12 } else { 1.0 };
        let mut body = SolverBody::<S> {
            v: S::Vector::zero(),
            s: S::Spin::zero(),
            im: if fixed || turns {
                0.0
            } else {
                (1.0 + 0.3 * wave(9, at)) * heavy
            },
            is: if fixed {
                0.0
            } else {
                (2.0 + 0.5 * wave(10, at)) * heavy
            },
        };
        for k in 0..S::D {
            body.v[k] = wave(k, at);
        }
        for k in 0..S::Spin::N {
            body.s[k] = wave(k + 4, at);
        }
        body
    };
    (0..count).map(body).collect()
}

/// Contact without friction.
fn smooth<S: Space>(pair: u32) -> ContactForm<S> {
    ContactForm {
        friction: 0.0,
        ..contact(pair)
    }
}

/// A contact for every pair of bodies; some stick, some slip and some are open.
fn contact<S: Space>(pair: u32) -> ContactForm<S> {
    let mut normal = S::Vector::zero();
    for k in 0..S::D {
        normal[k] = wave(k + 20, pair);
    }
    let normal = normal * (1.0 / normal.norm());
    ContactForm {
        bodies: [2 * pair, 2 * pair + 1],
        normal,
        arms: [-normal, normal],
        shift_n: 0.1 * wave(30, pair),
        friction: 0.3 + 0.3 * wave(31, pair),
        impulse: normal * (1.0 + wave(32, pair)),
        ..ContactForm::default()
    }
}

/// Contacts with springs, bonds, some of them tension-only, cohesion, restitution, or none of
/// these.
fn bonded<S: Space>(pair: u32) -> ContactForm<S> {
    let mut tangent = S::Tangent::zero();
    for k in 0..S::Tangent::N {
        tangent[k] = 0.3 * wave(k + 40, pair);
    }
    let elastic = Elastic {
        a_n: 0.4 * wave(33, pair),
        a_t: tangent,
        b_n: 0.5 + 0.5 * wave(34, pair),
        b_t: 0.5 + 0.4 * wave(35, pair),
        tension_only: pair.is_multiple_of(2),
        damped: false,
        loss_n: 0.0,
        curved: false,
        loss_t: 0.0,
    };
    ContactForm {
        shift_t: tangent * f64::from(pair % 3),
        tension: 0.2 * f64::from(pair % 4),
        cohesion: 0.1 * f64::from(pair % 5),
        elastic: (!pair.is_multiple_of(7)).then_some(elastic),
        compliance: [0.3 * f64::from(pair % 2), 0.2 * f64::from(pair % 3)],
        ..contact(pair)
    }
}

/// Contacts with lever arms, some open with restitution.
fn aside<S: Space>(form: ContactForm<S>, pair: u32) -> ContactForm<S> {
    let arm = |of: S::Vector, by: f64| {
        let mut arm = of * by;
        for k in 0..S::D {
            arm[k] += 0.3 * wave(51 + k, pair);
        }
        arm
    };
    ContactForm {
        central: false,
        // With restitution an open contact is free.
        shift_n: if pair % 19 == 4 {
            f64::INFINITY
        } else {
            form.shift_n
        },
        // In space some contacts are solved part by part because of the cohesion.
        cohesion: if pair.is_multiple_of(3) {
            form.cohesion
        } else {
            0.0
        },
        friction: if pair % 11 == 5 { 0.0 } else { form.friction },
        arms: [
            arm(form.arms[0], 0.4),
            arm(form.arms[1], 0.3 + 0.2 * wave(50, pair)),
        ],
        ..form
    }
}

/// Mobilities of bodies; some move along one axis only, and some pairs do not move at all.
fn masses<S: Space>(bodies: &[SolverBody<S>]) -> Vec<Mobility<S>> {
    let of = |(b, body): (usize, &SolverBody<S>)| {
        let still = b / 2 % 17 == 3;
        let mut mass = S::Vector::zero();
        let mut inertia = S::Vector::zero();
        for k in 0..S::D {
            let moves = !still && (b % 5 != 0 || b % S::D == k);
            mass[k] = if moves { body.im } else { 0.0 };
            inertia[k] = 1.0 + 0.2 * wave(60 + k, b as u32);
        }
        let turns = if still { 0.0 } else { body.is / 0.49 };
        let turning = S::Tensor::from_entries(|i, j| {
            let cross = if i == j { 1.0 } else { 0.1 };
            turns * cross * inertia[i] * inertia[j]
        });
        Mobility {
            mass,
            inertia: turning,
        }
    };
    bodies.iter().enumerate().map(of).collect()
}

#[derive(Clone)]
struct Contacts<S: Space, K: RowKind<S>> {
    rows: Vec<Row<S, K>>,
    pairs: Vec<[u32; 2]>,
    solver_bodies: Vec<SolverBody<S>>,
}

impl<S: Space, K: RowKind<S>> Contacts<S, K> {
    fn bits(&self) -> Vec<u64> {
        let mut out = Vec::new();
        for row in &self.rows {
            super::store(row.local_impulse(), &mut out);
        }
        for body in &self.solver_bodies {
            out.extend(body.v.padded());
            out.extend(body.s.padded());
            out.extend([body.im, body.is]);
        }
        out.into_iter().map(f64::to_bits).collect()
    }

    /// Visits several contacts at a time, or one by one.
    fn visit<V: Visit>(&mut self, with: Option<InstructionSet>, groups: &[u32], what: &mut V) {
        let solver_bodies = SolverBodies::new(&mut self.solver_bodies);
        let rows = (&mut self.rows[..], &self.pairs[..]);
        match with {
            // SAFETY: the machine has the instructions.
            Some(with) => unsafe {
                visit_with(with, rows, groups, &solver_bodies, what);
            },
            None => visit_one_by_one(rows, &solver_bodies, what),
        }
    }
}

/// All ways to process the contacts of this kind that `form` gives have the same result.
fn same<S: Space, K: RowKind<S>>(form: impl Fn(u32) -> ContactForm<S>) {
    let solver_bodies = solver_bodies::<S>(290);
    let bodies = RigidBodies {
        masses: &masses(&solver_bodies),
        lengths: &vec![0.7; 290],
        solver_bodies: &solver_bodies,
    };
    let rows = (0..145).map(|pair| Row::<S, K>::new(&form(pair), &bodies));
    let start = Contacts {
        rows: rows.collect(),
        pairs: (0..145).map(|pair| form(pair).bodies).collect(),
        solver_bodies: solver_bodies.clone(),
    };
    // Groups of all remainders, up to the end of the prefetch distance.
    let groups = [0, 1, 3, 6, 10, 15, 21, 28, 36, 45, 145];
    let all = [0, 145];
    for with in InstructionSet::of_this_machine() {
        let (mut one, mut several) = (start.clone(), start.clone());
        for relaxation in [1.0, 1.45, 1.0] {
            one.visit(None, &groups, &mut Update(relaxation));
            several.visit(Some(with), &groups, &mut Update(relaxation));
            assert!(one.bits() == several.bits(), "{with:?}");
            let mut sums = [MeasureErrors::default(), MeasureErrors::default()];
            one.visit(None, &all, &mut sums[0]);
            several.visit(Some(with), &all, &mut sums[1]);
            let [a, b] = sums.map(|s| s.sums(3));
            assert!(a.residual > 0.0 && a == b, "{with:?} {a:?} {b:?}");
            let mut free = [Free::default(), Free::default()];
            one.visit(None, &all, &mut free[0]);
            several.visit(Some(with), &all, &mut free[1]);
            let [a, b] = free.map(|f| f.scale());
            assert!(a.free > 0.0 && a == b, "{with:?} {a:?} {b:?}");
        }
        one.visit(None, &groups, &mut Load);
        several.visit(Some(with), &groups, &mut Load);
        assert!(one.bits() == several.bits(), "{with:?}");
        let normal = |row: &Row<S, K>| row.local_impulse().n;
        let open = one.rows.iter().filter(|row| normal(row) == 0.0).count();
        assert!(open < one.rows.len());
        let finite = |row: &Row<S, K>| normal(row).is_finite();
        assert!(one.rows.iter().all(finite));
    }
}

fn of_dimension<S: Space>() {
    same::<S, Plain>(contact);
    same::<S, Plain>(smooth);
    same::<S, Full<S>>(bonded);
    same::<S, Full<S>>(|pair| ContactForm {
        apart: true,
        ..bonded(pair)
    });
    same::<S, Unbonded<S>>(|pair| ContactForm {
        elastic: None,
        ..aside(bonded(pair), pair)
    });
    // Contacts without strength, compliance and tangential restitution.
    same::<S, Unbonded<S>>(|pair| aside(contact(pair), pair));
    same::<S, Bonded<S>>(|pair| aside(bonded(pair), pair));
}

#[test]
fn all_widths_give_the_bits_of_single_contacts() {
    of_dimension::<Dim2>();
    of_dimension::<Dim3>();
}
