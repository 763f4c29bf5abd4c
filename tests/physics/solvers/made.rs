//! Problems made from their solutions: impulses p and velocities u that satisfy the laws are drawn
//! first, then an operator W, and q = u - W p. The error is computed here independently from its
//! formula.

use fretwork::solve::error::Norm;
use fretwork::solve::local::block::BlockMatrix;
use fretwork::solve::local::law::Law;
use fretwork::solve::local::{Csr, LocalProblem};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A problem and the solution that it was made from.
pub struct Made<const D: usize> {
    pub w: DMatrix<f64>,
    pub q: Vec<f64>,
    pub laws: Vec<Law>,
    pub p: Vec<f64>,
    pub name: String,
}

pub fn rng(seed: u64) -> Pcg64 {
    Pcg64::seed_from_u64(seed)
}

fn number(rng: &mut Pcg64) -> f64 {
    rng.random_range(-1.0..1.0)
}

/// A vector of a given length in the tangents, in any direction.
fn tangent<const D: usize>(length: f64, rng: &mut Pcg64) -> [f64; D] {
    let mut t = [0.0; D];
    if D == 2 {
        t[1] = length.copysign(number(rng));
    } else {
        let angle = rng.random_range(0.0..std::f64::consts::TAU);
        (t[1], t[2]) = (length * angle.cos(), length * angle.sin());
    }
    t
}

/// Impulse and velocity that satisfy a law; `normals` are the normal impulses of the blocks before.
fn answer<const D: usize>(law: &Law, normals: &[f64], rng: &mut Pcg64) -> ([f64; D], [f64; D]) {
    let size = rng.random_range(0.1..1.0);
    let away = rng.random_range(0.1..1.0);
    let inside = rng.random_range(0.0..0.95);
    let (mut p, mut u) = ([0.0; D], [0.0; D]);
    let oppose = |p: &[f64; D], u: &mut [f64; D]| {
        for k in 1..D {
            u[k] = -away * p[k];
        }
    };
    match law {
        Law::Coulomb(mu) => match rng.random_range(0..3) {
            0 => {
                u = tangent(size, rng);
                u[0] = away;
            }
            1 => {
                p = tangent(inside * mu * size, rng);
                p[0] = size;
                if *mu == 0.0 {
                    u = tangent(away, rng);
                }
            }
            _ => {
                p = tangent(mu * size, rng);
                p[0] = size;
                if *mu == 0.0 {
                    u = tangent(away, rng);
                } else {
                    oppose(&p, &mut u);
                }
            }
        },
        Law::Cohesive { mu, cohesion } => {
            // The contact is open or pressed, and sticks or slides; cohesion holds an open contact
            // too.
            let pressed = rng.random_range(0..2) == 1;
            let slides = rng.random_range(0..2) == 1;
            let n = if pressed { size } else { 0.0 };
            let bound = mu * n + cohesion;
            p = tangent(if slides { bound } else { inside * bound }, rng);
            p[0] = n;
            if slides {
                oppose(&p, &mut u);
            }
            u[0] = if pressed { 0.0 } else { away };
        }
        Law::Free => p = std::array::from_fn(|_| number(rng)),
        Law::Pull => {
            p = std::array::from_fn(|_| number(rng));
            if rng.random_range(0..2) == 1 {
                p[0] = -size;
            } else {
                p[0] = 0.0;
                u[0] = -away;
            }
        }
        Law::Moment { of, twist, bend } => {
            let bound = normals[*of as usize];
            let rolls = rng.random_range(0..2) == 1;
            p = tangent(bend * bound * if rolls { 1.0 } else { inside }, rng);
            if rolls && bound > 0.0 {
                oppose(&p, &mut u);
            }
            let spins = rng.random_range(0..2) == 1;
            let sign = 1f64.copysign(number(rng));
            p[0] = sign * twist * bound * if spins { 1.0 } else { inside };
            u[0] = if spins { -sign * away } else { 0.0 };
        }
    }
    (p, u)
}

impl<const D: usize> Made<D> {
    /// Draws a solution of the laws and the corresponding free velocities.
    pub fn new(w: DMatrix<f64>, laws: Vec<Law>, name: String, rng: &mut Pcg64) -> Self {
        let (mut p, mut u, mut normals) = (Vec::new(), Vec::new(), Vec::new());
        // Impulses and velocities have equal size in the units of W.
        let count = w.nrows().max(1) as f64;
        let unit = w.trace() / count;
        let unit = if unit > 0.0 { unit } else { 1.0 };
        for law in &laws {
            let law = match *law {
                Law::Cohesive { mu, cohesion } => Law::Cohesive {
                    mu,
                    cohesion: cohesion * unit,
                },
                other => other,
            };
            let (pc, uc) = answer::<D>(&law, &normals, rng);
            normals.push(pc[0]);
            p.extend(pc.map(|x| x / unit));
            u.extend(uc);
        }
        let wp = &w * DVector::from_column_slice(&p);
        let q = u.iter().zip(wp.iter()).map(|(u, x)| u - x).collect();
        Self {
            w,
            q,
            laws,
            p,
            name,
        }
    }

    pub fn csr(&self) -> Csr {
        let n = self.w.nrows();
        let mut entries = Vec::new();
        for r in 0..n {
            for c in 0..n {
                if self.w[(r, c)] != 0.0 {
                    entries.push((r as u32, c as u32, self.w[(r, c)]));
                }
            }
        }
        Csr::from_triplets(n, n, &entries)
    }

    pub fn blocks(&self) -> BlockMatrix<D> {
        BlockMatrix::from_csr(&self.csr())
    }

    /// The problem in the form of an FCLIB file, of contacts with Coulomb's law.
    pub fn problem(&self) -> LocalProblem {
        LocalProblem {
            dimension: D,
            w: self.csr(),
            q: self.q.clone(),
            mu: self.laws.iter().map(Law::friction).collect(),
        }
    }

    pub fn free(&self) -> Vec<[f64; D]> {
        self.q.as_chunks().0.to_vec()
    }

    /// Returns the error of p by its formula: |r| / max(...), r = (p - proj(p - rho (u + mu |u_t|
    /// n))) / rho or the part that it misses of min(p_n/rho, u_n), mu^2/(1 + mu^2); in the FCLIB
    /// norm |r| / max(|u|, |q|) where that is above a half.
    pub fn error(&self, p: &[f64], norm: Norm) -> f64 {
        let u = &self.w * DVector::from_column_slice(p) + DVector::from_column_slice(&self.q);
        let (mut r2, mut p2, mut u2) = (0.0, 0.0, 0.0);
        for (c, law) in self.laws.iter().enumerate() {
            let at = c * D;
            let rho = match norm {
                Norm::Field => 1.0,
                _ => 1.0 / bound(&self.w.view((at, at), (D, D)).into_owned()),
            };
            let (pc, uc) = (&p[at..at + D], &u.as_slice()[at..at + D]);
            let slip = uc[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
            let mut z: Vec<f64> = (0..D).map(|k| pc[k] - rho * uc[k]).collect();
            z[0] -= rho * law.friction() * slip;
            let push = |of: u32| p[of as usize * D].max(0.0);
            let y = nearest(law, &z, push);
            let seen: f64 = (0..D).map(|k| ((pc[k] - y[k]) / rho).powi(2)).sum();
            let mu = law.friction();
            let lost = (pc[0] / rho).min(uc[0]) * mu * mu / (1.0 + mu * mu);
            r2 += if matches!(law, Law::Coulomb(_) | Law::Cohesive { .. }) {
                seen.max(lost * lost)
            } else {
                seen
            };
            for k in 0..D {
                p2 += (pc[k] / rho).powi(2);
                u2 += uc[k] * uc[k];
            }
        }
        let q2 = self.q.iter().map(|x| x * x).sum::<f64>();
        let most = match norm {
            Norm::Velocity => q2.max(u2),
            _ => q2.max(u2).max(p2),
        };
        let over = |scale: f64| (r2 / if scale > 0.0 { scale } else { 1.0 }).sqrt();
        match norm {
            Norm::Field => {
                over(most).max(Some(over(q2.max(u2))).filter(|r| *r > 0.5).unwrap_or(0.0))
            }
            _ => over(most),
        }
    }

    /// Error that impulses too large for the velocities may hide.
    pub fn rounding(&self, p: &[f64]) -> f64 {
        let sizes = self.w.abs() * DVector::from_column_slice(p).abs();
        let free = DVector::from_column_slice(&self.q).norm();
        f64::EPSILON * sizes.norm() / free.max(1e-300)
    }

    /// |p - p_made| / |p_made|.
    pub fn distance(&self, p: &[f64]) -> f64 {
        let made = DVector::from_column_slice(&self.p);
        (DVector::from_column_slice(p) - &made).norm() / made.norm().max(1e-300)
    }
}

/// Upper bound of the largest eigenvalue of a block: the largest absolute row sum of its symmetric
/// part.
fn bound(w: &DMatrix<f64>) -> f64 {
    let s = 0.5 * (w + w.transpose());
    s.row_iter()
        .map(|r| r.iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max)
}

/// Nearest admissible impulse, from the geometry in the half plane (normal, |tangent|).
fn nearest(law: &Law, z: &[f64], push: impl Fn(u32) -> f64) -> Vec<f64> {
    let t = z[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
    let at = |n: f64, length: f64| -> Vec<f64> {
        let scale = if t > 0.0 { length / t } else { 0.0 };
        std::iter::once(n)
            .chain(z[1..].iter().map(|x| x * scale))
            .collect()
    };
    let cone = |mu: f64, c: f64| {
        // The candidates are the point itself, the foot on the border, and the half disk at n = 0.
        let (n, s) = (z[0], t - c);
        if n >= 0.0 && s <= mu * n {
            return at(n, t);
        }
        let along = (n + mu * s) / (1.0 + mu * mu);
        if s > 0.0 && along > 0.0 {
            return at(along, mu * along + c);
        }
        at(0.0, t.min(c))
    };
    match law {
        Law::Coulomb(mu) => cone(*mu, 0.0),
        Law::Cohesive { mu, cohesion } => cone(*mu, *cohesion),
        Law::Free => z.to_vec(),
        Law::Pull => at(z[0].min(0.0), t),
        Law::Moment { of, twist, bend } => {
            let push = push(*of);
            at(z[0].clamp(-twist * push, twist * push), t.min(bend * push))
        }
    }
}

/// A symmetric matrix with eigenvalues from 1 to `condition`.
pub fn well(n: usize, condition: f64, rng: &mut Pcg64) -> DMatrix<f64> {
    let a = DMatrix::from_fn(n, n, |_, _| number(rng));
    let q = a.qr().q();
    let d = DVector::from_fn(n, |i, _| match i {
        0 => 1.0,
        1 => condition,
        _ => rng.random_range(1.0..=condition),
    });
    &q * DMatrix::from_diagonal(&d) * q.transpose()
}

/// H^T M^-1 H of free rigid bodies, where every contact is between two bodies, or a body and the
/// ground.
pub fn rigid<const D: usize>(bodies: usize, contacts: usize, rng: &mut Pcg64) -> DMatrix<f64> {
    let own = if D == 2 { 3 } else { 6 };
    let mut h = DMatrix::<f64>::zeros(bodies * own, contacts * D);
    for c in 0..contacts {
        // The first contacts reach every body.
        let a = if c < bodies {
            c
        } else {
            rng.random_range(0..bodies)
        };
        let b = rng.random_range(0..bodies);
        let frame = DMatrix::from_fn(D, D, |_, _| number(rng)).qr().q();
        let ground = a == b || rng.random_range(0..4) == 0;
        let pair = [(a, 1.0), (b, -1.0)];
        for (body, sign) in pair.into_iter().take(if ground { 1 } else { 2 }) {
            let arm: Vec<f64> = (0..D).map(|_| number(rng)).collect();
            for k in 0..D {
                let d: Vec<f64> = (0..D).map(|i| sign * frame[(i, k)]).collect();
                let turn = if D == 2 {
                    vec![arm[0] * d[1] - arm[1] * d[0]]
                } else {
                    vec![
                        arm[1] * d[2] - arm[2] * d[1],
                        arm[2] * d[0] - arm[0] * d[2],
                        arm[0] * d[1] - arm[1] * d[0],
                    ]
                };
                for (i, x) in d.into_iter().chain(turn).enumerate() {
                    h[(body * own + i, c * D + k)] += x;
                }
            }
        }
    }
    let mut inverse = DMatrix::<f64>::zeros(bodies * own, bodies * own);
    for b in 0..bodies {
        let mass: f64 = rng.random_range(0.5..2.0);
        for i in 0..D {
            inverse[(b * own + i, b * own + i)] = 1.0 / mass;
        }
        let turns = own - D;
        let a = DMatrix::from_fn(turns, turns, |_, _| number(rng));
        let inertia = 0.2 * mass * (DMatrix::identity(turns, turns) + &a * a.transpose());
        let inertia = inertia.try_inverse().expect("positive");
        inverse
            .view_mut((b * own + D, b * own + D), (turns, turns))
            .copy_from(&inertia);
    }
    h.transpose() * inverse * h
}

/// Blocks of separate contacts.
pub fn apart<const D: usize>(contacts: usize, rng: &mut Pcg64) -> DMatrix<f64> {
    let mut w = DMatrix::<f64>::zeros(contacts * D, contacts * D);
    for c in 0..contacts {
        w.view_mut((c * D, c * D), (D, D))
            .copy_from(&well(D, 3.0, rng));
    }
    w
}

/// Returns W plus an unsymmetric part of a relative size.
pub fn twisted(w: &DMatrix<f64>, size: f64, rng: &mut Pcg64) -> DMatrix<f64> {
    let n = w.nrows();
    let mean = w.norm() / (n.max(1) as f64);
    let noise = DMatrix::from_fn(n, n, |_, _| number(rng) * size * mean);
    w + (&noise - noise.transpose())
}

/// Friction coefficients: one for all contacts, or none for every third contact.
pub fn friction(contacts: usize, mu: f64, mixed: bool) -> Vec<Law> {
    (0..contacts)
        .map(|c| Law::Coulomb(if mixed && c % 3 == 0 { 0.0 } else { mu }))
        .collect()
}
