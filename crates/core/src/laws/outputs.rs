//! The columns that laws write, and what is accepted in them.

use std::fmt;

/// Vectors in the local frame, one column per component.
pub type Triple = [Vec<f64>; 3];

/// Columns written by plugins, named as in the ABI.
#[derive(Debug, Default)]
#[allow(missing_docs)]
pub struct Outputs {
    pub friction: Vec<f64>,
    pub restitution_n: Vec<f64>,
    pub restitution_t: Vec<f64>,
    pub tension_strength: Vec<f64>,
    pub shear_cohesion: Vec<f64>,
    pub rolling: Vec<f64>,
    pub spinning: Vec<f64>,
    pub traction: Triple,
    pub stiffness_n: Vec<f64>,
    pub stiffness_t: Vec<f64>,
    pub damping_n: Vec<f64>,
    pub damping_t: Vec<f64>,
    pub energy: Vec<f64>,
    pub damage: Vec<f64>,
    pub volume: Vec<f64>,
    pub moment: Triple,
    pub stiffness_twist: Vec<f64>,
    pub stiffness_bend: Vec<f64>,
    pub contact_force: Triple,
    pub contact_stiffness_n: Vec<f64>,
    pub contact_stiffness_t: Vec<f64>,
    pub contact_unloading_t: Vec<f64>,
    /// Energy that the tangential spring of a contact holds, where the law tells it (J);
    /// `out_energy` of contact laws.
    pub contact_energy_t: Vec<f64>,
    pub contact_damping_n: Vec<f64>,
    pub contact_damping_t: Vec<f64>,
    pub conductance: Vec<f64>,
    pub electric_conductance: Vec<f64>,
}

/// Columns that have one size.
pub(super) type Group<'a, const N: usize> = [&'a mut Vec<f64>; N];

impl Outputs {
    /// The columns of every call, those of compliant contacts, and those of transport.
    pub(super) fn groups(&mut self) -> (Group<'_, 22>, Group<'_, 9>, Group<'_, 2>) {
        let [tn, t1, t2] = &mut self.traction;
        let [mn, m1, m2] = &mut self.moment;
        let [force_n, f1, f2] = &mut self.contact_force;
        let all = [
            &mut self.friction,
            &mut self.restitution_n,
            &mut self.restitution_t,
            &mut self.tension_strength,
            &mut self.shear_cohesion,
            &mut self.rolling,
            &mut self.spinning,
            &mut self.stiffness_n,
            &mut self.stiffness_t,
            &mut self.damping_n,
            &mut self.damping_t,
            &mut self.energy,
            &mut self.damage,
            &mut self.volume,
            &mut self.stiffness_twist,
            &mut self.stiffness_bend,
            tn,
            t1,
            t2,
            mn,
            m1,
            m2,
        ];
        let springs = [
            &mut self.contact_stiffness_n,
            &mut self.contact_stiffness_t,
            &mut self.contact_unloading_t,
            &mut self.contact_energy_t,
            &mut self.contact_damping_n,
            &mut self.contact_damping_t,
            force_n,
            f1,
            f2,
        ];
        let transport = [&mut self.conductance, &mut self.electric_conductance];
        (all, springs, transport)
    }

    /// Iterates over all columns.
    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let (all, springs, transport) = self.groups();
        all.into_iter().chain(springs).chain(transport)
    }
}

/// A column that a call of a law writes.
#[derive(Debug)]
pub struct Output<'a> {
    /// Its name in the plugin interface.
    pub name: &'static str,
    /// One value a contact.
    pub values: &'a mut Vec<f64>,
    /// What is accepted; any finite value without it.
    pub range: Option<Range>,
}

impl<'a> Output<'a> {
    /// A column with a range.
    pub fn ranged((name, values, range): (&'static str, &'a mut Vec<f64>, Range)) -> Self {
        Self {
            name,
            values,
            range: Some(range),
        }
    }

    /// A column of any finite values.
    pub fn finite((name, values): (&'static str, &'a mut Vec<f64>)) -> Self {
        Self {
            name,
            values,
            range: None,
        }
    }
}

/// Accepted range of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Not negative: strengths, stiffnesses, damping, volumes, lengths.
    NotNegative,
    /// From 0 to 1: damage, normal restitution.
    Share,
    /// From -1 to 1: tangential restitution.
    Signed,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotNegative => "[0, infinity)",
            Self::Share => "[0, 1]",
            Self::Signed => "[-1, 1]",
        })
    }
}
