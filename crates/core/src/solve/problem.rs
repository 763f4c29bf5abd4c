//! The contact problem of a step: bodies as velocity records, contacts as rows.

use super::connected::ConnectedSets;
use super::form::{ContactForm, ContactSolution, Mobility, RowPlace};
use super::kinds::{KINDS, RowsOfKind, of_kind};
use super::loaded::LoadedPoints;
use super::nodal::NodalSystem;
use super::row::{MomentForm, MomentRow, MomentSolution, Parts, SolverBody, SystemRow};
use super::traction::Tractions;
use super::velocities;
use crate::geometry::space::Space;

/// The contact problem of one step. Push the bodies, then the contacts.
///
/// # Examples
/// A disk of 2 kg rests on an immovable plane. In a step of 1 ms gravity would accelerate it by
/// 0.01 m/s downwards and 0.001 m/s sideways, which Coulomb friction with mu = 0.5 can hold.
/// ```
/// use fretwork_core::geometry::space::{Dim2, VectorLike};
/// use fretwork_core::solve::{ContactForm, Problem, SolverOptions, nlgs};
/// use nalgebra::{Matrix1, Vector1, Vector2};
///
/// let mut problem = Problem::<Dim2>::default();
/// let (spin, turned) = (Vector1::new(0.0), Matrix1::new(0.0));
/// let free = Vector2::new(1e-3, -1e-2);
/// problem.push_body(free, spin, Vector2::new(0.5, 0.5), turned, 0.01);
/// problem.push_body(Vector2::zero(), spin, Vector2::zero(), turned, 0.01);
/// problem.push(&ContactForm {
///     normal: Vector2::new(0.0, 1.0),
///     arms: [Vector2::new(0.0, -0.01), Vector2::zero()],
///     friction: 0.5,
///     ..ContactForm::default()
/// });
/// let options = SolverOptions { tolerance: 1e-10, ..SolverOptions::default() };
/// let report = nlgs::solve(&mut problem, &options);
/// assert!(report.converged);
/// // The impulse that stops it: its mass times the change of velocity (N s).
/// let impulse = problem.solution(0).impulse;
/// assert!((impulse - Vector2::new(-2e-3, 2e-2)).norm() < 1e-9, "{impulse}");
/// assert!(problem.velocity(0).0.norm() < 1e-9);
/// ```
#[derive(Debug)]
pub struct Problem<S: Space> {
    /// Velocities, updated in place, one record per body.
    pub solver_bodies: Vec<SolverBody<S>>,
    /// Free velocities of the bodies.
    pub free: Vec<(S::Vector, S::Spin)>,
    pub(super) lengths: Vec<f64>,
    pub(super) masses: Vec<Mobility<S>>,
    /// Contacts between rigid bodies, by kind.
    pub(super) rows: [RowsOfKind<S>; KINDS],
    /// Contacts with dynamical systems; the iteration visits them after the rows above, in order.
    pub(super) of_systems: Vec<SystemRow<S>>,
    pub(super) tractions: Tractions,
    /// The nodes of the dynamical systems on which contacts act.
    pub(super) systems: Vec<NodalSystem<S>>,
    /// Memory of large systems of earlier problems.
    pub(super) loaded: Vec<LoadedPoints<S>>,
    /// Moments of contacts that resist rotation; the iteration visits them last, in order.
    pub(super) moments: Vec<MomentRow<S>>,
    pub(super) places: Vec<RowPlace>,
    /// Connected sets of the contacts, as last computed.
    pub(super) connected: ConnectedSets,
    /// Pattern of the matrix over the motions of bodies, of the last solve in velocities.
    pub(super) velocity_pattern: velocities::Pattern,
    /// Whether a contact has a compliance.
    pub(super) compliant: bool,
    /// Contacts of each kind between rigid bodies, as they are added.
    pub(super) of_kind: [Vec<u32>; KINDS],
    /// Bodies whose motion is imposed or controlled, in order.
    pub(super) controlled: Vec<u32>,
}

impl<S: Space> Default for Problem<S> {
    fn default() -> Self {
        Self {
            solver_bodies: Vec::new(),
            free: Vec::new(),
            lengths: Vec::new(),
            masses: Vec::new(),
            rows: RowsOfKind::none(),
            of_systems: Vec::new(),
            tractions: Tractions::default(),
            systems: Vec::new(),
            loaded: Vec::new(),
            moments: Vec::new(),
            places: Vec::new(),
            connected: ConnectedSets::default(),
            velocity_pattern: velocities::Pattern::default(),
            compliant: false,
            of_kind: Default::default(),
            controlled: Vec::new(),
        }
    }
}

impl<S: Space> Problem<S> {
    /// Bytes per body: its record, free velocity, length and inverse masses.
    pub const BYTES_A_BODY: usize = size_of::<SolverBody<S>>()
        + size_of::<(S::Vector, S::Spin)>()
        + size_of::<f64>()
        + size_of::<Mobility<S>>();

    /// Bytes per row of a contact: of two balls, of two balls with a bond, with lever arms, with
    /// lever arms and a bond.
    pub const BYTES_A_CONTACT: [usize; KINDS] = RowsOfKind::<S>::BYTES;

    /// Bytes per contact for the order of the iteration: its index as pushed, bodies, sequence and
    /// places.
    pub const BYTES_TO_SORT: usize =
        size_of::<RowPlace>() + size_of::<[u32; 2]>() + 3 * size_of::<u32>();

    /// Clears the problem, keeping its buffers.
    pub fn clear(&mut self) {
        self.solver_bodies.clear();
        self.free.clear();
        self.lengths.clear();
        self.masses.clear();
        for rows in &mut self.rows {
            of_kind!(rows, rows => rows.clear());
        }
        self.of_systems.clear();
        self.tractions.clear();
        self.clear_systems();
        self.moments.clear();
        self.places.clear();
        self.compliant = false;
    }

    /// Adds the moments of a contact that was already pushed, given with its bodies and normal.
    pub fn push_moment(&mut self, form: &MomentForm<S>, contact: &ContactForm<S>) {
        let row = self.moment_row(form, contact);
        self.moments.push(row);
    }

    /// The row of the moments of a contact between rigid bodies.
    pub(super) fn moment_row(
        &self,
        form: &MomentForm<S>,
        contact: &ContactForm<S>,
    ) -> MomentRow<S> {
        let [i, j] = contact.bodies.map(|b| b as usize);
        MomentRow::new(
            form,
            self.places[form.contact as usize],
            contact.bodies,
            contact.normal,
            [&self.masses[i], &self.masses[j]],
            [self.lengths[i], self.lengths[j]],
        )
    }

    /// Iterates over the moments, in the order pushed.
    pub fn moments(&self) -> impl Iterator<Item = MomentSolution<S>> {
        self.moments.iter().map(|row| {
            let [i, j] = row.bodies.map(|b| &self.solver_bodies[b as usize]);
            row.solution(i, j, &self.systems)
        })
    }

    /// Returns the normal impulse of a contact (N s).
    pub(super) fn normal(&self, place: RowPlace) -> f64 {
        self.local_impulse(place).n
    }

    /// Returns the normal and the tangential impulse of a contact (N s).
    pub(super) fn local_impulse(&self, place: RowPlace) -> Parts<S> {
        match place {
            RowPlace::Row { kind, row } => {
                of_kind!(&self.rows[kind as usize], rows => rows.row(row).local_impulse())
            }
            RowPlace::System(r) => self.of_systems[r as usize].impulse(),
        }
    }

    /// Returns the number of contacts.
    pub fn contacts(&self) -> usize {
        self.places.len()
    }

    /// Returns the solution of the `k`-th contact pushed.
    pub fn solution(&self, k: usize) -> ContactSolution<S> {
        let bodies = &self.solver_bodies;
        match self.places[k] {
            RowPlace::Row { kind, row } => {
                of_kind!(&self.rows[kind as usize], rows => rows.solution(row, bodies))
            }
            RowPlace::System(r) => self.of_systems[r as usize].solution(bodies, &self.systems),
        }
    }

    /// Returns velocity and angular velocity of a body after the solve.
    pub fn velocity(&self, body: usize) -> (S::Vector, S::Spin) {
        let record = &self.solver_bodies[body];
        (record.v, record.s * (1.0 / self.lengths[body]))
    }

    /// Finds the connected sets, unless the stored sets belong to the same contacts: packings at
    /// rest keep them from step to step. The sets are moved out of the problem, and must be
    /// returned to it.
    pub(super) fn take_connected(&mut self) -> ConnectedSets {
        let of = self.contacts_of_rows();
        let known = std::mem::take(&mut self.connected);
        if of.is_some() && known.of == of && known.controlled == self.controlled {
            return known;
        }
        let movable = self.movable(false);
        let mut sets = ConnectedSets::new(&movable, |found| {
            for rows in &self.rows {
                of_kind!(rows, rows => rows.pairs().iter().for_each(|pair| found(*pair)));
            }
        });
        for (body, _) in self.of_systems.iter().flat_map(SystemRow::rigid_masses) {
            sets.touches_system(body);
        }
        sets.of = of;
        sets.controlled.clone_from(&self.controlled);
        sets.of_several_controlled = self.of_several_controlled();
        sets
    }

    /// Returns numbers that identify the contacts of rigid bodies of this step; `None` where they
    /// are not sorted, or systems act.
    fn contacts_of_rows(&self) -> Option<[u64; KINDS]> {
        let sorted = |rows: &RowsOfKind<S>| of_kind!(rows, rows => rows.sorted());
        let known = self.rows.iter().all(sorted) && self.systems.is_empty();
        let rows = known.then(|| self.rows.each_ref())?;
        Some(rows.map(|rows| of_kind!(rows, rows => rows.changes())))
    }

    /// Returns the number of degrees of freedom of the bodies of each connected set.
    pub(super) fn freedoms(&self, sets: &ConnectedSets) -> Vec<usize> {
        let mut freedoms = vec![0; sets.len()];
        for (body, mobility) in (0..).zip(&self.masses) {
            if let Some(set) = sets.of_body(body) {
                freedoms[set] += mobility.freedoms(true);
            }
        }
        freedoms
    }
}

#[cfg(test)]
impl Problem<crate::geometry::space::Dim2> {
    /// Creates a problem of bodies at rest of unit mass, inertia and length.
    pub(super) fn of_unit_bodies(count: usize) -> Self {
        use nalgebra::{Matrix1, Vector1, Vector2};
        let mut problem = Self::default();
        for _ in 0..count {
            let (mass, inertia) = (Vector2::repeat(1.0), Matrix1::new(1.0));
            problem.push_body(Vector2::zeros(), Vector1::zeros(), mass, inertia, 1.0);
        }
        problem
    }
}
