//! Rows of the statistics: columns and values.

use super::Recorder;
use super::account::Account;
use super::jumps;
use crate::geometry::space::Space;
use crate::record::biaxial::Biaxial;
use crate::record::measure::Measures;
use crate::record::scars;
use crate::record::statistics::Column;
use crate::scene::build::Dimensional;
use crate::scene::case::Case;
use crate::step::{Simulation, StepReport};

impl<S: Dimensional> Recorder<'_, S> {
    pub(super) fn row(&self, report: &StepReport) -> Vec<f64> {
        let (s, e) = (&self.simulation, &self.simulation.energy);
        let n = &s.network;
        let cycle = self.cycles.as_ref().map_or(0, |(c, _)| c.number(s.time));
        let mut row = vec![
            s.steps as f64,
            s.time,
            f64::from(cycle),
            n.contact_count() as f64,
            report.active as f64,
            f64::from(report.solver.iterations),
            report.solver.error,
            f64::from(u8::from(report.solver.converged)),
            (n.bonds_made() - n.bonds_broken()) as f64,
            n.bonds_broken() as f64,
            self.damage_ratio(),
            n.mean_damage(),
        ];
        row.extend(e.entries().map(|(_, _, value)| value));
        row.extend([self.worn.0, self.worn.1]);
        if let Some(sample) = self.sample {
            row.extend([
                self.slide,
                sample.q,
                sample.p,
                if sample.p > 0.0 {
                    sample.q.abs() / sample.p
                } else {
                    0.0
                },
            ]);
        }
        if let Some(test) = &self.biaxial {
            row.extend(test.state(s).row());
        }
        row.extend(scars::row(s));
        if !s.control.phases.is_empty() {
            row.push(s.control.phase() as f64);
        }
        for (d, driven) in s
            .bodies
            .driven
            .iter()
            .enumerate()
            .filter(|(_, d)| shown(&d.name))
        {
            let b = driven.body as usize;
            let force = s.received[d].0 * (1.0 / s.scheme.h);
            for values in [s.bodies.position[b], s.bodies.velocity[b], force] {
                row.extend((0..S::D).map(|k| values[k]));
            }
        }
        row
    }
}

/// The statistics columns of a run of a case.
pub fn statistics_columns<S: Dimensional>(case: &Case, s: &Simulation<S>) -> Vec<Column> {
    let test = case.friction.as_ref();
    let driven = |name: &str| s.bodies.driven.iter().any(|d| d.name == name);
    let friction = test.is_some_and(|t| driven(&t.body));
    let mut out = columns(s, friction, case.biaxial.is_some());
    out.extend(case.jump.is_some().then(jumps::column));
    out.extend(Account::<S>::columns(case));
    out.extend(Measures::<S>::new(&case.measures, case.inertia_scaling).columns());
    out
}

pub(super) fn columns<S: Space>(s: &Simulation<S>, friction: bool, biaxial: bool) -> Vec<Column> {
    let newton = if S::D == 2 { "N/m" } else { "N" };
    let joule = if S::D == 2 { "J/m" } else { "J" };
    let volume = if S::D == 2 { "m^3/m" } else { "m^3" };
    let c = |name, unit, doc| Column::new(name, unit, doc);
    let mut out = vec![
        c("step", "", "number of the step"),
        c("time", "s", "time at its end"),
        c("cycle", "", "cycle of the friction test"),
        c("contacts", "", "contacts within the alert distance"),
        c("active", "", "contacts that carry an impulse"),
        c("iterations", "", "iterations of the solver"),
        c("error", "", "error of the solution"),
        c("converged", "", "1 if the tolerance was reached"),
        c("bonds_intact", "", "intact bonds"),
        c("bonds_broken", "", "broken bonds"),
        c("damage_ratio", "", "broken bonds over bonds made"),
        c("mean_damage", "", "mean damage over bonds made"),
    ];
    let entries = s.energy.entries().into_iter();
    out.extend(entries.map(|(name, doc, _)| c(name, joule, doc)));
    out.extend([
        c("worn_first", volume, "volume worn off first bodies"),
        c("worn_third", volume, "volume worn between grains"),
    ]);
    if friction {
        out.extend([
            c("delta", "m", "displacement of the body under test"),
            c("Q", newton, "tangential force that moves it"),
            c("P", newton, "normal force"),
            c("mu", "", "|Q|/P"),
        ]);
    }
    if biaxial {
        out.extend(Biaxial::columns());
    }
    out.extend(scars::columns(s));
    if !s.control.phases.is_empty() {
        out.push(c("phase", "", "number of the phase, from 1"));
    }
    let axes = ["x", "y", "z"];
    for driven in s.bodies.driven.iter().filter(|d| shown(&d.name)) {
        for (what, unit, doc) in [
            ("", "m", "position of the body"),
            ("v", "m/s", "velocity of the body"),
            ("f", newton, "contact force on the body"),
        ] {
            out.extend(
                axes.iter()
                    .take(S::D)
                    .map(|a| c_named(&driven.name, what, a, unit, doc)),
            );
        }
    }
    out
}

fn c_named(body: &str, what: &str, axis: &str, unit: &'static str, doc: &'static str) -> Column {
    Column::new(format!("{body}_{what}{axis}"), unit, doc)
}

/// Walls from a scene file get no columns.
fn shown(name: &str) -> bool {
    !name.starts_with("wall_")
}
