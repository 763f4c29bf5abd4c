//! Inputs of a law for a contact.

use crate::{Conductance, Table};

/// Input of a law for one contact. Vectors are (n, t1, t2), SI units.
#[derive(Clone, Copy, Debug, Default)]
pub struct Site {
    /// Gap (m), positive when open.
    pub gap: f64,
    /// Area (m^2).
    pub area: f64,
    /// Reduced radius (m).
    pub radius: f64,
    /// Time since the contact formed (s).
    pub age: f64,
    /// Time for which the contact has carried a compressive impulse without interruption (s).
    pub compression_time: f64,
    /// Bond elongation (m).
    pub opening: [f64; 3],
    /// Rotation of the bond (rad): twist about n, bending about t1 and t2. In two dimensions the
    /// second component is the rotation about the axis out of the plane. Zero without
    /// `FLAG_MOMENT`.
    pub rotation: [f64; 3],
    /// Relative velocity (m/s).
    pub velocity: [f64; 3],
    /// Impulse (N s).
    pub impulse: [f64; 3],
    /// Damage D; 1 without a bond.
    pub damage: f64,
    /// Overlap (m), with `FLAG_COMPLIANT`. At the start of a step it is an estimate of the overlap
    /// at its end, for which the law gives force and stiffness; at the end of a step it is the
    /// actual overlap.
    pub overlap: f64,
    /// Effective mass along the normal (kg; kg/m in 2D), with `FLAG_COMPLIANT` at the start of a
    /// step; 0 if neither body can move.
    pub effective_mass: f64,
    /// Force of the tangential spring along t1 and t2 (N; N/m in 2D), with `FLAG_COMPLIANT`;
    /// positive where the candidate was displaced along them.
    pub spring_t: [f64; 2],
    /// `spring_t` at the start of the step, in commit (N; N/m in 2D).
    pub spring_before_t: [f64; 2],
    /// Temperature of the contact (K) at the start of the step; 0 unless the case computes heat.
    pub temperature: f64,
    /// Temperatures of candidate and antagonist at the contact (K).
    pub temperatures: [f64; 2],
    /// Thermal conductivity of the pair, 2 k1 k2/(k1 + k2) (W/(m K)); 0 unless the case computes
    /// heat.
    pub conductivity: f64,
    /// Electrical resistivity of the pair, (rho1 + rho2)/2 (ohm m); 0 without current.
    pub resistivity: f64,
    /// Slip over the step (m), for wear and transport.
    pub slip: f64,
    /// Work of friction over the step (J; J/m in 2D), for wear and transport.
    pub friction_work: f64,
    /// Time step (s).
    pub h: f64,
    /// Theta of the time scheme.
    pub theta: f64,
    /// Time at the start of the step (s).
    pub time: f64,
    /// Dimension, 2 or 3.
    pub dimension: u32,
    /// Table of the law, with `FLAG_TABLE`; without numbers where the case names none.
    pub table: Table,
}

impl Site {
    /// Norm of the tangential opening (m).
    #[inline]
    pub fn tangential_opening(&self) -> f64 {
        self.opening[1].hypot(self.opening[2])
    }

    /// Normal opening if positive, otherwise zero (m).
    #[inline]
    pub fn normal_opening(&self) -> f64 {
        self.opening[0].max(0.0)
    }

    /// Norm of the opening that tension causes, sqrt(<u_n>^2 + |u_t|^2) (m).
    #[inline]
    pub fn effective_opening(&self) -> f64 {
        self.normal_opening().hypot(self.tangential_opening())
    }

    /// Norm of the tangential velocity (m/s).
    #[inline]
    pub fn sliding_speed(&self) -> f64 {
        self.velocity[1].hypot(self.velocity[2])
    }

    /// Whether the surfaces touch: the gap is closed, or a compressive impulse acts.
    #[inline]
    pub fn touches(&self) -> bool {
        self.gap <= 0.0 || self.pressure() > 0.0
    }

    /// Compressive force (N; N/m in 2D), zero in tension.
    #[inline]
    pub fn force(&self) -> f64 {
        if self.h > 0.0 {
            (self.impulse[0] / self.h).max(0.0)
        } else {
            0.0
        }
    }

    /// Half-width (m) of the spot that carries the compressive force where surfaces of this
    /// hardness (Pa) yield: the radius of a circle, or the half-width of a strip in 2D.
    pub fn plastic_spot(&self, hardness: f64) -> f64 {
        let area = self.force() / hardness;
        match self.dimension {
            2 => 0.5 * area,
            _ => (area / std::f64::consts::PI).sqrt(),
        }
    }

    /// Conductance of a spot of this half-width (m) between bodies of conductivity `k`: 2 k a for a
    /// circle. In 2D that of a strip, counted to the distance 2 R on either side, R the reduced
    /// radius: pi k/(2 asinh(2 R/a)) per metre of depth. 0 without a spot.
    pub fn constriction(&self, k: f64, half_width: f64) -> f64 {
        if half_width <= 0.0 {
            return 0.0;
        }
        match self.dimension {
            2 => {
                // This form of asinh takes fewer operations than that of the library; x is well
                // above 1e-3.
                let x = 2.0 * self.radius / half_width;
                0.5 * std::f64::consts::PI * k / (x + (x * x + 1.0).sqrt()).ln()
            }
            _ => 2.0 * k * half_width,
        }
    }

    /// Electric conductance of a spot of this half-width (m), from the resistivity of the pair; 0
    /// without current.
    pub fn electric_constriction(&self, half_width: f64) -> f64 {
        match self.resistivity > 0.0 {
            true => self.constriction(1.0 / self.resistivity, half_width),
            false => 0.0,
        }
    }

    /// Conductances for heat and current of a spot of this half-width (m).
    pub fn through_spot(&self, half_width: f64) -> Conductance {
        Conductance {
            thermal: self.constriction(self.conductivity, half_width),
            electric: self.electric_constriction(half_width),
        }
    }

    /// Compressive pressure over the area (Pa), zero in tension.
    #[inline]
    pub fn pressure(&self) -> f64 {
        let force = self.h * self.area;
        if force > 0.0 {
            (self.impulse[0] / force).max(0.0)
        } else {
            0.0
        }
    }
}
