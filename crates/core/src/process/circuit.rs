//! The tribological circuit of a run: assignment of grains to first bodies, ejection zones, the
//! mass ledger, and debris when it detaches.

use super::{Process, ProcessError};
use crate::bodies::Bodies;
use crate::contact::Network;
use crate::encoding::{EncodingError, decode, encode};
use crate::geometry::periodic::Periodic;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use crate::wear::bond_forest::BondForest;
use crate::wear::ledger::{GrainPlace, MassLedger};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What becomes of a grain in an ejection zone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum EjectionOutcome {
    /// The grain stays ejected until it leaves the zone, and may return to the contact.
    Stays,
    /// The grain is lost, and removed from the scene, after this time in the zone (s).
    LostAfter(f64),
}

/// An ejection zone outside the contact.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Zone {
    /// Name.
    pub name: String,
    /// Lowest corner (m); minus infinity in unbounded directions. In the plane the third number
    /// is ignored.
    pub low: [f64; 3],
    /// Highest corner (m); infinity in unbounded directions.
    pub high: [f64; 3],
    /// Body that carries the zone; the corners are then in the frame of that body, which may move
    /// but not rotate.
    pub carrier: Option<u32>,
    /// What becomes of the grains in the zone.
    pub outcome: EjectionOutcome,
}

impl Zone {
    /// Returns whether a position, or one of its periodic images, is in the zone.
    fn holds<S: Space>(&self, bodies: &Bodies<S>, periodic: &Periodic, at: &S::Vector) -> bool {
        let origin = self.carrier.map(|b| bodies.position[b as usize]);
        let x = origin.map_or(*at, |o| *at - o);
        (0..S::D).all(|k| match periodic.period[k] {
            // The first image above the low side; a zone that is unbounded along a period contains
            // all of it.
            Some(period) if self.low[k].is_finite() && self.high[k].is_finite() => {
                (x[k] - self.low[k]).rem_euclid(period) < self.high[k] - self.low[k]
            }
            Some(_) => true,
            None => self.low[k] <= x[k] && x[k] < self.high[k],
        })
    }
}

/// Definition of a circuit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CircuitParameters {
    /// First bodies that grains can belong to: bodies with bonds to grains.
    pub bases: Vec<u32>,
    /// Indices of the interfaces whose bonds connect grains to first bodies.
    pub interfaces: Vec<u16>,
    /// Ejection zones; a grain is in the first zone that contains its centre.
    pub zones: Vec<Zone>,
    /// Factor by which masses in the simulation exceed the real ones, see `inertia_scaling`.
    pub scaling: f64,
}

/// Debris: grains that detached together.
#[derive(Clone, Debug)]
pub struct Debris {
    /// Time at which the debris was detected (s).
    pub time: f64,
    /// Identities of the grains.
    pub grains: Vec<u64>,
    /// Mass (kg; kg/m in 2D).
    pub mass: f64,
    /// Centre of mass (m); the third component is zero in the plane.
    pub place: [f64; 3],
    /// Index of the first body from which the debris detached.
    pub base: u32,
    /// Fraction of sliding in the work on the bonds whose failure released it; see
    /// [`crate::contact::BondEnergies::mode_mix`].
    pub mode_mix: f64,
    /// Fracture energy of these bonds (J; J/m in 2D).
    pub energy: f64,
    /// Number of these bonds.
    pub bonds: usize,
}

/// A broken bond.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct BrokenBond {
    bodies: [u32; 2],
    work: [f64; 2],
    fracture: f64,
}

/// The circuit of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GrainCircuit {
    spec: CircuitParameters,
    /// Body indices of the grains.
    grains: Vec<u32>,
    /// Grain index of each body.
    number: Vec<Option<u32>>,
    forest: BondForest,
    /// The mass ledger.
    pub ledger: MassLedger,
    /// Time since which each grain has been in its zone (s).
    since: Vec<f64>,
    /// Bonds formed since the last update.
    formed: Vec<[u32; 2]>,
    /// Bonds broken since the last update.
    broken: Vec<[u32; 2]>,
    /// Bonds that each body lost since it was last connected, by body.
    broken_bonds: BTreeMap<u32, Vec<BrokenBond>>,
    /// Debris detached in the last update.
    #[serde(skip)]
    pub debris: Vec<Debris>,
    /// Wall-clock time spent on the circuit.
    pub cost: Duration,
}

impl GrainCircuit {
    /// Creates the circuit from the current bonds.
    pub fn new<S: Space>(spec: CircuitParameters, s: &Simulation<S>) -> Self {
        let grains: Vec<u32> = s.state.bodies.grains().map(|b| b as u32).collect();
        let mut number = vec![None; s.state.bodies.len()];
        for (k, b) in grains.iter().enumerate() {
            number[*b as usize] = Some(k as u32);
        }
        let between = |b: &[u32; 2]| b.iter().all(|b| counts(*b, &number, &spec));
        let bonds = bonds(&s.state.network, &spec.interfaces).filter(between);
        let forest = BondForest::new(s.state.bodies.len(), &spec.bases, bonds);
        let masses = grains
            .iter()
            .map(|b| s.state.bodies.mass[*b as usize] / spec.scaling);
        let masses: Vec<f64> = masses.collect();
        let mut circuit = Self {
            ledger: MassLedger::new(masses.clone(), vec![GrainPlace::Contact; grains.len()]),
            since: vec![s.state.time; grains.len()],
            number,
            forest,
            grains,
            formed: Vec::new(),
            broken: Vec::new(),
            broken_bonds: BTreeMap::new(),
            debris: Vec::new(),
            cost: Duration::ZERO,
            spec,
        };
        let mut places = circuit.places(s);
        for place in places.iter_mut().filter(|p| **p == GrainPlace::Lost) {
            // The first update removes it.
            *place = GrainPlace::Ejected(0);
        }
        circuit.ledger = MassLedger::new(masses, places);
        circuit
    }

    /// Returns the first bodies.
    pub fn bases(&self) -> &[u32] {
        &self.spec.bases
    }

    /// Returns the place of a body, if it is a grain.
    pub fn place(&self, body: usize) -> Option<GrainPlace> {
        self.number[body].map(|k| self.ledger.places()[k as usize])
    }

    /// Returns the number of grains connected to a first body.
    pub fn tied_to(&self, base: u32) -> usize {
        let tied = |b: &&u32| self.forest.base(**b) == Some(base);
        self.grains.iter().filter(tied).count()
    }

    /// Records the bonds formed and broken in the last step. Must be called after every step.
    pub fn record_bonds<S: Space>(&mut self, s: &Simulation<S>) {
        let clock = Instant::now();
        let (number, spec) = (&self.number, &self.spec);
        let connects = |bodies: &[u32; 2], law: u16| {
            spec.interfaces.contains(&law) && bodies.iter().all(|b| counts(*b, number, spec))
        };
        for (bodies, law) in &s.state.network.bonds_formed {
            if connects(bodies, *law) {
                self.formed.push(*bodies);
            }
        }
        let breaks = s.state.network.bond_breaks.iter();
        for b in breaks.filter(|b| connects(&b.bodies, b.law)) {
            let cut = BrokenBond {
                bodies: b.bodies,
                work: [b.energies.work[0], b.energies.work[1]],
                fracture: b.energies.fracture,
            };
            self.broken.push(b.bodies);
            let is_grain = |b: &&u32| self.number[**b as usize].is_some();
            for body in b.bodies.iter().filter(is_grain) {
                self.broken_bonds.entry(*body).or_default().push(cut);
            }
        }
        self.cost += clock.elapsed();
    }

    /// Updates connections, zones and ledger to the current state, and removes lost grains from the
    /// scene.
    pub fn update<S: Space>(&mut self, s: &mut Simulation<S>) {
        let clock = Instant::now();
        let change = if self.formed.is_empty() && self.broken.is_empty() {
            Default::default()
        } else {
            self.forest.change(&self.formed, &self.broken)
        };
        self.debris.clear();
        for (base, piece) in &change.loose {
            let debris = self.debris_of(s, *base, piece);
            self.debris.push(debris);
        }
        // The list of broken bonds of a grain is cleared when the grain detaches, and when it is
        // reconnected.
        let loose = change.loose.iter().flat_map(|(_, piece)| piece);
        for body in loose.chain(change.tied.iter().map(|(body, _)| body)) {
            self.broken_bonds.remove(body);
        }
        self.formed.clear();
        self.broken.clear();
        let before: Vec<GrainPlace> = self.ledger.places().to_vec();
        let places = self.places(s);
        self.ledger.update(&places);
        for (k, (old, new)) in before.iter().zip(&places).enumerate() {
            if *new == GrainPlace::Lost && *old != GrainPlace::Lost {
                s.remove_body(self.grains[k] as usize);
            }
        }
        self.cost += clock.elapsed();
    }

    /// Returns the current place of each grain.
    fn places<S: Space>(&mut self, s: &Simulation<S>) -> Vec<GrainPlace> {
        let mut places = Vec::with_capacity(self.grains.len());
        for (k, body) in self.grains.iter().enumerate() {
            let old = self.ledger.places()[k];
            if old == GrainPlace::Lost {
                places.push(old);
                continue;
            }
            if let Some(base) = self.forest.base(*body) {
                places.push(GrainPlace::Tied(base));
                continue;
            }
            let (at, periodic) = (&s.state.bodies.position[*body as usize], &s.shapes.periodic);
            let mut zones = self.spec.zones.iter();
            let zone = zones.position(|z| z.holds(&s.state.bodies, periodic, at));
            let Some(zone) = zone else {
                places.push(GrainPlace::Contact);
                continue;
            };
            let now = GrainPlace::Ejected(zone as u32);
            if old != now {
                self.since[k] = s.state.time;
            }
            let lost = match self.spec.zones[zone].outcome {
                EjectionOutcome::Stays => false,
                EjectionOutcome::LostAfter(time) => s.state.time - self.since[k] >= time,
            };
            places.push(if lost { GrainPlace::Lost } else { now });
        }
        places
    }

    fn debris_of<S: Space>(&self, s: &Simulation<S>, base: u32, piece: &[u32]) -> Debris {
        let first = s.state.bodies.position[piece[0] as usize];
        let (mut mass, mut moment) = (0.0, S::Vector::zero());
        for b in piece {
            let b = *b as usize;
            let (m, at) = (s.state.bodies.mass[b], s.state.bodies.position[b]);
            mass += m;
            moment += s.shapes.periodic.shortest(at - first) * m;
        }
        // The bonds between the piece and other bodies, broken at any time since its grains were
        // connected.
        let of = |b: u32| piece.binary_search(&b).is_ok();
        let bonds = piece
            .iter()
            .filter_map(|b| self.broken_bonds.get(b))
            .flatten();
        let cuts = bonds.filter(|c| of(c.bodies[0]) != of(c.bodies[1]));
        let (mut work, mut energy, mut bonds) = ([0.0; 2], 0.0, 0);
        for cut in cuts {
            energy += cut.fracture;
            bonds += 1;
            work = [0, 1].map(|k| work[k] + cut.work[k].max(0.0));
        }
        let all = work[0] + work[1];
        let id = |b: &u32| s.state.bodies.id[*b as usize];
        Debris {
            time: s.state.time,
            grains: piece.iter().map(id).collect(),
            mass: mass / self.spec.scaling,
            place: s
                .shapes
                .periodic
                .wrapped(first + moment * (1.0 / mass))
                .padded(),
            base,
            mode_mix: if all > 0.0 { work[1] / all } else { 0.0 },
            energy,
            bonds,
        }
    }
}

/// Intervals at which the ledger of a circuit is updated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Intervals {
    /// Number of steps between two updates.
    pub every: u64,
    /// Further intervals (steps) at which rows of a table need the current state.
    pub rows: Option<u64>,
}

/// The circuit as a process: once started it records the bonds of every step, and removes lost
/// grains between steps.
#[derive(Clone, Debug)]
pub struct CircuitProcess {
    spec: CircuitParameters,
    start: f64,
    intervals: Intervals,
    state: AccountState,
}

/// The part of a circuit that changes from step to step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct AccountState {
    /// The circuit; `None` before its start.
    circuit: Option<GrainCircuit>,
    /// Number of the last step whose bonds were recorded.
    recorded: u64,
    /// Number of the last step after which the circuit was updated.
    updated: u64,
}

/// No bond ties a grain to a first body of the circuit at its start.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no bond ties a grain to `{body}` when the circuit begins: let bonds be made before (circuit.start), let them reach it \
     (detection.alert, the places of grains), or leave it out of circuit.bases"
)]
pub struct BaseWithoutBonds {
    /// Name of the body.
    pub body: String,
}

impl CircuitProcess {
    /// Creates a circuit that starts after the first step that ends at this time (s) or later.
    pub fn new(spec: CircuitParameters, start: f64, intervals: Intervals) -> Self {
        Self {
            spec,
            start,
            intervals,
            state: AccountState::default(),
        }
    }

    /// Returns the circuit; `None` before its start.
    pub fn circuit(&self) -> Option<&GrainCircuit> {
        self.state.circuit.as_ref()
    }

    /// Returns the start time (s).
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Returns whether the circuit was updated after this number of steps.
    pub fn is_up_to_date(&self, steps: u64) -> bool {
        self.state.updated == steps
    }

    fn begin<S: Space>(&mut self, s: &Simulation<S>) -> Result<(), BaseWithoutBonds> {
        let circuit = GrainCircuit::new(self.spec.clone(), s);
        let untied = |base: &&u32| circuit.tied_to(**base) == 0;
        if let Some(base) = circuit.bases().iter().find(untied) {
            let driven = s.state.bodies.driven.iter().find(|d| d.body == *base);
            return Err(BaseWithoutBonds {
                body: driven.map_or(String::new(), |d| d.name.clone()),
            });
        }
        self.state.circuit = Some(circuit);
        Ok(())
    }

    fn update<S: Space>(&mut self, s: &mut Simulation<S>) {
        if let Some(circuit) = &mut self.state.circuit {
            circuit.update(s);
            self.state.updated = s.state.steps;
        }
    }
}

impl<S: Space> Process<S> for CircuitProcess {
    fn name(&self) -> &str {
        "tribological circuit"
    }

    fn between_steps(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        if s.state.time < self.start - 0.5 * s.options.scheme.h {
            return Ok(());
        }
        let Some(circuit) = &mut self.state.circuit else {
            return Ok(self.begin(s)?);
        };
        circuit.record_bonds(s);
        self.state.recorded = s.state.steps;
        let due = |every: u64| s.state.steps.is_multiple_of(every);
        if due(self.intervals.every) || self.intervals.rows.is_some_and(due) {
            self.update(s);
        }
        Ok(())
    }

    fn at_end(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        if self.state.recorded == s.state.steps && self.state.updated != s.state.steps {
            self.update(s);
        }
        Ok(())
    }

    fn repeats(&self) -> bool {
        true
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.state)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.state = decode(from)?;
        Ok(())
    }
}

/// Returns whether bonds of a body count: those of grains and bases. Another first body is not
/// debris, and connects no grain to a base.
fn counts(body: u32, number: &[Option<u32>], spec: &CircuitParameters) -> bool {
    number[body as usize].is_some() || spec.bases.contains(&body)
}

/// Iterates over the bodies of the intact bonds of these interfaces.
fn bonds<'a, S: Space>(
    network: &'a Network<S>,
    interfaces: &'a [u16],
) -> impl Iterator<Item = [u32; 2]> + 'a {
    let holds = move |c: &&crate::contact::Contact<S>| {
        interfaces.contains(&c.law) && network.bond(c).is_some_and(|b| b.intact())
    };
    network.contacts.iter().filter(holds).map(|c| c.bodies)
}

#[cfg(test)]
mod tests;
