//! An interface law: a list of slots, at most one law of each kind, with parameters.

use super::error::LawError;
use super::kind::{Domain, Kind};
use super::library::Plugin;
use fretwork_abi::{
    FLAG_BREAKS, FLAG_COMPLIANT, FLAG_CONSTANT, FLAG_FORMS, FLAG_MOMENT, FLAG_OPENING, FLAG_TABLE,
    FLAG_TEMPERATURE, FLAG_TENSION_ONLY,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Where the value of a parameter comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ParameterOrigin {
    /// It was given; the text says where, such as "the case".
    Given(String),
    /// The law's default.
    Default,
}

/// A plugin with the values of its parameters, in the order of its schema.
#[derive(Clone, Debug)]
pub struct LoadedLaw {
    /// The plugin.
    pub plugin: Arc<Plugin>,
    /// Values, one per parameter.
    pub parameters: Vec<f64>,
    /// Where they come from, one per parameter; empty if that is not known.
    pub origins: Vec<ParameterOrigin>,
    /// Numbers of its table, in the order of [`fretwork_abi::FwBatch::table`]; empty without one.
    pub table: &'static [f64],
    /// Index of its first column among the interface's internal variables.
    pub first_variable: usize,
}

impl LoadedLaw {
    /// Creates a law with these values of its parameters, in the order of its schema.
    pub fn new(plugin: Plugin, parameters: Vec<f64>) -> Self {
        Self {
            plugin: Arc::new(plugin),
            parameters,
            origins: Vec::new(),
            table: &[],
            first_variable: 0,
        }
    }

    /// Adds where the values of the parameters come from, one per parameter.
    #[must_use]
    pub fn with_origins(mut self, origins: Vec<ParameterOrigin>) -> Self {
        self.origins = origins;
        self
    }

    /// Gives the law a table, see [`fretwork_abi::FwBatch::table`]. Laws may keep its address, so
    /// that it stays in memory as long as the program runs.
    #[must_use]
    pub fn with_table(self, table: Vec<f64>) -> Self {
        Self {
            table: table.leak(),
            ..self
        }
    }

    /// Returns whether the table depends on temperature.
    fn table_of_temperatures(&self) -> bool {
        const TEMPERATURE: usize = 3;
        self.has(FLAG_TABLE)
            && self
                .table
                .get(TEMPERATURE)
                .is_some_and(|points| *points > 1.0)
    }

    /// Creates a law with the defaults of its parameters.
    pub fn with_defaults(plugin: Plugin) -> Self {
        let parameters = plugin.parameters.iter().map(|p| p.default).collect();
        Self::new(plugin, parameters)
    }

    /// Number of internal variables.
    pub fn variables(&self) -> usize {
        self.plugin.variables.len()
    }

    /// Returns whether a flag is set.
    pub fn has(&self, flag: u64) -> bool {
        self.plugin.flags & flag != 0
    }

    /// Returns whether the law reads temperatures or transports heat.
    pub fn reads_temperatures(&self) -> bool {
        self.plugin.kind == Kind::TRANSPORT
            || self.has(FLAG_TEMPERATURE)
            || self.table_of_temperatures()
    }
}

/// When bonds are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum BondRule {
    /// Every contact within the alert distance at the first step.
    #[default]
    Start,
    /// Every contact within the alert distance at this time (s), for example after compaction.
    At(f64),
    /// No bonds.
    Never,
}

/// Opening at which a bond begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum BondOpening {
    /// The opening is zero: cement fills the gap, and the bodies cannot approach while the bond
    /// holds.
    #[default]
    Filled,
    /// The opening is the gap, if it is positive: the bond pulls from the start, with the energy of
    /// this opening, and the bodies are free to close it, as with the cohesive laws of LMGC90.
    Gap,
}

/// Area on which tractions act, from the radius r of a contact, r1 r2/(r1 + r2) of two balls:
/// `factor` r times unit depth in 2D, `factor` pi r^2 in 3D. For points of surfaces that deform and
/// for facing sides and faces, r follows from their area, see
/// [`crate::geometry::shape::point_radius`]. LMGC90's benchmark scene uses the factor 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AreaRule {
    /// Factor.
    pub factor: f64,
}

impl Default for AreaRule {
    fn default() -> Self {
        Self { factor: 1.0 }
    }
}

impl AreaRule {
    /// Returns the area (m^2) of a contact of reduced radius `radius` (m).
    #[inline]
    pub fn area(&self, dimension: usize, radius: f64) -> f64 {
        if dimension == 2 {
            self.factor * radius
        } else {
            self.factor * std::f64::consts::PI * radius * radius
        }
    }
}

/// The law of a pair of materials: slots of laws, in the order of their kinds.
#[derive(Clone, Debug)]
pub struct Interface {
    /// Name in the case.
    pub name: String,
    /// When bonds are made.
    pub bonds: BondRule,
    /// Largest gap at which a bond is made (m); `None` for the alert distance.
    pub bonds_within: Option<f64>,
    /// Opening at which a bond begins.
    pub bond_opening: BondOpening,
    /// Time under compression (s) after which a contact forms a bond, including after an earlier
    /// bond broke.
    pub healing: Option<f64>,
    /// Area of a contact.
    pub area: AreaRule,
    /// Laws, at most one of each kind, sorted by kind; the contact law comes first.
    slots: Vec<LoadedLaw>,
    /// Flags of the cohesion law.
    cohesion_flags: u64,
}

impl Interface {
    /// An interface of these laws, in any order, with the default rules: bonds from the start where
    /// the laws make bonds, no healing, and the default area.
    ///
    /// # Errors
    /// There is no contact law, two laws have the same kind, or slots do not fit together.
    pub fn new(
        name: impl Into<String>,
        laws: impl IntoIterator<Item = LoadedLaw>,
    ) -> Result<Self, LawError> {
        let mut law = Self {
            name: name.into(),
            bonds: BondRule::default(),
            bonds_within: None,
            bond_opening: BondOpening::default(),
            healing: None,
            area: AreaRule::default(),
            slots: laws.into_iter().collect(),
            cohesion_flags: 0,
        };
        law.arrange()?;
        Ok(law)
    }

    /// Returns the interface with another law, which replaces the law of its kind if there is one.
    ///
    /// # Errors
    /// The slots do not fit together.
    pub fn with(mut self, law: LoadedLaw) -> Result<Self, LawError> {
        self.slots.retain(|l| l.plugin.kind != law.plugin.kind);
        self.slots.push(law);
        self.arrange()?;
        Ok(self)
    }

    /// Returns the interface with only the laws that `keep` accepts.
    ///
    /// # Errors
    /// No contact law is left, or the slots do not fit together.
    pub fn retain(mut self, keep: impl FnMut(&LoadedLaw) -> bool) -> Result<Self, LawError> {
        self.slots.retain(keep);
        self.arrange()?;
        Ok(self)
    }

    /// Returns the interface with another rule for when bonds are made, and a healing time (s).
    ///
    /// # Errors
    /// Healing needs a cohesion law that forms bonds in contact.
    pub fn with_bonds(mut self, bonds: BondRule, healing: Option<f64>) -> Result<Self, LawError> {
        (self.bonds, self.healing) = (bonds, healing);
        self.check()?;
        Ok(self)
    }

    /// Sorts the slots, numbers the internal variables and checks that the slots fit together.
    fn arrange(&mut self) -> Result<(), LawError> {
        self.slots.sort_by_key(|l| l.plugin.kind);
        let mut pairs = self.slots.windows(2);
        let twice = pairs.find(|w| w[0].plugin.kind == w[1].plugin.kind);
        let reason = match (twice, self.slots.first().map(|l| l.plugin.kind)) {
            (Some(w), _) => Some(format!(
                "interface `{}` has two {} laws, `{}` and `{}`; it takes one of each kind",
                self.name, w[0].plugin.kind, w[0].plugin.name, w[1].plugin.name
            )),
            (_, Some(kind)) if kind == Kind::CONTACT => None,
            _ => Some(format!("interface `{}` has no contact law", self.name)),
        };
        if let Some(reason) = reason {
            return Err(LawError::Incompatible { reason });
        }
        let mut next = 0;
        for loaded in &mut self.slots {
            loaded.first_variable = next;
            next += loaded.variables();
        }
        self.cohesion_flags = self.cohesion().map_or(0, |c| c.plugin.flags);
        self.check()
    }

    /// Whether the slots fit together.
    fn check(&self) -> Result<(), LawError> {
        if let (Some(_), Some(cohesion)) = (self.healing, self.cohesion())
            && !(cohesion.has(FLAG_OPENING) && cohesion.has(FLAG_FORMS))
        {
            return Err(LawError::Incompatible {
                reason: format!(
                    "the cohesion law `{}` of interface `{}` forms no bonds in contact; drop `healing` or choose another cohesion",
                    cohesion.plugin.name, self.name
                ),
            });
        }
        let mut slots = self.slots.iter();
        slots.try_for_each(|l| (l.plugin.kind.spec().fits)(self))
    }

    /// The law of a kind.
    pub fn law(&self, kind: Kind) -> Option<&LoadedLaw> {
        self.slots.iter().find(|l| l.plugin.kind == kind)
    }

    /// The contact law.
    pub fn contact(&self) -> &LoadedLaw {
        // `arrange` refuses an interface whose first slot is not a contact law.
        &self.slots[0]
    }

    /// Returns the cohesion law: traction against opening.
    pub fn cohesion(&self) -> Option<&LoadedLaw> {
        self.law(Kind::COHESION)
    }

    /// Returns the damage law.
    pub fn damage(&self) -> Option<&LoadedLaw> {
        self.law(Kind::DAMAGE)
    }

    /// Returns the wear law.
    pub fn wear(&self) -> Option<&LoadedLaw> {
        self.law(Kind::WEAR)
    }

    /// Returns the parameters of the law of a kind, in the order of its schema.
    pub fn parameters_mut(&mut self, kind: Kind) -> Option<&mut Vec<f64>> {
        let mut slots = self.slots.iter_mut();
        let found = slots.find(|l| l.plugin.kind == kind);
        found.map(|l| &mut l.parameters)
    }

    /// Iterates over the laws, in the order in which they are evaluated.
    pub fn loaded(&self) -> impl Iterator<Item = &LoadedLaw> {
        self.slots.iter()
    }

    /// Whether a law acts on intact bonds; else on contacts.
    pub fn acts_on_bonds(&self, law: &LoadedLaw) -> bool {
        match law.plugin.kind.spec().domain {
            Domain::Bonds => true,
            Domain::ByOpening => law.has(FLAG_OPENING),
            Domain::All | Domain::Near => false,
        }
    }

    /// Returns the number of internal variables over all slots.
    pub fn variables(&self) -> usize {
        self.loaded().map(LoadedLaw::variables).sum()
    }

    /// Returns the number of internal variables of the laws that act on every contact, bonded or
    /// not.
    pub fn variables_of_contacts(&self) -> usize {
        let on_contacts = self.loaded().filter(|l| !self.acts_on_bonds(l));
        on_contacts.map(LoadedLaw::variables).sum()
    }

    /// Iterates over the columns of the internal variables of bonds.
    pub fn variables_of_bonds(&self) -> impl Iterator<Item = usize> {
        let on_bonds = self.loaded().filter(|l| self.acts_on_bonds(l));
        on_bonds.flat_map(|l| l.first_variable..l.first_variable + l.variables())
    }

    /// Returns the initial values of the internal variables.
    pub fn initial(&self) -> Vec<f64> {
        self.loaded()
            .flat_map(|l| l.plugin.variables.iter().map(|v| v.default))
            .collect()
    }

    /// Returns the time at which contacts become bonds (s), if they do.
    pub fn bonding_time(&self) -> Option<f64> {
        let time = match self.bonds {
            BondRule::Start => 0.0,
            BondRule::At(time) => time,
            BondRule::Never => return None,
        };
        self.opens().then_some(time)
    }

    /// Returns whether the cohesion law has an opening and so forms bonds; without one it acts on
    /// every contact.
    pub fn opens(&self) -> bool {
        self.cohesion_flags & FLAG_OPENING != 0
    }

    /// Returns whether bonds resist bending and twist.
    pub fn rotates(&self) -> bool {
        self.cohesion_flags & FLAG_MOMENT != 0
    }

    /// Returns whether damage grows, by a damage law or by the cohesion law itself.
    pub fn damages(&self) -> bool {
        self.cohesion_flags & FLAG_BREAKS != 0 || self.damage().is_some()
    }

    /// Returns whether the normal stiffness acts in tension only.
    pub fn tension_only(&self) -> bool {
        self.cohesion_flags & FLAG_TENSION_ONLY != 0
    }

    /// Returns whether a law reads temperatures or transports heat.
    pub fn reads_temperatures(&self) -> bool {
        self.loaded().any(LoadedLaw::reads_temperatures)
    }

    /// Returns the transport law: conductances for heat and current.
    pub fn transport(&self) -> Option<&LoadedLaw> {
        self.law(Kind::TRANSPORT)
    }

    /// Returns whether contacts are springs.
    pub fn compliant(&self) -> bool {
        self.contact().has(FLAG_COMPLIANT)
    }

    /// Returns whether friction and restitution are the same for all contacts and steps.
    pub fn constant_contact(&self) -> bool {
        self.contact().has(FLAG_CONSTANT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::sample_laws::{bond, growing, interface, sticky};

    /// Laws of 0, 1 and 1 variables are given in another order: the columns of each law begin after
    /// those of the law before it.
    #[test]
    fn variables_of_laws_follow_each_other() {
        let law = interface([growing(), sticky()]);
        let kinds: Vec<Kind> = law.loaded().map(|l| l.plugin.kind).collect();
        assert_eq!(kinds, [Kind::CONTACT, Kind::COHESION, Kind::TRANSPORT]);
        let first: Vec<usize> = law.loaded().map(|l| l.first_variable).collect();
        assert_eq!((first, law.variables()), (vec![0, 0, 1], 2));
        assert_eq!(law.initial(), [7.0, 0.0]);
        let law = law.with(bond()).unwrap();
        let first: Vec<usize> = law.loaded().map(|l| l.first_variable).collect();
        assert_eq!((first, law.variables()), (vec![0, 0, 0], 1));
    }
}
