//! Where energy is dissipated: by depth, and by pair of bodies; and what of the friction coefficient that is.
//!
//! A contact's energy counts at its point; what is beyond a face counts in the bin there. A bond that is torn as its
//! contact leaves all reach counts where it was.

use super::cells::MECHANISMS;
use super::gap::{Faces, Gap};
use crate::layer::{Balance, Layer};
use fretwork_core::contact::ContactDissipation;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::Simulation;
use serde::{Deserialize, Serialize};

/// Energies by mechanism (J; J/m in 2D).
pub(super) type Energies = [f64; MECHANISMS.len()];

/// Pairs of bodies that are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Two grains.
    Grains,
    /// The first of the two first bodies and a grain.
    First,
    /// The second and a grain.
    Second,
    /// The two first bodies.
    Bodies,
    /// Another driven body in it.
    Others,
}

impl Place {
    /// All.
    pub const ALL: [Self; 5] = [
        Self::Grains,
        Self::First,
        Self::Second,
        Self::Bodies,
        Self::Others,
    ];

    /// Its name, with those of the first bodies.
    pub fn name(self, between: &(String, String)) -> String {
        match self {
            Self::Grains => "grain_grain".to_owned(),
            Self::First => format!("{}_grain", between.0),
            Self::Second => format!("{}_grain", between.1),
            Self::Bodies => format!("{}_{}", between.0, between.1),
            Self::Others => "others".to_owned(),
        }
    }

    fn of(bodies: [u32; 2], ends: [u32; 2], grain: &[bool]) -> Self {
        let has = |b: u32| bodies.contains(&b);
        let free = bodies.iter().filter(|b| grain[**b as usize]).count();
        match (free, has(ends[0]), has(ends[1])) {
            (2, ..) => Self::Grains,
            (1, true, _) => Self::First,
            (1, _, true) => Self::Second,
            (_, true, true) => Self::Bodies,
            _ => Self::Others,
        }
    }
}

/// The energies since the measure began to count.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(super) struct Dissipation<S: Space> {
    /// By bin, since the last sample.
    pub pending: Vec<Energies>,
    /// By bin, all of it.
    pub bins: Vec<Energies>,
    /// By place, in the order of [`Place::ALL`].
    pub places: [Energies; Place::ALL.len()],
    /// Work of the sliding on the layer, the integral of Q V (J).
    pub work: f64,
    /// The integral of P |V| (J).
    pub load: f64,
    /// What is dissipated and kept, and all work of the driven bodies; their balance when the count began, and now.
    ledger: Option<(Layer<S>, Balance, Balance)>,
    grain: Vec<bool>,
}

impl<S: Space> Dissipation<S> {
    /// Nothing yet.
    pub fn new(bins: usize, grain: Vec<bool>) -> Self {
        Self {
            pending: vec![Energies::default(); bins],
            bins: vec![Energies::default(); bins],
            places: Default::default(),
            work: 0.0,
            load: 0.0,
            ledger: None,
            grain,
        }
    }

    /// Counts from the state at hand on.
    pub fn begin(&mut self, s: &Simulation<S>) {
        let layer = Layer::new(s);
        let balance = layer.balance(s);
        self.ledger = Some((layer, balance, balance));
    }

    /// Whether it counts.
    pub fn counts(&self) -> bool {
        self.ledger.is_some()
    }

    /// Friction coefficient from the ledger: what was dissipated and kept, less the work of the driven bodies other
    /// than that of the sliding, over the integral of P |V|.
    pub fn friction(&self) -> Option<f64> {
        let (_, start, end) = self.ledger.as_ref()?;
        let other = end.other - start.other - self.work;
        (self.load > 0.0).then(|| (end.taken - start.taken - other) / self.load)
    }

    /// Takes in the last step.
    pub fn follow(&mut self, s: &Simulation<S>, faces: &Faces, gap: &Gap, along: usize) {
        let ends = [0, 1].map(|k| faces.body(s, k) as u32);
        let n = &s.network;
        let spent = n.spent.iter().flatten();
        for (contact, spent) in n.contacts.iter().zip(spent) {
            if *spent == ContactDissipation::default() {
                continue;
            }
            let at = s.bodies.position[contact.bodies[0] as usize] + contact.arms[0];
            let energies = [
                spent.friction,
                spent.impact + spent.adhesion,
                spent.fracture,
                spent.viscous,
                spent.correction,
            ];
            self.add(contact.bodies, ends, gap.bin(gap.depth(&at)), energies);
        }
        for torn in n.bond_breaks.iter().filter(|b| b.torn != 0.0) {
            let bin = gap.bin(gap.depth(&torn.place));
            self.add(torn.bodies, ends, bin, [0.0, 0.0, torn.torn, 0.0, 0.0]);
        }
        let sliding = faces.sliding_over_step(s)[along];
        if let Some((impulse, _)) = s.received.get(faces.places[1]) {
            self.work -= impulse[along] * sliding;
            self.load += gap.side * impulse[gap.across] * sliding.abs();
        }
        if let Some((layer, _, end)) = &mut self.ledger {
            // No body's work is kept apart here.
            layer.follow(s, (usize::MAX, 0));
            *end = layer.balance(s);
        }
    }

    fn add(&mut self, bodies: [u32; 2], ends: [u32; 2], bin: usize, energies: Energies) {
        let place = Place::of(bodies, ends, &self.grain) as usize;
        for (k, energy) in energies.into_iter().enumerate() {
            self.places[place][k] += energy;
            self.pending[bin - 1][k] += energy;
            self.bins[bin - 1][k] += energy;
        }
    }

    /// Since the last sample, by bin.
    pub fn take(&mut self) -> Vec<Energies> {
        let none = vec![Energies::default(); self.pending.len()];
        std::mem::replace(&mut self.pending, none)
    }

    /// All of it.
    pub fn total(&self) -> f64 {
        self.places.iter().flatten().sum()
    }
}
