//! Exact solution of one contact with its own block of W: p with u = W_cc p + f under Coulomb's
//! law.
//!
//! In 2D the law has four branches, each a linear equation. In 3D slip is the root of a scalar
//! equation, see [`crate::solve::slide`].

use super::block::{Block, times};
use super::form::largest;
use super::law::Law;
use crate::solve::slide::{schur, slide};
use std::hint::select_unpredictable;

/// Precomputed data for the exact solution of a contact.
#[derive(Clone, Copy, Debug)]
pub struct Local<const D: usize> {
    w: Block<D>,
    inverse: Block<D>,
    mu: f64,
    /// In 2D: 1 / (W_nn - s mu W_nt) for s = 1 and -1, the compliance in slip.
    slides: [f64; 2],
    lambda: f64,
}

impl<const D: usize> Local<D> {
    /// Precomputes the data from the diagonal block and the friction coefficient.
    pub fn new(w: &Block<D>, mu: f64) -> Self {
        let (schur, determinant) = schur(w);
        let iwnn = if w[0][0] > 0.0 { 1.0 / w[0][0] } else { 0.0 };
        let mut inverse = [[0.0; D]; D];
        if determinant > 0.0 && iwnn > 0.0 {
            // Inverse of a block matrix by its Schur complement.
            let s = if D == 2 {
                [[1.0 / schur[0][0], 0.0], [0.0, 0.0]]
            } else {
                let d = 1.0 / determinant;
                [
                    [schur[1][1] * d, -schur[0][1] * d],
                    [-schur[1][0] * d, schur[0][0] * d],
                ]
            };
            inverse[0][0] = iwnn;
            for i in 1..D {
                for j in 1..D {
                    inverse[i][j] = s[i - 1][j - 1];
                    inverse[0][j] -= iwnn * w[0][i] * s[i - 1][j - 1];
                    inverse[i][0] -= s[i - 1][j - 1] * w[j][0] * iwnn;
                }
            }
            for i in 1..D {
                inverse[0][0] -= inverse[0][i] * w[i][0] * iwnn;
            }
        }
        Self {
            w: *w,
            inverse,
            mu,
            slides: if D == 2 {
                [mu, -mu].map(|s| 1.0 / (w[0][0] - s * w[0][1]))
            } else {
                [0.0; 2]
            },
            lambda: 0.0,
        }
    }

    /// Returns W_cc^-1, which gives the impulse of a contact that sticks; zero if W_cc is singular.
    pub fn held(&self) -> Block<D> {
        self.inverse
    }

    /// Returns the impulse for the free velocity `f` of this contact.
    #[inline(always)]
    pub fn solve(&mut self, f: &[f64; D]) -> [f64; D] {
        if D == 2 {
            self.solve_plane(f)
        } else {
            self.solve_space(f)
        }
    }

    /// Solves in 2D: all four branches are computed and one is selected, because branch prediction
    /// would fail.
    #[inline(always)]
    fn solve_plane(&self, f: &[f64; D]) -> [f64; D] {
        let stick = times(&self.inverse, f);
        // Slip: p_t = -s mu p_n, where s is the sign of u_t, which equals the sign of the missing
        // impulse.
        let [forth, back] = self.slides.map(|x| -f[0] * x);
        let negative = stick[1].is_sign_negative();
        let n = select_unpredictable(negative, back, forth);
        let t = select_unpredictable(negative, self.mu * back, -self.mu * forth);
        let sticks = stick[0] < 0.0 && stick[1].abs() <= -self.mu * stick[0];
        let n = select_unpredictable(sticks, -stick[0], n);
        let t = select_unpredictable(sticks, -stick[1], t);
        let closed = f[0] < 0.0 && self.w[0][0] > 0.0;
        let mut p = [0.0; D];
        p[0] = select_unpredictable(closed, n.max(0.0), 0.0);
        p[1] = select_unpredictable(closed && n > 0.0, t, 0.0);
        p
    }

    #[inline(always)]
    fn solve_space(&mut self, f: &[f64; D]) -> [f64; D] {
        let mu = self.mu;
        let mut p = [0.0; D];
        if f[0] >= 0.0 || self.w[0][0] <= 0.0 {
            return p;
        }
        if mu == 0.0 {
            p[0] = -f[0] / self.w[0][0];
            return p;
        }
        let stick = times(&self.inverse, f);
        if stick[0] < 0.0 {
            let squared: f64 = stick[1..].iter().map(|x| x * x).sum();
            if squared <= mu * mu * stick[0] * stick[0] {
                return stick.map(|x| -x);
            }
        }
        let (found, lambda) = slide(&self.w, f, mu, self.lambda, true);
        self.lambda = lambda;
        p.copy_from_slice(&found[..D]);
        p
    }

    /// Solves the other laws by projected iterations with the block's own step length; none of them
    /// couples its directions strongly. `start` is the initial value, `all` holds the impulses on
    /// which bounds may depend.
    pub fn solve_rare(
        &self,
        f: &[f64; D],
        law: &Law,
        start: &[f64; D],
        all: &[[f64; D]],
    ) -> [f64; D] {
        const ROUNDS: usize = 20;
        let rho = 1.0 / largest(&self.w);
        let mut p = *start;
        if matches!(law, Law::Free | Law::Pull) && self.inverse != [[0.0; D]; D] {
            let held = times(&self.inverse, f).map(|x| -x);
            if *law == Law::Free || held[0] <= 0.0 {
                return held;
            }
            if let Some(slack) = self.slack(f) {
                return slack;
            }
        }
        if !rho.is_finite() {
            return p;
        }
        for _ in 0..ROUNDS {
            let u: [f64; D] = {
                let wp = times(&self.w, &p);
                std::array::from_fn(|k| wp[k] + f[k])
            };
            let r = law.natural(&p, &u, rho, all);
            let mut change = 0.0;
            for k in 0..D {
                p[k] -= r[k];
                change += r[k].abs();
            }
            if change <= 1e-15 * p.iter().map(|x| x.abs()).sum::<f64>() {
                break;
            }
        }
        p
    }

    /// Returns the solution without normal impulse and without slip; `None` if the tangential block
    /// is singular.
    fn slack(&self, f: &[f64; D]) -> Option<[f64; D]> {
        let (w, mut p) = (&self.w, [0.0; D]);
        if D == 2 {
            p[1] = -f[1] / w[1][1];
        } else {
            let d = w[1][1] * w[2][2] - w[1][2] * w[2][1];
            p[1] = (w[1][2] * f[2] - w[2][2] * f[1]) / d;
            p[2] = (w[2][1] * f[1] - w[1][1] * f[2]) / d;
        }
        p.iter().all(|x| x.is_finite()).then_some(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::local::law::slip;
    use rand::{RngExt, SeedableRng};

    /// Residual: the natural map with rho = 1.
    fn residual<const D: usize>(w: &Block<D>, f: &[f64; D], p: &[f64; D], mu: f64) -> f64 {
        let mut u = times(w, p);
        for k in 0..D {
            u[k] += f[k];
        }
        let slip = u[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
        let z: [f64; D] =
            std::array::from_fn(|k| p[k] - u[k] - if k == 0 { mu * slip } else { 0.0 });
        let y = crate::solve::cone::project_array(&z, mu, 0.0);
        (0..D).map(|k| (p[k] - y[k]).powi(2)).sum::<f64>().sqrt()
    }

    /// A random symmetric positive block.
    fn symmetric<const D: usize>(rng: &mut rand_pcg::Pcg64) -> Block<D> {
        let g: Block<D> =
            std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(-1.0..1.0)));
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                (0..D).map(|k| g[i][k] * g[j][k]).sum::<f64>() + f64::from(i == j)
            })
        })
    }

    fn random<const D: usize>() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        for _ in 0..5000 {
            let w = symmetric::<D>(&mut rng);
            let f: [f64; D] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
            let mu = rng.random_range(0.0..0.8);
            let p = Local::new(&w, mu).solve(&f);
            let r = residual(&w, &f, &p, mu);
            assert!(r < 1e-12, "{r} {w:?} {f:?} {mu} {p:?}");
        }
    }

    /// A tension-only bond: u = 0, or no normal impulse, u_n < 0 and no slip.
    fn pulls<const D: usize>() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(4);
        let mut slack = 0;
        for _ in 0..500 {
            let w = symmetric::<D>(&mut rng);
            let f: [f64; D] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
            let start: [f64; D] = std::array::from_fn(|_| rng.random_range(-9.0..9.0));
            let p = Local::new(&w, 0.0).solve_rare(&f, &Law::Pull, &start, &[]);
            let mut u = times(&w, &p);
            for k in 0..D {
                u[k] += f[k];
            }
            assert!(p[0] <= 0.0 && u[0] <= 1e-12 && (p[0] * u[0]).abs() < 1e-12);
            assert!(slip(&u) < 1e-12, "{u:?}");
            slack += u32::from(p[0] == 0.0);
        }
        assert!((100..400).contains(&slack), "{slack} of 500 are slack");
    }

    #[test]
    fn contacts_are_solved_in_the_plane_and_in_space() {
        random::<2>();
        random::<3>();
        pulls::<2>();
        pulls::<3>();
    }

    /// A contact sticks by its cohesion alone, on a block whose directions have different
    /// compliances: iterations continue until u = 0.
    #[test]
    fn rare_laws_are_iterated_to_the_end() {
        let w = [[1.0, 0.0], [0.0, 0.5]];
        let law = Law::Cohesive {
            mu: 0.0,
            cohesion: 1.0,
        };
        let p = Local::new(&w, 0.0).solve_rare(&[-1.0, 0.25], &law, &[0.0; 2], &[]);
        assert!(
            (p[0] - 1.0).abs() < 1e-15 && (p[1] + 0.5).abs() < 1e-6,
            "{p:?}"
        );
    }
}
