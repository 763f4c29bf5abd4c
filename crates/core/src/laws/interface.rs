//! An interface law: one plugin in each of four slots, with parameters.

use super::library::{LawError, Plugin};
use fretwork_abi::{
    FLAG_BREAKS, FLAG_CONSTANT, FLAG_FORMS, FLAG_MOMENT, FLAG_OPENING, FLAG_TENSION_ONLY,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A plugin with the values of its parameters, in the order of its schema.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The plugin.
    pub plugin: Arc<Plugin>,
    /// Values, one per parameter.
    pub parameters: Vec<f64>,
    /// Index of its first column among the interface's internal variables.
    pub first_variable: usize,
}

impl Loaded {
    /// Returns the number of internal variables.
    pub fn variables(&self) -> usize {
        self.plugin.variables.len()
    }

    /// Returns whether a flag is set.
    pub fn has(&self, flag: u64) -> bool {
        self.plugin.flags & flag != 0
    }
}

/// When bonds are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum BondRule {
    /// Every contact within the alert distance at the first step.
    #[default]
    Start,
    /// Every contact within the alert distance at this time (s), for example after compaction.
    At(f64),
    /// No bonds.
    Never,
}

/// Area on which tractions act, from the reduced radius r = r1 r2/(r1 + r2): `factor` r times unit depth in
/// 2D, `factor` pi r^2 in 3D. LMGC90's benchmark scene uses the factor 1.
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

/// The interface law of a pair of materials.
#[derive(Clone, Debug)]
pub struct Interface {
    /// Name in the case.
    pub name: String,
    /// Friction, restitution, rolling.
    pub contact: Loaded,
    /// Traction against opening.
    pub cohesion: Option<Loaded>,
    /// Damage evolution.
    pub damage: Option<Loaded>,
    /// Wear volume.
    pub wear: Option<Loaded>,
    /// When bonds are made.
    pub bonds: BondRule,
    /// Time under compression (s) after which a contact forms a bond, including after an earlier bond broke.
    pub healing: Option<f64>,
    /// Area of a contact.
    pub area: AreaRule,
}

impl Interface {
    /// Iterates over the plugins in use.
    pub fn loaded(&self) -> impl Iterator<Item = &Loaded> {
        std::iter::once(&self.contact)
            .chain(self.cohesion.iter())
            .chain(self.damage.iter())
            .chain(self.wear.iter())
    }

    /// Numbers the internal variables and checks that the laws are compatible.
    ///
    /// # Errors
    /// A damage law without a cohesion law that has an opening.
    pub fn compose(mut self) -> Result<Self, LawError> {
        let mut next = 0;
        for loaded in [
            Some(&mut self.contact),
            self.cohesion.as_mut(),
            self.damage.as_mut(),
            self.wear.as_mut(),
        ]
        .into_iter()
        .flatten()
        {
            loaded.first_variable = next;
            next += loaded.variables();
        }
        if let (Some(_), Some(cohesion)) = (self.healing, &self.cohesion)
            && !(cohesion.has(FLAG_OPENING) && cohesion.has(FLAG_FORMS))
        {
            return Err(LawError::Pairing {
                reason: format!(
                    "the cohesion law `{}` of interface `{}` forms no bonds in contact; drop `healing` or choose another cohesion",
                    cohesion.plugin.name, self.name
                ),
            });
        }
        if let Some(damage) = &self.damage {
            match &self.cohesion {
                None => {
                    return Err(LawError::Pairing {
                        reason: format!(
                            "the damage law `{}` of interface `{}` has no cohesion to damage; give the interface a cohesion law",
                            damage.plugin.name, self.name
                        ),
                    });
                }
                Some(c) if !c.has(FLAG_OPENING) || c.plugin.degradation <= 0.0 => {
                    return Err(LawError::Pairing {
                        reason: format!(
                            "the cohesion law `{}` of interface `{}` has no opening that the damage law `{}` could follow; choose another cohesion or drop the damage",
                            c.plugin.name, self.name, damage.plugin.name
                        ),
                    });
                }
                Some(_) => {}
            }
        }
        Ok(self)
    }

    /// Returns the number of internal variables over all slots.
    pub fn variables(&self) -> usize {
        self.loaded().map(Loaded::variables).sum()
    }

    /// Returns the number of internal variables of the laws that act on every contact, bonded or not.
    pub fn variables_of_contacts(&self) -> usize {
        let cohesion = self.cohesion.as_ref().filter(|_| !self.opens());
        [Some(&self.contact), cohesion, self.wear.as_ref()]
            .into_iter()
            .flatten()
            .map(Loaded::variables)
            .sum()
    }

    /// Iterates over the columns of the internal variables of bonds.
    pub fn variables_of_bonds(&self) -> impl Iterator<Item = usize> {
        let cohesion = self.cohesion.as_ref().filter(|_| self.opens());
        let bonds = cohesion.into_iter().chain(self.damage.as_ref());
        bonds.flat_map(|l| l.first_variable..l.first_variable + l.variables())
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

    /// Returns whether the cohesion law has an opening and so forms bonds; without one it acts on every
    /// contact.
    pub fn opens(&self) -> bool {
        self.cohesion.as_ref().is_some_and(|c| c.has(FLAG_OPENING))
    }

    /// Returns whether bonds resist bending and twist.
    pub fn rotates(&self) -> bool {
        self.cohesion.as_ref().is_some_and(|c| c.has(FLAG_MOMENT))
    }

    /// Returns whether damage grows, by a damage law or by the cohesion law itself.
    pub fn damages(&self) -> bool {
        self.damage.is_some() || self.cohesion.as_ref().is_some_and(|c| c.has(FLAG_BREAKS))
    }

    /// Returns whether the normal stiffness acts in tension only.
    pub fn tension_only(&self) -> bool {
        self.cohesion
            .as_ref()
            .is_some_and(|c| c.has(FLAG_TENSION_ONLY))
    }

    /// Returns whether friction and restitution are the same for all contacts and steps.
    pub fn constant_contact(&self) -> bool {
        self.contact.has(FLAG_CONSTANT)
    }
}
