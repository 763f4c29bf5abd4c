//! Contact laws: friction, restitution, the springs of compliant contacts.

pub mod coulomb;
pub mod coulomb_damage;
pub mod frictionless;
pub mod hertz_mindlin;
pub mod linear_contact;
pub mod mohr_coulomb;
pub mod newton_restitution;
pub mod rail_falling_friction;
pub mod rate_and_state;
pub mod rolling_friction;
pub mod static_dynamic;
pub mod thermal_contact;
pub mod thermal_friction;
pub mod velocity_weakening;

/// Calls a macro with the laws of this kind.
macro_rules! laws {
    ($($then:tt)*) => {
        $($then)*! { contact:
        coulomb::Coulomb,
        coulomb_damage::CoulombDamage,
        frictionless::Frictionless,
        hertz_mindlin::HertzMindlin,
        linear_contact::LinearContact,
        mohr_coulomb::MohrCoulomb,
        newton_restitution::NewtonRestitution,
        rail_falling_friction::RailFallingFriction,
        rate_and_state::RateAndState,
        rolling_friction::RollingFriction,
        static_dynamic::StaticDynamic,
        thermal_contact::ThermalContact,
        thermal_friction::ThermalFriction,
        velocity_weakening::VelocityWeakening,
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
            testing::friction_stays_finite::<$law>();
        )* };
    }

    #[test]
    fn every_law_keeps_its_range() {
        laws!(all);
    }
}
