//! Wear rate of first bodies by the grains that come loose from them.

use crate::first_bodies::WearMaterials;
use crate::quantity::unit::{ONE, WEAR_RATE};
use crate::quantity::{Findings, Role, Topic, quantity};
use crate::wear::{LoadPath, archard};
use fretwork_core::process::sliding::SlidingBody;
use fretwork_core::view::{FieldValues, RunView};

/// What the wear rate of grains that come loose is computed with.
#[derive(Clone, Debug)]
pub struct WornGrains {
    body: Option<SlidingBody>,
    materials: WearMaterials,
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

    /// Adds k = V/(P s) of a mass (kg; kg/m) that came loose over a load path (J; J/m in 2D), and
    /// K = k H with the hardness of the softest first body.
    pub(super) fn report(
        &self,
        load_path: f64,
        mass: f64,
        run: &dyn RunView,
        found: &mut Findings,
    ) {
        // The elastic part of strokes is that of the friction test.
        let slips = found.get::<LoadPath>().copied();
        let Some(share) = slips.and_then(|p| Some(p.slip? / p.imposed)) else {
            return;
        };
        let path = load_path * share;
        let Some(density) = self.density(run).filter(|_| path > 0.0 && mass > 0.0) else {
            return;
        };
        let rate = mass / (density * path);
        found.begin(Topic::Wear, Role::Detail);
        let doc = "specific wear rate k = V/(P s) of the grains that came loose from first bodies";
        let mut text = quantity(rate, WEAR_RATE.symbol(found.dimension()));
        let first_bodies = self.materials.hardness.iter();
        let softest = first_bodies.min_by(|a, b| a.value.total_cmp(&b.value));
        if let Some(hard) = softest {
            text += &archard(rate * hard.value, &hard.text);
            let doc = format!(
                "Archard's coefficient K = k H of these grains, H {}",
                hard.text
            );
            let coefficient = rate * hard.value;
            found.add("circuit.archard_coefficient", coefficient, ONE, doc);
        }
        let added = found.add("circuit.specific_rate", rate, WEAR_RATE, doc);
        added.secondary("specific wear rate of grains that came loose");
        added.sentence("wear by loose grains", format!("k = V/(P s) = {text}"));
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
