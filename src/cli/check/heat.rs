//! Report of `fretwork check` on heat: its clock, and whether a grain has one temperature.

use super::CheckLine;
use super::load::Load;
use crate::heat::{Heat, Node, Store};
use crate::laws::bench::{Bench, BenchMotion};
use crate::laws::{Interface, Kind};
use crate::scene::case::Case;
use crate::{AnySimulation, RunView};
use fretwork_observe::heat::without_heat;

/// Biot number below which the temperature inside a body is taken as uniform (F. P. Incropera, D.
/// P. DeWitt, Fundamentals of Heat and Mass Transfer, chapter 5).
const UNIFORM: f64 = 0.1;

/// Ratio D h/w² above which separate steps along the depth and along the surface differ from a
/// simultaneous step: the error of a band source then exceeds 1 %
/// (crates/math/tests/diffusion_columns.rs).
const SPLIT: f64 = 0.5;

/// The lines.
pub fn lines(case: &Case, simulation: &AnySimulation, load: &Load) -> Vec<CheckLine> {
    let s = simulation.view();
    let mut out = Vec::new();
    let Some(heat) = s.heat() else {
        let idle = without_heat(s).into_iter();
        out.extend(idle.map(|text| ("NO HEAT".to_owned(), text)));
        return out;
    };
    out.push(("heat clock".to_owned(), clock(case, heat)));
    out.extend(sideways(case, heat));
    out.extend(expanding(s, heat));
    let closed = s.laws().iter().filter(|l| l.transport().is_none());
    let closed: Vec<&str> = closed.map(|l| l.name.as_str()).collect();
    if !closed.is_empty() {
        let text = format!(
            "{} without a transport law: contacts there conduct nothing, and keep their heat in the two bodies",
            closed.join(", ")
        );
        out.push(("no conduction".to_owned(), text));
    }
    out.extend(mechanical_time(s, heat));
    if case.inertia_scaling != 1.0 {
        let text = "heat capacities are not scaled with inertia; heat of impacts and damping is that of the scaled masses".to_owned();
        out.push(("heat and inertia".to_owned(), text));
    }
    for (k, law) in s.laws().iter().enumerate() {
        out.extend(conduction(case, s, heat, load, (k, law)));
    }
    out
}

/// Describes where heat is stored.
pub fn stores(s: &dyn RunView) -> Option<String> {
    let (heat, state) = (s.heat()?, s.heat_state()?);
    let of = |(name, range): &(String, std::ops::Range<usize>)| {
        let nodes = &state.nodes[range.clone()];
        let column = |n: &Node| matches!(n.store, Store::HalfSpace(_));
        let mesh = nodes.len() > 1 && !nodes.iter().any(column);
        let what = match nodes.first().map(|n| &n.store) {
            None => "insulated".to_owned(),
            Some(_) if mesh => format!("{} points of its mesh", nodes.len()),
            Some(Store::Fixed) => format!("kept at {:.1} K", nodes[0].temperature),
            Some(Store::Lumped(capacity)) => format!("{capacity:.3e} J/K"),
            Some(Store::HalfSpace(space)) => {
                let depth = space.grid.depth.last().copied().unwrap_or_default();
                format!(
                    "{} half-spaces of {} points to {depth:.2e} m",
                    nodes.len(),
                    space.grid.points()
                )
            }
        };
        format!("{name} {what}")
    };
    let bodies: Vec<String> = heat.first_bodies.iter().map(of).collect();
    let grains = match s.grains().len() {
        0 => String::new(),
        1 => "1 grain of one temperature; ".to_owned(),
        n => format!("{n} grains of one temperature each; "),
    };
    Some(grains + &bodies.join(", "))
}

/// Describes which bodies expand with their temperature, and which first bodies do not.
fn expanding(s: &dyn RunView, heat: &Heat) -> Option<CheckLine> {
    let (coefficient, systems) = s.expanding()?;
    let expands = |body: usize| coefficient[body] != 0.0;
    let grains = s.grains().into_iter().filter(|g| expands(*g)).count();
    let driven = s.bodies().driven.iter();
    let rigid = driven.filter(|d| expands(d.body as usize));
    let mut named: Vec<String> = rigid.map(|d| d.name.clone()).collect();
    let systems = systems.into_iter().filter_map(|k| s.system(k));
    named.extend(systems.map(|system| system.name().to_owned()));
    let firsts = heat.first_bodies.iter().map(|(name, _)| name);
    let others: Vec<&str> = firsts
        .filter(|name| !named.contains(name))
        .map(String::as_str)
        .collect();
    let grains = match grains {
        0 => None,
        1 => Some("1 grain".to_owned()),
        n => Some(format!("{n} grains")),
    };
    let all: Vec<String> = grains.into_iter().chain(named.iter().cloned()).collect();
    let mut text = format!("size changes with temperature: {}", all.join(", "));
    if !others.is_empty() {
        text += &format!("; size stays: {}", others.join(", "));
    }
    Some(("expansion".to_owned(), text))
}

/// Describes the conduction between the pieces of a surface in a step.
fn sideways(case: &Case, heat: &Heat) -> Option<CheckLine> {
    let step = case.time.step * heat.clock * heat.every as f64;
    let numbers = heat.columns.iter().map(|c| c.number(step));
    let most = numbers.fold(0.0, f64::max);
    if most == 0.0 {
        return None;
    }
    let judged = match most < SPLIT {
        true => "small enough for a step of its own along the surface",
        false => {
            "too large for a step of its own along the surface: use a smaller step, smaller `heat.every`, or fewer pieces"
        }
    };
    let text = format!("D h/w^2 = {most:.2e} between pieces of width w of a surface: {judged}");
    Some(("heat sideways".to_owned(), text))
}

fn clock(case: &Case, heat: &Heat) -> String {
    let step = case.time.step * heat.clock * heat.every as f64;
    let mut text = format!(
        "each step of the heat is {step:.3e} s, theta {}",
        heat.theta
    );
    if heat.every > 1 {
        text += &format!(", every {} steps of the mechanics", heat.every);
    }
    if heat.clock != 1.0 {
        text += &format!(
            "; a second of mechanics lets heat flow for {:e} s, and puts in what its friction dissipates: heat flows per second are {:e} \
             of those of the mechanics",
            heat.clock,
            1.0 / heat.clock
        );
    }
    text
}

/// Shipped laws that integrate over time or sliding speed by themselves, and how.
const COUNTING: [(Kind, &str, &str); 2] = [
    (Kind::WEAR, "oxidation", "the sliding speed"),
    (Kind::TRANSPORT, "oxide-film", "time"),
];

/// Names the laws that integrate over the time or speed of the mechanics where heat has its own
/// clock.
fn mechanical_time(s: &dyn RunView, heat: &Heat) -> Vec<CheckLine> {
    let mut out: Vec<CheckLine> = Vec::new();
    if heat.clock == 1.0 {
        return out;
    }
    for law in s.laws() {
        for loaded in law.loaded() {
            let plugin = &loaded.plugin;
            let counts = COUNTING
                .iter()
                .find(|(kind, name, _)| *kind == plugin.kind && *name == plugin.name);
            let Some((kind, name, what)) = counts else {
                continue;
            };
            let text = format!(
                "the {kind} law `{name}` of `{}` counts {what} of the mechanics, not of `heat.clock`: a second of mechanics is {:e} s of heat",
                law.name, heat.clock
            );
            out.push(("MECHANICAL TIME".to_owned(), text));
        }
    }
    out
}

/// Describes the conductance of the median contact of an interface under the load, its Biot number,
/// and the time in which a grain takes the temperature of its neighbours.
fn conduction(
    case: &Case,
    s: &dyn RunView,
    heat: &Heat,
    load: &Load,
    (place, law): (usize, &Interface),
) -> Vec<CheckLine> {
    let (Some(_), Some((pressure, _))) = (law.transport(), load.pressure) else {
        return Vec::new();
    };
    let spec = &case.interfaces[place];
    let index = |name: &str| case.materials.keys().position(|m| m == name);
    let (Some(a), Some(b)) = (index(&spec.between.0), index(&spec.between.1)) else {
        return Vec::new();
    };
    let [a, b] = [&heat.materials[a], &heat.materials[b]];
    let Some(radius) = median_radius(s) else {
        return Vec::new();
    };
    let diameter = 2.0 * radius;
    // Two equal grains have half their radius as the reduced radius; a grain on a surface has its
    // own radius.
    let grains = |name: &String| {
        let pieces = s.pieces().into_iter().map(|p| (p.body, p.material));
        let balls = s.balls().into_iter().map(|b| (b.body, b.material));
        balls
            .chain(pieces)
            .filter(|(body, _)| s.bodies().driven.iter().all(|d| d.body != *body))
            .any(|(_, m)| Some(usize::from(m)) == index(name))
    };
    let both = grains(&spec.between.0) && grains(&spec.between.1);
    let reduced = if both { 0.5 * radius } else { radius };
    let conductivity = a.pair_conductivity(b);
    let mut bench = Bench::new(law.clone(), s.dimension() as u32, reduced)
        .of_material([conductivity, a.pair_resistivity(b)]);
    let force = pressure * diameter.powi(s.dimension() as i32 - 1);
    let motion = BenchMotion {
        pressure: force / bench.area(),
        ..BenchMotion::default()
    };
    let mut state = [bench.fresh()];
    let Ok(answers) = bench.step(&mut state, &[motion], case.time.step) else {
        return Vec::new();
    };
    let conductance = answers[0].conductance[0];
    if conductance <= 0.0 {
        let text = format!("{}: nothing under {pressure:.2e} Pa", law.name);
        return vec![("conduction".to_owned(), text)];
    }
    let (biot, unit, capacity) = match s.dimension() {
        2 => (
            conductance / conductivity,
            "W/(m K)",
            std::f64::consts::FRAC_PI_4 * diameter * diameter,
        ),
        _ => (
            conductance / (conductivity * diameter),
            "W/K",
            std::f64::consts::PI / 6.0 * diameter.powi(3),
        ),
    };
    let time = a.conductor().capacity.min(b.conductor().capacity) * capacity / conductance;
    let judged = match biot < UNIFORM {
        true => format!("below {UNIFORM}: a grain has one temperature"),
        false => format!(
            "above {UNIFORM}: a grain is not of one temperature, and the conductance of a contact is too large by about this share"
        ),
    };
    let text = format!(
        "{}: {conductance:.3e} {unit} at a new contact of a grain of {diameter:.2e} m under {pressure:.2e} Pa, thermal time {time:.2e} s; Biot number \
         {biot:.2e}, {judged}",
        law.name
    );
    vec![("conduction".to_owned(), text)]
}

/// Median radius of the balls and pieces (m).
fn median_radius(s: &dyn RunView) -> Option<f64> {
    let balls = s.balls().into_iter().map(|b| b.radius);
    let pieces = s.pieces().into_iter().map(|p| p.size);
    let mut radii: Vec<f64> = balls.chain(pieces).collect();
    radii.sort_unstable_by(f64::total_cmp);
    radii.get(radii.len() / 2).copied()
}
