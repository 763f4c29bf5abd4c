//! Errors of the layer of patches as sentences, with numbers in units as elsewhere.

use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::running::RunningError;
use fretwork_rolling::{FrettingError, PatchError, StrokeError};

/// Digits of forces that may differ by little.
const DIGITS: i32 = 6;

/// An error that can be said to a user.
pub(in crate::patch) trait Said {
    /// Returns the sentence.
    fn said(&self) -> String;
}

impl Said for FrettingError {
    fn said(&self) -> String {
        match self {
            Self::Slides { force, limit } => format!(
                "the contact slides away: friction holds forces below {} N, and {} N is asked for; take a lower force, or an amplitude of displacement",
                number(*limit, DIGITS),
                number(*force, DIGITS)
            ),
            Self::Force { wanted, reached } => format!(
                "no shift gives the force of {} N: {} N are reached",
                number(*wanted, DIGITS),
                number(*reached, DIGITS)
            ),
            Self::Amplitude(size) => format!(
                "the amplitude must be positive and finite, got {}",
                number(*size, 4)
            ),
            Self::Tangential(_) | Self::Changes => self.to_string(),
        }
    }
}

impl Said for StrokeError {
    fn said(&self) -> String {
        match self {
            Self::Fretting(error) => error.said(),
            Self::Normal(error) => error.to_string(),
        }
    }
}

impl Said for RunningError {
    fn said(&self) -> String {
        match self {
            Self::Normal { load, source } => format!("under {}: {source}", quantity(*load, "N")),
            Self::Fretting {
                load,
                displacement,
                source,
            } => format!(
                "under {} at an amplitude of {}: {}",
                quantity(*load, "N"),
                quantity(*displacement, "m"),
                source.said()
            ),
            Self::Friction(mu) => format!(
                "the coefficient of friction must be positive and finite, got {}",
                number(*mu, 4)
            ),
            Self::Axis(size) => format!(
                "loads and amplitudes must be positive and finite, got {}",
                number(*size, 4)
            ),
        }
    }
}

impl Said for PatchError {
    fn said(&self) -> String {
        match self {
            Self::Force { wanted, most } => format!(
                "the worn patch carries at most {} along the rolling, and {} is asked for: take a smaller force or fewer passages",
                quantity(*most, "N"),
                quantity(*wanted, "N")
            ),
            Self::Wide { passages, width } => format!(
                "after {} passages the patch is {} wide, and bodies worn that far are no longer the arcs of their radii: take a smaller `count`",
                number(*passages, 4),
                quantity(*width, "m")
            ),
            Self::Spread(passages) => format!(
                "after {} passages the patch leaves every grid that is laid around it, since the bodies have worn to fit each other: take a smaller `count`",
                number(*passages, 4)
            ),
            Self::Normal(_) | Self::Tangential(_) | Self::Coupled(_) => self.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_errors_have_units() {
        let slides = FrettingError::Slides {
            force: 15.0,
            limit: 14.9997,
        };
        let running = RunningError::Fretting {
            load: 50.0,
            displacement: 8e-7,
            source: slides,
        };
        let said = running.said();
        assert!(
            said.starts_with("under 50.00 N at an amplitude of 800.0 nm: the contact slides away: friction holds forces below 14.9997 N, and 15.0000 N"),
            "{said}"
        );
        let spread = PatchError::Spread(1.2345e9).said();
        assert!(spread.starts_with("after 1.234e9 passages"), "{spread}");
        let axis = RunningError::Axis(0.0).said();
        assert!(axis.ends_with("got 0"), "{axis}");
    }
}
