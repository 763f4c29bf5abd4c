//! The error of a solution: the natural map of the De Saxce form, free of scale.
//!
//! error = ( sum_c |p_c - proj_Kc(p_c - rho_c (u_c + mu_c |u_t,c| e_n))|^2 / rho_c^2 )^1/2
//!         / max( |u|, |u_free| ),     rho_c = 1 / lambda_max(W_cc),
//!
//! with Euclidean norms over the whole vector of contacts, all in velocity, and no division when the
//! maximum is zero. A scene scaled in length, mass or time has the same figure.

/// The formula, for reports.
pub const FORMULA: &str = "|p - proj_K(p - rho (u + mu |u_t| n))| / rho over max(|u|, |u_free|), rho = 1/lambda_max(W_cc)";

/// Sums over contacts; added in a fixed order, whatever the number of threads.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// Sum of squared residuals (m^2/s^2).
    pub residual: f64,
    /// Sum of squared relative velocities (m^2/s^2).
    pub velocity: f64,
    /// Largest squared residual (m^2/s^2).
    pub worst: f64,
    /// Index of the contact that has it (in the order of the sweep).
    pub worst_at: usize,
}

impl Sums {
    /// Adds one contact.
    #[inline(always)]
    pub fn add(&mut self, residual: f64, velocity: f64, at: usize) {
        self.residual += residual;
        self.velocity += velocity;
        if residual > self.worst {
            self.worst = residual;
            self.worst_at = at;
        }
    }

    /// Adds the sums of another range of contacts.
    pub fn merge(&mut self, other: &Self) {
        self.residual += other.residual;
        self.velocity += other.velocity;
        if other.worst > self.worst {
            self.worst = other.worst;
            self.worst_at = other.worst_at;
        }
    }

    /// The error, given the sum of squared free velocities (m^2/s^2).
    pub fn error(&self, free: f64) -> f64 {
        let scale = self.velocity.max(free).sqrt();
        let residual = self.residual.sqrt();
        if scale > 0.0 {
            residual / scale
        } else {
            residual
        }
    }
}
