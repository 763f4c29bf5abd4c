//! The shipped laws linked into a program: the sources of the plugin crates are compiled again, with their tables
//! but without the exported symbol, of which a program can have only one.
//!
//! The source of a law imports the crate `fretwork_law`; here that is this crate, whose `export!` stores the table
//! instead of exporting an entry function. The sources therefore need no conditional compilation, and nothing depends
//! on how a linker treats duplicate symbols.

extern crate self as fretwork_law;

use sdk::*;

#[cfg(test)]
mod mixed_mode;

/// The macro that replaces `export!` here.
mod entry {
    macro_rules! export {
        ($kind:ident $law:ty) => {
            /// The table that the plugin's entry function returns.
            pub fn plugin() -> &'static sdk::abi::FwPlugin {
                sdk::plugin_table!($kind $law);
                &TABLE.0
            }
        };
    }
    pub(crate) use export;
}
pub(crate) use entry::export;

macro_rules! laws {
    ($($module:ident $path:literal)*) => {
        $(
            #[path = $path]
            pub mod $module;
        )*

        /// The tables of all shipped laws.
        pub fn plugins() -> Vec<&'static sdk::abi::FwPlugin> {
            vec![$($module::plugin()),*]
        }
    };
}

laws! {
    contact_coulomb "../../contact/coulomb/src/lib.rs"
    contact_coulomb_damage "../../contact/coulomb_damage/src/lib.rs"
    contact_frictionless "../../contact/frictionless/src/lib.rs"
    contact_hertz_mindlin "../../contact/hertz_mindlin/src/lib.rs"
    contact_linear_contact "../../contact/linear_contact/src/lib.rs"
    contact_mohr_coulomb "../../contact/mohr_coulomb/src/lib.rs"
    contact_newton_restitution "../../contact/newton_restitution/src/lib.rs"
    contact_rail_falling_friction "../../contact/rail_falling_friction/src/lib.rs"
    contact_rate_and_state "../../contact/rate_and_state/src/lib.rs"
    contact_rolling_friction "../../contact/rolling_friction/src/lib.rs"
    contact_static_dynamic "../../contact/static_dynamic/src/lib.rs"
    contact_velocity_weakening "../../contact/velocity_weakening/src/lib.rs"
    cohesion_camanho_davila "../../cohesion/camanho_davila/src/lib.rs"
    cohesion_capillary_bridge "../../cohesion/capillary_bridge/src/lib.rs"
    cohesion_constant_attraction "../../cohesion/constant_attraction/src/lib.rs"
    cohesion_dmt "../../cohesion/dmt/src/lib.rs"
    cohesion_elastic_bond "../../cohesion/elastic_bond/src/lib.rs"
    cohesion_elastic_foundation "../../cohesion/elastic_foundation/src/lib.rs"
    cohesion_jkr "../../cohesion/jkr/src/lib.rs"
    cohesion_linear_adhesion "../../cohesion/linear_adhesion/src/lib.rs"
    cohesion_mac "../../cohesion/mac/src/lib.rs"
    cohesion_parallel_bond "../../cohesion/parallel_bond/src/lib.rs"
    cohesion_tvergaard_hutchinson "../../cohesion/tvergaard_hutchinson/src/lib.rs"
    cohesion_van_der_waals "../../cohesion/van_der_waals/src/lib.rs"
    cohesion_xu_needleman "../../cohesion/xu_needleman/src/lib.rs"
    damage_czm_fatigue "../../damage/czm_fatigue/src/lib.rs"
    damage_czm_linear "../../damage/czm_linear/src/lib.rs"
    damage_exponential_softening "../../damage/exponential_softening/src/lib.rs"
    damage_khoramishad "../../damage/khoramishad/src/lib.rs"
    damage_linear_softening "../../damage/linear_softening/src/lib.rs"
    damage_mac "../../damage/mac/src/lib.rs"
    damage_mohr_coulomb_brittle "../../damage/mohr_coulomb_brittle/src/lib.rs"
    damage_nguyen "../../damage/nguyen/src/lib.rs"
    damage_roe_siegmund "../../damage/roe_siegmund/src/lib.rs"
    damage_trapezoidal "../../damage/trapezoidal/src/lib.rs"
    wear_archard "../../wear/archard/src/lib.rs"
    wear_broken_bonds "../../wear/broken_bonds/src/lib.rs"
    wear_dissipated_energy "../../wear/dissipated_energy/src/lib.rs"
    wear_t_gamma "../../wear/t_gamma/src/lib.rs"
    contact_thermal_contact "../../contact/thermal_contact/src/lib.rs"
    contact_thermal_friction "../../contact/thermal_friction/src/lib.rs"
    damage_thermal_softening "../../damage/thermal_softening/src/lib.rs"
    wear_thermal_archard "../../wear/thermal_archard/src/lib.rs"
    wear_oxidation "../../wear/oxidation/src/lib.rs"
    transport_constant_conductance "../../transport/constant_conductance/src/lib.rs"
    transport_batchelor_obrien "../../transport/batchelor_obrien/src/lib.rs"
    transport_rough_contact "../../transport/rough_contact/src/lib.rs"
    transport_bond_conductance "../../transport/bond_conductance/src/lib.rs"
    transport_holm "../../transport/holm/src/lib.rs"
    transport_oxide_film "../../transport/oxide_film/src/lib.rs"
}
