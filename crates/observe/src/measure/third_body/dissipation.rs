//! Distribution of dissipated energy by depth and by pair of bodies, and its contribution to the
//! friction coefficient.
//!
//! A contact's energy counts at its contact point; beyond a face it counts in the bin at that face.
//! A bond that breaks because its bodies moved out of range counts at its last position.

use super::cells::MECHANISMS;
use super::gap::{Faces, Gap};
use crate::layer::{Balance, LayerBalance};
use fretwork_core::contact::ContactDissipation;
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};

/// Energies by mechanism (J; J/m in 2D).
pub(super) type Energies = [f64; MECHANISMS.len()];

/// Kinds of pairs of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PairKind {
    /// Two grains.
    Grains,
    /// The first of the two first bodies, and a grain.
    First,
    /// The second of the two first bodies, and a grain.
    Second,
    /// The two first bodies.
    Bodies,
    /// Any other driven body.
    Others,
}

impl PairKind {
    /// All.
    pub const ALL: [Self; 5] = [
        Self::Grains,
        Self::First,
        Self::Second,
        Self::Bodies,
        Self::Others,
    ];

    /// Returns the name, which contains those of the first bodies.
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

/// Energies since the start of the account.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Dissipation {
    /// Energies per bin, since the last sample.
    pub pending: Vec<Energies>,
    /// Energies per bin, in total.
    pub bins: Vec<Energies>,
    /// Energies per kind of pair, in the order of [`PairKind::ALL`].
    pub places: [Energies; PairKind::ALL.len()],
    /// Work of the sliding on the layer, the integral of Q V dt (J).
    pub work: f64,
    /// The integral of P |V| dt (J).
    pub load: f64,
    /// Observer of dissipated and stored energy and of the work of all driven bodies, with its
    /// balance at the start of the account and now.
    ledger: Option<(LayerBalance, Balance, Balance)>,
    grain: Vec<bool>,
}

impl Dissipation {
    /// Creates an account that has not started.
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

    /// Starts the account from the current state.
    pub fn begin(&mut self, run: &dyn RunView) {
        let layer = LayerBalance::new(run);
        let balance = layer.balance(run);
        self.ledger = Some((layer, balance, balance));
    }

    /// Whether the account has started.
    pub fn counts(&self) -> bool {
        self.ledger.is_some()
    }

    /// Returns the friction coefficient from the ledger: dissipated and stored energy, less the
    /// work of the driven bodies other than by sliding, over the integral of P |V| dt.
    pub fn friction(&self) -> Option<f64> {
        let (_, start, end) = self.ledger.as_ref()?;
        let other = end.other - start.other - self.work;
        (self.load > 0.0).then(|| (end.taken - start.taken - other) / self.load)
    }

    /// Processes the last step.
    pub fn follow(&mut self, run: &dyn RunView, faces: &Faces, gap: &Gap, along: usize) {
        let ends = [0, 1].map(|k| faces.body(run, k) as u32);
        let mut dissipation = run.dissipation().unwrap_or_default().iter();
        run.visit_contacts(&mut |contact| {
            let Some(spent) = dissipation.next() else {
                return;
            };
            if *spent == ContactDissipation::default() {
                return;
            }
            let energies = [
                spent.friction,
                spent.impact + spent.adhesion,
                spent.fracture,
                spent.viscous,
                spent.correction,
            ];
            let bin = gap.bin(gap.depth(&contact.point));
            self.add(contact.bodies, ends, bin, energies);
        });
        for torn in run.bond_breaks().iter().filter(|b| b.torn != 0.0) {
            let bin = gap.bin(gap.depth(&torn.place));
            self.add(torn.bodies, ends, bin, [0.0, 0.0, torn.torn, 0.0, 0.0]);
        }
        let sliding = faces.sliding_over_step(run)[along];
        if let Some([impulse, _]) = run.received().get(faces.places[1]) {
            self.work -= impulse[along] * sliding;
            self.load += gap.side * impulse[gap.across] * sliding.abs();
        }
        if let Some((layer, _, end)) = &mut self.ledger {
            // The work of no body is excluded here.
            layer.follow(run, None);
            *end = layer.balance(run);
        }
    }

    fn add(&mut self, bodies: [u32; 2], ends: [u32; 2], bin: usize, energies: Energies) {
        let place = PairKind::of(bodies, ends, &self.grain) as usize;
        for (k, energy) in energies.into_iter().enumerate() {
            self.places[place][k] += energy;
            self.pending[bin - 1][k] += energy;
            self.bins[bin - 1][k] += energy;
        }
    }

    /// Returns the energies per bin since the last sample, and resets them.
    pub fn take(&mut self) -> Vec<Energies> {
        let none = vec![Energies::default(); self.pending.len()];
        std::mem::replace(&mut self.pending, none)
    }

    /// Returns the total energy.
    pub fn total(&self) -> f64 {
        self.places.iter().flatten().sum()
    }
}
