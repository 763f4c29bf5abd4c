//! Wear rate of first bodies by the grains that come loose from them.

use crate::first_bodies::{BodyHardness, WearMaterials, name_of};
use crate::quantity::unit::{ONE, PASCAL, WEAR_RATE};
use crate::quantity::{Estimate, Findings, Role, Topic, with_half_width};
use crate::steady;
use crate::wear::{LoadPath, archard};
use fretwork_core::process::circuit::Debris;
use fretwork_core::process::sliding::SlidingBody;
use fretwork_core::view::{FieldValues, RunView};
use serde::{Deserialize, Serialize};

/// Observers whose results the wear rate is computed from: the friction test tells which part of
/// its path is slip.
pub(super) const READS: [&str; 1] = ["friction test"];

/// What the wear rate of grains that come loose is computed with.
#[derive(Clone, Debug)]
pub struct WornGrains {
    body: Option<SlidingBody>,
    materials: WearMaterials,
}

/// What a first body lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Loss {
    /// Index of the body.
    base: u32,
    /// Number of pieces of debris, and of their grains.
    pieces: u64,
    grains: u64,
    /// Sum of the masses of the pieces (kg; kg/m), and of their squares.
    mass: f64,
    squares: f64,
}

impl Loss {
    /// Adds a piece to the losses of its first body.
    pub(super) fn add(all: &mut Vec<Self>, piece: &Debris) {
        let known = all.iter().position(|loss| loss.base == piece.base);
        let at = known.unwrap_or_else(|| {
            all.push(Self {
                base: piece.base,
                ..Self::default()
            });
            all.len() - 1
        });
        let loss = &mut all[at];
        loss.pieces += 1;
        loss.grains += piece.grains.len() as u64;
        loss.mass += piece.mass;
        loss.squares += piece.mass * piece.mass;
    }

    /// Returns the losses of all first bodies together.
    fn total(all: &[Self]) -> Self {
        all.iter().fold(Self::default(), |sum, loss| Self {
            base: loss.base,
            pieces: sum.pieces + loss.pieces,
            grains: sum.grains + loss.grains,
            mass: sum.mass + loss.mass,
            squares: sum.squares + loss.squares,
        })
    }

    /// Returns the relative half-width of 95 % of its mass by counting: pieces come loose
    /// independently of each other (Poisson), with masses of their own, so that the variance of
    /// their sum is the sum of the squares.
    fn counting_error(&self) -> f64 {
        const NORMAL: f64 = 1.96;
        NORMAL * self.squares.sqrt() / self.mass
    }
}

/// Relative half-width of a rate, and what it is over.
struct Spread {
    share: f64,
    scope: String,
}

impl Spread {
    /// Returns the larger of the counting error and that of the blocks, by the mass that had come
    /// loose (kg; kg/m) after load paths (J; J/m).
    fn of(loss: &Loss, history: &[(f64, f64)]) -> Self {
        let counted = loss.counting_error();
        let [first, last] = [history.first(), history.last()].map(|p| p.map_or(0.0, |p| p.0));
        let blocks = steady::flow(history, first, last).filter(|flow| flow.mean > 0.0);
        let blocks = blocks.map_or(0.0, |flow| flow.half_width / flow.mean);
        match counted >= blocks {
            true => Self {
                share: counted,
                scope: format!(
                    "within this sample (counting {} pieces of {} grains, Poisson)",
                    loss.pieces, loss.grains
                ),
            },
            false => Self {
                share: blocks,
                scope: format!("within this sample (slip in {} blocks)", steady::BLOCKS),
            },
        }
    }

    fn estimate(&self, value: f64) -> Estimate {
        Estimate {
            value: Some(value),
            scatter: Some(self.share * value),
            scope: Some(self.scope.clone()),
            ..Estimate::default()
        }
        .judged()
    }
}

/// What is known of the grains that came loose at the end of a run.
pub(super) struct LooseGrains<'a> {
    /// By first body.
    pub losses: &'a [Loss],
    /// First bodies in the order of the summary.
    pub bases: &'a [u32],
    /// Load path (J; J/m) of the whole motion, elastic parts included, with the mass (kg; kg/m)
    /// that had come loose by then.
    pub history: &'a [(f64, f64)],
}

impl WornGrains {
    /// Creates it with the rubbed body of the friction test, if there is one.
    pub fn new(body: Option<SlidingBody>, materials: WearMaterials) -> Self {
        Self { body, materials }
    }

    /// Returns normal force times path of the last step (J; J/m in 2D).
    pub(super) fn load_path(&self, run: &dyn RunView) -> f64 {
        self.body.map_or(0.0, |body| {
            let (drive, normal_force) = run.rubbing(&body);
            run.cycle_multiplier() * normal_force * drive.slide.abs()
        })
    }

    /// Adds k = V/(P s) of what came loose since the start of the account, and K = k H of each
    /// first body with its own hardness. The friction test, which reports before, says which part
    /// of the path is slip.
    pub(super) fn report(&self, loose: &LooseGrains<'_>, run: &dyn RunView, found: &mut Findings) {
        let slips = found.get::<LoadPath>().copied();
        let Some(share) = slips.and_then(|p| Some(p.slip? / p.imposed)) else {
            return;
        };
        let path = share * loose.history.last().map_or(0.0, |p| p.0);
        let all = Loss::total(loose.losses);
        let Some(density) = self.density(run).filter(|_| path > 0.0 && all.mass > 0.0) else {
            return;
        };
        found.begin(Topic::Wear, Role::Detail);
        let rate = all.mass / (density * path);
        let spread = Spread::of(&all, loose.history);
        let estimate = spread.estimate(rate);
        let one = loose.losses.len() == 1;
        let mut text = format!("k = V/(P s) = {}", rate_of(rate, &spread, found));
        for loss in loose.losses {
            let own = loss.mass / (density * path);
            let own_spread = if one {
                Spread::of(loss, loose.history)
            } else {
                Spread::of(loss, &[])
            };
            let name = name_of(run, loss.base);
            if !one {
                text += &format!("; of {name} {}", rate_of(own, &own_spread, found));
            }
            text += &self.of_base((loss, &name), own, &own_spread, (loose.bases, one), found);
        }
        let open = match estimate.is_determined() {
            Some(false) => "not determined: ",
            _ => "",
        };
        let doc = "specific wear rate k = V/(P s) of the grains that came loose from first bodies";
        let added = found.add("circuit.specific_rate", rate, WEAR_RATE, doc);
        added.secondary("specific wear rate of grains that came loose");
        added.sentence(
            "wear by loose grains",
            format!("{open}{text} ({})", spread.scope),
        );
        found.estimate("circuit.specific_rate", &estimate);
    }

    /// Adds k and K of a first body; of the only one that lost grains, K is that of the circuit.
    /// Returns K as text.
    fn of_base(
        &self,
        (loss, name): (&Loss, &str),
        rate: f64,
        spread: &Spread,
        (bases, one): (&[u32], bool),
        found: &mut Findings,
    ) -> String {
        let at = bases.iter().position(|base| *base == loss.base);
        let mut add = |key: &str, value: f64, unit, doc: String| {
            if let Some(at) = at {
                found.add(&format!("circuit.bases.{at}.{key}"), value, unit, doc);
            }
        };
        let doc = format!("specific wear rate k = V/(P s) of the grains of `{name}`");
        add("specific_rate", rate, WEAR_RATE, doc);
        let mut own = self.materials.own_hardness.iter();
        let Some(BodyHardness { value, text, .. }) = own.find(|h| h.body == name) else {
            return String::new();
        };
        let coefficient = rate * value;
        let doc = format!("Archard's coefficient K = k H of `{name}`");
        add("archard_coefficient", coefficient, ONE, doc.clone());
        add(
            "hardness",
            *value,
            PASCAL,
            format!("hardness H of `{name}`: {text}"),
        );
        let estimate = spread.estimate(coefficient);
        if let Some(at) = at {
            found.estimate(
                &format!("circuit.bases.{at}.archard_coefficient"),
                &estimate,
            );
            found.estimate(
                &format!("circuit.bases.{at}.specific_rate"),
                &spread.estimate(rate),
            );
        }
        if one {
            found.add("circuit.archard_coefficient", coefficient, ONE, doc);
            found.estimate("circuit.archard_coefficient", &estimate);
        }
        archard(coefficient, estimate.scatter, text)
    }

    /// Returns the density of the grains (kg/m^3); `None` if they are of several materials.
    fn density(&self, run: &dyn RunView) -> Option<f64> {
        let (materials, first_body) = ("material", "first_body");
        let [
            Some(FieldValues::Number(materials)),
            Some(FieldValues::Number(first_body)),
        ] = [materials, first_body].map(|name| run.grain_field(name))
        else {
            return None;
        };
        let grains = materials.iter().zip(first_body);
        let mut grains = grains.filter(|(_, first_body)| *first_body == 0.0);
        let (first, _) = grains.next()?;
        let alike = grains.all(|(material, _)| material == first);
        let density = self.materials.densities.get(*first as usize);
        density.copied().filter(|d| alike && *d > 0.0)
    }
}

/// Returns a rate with its half-width as text.
fn rate_of(rate: f64, spread: &Spread, found: &Findings) -> String {
    let unit = WEAR_RATE.symbol(found.dimension());
    with_half_width(rate, spread.share * rate, unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(base: u32, grains: u64, mass: f64) -> Debris {
        Debris {
            time: 0.0,
            grains: (0..grains).collect(),
            mass,
            place: [0.0; 3],
            base,
            mode_mix: 0.0,
            energy: 0.0,
            bonds: 0,
        }
    }

    /// Losses of pieces of one grain each, of mass 1.
    fn losses(pieces: usize) -> Vec<Loss> {
        let mut all = Vec::new();
        for _ in 0..pieces {
            Loss::add(&mut all, &piece(3, 1, 1.0));
        }
        all
    }

    #[test]
    fn few_pieces_leave_the_rate_undetermined() {
        let spread = |pieces| Spread::of(&losses(pieces)[0], &[]);
        let (few, many) = (spread(8), spread(100));
        assert!((few.share - 1.96 / 8.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(few.estimate(1e-13).is_determined(), Some(false));
        assert_eq!(many.estimate(1e-13).is_determined(), Some(true));
        assert!(
            many.scope.contains("100 pieces of 100 grains"),
            "{}",
            many.scope
        );
        // A single large piece among small ones decides the sum.
        let mut uneven = losses(100);
        Loss::add(&mut uneven, &piece(3, 100, 100.0));
        assert!(uneven[0].counting_error() > 0.9);
    }

    #[test]
    fn losses_are_those_of_the_body_that_lost_the_grains() {
        let mut all = losses(2);
        Loss::add(&mut all, &piece(5, 3, 6.0));
        let of = |k: usize| (all[k].base, all[k].pieces, all[k].grains, all[k].mass);
        assert_eq!([of(0), of(1)], [(3, 2, 2, 2.0), (5, 1, 3, 6.0)]);
        let total = Loss::total(&all);
        assert_eq!((total.pieces, total.mass, total.squares), (3, 8.0, 38.0));
    }

    #[test]
    fn blocks_that_differ_widen_the_interval_of_many_pieces() {
        let loss = &losses(10_000)[0];
        let line = |rate: &dyn Fn(f64) -> f64| {
            let points = (0..=400).map(|k| f64::from(k) / 400.0);
            points.map(|s| (s, rate(s))).collect::<Vec<_>>()
        };
        let even = Spread::of(loss, &line(&|s| 1e4 * s));
        assert!(even.scope.contains("counting") && even.share < 0.02);
        // All comes loose in the first half.
        let early = Spread::of(loss, &line(&|s| 1e4 * (2.0 * s).min(1.0)));
        assert!(early.scope.contains("10 blocks") && early.share > 0.5);
    }
}
