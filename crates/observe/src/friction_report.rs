//! Results of a friction test at its end.

use super::cycle::{Cycle, SlipRegime};
use super::fretting;
use super::friction::Cycles;
use super::quantity::unit::{ENERGY, ONE};
use super::quantity::{Findings, Role, Topic, number, quantity};
use super::scatter::Scatter;
use super::warning::Warning;
use serde::Serialize;

crate::described! {
    /// Friction over the last complete cycle, or the second half of the time; all null without a
    /// friction test.
    #[derive(Clone, Debug, Default, Serialize)]
    pub struct Friction {
        /// Coefficient of sliding: tangential over normal force while the contact slides, without
        /// the elastic travel after a reversal; null in partial slip.
        pub friction_coefficient: Option<f64> => ONE,
        /// Energetic coefficient: work of the tangential force over normal force times the path,
        /// which counts the elastic part of the path.
        pub energetic_coefficient: Option<f64> => ONE,
        /// Energy dissipated and stored by the energy ledger over the same path: an independent
        /// check of the energetic coefficient.
        pub friction_from_dissipation: Option<f64> => ONE,
        /// Largest tangential force over the mean normal force of the same cycle, Q*/P.
        pub peak_friction: Option<f64> => ONE,
        /// Slip ratio: the part of the stroke that is slip; null without reciprocating motion.
        pub slip_ratio: Option<f64> => ONE,
        /// Energy ratio A = E_d/(4 Q* delta*); null without reciprocating motion.
        pub energy_ratio: Option<f64> => ONE,
        /// How the coefficient scatters over cycles or blocks, for its interval.
        #[serde(skip)]
        pub scatter: Option<Scatter>,
        /// Cycles of the test.
        #[serde(skip)]
        pub cycles: Vec<Cycle>,
        /// Whether the contacts slide across the axis of the test alone.
        #[serde(skip)]
        pub across: bool,
        /// Whether the cycles are not periods of the motion.
        #[serde(skip)]
        pub other_period: bool,
        /// Whether the contacts stick.
        #[serde(skip)]
        pub sticks: bool,
        /// Whether the motion is reciprocating.
        #[serde(skip)]
        pub oscillates: bool,
        /// Times between which the contact slides (s); `None` where all of the motion is sliding.
        #[serde(skip)]
        pub sliding: Option<Vec<[f64; 2]>>,
    }
}

const NO_TEST: &str = "the case has no friction test (`friction`)";
/// Names of the results of a friction test.
const NAMES: [&str; 6] = [
    "friction_coefficient",
    "energetic_coefficient",
    "friction_from_dissipation",
    "peak_friction",
    "slip_ratio",
    "energy_ratio",
];

/// Marks the results that cases without a friction test do not have.
pub(crate) fn report_none(found: &mut Findings) {
    found.begin(Topic::Friction, Role::Detail);
    add(&Friction::default(), None, found);
    for name in NAMES.iter().chain(&["cycles", "fretting"]) {
        found.edit(name, |q| {
            q.lacks(NO_TEST);
        });
    }
}

fn add(friction: &Friction, fretting: Option<&fretting::FrettingOutcome>, found: &mut Findings) {
    found.part("", friction, "");
    let doc = "cycles of the friction test";
    found.parts::<Cycle>("cycles", &friction.cycles, doc);
    let doc = "evaluation of a fretting test; null without reciprocating motion";
    found.parts::<fretting::FrettingOutcome>("fretting", &fretting, doc);
}

/// Returns whether a cycle has a coefficient of sliding.
fn slides(cycle: &Cycle) -> bool {
    cycle.friction_coefficient.is_some()
}

/// Adds friction, cycles and the evaluation of a fretting test.
pub(super) fn report(
    cycles: &Cycles,
    fretting: Option<fretting::FrettingOutcome>,
    found: &mut Findings,
) {
    let last = cycles.last();
    let of_strokes = last.filter(|_| cycles.oscillates());
    let along = last.filter(|_| !cycles.across());
    let friction = Friction {
        friction_coefficient: last.and_then(|c| c.friction_coefficient),
        energetic_coefficient: along.map(|c| c.energetic_coefficient),
        friction_from_dissipation: along.map(|c| c.friction_from_dissipation),
        peak_friction: last.and_then(Cycle::peak_ratio),
        slip_ratio: of_strokes.map(|c| c.slip_ratio),
        energy_ratio: of_strokes.map(|c| c.energy_ratio),
        // What still rises as in partial slip has no interval.
        scatter: cycles
            .scatter()
            .filter(|_| cycles.oscillates() || along.is_some_and(slides)),
        cycles: cycles.list.clone(),
        across: cycles.across(),
        sticks: cycles.sticks(),
        other_period: cycles.of_other_period(),
        oscillates: cycles.oscillates(),
        sliding: cycles.sliding().map(<[_]>::to_vec),
    };
    found.begin(Topic::Friction, Role::Detail);
    add(&friction, fretting.as_ref(), found);
    found.warn(friction.warnings());
    let Some(last) = last else {
        found.edit("friction_coefficient", |q| {
            q.headline("friction coefficient").silent();
        });
        return;
    };
    show(&friction, last, fretting.as_ref(), found);
}

fn show(
    friction: &Friction,
    last: &Cycle,
    fretting: Option<&fretting::FrettingOutcome>,
    found: &mut Findings,
) {
    let over = match (fretting.is_some(), last.complete) {
        (true, true) => format!("in cycle {}, the last complete one", last.cycle),
        (false, true) => "over the second half".to_owned(),
        (_, false) => "over the completed part of the evaluated time".to_owned(),
    };
    let none = last.friction_coefficient.is_none();
    let text = no_sliding(friction, last);
    found.edit("friction_coefficient", |q| {
        q.headline("friction coefficient");
        match none {
            true => q.sentence("friction coefficient", text),
            false => q.remark(format!("{over}: |Q|/P while the contact slides")),
        };
    });
    for (name, label, what) in [
        (
            "energetic_coefficient",
            "energetic coefficient",
            "work of Q over P times the path, the elastic part included",
        ),
        (
            "friction_from_dissipation",
            "from the energy ledger",
            "energy dissipated and stored over P times the path",
        ),
        ("peak_friction", "peak Q*/P", "largest |Q| over mean P"),
    ] {
        found.edit(name, |q| {
            q.secondary(label).remark(format!("{over}: {what}"));
        });
    }
    let unit = |unit: super::quantity::Unit| unit.symbol(found.dimension());
    let (joule, newton, volume) = (
        unit(ENERGY),
        unit(super::quantity::unit::FORCE),
        unit(super::quantity::unit::VOLUME),
    );
    let late = friction.cycles.last().filter(|c| c.cycle > 1);
    let shown: Vec<(usize, &Cycle)> = friction
        .cycles
        .first()
        .map(|c| (0, c))
        .into_iter()
        .chain(late.map(|c| (friction.cycles.len() - 1, c)))
        .collect();
    for (k, c) in shown {
        let unfinished = if c.complete { "" } else { " (unfinished)" };
        let text = format!(
            "friction {}, E_d {}, mean P {}, largest |Q| {}, {} bonds broken, worn {}",
            coefficient(c),
            quantity(c.work, joule),
            quantity(c.normal_force, newton),
            quantity(c.tangential_amplitude, newton),
            c.broken,
            quantity(c.wear_volume, volume)
        );
        found.edit(&format!("cycles.{k}.cycle"), |q| {
            q.sentence(format!("cycle {}{unfinished}", c.cycle), text);
        });
    }
    if !friction.oscillates && last.friction_coefficient.is_some() {
        let text = format!("slides one way over {}", quantity(last.path, "m"));
        let doc = "how the contact slides in a motion one way, over the evaluated part of it";
        found
            .finding("sliding_regime", text, doc)
            .about(Topic::Regime);
    }
    let Some(f) = fretting else { return };
    let complete: Vec<&Cycle> = friction.cycles.iter().filter(|c| c.complete).collect();
    if let [first, .., _] = complete[..] {
        let text = format!(
            "{} complete; {} in the first, {} in the last",
            complete.len(),
            coefficient(first),
            coefficient(last)
        );
        found.edit("fretting.energy", |q| {
            q.secondary("dissipated in all cycles");
            q.sentence("cycles", text);
        });
    }
    let whole = if f.regime == last.regime {
        "in all cycles".to_owned()
    } else {
        format!(
            "in cycle {}; {} over all cycles",
            last.cycle,
            f.regime.name()
        )
    };
    let text = if last.moves_together() || friction.sticks {
        "none: the bodies do not slide on each other".to_owned()
    } else if !last.complete {
        "not known: no cycle is complete".to_owned()
    } else {
        format!(
            "{} {whole}; A = E_d/(4 Q* delta*) {}, slip ratio {}, E_d {}, stroke +-{}",
            last.regime.name(),
            number(last.energy_ratio, 3),
            number(last.slip_ratio, 3),
            quantity(last.work, joule),
            quantity(last.amplitude, "m")
        )
    };
    found.edit("fretting.regime", |q| {
        q.secondary("sliding regime")
            .sentence("sliding regime", text);
    });
    if let Some(alpha) = f.alpha {
        let value = number(1e9 * alpha.value, 4);
        let text = match alpha.half_width {
            Some(h) => format!(
                "{value} +- {} mm3/J over all cycles (95 %, jackknife)",
                number(1e9 * h, 2)
            ),
            None => format!("{value} mm3/J"),
        };
        found.edit("fretting.alpha.value", |q| {
            q.about(Topic::Wear).secondary("wear per energy");
            q.sentence("wear per energy", text);
            q.estimate = Some(super::quantity::Estimate {
                value: Some(alpha.value),
                scatter: alpha.half_width,
                method: (alpha.half_width).map(|_| "95 %, jackknife over all cycles".to_owned()),
                ..super::quantity::Estimate::default()
            });
        });
    }
}

/// Returns the coefficient of sliding of a cycle as text.
fn coefficient(cycle: &Cycle) -> String {
    match cycle.friction_coefficient {
        Some(mu) => number(mu, 4),
        None => format!("none ({})", cycle.regime.name()),
    }
}

/// Returns why there is no coefficient of sliding, with what describes the contact instead.
fn no_sliding(friction: &Friction, last: &Cycle) -> String {
    let known = |value: Option<f64>| value.map_or("unknown".to_owned(), |x| number(x, 3));
    if friction.sticks && last.load_path > 0.0 {
        return format!(
            "none: the contact sticks, Q*/P {}",
            known(friction.peak_friction)
        );
    }
    if friction.other_period {
        return "none: the motion turns back more than twice in a cycle, or a cycle has several loops; give its period as `period` of `friction`".to_owned();
    }
    if friction.across {
        return "none: the contacts slide across the axis of the test, not along it; give the other one as `along` of `friction`".to_owned();
    }
    if !friction.oscillates {
        return match (last.reverses(), last.regime) {
            (true, _) => "none: the motion turns back, and its period is not known; give `period` of `friction`".to_owned(),
            (false, SlipRegime::Partial) => format!(
                "none, partial slip: Q rises to the end as that of elastic bodies, to Q*/P {}",
                known(friction.peak_friction)
            ),
            (false, _) => {
                "none: nothing slid under a load in the second half of the time, which is evaluated".to_owned()
            }
        };
    }
    let why = match (last.complete, last.regime) {
        (false, _) => {
            return format!(
                "none, no cycle is complete: Q*/P {} so far",
                known(friction.peak_friction)
            );
        }
        (true, _) if last.moves_together() => {
            return format!(
                "none, the bodies move together: they slide {} of their path, Q*/P {}",
                number(last.path / last.moved, 2),
                known(friction.peak_friction)
            );
        }
        (true, SlipRegime::Partial) => "partial slip",
        (true, _) => "no whole stroke between two reversals yet (a cycle more tells, time.end)",
    };
    format!(
        "none, {why}: Q*/P {}, slip ratio {}, A = E_d/(4 Q* delta*) {}",
        known(friction.peak_friction),
        known(friction.slip_ratio),
        known(friction.energy_ratio)
    )
}

impl Friction {
    fn warnings(&self) -> Vec<Warning> {
        let both = [self.energetic_coefficient, self.friction_from_dissipation];
        let infinite = both.into_iter().flatten().any(|x| !x.is_finite());
        let unfinished = !self.cycles.is_empty() && self.cycles.iter().all(|c| !c.complete);
        let unfinished = unfinished.then(|| {
            let text = "the run ended within the first evaluated cycle, or half: friction covers the completed part; let it run longer \
                 (time.end)";
            Warning::note("NO COMPLETE CYCLE", text)
        });
        let method = self.scatter.as_ref().filter(|s| s.half_width().is_none());
        let method = method.map(Scatter::method);
        let changes = method.filter(|m| m.starts_with("none")).map(|m| {
            let why = m.trim_start_matches("none: ");
            let text = format!("friction has no interval: {why}; let it run longer (time.end)");
            Warning::note("NOT STEADY", text)
        });
        let infinite = infinite.then(Warning::infinite);
        infinite
            .into_iter()
            .chain(unfinished)
            .chain(changes)
            .collect()
    }
}
