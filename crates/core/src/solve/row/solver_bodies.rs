//! Velocities of bodies, which several threads update at the same time.

use crate::geometry::space::Space;

/// Velocity record of a body in the solver: 64 bytes in both dimensions.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct SolverBody<S: Space> {
    /// Velocity of the centre (m/s).
    pub v: S::Vector,
    /// Angular velocity times the body's length (m/s).
    pub s: S::Spin,
    /// Inverse mass, the largest of all axes (1/kg).
    pub im: f64,
    /// Inverse inertia times the length squared, the largest about any axis (1/kg).
    pub is: f64,
}

/// Velocities accessed by several threads, each at its own bodies.
///
/// Indices are not checked here, in the innermost loop, but when rows are created:
/// [`RigidBodies`](super::RigidBodies) looks up both bodies of each contact, which must differ, and
/// a problem never loses a body. Rows of moments are checked where they are used ([`Self::alone`]).
pub(in crate::solve) struct SolverBodies<S: Space> {
    first: *mut SolverBody<S>,
    len: usize,
}

// SAFETY: contacts solved at the same time share no movable body (see `colour`), and records of
// immovable bodies are only read; so no record is written while another thread accesses it.
unsafe impl<S: Space> Sync for SolverBodies<S> {}

impl<S: Space> SolverBodies<S> {
    pub fn new(solver_bodies: &mut [SolverBody<S>]) -> Self {
        Self {
            first: solver_bodies.as_mut_ptr(),
            len: solver_bodies.len(),
        }
    }

    /// Returns the record of a body, for code that itself satisfies the rule of `Sync`.
    #[inline(always)]
    pub fn at(&self, body: u32) -> *mut SolverBody<S> {
        debug_assert!((body as usize) < self.len);
        // SAFETY: the index was looked up when the row was made, see above.
        unsafe { self.first.add(body as usize) }
    }

    /// Runs `f` on the records of two bodies on a single thread; stores both.
    #[inline(always)]
    pub fn alone(&self, bodies: [u32; 2], f: impl FnOnce(&mut SolverBody<S>, &mut SolverBody<S>)) {
        assert!(bodies[0] != bodies[1] && bodies.iter().all(|b| (*b as usize) < self.len));
        let [a, b] = bodies.map(|k| self.at(k));
        // SAFETY: the two bodies differ, and no other thread is active.
        unsafe { f(&mut *a, &mut *b) }
    }

    #[inline(always)]
    pub fn read(&self, bodies: [u32; 2]) -> (SolverBody<S>, SolverBody<S>) {
        let [a, b] = bodies.map(|k| self.at(k));
        // SAFETY: nothing is written while errors are measured.
        unsafe { (*a, *b) }
    }
}
