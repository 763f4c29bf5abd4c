//! The mass ledger of the tribological circuit: the place of each grain, and the flows between the
//! places.
//!
//! A grain is tied to a first body, in the contact, ejected, or lost. With M the mass in the
//! contact, E that in the ejection zones, T that of the first bodies' grains and W the lost mass,
//! over any interval dM = Qs - Qa + Qr - Qe, dE = Qe - Qr - Qw, dT = Qa - Qs, dW = Qw: source flow
//! Qs, reattachment Qa, ejection Qe, recirculation Qr, wear flow Qw. The flows follow N. Fillot, I.
//! Iordanoff, Y. Berthier, "Modelling third body flows with a discrete element method: a tool for
//! understanding wear with adhesive particles", Tribol. Int. 40 (2007) 973; Qa is added here for
//! bonds that heal.
//!
//! Flows are counted when grains change place, contents from the current places. The two are
//! compared each time, exactly in grains and to rounding in mass.

use serde::{Deserialize, Serialize};

/// Location of a grain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum GrainPlace {
    /// Grain that a path of bonds connects to the first body of this index.
    Tied(u32),
    /// Loose grain between the first bodies.
    Contact,
    /// Grain in the ejection zone of this index.
    Ejected(u32),
    /// Grain that is lost permanently.
    Lost,
}

/// Number of grains and their mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Amount {
    /// Number of grains.
    pub grains: i64,
    /// Mass (kg; kg/m in 2D).
    pub mass: f64,
}

impl Amount {
    /// Adds this number of grains with their total mass.
    pub fn add(&mut self, grains: i64, mass: f64) {
        self.grains += grains;
        self.mass += mass;
    }
}

/// Grains and their mass, by place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MassByPlace {
    /// Amount tied to first bodies.
    pub tied: Amount,
    /// Amount in the contact, M.
    pub contact: Amount,
    /// Amount in ejection zones.
    pub ejected: Amount,
    /// Amount that is lost.
    pub lost: Amount,
}

impl MassByPlace {
    /// Counts all grains.
    pub fn count(places: &[GrainPlace], masses: &[f64]) -> Self {
        let mut contents = Self::default();
        for (place, mass) in places.iter().zip(masses) {
            contents.at(*place).add(1, *mass);
        }
        contents
    }

    fn at(&mut self, place: GrainPlace) -> &mut Amount {
        match place {
            GrainPlace::Tied(_) => &mut self.tied,
            GrainPlace::Contact => &mut self.contact,
            GrainPlace::Ejected(_) => &mut self.ejected,
            GrainPlace::Lost => &mut self.lost,
        }
    }
}

/// Flows accumulated since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flows {
    /// Amount moved from first bodies to the contact, source.
    pub source: Amount,
    /// Amount moved from the contact to first bodies, by newly formed bonds.
    pub attached: Amount,
    /// Amount moved from the contact to ejection zones.
    pub ejected: Amount,
    /// Amount moved from ejection zones back to the contact.
    pub recirculated: Amount,
    /// Amount moved from ejection zones to lost, wear.
    pub wear: Amount,
}

/// The ledger.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct MassLedger {
    masses: Vec<f64>,
    places: Vec<GrainPlace>,
    start: MassByPlace,
    /// Current contents, counted.
    pub contents: MassByPlace,
    /// Accumulated flows.
    pub flows: Flows,
}

impl MassLedger {
    /// Creates a ledger for grains of these masses (kg; kg/m in 2D) at these places.
    pub fn new(masses: Vec<f64>, places: Vec<GrainPlace>) -> Self {
        let start = MassByPlace::count(&places, &masses);
        Self {
            masses,
            places,
            start,
            contents: start,
            flows: Flows::default(),
        }
    }

    /// Returns the places of the grains.
    pub fn places(&self) -> &[GrainPlace] {
        &self.places
    }

    /// Updates the places of the grains. Each grain passes through all intermediate places.
    pub fn update(&mut self, places: &[GrainPlace]) {
        for (k, new) in places.iter().enumerate() {
            let old = std::mem::replace(&mut self.places[k], *new);
            if old == *new {
                continue;
            }
            let (from, to, mass) = (rank(old), rank(*new), self.masses[k]);
            let f = &mut self.flows;
            let out = [&mut f.source, &mut f.ejected, &mut f.wear];
            // A lost grain that reappears is not counted as wear.
            for step in out.into_iter().take(to).skip(from) {
                step.add(1, mass);
            }
            if to < from {
                if from == 3 {
                    f.wear.add(-1, -mass);
                }
                if from >= 2 && to <= 1 {
                    f.recirculated.add(1, mass);
                }
                if to == 0 {
                    f.attached.add(1, mass);
                }
            }
        }
        self.contents = MassByPlace::count(&self.places, &self.masses);
    }

    /// Returns counted contents minus those from flows, by place: zero in grains, rounding in mass.
    pub fn residual(&self) -> MassByPlace {
        let (now, start, f) = (&self.contents, &self.start, &self.flows);
        let rest = |now: Amount, start: Amount, enter: &[Amount], leave: &[Amount]| {
            let mut rest = Amount::default();
            rest.add(now.grains - start.grains, now.mass - start.mass);
            enter.iter().for_each(|a| rest.add(-a.grains, -a.mass));
            leave.iter().for_each(|a| rest.add(a.grains, a.mass));
            rest
        };
        MassByPlace {
            tied: rest(now.tied, start.tied, &[f.attached], &[f.source]),
            contact: rest(
                now.contact,
                start.contact,
                &[f.source, f.recirculated],
                &[f.attached, f.ejected],
            ),
            ejected: rest(
                now.ejected,
                start.ejected,
                &[f.ejected],
                &[f.recirculated, f.wear],
            ),
            lost: rest(now.lost, start.lost, &[f.wear], &[]),
        }
    }
}

/// Places in the order in which mass passes them.
fn rank(place: GrainPlace) -> usize {
    match place {
        GrainPlace::Tied(_) => 0,
        GrainPlace::Contact => 1,
        GrainPlace::Ejected(_) => 2,
        GrainPlace::Lost => 3,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    fn places(rng: &mut Pcg64, n: usize) -> Vec<GrainPlace> {
        let one = |k: u32| match k {
            0 => GrainPlace::Tied(0),
            1 => GrainPlace::Tied(1),
            2 => GrainPlace::Contact,
            3 => GrainPlace::Ejected(0),
            4 => GrainPlace::Ejected(1),
            _ => GrainPlace::Lost,
        };
        (0..n).map(|_| one(rng.random_range(0..6))).collect()
    }

    #[test]
    fn whatever_grains_do_the_sum_is_zero() {
        let mut rng = Pcg64::seed_from_u64(3);
        let masses: Vec<f64> = (0..500).map(|_| rng.random_range(1e-9..1e-6)).collect();
        let total: f64 = masses.iter().sum();
        let first = places(&mut rng, 500);
        let mut ledger = MassLedger::new(masses, first);
        for _ in 0..200 {
            let next = places(&mut rng, 500);
            ledger.update(&next);
            let r = ledger.residual();
            for a in [r.tied, r.contact, r.ejected, r.lost] {
                assert_eq!(a.grains, 0);
                // 200 sums of a few thousand terms.
                assert!(a.mass.abs() < 1e-11 * total, "{a:?}");
            }
        }
        let f = ledger.flows;
        assert!(f.source.grains > 0 && f.attached.grains > 0 && f.recirculated.grains > 0);
    }

    #[test]
    fn a_grain_that_flies_out_at_once_passes_every_flow() {
        let mut ledger = MassLedger::new(vec![2.0], vec![GrainPlace::Tied(0)]);
        ledger.update(&[GrainPlace::Lost]);
        let one = Amount {
            grains: 1,
            mass: 2.0,
        };
        let f = ledger.flows;
        assert_eq!([f.source, f.ejected, f.wear], [one; 3]);
        assert_eq!([f.attached, f.recirculated], [Amount::default(); 2]);
    }

    /// Qs = Cs (Mmax - M) and Qe = Qw = Ce M, the linear closure: M tends to Cs Mmax/(Cs + Ce) with
    /// the time constant 1/(Cs + Ce), and Qw to Cs Ce Mmax/(Cs + Ce).
    #[test]
    fn imposed_linear_flows_give_their_closed_form() {
        let (cs, ce, most, dt) = (3.0, 2.0, 4_000usize, 1e-3);
        // A first body with sufficient mass.
        let n = 8 * most;
        let mut places = vec![GrainPlace::Tied(0); n];
        let mut ledger = MassLedger::new(vec![1.0; n], places.clone());
        let (mut loose, mut lost, mut due) = (0, 0, [0.0f64; 2]);
        let tau = 1.0 / (cs + ce);
        let level = cs * most as f64 * tau;
        for step in 1..=2000 {
            let m = ledger.contents.contact.mass;
            due[0] += cs * (most as f64 - m) * dt;
            due[1] += ce * m * dt;
            for _ in 0..due[0].floor() as usize {
                places[loose] = GrainPlace::Contact;
                loose += 1;
            }
            for _ in 0..due[1].floor() as usize {
                places[lost] = GrainPlace::Lost;
                lost += 1;
            }
            due = due.map(f64::fract);
            ledger.update(&places);
            let exact = level * (1.0 - (-(step as f64) * dt / tau).exp());
            // The error of Euler's method is dt/2 in the exponent, and counting whole grains adds a
            // few.
            let off = (ledger.contents.contact.mass - exact).abs();
            assert!(off < 0.5 * dt / tau * level + 4.0, "step {step}: {off}");
            let worn = ce * level * (step as f64 * dt - tau * exact / level);
            let off = (ledger.flows.wear.mass - worn).abs();
            assert!(off < 0.5 * dt * ce * level + 4.0, "step {step}: {off}");
        }
        assert_eq!(ledger.residual().contact.grains, 0);
    }
}
