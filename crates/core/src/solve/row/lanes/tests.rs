use super::{Instructions, visit_with};
use crate::geometry::space::{Dim2, Dim3, MatrixLike, Space, VectorLike};
use crate::solve::form::Mobility;
use crate::solve::form::{ContactForm, Elastic};
use crate::solve::row::visit::{Free, Load, Measure, Update, Visit};
use crate::solve::row::{
    Bonded, FullRow, LeverRow, Loose, PlainRow, Row, SolverBodies, SolverBody,
};

/// Returns a pseudo-random number between -1 and 1.
fn wave(k: usize, of: u32) -> f64 {
    (1.7 * k as f64 + 0.9 * f64::from(of * of % 101)).sin()
}

/// Bodies with velocities and masses; every fourteenth is fixed, some pairs are, and some can only turn.
fn solver_bodies<S: Space>(count: u32) -> Vec<SolverBody<S>> {
    let body = |at: u32| {
        let fixed = at % 14 == 1 || at / 2 % 23 == 5;
        let turns = at / 2 % 29 == 7;
        let mut body = SolverBody::<S> {
            v: S::Vector::zero(),
            s: S::Spin::zero(),
            im: if fixed || turns {
                0.0
            } else {
                1.0 + 0.3 * wave(9, at)
            },
            is: if fixed { 0.0 } else { 2.0 + 0.5 * wave(10, at) },
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

/// A contact of every pair of bodies, some of which stick, some slip and some open.
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
        central: true,
        apart: false,
        shift_n: 0.1 * wave(30, pair),
        shift_t: S::Tangent::zero(),
        friction: 0.3 + 0.3 * wave(31, pair),
        tension: 0.0,
        cohesion: 0.0,
        elastic: None,
        compliance: [0.0; 2],
        impulse: normal * (1.0 + wave(32, pair)),
    }
}

/// Contacts with springs, bonds, some of them tension-only, cohesion, restitution, or none of these.
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

struct State<R, S: Space> {
    rows: Vec<R>,
    solver_bodies: Vec<SolverBody<S>>,
}

impl<S: Space, R: Row<S>> State<R, S> {
    fn bits(&self) -> Vec<u64> {
        let mut out = Vec::new();
        self.rows
            .iter()
            .for_each(|row| crate::solve::row::store::<S>(row.local_impulse(), &mut out));
        for body in &self.solver_bodies {
            out.extend(body.v.padded());
            out.extend(body.s.padded());
            out.extend([body.im, body.is]);
        }
        // Both zeros compare equal.
        out.into_iter().map(|x| (x + 0.0).to_bits()).collect()
    }

    /// Visits several contacts at a time where the machine can, and one by one.
    fn visit<V: Visit>(&mut self, groups: Option<(&[u32], Instructions)>, what: &mut V) {
        let solver_bodies = SolverBodies::new(&mut self.solver_bodies);
        match groups {
            Some((groups, with)) => {
                // SAFETY: the machine has the instructions, and groups and bodies are as they should be.
                let can = unsafe { visit_with(with, &mut self.rows, groups, &solver_bodies, what) };
                assert!(can);
            }
            None => {
                let rows = self.rows.iter_mut().enumerate();
                rows.for_each(|(at, row)| what.visit_row(row, &solver_bodies, at));
            }
        }
    }
}

fn same<S: Space, R: Row<S>>(
    form: impl Fn(u32) -> ContactForm<S>,
    row: impl Fn(&ContactForm<S>, f64, f64) -> R,
) {
    same_rows(|pair, solver_bodies| {
        let [a, b] = [2 * pair, 2 * pair + 1].map(|k| &solver_bodies[k as usize]);
        let w_n = a.im + b.im;
        row(&form(pair), w_n, w_n + a.is + b.is)
    });
}

fn same_rows<S: Space, R: Row<S>>(row: impl Fn(u32, &[SolverBody<S>]) -> R) {
    match Instructions::of_this_machine() {
        None => {}
        Some(Instructions::Avx2) => same_with(Instructions::Avx2, &row),
        Some(Instructions::Avx512) => {
            same_with(Instructions::Avx2, &row);
            same_with(Instructions::Avx512, &row);
        }
    }
}

fn same_with<S: Space, R: Row<S>>(with: Instructions, row: impl Fn(u32, &[SolverBody<S>]) -> R) {
    // Groups of all remainders, up to the end of the prefetch distance.
    let groups: Vec<u32> = vec![0, 1, 3, 6, 10, 15, 21, 28, 36, 45, 145];
    let solver_bodies = solver_bodies::<S>(290);
    let rows: Vec<R> = (0..145).map(|pair| row(pair, &solver_bodies)).collect();
    let mut one = State {
        rows: rows.clone(),
        solver_bodies: solver_bodies.clone(),
    };
    let mut four = State {
        rows,
        solver_bodies,
    };
    for relaxation in [1.0, 1.45, 1.0] {
        one.visit(None, &mut Update(relaxation));
        four.visit(Some((&groups, with)), &mut Update(relaxation));
        assert!(one.bits() == four.bits());
        let mut sums = [Measure::default(), Measure::default()];
        one.visit(None, &mut sums[0]);
        four.visit(Some((&[0, 145], with)), &mut sums[1]);
        let [a, b] = sums.map(|s| s.sums(3));
        assert!(a.residual > 0.0 && a == b, "{a:?} {b:?}");
        let mut free = [Free::default(), Free::default()];
        one.visit(None, &mut free[0]);
        four.visit(Some((&[0, 145], with)), &mut free[1]);
        let [a, b] = free.map(|f| f.scale());
        assert!(a.free > 0.0 && a == b, "{a:?} {b:?}");
    }
    one.visit(None, &mut Load);
    four.visit(Some((&groups, with)), &mut Load);
    assert!(one.bits() == four.bits());
    let open = one
        .rows
        .iter()
        .filter(|r| r.local_impulse().0 == 0.0)
        .count();
    assert!(open < one.rows.len());
}

#[test]
fn lanes_give_the_bits_of_single_contacts() {
    same(contact::<Dim2>, PlainRow::new);
    same(contact::<Dim3>, PlainRow::new);
    same(smooth::<Dim2>, PlainRow::new);
    same(smooth::<Dim3>, PlainRow::new);
    same(bonded::<Dim2>, |form, n, t| {
        FullRow::new(form, n, t, [1.0; 2])
    });
    same(bonded::<Dim3>, |form, n, t| {
        FullRow::new(form, n, t, [1.07, 0.95])
    });
    // Contacts with levers, of bodies of which some move along one axis alone.
    let inertia = |solver_bodies: &[SolverBody<Dim2>], b: usize| {
        let body = &solver_bodies[b];
        let mut mass = [body.im; 2];
        if b.is_multiple_of(5) {
            mass[b % 2] = 0.0;
        }
        // Some pairs do not move at all.
        let turns = if b / 2 % 17 == 3 {
            mass = [0.0; 2];
            0.0
        } else {
            body.is
        };
        let mobility = Mobility {
            mass: VectorLike::from_slice(&mass),
            inertia: MatrixLike::uniform(turns / 0.49),
        };
        (mobility, 0.7)
    };
    let aside = |form: ContactForm<Dim2>, pair: u32| ContactForm {
        central: false,
        apart: false,
        // With restitution an open contact is free.
        shift_n: if pair % 19 == 4 {
            f64::INFINITY
        } else {
            form.shift_n
        },
        arms: [
            form.arms[0] * 0.4,
            form.arms[1] * (0.3 + 0.2 * wave(50, pair)),
        ]
        .map(|mut arm| {
            arm[0] += 0.3 * wave(51, pair);
            arm
        }),
        ..form
    };
    same_rows(|pair, all| {
        let form = ContactForm {
            elastic: None,
            ..aside(bonded(pair), pair)
        };
        LeverRow::<Dim2, Loose<Dim2>>::new(&form, |b| inertia(all, b))
    });
    same_rows(|pair, all| {
        LeverRow::<Dim2, Bonded<Dim2>>::new(&aside(bonded(pair), pair), |b| inertia(all, b))
    });
}
