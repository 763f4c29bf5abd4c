//! Cohesion laws: the traction of a bond against its opening, and attraction across a gap.

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

/// Calls a macro with the laws of this kind.
macro_rules! laws {
    ($($then:tt)*) => {
        $($then)*! { cohesion:
        camanho_davila::CamanhoDavila,
        capillary_bridge::CapillaryBridge,
        constant_attraction::ConstantAttraction,
        dmt::Dmt,
        elastic_bond::ElasticBond,
        elastic_foundation::ElasticFoundation,
        jkr::Jkr,
        linear_adhesion::LinearAdhesion,
        mac::Mac,
        parallel_bond::ParallelBond,
        tvergaard_hutchinson::TvergaardHutchinson,
        van_der_waals::VanDerWaals,
        xu_needleman::XuNeedleman,
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
            testing::cohesion_stays_finite::<$law>();
        )* };
    }

    #[test]
    fn every_law_keeps_its_range() {
        laws!(all);
    }
}
