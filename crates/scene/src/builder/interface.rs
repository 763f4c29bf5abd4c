//! Interfaces made in Rust.

use crate::case::slots::BySlot;
use crate::case::{InterfaceSpec, SlotValues};
use crate::material::NumberSpec;
use fretwork_core::laws::{BondOpening, BondRule, Kind};
use std::collections::BTreeMap;

fn values(parameters: &[(&str, f64)]) -> BTreeMap<String, NumberSpec> {
    let given = parameters.iter();
    given
        .map(|(name, value)| ((*name).to_owned(), NumberSpec::from(*value)))
        .collect()
}

impl InterfaceSpec {
    /// Creates an interface between two materials, by their names in the case, with a contact law
    /// and its parameters in the units of the law (SI). `fretwork law show contact/NAME` lists the
    /// parameters and their ranges.
    pub fn new(
        name: impl Into<String>,
        between: (&str, &str),
        contact: impl Into<String>,
        parameters: &[(&str, f64)],
    ) -> Self {
        let spec = Self {
            name: name.into(),
            between: (between.0.to_owned(), between.1.to_owned()),
            parameters_from: None,
            laws: BySlot::default(),
            parameters: SlotValues::default(),
            tables: BySlot::default(),
            bonds: BondRule::default(),
            healing: None,
            bonds_within: None,
            bond_opening: BondOpening::default(),
            area_factor: 1.0,
        };
        spec.with(Kind::CONTACT, contact, parameters)
    }

    /// Adds a law of a kind with its parameters in the law's units.
    #[must_use]
    pub fn with(mut self, kind: Kind, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.laws.set(kind, law.into());
        if !parameters.is_empty() {
            self.parameters.set(kind, values(parameters));
        }
        self
    }

    /// Sets the table of the law of a kind, a file relative to that of the case.
    #[must_use]
    pub fn table(mut self, kind: Kind, file: impl Into<String>) -> Self {
        self.tables.set(kind, file.into());
        self
    }

    /// Adds a cohesion law with its parameters in the law's units.
    #[must_use]
    pub fn cohesion(self, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.with(Kind::COHESION, law, parameters)
    }

    /// Adds a damage law with its parameters in the law's units.
    #[must_use]
    pub fn damage(self, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.with(Kind::DAMAGE, law, parameters)
    }

    /// Adds a wear law with its parameters in the law's units.
    #[must_use]
    pub fn wear(self, law: impl Into<String>, parameters: &[(&str, f64)]) -> Self {
        self.with(Kind::WEAR, law, parameters)
    }

    /// Sets when bonds form; at the first step by default.
    #[must_use]
    pub fn bonds(mut self, rule: BondRule) -> Self {
        self.bonds = rule;
        self
    }

    /// Sets the largest gap at which a bond forms (m); the alert distance by default.
    #[must_use]
    pub fn bonds_within(mut self, gap: f64) -> Self {
        self.bonds_within = Some(gap);
        self
    }

    /// Sets the opening at which bonds begin.
    #[must_use]
    pub fn bond_opening(mut self, opening: BondOpening) -> Self {
        self.bond_opening = opening;
        self
    }

    /// Sets the factor of the contact's area, see [`AreaRule`](fretwork_core::laws::AreaRule); 1 by
    /// default.
    #[must_use]
    pub fn area_factor(mut self, factor: f64) -> Self {
        self.area_factor = factor;
        self
    }
}
