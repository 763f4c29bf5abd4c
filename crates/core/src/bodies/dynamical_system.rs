//! The interface between the time step and a body that is more than rigid.
//!
//! Rigid bodies are the fast case and stay in the columns of [`super::Bodies`]. Anything else (an
//! elastic half-space, a mesh, a grain in a floating frame) is a [`DynamicalSystem`]: it has
//! generalised coordinates of its own, and contacts see it through its *nodes*, points whose
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
//! so that a contact solver needs two things of it only: the free velocities of the nodes, and
//! their compliance P_a A^-1 P_b^T, the change of velocity at one node by an impulse at another.
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

/// The step that a system is taken through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemStep<S: Space> {
    /// Time at its start (s).
    pub time: f64,
    /// Its length (s).
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
    /// 1/2. Where internal forces are not linear the second part is the work against the force that
    /// the step was taken with, h f . v_theta, less the change of the stored energy: negative where
    /// the scheme adds energy.
    pub scheme: f64,
    /// Of thermal expansion: what the stored energy gained when the free strain of the step was
    /// set.
    pub expansion: f64,
}

/// The holder of a part of a system along an axis: displacement, velocity and force.
#[derive(Clone, Debug, PartialEq)]
pub struct Holder {
    /// Name of the part.
    pub part: String,
    /// Axis, 0 is x.
    pub axis: usize,
    /// Share of the last step at which displacement and force are those given: theta, or 1 where a
    /// force is that of the end.
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
/// In each step it is called in this order:
///
/// 1. [`begin_step`](Self::begin_step) at the state of its start,
/// 2. [`advance`](Self::advance) by (1 - theta) h, to q_m, where contacts are found,
/// 3. [`linearise`](Self::linearise) and [`free_velocity`](Self::free_velocity), once,
/// 4. [`contact_nodes`](Self::contact_nodes) once for each contact, then
///    [`compliance`](Self::compliance) of the nodes that are touched; where the step is solved
///    again with more contacts, nodes of all contacts again, and the compliance if other nodes are
///    touched,
/// 5. [`set_contact_impulse`](Self::set_contact_impulse) and [`set_velocity`](Self::set_velocity)
///    with v+, then [`relinearise`](Self::relinearise), after which all from the free velocity on
///    is asked again where it says so; several times where a step is solved again,
/// 6. `advance` by theta h, and [`work`](Self::work) at the end.
///
/// Velocities have [`freedoms`](Self::freedoms) entries, in the system's own units.
///
/// Its results must depend on its state only: equal states give equal bits.
///
/// # Methods
/// Every method of the solver serves systems: sweeps apply the compliance impulse by impulse,
/// gradients to all nodes at a time, and Newton and the interior point form W, of which the blocks
/// between all contacts of a system are filled. Where these have more than some ten million entries
/// there are products alone, and methods that need W are refused ([`crate::solve::refusal`]). A law
/// that resists rotation acts on a [`turning_node`](DynamicalSystem::turning_node); where there is
/// none the system does not turn, and what holds it takes the moment. The projection of overlaps is
/// refused with any system.
///
/// # Systems that are not linear
/// With internal forces f(q) in place of K q a step is taken with the tangent: `linearise` forms K
/// = df/dq and A at the state q + h theta v that the step would reach without forces (it is q_m at
/// theta = 1/2), and the free velocity is v + A^-1 h (F - C v - f(q + h theta v)). Where no impact
/// makes the velocity jump the force is then wrong by O(h^4), and the rule is of second order at
/// theta = 1/2. What the linearised force does along the step and what is stored differ: the
/// difference is part of [`SystemWork::scheme`], and the ledger closes. A system whose forces
/// change more than that within a step converges them by
/// [`relinearise`](DynamicalSystem::relinearise).
pub trait DynamicalSystem<S: Space>: Debug + Send + Sync {
    /// Name in the case.
    fn name(&self) -> &str;

    /// Number of generalised velocities.
    fn freedoms(&self) -> usize;

    /// The current generalised velocities.
    fn velocity(&self) -> &[f64];

    /// Sets the generalised impulse of all contacts (N s), before the velocity that it leads to:
    /// systems with imposed motion compute the work of that motion from it. Ignored by default.
    fn set_contact_impulse(&mut self, _impulse: &[f64]) {}

    /// Takes generalised velocities, as many as [`Self::freedoms`].
    fn set_velocity(&mut self, velocity: &[f64]);

    /// Velocity of the material that passes through its surface, which stays in place (m/s): it
    /// moves along the surface, so that no gap closes by it. Here none.
    fn passing(&self) -> S::Vector {
        S::Vector::zero()
    }

    /// Begins a step at the current state, which it remembers as its start. A linear system forms A
    /// here where h or theta have changed.
    fn begin_step(&mut self, step: &SystemStep<S>);

    /// Takes the strain that each point of its mesh has without stress, or one of all points, by
    /// the thermal expansion of the step. Called in every step from the first with heat on, before
    /// [`Self::begin_step`]. By default nothing: it does not expand.
    fn set_free_strain(&mut self, _of_points: &[f64]) {}

    /// Work of the expansion at each point of its mesh in the step (J; J/m in 2D), which sums to
    /// [`SystemWork::expansion`]; none where it does not expand.
    fn expansion_work(&self) -> &[f64] {
        &[]
    }

    /// Whether [`Self::set_free_strain`] makes it expand.
    fn expands(&self) -> bool {
        false
    }

    /// Forms A and what [`Self::compliance`] gives for the step, where they depend on the state: a
    /// body in large strain takes its tangent and factorises, one in a floating frame turns its
    /// blocks. Called once a step, at q_m, before all that needs A; [`Self::begin_step`] has
    /// remembered the start. By default nothing: A is that of a linear system.
    fn linearise(&mut self, _step: &SystemStep<S>) {}

    /// Asked after the contacts of a step were solved, at the velocities that they led to: whether
    /// the system has linearised anew, because its forces are not those of the step at these
    /// velocities. The free velocity and the compliance are then asked for again, and the contacts
    /// are solved again: Newton's method, whose end the system decides. Here false: what
    /// [`Self::linearise`] gave stands.
    ///
    /// # Errors
    /// Why there is no balance, and what to change, as the second half of a sentence.
    fn relinearise(&mut self, _step: &SystemStep<S>) -> Result<bool, String> {
        Ok(false)
    }

    /// How often it has linearised in the step; none of linear systems.
    fn linearisations(&self) -> u32 {
        0
    }

    /// Moves the coordinates by a time (s) at the current velocities. A step does so twice: by (1 -
    /// theta) h at the velocities of its start, after [`Self::begin_step`], and by theta h at those
    /// of its end.
    fn advance(&mut self, time: f64);

    /// v_free, the velocities at the end of the step without contacts; those of an imposed motion
    /// as they are imposed.
    fn free_velocity(&self, step: &SystemStep<S>) -> Vec<f64>;

    /// Replaces a generalised impulse by the change of velocity that it gives, A^-1 times it; zero
    /// where motion is imposed.
    fn solve(&self, impulse: &mut [f64]);

    /// The work of the step, at its end.
    fn work(&self, step: &SystemStep<S>) -> SystemWork;

    /// Kinetic energy now (J; J/m in 2D).
    fn kinetic_energy(&self) -> f64;

    /// Energy stored in deformation now (J; J/m in 2D).
    fn stored_energy(&self) -> f64;

    /// Mass that gravity acts on (kg; kg/m in 2D).
    fn mass(&self) -> f64;

    /// A length of its size, as the radius of a grain is (m): the kinetic energy of a body at rest
    /// is small against its mass times gravity times twice this length. Here half of the longest
    /// edge of the box around its contactors.
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

    /// Whether motion of it is imposed. A condition of rest does not look at it then, as it does
    /// not at a first body that is driven.
    fn is_driven(&self) -> bool {
        false
    }

    /// Whether it is a grain, which results report together with all other grains.
    fn is_grain(&self) -> bool {
        false
    }

    /// Where a node is (m).
    fn node_position(&self, node: u32) -> S::Vector;

    /// P_a v: the velocity of a node at generalised velocities (m/s).
    fn node_velocity(&self, node: u32, velocity: &[f64]) -> S::Vector;

    /// Adds P_a^T p to a generalised impulse: that of an impulse on a node (N s).
    fn add_impulse(&self, node: u32, impulse: &S::Vector, generalised: &mut [f64]);

    /// Its parts that can touch.
    fn contactors(&self) -> Vec<Contactor>;

    /// The nodes that a contact acts on, at an arm from the contactor's origin, in world axes (m):
    /// those of the origin, of a contactor that does not turn.
    fn contact_nodes(&self, contactor: &Contactor, _arm: &S::Vector) -> Nodes {
        contactor.nodes.clone()
    }

    /// A node that turns with a contactor where a contact acts, at an arm from its origin in world
    /// axes (m), and a length (m). Such nodes come after those of points: the velocity of one is
    /// the angular velocity of the contactor there times its length (in the plane along x), and an
    /// impulse p on it is a moment of p times the length. Laws that resist rotation act on it.
    ///
    /// By default there is none: the contactor does not turn, whatever moment acts on it, so that moments on it
    /// have no power.
    fn turning_node(&self, _contactor: &Contactor, _arm: &S::Vector) -> Option<(u32, f64)> {
        None
    }

    /// Of a contactor that is a point of a surface whose displacement is linear on its facets: the
    /// facets at it, each with its D corners as they are now, outside being where they are
    /// anticlockwise, in the plane on their left (m), and the place of the point among them. None
    /// of others.
    fn facets_at(&self, _contactor: usize) -> Vec<([S::Vector; 3], usize)> {
        Vec::new()
    }

    /// The nodes of a weighted sum of vertices of the surface of a contactor, whose displacement is
    /// linear between them; none of surfaces of which it is not.
    fn vertex_nodes(&self, _contactor: &Contactor, _weights: &[(u32, f64)]) -> Option<Nodes> {
        None
    }

    /// Sides along x and y (m; along x in the plane) of the equal cells whose middles are its
    /// points and the vertices of its surface; none of other systems. A uniform pressure on the
    /// points of one grid is one on the nearest places of a grid of equal cells.
    fn cell_size(&self) -> Option<[f64; 2]> {
        None
    }

    /// The surface of a contactor that is one, in the frame of the contactor, as it is now.
    fn surface(&self, _contactor: &Contactor) -> Option<Box<dyn Surface<S>>> {
        None
    }

    /// Vertices of that surface as they are now, in the order of its own, in the frame of the
    /// contactor (m).
    fn surface_vertices(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Of a grain, by vertex of its surface: the length (m) or area (m^2) that the vertex stands
    /// for, the sum of the shares of its facets along their outward normals.
    fn point_areas(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Velocity of the origin of a contactor (m/s) and angular velocity of its frame (rad/s) at
    /// generalised velocities: that of its nodes, without turning.
    fn contactor_velocity(&self, contactor: &Contactor, velocity: &[f64]) -> (S::Vector, S::Spin) {
        let of_node = |node| self.node_velocity(node, velocity);
        (contactor.nodes.sum_of(of_node), S::Spin::zero())
    }

    /// The velocity of a contactor's frame that contacts of the step are looked for with, at the
    /// velocities without contacts: here these. A surface without inertia springs back to where it
    /// is without load, if nothing pushes it: it is expected to stay.
    fn expected_velocity(&self, contactor: &Contactor, free: &[f64]) -> (S::Vector, S::Spin) {
        self.contactor_velocity(contactor, free)
    }

    /// Where a contactor stands and how it moves: as the nodes of its origin, without turning.
    fn contactor_motion(&self, contactor: &Contactor) -> ContactorMotion<S> {
        let (velocity, spin) = self.contactor_velocity(contactor, self.velocity());
        ContactorMotion {
            position: contactor.nodes.sum_of(|node| self.node_position(node)),
            rotation: S::identity(),
            velocity,
            spin,
        }
    }

    /// Whether its contactors can touch each other.
    fn touches_itself(&self) -> bool {
        false
    }

    /// The blocks P_a A^-1 P_b^T of some nodes (1/kg), row by row: a square of them. Here by
    /// solving for each node; systems of which A stays as it is keep the blocks of their surface
    /// instead.
    fn compliance(&self, nodes: &[u32]) -> Vec<S::Matrix> {
        compliance_by_solving(self, nodes)
    }

    /// The blocks of some points that are sums of nodes (1/kg), row by row.
    fn point_compliance(&self, points: &[Nodes]) -> Vec<S::Matrix> {
        compliance_of_points(self, points)
    }

    /// The compliance of all nodes that contacts can act on, with the columns of those that are
    /// touched, where it is kept between steps: the solver then reads it in place, and copies
    /// nothing. Here none.
    fn kept_compliance(&self, _touched: &[u32]) -> Option<Arc<Compliance<S>>> {
        None
    }

    /// How many nodes that compliance has; none where it is not kept.
    fn kept_nodes(&self) -> Option<usize> {
        None
    }

    /// Its holders, always in the same order.
    fn holders(&self) -> Vec<Holder> {
        Vec::new()
    }

    /// The current drive of a held part along an axis, to be replaced by one that imposes motion if
    /// it does, and by none that does if it does not. None where nothing is held.
    fn drive_mut(&mut self, _part: &str, _axis: usize) -> Option<&mut Dof> {
        None
    }

    /// Its mesh as it is now; none of systems that have no mesh.
    fn deformed_mesh(&self) -> Option<DeformedMesh<S::Vector>> {
        None
    }

    /// How heat flows in that mesh; none of systems whose heat is not computed.
    fn conduction(&self) -> Option<Conduction> {
        None
    }

    /// Velocities of the points of that mesh (m/s); none where they are not known.
    fn mesh_velocity(&self) -> Vec<S::Vector> {
        Vec::new()
    }

    /// Places of the points of that mesh at the start of the run, without load (m), of a body that
    /// travels as grains do; none of others, of which [`DeformedMesh::points`] stay where they are.
    fn mesh_at_start(&self) -> Vec<S::Vector> {
        Vec::new()
    }

    /// The surface that touches, for tractions along it; none of systems of which tractions are not
    /// known. Its points and facets stay the same over a run.
    fn touching_surface(&self) -> Option<TouchingSurface<S::Vector>> {
        None
    }

    /// Memory and cost of its solutions; `None` if unknown.
    fn size(&self) -> Option<SystemSize> {
        None
    }

    /// Whether the points that touch stand for equal areas in space, pi times the square of their
    /// radius, so that a force over its area is a traction. (In the plane it is for all.)
    fn has_equal_points(&self) -> bool {
        false
    }

    /// The largest strain and the largest rotation (rad) in it now, where it takes both for small;
    /// none of other systems.
    fn small_strain(&self) -> Option<[f64; 2]> {
        None
    }

    /// Where loads must stay away from the border of what can be loaded: the largest force there
    /// over the largest at all, in the last step.
    fn load_at_border(&self) -> Option<f64> {
        None
    }

    /// Its state between two steps, as bytes that [`Self::restore`] understands: coordinates,
    /// velocities, and what else the next step depends on.
    fn save(&self) -> Vec<u8>;

    /// Takes a state that the same system saved; false, and unchanged, where the bytes are none.
    #[must_use]
    fn restore(&mut self, saved: &[u8]) -> bool;

    /// A copy.
    fn clone_box(&self) -> Box<dyn DynamicalSystem<S>>;
}

/// The blocks P_a A^-1 P_b^T of some nodes of a system (1/kg), row by row, by solving for each
/// node.
pub fn compliance_by_solving<S: Space, T: DynamicalSystem<S> + ?Sized>(
    system: &T,
    nodes: &[u32],
) -> Vec<S::Matrix> {
    let points: Vec<Nodes> = nodes.iter().copied().map(Nodes::one).collect();
    point_compliance_by_solving(system, &points)
}

/// The blocks of some points that are sums of nodes (1/kg), row by row, by solving for each point.
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

/// Points are far fewer than the nodes that they are sums of where nodes are more than this times
/// as many: one solution for each point in each step is then cheaper than one for each node that is
/// kept, and needs no memory.
const FAR_FEWER: usize = 16;

/// Whether points are far fewer than the nodes that they are sums of.
pub(crate) fn far_fewer(points: usize, nodes: usize) -> bool {
    FAR_FEWER * points < nodes
}

/// The blocks of points that are sums of nodes (1/kg), row by row, from those of the nodes unless
/// these are many more.
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
    // From an impulse on a point to all nodes, point by point, and from there to the points.
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
