//! What the laws of an interface ask of a solver, found out before a step is done.
//!
//! Flags tell of bonds. Friction against rotation and shear cohesion are numbers that a contact law gives at run
//! time: a law that is constant is asked once, any other on a bench of trial contacts.

use super::bench::{Bench, Motion, State};
use super::interface::{BondRule, Interface, Loaded};
use super::kind::Kind;
use super::library::LawError;

/// Whether a law asks for something, from the least to the most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Requirement {
    /// It cannot.
    #[default]
    Never,
    /// Not in the trials, but the law decides at run time.
    Unseen,
    /// In some of the trials.
    Sometimes,
    /// In every contact that touches.
    Always,
}

impl Requirement {
    /// From what trials gave: whether the contact touched, and whether the law asked for it.
    fn of(trials: &[(bool, bool)], constant: bool) -> Self {
        let any = trials.iter().any(|(_, asks)| *asks);
        let all = trials.iter().all(|(touches, asks)| *asks || !touches);
        match (any, all) {
            (true, true) => Self::Always,
            (true, false) => Self::Sometimes,
            _ if constant => Self::Never,
            _ => Self::Unseen,
        }
    }
}

/// What an interface asks of a solver beyond Coulomb's cone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LawRequirements {
    /// Friction against sliding.
    pub friction: Requirement,
    /// Friction against rotation.
    pub rotation: Requirement,
    /// Shear cohesion; unseen of laws of bonds, which are tried in no trial.
    pub cohesion: Requirement,
}

impl Interface {
    /// What it asks for between contacts of these reduced radii (m).
    ///
    /// # Errors
    /// What a law said to the trial.
    pub fn demand(&self, dimension: u32, radii: &[f64]) -> Result<LawRequirements, LawError> {
        let bonds = self.opens() && (self.bonds != BondRule::Never || self.healing.is_some());
        let acting = self.clone().with_bonds(self.bonds, None)?;
        let tried = |l: &Loaded| {
            let bonds = self.acts_on_bonds(l);
            !bonds && [Kind::CONTACT, Kind::COHESION].contains(&l.plugin.kind)
        };
        let acting = acting.retain(tried)?;
        let constant = acting.constant_contact();
        let simple = constant && acting.cohesion().is_none();
        let (mut rubs, mut turns, mut grips) = (Vec::new(), Vec::new(), Vec::new());
        for radius in radii {
            let mut bench = Bench::new(acting.clone(), dimension, *radius);
            let (mut states, motions) = trials(&bench, *radius);
            let answers = bench.step(&mut states, &motions, STEP)?;
            for (answer, motion) in answers.iter().zip(&motions) {
                let touches = motion.gap <= 0.0;
                rubs.push((touches, answer.mu > 0.0));
                turns.push((touches, answer.rolling.iter().any(|x| *x > 0.0)));
                grips.push((touches, answer.strength[1] > 0.0));
            }
        }
        Ok(LawRequirements {
            friction: Requirement::of(&rubs, constant),
            rotation: Requirement::of(&turns, constant),
            cohesion: Requirement::of(&grips, simple).max(if bonds {
                Requirement::Unseen
            } else {
                Requirement::Never
            }),
        })
    }
}

/// Step of the trial (s).
const STEP: f64 = 1e-4;

/// Contacts young and old, whole and worn out, pressed and not, sliding slowly and fast.
fn trials(bench: &Bench, radius: f64) -> (Vec<State>, Vec<Motion>) {
    let (mut states, mut motions) = (Vec::new(), Vec::new());
    for pressure in [0.0, 1e3, 1e6, 1e9] {
        for slide in [0.0, 1e-6, 1e-3, 1.0] {
            for age in [0.0, 1.0] {
                for damage in [0.0, 1.0] {
                    states.push(State {
                        time: age,
                        pressed: if pressure > 0.0 { age } else { 0.0 },
                        damage,
                        ..bench.fresh()
                    });
                    let gap = if pressure > 0.0 { 0.0 } else { 1e-3 * radius };
                    motions.push(Motion {
                        opening: [0.0, slide * STEP, 0.0],
                        gap,
                        pressure,
                        ..Motion::default()
                    });
                }
            }
        }
    }
    (states, motions)
}
