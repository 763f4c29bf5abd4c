//! Dynamical systems move with the bodies, and their contactors follow them.

use crate::bodies::{ContactorShape, DynamicalSystem, SystemStep};
use crate::contact::detect;
use crate::energy::BodyWork;
use crate::geometry::shape::{Ball, Carried};
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;

/// Adds a dynamical system, for [`Simulation::add_system`].
pub(in crate::step) fn add_system<S: Space>(
    s: &mut Simulation<S>,
    system: Box<dyn DynamicalSystem<S>>,
) -> usize {
    let (kinetic, stored) = (system.kinetic_energy(), system.stored_energy());
    let contactors = system.contactors();
    let index = s.state.systems.add(system, &mut s.state.bodies);
    // Contacts in the first move are searched with the velocities at the start.
    s.state.systems.carry(&mut s.state.bodies);
    let system = s.state.systems.get(index);
    let mut points = 0..0;
    for (contactor, body) in contactors.iter().zip(s.state.systems.bodies(index)) {
        if let Some(shape) = system.and_then(|s| s.surface(contactor)) {
            s.shapes.surfaces.push(Carried {
                body: *body,
                offset: S::Vector::zero(),
                shape,
                material: contactor.material,
            });
        }
        if let (Some(system), ContactorShape::Grain) = (system, contactor.shape) {
            let surface = s.shapes.surfaces.len() - 1;
            s.state.network.of_grains.insert(surface);
            let areas = system.point_areas(contactor);
            let first = s.shapes.balls.len();
            points = first..first + areas.len();
            let vertices = system.surface_vertices(contactor).into_iter();
            let point = |(offset, area)| Ball {
                body: *body,
                radius: 0.0,
                offset,
                material: contactor.material,
                area,
            };
            s.shapes.balls.extend(vertices.zip(areas).map(point));
        }
        let radius = match contactor.shape {
            ContactorShape::Ball => Some(contactor.radius),
            ContactorShape::Point => Some(0.0),
            ContactorShape::Surface | ContactorShape::Grain | ContactorShape::Given => None,
        };
        if let Some(radius) = radius {
            s.shapes.balls.push(Ball {
                body: *body,
                radius,
                offset: S::Vector::zero(),
                material: contactor.material,
                area: S::Vector::zero(),
            });
        }
    }
    if !points.is_empty() {
        s.state.systems.set_points(index, points);
    }
    s.state.network.fast = detect::fast_motion(&s.shapes, s.state.network.alert);
    s.state.network.forget_neighbours();
    s.state.energy.kinetic += kinetic;
    s.state.energy.initial_kinetic += kinetic;
    s.state.energy.elastic += stored;
    s.state.energy.external_work += stored;
    s.state.energy.raise_scale(kinetic);
    s.state.energy.raise_scale(stored);
    index
}

/// Advances all systems through the first part of a step (s).
pub(super) fn begin_systems<S: Space>(s: &mut Simulation<S>, time: f64) {
    if s.state.systems.is_empty() {
        return;
    }
    let step = system_step(s);
    s.state.systems.begin_step(&step);
    s.state.systems.advance(time);
    carry_systems(s);
}

/// Moves the bodies of contactors with their systems, and deforms surfaces with them.
pub(super) fn carry_systems<S: Space>(s: &mut Simulation<S>) {
    s.state.systems.carry(&mut s.state.bodies);
    s.state.systems.deform(&s.state.bodies, &mut s.shapes);
}

/// Computes the velocities of systems without contacts, and writes those of their bodies to `free`.
pub(super) fn free_systems<S: Space>(s: &mut Simulation<S>, free: &mut [(S::Vector, S::Spin)]) {
    if !s.state.systems.is_empty() {
        let step = system_step(s);
        s.state.systems.free_velocities(&step, free);
    }
}

/// Restores the velocities of all systems and their bodies at the start of the step.
pub(super) fn restart_systems<S: Space>(s: &mut Simulation<S>) {
    if !s.state.systems.is_empty() {
        s.state.systems.restart();
        s.state.systems.carry(&mut s.state.bodies);
    }
}

/// Advances all systems through the last part of a step (s) and adds their work; returns their
/// kinetic and stored energy.
pub(in crate::step) fn end_systems<S: Space>(
    s: &mut Simulation<S>,
    time: f64,
    work: &mut BodyWork,
) -> (f64, f64) {
    if s.state.systems.is_empty() {
        return (0.0, 0.0);
    }
    s.state.systems.advance(time);
    let own = s.state.systems.work(&system_step(s));
    work.potential += own.potential;
    work.external += own.external;
    work.damping += own.damping;
    work.scheme += own.scheme;
    work.expansion += own.expansion;
    s.state.systems.energies()
}

/// Returns the data of the current step that systems receive.
pub(in crate::step) fn system_step<S: Space>(s: &Simulation<S>) -> SystemStep<S> {
    SystemStep {
        time: s.state.time,
        h: s.options.scheme.h,
        theta: s.options.scheme.theta,
        gravity: s.state.gravity,
    }
}
