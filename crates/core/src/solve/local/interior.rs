//! Interior-point method for the conic problem with the De Saxce correction.
//!
//! With r = (mu p_n, p_t) and v = (u_n / mu + |u_t|, u_t) the law reads: r, v in the Lorentz cone,
//! r.v = 0 (De Saxce and Feng 1998). Primal-dual steps in Nesterov-Todd scaling solve it even if W
//! is rank deficient (Acary, Armand, Nguyen and Shpakovych 2024); here the term |u_t| is linearised
//! as well. Mehrotra's predictor-corrector chooses the centring.
//!
//! Where mu = 0 the cone is the half line: p_t = 0 is known, and the tangents have no rows in the
//! system. A bond is a block without a cone, u = 0; the normal part of a tension-only bond lies on
//! the half line p_n
//! <= 0.

use super::block::Block;
use super::factored::{Shift, Shifted};
use super::form::{Form, dot, largest};
use super::law::{Law, slip};
use super::lorentz::{Scaling, divide, longest_step, product};
use super::state::{Best, Budget, Iteration, Solver};

/// Smoothing of |v_t| relative to the value of v_t on the central path of a sticking contact.
const SMOOTH: f64 = 0.01;

/// Iterations without a smaller error before the iterate is moved away from the cone boundaries.
const STALLED: u32 = 15;

/// Moves the iterate away from the cone boundaries: one contact may reach its boundary, to
/// rounding, long before the others, and then the step length vanishes or the scaling breaks down.
struct Recentring {
    /// Magnitudes of r and of v.
    magnitudes: [f64; 2],
    /// Remaining number of moves away from the boundaries.
    left: u32,
}

impl Recentring {
    /// Moves the iterate by the missing distance; returns whether it did.
    fn step<const D: usize>(
        &mut self,
        error: f64,
        cones: &Cones,
        iterate: &mut Iterate<D>,
    ) -> bool {
        if self.left == 0 {
            return false;
        }
        self.left -= 1;
        let shift = (10.0 * error).min(0.1);
        let [size_r, size_v] = self.magnitudes;
        for c in &cones.blocks {
            iterate.r[*c][0] += shift * size_r;
            iterate.v[*c][0] += shift * size_v;
        }
        true
    }
}

/// The method.
#[derive(Clone, Copy, Debug, Default)]
pub struct Interior;

/// Increments of r and of v.
type Increments<const D: usize> = (Vec<[f64; D]>, Vec<[f64; D]>);

/// Fraction of the slope of |u_t| that is linearised: it is reduced, or set to zero, where it makes
/// steps short.
struct Slope {
    share: f64,
    /// Whether the fraction changes gradually, or only between all and nothing.
    gradual: bool,
    short: u32,
}

impl Slope {
    /// With bonds the full slope fails repeatedly: in the fretting case two steps of three are
    /// shorter than 1e-2 if the fraction is only 0 or 1, and the error stays at 2e-4, while the
    /// gradual variant reaches 7e-5 in 70 steps.
    fn new(gradual: bool) -> Self {
        Self {
            share: 1.0,
            gradual,
            short: 0,
        }
    }

    /// Updates the fraction after a step of length t.
    fn follow(&mut self, t: f64) {
        const SHORT: f64 = 0.1;
        const LONG: f64 = 0.5;
        self.short = if t < SHORT { self.short + 1 } else { 0 };
        self.share = match (self.gradual, self.short) {
            (false, 0 | 1) => 1.0,
            (false, _) => 0.0,
            (true, 0) if t > LONG => (2.0 * self.share + 0.05).min(1.0),
            (true, 0) => self.share,
            (true, _) => 0.3 * self.share,
        };
    }
}

/// A block in the method: its first components lie in a Lorentz cone, the others are free with zero
/// velocity.
#[derive(Clone, Copy, Debug)]
struct ConeBlock {
    /// Number of components in the cone: all components for a contact with friction, one without
    /// friction or for a tension-only bond.
    cone: usize,
    /// Number of components with a row in the system.
    size: usize,
    /// Factor from the cone's axis to the normal: 1/mu, 1 without friction, -1 for a tension-only
    /// bond.
    over: f64,
}

impl ConeBlock {
    fn new<const D: usize>(law: &Law) -> Self {
        let (cone, size, over) = match law {
            Law::Free => (0, D, 1.0),
            Law::Pull => (1, D, -1.0),
            law if law.friction() > 0.0 => (D, D, 1.0 / law.friction()),
            _ => (1, 1, 1.0),
        };
        Self { cone, size, over }
    }

    /// Returns whether slip shifts the cone of velocities.
    fn slides(&self) -> bool {
        self.cone > 1
    }

    /// Returns the components in the cone, padded with zeros.
    #[inline(always)]
    fn of<const D: usize>(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|k| if k < self.cone { x[k] } else { 0.0 })
    }
}

impl Interior {
    /// Checks that the method supports the law of every block.
    ///
    /// # Errors
    /// Returns a sentence that names the first unsupported law.
    pub fn serves(laws: &[Law]) -> Result<(), String> {
        let known = |law: &Law| matches!(law, Law::Coulomb(_) | Law::Free | Law::Pull);
        let other = laws.iter().position(|law| !known(law));
        match other {
            None => Ok(()),
            Some(block) => Err(format!(
                "the interior point supports Coulomb's law and bonds, but block {block} has another law: {:?}",
                laws[block]
            )),
        }
    }
}

/// The cones of the blocks of a problem.
struct Cones {
    parts: Vec<ConeBlock>,
    /// Number of components of each block with a row in the system.
    sizes: Vec<usize>,
    /// Factor from the axis of each cone to the normal.
    over: Vec<f64>,
    /// Indices of the blocks with a cone.
    blocks: Vec<usize>,
}

impl Cones {
    fn new<const D: usize>(laws: &[Law]) -> Self {
        let parts: Vec<ConeBlock> = laws.iter().map(ConeBlock::new::<D>).collect();
        Self {
            sizes: parts.iter().map(|part| part.size).collect(),
            over: parts.iter().map(|part| part.over).collect(),
            blocks: (0..parts.len()).filter(|c| parts[*c].cone > 0).collect(),
            parts,
        }
    }

    fn count(&self) -> f64 {
        self.blocks.len().max(1) as f64
    }

    /// Returns whether a block is a bond.
    fn any_bond(&self) -> bool {
        self.blocks.len() < self.parts.len() || self.parts.iter().any(|part| part.over < 0.0)
    }

    /// Returns the magnitudes of r and of v in a problem; `None` if nothing can move, or values are
    /// out of range.
    fn magnitudes<const D: usize>(&self, form: &Form<D>) -> Option<[f64; 2]> {
        let measured: Vec<usize> = if self.blocks.is_empty() {
            (0..form.len()).collect()
        } else {
            self.blocks.clone()
        };
        let mean = |x: &dyn Fn(usize) -> f64| {
            measured.iter().map(|c| x(*c)).sum::<f64>() / measured.len() as f64
        };
        let mean_w = mean(&|c| form.w.diagonal(c)[0][0]);
        let squared = |x: &[f64; D]| x.iter().map(|x| x * x).sum::<f64>();
        let size_v = mean(&|c| squared(&form.q[c])).sqrt().max(1e-300);
        let size_r = size_v / mean_w;
        (size_r.is_finite() && size_r > 0.0).then_some([size_r, size_v])
    }
}

/// The iterate: r and v of every block.
struct Iterate<const D: usize> {
    r: Vec<[f64; D]>,
    v: Vec<[f64; D]>,
}

impl<const D: usize> Iterate<D> {
    /// Returns an iterate on the axes of all cones.
    fn on_axes(cones: &Cones, [size_r, size_v]: [f64; 2]) -> Self {
        let zero = vec![[0.0; D]; cones.parts.len()];
        let mut iterate = Self {
            r: zero.clone(),
            v: zero,
        };
        for c in cones.blocks.iter().copied() {
            iterate.r[c][0] = size_r;
            iterate.v[c][0] = size_v;
        }
        iterate
    }

    /// Computes the impulses p of r.
    fn impulses(&self, cones: &Cones, p: &mut [[f64; D]]) {
        p.copy_from_slice(&self.r);
        for (p, over) in p.iter_mut().zip(&cones.over) {
            p[0] *= over;
        }
    }

    fn advance(&mut self, t: f64, (dr, dv): &Increments<D>) {
        for c in 0..self.r.len() {
            for k in 0..D {
                self.r[c][k] += t * dr[c][k];
                self.v[c][k] += t * dv[c][k];
            }
        }
    }
}

/// The equations v_n - u_n/mu - |v_t| = 0 and v_t - u_t = 0, linearised at an iterate.
struct Linearised<'a, const D: usize> {
    cones: &'a Cones,
    at: &'a Iterate<D>,
    /// Mean of r.v over the cones.
    gap: f64,
    /// Residual of the equations.
    residual: Vec<[f64; D]>,
    /// Derivative of the smoothed |v_t|.
    tau: Vec<[f64; D]>,
    scalings: Vec<Scaling<D>>,
    /// A P^2 with A = I - e tau^T.
    diagonal: Vec<Block<D>>,
}

impl<'a, const D: usize> Linearised<'a, D> {
    /// Linearises at an iterate with the velocities `u` of its impulses; `share` is the fraction of
    /// the slope of
    /// |u_t| that is taken.
    fn new(cones: &'a Cones, at: &'a Iterate<D>, u: &[[f64; D]], share: f64) -> Self {
        let n = u.len();
        let mut system = Self {
            cones,
            at,
            gap: dot(&at.r, &at.v) / cones.count(),
            residual: vec![[0.0; D]; n],
            tau: vec![[0.0; D]; n],
            scalings: Vec::with_capacity(n),
            diagonal: vec![[[0.0; D]; D]; n],
        };
        for (c, u) in u.iter().enumerate() {
            if cones.parts[c].slides() {
                system.add_sliding(c, u, share);
            } else {
                system.add_without_slip(c, u);
            }
        }
        system
    }

    /// Adds a block without friction.
    fn add_without_slip(&mut self, c: usize, u: &[f64; D]) {
        let (r, v, part) = (&self.at.r[c], &self.at.v[c], &self.cones.parts[c]);
        self.residual[c] = std::array::from_fn(|k| v[k] - u[k]);
        self.residual[c][0] = v[0] - u[0] * part.over;
        let scaling = Scaling::new(&part.of(r), v);
        if part.cone > 0 {
            self.diagonal[c][0][0] = scaling.square()[0][0];
        }
        self.scalings.push(scaling);
    }

    /// Adds a contact with friction.
    fn add_sliding(&mut self, c: usize, u: &[f64; D], share: f64) {
        let (r, v, over) = (&self.at.r[c], &self.at.v[c], self.cones.over[c]);
        let t = slip(v);
        let eps = SMOOTH * self.gap / r[0];
        let smooth = (t * t + eps * eps).sqrt();
        let (tau, residual) = (&mut self.tau[c], &mut self.residual[c]);
        for k in 1..D {
            tau[k] = share * v[k] / smooth;
            residual[k] = v[k] - u[k];
        }
        residual[0] = v[0] - u[0] * over - smooth + eps;
        let scaling = Scaling::new(r, v);
        let square = scaling.square();
        let diagonal = &mut self.diagonal[c];
        *diagonal = square;
        for j in 0..D {
            for k in 1..D {
                diagonal[0][j] -= tau[k] * square[k][j];
            }
        }
        self.scalings.push(scaling);
    }

    /// Solves (W + A P^2) dr = A P d + residual, dv = P d - P^2 dr; `None` if the solution is not
    /// finite.
    fn direction(&self, factor: &dyn Shifted<D>, d: &[[f64; D]]) -> Option<Increments<D>> {
        let (n, parts) = (d.len(), &self.cones.parts);
        let (scalings, residual, tau) = (&self.scalings, &self.residual, &self.tau);
        let pd: Vec<[f64; D]> = (0..n)
            .map(|c| parts[c].of(&scalings[c].apply(&d[c])))
            .collect();
        let mut dr: Vec<[f64; D]> = (0..n)
            .map(|c| {
                std::array::from_fn(|k| {
                    let mut x = pd[c][k] + residual[c][k];
                    if k == 0 {
                        for j in 1..D {
                            x -= tau[c][j] * pd[c][j];
                        }
                    }
                    x
                })
            })
            .collect();
        if !factor.solve(&mut dr) {
            return None;
        }
        let dv = (0..n)
            .map(|c| {
                let back = scalings[c].apply(&scalings[c].apply(&parts[c].of(&dr[c])));
                parts[c].of(&std::array::from_fn(|k| pd[c][k] - back[k]))
            })
            .collect();
        Some((dr, dv))
    }

    /// Returns the largest steps for which r and v stay in their cones.
    fn longest_steps(&self, (dr, dv): &Increments<D>) -> (f64, f64) {
        let Iterate { r, v } = self.at;
        let ends = |c: &usize| {
            let part = |x: &[f64; D]| self.cones.parts[*c].of(x);
            let longest_r = longest_step(&part(&r[*c]), &part(&dr[*c]));
            (longest_r, longest_step(&v[*c], &dv[*c]))
        };
        let unbounded = (f64::INFINITY, f64::INFINITY);
        let nearer = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.min(c), b.min(d));
        self.cones.blocks.iter().map(ends).fold(unbounded, nearer)
    }

    /// Returns the centring parameter that the predictor suggests: the cube of the fraction of r.v
    /// that would be left at the end of its longest step.
    fn centring(&self, predictor: &Increments<D>) -> f64 {
        let (a, b) = self.longest_steps(predictor);
        let (a, b) = (a.min(1.0), b.min(1.0));
        let t = a.min(b);
        let ((dr, dv), Iterate { r, v }) = (predictor, self.at);
        let ahead: f64 = (0..r.len())
            .map(|c| {
                (0..D)
                    .map(|k| (r[c][k] + t * dr[c][k]) * (v[c][k] + t * dv[c][k]))
                    .sum::<f64>()
            })
            .sum::<f64>()
            / self.cones.count();
        (ahead / self.gap).clamp(0.0, 1.0).powi(3).clamp(1e-6, 0.9)
    }

    /// Returns the right-hand side of the corrector: centring, and the second-order term of the
    /// predictor.
    fn corrected(&self, lambda: &[[f64; D]], predictor: &Increments<D>) -> Vec<[f64; D]> {
        let sigma = self.centring(predictor);
        let ((dr, dv), parts) = (predictor, &self.cones.parts);
        (0..lambda.len())
            .map(|c| {
                if parts[c].cone == 0 {
                    return [0.0; D];
                }
                let x = self.scalings[c].apply(&parts[c].of(&dr[c]));
                let y = self.scalings[c].apply_inverse(&dv[c]);
                let second = product(&x, &y);
                let square = product(&lambda[c], &lambda[c]);
                let right: [f64; D] = std::array::from_fn(|k| {
                    -square[k] - second[k] + if k == 0 { sigma * self.gap } else { 0.0 }
                });
                divide(&lambda[c], &right)
            })
            .collect()
    }

    /// Returns a predictor-corrector step and its length; `None` if a system cannot be solved.
    fn step(&self, form: &Form<D>, [size_r, size_v]: [f64; 2]) -> Option<(f64, Increments<D>)> {
        let factor = form.w.shifted(&Shift {
            s: &self.diagonal,
            sizes: &self.cones.sizes,
            normal: &self.cones.over,
        })?;
        let lambda: Vec<[f64; D]> = (0..form.len())
            .map(|c| self.scalings[c].apply(&self.cones.parts[c].of(&self.at.r[c])))
            .collect();
        let affine: Vec<[f64; D]> = lambda.iter().map(|l| l.map(|x| -x)).collect();
        let predictor = self.direction(factor.as_ref(), &affine)?;
        let corrected = self.corrected(&lambda, &predictor);
        let increments = self.direction(factor.as_ref(), &corrected)?;
        let (a, b) = self.longest_steps(&increments);
        let keep = 1.0 - (0.1 * self.gap / (size_r * size_v)).clamp(1e-4, 0.1);
        Some(((keep * a).min(keep * b).min(1.0), increments))
    }
}

impl<const D: usize> Solver<D> for Interior {
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        let cones = Cones::new::<D>(form.laws);
        let Some(magnitudes) = cones.magnitudes(form) else {
            return;
        };
        let mut iterate = Iterate::on_axes(&cones, magnitudes);
        let mut best = Best::of(state);
        let mut p = state.p.clone();
        let mut u = vec![[0.0; D]; form.len()];
        let mut slope = Slope::new(cones.any_bond());
        let mut stalled = 0;
        let mut inwards = Recentring {
            magnitudes,
            left: 10,
        };
        while !budget.ends(state) {
            iterate.impulses(&cones, &mut p);
            form.velocity(&p, &mut u);
            let step = Linearised::new(&cones, &iterate, &u, slope.share).step(form, magnitudes);
            let Some((t, increments)) = step else {
                if inwards.step(best.error, &cones, &mut iterate) {
                    continue;
                }
                break;
            };
            iterate.advance(t, &increments);
            state.iterations += 1;
            iterate.impulses(&cones, &mut state.p);
            for c in 0..form.len() {
                if largest(form.w.diagonal(c)) == 0.0 {
                    // Both bodies are immovable: the impulse would grow without bound.
                    state.p[c] = [0.0; D];
                }
            }
            state.measure(form);
            stalled = if state.error < 0.9 * best.error {
                0
            } else {
                stalled + 1
            };
            best.keep(state);
            slope.follow(t);
            if t < 1e-10 || stalled > STALLED {
                stalled = 0;
                if !inwards.step(best.error, &cones, &mut iterate) {
                    break;
                }
            }
        }
        best.restore(form, state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With bonds the fraction of the slope decreases to 0.3 after a short step, and about doubles
    /// after a long one; without bonds it is 0 or 1.
    #[test]
    fn the_slope_follows_the_length_of_steps() {
        let shares = |gradual| {
            let mut slope = Slope::new(gradual);
            [0.05, 0.05, 0.3, 0.8, 0.8, 0.8, 0.8].map(|t| {
                slope.follow(t);
                slope.share
            })
        };
        let wanted = [0.3, 0.09, 0.09, 0.23, 0.51, 1.0, 1.0];
        let found = shares(true);
        let near = found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near, "{found:?}");
        assert_eq!(shares(false), [1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    }
}
