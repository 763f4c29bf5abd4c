//! Observes broken bonds: the ratio of the released energy to the energy that their laws declare,
//! and whether the step resolved them.

mod summary;

pub use summary::{
    FractureSummary, InterfaceBonds, Reference, UNRESOLVED_BREAK_SHARE, UNRESOLVED_ENERGY_ERROR,
};

use super::quantity::{Findings, Role, Topic};
use crate::observer::{Observer, RunEnd};
use fretwork_core::contact::Break;
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::laws::bench::Bench;
use fretwork_core::laws::bench::scale::Mode;
use fretwork_core::laws::{Interface, LawError};
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use fretwork_scene::bond_sites::BondSites;
use fretwork_scene::case::Case;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Number of opening angles, evenly spaced from the normal to the tangent, at which areas of broken
/// bonds are collected for laws that declare no energy.
const ANGLES: usize = 19;
/// Reduced radius of the bond on the bench (m), where the scene has no contacts any more.
const RADIUS: f64 = 1e-3;
/// Share of rotation in the work on a bond above which its energy is compared with that of a pull
/// that also rotates it: declared energies are those of openings.
const TURNS: f64 = 1e-3;
/// Number of bonds broken by rotation that are compared.
const TURNED: usize = 32;
/// Speed at which critical openings are searched (m/s).
const SLOW: f64 = 1e-6;

/// A bond that broke in rotation: its normal and tangential opening (m), twist and bending (rad),
/// area, and released energy (J).
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct RotatedBreak {
    opening: [f64; 2],
    rotation: [f64; 2],
    area: f64,
    released: f64,
}

/// Broken bonds of an interface.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Broken {
    broken: u64,
    torn: u64,
    at_once: u64,
    /// Number of bonds that began at their gap.
    begun_open: u64,
    released: f64,
    /// Part of the released energy that is compared.
    opened: f64,
    /// Energy that the law declares for bonds that opened; NaN where it declares none.
    declared: f64,
    /// Areas of these bonds by angle.
    areas: Vec<f64>,
    /// Bonds that broke in rotation.
    turned: Vec<RotatedBreak>,
}

impl Broken {
    fn add(&mut self, b: &Break, law: &Interface) {
        if !b.damaged {
            self.torn += 1;
            return;
        }
        self.broken += 1;
        self.at_once += u64::from(b.damage_before <= 0.0);
        self.begun_open += u64::from(b.energies.given > 0.0);
        let released = b.energies.fracture + b.energies.given;
        self.released += released;
        if b.energies.turning() > TURNS {
            if self.turned.len() < TURNED {
                self.turned.push(RotatedBreak {
                    opening: b.opening,
                    rotation: b.rotation,
                    area: b.area,
                    released,
                });
            }
            return;
        }
        self.opened += released;
        let angle = b.opening[1].atan2(b.opening[0].max(0.0));
        let declared = law.declared_fracture_energy(angle);
        self.declared += declared.map_or(f64::NAN, |g| g * b.area);
        self.areas.resize(ANGLES, 0.0);
        let place = angle / FRAC_PI_2 * (ANGLES - 1) as f64;
        let low = (place as usize).min(ANGLES - 2);
        let share = place - low as f64;
        self.areas[low] += b.area * (1.0 - share);
        self.areas[low + 1] += b.area * share;
    }

    /// Returns the energy released by bonds in rotation, and the energy of slow pulls to the same
    /// openings and rotations; `None` where a pull does not break a bond.
    fn by_turning_pulls(
        &self,
        law: &Interface,
        dimension: usize,
    ) -> Result<Option<[f64; 2]>, LawError> {
        let mut sums = [0.0; 2];
        for turned in &self.turned {
            let bench = Bench::new(law.clone(), dimension as u32, RADIUS);
            let mut bench = bench.of_area(turned.area);
            let Some(energy) =
                bench.slow_fracture_energy_towards(turned.opening, turned.rotation)?
            else {
                return Ok(None);
            };
            sums[0] += turned.released;
            sums[1] += energy * turned.area;
        }
        Ok(Some(sums))
    }

    /// Returns the energy of slow pulls for these bonds.
    fn by_slow_pulls(&self, bench: &mut Bench) -> Result<Option<f64>, LawError> {
        let mut sum = 0.0;
        for (k, area) in self.areas.iter().enumerate().filter(|(_, a)| **a > 0.0) {
            let angle = FRAC_PI_2 * k as f64 / (ANGLES - 1) as f64;
            match bench.slow_fracture_energy(angle)? {
                Some(energy) => sum += energy * area,
                None => return Ok(None),
            }
        }
        Ok(Some(sum))
    }
}

/// Observes broken bonds.
#[derive(Clone, Debug)]
pub struct Fracture {
    jumps: bool,
    /// Broken bonds of each interface.
    broken: Vec<Broken>,
}

impl Fracture {
    /// Observes the bonds of a simulation.
    pub fn of(case: &Case, run: &dyn RunView) -> Self {
        Self {
            jumps: case.jump.is_some(),
            broken: vec![Broken::default(); run.laws().len()],
        }
    }

    fn energies(&self, run: &dyn RunView, place: usize) -> InterfaceBonds {
        let (law, broken) = (&run.laws()[place], &self.broken[place]);
        let sites = BondSites::of(run, place);
        let radius = sites.as_ref().map_or(RADIUS, |s| s.radius);
        let mut bench = Bench::new(law.clone(), run.dimension() as u32, radius);
        let mut out = InterfaceBonds {
            interface: law.name.clone(),
            broken: broken.broken,
            torn: broken.torn,
            released: broken.released,
            broken_at_once: share(broken.at_once, broken.broken),
            ..InterfaceBonds::default()
        };
        // Values from the bench are omitted for a law that fails on it.
        if broken.broken > 0 {
            if broken.declared.is_finite() {
                (out.declared, out.reference) = (Some(broken.declared), Reference::Declared);
                out.comparable = broken.begun_open == 0;
            } else if let Ok(Some(energy)) = broken.by_slow_pulls(&mut bench) {
                (out.declared, out.reference) = (Some(energy), Reference::SlowPull);
                out.comparable = broken.begun_open == 0
                    && !law.bonds_remember()
                    && bench.fracture_energy_is_constant().unwrap_or(false);
            }
            out.compared = broken.opened;
            if let Ok(Some([released, energy])) = broken.by_turning_pulls(law, run.dimension()) {
                out.compared += released;
                out.declared = out.declared.map(|e| e + energy);
            }
            out.released_over_declared =
                out.declared.filter(|e| *e > 0.0).map(|e| out.compared / e);
        }
        let Ok(Some(scale)) = bench.scale(SLOW) else {
            return out;
        };
        let modes = [&scale.normal, &scale.shear];
        let ends = |m: &Mode| m.broken.or(m.peak.map(|p| p.1));
        out.critical_opening = modes.into_iter().filter_map(ends).reduce(f64::min);
        let peaks = modes.into_iter().filter_map(|m| m.peak.map(|p| p.1));
        out.peak_opening = peaks.reduce(f64::min);
        out.slide(&run.bonds_of(place).slides);
        out.step_times_frequency = sites.map(|sites| {
            let of = |n: f64, t: f64| {
                let squared = (scale.normal.stiffness * n).max(scale.shear.stiffness * t);
                run.options().scheme.h * squared.sqrt()
            };
            [
                of(sites.normal_median, sites.shear_median),
                of(sites.normal, sites.shear),
            ]
        });
        out
    }
}

fn share(part: u64, of: u64) -> Option<f64> {
    (of > 0).then(|| part as f64 / of as f64)
}

impl Observer for Fracture {
    fn name(&self) -> String {
        "fracture energy".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        let laws = run.laws();
        for b in run.bond_breaks() {
            let place = usize::from(b.law);
            if let (Some(broken), Some(law)) = (self.broken.get_mut(place), laws.get(place)) {
                broken.add(b, law);
            }
        }
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let run = end.simulation;
        let laws = run.laws().iter().enumerate();
        let bonded = laws.filter(|(k, law)| run.bonds_of(*k).made > 0 && law.opens());
        let interfaces: Vec<InterfaceBonds> = bonded.map(|(k, _)| self.energies(run, k)).collect();
        if interfaces.is_empty() {
            found.begin(Topic::Damage, Role::Detail);
            let doc = "energy that broken bonds released, over what their laws declare; null without bonds";
            found.parts::<FractureSummary>("fracture", &None::<FractureSummary>, doc);
            return;
        }
        FractureSummary::new(interfaces, self.jumps, run.options()).report(found);
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.broken)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.broken = decode(from)?;
        Ok(())
    }
}
