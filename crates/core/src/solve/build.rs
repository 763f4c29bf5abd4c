//! Building a contact problem: bodies first, then contacts, each in a row of the kind that it
//! needs.

use super::form::{ContactForm, Mobility, RowPlace};

use super::kinds::{KINDS, RowsOfKind, of_kind};
use super::problem::Problem;
use super::row::{RigidBodies, SolverBody};
use crate::geometry::space::Space;
use crate::threads::{fill, for_chunks, map_chunks, worth_dividing};

/// Approximate time to add a body (ns).
const BODY: f64 = 15.0;
/// Approximate time to look up the place of a contact or a body (ns).
const SORT: f64 = 3.0;
/// Number of contacts of a task.
const CHUNK: usize = 4096;

/// Returns the record of a body at its free velocity.
fn record<S: Space>(
    free: &(S::Vector, S::Spin),
    mobility: &Mobility<S>,
    length: f64,
) -> SolverBody<S> {
    SolverBody {
        v: free.0,
        s: free.1 * length,
        im: (1..S::D).fold(mobility.mass[0], |most, k| most.max(mobility.mass[k])),
        is: mobility.largest_inverse_inertia() * length * length,
    }
}

impl<S: Space> Problem<S> {
    /// Adds a body with its free velocity, inverse masses, inverse inertia tensor, and the length
    /// that scales its spin.
    pub fn push_body(
        &mut self,
        v: S::Vector,
        w: S::Spin,
        inverse_mass: S::Vector,
        inverse_inertia: S::Tensor,
        length: f64,
    ) {
        let mobility = Mobility::<S> {
            mass: inverse_mass,
            inertia: inverse_inertia,
        };
        self.solver_bodies.push(record(&(v, w), &mobility, length));
        self.free.push((v, w));
        self.lengths.push(length);
        self.masses.push(mobility);
    }

    /// Adds all bodies to a problem without bodies, with their free velocities, mobilities and
    /// lengths.
    pub fn push_bodies(
        &mut self,
        free: &[(S::Vector, S::Spin)],
        parallel: bool,
        body: impl Fn(usize) -> (Mobility<S>, f64) + Sync + Send,
    ) {
        debug_assert!(self.solver_bodies.is_empty());
        let (divide, count) = (worth_dividing(parallel, free.len(), BODY), free.len());
        self.free.extend_from_slice(free);
        fill(divide, &mut self.lengths, count, |b| body(b).1);
        fill(divide, &mut self.masses, count, |b| body(b).0);
        let (masses, lengths) = (&self.masses, &self.lengths);
        fill(divide, &mut self.solver_bodies, count, |b| {
            record(&free[b], &masses[b], lengths[b])
        });
    }

    /// Adds a contact.
    pub fn push(&mut self, contact: &ContactForm<S>) {
        let kind = RowsOfKind::kind(contact);
        let bodies = RigidBodies {
            solver_bodies: &self.solver_bodies,
            masses: &self.masses,
            lengths: &self.lengths,
        };
        let row = of_kind!(&mut self.rows[kind], rows => rows.push(contact, &bodies));
        let kind = kind as u8;
        self.places.push(RowPlace::Row { kind, row });
        self.compliant |= contact.compliance != [0.0; 2];
    }

    /// Adds all contacts to a problem without contacts, in the order of the iteration.
    pub fn push_all(&mut self, contacts: &[ContactForm<S>], parallel: bool) {
        debug_assert!(self.places.is_empty());
        self.of_kind.iter_mut().for_each(Vec::clear);
        let divide = worth_dividing(parallel, contacts.len(), SORT);
        let parts = map_chunks(divide, contacts, CHUNK, |first, contacts| {
            let mut of_kind: [Vec<u32>; KINDS] = Default::default();
            let mut places = Vec::with_capacity(contacts.len());
            let mut compliant = false;
            for (contact, k) in contacts.iter().zip(first..) {
                compliant |= contact.compliance != [0.0; 2];
                let kind = RowsOfKind::kind(contact);
                let list = &mut of_kind[kind];
                places.push((kind, list.len() as u32));
                list.push(k as u32);
            }
            (of_kind, places, compliant)
        });
        self.places.reserve_exact(contacts.len());
        for (lists, places, compliant) in parts {
            self.compliant |= compliant;
            let before = self.of_kind.each_ref().map(|list| list.len() as u32);
            self.places
                .extend(places.iter().map(|(kind, k)| RowPlace::Row {
                    kind: *kind as u8,
                    row: before[*kind] + k,
                }));
            for (all, some) in self.of_kind.iter_mut().zip(lists) {
                all.extend(some);
            }
        }
        let movable = self.movable(parallel);
        let bodies = RigidBodies {
            solver_bodies: &self.solver_bodies,
            masses: &self.masses,
            lengths: &self.lengths,
        };
        for (rows, of) in self.rows.iter_mut().zip(&self.of_kind) {
            of_kind!(rows, rows => rows.set(of, contacts, &movable, &bodies, parallel));
        }
        self.place_in_order(parallel);
    }

    /// Returns for each body whether it moves.
    pub(super) fn movable(&self, parallel: bool) -> Vec<bool> {
        let (mut movable, count) = (Vec::new(), self.solver_bodies.len());
        fill(
            worth_dividing(parallel, count, SORT),
            &mut movable,
            count,
            |b| {
                let body = &self.solver_bodies[b];
                body.im > 0.0 || body.is > 0.0
            },
        );
        movable
    }

    /// Converts the places of contacts from the order as pushed to the order of the iteration.
    pub(super) fn place_in_order(&mut self, parallel: bool) {
        let in_order = self.rows.each_ref();
        let in_order = in_order.map(|rows| of_kind!(rows, rows => rows.places()));
        let divide = worth_dividing(parallel, self.places.len(), SORT);
        for_chunks(divide, &mut self.places, CHUNK, |_, places| {
            for place in places {
                if let RowPlace::Row { kind, row } = place {
                    *row = in_order[*kind as usize][*row as usize];
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use crate::solve::form::Elastic;
    use crate::solve::measure;
    use nalgebra::{Matrix1, Vector1, Vector2};

    fn contact(compliance: [f64; 2]) -> ContactForm<Dim2> {
        ContactForm {
            normal: Vector2::new(0.0, 1.0),
            arms: [Vector2::new(0.0, -0.01), Vector2::new(0.0, 0.01)],
            friction: 0.5,
            compliance,
            impulse: Vector2::new(0.1, 0.2),
            ..ContactForm::default()
        }
    }

    /// The work of a step includes c |p|^2 of compliant contacts, whatever the order in which they
    /// are added, and is not computed where no contact is compliant.
    #[test]
    fn contacts_that_yield_are_known() {
        for compliance in [[0.0; 2], [3.0, 0.0], [0.0, 5.0]] {
            for at_once in [false, true] {
                let mut problem = Problem::<Dim2>::default();
                for inverse_mass in [2.0, 0.0] {
                    let (v, w) = (Vector2::new(0.0, -1.0), Vector1::new(0.0));
                    let mobility = (Vector2::repeat(inverse_mass), Matrix1::new(0.0));
                    problem.push_body(v, w, mobility.0, mobility.1, 0.01);
                }
                let form = contact(compliance);
                if at_once {
                    problem.push_all(std::slice::from_ref(&form), false);
                } else {
                    problem.push(&form);
                    crate::solve::nlgs::prepare(&mut problem);
                }
                let yields = compliance != [0.0; 2];
                assert_eq!(problem.compliant, yields);
                let free = measure::free_velocity(&mut problem, false);
                problem.reload(false);
                let sums = measure::measure(&mut problem, false);
                let work = measure::scale(&mut problem, free, &sums, false).work;
                let [n, t] = compliance;
                let wanted = 2.0 * (0.1 * 0.1 + 0.2 * 0.2) + n * 0.2 * 0.2 + t * 0.1 * 0.1;
                assert!((work - wanted).abs() < 1e-12, "{work} J, not {wanted}");
                problem.clear();
                assert!(!problem.compliant);
            }
        }
    }

    /// A bond whose impulse is given has its part of the impulse; the rest acts on the compliance.
    #[test]
    fn a_bond_beside_a_compliance_takes_its_part() {
        let mut problem = Problem::<Dim2>::default();
        for inverse_mass in [2.0, 0.0] {
            let (v, w) = (Vector2::new(0.0, -1.0), Vector1::new(0.0));
            problem.push_body(v, w, Vector2::repeat(inverse_mass), Matrix1::new(0.0), 0.01);
        }
        let (normal, impulse) = (contact([0.0; 2]).normal, contact([0.0; 2]).impulse);
        let tangential = Dim2::tangential(&normal, &impulse);
        let bond = Elastic {
            a_n: 0.25,
            a_t: Vector1::new(0.5),
            ..Elastic::none()
        };
        problem.push(&ContactForm {
            elastic: Some(bond),
            ..contact([3.0, 5.0])
        });
        crate::solve::nlgs::prepare(&mut problem);
        let free = measure::free_velocity(&mut problem, false);
        problem.reload(false);
        let sums = measure::measure(&mut problem, false);
        let work = measure::scale(&mut problem, free, &sums, false).work;
        let [n, t] = [normal.dot(&impulse) + 0.25, tangential.x + 0.5];
        let wanted = 2.0 * impulse.norm_squared() + 3.0 * n * n + 5.0 * t * t;
        assert!((work - wanted).abs() < 1e-12, "{work} J, not {wanted}");
    }
}
