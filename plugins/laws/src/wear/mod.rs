//! Wear laws: the volume that a contact loses.

pub mod archard;
pub mod broken_bonds;
pub mod dissipated_energy;
pub mod oxidation;
pub mod t_gamma;
pub mod thermal_archard;

/// Calls a macro with the laws of this kind.
macro_rules! laws {
    ($($then:tt)*) => {
        $($then)*! { wear:
        archard::Archard,
        broken_bonds::BrokenBonds,
        dissipated_energy::DissipatedEnergy,
        oxidation::Oxidation,
        t_gamma::TGamma,
        thermal_archard::ThermalArchard,
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
            testing::wear_stays_finite::<$law>();
        )* };
    }

    #[test]
    fn every_law_keeps_its_range() {
        laws!(all);
    }
}
