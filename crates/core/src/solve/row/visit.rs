//! Operations applied to every row in turn: several contacts at a time with vector instructions where
//! available, otherwise one by one, with bitwise identical results.

#[cfg(target_arch = "x86_64")]
use super::lanes::{self, Moving, Records, Tuple, Wide};
use super::{Row, SolverBodies, SolverBody};
use crate::geometry::space::{Space, VectorLike, least};
use crate::solve::error::{ROUNDINGS, Scale, Sums};

/// An operation on rows.
pub trait Visit {
    /// Whether to process two vector registers of contacts at a time in 3D, to hide latency.
    const TWO_REGISTERS: bool;

    /// Processes one row, the `at`-th of those visited.
    fn visit_row<S: Space, R: Row<S>>(
        &mut self,
        row: &mut R,
        solver_bodies: &SolverBodies<S>,
        at: usize,
    );

    /// Processes the rows from the `at`-th on, which share no movable body or are only read.
    ///
    /// # Safety
    /// Rows and records are valid, and nobody else writes them.
    #[cfg(target_arch = "x86_64")]
    unsafe fn visit_wide<W: Wide, const U: usize>(
        &mut self,
        rows: &Records<W, U>,
        a: &Records<SolverBody<W::Space>, U>,
        b: &Records<SolverBody<W::Space>, U>,
        at: usize,
    );
}

/// Visits a block of rows, given the starts of its groups and the end of the last; contacts of a group share
/// no movable body.
pub fn visit<S: Space, R: Row<S>>(
    rows: &mut [R],
    groups: &[u32],
    solver_bodies: &SolverBodies<S>,
    what: &mut impl Visit,
) {
    // Groups of a single contact would leave three of four lanes idle.
    #[cfg(target_arch = "x86_64")]
    if rows.len() >= 2 * groups.len() && lanes::visit(rows, groups, solver_bodies, what) {
        return;
    }
    for (at, row) in rows.iter_mut().enumerate() {
        what.visit_row(row, solver_bodies, at);
    }
}

/// Solves the contact for the current velocities, with the given relaxation, and updates the velocities.
pub struct Update(pub f64);

impl Visit for Update {
    const TWO_REGISTERS: bool = true;

    #[inline(always)]
    fn visit_row<S: Space, R: Row<S>>(
        &mut self,
        row: &mut R,
        solver_bodies: &SolverBodies<S>,
        _: usize,
    ) {
        solver_bodies.with(row.bodies(), |a, b| row.update(a, b, self.0));
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    unsafe fn visit_wide<W: Wide, const U: usize>(
        &mut self,
        rows: &Records<W, U>,
        a: &Records<SolverBody<W::Space>, U>,
        b: &Records<SolverBody<W::Space>, U>,
        _: usize,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let (mut i, mut j) = (Moving::load(a), Moving::load(b));
            W::updates(rows, &mut i, &mut j, lanes::Lanes::all(self.0));
            i.store(a);
            j.store(b);
        }
    }
}

/// Applies the stored impulse to the velocities.
pub struct Load;

impl Visit for Load {
    const TWO_REGISTERS: bool = true;

    #[inline(always)]
    fn visit_row<S: Space, R: Row<S>>(
        &mut self,
        row: &mut R,
        solver_bodies: &SolverBodies<S>,
        _: usize,
    ) {
        solver_bodies.with(row.bodies(), |a, b| row.load(a, b));
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    unsafe fn visit_wide<W: Wide, const U: usize>(
        &mut self,
        rows: &Records<W, U>,
        a: &Records<SolverBody<W::Space>, U>,
        b: &Records<SolverBody<W::Space>, U>,
        _: usize,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let (mut i, mut j) = (Moving::load(a), Moving::load(b));
            W::loads(rows, &mut i, &mut j);
            i.store(a);
            j.store(b);
        }
    }
}

/// Number of separate partial sums: the lanes of a vector register.
const APART: usize = 4;

/// Sums the contributions of contacts to the convergence test.
#[derive(Default)]
pub struct Measure {
    residual: [f64; APART],
    velocity: [f64; APART],
    impulse: [f64; APART],
    power: [f64; APART],
    unbalanced: [f64; APART],
    slip: [f64; APART],
    worst: [f64; APART],
    worst_at: [f64; APART],
}

impl Measure {
    /// Returns the sums; contacts are counted from `first`.
    pub fn sums(&self, first: usize) -> Sums {
        let mut out = Sums::default();
        for k in 0..APART {
            out.merge(&Sums {
                residual: self.residual[k],
                velocity: self.velocity[k],
                impulse: self.impulse[k],
                power: self.power[k],
                unbalanced: self.unbalanced[k],
                slip: self.slip[k],
                worst: self.worst[k],
                worst_at: first + self.worst_at[k] as usize,
                ..Sums::default()
            });
        }
        out
    }
}

impl Visit for Measure {
    const TWO_REGISTERS: bool = false;

    #[inline(always)]
    fn visit_row<S: Space, R: Row<S>>(
        &mut self,
        row: &mut R,
        solver_bodies: &SolverBodies<S>,
        at: usize,
    ) {
        let (a, b) = solver_bodies.read(row.bodies());
        let (r, k) = (row.residual(&a, &b), at % APART);
        self.residual[k] += r.squared;
        self.velocity[k] += r.velocity;
        self.impulse[k] += r.impulse;
        self.power[k] += r.power;
        self.unbalanced[k] += r.unbalanced;
        self.slip[k] += r.slip;
        if r.squared > self.worst[k] {
            self.worst[k] = r.squared;
            self.worst_at[k] = at as f64;
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    unsafe fn visit_wide<W: Wide, const U: usize>(
        &mut self,
        rows: &Records<W, U>,
        a: &Records<SolverBody<W::Space>, U>,
        b: &Records<SolverBody<W::Space>, U>,
        at: usize,
    ) {
        // SAFETY: as asked for.
        let r = unsafe { W::residuals(rows, &Moving::load(a), &Moving::load(b)) };
        r.squared.add_to(&mut self.residual);
        r.velocity.add_to(&mut self.velocity);
        r.impulse.add_to(&mut self.impulse);
        r.power.add_to(&mut self.power);
        r.unbalanced.add_to(&mut self.unbalanced);
        r.slip.add_to(&mut self.slip);
        r.squared.raise(&mut self.worst, &mut self.worst_at, at);
    }
}

/// Squared rounding of the relative velocity of a contact, by the squared velocities of its sides and its friction.
#[inline(always)]
pub fn noise(own: f64, friction: f64) -> f64 {
    let mu = least(friction, MAX_FRICTION);
    own * (1.0 + mu * mu) * ROUNDINGS
}

/// Sums the scales of the error from the free velocities, which are the current ones.
#[derive(Default)]
pub struct Free {
    free: [f64; APART],
    energy: [f64; APART],
    noise: [f64; APART],
}

/// The natural map multiplies the rounding error of a slip by mu; mu is capped here for that purpose.
const MAX_FRICTION: f64 = 1e6;

impl Free {
    /// Returns the sums.
    pub fn scale(&self) -> Scale {
        let [free, energy, noise] =
            [self.free, self.energy, self.noise].map(|x| (x[0] + x[1]) + (x[2] + x[3]));
        Scale {
            free,
            energy,
            noise,
            ..Scale::default()
        }
    }
}

impl Visit for Free {
    const TWO_REGISTERS: bool = false;

    #[inline(always)]
    fn visit_row<S: Space, R: Row<S>>(
        &mut self,
        row: &mut R,
        solver_bodies: &SolverBodies<S>,
        at: usize,
    ) {
        let (a, b) = solver_bodies.read(row.bodies());
        let (speed, k) = (row.speed(&a, &b), at % APART);
        self.free[k] += speed;
        self.energy[k] += row.rho() * speed;
        let own = a.v.dot(&a.v) + a.s.dot(&a.s) + b.v.dot(&b.v) + b.s.dot(&b.s);
        self.noise[k] += noise(own, row.friction());
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    unsafe fn visit_wide<W: Wide, const U: usize>(
        &mut self,
        rows: &Records<W, U>,
        a: &Records<SolverBody<W::Space>, U>,
        b: &Records<SolverBody<W::Space>, U>,
        _: usize,
    ) {
        // SAFETY: as asked for.
        unsafe {
            let (a, b) = (Moving::<W::Space, U>::load(a), Moving::load(b));
            let row = W::speeds(rows, &a, &b);
            row.speed.add_to(&mut self.free);
            (row.rho * row.speed).add_to(&mut self.energy);
            let own = a.v.dot(a.v) + a.s.dot(a.s) + b.v.dot(b.v) + b.s.dot(b.s);
            let mu = row.mu.min(lanes::Lanes::all(MAX_FRICTION));
            let one = lanes::Lanes::all(1.0);
            let noise = own * (one + mu * mu) * lanes::Lanes::all(ROUNDINGS);
            noise.add_to(&mut self.noise);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of all lanes; the worst contact is counted from the first one.
    #[test]
    fn sums_of_lanes_are_merged() {
        let measure = Measure {
            residual: [1.0, 2.0, 4.0, 8.0],
            slip: [16.0, 32.0, 64.0, 128.0],
            worst: [0.5, 0.75, 3.0, 1.0],
            worst_at: [0.0, 1.0, 6.0, 3.0],
            ..Measure::default()
        };
        let sums = measure.sums(10);
        assert_eq!((sums.residual, sums.slip), (15.0, 240.0));
        assert_eq!((sums.worst, sums.worst_at), (3.0, 16));
    }
}
