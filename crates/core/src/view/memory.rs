//! Memory of a simulation.

use crate::bodies::Bodies;
use crate::contact::Bond;
use crate::geometry::shape::Ball;
use crate::geometry::space::Space;
use crate::solve::Problem;
use crate::step::Simulation;

/// Memory of a grain and of a contact (bytes), from the sizes of their types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryUse {
    /// State and shape of a grain.
    pub grain: usize,
    /// A body in the solver.
    pub solver_body: usize,
    /// Memory of a contact in the sweep of the solver: without bonds and levers, with bonds, with
    /// levers, with both.
    pub rows: [usize; 4],
    /// Geometry and memory of a contact, and its place in the order of the sweep.
    pub contact: usize,
    /// A bond.
    pub bond: usize,
    /// Rotation of a bond, for laws that use it.
    pub turn: usize,
}

impl MemoryUse {
    pub(super) fn of<S: Space>() -> Self {
        Self {
            grain: Bodies::<S>::BYTES + size_of::<Ball<S>>() + size_of::<S::Vector>(),
            solver_body: Problem::<S>::BYTES_A_BODY,
            rows: Problem::<S>::BYTES_A_CONTACT,
            contact: Simulation::<S>::BYTES_A_CONTACT + Problem::<S>::BYTES_TO_SORT,
            bond: size_of::<Bond<S>>(),
            turn: size_of::<S::Spin>(),
        }
    }
}
