//! Features that a case enables or leaves disabled, and the memory per grain and contact.

use crate::bodies::Dof;
use crate::laws::Interface;
use crate::laws::requirements::{LawRequirements, Requirement};
use crate::record::{meshes, views};
use crate::scene::case::{BodySpec, Case};
use crate::scene::methods::SolverRequirements;
use crate::scene::phases::{drives_of, drives_of_holder, holder_name};
use crate::step::Coupling;
use crate::{AnySimulation, RunView};

/// Names of the enabled and disabled features.
#[derive(Default)]
pub struct Features {
    pub on: Vec<String>,
    pub off: Vec<String>,
}

impl Features {
    /// The features of a case and its scene.
    pub fn of(case: &Case, simulation: &AnySimulation) -> Self {
        let s = simulation.view();
        let mut out = Self::default();
        out.motion(s);
        out.programme(case, s);
        out.laws(s);
        out.scheme(case, s);
        out.output(case, simulation);
        out
    }

    fn say(&mut self, name: &str, on: Option<String>) {
        match on {
            Some(text) => self.on.push(format!("{name}: {text}")),
            None => self.off.push(name.to_owned()),
        }
    }

    fn motion(&mut self, s: &dyn RunView) {
        let velocities = s.dimension();
        let spins = if velocities == 2 { 1 } else { 3 };
        let text = format!("{velocities} velocities, {spins} spins a body");
        self.say("dimensions", Some(text));
        let turning = s.bodies().inverse_inertia.iter().filter(|i| **i > 0.0);
        let turning = turning.count();
        // A contact exerts a moment only if its force does not pass through the centre.
        let levers = has_levers(s);
        let turned = levers || asks(s, |d| d.friction) || s.laws().iter().any(Interface::opens);
        let text = format!("{turning} bodies turn freely");
        self.say("rotation", (turned && turning > 0).then_some(text));
        let axes: Vec<&str> = ["x", "y", "z"]
            .into_iter()
            .zip(s.periodic().period)
            .filter_map(|(name, period)| period.map(|_| name))
            .collect();
        self.say(
            "periodic",
            (!axes.is_empty()).then(|| format!("along {}", axes.join(", "))),
        );
        let g = super::load::gravity(s);
        self.say("gravity", (g > 0.0).then(|| format!("{g:.3e} m/s^2")));
    }

    /// Adds changes during the run, and external loads.
    fn programme(&mut self, case: &Case, s: &dyn RunView) {
        let phases = case.phases.iter().map(|p| match &p.repeat {
            None => p.name.clone(),
            Some(r) => match r.from.as_ref().filter(|from| **from != p.name) {
                Some(from) => format!("{}, {} times from {from} on", p.name, r.times),
                None => format!("{}, {} times", p.name, r.times),
            },
        });
        self.list("phases", phases);
        let names = BodySpec::names(s.dimension());
        let drives = |which: fn(&Dof) -> bool| {
            let mut found: Vec<String> = Vec::new();
            for body in &case.bodies {
                for (k, dof) in drives_of(case, body) {
                    let name = format!("{} {}", body.name, names[k]);
                    if dof.drives().any(which) && !found.contains(&name) {
                        found.push(name);
                    }
                }
            }
            let half_spaces = case.half_spaces.iter().map(|b| {
                let d = &b.dofs;
                (b.name.clone(), b.name.clone(), [&d.x, &d.y, &d.z])
            });
            let supports = case.elastic.iter().flat_map(|b| {
                b.supports.iter().map(|s| {
                    let holder = holder_name(&b.name, &s.part);
                    (holder, format!("{} {}", b.name, s.part), [&s.x, &s.y, &s.z])
                })
            });
            for (holder, shown, dofs) in half_spaces.chain(supports) {
                for (k, dof) in dofs.into_iter().enumerate() {
                    let mut drives = drives_of_holder(case, &holder, k, dof);
                    if drives.any(|d| d.drives().any(which)) {
                        found.push(format!("{shown} {}", ["x", "y", "z"][k]));
                    }
                }
            }
            found.into_iter()
        };
        let imposed = |d: &Dof| matches!(d, Dof::Velocity(_) | Dof::Displacement(_));
        self.list("imposed motion", drives(imposed));
        self.list("imposed force", drives(|d| matches!(d, Dof::Force(_))));
        let servo = |d: &Dof| matches!(d, Dof::Pressure { .. });
        self.list("servo pressure", drives(servo));
        let (removals, driven) = (s.removals().iter(), s.bodies().driven);
        let timed = removals.map(|(place, time)| format!("{} at {time:e} s", driven[*place].name));
        let opened = case.phases.iter().flat_map(|p| {
            let open = p.open.iter();
            open.map(|body| format!("{body} with phase {}", p.name))
        });
        self.list("gates", timed.chain(opened));
        let turns =
            s.gravity_drive().is_some() || case.phases.iter().any(|p| p.gravity_drive.is_some());
        self.say(
            "gravity that changes",
            turns.then(|| "by its drive".to_owned()),
        );
    }

    fn list(&mut self, name: &str, all: impl Iterator<Item = String>) {
        let all: Vec<String> = all.collect();
        self.say(name, (!all.is_empty()).then(|| all.join(", ")));
    }

    fn laws(&mut self, s: &dyn RunView) {
        let requirements = SolverRequirements::of(s);
        let names = |which: fn(&LawRequirements) -> Requirement| {
            let each = requirements.each().filter_map(|(name, requirements)| {
                match requirements.map_or(Requirement::NotObserved, which) {
                    Requirement::Never => None,
                    Requirement::NotObserved => Some(format!("{name}?")),
                    _ => Some(name.to_owned()),
                }
            });
            let each: Vec<String> = each.collect();
            (!each.is_empty()).then(|| format!("in {}", each.join(", ")))
        };
        self.say("friction", names(|d| d.friction));
        self.say("friction against rotation", names(|d| d.rotation));
        let laws = |text: &dyn Fn(&Interface) -> Option<String>| {
            let each = s.laws().iter().filter_map(|law| Some((law, text(law)?)));
            let each: Vec<String> = each.map(|(l, t)| format!("in {}, {t}", l.name)).collect();
            (!each.is_empty()).then(|| each.join("; "))
        };
        let bonding = |law: &Interface| law.bonding_time().is_some() || law.healing.is_some();
        self.say(
            "bonds",
            laws(&|law| {
                let memory = s.memory_use();
                let turn = if law.rotates() { memory.turn } else { 0 };
                let cohesion = law.cohesion().filter(|_| law.opens() && bonding(law))?;
                let bytes = memory.bond + turn;
                Some(format!("{}, {bytes} bytes a bond", cohesion.plugin.name))
            }),
        );
        self.say(
            "attraction without bonds",
            laws(&|law| {
                let cohesion = law.cohesion().filter(|_| !law.opens());
                cohesion.map(|l| l.plugin.name.clone())
            }),
        );
        self.say(
            "damage",
            laws(&|law| {
                let cohesion = law.cohesion().filter(|_| law.damages());
                let by = law.damage().or(cohesion);
                by.map(|l| l.plugin.name.clone())
            }),
        );
        let scars = s.scars().into_iter().map(|c| {
            let vertices = c.vertices;
            format!("{}, {vertices} vertices, {:e} m thick", c.name, c.thickness)
        });
        let scars: Vec<String> = scars.collect();
        let recede = (!scars.is_empty()).then(|| scars.join("; "));
        self.say("surfaces that recede", recede);
        self.say(
            "healing",
            laws(&|law| law.healing.map(|time| format!("after {time:e} s"))),
        );
        self.say(
            "wear",
            laws(&|law| law.wear().map(|l| l.plugin.name.clone())),
        );
        self.say(
            "history variables",
            laws(&|law| {
                let n = law.variables();
                let whose = if law.variables_of_contacts() > 0 {
                    "contact"
                } else {
                    "bond"
                };
                (n > 0).then(|| format!("{n}, {} bytes a {whose}", 8 * n))
            }),
        );
    }

    fn scheme(&mut self, case: &Case, s: &dyn RunView) {
        let share = s.options().correction;
        self.say(
            "position correction",
            (share > 0.0).then(|| format!("{share} of a penetration a step")),
        );
        let bound = s.options().projection;
        self.say(
            "projection of overlaps",
            (bound > 0.0).then(|| format!("beyond {bound:e} of the smaller body's length")),
        );
        let implicit = match s.options().coupling {
            Coupling::Implicit { tolerance, .. } => Some(format!("to {tolerance:e}")),
            Coupling::Explicit | Coupling::Midpoint => None,
        };
        self.say("implicit coupling", implicit);
        let scaling = case.inertia_scaling;
        self.say(
            "inertia scaling",
            (scaling != 1.0).then(|| format!("{scaling:e}")),
        );
        let jump = case.jump.as_ref().map(|j| {
            let ends = j
                .cycles
                .map_or(String::new(), |n| format!(", to {n} cycles"));
            format!(
                "from cycle {} on, of at most {} cycles, to {} of error each{ends}",
                j.after + 1,
                j.at_most,
                j.tolerance
            )
        });
        self.say("cycle jump", jump);
        self.say("heat", super::heat::stores(s));
        let circuit = case.heat.as_ref().and_then(|h| h.circuit.as_ref());
        let through = circuit.map(|c| format!("from {} to {}, {:?}", c.from, c.to, c.supply));
        self.say("electric current", through);
        let body = case.friction.as_ref().map(|f| f.body.clone());
        self.say("friction test", body);
        let walls = case.biaxial.as_ref().map(|b| format!("{:?}", b.axial));
        self.say("biaxial test", walls);
    }

    fn output(&mut self, case: &Case, s: &AnySimulation) {
        self.say(
            "circuit of grains",
            case.circuit.as_ref().map(|c| {
                let (bases, zones) = (c.bases.join(", "), c.zones.len());
                format!(
                    "tied to {bases}, {zones} ejection zones, from {:e} s",
                    c.start
                )
            }),
        );
        let measures = case.measures.iter();
        self.list(
            "measures",
            measures.map(|m| format!("{} ({})", m.name(), m.kind())),
        );
        let o = &case.output;
        self.say("statistics", Some(format!("every {} steps", o.every)));
        self.say(
            "frames",
            (o.frames > 0).then(|| format!("{} of {} pixels", o.frames, o.width)),
        );
        let [grain, contact] = views::bytes(s.view(), case.circuit.is_some());
        let meshes = match meshes::bytes(case, s.view()) {
            0 => String::new(),
            bytes => format!(", {:.2} MB of deformable bodies", bytes as f64 / 1e6),
        };
        let views = || {
            let count = o.views;
            format!("{count}, {grain} bytes a grain, {contact} a contact{meshes}")
        };
        self.say("views", (o.views > 0).then(views));
        self.say("figures", o.figures.then(|| "at the end".to_owned()));
        let every = format!("every {} steps", o.fclib);
        self.say("FCLIB problems", (o.fclib > 0).then_some(every));
    }
}

fn asks(s: &dyn RunView, which: fn(&LawRequirements) -> Requirement) -> bool {
    let requirements = SolverRequirements::of(s);
    let mut each = requirements.each();
    each.any(|(_, d)| d.is_none_or(|d| which(d) != Requirement::Never))
}

/// Whether the force of a contact does not pass through the centres of its bodies.
fn has_levers(s: &dyn RunView) -> bool {
    let mut levers = false;
    s.visit_contacts(&mut |c| levers |= !c.central);
    levers
}

/// Returns the bytes per grain and per contact, from the types that store them.
pub fn memory(s: &dyn RunView) -> [String; 2] {
    let memory = s.memory_use();
    let (kept, line) = (memory.grain, memory.solver_body);
    let [plain, full, levers, bonded_levers] = memory.rows;
    let bonded = s.laws().iter().any(|law| law.cohesion().is_some());
    let mut rows = vec![if bonded {
        format!("{full} bytes in the sweep")
    } else {
        format!("{plain} bytes in the sweep")
    }];
    if has_levers(s) {
        let levers = if bonded { bonded_levers } else { levers };
        rows.push(format!("{levers} where it has levers"));
    }
    let beside = memory.contact;
    [
        format!(
            "{} bytes: {kept} of state, {line} in the solver",
            kept + line
        ),
        format!("{}, {beside} of geometry and memory", rows.join(", ")),
    ]
}
