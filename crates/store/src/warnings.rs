//! Warnings about a run with advice: reasons not to trust it, and notes. The table is in docs/trustworthy.md.

use crate::summary::{Summary, Uncertainty};
use fretwork_core::geometry::space::Space;
use fretwork_core::solve::Report;
use fretwork_core::solve::local::solver::Method;
use fretwork_core::step::Simulation;
use fretwork_observe::error_estimate::Change;
use fretwork_observe::heat::HeatChecks;
use fretwork_observe::nearest_places::NearestPlaces;
pub use fretwork_observe::warning::{NOT_REACHED, Warning};
use fretwork_scene::methods::{Demands, Service};

/// Residual of the energy ledger, and of the account of heat, relative to the largest energy or heat, above which it is not explained by
/// rounding: ledgers close to 1e-9 and better, also over millions of steps.
pub const LEDGER: f64 = 1e-6;
/// Overlap of rigid contacts, over the radius of the smaller grain, from which they are not where the model says.
const OVERLAP: f64 = 1e-2;
/// Residual velocities, as a share of those of the contacts, below which they are not worth a note.
const LOOSE: f64 = 1e-3;
/// Share of a result, or of the energy, by which an error is worth a note.
const LARGE_ERROR: f64 = 0.05;

/// Steps that ended above the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Missed {
    /// Their number.
    pub steps: u64,
    /// The first of them.
    pub first: u64,
    /// Largest error of them.
    pub error: f64,
}

impl Missed {
    /// Counts a step by its number.
    pub fn add(&mut self, report: &Report, step: u64) {
        if report.converged {
            return;
        }
        if self.steps == 0 {
            self.first = step;
        }
        self.steps += 1;
        self.error = self.error.max(report.error);
    }

    /// Advice to the user after `of` steps; proposes only solvers that the laws permit. `None` if all steps
    /// converged.
    pub fn warning<S: Space>(&self, simulation: &Simulation<S>, of: u64) -> Option<String> {
        if self.steps == 0 {
            return None;
        }
        let options = simulation.solver_in_force();
        let demands = Demands::of(simulation);
        let others = [Method::Auto, Method::Newton, Method::Interior].into_iter();
        let others = others
            .filter(|m| *m != options.method)
            .filter(|m| !matches!(demands.service(*m), Service::Refuses(_)));
        let others: Vec<String> = others.map(|m| format!("{m:?}")).collect();
        let other = if others.is_empty() {
            String::new()
        } else {
            format!(", or try solver.method {}", others.join(" or "))
        };
        // Velocities of bodies much lighter than their neighbours have rounding errors above a tight
        // tolerance.
        let rounding = if options.tolerance < 1e-6 {
            ", or allow a larger solver.tolerance (rounding may leave more than this one)"
        } else {
            ""
        };
        Some(format!(
            "{}, raise solver.max_iterations (it is {}){other}{rounding}",
            self.seen(of, options.tolerance),
            options.max_iterations
        ))
    }

    /// Description of the missed steps among `of`, and the first thing to change.
    fn seen(&self, of: u64, tolerance: f64) -> String {
        format!(
            "{} of {of} steps, the first is step {}, ended with an error of up to {:.1e} (tolerance {tolerance:.0e}); take a \
             smaller time.step",
            self.steps, self.first, self.error
        )
    }
}

/// Steps of a run that missed the tolerance, without those that no solver could solve.
pub fn missed(summary: &Summary) -> Missed {
    let solver = &summary.solver;
    let impossible = summary.impossible_motions.squeezed_steps;
    Missed {
        steps: solver.unconverged_steps.saturating_sub(impossible),
        first: solver.first_unconverged,
        error: solver.error_max,
    }
}

/// All warnings that follow from a summary, worst first; reasons before notes. `advice` is the text for
/// missed steps ([`Missed::warning`]).
pub fn of(summary: &Summary, advice: Option<String>) -> Vec<Warning> {
    let mut list = Vec::new();
    let mut serious = |of: &'static str, text: Option<String>| {
        list.extend(text.map(|text| Warning::serious(of, text)));
    };
    let ended = if summary.interrupted {
        "INTERRUPTED"
    } else {
        "STOPPED"
    };
    serious(ended, stopped(summary));
    serious("NOT FINITE", infinite(summary));
    serious("ENERGY DOES NOT ADD UP", ledger(summary));
    serious("FRICTION GIVES ENERGY", friction(summary));
    let heat = summary.heat.as_ref();
    let account = heat.and_then(|h| h.account(LEDGER));
    serious("HEAT DOES NOT ADD UP", account);
    serious("IMPOSSIBLE MOTION", summary.impossible_motions.warning());
    serious("TOO FAST", summary.step_size.warning());
    serious("FOUND OVERLAPPING", summary.step_size.sunk_warning());
    // No smaller step helps against a motion that cannot be obeyed.
    let possible = summary.impossible_motions.is_empty();
    serious("OVERLAP", overlap(summary).filter(|_| possible));
    serious("MOTION LOST", summary.step_size.rounding_warning());
    for body in &summary.small_strain {
        serious("NOT SMALL STRAIN", body.warning());
    }
    for body in &summary.border_loads {
        serious("LOAD AT BORDER", body.warning());
    }
    serious("COARSE CONTACT", coarse(summary, true));
    serious("ALIASED DRIVE", drives(summary, true));
    let missed = missed(summary);
    let generic = || missed.seen(summary.steps, summary.solver.tolerance);
    let advice = advice.or_else(|| (missed.steps > 0).then(generic));
    serious("NOT CONVERGED", advice);
    serious("LOOSE VELOCITIES", loose_velocities(summary));
    serious("NOT COUPLED", uncoupled(summary));
    serious("LAWS NOT MET", unmet(summary));
    serious("NOT CERTIFIED", uncertified(summary));
    serious("GRAINS DO NOT ADD UP", grains(summary));
    let reached = summary.stopped.is_none();
    serious("NOT REACHED", phases(summary).filter(|_| reached));
    let jumps = summary
        .jump
        .iter()
        .flat_map(fretwork_observe::jump::warnings);
    list.extend(jumps.filter(|w| reached || w.of != NOT_REACHED));
    list.extend(edges(summary));
    list.extend(scheme(summary));
    list.extend(notes(summary));
    list.sort_by_key(|w| !w.serious);
    list
}

fn stopped(summary: &Summary) -> Option<String> {
    let why = summary.stopped.as_ref()?;
    Some(if summary.interrupted {
        format!(
            "{why}; the results cover the completed part, the same command with --resume continues"
        )
    } else {
        format!("{why}; the results cover the completed part")
    })
}

fn infinite(summary: &Summary) -> Option<String> {
    let e = &summary.energy;
    let energies = [
        e.kinetic,
        e.potential,
        e.elastic,
        e.external_work,
        e.residual,
        e.dissipated(),
    ];
    let friction = [
        summary.friction_coefficient,
        summary.friction_from_dissipation,
    ];
    let all = energies.into_iter().chain(friction.into_iter().flatten());
    all.into_iter().any(|x| !x.is_finite()).then(|| {
        "energies or friction are not finite: forces, speeds or sizes of the case exceed the range of double precision".to_owned()
    })
}

fn ledger(summary: &Summary) -> Option<String> {
    let share = summary.energy_residual_relative;
    (share > LEDGER).then(|| {
        format!(
            "the ledger's residual is {share:.1e} of the largest energy (rounding leaves less than {LEDGER:.0e}): a law's energies \
             may be wrong, see fretwork law certify"
        )
    })
}

fn uncoupled(summary: &Summary) -> Option<String> {
    let steps = summary.solver.uncoupled_steps;
    (steps > 0).then(|| {
        format!(
            "{steps} of {} steps did not converge in the damage coupling; raise max_iterations of `coupling: Implicit(tolerance: ..., max_iterations: ...)` or take a smaller time.step",
            summary.steps
        )
    })
}

/// Mean share of the friction, and largest share of an attraction, by which steps may differ from their laws.
const UNMET_FRICTION: f64 = 2e-3;
const UNMET_ATTRACTION: f64 = 2e-2;

fn unmet(summary: &Summary) -> Option<String> {
    let laws = &summary.solver.laws;
    let (friction, attraction) = (laws.friction_mean, laws.attraction_max);
    let mut parts = Vec::new();
    if friction > UNMET_FRICTION {
        parts.push(format!(
            "friction differs from that of its law at the velocity of sliding by {:.2} % on average: contacts jump between stick and slip within \
             a step; take a smaller time.step, or a law that falls over a wider range of velocities",
            1e2 * friction
        ));
    }
    if attraction > UNMET_ATTRACTION {
        parts.push(format!(
            "attractions differ from those of their laws over the gaps of a step by up to {:.1} % of the load; take a smaller time.step or solver.tolerance",
            1e2 * attraction
        ));
    }
    (!parts.is_empty()).then(|| parts.join("; "))
}

fn uncertified(summary: &Summary) -> Option<String> {
    let wrong = summary.plugins.iter().filter(|p| !p.certified);
    let names: Vec<String> = wrong
        .map(|p| format!("{} law {}", p.kind, p.name))
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "the {} does not pass its certificate with the parameters of this run; fretwork law certify says why",
            names.join(", the ")
        )
    })
}

/// Drives that the steps alias or resolve poorly.
fn drives(summary: &Summary, aliased: bool) -> Option<String> {
    let drives = summary.unresolved_drives.iter();
    let texts: Vec<&str> = drives
        .filter(|d| d.aliased == aliased)
        .map(|d| d.text.as_str())
        .collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}

fn grains(summary: &Summary) -> Option<String> {
    let r = &summary.circuit.as_ref()?.residual;
    let off = [&r.tied, &r.contact, &r.ejected, &r.lost];
    let off: i64 = off.iter().map(|a| a.grains.abs()).sum();
    (off > 0).then(|| format!("the circuit's account misses {off} grains: this is a defect of the program, please report it"))
}

fn phases(summary: &Summary) -> Option<String> {
    let missed = &summary.phases_missed;
    (!missed.is_empty()).then(|| {
        format!(
            "the run ended before the phases {}; let it run longer (time.end)",
            missed.join(", ")
        )
    })
}

/// The contact whose elements leave most doubt of the heat, where that is a reason not to trust it or a note alone. Two bodies that
/// touch each other have one contact.
fn coarse(summary: &Summary, serious: bool) -> Option<String> {
    let all = summary.resolution.iter();
    let worst = all.max_by(|a, b| a.heat_error.total_cmp(&b.heat_error))?;
    let (reason, text) = worst.warning()?;
    (reason == serious).then_some(text)
}

/// Rigid bodies that overlap.
fn overlap(summary: &Summary) -> Option<String> {
    let solver = &summary.solver;
    (solver.overlap_max > OVERLAP).then(|| {
        let left = if solver.overlap_after > OVERLAP {
            format!(", {:.1e} after they were taken out", solver.overlap_after)
        } else {
            String::new()
        };
        format!(
            "rigid bodies overlap by up to {:.1e} of the radius of the smaller one{left}; take a smaller time.step or solver.tolerance, or \
             take overlaps out by `solver: (projection: 0.005)`",
            solver.overlap_max
        )
    })
}

/// Bodies that slid into edges which the error of the solver may have made: a reason where they are many for the bodies of the scene.
fn edges(summary: &Summary) -> Option<Warning> {
    let (many, text) = summary.step_size.edges_warning()?;
    Some(match many {
        true => Warning::serious("EDGES MET", text),
        false => Warning::note("EDGES MET", text),
    })
}

/// Steps that reached their tolerance, but whose residuals outweigh the slip that they are to resolve.
fn loose_velocities(summary: &Summary) -> Option<String> {
    let parts = &summary.solver.error_parts;
    // Where steps missed it, NOT CONVERGED says so.
    (summary.solver.unconverged_steps == 0 && parts.contact_law > 1.0 && parts.velocity > LOOSE).then(|| {
        format!(
            "the residuals of the steps make {:.1} times the heat of slip: slow sliding, and with it friction, may be wrong although \
             the steps reached solver.tolerance; take a smaller one, or compliant contacts \
             (docs/compliant.md, docs/accuracy.md)",
            parts.contact_law
        )
    })
}

/// The position correction, where it is a large share of the energy.
fn correction(summary: &Summary) -> Option<String> {
    let share = summary.uncertainty.repeats.shares.correction?;
    (share > LARGE_ERROR).then(|| {
        format!(
            "{:.0} % of the energy comes from taking overlaps out, not from the drives: take a smaller solver.tolerance or time.step, or \
             compliant contacts (docs/compliant.md)",
            100.0 * share
        )
    })
}

/// Share of the energy that the time integration may add before the run is not to be trusted.
const ADDED: f64 = 0.2;

/// The time integration, where what it takes or adds is a large share of the energy.
fn scheme(summary: &Summary) -> Option<Warning> {
    let share = summary.uncertainty.repeats.shares.scheme?;
    let percent = format!("{:.0} %", 100.0 * share.abs());
    let text = if share > LARGE_ERROR {
        format!(
            "the time integration takes {percent} of the energy (`scheme`), as if contacts had damping that no law gives: take a smaller \
             time.step, to which this loss is proportional (docs/compliant.md)"
        )
    } else if share < -LARGE_ERROR {
        format!(
            "the time integration adds {percent} to the energy (`scheme`): springs of contacts that are found with an overlap bring energy. Take \
             a smaller time.step; between bodies with corners, whose points of contact come and go, that does not help, but rigid contacts do \
             (docs/compliant.md)"
        )
    } else {
        return None;
    };
    Some(match share < -ADDED {
        true => Warning::serious("TIME INTEGRATION", text),
        false => Warning::note("TIME INTEGRATION", text),
    })
}

/// Friction that gives energy.
fn friction(summary: &Summary) -> Option<String> {
    let e = &summary.energy;
    let taken = e.friction + e.given_by_friction;
    (e.given_by_friction > LARGE_ERROR * taken.max(0.0) && e.given_by_friction > LEDGER * e.scale).then(|| {
        format!(
            "friction gave {:.1e} J in steps in which it dissipated less than nothing, and took {taken:.1e} J in the others: take a \
             smaller time.step; if it stays, a contact law makes energy by friction (fretwork law certify)",
            e.given_by_friction
        )
    })
}

/// A result, its change with a setting, and that setting.
type SettingEffect = (&'static str, Change, &'static str);

/// The changes of the main results, as found by repeated steps, that may be large.
fn large_effects(uncertainty: &Uncertainty) -> Vec<SettingEffect> {
    let repeats = &uncertainty.repeats;
    let settings = [
        (Some(&repeats.step), "time.step"),
        (Some(&repeats.tolerance), "solver.tolerance"),
        (repeats.coupling.as_ref(), "explicit coupling"),
    ];
    let known = settings.into_iter().filter_map(|(e, of)| Some((e?, of)));
    let effects = known.flat_map(|(e, of)| {
        [
            ("friction", e.friction_coefficient, of),
            ("damage", e.damage, of),
            ("wear", e.wear, of),
        ]
    });
    let effects = effects.filter_map(|(what, change, of)| Some((what, change?, of)));
    effects.filter(|e| e.1.bound() > LARGE_ERROR).collect()
}

/// Results that repeated steps show to be wrong by more than 5 %.
fn estimated_error(uncertainty: &Uncertainty) -> Option<String> {
    let list = large_effects(uncertainty).into_iter();
    let texts = list.filter(|(_, c, _)| c.change.abs() > c.half_width);
    let texts = texts.map(|(what, c, of)| {
        let (change, half) = (100.0 * c.change, 100.0 * c.half_width);
        format!("{what} {change:+.0} +- {half:.0} % for {of}")
    });
    let texts: Vec<String> = texts.collect();
    (!texts.is_empty()).then(|| {
        format!(
            "repeated steps with finer settings give another result: {}; take a smaller time.step (also where it is the \
             coupling) or solver.tolerance, and see `uncertainty` in summary.json",
            texts.join(", ")
        )
    })
}

/// Results of which the repeated steps do not tell whether they are right to 5 %.
fn unknown_error(uncertainty: &Uncertainty) -> Option<String> {
    let list = large_effects(uncertainty).into_iter();
    let texts = list.filter(|(_, c, _)| c.change.abs() <= c.half_width);
    let texts = texts.map(|(what, c, of)| match c.bound() {
        bound if bound < 1.0 => format!("{what} up to {:.0} % for {of}", 100.0 * bound),
        _ => format!("{what} of any size for {of}"),
    });
    let texts: Vec<String> = texts.collect();
    (!texts.is_empty()).then(|| {
        format!(
            "repeated steps at {} places do not tell whether results are right to 5 %. Possible errors: {}. A longer run, or more places \
             (`uncertainty: (repeats: {})`, for more time), tell more",
            uncertainty.repeats.places,
            texts.join(", "),
            4 * uncertainty.repeats.places
        )
    })
}

/// Notes that do not affect the trust in the results.
fn notes(summary: &Summary) -> Vec<Warning> {
    let mut notes = Vec::new();
    let mut note = |of, text: Option<String>| notes.extend(text.map(|t| Warning::note(of, t)));
    let bonds = summary.fracture.as_ref().and_then(|f| f.warning());
    note("BONDS NOT RESOLVED", bonds);
    let unfinished = !summary.cycles.is_empty() && summary.cycles.iter().all(|c| !c.complete);
    note(
        "NO COMPLETE CYCLE",
        unfinished.then(|| {
            "the run ended within the first evaluated cycle, or half: friction covers the completed part; let it run longer \
             (time.end)"
                .to_owned()
        }),
    );
    let mu = &summary.uncertainty.friction_coefficient;
    let changes = mu
        .method
        .as_ref()
        .filter(|m| mu.scatter.is_none() && m.starts_with("none"));
    note(
        "NOT STEADY",
        changes.map(|m| {
            let why = m.trim_start_matches("none: ");
            format!("friction has no interval: {why}; let it run longer (time.end)")
        }),
    );
    let idle = &summary.without_heat;
    note("NO HEAT", (!idle.is_empty()).then(|| idle.join("; ")));
    let heat = summary.heat.as_ref();
    note("SHALLOW HALF-SPACES", heat.and_then(HeatChecks::shallow));
    note("HEAT OUT OF RANGE", heat.and_then(HeatChecks::outside));
    let nearest = summary.nearest_places.as_ref();
    note("COARSE CONTACT", coarse(summary, false));
    note("NEAREST PLACES", nearest.and_then(NearestPlaces::warning));
    note("COARSE DRIVE", drives(summary, false));
    note("POSITION CORRECTION", correction(summary));
    let missed = summary.accuracy.as_ref().and_then(|a| a.shortfall());
    note("ACCURACY NOT SHOWN", missed);
    let uncertainty = &summary.uncertainty;
    note("ESTIMATED ERROR", estimated_error(uncertainty));
    note("ERROR NOT KNOWN", unknown_error(uncertainty));
    note("NOT UNIQUE", several_solutions(summary));
    notes
}

/// Steps of which another solution was found, with those in which it was not sought: alone these say nothing, as all dense flows have them, but
/// where first bodies alone may hold a grain.
fn several_solutions(summary: &Summary) -> Option<String> {
    let solver = &summary.solver;
    let [several, not_searched, pinched] = [
        solver.several_steps,
        solver.not_searched_steps,
        solver.pinched_steps,
    ];
    let found = (several > 0).then(|| {
        format!(
            "in {several} steps another solution was found, in which loaded contacts slide that hold in the other, since more contacts carry a load than \
             its balance determines; the one of less energy was kept, others may exist"
        )
    });
    let left = (several > 0 && not_searched > 0 || pinched > 0).then(|| {
        let of_grains = if pinched > 0 {
            format!(", in {pinched} of them one of a grain between first bodies, which might hold it")
        } else {
            String::new()
        };
        format!(
            "in {not_searched} steps a loaded contact began to slide among more than 64 connected contacts, whose impulses may outnumber the freedoms of \
             their bodies{of_grains}; no other solution was sought there"
        )
    });
    let told: Vec<String> = found.into_iter().chain(left).collect();
    if told.is_empty() {
        return None;
    }
    Some(format!(
        "{}; compliant contacts (docs/compliant.md) have one (docs/solvers.md, several solutions)",
        told.join("; ")
    ))
}

#[cfg(test)]
#[path = "warnings_tests.rs"]
mod tests;
