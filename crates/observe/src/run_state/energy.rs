//! Results of the ledgers of energy and momentum at the end of a run.

use super::{BondsOfCase, NO_BONDS, NO_DAMAGE};
use crate::quantity::unit::{ANGULAR_MOMENTUM, ENERGY, MOMENTUM, ONE};
use crate::quantity::{DESCRIBES_THE_RUN, Findings, Role, Topic, number, quantity};
use crate::warning::Warning;
use fretwork_core::energy::Energy;
use fretwork_core::momentum::Momentum;
use serde::Serialize;

/// Residual of the energy ledger, and of the account of heat, relative to the largest energy or
/// heat, above which it is not explained by rounding: ledgers close to 1e-9 and better, also over
/// millions of steps.
pub const LEDGER_TOLERANCE: f64 = 1e-6;
/// Share of the energy dissipated by friction that friction may return without a warning.
const GIVEN: f64 = 0.05;
/// Energies below this fraction of the largest are omitted, as in the energy figure.
const NEGLIGIBLE: f64 = 1e-3;
/// Share of the largest energy that is round-off of sums over the steps.
const ROUND_OFF: f64 = 1e-12;

crate::described! {
    /// Momentum of the free rigid bodies that nothing outside gave them.
    #[derive(Clone, Copy, Debug, Default, Serialize)]
    pub struct MomentumSummary {
        /// Linear momentum of the free rigid bodies that nothing outside gave them.
        pub linear: f64 => MOMENTUM,
        /// Angular momentum of the free rigid bodies that nothing outside gave them; zero in
        /// periodic scenes.
        pub angular: f64 => ANGULAR_MOMENTUM,
        /// Linear momentum that nothing outside gave over the largest sum of the bodies' |m v| so
        /// far.
        pub linear_relative: f64 => ONE,
        /// Angular momentum that nothing outside gave over the largest sum of the bodies'
        /// |x × m v| + |I w| so far.
        pub angular_relative: f64 => ONE,
    }
}

/// Adds energies and momenta.
pub(super) fn report(e: &Energy, momentum: Momentum, bonds: BondsOfCase, found: &mut Findings) {
    found.begin(Topic::Energy, Role::Detail);
    found.keep(*e);
    let sums = [
        (
            "dissipated",
            e.dissipated(),
            "energy turned into heat and new surfaces",
        ),
        (
            "stored",
            e.kinetic + e.elastic,
            "kinetic and elastic energy now",
        ),
    ];
    for (name, sum, doc) in sums {
        found.add(&format!("energy.{name}"), sum, ENERGY, doc);
    }
    let largest = largest(e);
    for (name, doc, value) in e.entries() {
        let balance = matches!(name, "residual" | "initial_kinetic");
        let entry = found.add(&format!("energy.{name}"), value, ENERGY, doc);
        if !balance && value.abs() > NEGLIGIBLE * largest {
            entry.secondary(label(name)).silent();
        }
    }
    if !bonds.any {
        found.edit("energy.elastic", |q| {
            q.lacks(NO_BONDS);
        });
    }
    if !bonds.damaged {
        found.edit("energy.fracture", |q| {
            q.lacks(NO_DAMAGE);
        });
    }
    let doc = "largest energy seen, to which the residual is compared";
    found
        .add("energy.scale", e.scale, ENERGY, doc)
        .lacks(DESCRIBES_THE_RUN);
    let doc = "energy that friction of compliant contacts gave back, summed over steps in which it dissipated less than nothing";
    found.add("energy.given_by_friction", e.given_by_friction, ENERGY, doc);
    let doc = "energy that no entry explains, over the largest energy seen: round-off where the bookkeeping is right";
    let residual = e.relative_residual();
    let relative = found.add("energy_residual_relative", residual, ONE, doc);
    relative.secondary("residual of the ledger").silent();
    let unit = ENERGY.symbol(found.dimension());
    for (name, label, text) in sentences(e, unit) {
        found.edit(&format!("energy.{name}"), |q| {
            q.secondary(label).sentence(label, text);
        });
    }
    found.begin(Topic::Energy, Role::Diagnostic);
    let [linear, angular] = momentum.drift();
    let [linear_relative, angular_relative] = momentum.relative();
    let drift = MomentumSummary {
        linear,
        angular,
        linear_relative,
        angular_relative,
    };
    found.part("momentum", &drift, "");
}

/// Returns the short name of an entry of the ledger.
fn label(name: &str) -> String {
    match name {
        "viscous" => "damping".to_owned(),
        "scheme" => "time integration".to_owned(),
        "correction" => "position correction".to_owned(),
        "carried" => "carried off".to_owned(),
        "expansion" => "thermal expansion".to_owned(),
        name => name.replace('_', " "),
    }
}

fn largest(e: &Energy) -> f64 {
    let sizes = e.entries().into_iter().map(|(_, _, x)| x.abs());
    sizes.fold(0.0, f64::max)
}

/// Returns the sentences for the terminal: external work + gravity + kinetic energy at the start =
/// dissipated + stored.
fn sentences(e: &Energy, unit: &str) -> Vec<(&'static str, &'static str, String)> {
    let largest = largest(e);
    let shown = |x: f64| x.is_nan() || x.abs() > NEGLIGIBLE * largest;
    let mut out = Vec::new();
    let sinks = [
        ("friction", e.friction),
        ("fracture", e.fracture),
        ("impact", e.impact),
        ("viscous", e.viscous),
        ("adhesion", e.adhesion),
        ("scheme", e.scheme),
        ("correction", e.correction),
        ("carried", e.carried),
    ];
    let sinks = sinks.iter().filter(|(_, x)| shown(*x));
    let sinks: Vec<String> = sinks
        .map(|(name, x)| format!("{} {}", label(name), quantity(*x, unit)))
        .collect();
    if !sinks.is_empty() {
        out.push(("dissipated", "dissipated", sinks.join(", ")));
    }
    let mut stored = Vec::new();
    if shown(e.kinetic) || shown(e.initial_kinetic) {
        stored.push(format!(
            "kinetic energy {}, {} at the start",
            quantity(e.kinetic, unit),
            quantity(e.initial_kinetic, unit)
        ));
    }
    if shown(e.elastic) {
        stored.push(format!("elastic energy {}", quantity(e.elastic, unit)));
    }
    if !stored.is_empty() {
        out.push(("stored", "stored", stored.join("; ")));
    }
    let gravity = match e.potential {
        x if !shown(x) => String::new(),
        x if x < 0.0 => format!("; gravity gave {}", quantity(-x, unit)),
        x => format!("; gravity took {}", quantity(x, unit)),
    };
    let expansion = match e.expansion {
        x if !shown(x) => String::new(),
        x => format!("; thermal expansion did {}", quantity(x, unit)),
    };
    let work = match e.external_work {
        x if x.abs() <= ROUND_OFF * largest => 0.0,
        x => x,
    };
    let text = format!(
        "{}{gravity}{expansion}; the ledger closes to {} of the largest energy",
        quantity(work, unit),
        number(e.relative_residual(), 2)
    );
    out.push(("external_work", "external work", text));
    out
}

/// Adds the warnings of the ledger.
pub(super) fn warn(e: &Energy, found: &mut Findings) {
    let energies = [
        e.kinetic,
        e.potential,
        e.elastic,
        e.external_work,
        e.residual,
        e.dissipated(),
    ];
    found.warn(
        energies
            .iter()
            .any(|x| !x.is_finite())
            .then(Warning::infinite),
    );
    let share = e.relative_residual();
    found.warn((share > LEDGER_TOLERANCE).then(|| {
        let text = format!(
            "the ledger's residual is {share:.1e} of the largest energy (rounding leaves less than {LEDGER_TOLERANCE:.0e}): a law's energies \
             may be wrong, see fretwork law certify"
        );
        Warning::serious("ENERGY DOES NOT ADD UP", text)
    }));
    let taken = e.friction + e.given_by_friction;
    let gives = e.given_by_friction > GIVEN * taken.max(0.0);
    found.warn((gives && e.given_by_friction > LEDGER_TOLERANCE * e.scale).then(|| {
        let text = format!(
            "friction gave {:.1e} J in steps in which it dissipated less than nothing, and took {taken:.1e} J in the others: take a \
             smaller time.step; if it stays, a contact law makes energy by friction (fretwork law certify)",
            e.given_by_friction
        );
        Warning::serious("FRICTION GIVES ENERGY", text)
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warned(e: Energy) -> Vec<&'static str> {
        let mut found = Findings::new(3);
        warn(&e, &mut found);
        found.warnings().iter().map(|w| w.of).collect()
    }

    #[test]
    fn a_sound_ledger_has_no_warning() {
        assert!(warned(Energy::default()).is_empty());
        let closes = Energy {
            residual: 1e-9,
            scale: 1.0,
            ..Energy::default()
        };
        assert!(warned(closes).is_empty());
        let off = Energy {
            residual: 1e-3,
            ..closes
        };
        assert_eq!(warned(off), ["ENERGY DOES NOT ADD UP"]);
        let infinite = Energy {
            kinetic: f64::NAN,
            ..Energy::default()
        };
        assert_eq!(warned(infinite), ["NOT FINITE"]);
    }

    #[test]
    fn friction_that_gives_energy_is_a_reason() {
        let of = |given: f64| {
            warned(Energy {
                friction: 1.0 - given,
                given_by_friction: given,
                scale: 2.0,
                ..Energy::default()
            })
        };
        assert!(of(0.01).is_empty());
        assert_eq!(of(0.2), ["FRICTION GIVES ENERGY"]);
    }

    #[test]
    fn energies_are_named_as_in_the_ledger_and_balance() {
        // In this fall forces do 12 J of work and gravity 80 J, of which 5 J are kinetic and 3 J in
        // bonds.
        let mut e = Energy {
            external_work: 12.0,
            potential: -80.0,
            initial_kinetic: 1.0,
            kinetic: 5.0,
            elastic: 3.0,
            friction: 60.0,
            adhesion: 25.0,
            viscous: 1e-3,
            scheme: 1e-3,
            ..Energy::default()
        };
        let said = |e: &Energy| {
            sentences(e, "J")
                .into_iter()
                .map(|s| s.2)
                .collect::<Vec<_>>()
        };
        let [dissipated, stored, work] = &said(&e)[..] else {
            panic!("{:?}", said(&e));
        };
        assert_eq!(dissipated, "friction 60.00 J, adhesion 25.00 J");
        assert_eq!(
            stored,
            "kinetic energy 5.000 J, 1.000 J at the start; elastic energy 3.000 J"
        );
        assert!(work.starts_with("12.00 J; gravity gave 80.00 J; the ledger"));
        // Damping and time integration are separate entries; a rise takes energy.
        (e.viscous, e.scheme, e.potential) = (2.0, 4.0, 7.0);
        let [dissipated, _, work] = &said(&e)[..] else {
            panic!("{:?}", said(&e));
        };
        assert_eq!(
            dissipated,
            "friction 60.00 J, damping 2.000 J, adhesion 25.00 J, time integration 4.000 J"
        );
        assert!(work.contains("gravity took 7.000 J"));
    }
}
