//! Requirements of interface laws on the solver, determined before the first step.
//!
//! Bonds are known from the laws' flags. Rolling friction and shear cohesion are values that a
//! contact law returns at run time: a constant law is called once, any other is tried on a bench
//! with trial contacts.

use super::bench::{Bench, BenchMotion, BenchState};
use super::error::LawError;
use super::interface::{BondRule, Interface, LoadedLaw};
use super::kind::Kind;

/// Whether a law requires a feature, from never to always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Requirement {
    /// The law never requires it.
    #[default]
    Never,
    /// The law did not require it in the trials, but decides at run time.
    NotObserved,
    /// The law required it in some of the trials.
    Sometimes,
    /// The law requires it in every closed contact.
    Always,
}

impl Requirement {
    /// Evaluates trials, given as (contact closed, feature required).
    fn of(trials: &[(bool, bool)], constant: bool) -> Self {
        let any = trials.iter().any(|(_, asks)| *asks);
        let all = trials.iter().all(|(touches, asks)| *asks || !touches);
        match (any, all) {
            (true, true) => Self::Always,
            (true, false) => Self::Sometimes,
            _ if constant => Self::Never,
            _ => Self::NotObserved,
        }
    }
}

/// Requirements of an interface on a solver, beyond Signorini's condition.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LawRequirements {
    /// Sliding friction.
    pub friction: Requirement,
    /// Rolling or spinning friction.
    pub rotation: Requirement,
    /// Shear cohesion; `NotObserved` for laws with bonds, which the trials do not cover.
    pub cohesion: Requirement,
}

impl Interface {
    /// Returns the requirements between contacts of these reduced radii (m).
    ///
    /// # Errors
    /// A law's error in a trial.
    pub fn solver_requirements(
        &self,
        dimension: u32,
        radii: &[f64],
    ) -> Result<LawRequirements, LawError> {
        let bonds = self.opens() && (self.bonds != BondRule::Never || self.healing.is_some());
        let acting = self.clone().with_bonds(self.bonds, None)?;
        let tried = |l: &LoadedLaw| {
            let bonds = self.acts_on_bonds(l);
            !bonds && [Kind::CONTACT, Kind::COHESION].contains(&l.plugin.kind)
        };
        let acting = acting.retain(tried)?;
        let constant = acting.constant_contact();
        let simple = constant && acting.cohesion().is_none();
        let (mut rubs, mut moment_steps, mut grips) = (Vec::new(), Vec::new(), Vec::new());
        for radius in radii {
            let mut bench = Bench::new(acting.clone(), dimension, *radius);
            let (mut states, motions) = trials(&bench, *radius);
            let answers = bench.step(&mut states, &motions, STEP)?;
            for (answer, motion) in answers.iter().zip(&motions) {
                let touches = motion.gap <= 0.0;
                rubs.push((touches, answer.mu > 0.0));
                moment_steps.push((touches, answer.rolling.iter().any(|x| *x > 0.0)));
                grips.push((touches, answer.strength[1] > 0.0));
            }
        }
        Ok(LawRequirements {
            friction: Requirement::of(&rubs, constant),
            rotation: Requirement::of(&moment_steps, constant),
            cohesion: Requirement::of(&grips, simple).max(if bonds {
                Requirement::NotObserved
            } else {
                Requirement::Never
            }),
        })
    }
}

/// Time step of the trial (s).
const STEP: f64 = 1e-4;

/// Returns trial contacts: new and old, intact and damaged, compressed and not, at low and high
/// sliding speeds.
fn trials(bench: &Bench, radius: f64) -> (Vec<BenchState>, Vec<BenchMotion>) {
    let (mut states, mut motions) = (Vec::new(), Vec::new());
    for pressure in [0.0, 1e3, 1e6, 1e9] {
        for slide in [0.0, 1e-6, 1e-3, 1.0] {
            for age in [0.0, 1.0] {
                for damage in [0.0, 1.0] {
                    states.push(BenchState {
                        time: age,
                        compression_time: if pressure > 0.0 { age } else { 0.0 },
                        damage,
                        ..bench.fresh()
                    });
                    let gap = if pressure > 0.0 { 0.0 } else { 1e-3 * radius };
                    motions.push(BenchMotion {
                        opening: [0.0, slide * STEP, 0.0],
                        gap,
                        pressure,
                        ..BenchMotion::default()
                    });
                }
            }
        }
    }
    (states, motions)
}
