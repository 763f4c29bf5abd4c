//! Damage laws: how the damage D of a bond grows, and when it breaks.

pub mod czm_fatigue;
pub mod czm_linear;
pub mod exponential_softening;
pub mod khoramishad;
pub mod linear_softening;
pub mod mac;
pub mod mohr_coulomb_brittle;
pub mod nguyen;
pub mod roe_siegmund;
pub mod thermal_softening;
pub mod trapezoidal;

/// Calls a macro with the laws of this kind.
macro_rules! laws {
    ($($then:tt)*) => {
        $($then)*! { damage:
        czm_fatigue::CzmFatigue,
        czm_linear::CzmLinear,
        exponential_softening::ExponentialSoftening,
        khoramishad::Khoramishad,
        linear_softening::LinearSoftening,
        mac::Mac,
        mohr_coulomb_brittle::MohrCoulombBrittle,
        nguyen::Nguyen,
        roe_siegmund::RoeSiegmund,
        thermal_softening::ThermalSoftening,
        trapezoidal::Trapezoidal,
        }
    };
}

laws!(crate::tables);

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_law::testing;

    macro_rules! all {
        ($kind:ident: $($law:path),* $(,)?) => { $(
            testing::damage_stays_in_range::<$law>();
            testing::damage_never_falls::<$law>();
        )* };
    }

    #[test]
    fn every_law_keeps_its_range() {
        laws!(all);
    }
}
