//! Uncertainty of the main results.

use crate::error_estimate::{Change, Effects, Repeats};
use crate::friction_report::Friction;
pub use crate::quantity::Estimate;
use crate::quantity::unit::{ENERGY, VOLUME, WORD};
use crate::quantity::{DESCRIBES_THE_RUN, Findings, Role, Topic, number, part};
use crate::scatter;
use serde::Serialize;

crate::described! {
    /// The main results.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct Uncertainty {
        /// Friction coefficient: the mean over the later cycles, or the second half of the time.
        pub friction_coefficient: Estimate = part::<Estimate>(),
        /// Broken bonds over bonds made; its half-widths are those of the sum of the damage of all
        /// bonds, of which the ratio counts the part that is complete.
        pub damage_ratio: Estimate = part::<Estimate>(),
        /// Volume worn off first bodies.
        pub wear: Estimate = part::<Estimate>(),
        /// Energy dissipated by friction.
        pub friction_energy: Estimate = part::<Estimate>(),
        /// The repeated steps on which `step`, `tolerance` and `coupling` rest, and shares of the
        /// energy.
        pub repeats: Repeats = part::<Repeats>(),
    }
}

impl Uncertainty {
    /// Creates the estimates from the results of the observers and of repeated steps.
    pub fn new(found: &Findings, repeats: Repeats) -> Self {
        let mut all = Self::scattered(found);
        let energy = found.number("energy.friction");
        all.friction_energy.value = energy.filter(|e| *e > 0.0);
        repeated(&mut all.friction_coefficient, &repeats, |e| {
            e.friction_coefficient
        });
        repeated(&mut all.damage_ratio, &repeats, |e| e.damage);
        repeated(&mut all.wear, &repeats, |e| e.wear);
        repeated(&mut all.friction_energy, &repeats, |e| e.friction_energy);
        let judged = [
            &mut all.friction_coefficient,
            &mut all.damage_ratio,
            &mut all.wear,
            &mut all.friction_energy,
        ];
        for estimate in judged {
            *estimate = std::mem::take(estimate).judged();
        }
        all.repeats = repeats;
        all
    }

    /// Returns the values, and their scatter within the run.
    fn scattered(found: &Findings) -> Self {
        let mut all = Self::default();
        let friction = found.get::<Friction>();
        let mu = &mut all.friction_coefficient;
        mu.value = found.number("friction_coefficient");
        if let Some(scatter) = friction.and_then(|f| f.scatter.as_ref()) {
            mu.method = Some(scatter.method());
            mu.scatter = scatter.half_width();
            mu.scope = mu.scatter.map(|_| scatter.scope());
        }
        // The ratio of the sums over blocks is that of the second half.
        let mean = friction.filter(|f| f.oscillates).and_then(|f| {
            let scatter = f.scatter.as_ref()?;
            scatter.half_width()?;
            Some((scatter.flow.mean, format!("mean of {}", scatter.over)))
        });
        let own = mu.value.zip(friction).map(|(own, friction)| {
            let complete = friction.cycles.iter().rev().find(|c| c.complete);
            let last = complete.or(friction.cycles.last());
            let part = match last.filter(|_| friction.oscillates) {
                Some(cycle) => format!("cycle {}", cycle.cycle),
                None => "second half of the time".to_owned(),
            };
            let begun = complete.map_or("begun ", |_| "");
            (own, format!("{begun}{part}"))
        });
        (mu.value, mu.statistic) = mean.or(own).unzip();
        let bonds = found.number("bonds").unwrap_or(0.0);
        all.damage_ratio.value = found.number("damage_ratio").filter(|_| bonds > 0.0);
        let worn = found.number("wear.volume_first_bodies");
        let Some(worn) = worn.filter(|worn| *worn > 0.0) else {
            return all;
        };
        all.wear.value = Some(worn);
        let Some(friction) = friction else { return all };
        let cycles = &friction.cycles;
        let complete = cycles.iter().filter(|c| c.complete).count();
        // A cycle that represents several is not a sample like the others.
        let single = cycles.iter().all(|c| c.jumped == 0);
        let alike = friction.oscillates && complete > 0 && single;
        if let Some(s) = scatter::over_cycles(cycles, |c| Some(c.wear_volume)).filter(|_| alike) {
            all.wear.scatter = s.half_width().map(|w| w * complete as f64);
            all.wear.scope = all.wear.scatter.map(|_| s.scope());
            all.wear.method = Some(format!("wear of a cycle times {complete}: {}", s.method()));
        }
        all
    }

    /// Adds the estimates to their quantities, and warns of large errors.
    pub fn report(&self, found: &mut Findings) {
        found.begin(Topic::Run, Role::Diagnostic);
        found.part("uncertainty", self, "");
        for (name, unit) in [("wear", VOLUME), ("friction_energy", ENERGY)] {
            found.edit_all(&[&format!("uncertainty.{name}")], |q| {
                if q.unit != WORD {
                    q.unit = unit;
                }
            });
        }
        found.edit_all(&["uncertainty"], |q| {
            q.lacks(DESCRIBES_THE_RUN);
        });
        for (name, estimate) in [
            ("friction_coefficient", &self.friction_coefficient),
            ("damage_ratio", &self.damage_ratio),
            ("wear.volume_first_bodies", &self.wear),
            ("energy.friction", &self.friction_energy),
        ] {
            let known = estimate.scatter.is_some() || estimate.settings().next().is_some();
            if known || estimate.statistic.is_some() {
                found.estimate(name, estimate);
            }
        }
        self.friction_coefficient.as_result(found);
        if self.wear.settings().next().is_some() {
            found.edit("wear.volume_first_bodies", |q| {
                q.remark("");
            });
        }
        let repeats = &self.repeats;
        let text = match &repeats.reason {
            Some(reason) => format!("none, {reason}"),
            None => format!(
                "{} steps repeated at each of {} places, at the cost of {} % of the run",
                repeats.steps,
                repeats.places,
                number(100.0 * repeats.cost_share, 2)
            ),
        };
        found.edit("uncertainty.repeats.places", |q| {
            q.sentence("estimate of the error", text);
        });
        found.warn(repeats.warnings());
    }
}

impl Estimate {
    /// Makes the value of the friction coefficient that of this estimate: one number of one name.
    fn as_result(&self, found: &mut Findings) {
        let Some((value, statistic)) = self.value.zip(self.statistic.as_ref()) else {
            return;
        };
        found.edit("friction_coefficient", |q| {
            q.value = value.into();
            q.remark(format!("{statistic}: |Q|/P while the contact slides"));
        });
    }
}

/// Adds the results of repeated steps for a result.
fn repeated(result: &mut Estimate, repeats: &Repeats, part: fn(&Effects) -> Option<Change>) {
    let size = result.value.map(f64::abs);
    let half = |effects: &Effects| Some(size? * part(effects)?.bound());
    result.coupling = repeats.coupling.as_ref().and_then(half);
    (result.step, result.tolerance) = (half(&repeats.step), half(&repeats.tolerance));
}
