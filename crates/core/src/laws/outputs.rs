//! The columns that laws write, and their accepted ranges.

use std::fmt;

/// Vectors in the local frame, one column per component.
pub type Triple = [Vec<f64>; 3];

/// Declares the columns in groups of one size: single columns, then columns per component.
macro_rules! columns {
    ($($(#[$about:meta])* $group:ident {
        $($(#[$doc:meta])* $column:ident,)* $(; $($triple:ident,)*)?
    })*) => {
        /// Columns written by plugins, named as in the ABI.
        #[derive(Debug, Default)]
        #[allow(missing_docs)]
        pub struct Outputs {
            $($($(#[$doc])* pub $column: Vec<f64>,)* $($(pub $triple: Triple,)*)?)*
        }

        impl Outputs {
            $($(#[$about])*
            pub(super) fn $group(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
                let single = [$(&mut self.$column),*].into_iter();
                single$($(.chain(&mut self.$triple))*)?
            })*

            /// Iterates over all columns.
            pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
                let single = [$($(&mut self.$column),*),*].into_iter();
                single$($($(.chain(&mut self.$triple))*)?)*
            }
        }
    };
}

columns! {
    /// Iterates over the columns that every batch has.
    every {
        friction, restitution_n, restitution_t, tension_strength, shear_cohesion, rolling,
        spinning, stiffness_n, stiffness_t, damping_n, damping_t, energy, damage, volume,
        stiffness_twist, stiffness_bend,
        ; traction, moment,
    }
    /// Iterates over the columns of compliant contacts.
    springs {
        contact_stiffness_n, contact_stiffness_t, contact_unloading_t,
        /// Energy stored in the tangential spring of a contact, where the law reports it (J);
        /// `out_energy` of contact laws.
        contact_energy_t,
        contact_damping_n, contact_damping_t,
        ; contact_force,
    }
    /// Iterates over the columns of transport.
    transport { conductance, electric_conductance, }
}

/// A column that a call of a law writes.
#[derive(Debug)]
pub struct Output<'a> {
    /// Name in the plugin interface.
    pub name: &'static str,
    /// One value per contact.
    pub values: &'a mut Vec<f64>,
    /// Accepted range; `None` for any finite value.
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
    /// Values that are not negative: strengths, stiffnesses, damping, volumes, lengths.
    NotNegative,
    /// Values from 0 to 1: damage, normal restitution.
    Share,
    /// Values from -1 to 1: tangential restitution.
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
