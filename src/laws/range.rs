//! The range in which an output of a law can lie, where physics or the plugin interface gives one.

use super::columns::Outputs;
use super::library::{Call, Kind};
use std::fmt;

/// What is accepted of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// No less than nothing: strengths, stiffnesses, damping, volumes, lengths.
    NotNegative,
    /// From none to all: damage, normal restitution.
    Share,
    /// Back or on, at most as much as came: tangential restitution.
    Signed,
}

impl Range {
    /// Round-off is no error: what a law forms as a share may miss its end by some of it.
    const ROUND_OFF: f64 = 1e-12;

    fn bounds(self) -> (f64, f64) {
        match self {
            Self::NotNegative => (0.0, f64::INFINITY),
            Self::Share => (-Self::ROUND_OFF, 1.0 + Self::ROUND_OFF),
            Self::Signed => (-1.0 - Self::ROUND_OFF, 1.0 + Self::ROUND_OFF),
        }
    }

    /// The first value of a column outside. Nearly always none: all are looked at, without a branch each, before it is
    /// searched for.
    fn first_outside(self, column: &[f64]) -> Option<usize> {
        let (low, high) = self.bounds();
        let outside = |x: &f64| (*x < low) | (*x > high);
        if column.iter().fold(false, |any, x| any | outside(x)) {
            column.iter().position(outside)
        } else {
            None
        }
    }
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

/// A value that cannot be.
pub(super) struct Outside {
    pub contact: usize,
    pub column: &'static str,
    pub value: f64,
    pub range: Range,
}

impl Outputs {
    /// The first column in which a call of this kind gave a value that cannot be. Values are finite. Tractions, moments and
    /// stored energies may have any sign; that damage falls is no error, as the host holds it up.
    pub(super) fn outside(&self, kind: Kind, call: Call) -> Option<Outside> {
        use Range::{NotNegative, Share, Signed};
        type Column<'a> = (&'static str, &'a Vec<f64>, Range);
        let strengths: [Column<'_>; 2] = [
            ("out_tension_strength", &self.tension_strength, NotNegative),
            ("out_shear_cohesion", &self.shear_cohesion, NotNegative),
        ];
        let written: &[Column<'_>] = match (kind, call) {
            (Kind::Contact, Call::Prepare) => &[
                ("out_friction", &self.friction, NotNegative),
                ("out_restitution_n", &self.restitution_n, Share),
                ("out_restitution_t", &self.restitution_t, Signed),
                ("out_rolling", &self.rolling, NotNegative),
                ("out_spinning", &self.spinning, NotNegative),
                strengths[0],
                strengths[1],
            ],
            (Kind::Cohesion, Call::Prepare) => &[
                ("out_stiffness_n", &self.stiffness_n, NotNegative),
                ("out_stiffness_t", &self.stiffness_t, NotNegative),
                ("out_damping_n", &self.damping_n, NotNegative),
                ("out_damping_t", &self.damping_t, NotNegative),
                ("out_stiffness_twist", &self.stiffness_twist, NotNegative),
                ("out_stiffness_bend", &self.stiffness_bend, NotNegative),
                strengths[0],
                strengths[1],
            ],
            (Kind::Damage | Kind::Cohesion, Call::Commit) => &[("out_damage", &self.damage, Share)],
            (Kind::Wear, Call::Commit) => &[("out_volume", &self.volume, NotNegative)],
            _ => &[],
        };
        let found = written.iter().find_map(|(column, values, range)| {
            let contact = range.first_outside(values)?;
            Some(Outside {
                contact,
                column,
                value: values[contact],
                range: *range,
            })
        });
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_outside_is_found_and_round_off_is_not() {
        let share = |column: &[f64]| Range::Share.first_outside(column);
        assert_eq!(share(&[0.0, 1.0, -0.0, 1.0 + 1e-15]), None);
        assert_eq!(share(&[0.5, 2.0, -3.0]), Some(1));
        assert_eq!(share(&[0.5, 0.5, -3.0]), Some(2));
        assert_eq!(Range::Signed.first_outside(&[-1.0, 1.0, -1.1]), Some(2));
        assert_eq!(Range::NotNegative.first_outside(&[1e300, -1e-300]), Some(1));
    }
}
