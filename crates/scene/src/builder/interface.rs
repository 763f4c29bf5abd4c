//! Interfaces made in Rust.

use crate::case::{InterfaceSpec, SlotValues};
use crate::material::Given;
use fretwork_core::laws::BondRule;
use std::collections::BTreeMap;

fn values(parameters: &[(&str, f64)]) -> BTreeMap<String, Given> {
    let given = parameters.iter();
    given
        .map(|(name, value)| ((*name).to_owned(), Given::from(*value)))
        .collect()
}

impl InterfaceSpec {
    /// An interface between two materials, by their names in the case, with a contact law and its parameters in the units of
    /// the law (SI). `fretwork law show contact/NAME` lists the parameters and their ranges.
    pub fn new(
        name: impl Into<String>,
        between: (&str, &str),
        contact: impl Into<String>,
        parameters: &[(&str, f64)],
    ) -> Self {
        Self {
            name: name.into(),
            between: (between.0.to_owned(), between.1.to_owned()),
            parameters_from: None,
            contact: contact.into(),
            cohesion: None,
            damage: None,
            wear: None,
            parameters: SlotValues {
                contact: values(parameters),
                ..SlotValues::default()
            },
            bonds: BondRule::default(),
            healing: None,
            area_factor: 1.0,
        }
    }

    /// With a cohesion law and its parameters in the law's units.
    #[must_use]
    pub fn cohesion(mut self, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.cohesion = Some(law.into());
        self.parameters.cohesion = values(parameters);
        self
    }

    /// With a damage law and its parameters in the law's units.
    #[must_use]
    pub fn damage(mut self, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.damage = Some(law.into());
        self.parameters.damage = values(parameters);
        self
    }

    /// With a wear law and its parameters in the law's units.
    #[must_use]
    pub fn wear(mut self, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.wear = Some(law.into());
        self.parameters.wear = values(parameters);
        self
    }

    /// When bonds are made; at the first step by default.
    #[must_use]
    pub fn bonds(mut self, rule: BondRule) -> Self {
        self.bonds = rule;
        self
    }

    /// Factor of the contact's area, see [`AreaRule`](fretwork_core::laws::AreaRule); 1 by default.
    #[must_use]
    pub fn area_factor(mut self, factor: f64) -> Self {
        self.area_factor = factor;
        self
    }
}
