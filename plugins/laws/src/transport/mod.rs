//! Transport laws: conductances of a contact for heat and electric charge.

pub mod batchelor_obrien;
pub mod bond_conductance;
pub mod constant_conductance;
pub mod holm;
pub mod oxide_film;
pub mod rough_contact;

crate::tables! { transport:
    batchelor_obrien::BatchelorObrien,
    bond_conductance::BondConductance,
    constant_conductance::ConstantConductance,
    holm::Holm,
    oxide_film::OxideFilm,
    rough_contact::RoughContact,
}
