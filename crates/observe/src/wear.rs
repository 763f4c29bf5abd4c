//! Wear of first and third bodies, and mean flows of matter, from the start of the friction test on: what came before it, placing grains and pressing them
//! together, is no flow of the contact.

use super::chart::Axis;
use super::figures::history;
use super::first_bodies;
use super::observer::{Observer, RunEnd};
use super::output::Output;
use super::statistics::Column;
use super::summary::{self, Summary};
use fretwork_core::code::{CodeError, decode, encode};
use fretwork_core::geometry::space::Space;
use fretwork_core::process::jump::Jumps;
use fretwork_core::step::{Simulation, StepReport};
use fretwork_core::threads::{map_ranges, pays};
use serde::{Deserialize, Serialize};

/// Observes what wears.
#[derive(Clone, Debug)]
pub struct Wear {
    /// Axis of sliding.
    along: usize,
    /// By how much the masses of bodies are too large, see `inertia_scaling` of a case.
    scaling: f64,
    /// Density of the first bodies (kg/m^3).
    density: f64,
    state: Worn,
}

/// What it carries from step to step.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Worn {
    /// Volumes worn off first bodies and between grains (m^3; m^3/m).
    volumes: (f64, f64),
    flows: Flows,
}

impl Wear {
    /// Wear of first bodies of a density (kg/m^3), with flows along an axis from a time (s) on; masses of the bodies are larger
    /// than they are by `scaling`.
    pub fn new(start: f64, along: usize, scaling: f64, density: f64) -> Self {
        Self {
            along,
            scaling,
            density,
            state: Worn {
                volumes: (0.0, 0.0),
                flows: Flows::since(start),
            },
        }
    }
}

impl<S: Space> Observer<S> for Wear {
    fn name(&self) -> String {
        "wear".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn after_step(&mut self, s: &Simulation<S>, report: &StepReport) {
        let state = &mut self.state;
        state.volumes.0 += report.totals.worn_first;
        state.volumes.1 += report.totals.worn_third;
        state
            .flows
            .add(s, self.along, self.scaling, state.volumes.0);
    }

    fn columns(&self) -> Vec<Column> {
        let volume = if S::D == 2 { "m^3/m" } else { "m^3" };
        vec![
            Column::new("worn_first", volume, "volume worn off first bodies"),
            Column::new("worn_third", volume, "volume worn between grains"),
        ]
    }

    fn sample(&mut self, _: &Simulation<S>) -> Vec<f64> {
        vec![self.state.volumes.0, self.state.volumes.1]
    }

    fn summarise(&self, end: &RunEnd<'_, S>, summary: &mut Summary) {
        let (s, state) = (end.simulation, &self.state);
        // Wear goes on over the cycles that were jumped over.
        let jumps = s.process::<Jumps>();
        let over = jumps.map_or(0.0, |j| j.jumped_at(s.state.time) * j.period());
        // Nothing leaves a contact that is periodic along the sliding.
        let closed = s.shapes.periodic.period[self.along].map(|_| 0.0);
        summary.wear = summary::Wear {
            unit: summary::Wear::unit(S::D),
            start: state.flows.start,
            Qs: state.flows.source(over) * self.density,
            Qi: state.flows.internal(),
            Qe: closed,
            Qw: closed,
            volume_first_bodies: state.volumes.0,
            volume_third_body: state.volumes.1,
            load_path: None,
            bodies: first_bodies::wear(s),
        };
    }

    fn figures(&self, end: &RunEnd<'_, S>) -> Vec<Output> {
        let own = end.simulation.state.scars.iter();
        let own = own.map(|scar| (scar.name.as_str(), format!("{}_worn", scar.name)));
        let all = [
            ("first bodies", "worn_first"),
            ("between grains", "worn_third"),
        ];
        let all = all.map(|(label, column)| (label, column.to_owned()));
        // One scar alone is what is worn off first bodies.
        let several = own.len() > 1;
        let series: Vec<(&str, String)> = all.into_iter().chain(own.filter(|_| several)).collect();
        let chart = history("Worn volume", Axis::of_rows("worn volume V"), &series)
            .note("What the wear laws removed since the start.");
        vec![Output::figure("worn_volume", [chart], 1)]
    }

    fn save(&self) -> Result<Vec<u8>, CodeError> {
        encode(&self.state)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), CodeError> {
        self.state = decode(from)?;
        Ok(())
    }
}

/// What flowed since the start of the friction test; since the start of the run without one.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Flows {
    /// When it starts (s).
    start: f64,
    /// Time since then (s).
    time: f64,
    /// Volume worn off first bodies before it (m^3; m^3/m).
    before: f64,
    /// Volume worn off them since (m^3; m^3/m).
    worn: f64,
    /// Mass of the third body that crossed a section since (kg; kg/m).
    crossed: f64,
}

impl Flows {
    /// From a time on.
    fn since(start: f64) -> Self {
        Self {
            start,
            ..Self::default()
        }
    }

    /// Takes in a step: the sliding axis, the inertia scaling of the case, and the volume worn off first bodies so far.
    fn add<S: Space>(&mut self, s: &Simulation<S>, along: usize, scaling: f64, worn: f64) {
        let h = s.options.scheme.h;
        if s.state.time - 0.5 * h < self.start {
            self.before = worn;
            return;
        }
        self.time += h;
        self.worn = worn - self.before;
        self.crossed += h * internal_flow(s, along) / scaling;
    }

    /// Volume worn off first bodies a second, over a longer time by so much (m^3/s; m^3/(m s)); zero before the start.
    fn source(&self, over: f64) -> f64 {
        mean(self.worn, self.time + over)
    }

    /// Mass that crosses a section a second (kg/s; kg/(m s)); zero before the start.
    fn internal(&self) -> f64 {
        mean(self.crossed, self.time)
    }
}

fn mean(amount: f64, time: f64) -> f64 {
    if time > 0.0 { amount / time } else { 0.0 }
}

/// Bodies of a task, and about what the flow of one takes (ns).
const CHUNK: usize = 4096;
const EACH: f64 = 4.0;

/// Mass of the third body that crosses a section a second: sum m |v| / L along the sliding.
fn internal_flow<S: Space>(s: &Simulation<S>, along: usize) -> f64 {
    let bodies = &s.state.bodies;
    let grain = bodies.grain_flags();
    let divide = pays(s.options.solver.parallel, bodies.len(), EACH);
    let parts = map_ranges(divide, bodies.len(), CHUNK, |range| {
        let (mut low, mut high, mut flow) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for b in range {
            let moves =
                bodies.inverse_mass[b][along] > 0.0 || bodies.carrier(b).is_some_and(|c| c.grain);
            if moves && bodies.length[b] > 0.0 {
                let x = bodies.position[b][along];
                (low, high) = (low.min(x), high.max(x));
                if grain[b] {
                    flow += bodies.mass[b] * bodies.velocity[b][along].abs();
                }
            }
        }
        (low, high, flow)
    });
    let (mut low, mut high, mut flow) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    for (l, h, f) in parts {
        (low, high) = (low.min(l), high.max(h));
        flow += f;
    }
    let length = s.shapes.periodic.period[along].unwrap_or(high - low);
    if length.is_finite() && length > 0.0 {
        flow / length
    } else {
        0.0
    }
}
