//! Results of the repetitions for the summary.

use super::Increments;
use super::change::{Change, RatioPair};
use super::{ErrorEstimate, FINER, StretchRepeats};
use crate::friction_report::Friction;
use crate::quantity::unit::{ONE, WORD};
use crate::quantity::{part, values};
use fretwork_core::energy::Energy;
use serde::Serialize;

crate::described! {
    /// Effect of one setting on the results: relative changes between the run and its repeats, null
    /// where they cannot be compared.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct Effects {
        /// Friction coefficient, over the places at which the contact slides.
        pub friction_coefficient: Option<Change> = part::<Change>(),
        /// Energy dissipated by friction.
        pub friction_energy: Option<Change> = part::<Change>(),
        /// Sum of the damage of all bonds.
        pub damage: Option<Change> = part::<Change>(),
        /// Volume worn off first bodies.
        pub wear: Option<Change> = part::<Change>(),
    }
}

/// Growth at a place with the settings of the run, and with finer ones.
struct Pair {
    coarse: Increments,
    fine: Increments,
    /// Whether the contact slides there.
    slides: bool,
}

impl Effects {
    fn of(pairs: &[Pair], extrapolation: f64) -> Self {
        let over = |slide: bool, part: fn(&Increments) -> [f64; 2]| {
            let pairs = pairs.iter().filter(|p| p.slides || !slide);
            let pairs = pairs.map(|pair| RatioPair {
                coarse: part(&pair.coarse),
                fine: part(&pair.fine),
            });
            Change::over(&pairs.collect::<Vec<_>>(), extrapolation)
        };
        let change = |part| over(false, part);
        Self {
            friction_coefficient: over(true, |i| [i.work, i.load_path]),
            friction_energy: change(|i| [i.friction_energy, 1.0]),
            damage: change(|i| [i.damage, 1.0]),
            wear: change(|i| [i.wear, 1.0]),
        }
    }
}

crate::described! {
    /// Shares of the energy supplied that are a measure of the error.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
    pub struct Shares {
        /// Energy that the position correction supplies over the external work, or over the energy
        /// dissipated where that is more; null where there is neither.
        pub correction: Option<f64> => ONE,
        /// Energy that the time integration takes (negative where it adds some) over the energy of
        /// the run: the largest of the external work, the energy dissipated, the change of
        /// potential energy, and the kinetic energy at the start but for that of driven bodies;
        /// null where there is none of these.
        pub scheme: Option<f64> => ONE,
        /// Work supplied in steps that missed the tolerance over that in all steps; null where none
        /// is supplied.
        pub unconverged: Option<f64> => ONE,
    }
}

crate::described! {
    /// Repeats of a run, and what they say.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct Repeats {
        /// Number of places.
        pub places: usize => ONE,
        /// Steps that were repeated at each.
        pub steps: u32 => ONE,
        /// Steps done before each place.
        pub at: Vec<u64> = values(ONE),
        /// Places at which a repeated step failed.
        pub failed: u32 => ONE,
        /// Places left out because repeats were dearer than planned.
        pub left_out: u32 => ONE,
        /// Places at which a hundredth of the tolerance was reached; at the others the repeat ended
        /// at four times the largest number of iterations of the run's own steps there, or at 100
        /// if that is more.
        pub tight: usize => ONE,
        /// Cost of the repeats over that of the run, in solver iterations times contacts.
        pub cost_share: f64 => ONE,
        /// Why there is no estimate; null where there is one.
        pub reason: Option<String> => WORD,
        /// A quarter of the step, extrapolated to none at the first order.
        pub step: Effects = part::<Effects>(),
        /// A hundredth of the tolerance.
        pub tolerance: Effects = part::<Effects>(),
        /// Implicit coupling; null where the run has it, or has no damage.
        pub coupling: Option<Effects> = part::<Effects>(),
        /// Shares of the energy.
        pub shares: Shares = part::<Shares>(),
    }
}

impl ErrorEstimate {
    /// Returns the results, given the ledger at the end, the kinetic energy of driven bodies then
    /// (J), and the friction test, if there is one.
    pub fn report(&self, energy: &Energy, driven: f64, friction: Option<&Friction>) -> Repeats {
        let sliding = friction.and_then(|f| f.sliding.as_deref());
        let slides = |[from, to]: [f64; 2]| {
            let within = |span: &[f64; 2]| span[0] <= from && to <= span[1];
            sliding.is_none_or(|spans| spans.iter().any(within))
        };
        let pairs = |fine: fn(&StretchRepeats) -> Option<Increments>| {
            let pair = |p: &StretchRepeats| {
                Some(Pair {
                    coarse: p.base,
                    fine: fine(p)?,
                    slides: slides(p.span),
                })
            };
            self.places.iter().filter_map(pair).collect::<Vec<_>>()
        };
        let coupled = pairs(|p| p.coupled);
        let short = 1.0 / f64::from(FINER);
        let share = |part: f64, whole: f64| (whole > 0.0).then(|| part / whole);
        // The correction is negative where it supplies energy.
        let correction = (-energy.correction).max(0.0);
        // Energy that corrections supply is dissipated elsewhere.
        let dissipated = energy.dissipated() - energy.correction;
        let turned_over = [
            dissipated + energy.scheme.max(0.0),
            energy.potential.abs(),
            energy.initial_kinetic - driven,
        ];
        let turned_over = turned_over
            .into_iter()
            .fold(energy.external_work.abs(), f64::max);
        Repeats {
            places: self.places.len(),
            steps: self.length,
            at: self.places.iter().map(|p| p.step).collect(),
            failed: self.failed,
            left_out: self.left_out,
            tight: self.places.iter().filter(|p| p.tight).count(),
            cost_share: share(self.cost[1], self.cost[0]).unwrap_or(0.0),
            reason: self.reason.clone(),
            step: Effects::of(&pairs(|p| Some(p.finer)), 1.0 / (1.0 - short)),
            tolerance: Effects::of(&pairs(|p| Some(p.tighter)), 1.0),
            coupling: (!coupled.is_empty()).then(|| Effects::of(&coupled, 1.0)),
            shares: Shares {
                correction: share(correction, energy.external_work.abs().max(dissipated)),
                scheme: share(energy.scheme, turned_over),
                unconverged: share(self.supplied[1], self.supplied[0]),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three places at which the force of sliding changes by 1 %, and one in the elastic part of
    /// the stroke, at which it changes by half and turns its sign.
    #[test]
    fn the_elastic_part_of_a_stroke_is_no_error_of_sliding() {
        let place = |from: f64, coarse: f64, fine: f64| {
            let grown = |work| Increments {
                work,
                load_path: 2.0,
                friction_energy: work,
                ..Increments::default()
            };
            StretchRepeats {
                step: 0,
                span: [from, from + 0.1],
                base: grown(coarse),
                finer: grown(fine),
                tighter: grown(coarse),
                tight: true,
                coupled: None,
            }
        };
        let estimate = ErrorEstimate {
            places: vec![
                place(0.1, -0.4, 0.6),
                place(0.5, 0.8, 0.808),
                place(1.5, 0.8, 0.808),
                place(1.8, 0.8, 0.808),
            ],
            ..ErrorEstimate::default()
        };
        let friction = |sliding| Friction {
            sliding,
            ..Friction::default()
        };
        let change = |friction: &Friction| {
            let repeats = estimate.report(&Energy::default(), 0.0, Some(friction));
            repeats.step.friction_coefficient.unwrap()
        };
        let known = change(&friction(Some(vec![[0.4, 1.0], [1.4, 2.0]])));
        assert!((known.change - 0.01 * 4.0 / 3.0).abs() < 1e-12, "{known:?}");
        assert!(known.half_width < 1e-12, "{known:?}");
        assert!(change(&friction(None)).change > 0.4);
        let two = friction(Some(vec![[1.4, 2.0]]));
        let repeats = estimate.report(&Energy::default(), 0.0, Some(&two));
        assert_eq!(repeats.step.friction_coefficient, None);
        assert!(repeats.step.friction_energy.is_some());
    }
}
