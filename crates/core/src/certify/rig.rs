//! A law with its partners on the bench, and the law's characteristic opening.

use crate::laws::bench::{Bench, BenchMotion, BenchOutputs};
use crate::laws::{Interface, Kind, LawError, LoadedLaw, Plugin, SearchPath};
use rand::{RngExt, SeedableRng};

/// Reduced radius of the contacts on the bench (m); the area is pi r^2 in 3D.
pub const RADIUS: f64 = 1e-5;
/// Compressive pressure for laws that need one (Pa).
pub const PRESSURE: f64 = 1e6;

/// A law with its partners on the bench.
pub struct Rig {
    /// Bench that does not report values out of range as errors.
    pub bench: Bench,
    law: Interface,
    dimension: u32,
    /// Name of the cohesion beside the law, as a suffix for texts; empty without one.
    partner: String,
    /// Opening at which damage begins, or for a law without damage the one that stores 1 J/m^2 (m);
    /// set by [`Self::find_scale`].
    pub onset: f64,
    /// Opening at which the bond breaks, if it does (m).
    pub end: Option<f64>,
    /// Kind of the law under test.
    pub kind: Kind,
}

/// Finds a law by its name, with default parameters.
fn by_default(path: &SearchPath, kind: Kind, name: &str) -> Result<LoadedLaw, LawError> {
    Ok(LoadedLaw::with_defaults(path.find(kind, name)?))
}

impl Rig {
    /// Creates one rig for each set of partners of the kind of law. A damage law is combined with
    /// `cohesion` if given, else once with a linear bond (m = 1) and once with that of MAC (m = 2).
    pub fn all(
        plugin: &Plugin,
        parameters: &[f64],
        cohesion: Option<&LoadedLaw>,
        path: &SearchPath,
    ) -> Result<Vec<Self>, LawError> {
        let own = LoadedLaw::new(plugin.clone(), parameters.to_vec());
        let mut laws: Vec<(String, Vec<LoadedLaw>)> = Vec::new();
        for set in plugin.kind.spec().certificate.partners {
            let mut slots = vec![own.clone()];
            let mut partner = String::new();
            for (kind, name) in *set {
                let law = match cohesion.filter(|_| *kind == Kind::COHESION) {
                    Some(given) => given.clone(),
                    None => by_default(path, *kind, name)?,
                };
                if *kind == Kind::COHESION {
                    partner.clone_from(&law.plugin.name);
                }
                slots.push(law);
            }
            if !slots.iter().any(|l| l.plugin.kind == Kind::CONTACT) {
                slots.push(by_default(path, Kind::CONTACT, "frictionless")?);
            }
            // Sets that become equal by the given cohesion are tested once.
            if cohesion.is_none() || !laws.iter().any(|(known, _)| *known == partner) {
                laws.push((partner, slots));
            }
        }
        let planar = plugin.flags & fretwork_abi::FLAG_2D_ONLY != 0;
        let dimension = if planar { 2 } else { 3 };
        laws.into_iter()
            .map(|(partner, law)| {
                let law = Interface::new("bench", law)?;
                Ok(Self {
                    bench: Bench::new(law.clone(), dimension, RADIUS).lenient(),
                    law,
                    dimension,
                    partner: if partner.is_empty() {
                        String::new()
                    } else {
                        format!(" (with {partner})")
                    },
                    onset: 1e-7,
                    end: None,
                    kind: plugin.kind,
                })
            })
            .collect()
    }

    /// Returns the name of the cohesion beside the law, as a suffix for texts.
    pub fn partner(&self) -> &str {
        &self.partner
    }

    /// Returns whether the laws have an opening.
    pub fn opens(&self) -> bool {
        self.law.opens()
    }

    /// Returns whether damage can grow.
    pub fn damages(&self) -> bool {
        self.law.damages()
    }

    /// Returns the law under test.
    pub fn tested(&self) -> &LoadedLaw {
        self.law.law(self.kind).unwrap_or(self.law.contact())
    }

    /// Returns a second bench with the laws of this one.
    pub fn second_bench(&self) -> Bench {
        self.strict_bench().lenient()
    }

    /// Returns a bench that reports values out of range as errors, as in a run.
    pub fn strict_bench(&self) -> Bench {
        Bench::new(self.law.clone(), self.dimension, RADIUS)
    }

    /// Returns a second bench on which the law under test has other parameters.
    pub fn with_parameters(&self, parameters: &[f64]) -> Bench {
        let mut law = self.law.clone();
        if let Some(tested) = law.parameters_mut(self.kind) {
            *tested = parameters.to_vec();
        }
        Bench::new(law, self.dimension, RADIUS).lenient()
    }

    /// Finds the openings at which damage begins and at which the bond is broken, by one pull in
    /// mode I and, if that causes no damage, one in mode II. Without damage the onset is the
    /// opening that stores 1 J/m^2.
    pub fn find_scale(&mut self) -> Result<(), LawError> {
        if !self.opens() {
            return Ok(());
        }
        // A tenth of a decade apart, from a picometre to ten metres, in one increasing pull.
        let openings: Vec<f64> = (0..=130)
            .map(|k| 10f64.powf(-12.0 + 0.1 * f64::from(k)))
            .collect();
        let mut stored = None;
        for angle in [0.0, std::f64::consts::FRAC_PI_2] {
            let mut answers = Vec::new();
            let mut state = self.bench.fresh();
            for u in &openings {
                let answer = self.bench.step_one(&mut state, &pull(*u, angle), 1.0)?;
                answers.push((*u, answer));
            }
            let first = |test: &dyn Fn(&BenchOutputs) -> bool| {
                answers.iter().find(|a| test(&a.1)).map(|a| a.0)
            };
            stored = stored.or(first(&|a| a.stored >= 1.0));
            if let Some(onset) = first(&|a| a.damage > 0.0) {
                self.onset = onset;
                self.end = first(&|a| a.damage >= 1.0);
                return Ok(());
            }
        }
        self.onset = stored.unwrap_or(1e-6);
        Ok(())
    }

    /// Returns a random walk of `steps` openings, normal and tangential, up to 3 times the onset,
    /// in steps of up to `share` times the onset; for a law without opening these are gaps and
    /// slips.
    pub fn random_walk(&self, seed: u64, steps: usize, share: f64) -> Vec<BenchMotion> {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
        let reach = 3.0 * self.onset;
        let mut at = [0.0; 3];
        let mut turn = [0.0; 3];
        let tangents = if self.dimension == 2 { 2 } else { 3 };
        (0..steps)
            .map(|_| {
                for x in at.iter_mut().take(tangents) {
                    *x += share * self.onset * rng.random_range(-1.0..1.0);
                    *x = f64::clamp(*x, -reach, reach);
                }
                if self.law.rotates() {
                    let bends = if self.dimension == 2 { 1..2 } else { 0..3 };
                    for x in &mut turn[bends] {
                        *x += 0.1 * share * self.onset / RADIUS * rng.random_range(-1.0..1.0);
                    }
                }
                BenchMotion {
                    opening: at,
                    rotation: turn,
                    gap: at[0],
                    pressure: if at[0] <= 0.0 { PRESSURE } else { 0.0 },
                    ..BenchMotion::default()
                }
            })
            .collect()
    }

    /// Returns a vector (normal, two tangents) in tangential axes that are rotated, in 2D reversed.
    pub fn in_rotated_axes(&self, [n, t1, t2]: [f64; 3]) -> [f64; 3] {
        if self.dimension == 2 {
            [n, -t1, 0.0]
        } else {
            [n, 0.8 * t1 - 0.6 * t2, 0.6 * t1 + 0.8 * t2]
        }
    }

    /// Drives one new contact along motions, each over a step of `h` (s).
    pub fn drive(
        &mut self,
        motions: &[BenchMotion],
        h: f64,
    ) -> Result<Vec<BenchOutputs>, LawError> {
        let mut state = self.bench.fresh();
        let step = |motion| self.bench.step_one(&mut state, motion, h);
        motions.iter().map(step).collect()
    }
}

/// Returns a motion that ends at an opening of length `u` (m) at an angle from the normal (rad).
pub fn pull(u: f64, angle: f64) -> BenchMotion {
    let opening = [u * angle.cos(), u * angle.sin(), 0.0];
    BenchMotion {
        opening,
        gap: opening[0],
        ..BenchMotion::default()
    }
}
