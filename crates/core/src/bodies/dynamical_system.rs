//! The interface between the time step and a body that is more than rigid.
//!
//! Rigid bodies are the fast case and stay in the columns of [`super::Bodies`]. Anything else (an
//! elastic half-space, a mesh, a grain in a floating frame) is a [`DynamicalSystem`]: it has
//! its own generalised coordinates, and contacts act on it through its *nodes*, points whose
//! velocities are linear in its generalised velocities, u_a = P_a v.
//!
//! Over a step of the theta scheme, with q and v at its start,
//!
//! ```text
//! A = M + h theta C + h^2 theta^2 K
//! v_free = v + A^-1 h (F - C v - K (q + h theta v))
//! v+ = v_free + A^-1 sum_a P_a^T p_a          p_a the impulse on node a
//! ```
//!
//! so that a contact solver needs only two things: the free velocities of the nodes, and their
//! compliance P_a A^-1 P_b^T, the change of velocity at one node by an impulse at another.
//!
//! Sources: J. J. Moreau, "Numerical aspects of the sweeping process", Comput. Methods Appl. Mech.
//! Eng. 177 (1999); M. Jean, "The non-smooth contact dynamics method", same volume.

use super::compliance::Compliance;
use super::conduction::Conduction;
use super::contactor::{Contactor, ContactorMotion};
use super::drive::Dof;
use super::nodes::Nodes;
use super::system_report::{DeformedMesh, SystemSize, TouchingSurface};
use crate::geometry::shape::Surface;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use std::fmt::Debug;
use std::sync::Arc;

/// A time step, as passed to systems.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemStep<S: Space> {
    /// Time at its start (s).
    pub time: f64,
    /// Length (s).
    pub h: f64,
    /// Theta in \[1/2, 1\].
    pub theta: f64,
    /// Acceleration of gravity (m/s^2).
    pub gravity: S::Vector,
}

/// Work over a step (J; J/m in 2D), at the velocities v_theta = (1 - theta) v + theta v+.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SystemWork {
    /// Change of the potential energy in gravity, -h v_theta . M g.
    pub potential: f64,
    /// Work of imposed forces and motions.
    pub external: f64,
    /// Dissipated by damping, h v_theta . C v_theta.
    pub damping: f64,
    /// Dissipated by the scheme, (theta - 1/2) (|v+ - v|_M^2 + h^2 |v_theta|_K^2); zero at theta =
    /// 1/2. For nonlinear internal forces the second part is the work against the force used in the
    /// step, h f . v_theta, less the change of the stored energy: negative where the scheme adds
    /// energy.
    pub scheme: f64,
    /// Work of thermal expansion: the increase of the stored energy when the free strain of the
    /// step was set.
    pub expansion: f64,
}

/// The holder of a part of a system along an axis: displacement, velocity and force.
#[derive(Clone, Debug, PartialEq)]
pub struct Holder {
    /// Name of the part.
    pub part: String,
    /// Axis, 0 is x.
    pub axis: usize,
    /// Fraction of the last step at which displacement and force hold: theta, or 1 for a force at
    /// the end of the step.
    pub at: f64,
    /// Displacement of the part since the start (m).
    pub displacement: f64,
    /// Velocity of the part over the last step, v_theta (m/s).
    pub velocity: f64,
    /// Force of the holder on the part over the last step (N; N/m in 2D).
    pub force: f64,
}

/// The von Mises stress of a stress tensor xx, yy, zz, yz, xz, xy (Pa).
pub fn von_mises(stress: &[f64; 6]) -> f64 {
    let [x, y, z, yz, xz, xy] = *stress;
    let normal = (x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2);
    (0.5 * normal + 3.0 * (yz * yz + xz * xz + xy * xy)).sqrt()
}

/// A body with generalised coordinates of its own.
///
/// In each step its methods are called in this order:
///
/// 1. [`begin_step`](Self::begin_step) in the state at the start of the step,
/// 2. [`advance`](Self::advance) by (1 - theta) h, to q_m, where contacts are found,
/// 3. [`linearise`](Self::linearise) and [`free_velocity`](Self::free_velocity), once,
/// 4. [`contact_nodes`](Self::contact_nodes) once for each contact, then
///    [`compliance`](Self::compliance) of the nodes that are touched; where the step is solved
///    again with more contacts, nodes of all contacts again, and the compliance if other nodes are
///    touched,
/// 5. [`set_contact_impulse`](Self::set_contact_impulse) and [`set_velocity`](Self::set_velocity)
///    with v+, then [`relinearise`](Self::relinearise); if it returns true, the calls from the free
///    velocity on are repeated; several times where a step is solved again,
/// 6. `advance` by theta h, and [`work`](Self::work) at the end.
///
/// Velocities have [`freedoms`](Self::freedoms) entries, in the system's own units.
///
/// The results of a system must depend on its state only: equal states give equal bits.
///
/// # Methods
/// Every method of the solver serves systems: sweeps apply the compliance impulse by impulse,
/// gradients to all nodes at a time, and Newton and the interior point form W, of which the blocks
/// between all contacts of a system are filled. If these have more than about ten million entries,
/// only products with W are computed, and methods that need W are refused
/// ([`crate::solve::refusal`]). A law that resists rotation acts on a
/// [`turning_node`](DynamicalSystem::turning_node); a system without one does not rotate, and its
/// holders take the moment. The projection of overlaps is refused with any system.
///
/// # Nonlinear systems
/// With internal forces f(q) instead of K q a step uses the tangent: `linearise` forms K = df/dq
/// and A at the state q + h theta v that the step would reach without forces (q_m at theta = 1/2),
/// and the free velocity is v + A^-1 h (F - C v - f(q + h theta v)). Without impacts, the error of
/// the force is then O(h^4), and the scheme is of second order at theta = 1/2. The work of the
/// linearised force differs from the change of the stored energy; the difference is part of
/// [`SystemWork::scheme`], so that the ledger closes. A system whose forces change more within a
/// step iterates with [`relinearise`](DynamicalSystem::relinearise).
pub trait DynamicalSystem<S: Space>: Debug + Send + Sync {
    /// Returns the name in the case.
    fn name(&self) -> &str;

    /// Returns the number of generalised velocities.
    fn freedoms(&self) -> usize;

    /// Returns the current generalised velocities.
    fn velocity(&self) -> &[f64];

    /// Sets the generalised impulse of all contacts (N s), before the resulting velocity is set:
    /// systems with imposed motion compute the work of that motion from it. Ignored by default.
    fn set_contact_impulse(&mut self, _impulse: &[f64]) {}

    /// Sets the generalised velocities, as many as [`Self::freedoms`].
    fn set_velocity(&mut self, velocity: &[f64]);

    /// Returns the velocity of material that flows along a surface that stays in place (m/s); it
    /// closes no gap. Zero by default.
    fn passing(&self) -> S::Vector {
        S::Vector::zero()
    }

    /// Begins a step at the current state, which is stored as its start. A linear system forms A
    /// here where h or theta have changed.
    fn begin_step(&mut self, step: &SystemStep<S>);

    /// Sets the stress-free strain due to thermal expansion in the step, one number for each point
    /// of the mesh or one for all. Called before [`Self::begin_step`] in every step from the first
    /// with heat on. Does nothing by default, for systems that do not expand.
    fn set_free_strain(&mut self, _of_points: &[f64]) {}

    /// Returns the work of the expansion at each point of the mesh in the step (J; J/m in 2D),
    /// which sums to [`SystemWork::expansion`]; empty for systems that do not expand.
    fn expansion_work(&self) -> &[f64] {
        &[]
    }

    /// Returns whether [`Self::set_free_strain`] makes the system expand.
    fn expands(&self) -> bool {
        false
    }

    /// Forms A and the compliance for the step, where they depend on the state: a body in large
    /// strain computes and factorises its tangent, a body in a floating frame rotates its blocks.
    /// Called once per step, at q_m, after [`Self::begin_step`] and before anything that needs A.
    /// Does nothing by default, for linear systems.
    fn linearise(&mut self, _step: &SystemStep<S>) {}

    /// Linearises again if the forces at the velocities found by the contact solver differ from
    /// those used in the step, and returns whether it did. If so, the free velocity and the
    /// compliance are requested and the contacts solved again: Newton's method, whose end the
    /// system decides. Returns false by default.
    ///
    /// # Errors
    /// The reason why there is no balance and a remedy, as the second half of a sentence.
    fn relinearise(&mut self, _step: &SystemStep<S>) -> Result<bool, String> {
        Ok(false)
    }

    /// Returns the number of linearisations in the step; 0 for linear systems.
    fn linearisations(&self) -> u32 {
        0
    }

    /// Moves the coordinates by a time (s) at the current velocities. A step does so twice: by (1 -
    /// theta) h at the velocities of its start, after [`Self::begin_step`], and by theta h at those
    /// of its end.
    fn advance(&mut self, time: f64);

    /// Returns v_free, the velocities at the end of the step without contacts; imposed velocities
    /// are the imposed values.
    fn free_velocity(&self, step: &SystemStep<S>) -> Vec<f64>;

    /// Replaces a generalised impulse by the change of velocity that it causes, A^-1 times the
    /// impulse; zero where motion is imposed.
    fn solve(&self, impulse: &mut [f64]);

    /// Returns the work of the step, at its end.
    fn work(&self, step: &SystemStep<S>) -> SystemWork;

    /// Returns the kinetic energy (J; J/m in 2D).
    fn kinetic_energy(&self) -> f64;

    /// Returns the energy stored in deformation (J; J/m in 2D).
    fn stored_energy(&self) -> f64;

    /// Returns the mass on which gravity acts (kg; kg/m in 2D).
    fn mass(&self) -> f64;

    /// Returns a length that characterises the size, such as the radius of a grain (m): a body
    /// counts as at rest if its kinetic energy is small compared with its mass times gravity times
    /// twice this length. By default half of the longest edge of the box around the contactors.
    fn length(&self) -> f64 {
        let (mut low, mut high) = (S::Vector::zero(), S::Vector::zero());
        for (k, contactor) in self.contactors().iter().enumerate() {
            let at = self.contactor_motion(contactor).position;
            for d in 0..S::D {
                let [from, to] = [at[d] - contactor.radius, at[d] + contactor.radius];
                low[d] = if k == 0 { from } else { low[d].min(from) };
                high[d] = if k == 0 { to } else { high[d].max(to) };
            }
        }
        (0..S::D).fold(0.0, |most: f64, d| most.max(0.5 * (high[d] - low[d])))
    }

    /// Returns whether motion is imposed on the system. Conditions of rest ignore such systems,
    /// like driven first bodies.
    fn is_driven(&self) -> bool {
        false
    }

    /// Returns whether the system is a grain, which results report together with all other grains.
    fn is_grain(&self) -> bool {
        false
    }

    /// Returns the position of a node (m).
    fn node_position(&self, node: u32) -> S::Vector;

    /// Returns P_a v, the velocity of a node for generalised velocities (m/s).
    fn node_velocity(&self, node: u32, velocity: &[f64]) -> S::Vector;

    /// Adds P_a^T p, for an impulse p on a node (N s), to a generalised impulse.
    fn add_impulse(&self, node: u32, impulse: &S::Vector, generalised: &mut [f64]);

    /// Returns the parts that can touch.
    fn contactors(&self) -> Vec<Contactor>;

    /// Returns the nodes on which a contact acts, at an arm from the contactor's origin in world
    /// axes (m). By default the nodes of the origin, for contactors that do not rotate.
    fn contact_nodes(&self, contactor: &Contactor, _arm: &S::Vector) -> Nodes {
        contactor.nodes.clone()
    }

    /// Returns a node that represents the rotation of a contactor where a contact acts, at an arm
    /// from its origin in world axes (m), and a length (m). Such nodes come after those of points:
    /// the velocity of one is the angular velocity of the contactor there times the length (in the
    /// plane along x), and an impulse p on it is the moment p times the length. Laws that resist
    /// rotation act on it.
    ///
    /// None by default: the contactor does not rotate under any moment, so that moments do no work.
    fn turning_node(&self, _contactor: &Contactor, _arm: &S::Vector) -> Option<(u32, f64)> {
        None
    }

    /// Returns the facets at a contactor that is a point of a surface with linear displacement on
    /// its facets: the current D corners of each (m), anticlockwise seen from outside or in the
    /// plane with the outside on their left, and the index of the point among them. Empty for other
    /// contactors.
    fn facets_at(&self, _contactor: usize) -> Vec<([S::Vector; 3], usize)> {
        Vec::new()
    }

    /// Returns the nodes of a weighted sum of vertices of the surface of a contactor; `None` for
    /// surfaces whose displacement is not linear between vertices.
    fn vertex_nodes(&self, _contactor: &Contactor, _weights: &[(u32, f64)]) -> Option<Nodes> {
        None
    }

    /// Returns the sides along x and y (m; along x in the plane) of the equal cells whose centres
    /// are the points and surface vertices of the system; `None` for other systems. Contacts of
    /// points with the nearest positions transfer a uniform pressure between grids of equal cells.
    fn cell_size(&self) -> Option<[f64; 2]> {
        None
    }

    /// Returns the current surface of a contactor that is a surface, in the frame of the contactor.
    fn surface(&self, _contactor: &Contactor) -> Option<Box<dyn Surface<S>>> {
        None
    }

    /// Returns the current vertices of that surface in its own order, in the frame of the contactor
    /// (m).
    fn surface_vertices(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Returns the tributary length (m) or area (m^2) of each surface vertex of a grain: the sum of
    /// the shares of its facets along their outward normals.
    fn point_areas(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Returns the velocity of the origin of a contactor (m/s) and the angular velocity of its
    /// frame (rad/s) for generalised velocities. By default that of its nodes, without rotation.
    fn contactor_velocity(&self, contactor: &Contactor, velocity: &[f64]) -> (S::Vector, S::Spin) {
        let of_node = |node| self.node_velocity(node, velocity);
        (contactor.nodes.sum_of(of_node), S::Spin::zero())
    }

    /// Returns the velocity of a contactor's frame with which contacts of the step are predicted,
    /// given the velocities without contacts; these by default. A surface without inertia, which
    /// would spring back to its unloaded shape without contacts, is expected to stay.
    fn expected_velocity(&self, contactor: &Contactor, free: &[f64]) -> (S::Vector, S::Spin) {
        self.contactor_velocity(contactor, free)
    }

    /// Returns position and motion of a contactor. By default those of the nodes of its origin,
    /// without rotation.
    fn contactor_motion(&self, contactor: &Contactor) -> ContactorMotion<S> {
        let (velocity, spin) = self.contactor_velocity(contactor, self.velocity());
        ContactorMotion {
            position: contactor.nodes.sum_of(|node| self.node_position(node)),
            rotation: S::identity(),
            velocity,
            spin,
        }
    }

    /// Returns whether contactors of the system can touch each other.
    fn touches_itself(&self) -> bool {
        false
    }

    /// Returns the square of blocks P_a A^-1 P_b^T of some nodes (1/kg), row by row. By default a
    /// solution for each node; systems with a constant A keep the blocks of their surface instead.
    fn compliance(&self, nodes: &[u32]) -> Vec<S::Matrix> {
        compliance_by_solving(self, nodes)
    }

    /// Returns the blocks of points that are sums of nodes (1/kg), row by row.
    fn point_compliance(&self, points: &[Nodes]) -> Vec<S::Matrix> {
        compliance_of_points(self, points)
    }

    /// Returns the compliance of all nodes on which contacts can act, with the columns of the
    /// touched ones, if it is kept between steps: the solver then reads it without copying. None by
    /// default.
    fn kept_compliance(&self, _touched: &[u32]) -> Option<Arc<Compliance<S>>> {
        None
    }

    /// Returns the number of nodes of that compliance; `None` if it is not kept.
    fn kept_nodes(&self) -> Option<usize> {
        None
    }

    /// Returns the holders, always in the same order.
    fn holders(&self) -> Vec<Holder> {
        Vec::new()
    }

    /// Returns the current drive of a held part along an axis; `None` if the part is not held. It
    /// may be replaced by a drive of the same kind: imposed motion, or not.
    fn drive_mut(&mut self, _part: &str, _axis: usize) -> Option<&mut Dof> {
        None
    }

    /// Returns the current mesh; `None` for systems without mesh.
    fn deformed_mesh(&self) -> Option<DeformedMesh<S::Vector>> {
        None
    }

    /// Returns the heat conduction of that mesh; `None` for systems whose heat is not computed.
    fn conduction(&self) -> Option<Conduction> {
        None
    }

    /// Returns the velocities of the points of that mesh (m/s); empty if unknown.
    fn mesh_velocity(&self) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Returns the unloaded positions of the points of that mesh at the start of the run (m), for
    /// bodies that travel, such as grains; empty for others, whose [`DeformedMesh::points`] do not
    /// move.
    fn mesh_at_start(&self) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Returns the surface on which tractions are computed; `None` if they are not known. Its
    /// points and facets stay the same over a run.
    fn touching_surface(&self) -> Option<TouchingSurface<S::Vector>> {
        None
    }

    /// Returns memory and cost of solutions; `None` if unknown.
    fn size(&self) -> Option<SystemSize> {
        None
    }

    /// Returns whether the contact points have equal tributary areas in space, pi times the square
    /// of their radius, so that a force over the area is a traction. (In the plane it is for all
    /// systems.)
    fn has_equal_points(&self) -> bool {
        false
    }

    /// Returns the current largest strain and largest rotation (rad) of a system that assumes both
    /// to be small; `None` for other systems.
    fn small_strain(&self) -> Option<[f64; 2]> {
        None
    }

    /// Returns, for systems whose loads must stay away from the border of the loadable part, the
    /// largest force there relative to the largest force, in the last step.
    fn load_at_border(&self) -> Option<f64> {
        None
    }

    /// Returns the state between two steps as bytes for [`Self::restore`]: coordinates, velocities,
    /// and everything else on which the next step depends.
    fn save(&self) -> Vec<u8>;

    /// Restores a state that the same system saved; returns false, without change, if the bytes are
    /// not such a state.
    #[must_use]
    fn restore(&mut self, saved: &[u8]) -> bool;

    /// Returns a copy.
    fn clone_box(&self) -> Box<dyn DynamicalSystem<S>>;
}

/// Returns the blocks P_a A^-1 P_b^T of some nodes of a system (1/kg), row by row, from a solution
/// for each node.
pub fn compliance_by_solving<S: Space, T: DynamicalSystem<S> + ?Sized>(
    system: &T,
    nodes: &[u32],
) -> Vec<S::Matrix> {
    let points: Vec<Nodes> = nodes.iter().copied().map(Nodes::one).collect();
    point_compliance_by_solving(system, &points)
}

/// Returns the blocks of points that are sums of nodes (1/kg), row by row, from a solution for each
/// point.
fn point_compliance_by_solving<S: Space, T: DynamicalSystem<S> + ?Sized>(
    system: &T,
    points: &[Nodes],
) -> Vec<S::Matrix> {
    let zero = S::Matrix::diagonal(&S::Vector::zero());
    let mut blocks = vec![zero; points.len() * points.len()];
    let mut response = vec![0.0; system.freedoms()];
    for (b, point) in points.iter().enumerate() {
        for k in 0..S::D {
            let mut unit = S::Vector::zero();
            unit[k] = 1.0;
            response.fill(0.0);
            for (node, weight) in point.terms() {
                system.add_impulse(node, &(unit * weight), &mut response);
            }
            system.solve(&mut response);
            for (a, point) in points.iter().enumerate() {
                let velocity = point.sum_of(|node| system.node_velocity(node, &response));
                let block = &mut blocks[a * points.len() + b];
                *block = *block + S::Matrix::dyad(&velocity, &unit);
            }
        }
    }
    blocks
}

/// Ratio of nodes to points from which one solution for each point in each step is cheaper than one
/// for each node that is kept, and needs no memory.
const FAR_FEWER: usize = 16;

/// Returns whether points are far fewer than the nodes of which they are sums.
pub(crate) fn far_fewer(points: usize, nodes: usize) -> bool {
    FAR_FEWER * points < nodes
}

/// Returns the blocks of points that are sums of nodes (1/kg), row by row, from those of the nodes
/// unless these are far more numerous.
pub fn compliance_of_points<S: Space, T: DynamicalSystem<S> + ?Sized>(
    system: &T,
    points: &[Nodes],
) -> Vec<S::Matrix> {
    let terms = points.iter().flat_map(Nodes::terms);
    let mut nodes: Vec<u32> = terms.map(|(node, _)| node).collect();
    nodes.sort_unstable();
    nodes.dedup();
    if far_fewer(points.len(), nodes.len()) {
        return point_compliance_by_solving(system, points);
    }
    let blocks = system.compliance(&nodes);
    let place = |node: u32| nodes.binary_search(&node).unwrap_or_default();
    let terms = |point: &Nodes| point.terms().map(|(n, w)| (place(n), w)).collect();
    let terms: Vec<Vec<(usize, f64)>> = points.iter().map(terms).collect();
    let sum = |row: &[S::Matrix], terms: &[(usize, f64)]| {
        let zero = S::Matrix::uniform(0.0);
        terms
            .iter()
            .fold(zero, |sum, (at, w)| sum + row[*at].scaled(*w))
    };
    // Responses of all nodes to an impulse on each point, then of the points.
    let mut of_nodes = Vec::with_capacity(points.len() * nodes.len());
    for point in &terms {
        let rows = blocks.chunks_exact(nodes.len());
        of_nodes.extend(rows.map(|row| sum(row, point)));
    }
    let mut out = Vec::with_capacity(points.len() * points.len());
    for a in &terms {
        let by_point = of_nodes.chunks_exact(nodes.len());
        out.extend(by_point.map(|row| sum(row, a)));
    }
    out
}

impl<S: Space> Clone for Box<dyn DynamicalSystem<S>> {
    fn clone(&self) -> Self {
        self.clone_box()
    }
}
