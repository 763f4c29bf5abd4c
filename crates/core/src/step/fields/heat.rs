//! Fields of simulations with heat.

use super::{Field, GrainPart};
use crate::contact::{Contact, ContactHeat};
use crate::geometry::space::Space;
use crate::step::Simulation;
use crate::unit::{CONDUCTANCE, ELECTRIC_CONDUCTANCE, ENERGY};

/// Returns the temperature of the body of a grain, for simulations with heat.
pub fn heat_of_grains<S: Space>() -> Field<S, GrainPart<S>> {
    Field::number(
        "temperature",
        "K",
        "temperature; of a first body the mean of its surface, not a number of an insulated one",
        |s: &Simulation<S>, g: &GrainPart<S>| s.temperature(g.body as usize).unwrap_or(f64::NAN),
    )
}

/// A value of a contact in the last step; not a number before the first.
fn of_contact<S: Space>(
    s: &Simulation<S>,
    contact: &Contact<S>,
    get: impl Fn(&ContactHeat, usize) -> Option<f64>,
) -> f64 {
    let network = &s.state.network;
    let at = network
        .contacts
        .binary_search_by_key(&contact.key, |c| c.key);
    let found = network.thermal.as_ref().zip(at.ok());
    found.and_then(|(t, k)| get(t, k)).unwrap_or(f64::NAN)
}

/// Returns temperature, heat and conductances of contacts in the last step, for simulations with
/// heat.
pub fn heat_of_contacts<S: Space>() -> [Field<S, Contact<S>>; 4] {
    let units = [ENERGY, CONDUCTANCE, ELECTRIC_CONDUCTANCE];
    let [joule, thermal, electric] = units.map(|unit| unit.symbol(S::D));
    [
        Field::number(
            "temperature",
            "K",
            "temperature that laws saw in the last step, with the flash temperature where there is one",
            |s: &Simulation<S>, c: &Contact<S>| {
                of_contact(s, c, |t, k| Some(t.temperatures.get(k)?.temperature[0]))
            },
        ),
        Field::number(
            "heat",
            joule,
            "heat put in by dissipation and current in the last step",
            |s: &Simulation<S>, c: &Contact<S>| of_contact(s, c, |t, k| t.source.get(k).copied()),
        ),
        Field::number(
            "conductance",
            thermal,
            "thermal conductance in the last step",
            |s: &Simulation<S>, c: &Contact<S>| {
                of_contact(s, c, |t, k| Some(t.conductance.get(k)?[0]))
            },
        ),
        Field::number(
            "electric_conductance",
            electric,
            "electrical conductance in the last step",
            |s: &Simulation<S>, c: &Contact<S>| {
                of_contact(s, c, |t, k| Some(t.conductance.get(k)?[1]))
            },
        ),
    ]
}
