//! Velocities that several threads update at the same time.

use super::SolverBody;
use crate::geometry::space::Space;

/// Velocities reached by several threads, each at bodies of its own.
pub(in crate::solve) struct Lines<S: Space> {
    first: *mut SolverBody<S>,
    len: usize,
}

// SAFETY: contacts solved at the same time share no movable body (see `colour`), and lines of
// immovable bodies are read only; so no line is written while another thread reads or writes it.
unsafe impl<S: Space> Sync for Lines<S> {}

impl<S: Space> Lines<S> {
    pub fn new(lines: &mut [SolverBody<S>]) -> Self {
        Self {
            first: lines.as_mut_ptr(),
            len: lines.len(),
        }
    }

    /// The line of a body, for code that keeps to the rule of `Sync` by itself.
    #[inline(always)]
    pub fn at(&self, body: u32) -> *mut SolverBody<S> {
        debug_assert!((body as usize) < self.len);
        // SAFETY: indices are those of bodies pushed before the contact.
        unsafe { self.first.add(body as usize) }
    }

    /// Runs `f` on the lines of two bodies and stores those of movable bodies.
    #[inline(always)]
    pub fn with(&self, bodies: [u32; 2], f: impl FnOnce(&mut SolverBody<S>, &mut SolverBody<S>)) {
        debug_assert!(bodies[0] != bodies[1]);
        let [a, b] = bodies.map(|k| self.at(k));
        // SAFETY: see `Sync` above.
        unsafe {
            let (mut x, mut y) = (*a, *b);
            f(&mut x, &mut y);
            if x.im > 0.0 || x.is > 0.0 {
                (*a).v = x.v;
                (*a).s = x.s;
            }
            if y.im > 0.0 || y.is > 0.0 {
                (*b).v = y.v;
                (*b).s = y.s;
            }
        }
    }

    /// The same for one thread alone: stores both.
    #[inline(always)]
    pub fn alone(&self, bodies: [u32; 2], f: impl FnOnce(&mut SolverBody<S>, &mut SolverBody<S>)) {
        debug_assert!(bodies[0] != bodies[1]);
        let [a, b] = bodies.map(|k| self.at(k));
        // SAFETY: two bodies, and no other thread is at work.
        unsafe { f(&mut *a, &mut *b) }
    }

    #[inline(always)]
    pub fn read(&self, bodies: [u32; 2]) -> (SolverBody<S>, SolverBody<S>) {
        let [a, b] = bodies.map(|k| self.at(k));
        // SAFETY: nothing is written while errors are measured.
        unsafe { (*a, *b) }
    }
}
