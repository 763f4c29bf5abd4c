//! Laws of a block of unknowns: set of admissible impulses and natural map.

use crate::solve::cone::project_array;

/// Returns |t|.
#[inline(always)]
pub fn slip<const D: usize>(u: &[f64; D]) -> f64 {
    if D == 2 {
        u[1].abs()
    } else {
        let mut squared = 0.0;
        for x in &u[1..] {
            squared += x * x;
        }
        squared.sqrt()
    }
}

/// Returns p - project(p - rho (u + mu |u_t| n)).
#[inline(always)]
pub fn natural<const D: usize>(p: &[f64; D], u: &[f64; D], mu: f64, rho: f64) -> [f64; D] {
    let shift = mu * slip(u);
    let z: [f64; D] =
        std::array::from_fn(|k| p[k] - rho * (u[k] + if k == 0 { shift } else { 0.0 }));
    let y = project_array(&z, mu, 0.0);
    std::array::from_fn(|k| p[k] - y[k])
}

/// Law of a block of unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// 0 <= u_n perp p_n >= 0 and |p_t| <= mu p_n opposite to u_t.
    Coulomb(f64),
    /// Coulomb's law with |p_t| <= mu p_n + cohesion.
    Cohesive {
        /// Friction coefficient.
        mu: f64,
        /// Shear cohesion over the step (N s).
        cohesion: f64,
    },
    /// u = 0, p unbounded: a bond, whose compliance is part of W.
    Free,
    /// A bond in tension only: u = 0 where p_n <= 0, and p = 0 otherwise.
    Pull,
    /// Moments (twist, bending): |p_n| <= twist P, |p_t| <= bend P, where P is the normal impulse
    /// of block `of`.
    Moment {
        /// The block whose normal impulse bounds the moment.
        of: u32,
        /// Bound of the twist moment divided by P (m).
        twist: f64,
        /// Bound of the bending moment divided by P (m).
        bend: f64,
    },
}

impl Law {
    /// Returns the admissible point nearest to z; `p` holds all impulses, for laws whose bounds
    /// depend on other blocks.
    #[inline(always)]
    pub fn project<const D: usize>(&self, z: &[f64; D], p: &[[f64; D]]) -> [f64; D] {
        match self {
            Self::Coulomb(mu) => project_array(z, *mu, 0.0),
            _ => self.project_rare(z, p),
        }
    }

    #[cold]
    fn project_rare<const D: usize>(&self, z: &[f64; D], p: &[[f64; D]]) -> [f64; D] {
        match self {
            Self::Coulomb(mu) => project_array(z, *mu, 0.0),
            Self::Cohesive { mu, cohesion } => project_array(z, *mu, *cohesion),
            Self::Free => *z,
            Self::Pull => {
                let mut y = *z;
                y[0] = y[0].min(0.0);
                y
            }
            Self::Moment { of, twist, bend } => {
                let bound = p[*of as usize][0].max(0.0);
                let length = slip(z);
                let scale = if length > bend * bound {
                    bend * bound / length
                } else {
                    1.0
                };
                std::array::from_fn(|k| {
                    if k == 0 {
                        z[0].clamp(-twist * bound, twist * bound)
                    } else {
                        z[k] * scale
                    }
                })
            }
        }
    }

    /// Returns mu of the De Saxce correction.
    #[inline(always)]
    pub fn friction(&self) -> f64 {
        match self {
            Self::Coulomb(mu) | Self::Cohesive { mu, .. } => *mu,
            _ => 0.0,
        }
    }

    /// Returns the natural map, p - project(p - rho (u + mu |u_t| n)).
    #[inline(always)]
    pub fn natural<const D: usize>(
        &self,
        p: &[f64; D],
        u: &[f64; D],
        rho: f64,
        all: &[[f64; D]],
    ) -> [f64; D] {
        if let Self::Coulomb(mu) = self {
            return natural(p, u, *mu, rho);
        }
        let shift = self.friction() * slip(u);
        let z = std::array::from_fn(|k| p[k] - rho * (u[k] + if k == 0 { shift } else { 0.0 }));
        let y = self.project(&z, all);
        std::array::from_fn(|k| p[k] - y[k])
    }
}
