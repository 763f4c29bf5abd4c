//! Dynamical systems without their dimension.

use crate::bodies::{
    Conduction, Contactor, DeformedMesh, DynamicalSystem, Holder, SystemSize, SystemStep,
    TouchingSurface, padded,
};
use crate::geometry::space::{Space, VectorLike};
use nalgebra::Vector3;

/// A body that is more than rigid, for reading; see [`DynamicalSystem`], whose methods have the
/// same names.
pub trait SystemView {
    /// Returns the name in the case.
    fn name(&self) -> &str;
    /// Returns the number of generalised velocities.
    fn freedoms(&self) -> usize;
    /// Returns whether the system is a grain.
    fn is_grain(&self) -> bool;
    /// Returns a characteristic length (m).
    fn length(&self) -> f64;
    /// Returns the mass (kg; kg/m in 2D).
    fn mass(&self) -> f64;
    /// Returns whether the size can change with temperature.
    fn expands(&self) -> bool;
    /// Returns the mesh for the conduction of heat; `None` without one.
    fn conduction(&self) -> Option<Conduction>;
    /// Returns the parts that can touch.
    fn contactors(&self) -> Vec<Contactor>;
    /// Returns the holders.
    fn holders(&self) -> Vec<Holder>;
    /// Returns memory and cost of the solutions.
    fn size(&self) -> Option<SystemSize>;
    /// Returns the current mesh; `None` without one.
    fn deformed_mesh(&self) -> Option<DeformedMesh<Vector3<f64>>>;
    /// Returns the velocities of the points of that mesh (m/s); empty if unknown.
    fn mesh_velocity(&self) -> Vec<Vector3<f64>>;
    /// Returns the unloaded positions of the points of that mesh at the start of the run (m), for a
    /// body that travels, such as a grain; empty for others.
    fn mesh_at_start(&self) -> Vec<Vector3<f64>>;
    /// Returns the contact surface; `None` where tractions on it are unknown.
    fn touching_surface(&self) -> Option<TouchingSurface<Vector3<f64>>>;
    /// Returns the position of a node (m).
    fn node_position(&self, node: u32) -> Vector3<f64>;
    /// Returns whether the contact points have equal tributary areas in space.
    fn has_equal_points(&self) -> bool;
    /// Returns the current largest strain and largest rotation (rad), where the system assumes both
    /// to be small.
    fn small_strain(&self) -> Option<[f64; 2]>;
    /// Returns, where loads must stay away from the border of the loadable part, the largest force
    /// there relative to the largest force, in the last step.
    fn load_at_border(&self) -> Option<f64>;
    /// Returns the numbers of points and elements of the mesh; `None` without one.
    fn mesh_size(&self) -> Option<[usize; 2]>;
    /// Returns the number of points of the contact surface; 0 without one.
    fn surface_points(&self) -> usize;
    /// Returns a copy, to measure the cost of its solutions.
    fn trial(&self) -> Box<dyn SystemTrial + '_>;
}

/// A copy of a dynamical system at the start of a step, see [`SystemView::trial`].
pub trait SystemTrial {
    /// Begins the step and linearises, which includes a factorisation where the system has a
    /// factor.
    fn linearise(&mut self);
    /// Applies a unit impulse to every node of the contactors, along the last axis.
    fn push(&mut self);
    /// Solves once for these impulses.
    fn solve(&mut self);
}

/// A system in its dimension.
pub(super) struct SystemReader<'a, S: Space> {
    pub system: &'a dyn DynamicalSystem<S>,
    /// The next step.
    pub step: SystemStep<S>,
}

impl<S: Space> SystemView for SystemReader<'_, S> {
    fn name(&self) -> &str {
        self.system.name()
    }
    fn freedoms(&self) -> usize {
        self.system.freedoms()
    }
    fn is_grain(&self) -> bool {
        self.system.is_grain()
    }
    fn length(&self) -> f64 {
        self.system.length()
    }
    fn mass(&self) -> f64 {
        self.system.mass()
    }
    fn expands(&self) -> bool {
        self.system.expands()
    }
    fn conduction(&self) -> Option<Conduction> {
        self.system.conduction()
    }
    fn contactors(&self) -> Vec<Contactor> {
        self.system.contactors()
    }
    fn holders(&self) -> Vec<Holder> {
        self.system.holders()
    }
    fn size(&self) -> Option<SystemSize> {
        self.system.size()
    }
    fn deformed_mesh(&self) -> Option<DeformedMesh<Vector3<f64>>> {
        Some(self.system.deformed_mesh()?.padded())
    }
    fn mesh_velocity(&self) -> Vec<Vector3<f64>> {
        padded(&self.system.mesh_velocity())
    }
    fn mesh_at_start(&self) -> Vec<Vector3<f64>> {
        padded(&self.system.mesh_at_start())
    }
    fn touching_surface(&self) -> Option<TouchingSurface<Vector3<f64>>> {
        Some(self.system.touching_surface()?.padded())
    }
    fn node_position(&self, node: u32) -> Vector3<f64> {
        self.system.node_position(node).padded().into()
    }
    fn has_equal_points(&self) -> bool {
        self.system.has_equal_points()
    }
    fn small_strain(&self) -> Option<[f64; 2]> {
        self.system.small_strain()
    }
    fn load_at_border(&self) -> Option<f64> {
        self.system.load_at_border()
    }
    fn mesh_size(&self) -> Option<[usize; 2]> {
        let mesh = self.system.deformed_mesh()?;
        Some([mesh.points.len(), mesh.elements.len() / (S::D + 1)])
    }
    fn surface_points(&self) -> usize {
        self.system.touching_surface().map_or(0, |s| s.points.len())
    }
    fn trial(&self) -> Box<dyn SystemTrial + '_> {
        Box::new(Trial {
            copy: self.system.clone_box(),
            step: &self.step,
            impulse: vec![0.0; self.system.freedoms()],
        })
    }
}

struct Trial<'a, S: Space> {
    copy: Box<dyn DynamicalSystem<S>>,
    step: &'a SystemStep<S>,
    impulse: Vec<f64>,
}

impl<S: Space> SystemTrial for Trial<'_, S> {
    fn linearise(&mut self) {
        self.copy.begin_step(self.step);
        self.copy.linearise(self.step);
    }
    fn push(&mut self) {
        let mut push = S::Vector::zero();
        push[S::D - 1] = 1.0;
        for contactor in self.copy.contactors() {
            for (node, _) in contactor.nodes.terms() {
                self.copy.add_impulse(node, &push, &mut self.impulse);
            }
        }
    }
    fn solve(&mut self) {
        self.copy.solve(&mut self.impulse);
    }
}
