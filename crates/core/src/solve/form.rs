//! The input of a solver: bodies as velocity records, contacts in the standard form.

use super::connected::Connected;
use super::kinds::{KINDS, RowsOfKind, of_kind};
use super::loaded::Loaded;
use super::nodal::NodalSystem;
use super::row::{MomentForm, MomentRow, MomentSolution, Parts, SolverBody, SystemRow};
use super::traction::Tractions;
use crate::geometry::space::{MatrixLike, Space, VectorLike};

/// One contact in the standard local form. Impulses are in N s, velocities in m/s.
#[derive(Clone, Debug)]
pub struct ContactForm<S: Space> {
    /// The candidate and the antagonist (indices of bodies).
    pub bodies: [u32; 2],
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// From each body's centre to the contact point (m).
    pub arms: [S::Vector; 2],
    /// Both arms lie along the normal and both inverse masses are isotropic.
    pub central: bool,
    /// Of a central contact, whether its arms are not the lengths of its bodies: it acts in the gap
    /// between two balls, or in their overlap.
    pub apart: bool,
    /// s_n: max(g, 0)/h or e_n u_n^- (m/s).
    pub shift_n: f64,
    /// s_t: e_t u_t^- (m/s).
    pub shift_t: S::Tangent,
    /// Friction coefficient mu.
    pub friction: f64,
    /// Tensile strength impulse h c_n (N s).
    pub tension: f64,
    /// Shear cohesion impulse h c_t (N s).
    pub cohesion: f64,
    /// The single-valued (bond) part, if any.
    pub elastic: Option<Elastic<S>>,
    /// Compliance c of the unilateral part over the step, normal and tangential (1/kg): its law is
    /// in u + s + c p; zero for a rigid contact.
    pub compliance: [f64; 2],
    /// Initial impulse, in world axes (N s).
    pub impulse: S::Vector,
}

impl<S: Space> ContactForm<S> {
    /// Returns a contact on which nothing acts.
    pub(super) fn idle() -> Self {
        Self {
            bodies: [0, 1],
            normal: S::Vector::zero(),
            arms: [S::Vector::zero(); 2],
            central: true,
            apart: false,
            shift_n: 0.0,
            shift_t: S::Tangent::zero(),
            friction: 0.0,
            tension: 0.0,
            cohesion: 0.0,
            elastic: None,
            compliance: [0.0; 2],
            impulse: S::Vector::zero(),
        }
    }
}

/// Bond impulse p_el = -(a + B u); with `tension_only` the normal part vanishes where it would
/// push.
#[derive(Clone, Copy, Debug)]
pub struct Elastic<S: Space> {
    /// Normal impulse of the bond at u = 0, positive in tension (N s).
    pub a_n: f64,
    /// Tangential impulse of the bond at u = 0 (N s).
    pub a_t: S::Tangent,
    /// Normal stiffness and damping over the step (kg).
    pub b_n: f64,
    /// Tangential stiffness and damping over the step (kg).
    pub b_t: f64,
    /// Whether the normal part acts in tension only.
    pub tension_only: bool,
    /// Whether the normal part has damping.
    pub damped: bool,
    /// Whether the law's traction is not linear in the opening, so that this is a tangent of it.
    pub curved: bool,
    /// Normal dissipation of damping and time scheme over the step: loss_n u_n,th^2 + loss_t
    /// |u_t,th|^2 (kg).
    pub loss_n: f64,
    /// Tangential dissipation; see `loss_n` (kg).
    pub loss_t: f64,
}

impl<S: Space> Elastic<S> {
    /// Returns a bond without effect.
    pub fn none() -> Self {
        Self {
            a_n: 0.0,
            a_t: S::Tangent::zero(),
            b_n: 0.0,
            b_t: 0.0,
            tension_only: false,
            damped: false,
            curved: false,
            loss_n: 0.0,
            loss_t: 0.0,
        }
    }

    /// Energy that damping and the time scheme take in a step (J), given the opening at its start
    /// (m) and the relative velocity, its average over the step and at its end (m/s). `None` for a
    /// bond whose force is not linear over the step: its law is not, or it acts in tension only and
    /// opens, closes, or would push by its damping. What is lost then follows from its stored
    /// energy.
    pub fn lost(
        &self,
        solution: &ContactSolution<S>,
        normal: &S::Vector,
        opening: f64,
        [average, after]: [&S::Vector; 2],
        h: f64,
    ) -> Option<f64> {
        let (un, ut) = (normal.dot(average), S::tangential(normal, average));
        let pulls = !self.tension_only || self.a_n + self.b_n * normal.dot(after) > 0.0;
        let opens = [opening > 0.0, opening + h * un > 0.0];
        let normal_part = if self.curved || self.tension_only && opens[0] != opens[1] {
            return None;
        } else if self.tension_only && self.damped && !opens[0] {
            // It stores nothing in compression, so that all the work of its damping is lost.
            (solution.unilateral_n - normal.dot(&solution.impulse)) * un
        } else if pulls {
            self.loss_n * un * un
        } else if self.damped {
            return None;
        } else {
            0.0
        };
        Some(normal_part + self.loss_t * ut.dot(&ut))
    }
}

/// Solution of one contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactSolution<S: Space> {
    /// Total impulse p in world axes (N s).
    pub impulse: S::Vector,
    /// Normal part of p_sc (N s).
    pub unilateral_n: f64,
    /// Tangential part of p_sc (N s).
    pub unilateral_t: S::Tangent,
}

/// Response of a body to impulses.
#[derive(Clone, Copy, Debug)]
pub struct Mobility<S: Space> {
    /// Inverse mass along each axis (1/kg).
    pub mass: S::Vector,
    /// Inverse inertia tensor (1/(kg m^2)).
    pub inertia: S::Tensor,
}

impl<S: Space> Mobility<S> {
    /// Returns the velocity and angular velocity caused by an impulse and a moment.
    #[inline]
    pub fn apply(&self, p: &S::Vector, moment: &S::Spin) -> (S::Vector, S::Spin) {
        (p.scaled_by(&self.mass), self.inertia.apply(moment))
    }

    /// Returns the inverse mass or inertia of a degree of freedom, zero where it is imposed.
    pub fn along(&self, k: usize) -> f64 {
        if k < S::D {
            self.mass[k]
        } else {
            self.inertia.entry(k - S::D, k - S::D)
        }
    }

    /// Returns whether moments can rotate the body.
    pub fn turns(&self) -> bool {
        self.inertia.entry(0, 0) > 0.0
    }

    /// Returns whether the body can move.
    pub fn moves(&self) -> bool {
        self.turns() || (0..S::D).any(|k| self.mass[k] > 0.0)
    }

    /// Returns the largest inverse inertia about any axis, or an upper bound; exact for isotropic
    /// inertia (1/(kg m^2)).
    pub fn quickest(&self) -> f64 {
        let n = S::Spin::N;
        let row = |i: usize| (0..n).map(|j| self.inertia.entry(i, j).abs()).sum::<f64>();
        (0..n).map(row).fold(0.0, f64::max)
    }

    /// Returns twice the kinetic energy of a velocity change, without imposed degrees of freedom
    /// (J).
    #[inline]
    pub fn energy(&self, dv: &S::Vector, dw: &S::Spin) -> f64 {
        let masses = (0..S::D).filter(|k| self.mass[*k] > 0.0);
        let shift: f64 = masses.map(|k| dv[k] * dv[k] / self.mass[k]).sum();
        if !self.turns() {
            return shift;
        }
        let about = self.inertia.entry(0, 0);
        if self.inertia == S::Tensor::uniform(about) {
            return shift + dw.dot(dw) / about;
        }
        shift + self.energy_of_turning(dw)
    }

    /// The same of rotation, where the inertia has directions.
    #[inline(never)]
    fn energy_of_turning(&self, dw: &S::Spin) -> f64 {
        let inertia = self.inertia.inverse();
        inertia.map_or(0.0, |i| dw.dot(&i.apply(dw)))
    }
}

/// Location of a contact's row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Of a kind of rows, see [`super::kinds`].
    Row {
        kind: u8,
        row: u32,
    },
    System(u32),
}

/// The contact problem of one step. Push the bodies, then the contacts.
///
/// # Examples
/// A disk of 2 kg rests on an immovable plane; in a step of 1 ms gravity would give it 0.01 m/s
/// downwards, and 0.001 m/s sideways, which is within what Coulomb friction with mu = 0.5 holds.
/// ```
/// use fretwork_core::geometry::space::{Dim2, Space, VectorLike};
/// use fretwork_core::solve::{ContactForm, Options, Problem, nlgs};
/// use nalgebra::{Matrix1, Vector1, Vector2};
///
/// let mut problem = Problem::<Dim2>::default();
/// let (spin, turned) = (Vector1::new(0.0), Matrix1::new(0.0));
/// let free = Vector2::new(1e-3, -1e-2);
/// problem.push_body(free, spin, Vector2::new(0.5, 0.5), turned, 0.01);
/// problem.push_body(Vector2::zero(), spin, Vector2::zero(), turned, 0.01);
/// problem.push(&ContactForm {
///     bodies: [0, 1],
///     normal: Vector2::new(0.0, 1.0),
///     arms: [Vector2::new(0.0, -0.01), Vector2::zero()],
///     central: true,
///     apart: false,
///     shift_n: 0.0,
///     shift_t: <Dim2 as Space>::Tangent::zero(),
///     friction: 0.5,
///     tension: 0.0,
///     cohesion: 0.0,
///     elastic: None,
///     compliance: [0.0; 2],
///     impulse: Vector2::zero(),
/// });
/// let report = nlgs::solve(&mut problem, &Options { tolerance: 1e-10, ..Options::default() });
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
    /// Contacts with dynamical systems; they run after those above, in order.
    pub(super) of_systems: Vec<SystemRow<S>>,
    pub(super) tractions: Tractions,
    /// The dynamical systems, as far as contacts see them.
    pub(super) systems: Vec<NodalSystem<S>>,
    /// Memory of large systems that were solved before.
    pub(super) loaded: Vec<Loaded<S>>,
    /// Moments of contacts that resist rotation; they run last, in order.
    pub(super) moments: Vec<MomentRow<S>>,
    pub(super) places: Vec<Place>,
    /// Connected sets of the contacts that it had when these were asked for last.
    pub(super) connected: Connected,
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
            connected: Connected::default(),
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
        size_of::<Place>() + size_of::<[u32; 2]>() + 3 * size_of::<u32>();

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
    pub(super) fn normal(&self, place: Place) -> f64 {
        self.local_impulse(place).n
    }

    /// Returns the normal and the tangential impulse of a contact (N s).
    pub(super) fn local_impulse(&self, place: Place) -> Parts<S> {
        match place {
            Place::Row { kind, row } => {
                of_kind!(&self.rows[kind as usize], rows => rows.row(row).local_impulse())
            }
            Place::System(r) => self.of_systems[r as usize].impulse(),
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
            Place::Row { kind, row } => {
                of_kind!(&self.rows[kind as usize], rows => rows.solution(row, bodies))
            }
            Place::System(r) => self.of_systems[r as usize].solution(bodies, &self.systems),
        }
    }

    /// Returns velocity and angular velocity of a body after the solve.
    pub fn velocity(&self, body: usize) -> (S::Vector, S::Spin) {
        let record = &self.solver_bodies[body];
        (record.v, record.s * (1.0 / self.lengths[body]))
    }
}
