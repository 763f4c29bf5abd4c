//! The contact laws that come with Fretwork, by kind. Each is written with the crate
//! `fretwork_law`, like the laws of other authors, and reaches the program through the same table
//! of functions.

#![forbid(unsafe_code)]

/// Contact laws: friction, restitution, the springs of compliant contacts.
pub mod contact {
    pub mod coulomb;
    pub mod coulomb_damage;
    pub mod debris_friction;
    pub mod frictionless;
    pub mod hertz_mindlin;
    pub mod linear_contact;
    pub mod mohr_coulomb;
    pub mod newton_restitution;
    pub mod rail_falling_friction;
    pub mod rate_and_state;
    pub mod rolling_friction;
    pub mod static_dynamic;
    pub mod tabulated;
    pub mod thermal_contact;
    pub mod thermal_friction;
    pub mod velocity_weakening;
}

/// Cohesion laws: the traction of a bond against its opening, and attraction across a gap.
pub mod cohesion {
    pub mod camanho_davila;
    pub mod capillary_bridge;
    pub mod constant_attraction;
    pub mod dmt;
    pub mod elastic_bond;
    pub mod elastic_foundation;
    pub mod jkr;
    pub mod linear_adhesion;
    pub mod mac;
    pub mod parallel_bond;
    pub mod tvergaard_hutchinson;
    pub mod van_der_waals;
    pub mod xu_needleman;
}

/// Damage laws: how the damage D of a bond grows, and when it breaks.
pub mod damage {
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
}

/// Wear laws: the volume that a contact loses.
pub mod wear {
    pub mod archard;
    pub mod broken_bonds;
    pub mod dissipated_energy;
    pub mod oxidation;
    pub mod t_gamma;
    pub mod tabulated;
    pub mod thermal_archard;
}

/// Transport laws: conductances of a contact for heat and electric charge.
pub mod transport {
    pub mod batchelor_obrien;
    pub mod bond_conductance;
    pub mod constant_conductance;
    pub mod holm;
    pub mod oxide_film;
    pub mod rough_contact;
}

mod trapezoid;

#[cfg(test)]
mod mixed_mode;

/// The gas constant (J/(mol K)).
const GAS: f64 = 8.314462618;

/// Calls a macro with all laws, by kind.
macro_rules! laws {
    ($then:ident) => {
        $then! {
            contact:
                coulomb::Coulomb, coulomb_damage::CoulombDamage,
                debris_friction::DebrisFriction, frictionless::Frictionless,
                hertz_mindlin::HertzMindlin, linear_contact::LinearContact,
                mohr_coulomb::MohrCoulomb, newton_restitution::NewtonRestitution,
                rail_falling_friction::RailFallingFriction, rate_and_state::RateAndState,
                rolling_friction::RollingFriction, static_dynamic::StaticDynamic,
                tabulated::Tabulated, thermal_contact::ThermalContact, thermal_friction::ThermalFriction,
                velocity_weakening::VelocityWeakening;
            cohesion:
                camanho_davila::CamanhoDavila, capillary_bridge::CapillaryBridge,
                constant_attraction::ConstantAttraction, dmt::Dmt, elastic_bond::ElasticBond,
                elastic_foundation::ElasticFoundation, jkr::Jkr, linear_adhesion::LinearAdhesion,
                mac::MacCohesion, parallel_bond::ParallelBond, tvergaard_hutchinson::TvergaardHutchinson,
                van_der_waals::VanDerWaals, xu_needleman::XuNeedleman;
            damage:
                czm_fatigue::CzmFatigue, czm_linear::CzmLinear,
                exponential_softening::ExponentialSoftening, khoramishad::Khoramishad,
                linear_softening::LinearSoftening, mac::MacDamage,
                mohr_coulomb_brittle::MohrCoulombBrittle, nguyen::Nguyen, roe_siegmund::RoeSiegmund,
                thermal_softening::ThermalSoftening, trapezoidal::Trapezoidal;
            wear:
                archard::Archard, broken_bonds::BrokenBonds, dissipated_energy::DissipatedEnergy,
                oxidation::Oxidation, t_gamma::TGamma, tabulated::TabulatedWear,
                thermal_archard::ThermalArchard;
            transport:
                batchelor_obrien::BatchelorObrien, bond_conductance::BondConductance,
                constant_conductance::ConstantConductance, holm::Holm, oxide_film::OxideFilm,
                rough_contact::RoughContact;
        }
    };
}

macro_rules! tables {
    ($($kind:ident: $($module:ident::$law:ident),*;)*) => {
        vec![$($({
            fretwork_law::plugin_table!($kind crate::$kind::$module::$law);
            &TABLE
        }),*),*]
    };
}

/// The tables of all laws.
pub fn plugins() -> Vec<&'static fretwork_law::abi::LinkedLaw> {
    laws!(tables)
}

#[cfg(test)]
mod tests {
    use fretwork_law::{CohesionLaw, testing};

    macro_rules! check {
        (contact $law:ty) => {
            testing::friction_stays_finite::<$law>();
        };
        (cohesion $law:ty) => {
            testing::cohesion_stays_finite::<$law>();
            if <$law>::DEGRADATION > 0.0 {
                testing::traction_is_the_slope_of_the_energy(&<$law>::default());
            }
        };
        (damage $law:ty) => {
            testing::damage_stays_in_range::<$law>();
            testing::damage_never_falls::<$law>();
        };
        (wear $law:ty) => {
            testing::wear_stays_finite::<$law>();
        };
        (transport $law:ty) => {};
    }

    macro_rules! checks {
        ($($kind:ident: $($module:ident::$law:ident),*;)*) => {
            $($(check!($kind crate::$kind::$module::$law);)*)*
        };
    }

    #[test]
    fn every_law_keeps_its_range() {
        laws!(checks);
    }
}
