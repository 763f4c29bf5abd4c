//! Interior-point method for the conic problem with the De Saxce correction.
//!
//! With r = (mu p_n, p_t) and v = (u_n / mu + |u_t|, u_t) the law reads: r, v in the Lorentz cone, r.v = 0
//! (De Saxce and Feng 1998). Primal-dual steps in Nesterov-Todd scaling solve it even if W is rank deficient
//! (Acary, Armand, Nguyen and Shpakovych 2024); here the term |u_t| is linearised as well. Mehrotra's
//! predictor-corrector chooses the centring.
//!
//! Where mu = 0 the cone is the half line: p_t = 0 is known, and the tangents have no rows in the system. A
//! bond is a block without a cone, u = 0; the normal part of a tension-only bond lies on the half line p_n
//! <= 0.

use super::block::Block;
use super::form::{Form, Shift, dot, largest};
use super::law::{Law, slip};
use super::state::{Best, Budget, Solver, State};

/// Smoothing of |v_t| relative to the value of v_t on the central path of a sticking contact.
const SMOOTH: f64 = 0.01;

/// Iterations without a smaller error before the iterate is moved away from the cone boundaries.
const STALLED: u32 = 15;

/// Moves the iterate away from the cone boundaries: one contact may reach its boundary, to rounding, long
/// before the others, and then the step length vanishes or the scaling breaks down.
struct Inwards {
    size_r: f64,
    size_v: f64,
    /// Remaining number of such moves.
    left: u32,
}

impl Inwards {
    /// Moves the iterate by the missing distance; returns whether it did.
    fn step<const D: usize>(
        &mut self,
        error: f64,
        cones: &[usize],
        r: &mut [[f64; D]],
        v: &mut [[f64; D]],
    ) -> bool {
        if self.left == 0 {
            return false;
        }
        self.left -= 1;
        let shift = (10.0 * error).min(0.1);
        for c in cones {
            r[*c][0] += shift * self.size_r;
            v[*c][0] += shift * self.size_v;
        }
        true
    }
}

/// The method.
#[derive(Clone, Copy, Debug, Default)]
pub struct Interior;

/// Returns x0^2 - |x1|^2.
fn determinant<const D: usize>(x: &[f64; D]) -> f64 {
    let t = slip(x);
    (x[0] - t) * (x[0] + t)
}

/// Returns the Jordan product.
fn product<const D: usize>(x: &[f64; D], y: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|k| {
        if k == 0 {
            (0..D).map(|i| x[i] * y[i]).sum()
        } else {
            x[0] * y[k] + y[0] * x[k]
        }
    })
}

/// Returns z with x o z = y.
fn divide<const D: usize>(x: &[f64; D], y: &[f64; D]) -> [f64; D] {
    let d = determinant(x);
    let cross: f64 = (1..D).map(|k| x[k] * y[k]).sum();
    let z0 = (x[0] * y[0] - cross) / d;
    std::array::from_fn(|k| {
        if k == 0 {
            z0
        } else {
            (y[k] - z0 * x[k]) / x[0]
        }
    })
}

/// Nesterov-Todd scaling: P r = P^-1 v.
struct Scaling<const D: usize> {
    eta: f64,
    w: [f64; D],
}

impl<const D: usize> Scaling<D> {
    fn new(r: &[f64; D], v: &[f64; D]) -> Self {
        let (dr, dv) = (determinant(r).max(1e-300), determinant(v).max(1e-300));
        let (a, b) = (1.0 / dr.sqrt(), 1.0 / dv.sqrt());
        let inner: f64 = (0..D).map(|k| r[k] * v[k]).sum::<f64>() * a * b;
        let gamma = (0.5 * (1.0 + inner)).sqrt();
        let w: [f64; D] = std::array::from_fn(|k| {
            let sign = if k == 0 { 1.0 } else { -1.0 };
            (v[k] * b + sign * r[k] * a) / (2.0 * gamma)
        });
        Self {
            eta: (dv / dr).powf(0.25),
            w,
        }
    }

    fn apply(&self, x: &[f64; D]) -> [f64; D] {
        let w = &self.w;
        let cross: f64 = (1..D).map(|k| w[k] * x[k]).sum();
        let along = x[0] + cross / (1.0 + w[0]);
        std::array::from_fn(|k| {
            self.eta
                * if k == 0 {
                    w[0] * x[0] + cross
                } else {
                    x[k] + along * w[k]
                }
        })
    }

    fn apply_inverse(&self, x: &[f64; D]) -> [f64; D] {
        let w = &self.w;
        let cross: f64 = (1..D).map(|k| w[k] * x[k]).sum();
        let along = -x[0] + cross / (1.0 + w[0]);
        std::array::from_fn(|k| {
            (if k == 0 {
                w[0] * x[0] - cross
            } else {
                x[k] + along * w[k]
            }) / self.eta
        })
    }

    /// Returns P^2 = eta^2 (2 w w^T - J).
    fn square(&self) -> Block<D> {
        let e = self.eta * self.eta;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let sign = if i != j {
                    0.0
                } else if i == 0 {
                    1.0
                } else {
                    -1.0
                };
                e * (2.0 * self.w[i] * self.w[j] - sign)
            })
        })
    }
}

/// Returns the largest t for which x + t d stays in the cone.
fn longest<const D: usize>(x: &[f64; D], d: &[f64; D]) -> f64 {
    let mut a = d[0] * d[0];
    let mut b = x[0] * d[0];
    let mut c = x[0] * x[0];
    for k in 1..D {
        a -= d[k] * d[k];
        b -= x[k] * d[k];
        c -= x[k] * x[k];
    }
    // Smallest positive root of a t^2 + 2 b t + c.
    let mut t = f64::INFINITY;
    let disc = b * b - a * c;
    if disc >= 0.0 {
        let q = -(b + b.signum() * disc.sqrt());
        for root in [q / a, c / q] {
            if root > 0.0 && root < t {
                t = root;
            }
        }
    }
    if d[0] < 0.0 {
        t = t.min(-x[0] / d[0]);
    }
    t
}

/// Increments of r and of v.
type Pair<const D: usize> = (Vec<[f64; D]>, Vec<[f64; D]>);

/// Fraction of the slope of |u_t| that is linearised: it is reduced, or set to zero, where it makes steps
/// short.
struct Slope {
    share: f64,
    /// Whether the fraction changes gradually, or only between all and nothing.
    gradual: bool,
    short: u32,
}

impl Slope {
    /// With bonds the full slope fails repeatedly: in the fretting case two steps of three are shorter than
    /// 1e-2 with all-or-nothing, and the error stays at 2e-4, where the gradual variant reaches 7e-5 in 70
    /// steps.
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
struct Part {
    /// Components in the cone: all for a contact with friction, one without friction or for a tension-only
    /// bond.
    cone: usize,
    /// Components with a row in the system.
    size: usize,
    /// Factor from the cone's axis to the normal: 1/mu, 1 without friction, -1 for a tension-only bond.
    over: f64,
}

impl Part {
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
    /// A sentence that names the first unsupported law.
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

impl<const D: usize> Solver<D> for Interior {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let n = form.len();
        let parts: Vec<Part> = form.laws.iter().map(Part::new::<D>).collect();
        let sizes: Vec<usize> = parts.iter().map(|part| part.size).collect();
        let over: Vec<f64> = parts.iter().map(|part| part.over).collect();
        // Starts well inside both cones, at the scale of the problem.
        let cones: Vec<usize> = (0..n).filter(|c| parts[*c].cone > 0).collect();
        let count = cones.len().max(1) as f64;
        let measured: Vec<usize> = if cones.is_empty() {
            (0..n).collect()
        } else {
            cones.clone()
        };
        let mean = |x: &dyn Fn(usize) -> f64| {
            measured.iter().map(|c| x(*c)).sum::<f64>() / measured.len() as f64
        };
        let mean_w = mean(&|c| form.w.diagonal(c)[0][0]);
        let squared = |x: &[f64; D]| x.iter().map(|x| x * x).sum::<f64>();
        let size_v = mean(&|c| squared(&form.q[c])).sqrt().max(1e-300);
        let size_r = size_v / mean_w;
        if !size_r.is_finite() || size_r <= 0.0 {
            // Nothing can move, or values are out of range.
            return;
        }
        let mut r = vec![[0.0; D]; n];
        let mut v = vec![[0.0; D]; n];
        for c in cones.iter().copied() {
            r[c][0] = size_r;
            v[c][0] = size_v;
        }
        let mut best = Best::of(state);
        let mut p = state.p.clone();
        let mut u = vec![[0.0; D]; n];
        let mut slope = Slope::new(cones.len() < n || parts.iter().any(|part| part.over < 0.0));
        let mut stalled = 0;
        let mut inwards = Inwards {
            size_r,
            size_v,
            left: 10,
        };
        while !budget.ends(state) {
            // Residual of v_n - u_n/mu - |v_t| = 0 and v_t - u_t = 0.
            p.copy_from_slice(&r);
            for c in 0..n {
                p[c][0] *= over[c];
            }
            form.velocity(&p, &mut u);
            let gap: f64 = dot(&r, &v) / count;
            let mut diagonal = vec![[[0.0; D]; D]; n];
            let mut tau = vec![[0.0; D]; n];
            let mut scalings = Vec::with_capacity(n);
            let mut residual = vec![[0.0; D]; n];
            for c in 0..n {
                if !parts[c].slides() {
                    residual[c] = std::array::from_fn(|k| v[c][k] - u[c][k]);
                    residual[c][0] = v[c][0] - u[c][0] * over[c];
                    let s = Scaling::new(&parts[c].of(&r[c]), &v[c]);
                    if parts[c].cone > 0 {
                        diagonal[c][0][0] = s.square()[0][0];
                    }
                    scalings.push(s);
                    continue;
                }
                let t = slip(&v[c]);
                let eps = SMOOTH * gap / r[c][0];
                let smooth = (t * t + eps * eps).sqrt();
                for k in 1..D {
                    tau[c][k] = slope.share * v[c][k] / smooth;
                    residual[c][k] = v[c][k] - u[c][k];
                }
                residual[c][0] = v[c][0] - u[c][0] * over[c] - smooth + eps;
                let s = Scaling::new(&r[c], &v[c]);
                let square = s.square();
                // A P^2 with A = I - e tau^T.
                diagonal[c] = square;
                for j in 0..D {
                    for k in 1..D {
                        diagonal[c][0][j] -= tau[c][k] * square[k][j];
                    }
                }
                scalings.push(s);
            }
            let Some(factor) = form.w.shifted(&Shift {
                s: &diagonal,
                sizes: &sizes,
                normal: &over,
            }) else {
                if inwards.step(best.error, &cones, &mut r, &mut v) {
                    continue;
                }
                break;
            };
            let direction = |d: &[[f64; D]]| -> Option<Pair<D>> {
                // (W + A P^2) dr = A P d + residual;  dv = P d - P^2 dr.
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
            };
            let longest_both = |dr: &[[f64; D]], dv: &[[f64; D]]| {
                let ends = |c: &usize| {
                    let part = |x: &[f64; D]| parts[*c].of(x);
                    let r = longest(&part(&r[*c]), &part(&dr[*c]));
                    (r, longest(&v[*c], &dv[*c]))
                };
                let most = (f64::INFINITY, f64::INFINITY);
                let nearer = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.min(c), b.min(d));
                cones.iter().map(ends).fold(most, nearer)
            };
            let lambda: Vec<[f64; D]> = (0..n)
                .map(|c| scalings[c].apply(&parts[c].of(&r[c])))
                .collect();
            let affine: Vec<[f64; D]> = lambda.iter().map(|l| l.map(|x| -x)).collect();
            let Some((dr, dv)) = direction(&affine) else {
                if inwards.step(best.error, &cones, &mut r, &mut v) {
                    continue;
                }
                break;
            };
            let (a, b) = longest_both(&dr, &dv);
            let (a, b) = (a.min(1.0), b.min(1.0));
            let t = a.min(b);
            let ahead: f64 = (0..n)
                .map(|c| {
                    (0..D)
                        .map(|k| (r[c][k] + t * dr[c][k]) * (v[c][k] + t * dv[c][k]))
                        .sum::<f64>()
                })
                .sum::<f64>()
                / count;
            let sigma = (ahead / gap).clamp(0.0, 1.0).powi(3).clamp(1e-6, 0.9);
            let corrected: Vec<[f64; D]> = (0..n)
                .map(|c| {
                    if parts[c].cone == 0 {
                        return [0.0; D];
                    }
                    let x = scalings[c].apply(&parts[c].of(&dr[c]));
                    let y = scalings[c].apply_inverse(&dv[c]);
                    let second = product(&x, &y);
                    let square = product(&lambda[c], &lambda[c]);
                    let right: [f64; D] = std::array::from_fn(|k| {
                        -square[k] - second[k] + if k == 0 { sigma * gap } else { 0.0 }
                    });
                    divide(&lambda[c], &right)
                })
                .collect();
            let Some((dr, dv)) = direction(&corrected) else {
                if inwards.step(best.error, &cones, &mut r, &mut v) {
                    continue;
                }
                break;
            };
            let (a, b) = longest_both(&dr, &dv);
            let keep = 1.0 - (0.1 * gap / (size_r * size_v)).clamp(1e-4, 0.1);
            let t = (keep * a).min(keep * b).min(1.0);
            for c in 0..n {
                for k in 0..D {
                    r[c][k] += t * dr[c][k];
                    v[c][k] += t * dv[c][k];
                }
            }
            state.iterations += 1;
            for c in 0..n {
                state.p[c] = r[c];
                state.p[c][0] *= over[c];
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
            if (t < 1e-10 || stalled > STALLED) && {
                stalled = 0;
                !inwards.step(best.error, &cones, &mut r, &mut v)
            } {
                break;
            }
        }
        best.restore(form, state);
    }
}
