//! The undamaged bond, for damage laws.

/// The undamaged bond at this opening, for damage laws.
#[derive(Clone, Copy, Debug, Default)]
pub struct Intact {
    /// Stored energy psi_0 (J/m^2).
    pub energy: f64,
    /// Traction (Pa).
    pub traction: [f64; 3],
    /// Moment over the area (N m/m^2).
    pub moment: [f64; 3],
    /// Exponent m of psi = (1 - D)^m psi_0.
    pub degradation: f64,
}

impl Intact {
    /// The tensile part of the traction: (normal if positive, norm of the tangential part) (Pa).
    #[inline]
    pub fn pull(&self) -> [f64; 2] {
        [
            self.traction[0].max(0.0),
            self.traction[1].hypot(self.traction[2]),
        ]
    }

    /// Norm of the tensile traction (Pa): sqrt(<t_n>^2 + |t_t|^2).
    #[inline]
    pub fn traction_length(&self) -> f64 {
        let [n, t] = self.pull();
        n.hypot(t)
    }

    /// The opening of a linear bond that carries this traction and stores this energy, 2 psi_0/|t|
    /// (m). With one stiffness for both directions it is sqrt(<u_n>^2 + |u_t|^2).
    #[inline]
    pub fn opening(&self) -> f64 {
        let t = self.traction_length();
        if t > 0.0 { 2.0 * self.energy / t } else { 0.0 }
    }

    /// Stiffness |t|/opening (Pa/m); zero without tensile traction.
    #[inline]
    pub fn stiffness(&self) -> f64 {
        let t = self.traction_length();
        if self.energy > 0.0 {
            0.5 * t * t / self.energy
        } else {
            0.0
        }
    }

    /// Returns the damage at which the bond carries `traction`: (1 - D)^m |t_0| = traction; 0 if
    /// the undamaged bond carries less.
    #[inline]
    pub fn damage_for(&self, traction: f64) -> f64 {
        let t = self.traction_length();
        if t <= traction || t <= 0.0 {
            return 0.0;
        }
        let left = (traction / t).max(0.0);
        if self.degradation == 1.0 {
            1.0 - left
        } else {
            1.0 - left.powf(1.0 / self.degradation)
        }
    }

    /// Returns the damage of a bond that softens. It remains `damage` while the undamaged bond
    /// carries no more than `strength` (Pa), and never decreases. Beyond, the bond carries
    /// `traction(u, u_0)` (Pa) at the opening u, where u_0 = strength/K is the opening at the
    /// strength, and breaks where that is `None`.
    pub fn soften(
        &self,
        damage: f64,
        strength: f64,
        traction: impl FnOnce(f64, f64) -> Option<f64>,
    ) -> f64 {
        let k = self.stiffness();
        if k <= 0.0 || self.traction_length() <= strength {
            return damage;
        }
        match traction(self.opening(), strength / k) {
            Some(traction) => self.damage_for(traction).max(damage),
            None => 1.0,
        }
    }

    /// Calls [`Self::soften`] with a traction that decreases linearly from `strength` (Pa) to zero
    /// at 2 energy/strength, so that `energy` (J/m^2) is the area below it. A bond that stores more
    /// than that at its strength breaks there.
    pub fn soften_linearly(&self, damage: f64, strength: f64, energy: f64) -> f64 {
        self.soften(damage, strength, |u, first| {
            let last = 2.0 * energy / strength;
            let broken = u >= last || last <= first;
            (!broken).then(|| strength * ((last - u) / (last - first)))
        })
    }

    /// The driving force Y = -d psi/d D = m (1 - D)^(m - 1) psi_0 (J/m^2).
    #[inline]
    pub fn release_rate(&self, damage: f64) -> f64 {
        // The common exponents avoid the power function, which costs more than the rest of a law.
        match self.degradation {
            1.0 => self.energy,
            2.0 => 2.0 * (1.0 - damage) * self.energy,
            m => m * (1.0 - damage).powf(m - 1.0) * self.energy,
        }
    }
}
