//! Reading a simulation.

use super::fields::{self, FieldInfo, FieldValues, GrainFields};
use super::memory::MemoryUse;
use super::placement;
use super::rows::{
    BallView, BodyColumns, ContactView, Motion, Outline, PieceView, ScarView, SurfaceView,
};
use super::systems::{SystemReader, SystemView};
use crate::bodies::SystemStep;
use crate::contact::detect::{self, LawTable};
use crate::contact::{Contact, StepSizeDiagnostics};
use crate::energy::Energy;
use crate::geometry::convex::Core;
use crate::geometry::periodic::Periodic;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::heat::{Heat, HeatState};
use crate::laws::Interface;
use crate::momentum::Momentum;
use crate::process::expansion::ThermalExpansion;
use crate::solve;
use crate::step::control::{Begun, GravityDrive};
use crate::step::fields::GrainPart;
use crate::step::{InDimension, Options, Simulation};
use std::fmt::Debug;

/// A simulation for reading, between two steps. The [module](super) describes the third components.
///
/// Bodies are counted as in [`RunView::bodies`], surfaces as in [`RunView::surfaces`].
pub trait RunView: Debug {
    /// The simulation in its dimension.
    #[doc(hidden)]
    fn in_dimension(&self) -> InDimension<'_>;
    /// Number of dimensions, 2 or 3.
    fn dimension(&self) -> usize;
    /// Time at the end of the last step (s).
    fn time(&self) -> f64;
    /// Steps completed.
    fn steps(&self) -> u64;
    /// How it is computed.
    fn options(&self) -> &Options;
    /// The options of the solver, with the tolerance that the current phase has set, if any.
    fn solver_in_force(&self) -> solve::Options;
    /// Number of the current phase, from 1; 0 before the first step and without phases.
    fn phase(&self) -> usize;
    /// Whether phases or processes end the run before its time.
    fn finished(&self) -> bool;
    /// The phases begun so far, in order.
    fn begun(&self) -> &[Begun];
    /// Acceleration of gravity (m/s^2).
    fn gravity(&self) -> [f64; 3];
    /// How gravity changes in time.
    fn gravity_drive(&self) -> Option<&GravityDrive>;
    /// Bodies that are removed at a time: index among the driven bodies, and time (s).
    fn gates(&self) -> &[(usize, f64)];
    /// Lengths of the periodic cell.
    fn periodic(&self) -> &Periodic;
    /// Distance within which a pair forms a contact (m).
    fn alert(&self) -> f64;
    /// Interface laws.
    fn laws(&self) -> &[Interface];
    /// Interface law of each pair of materials.
    fn table(&self) -> &LawTable;

    /// Columns of the bodies.
    fn bodies(&self) -> BodyColumns<'_>;
    /// The bodies that are grains and are still there.
    fn grains(&self) -> Vec<usize>;
    /// Where a body is and how it moves.
    fn motion(&self, body: usize) -> Motion;
    /// Inverse mass of a body along each axis, zero where its motion is imposed (1/kg).
    fn inverse_mass(&self, body: usize) -> [f64; 3];
    /// Moments of inertia in the body's own axes, row by row (kg m^2); in 2D the first alone.
    fn inertia_tensor(&self, body: usize) -> [f64; 9];
    /// Kinetic energy of a body (J; J/m in 2D).
    fn kinetic_energy(&self, body: usize) -> f64;
    /// Name of a body in messages: a first body's name, a grain's identity.
    fn body_name(&self, body: u32) -> String;
    /// Mean force (N; N/m in 2D) and moment about its centre (N m; N in 2D) of the last step by its
    /// contacts on a first body; `None` for a name that no first body has.
    fn contact_force_on(&self, name: &str) -> Option<[[f64; 3]; 2]>;

    /// The balls of all bodies, and the points of those that deform.
    fn balls(&self) -> Vec<BallView>;
    /// The convex pieces of all bodies.
    fn pieces(&self) -> Vec<PieceView>;
    /// The surfaces of all bodies.
    fn surfaces(&self) -> Vec<SurfaceView>;
    /// Lines of a surface in its own frame (m).
    fn surface_lines(&self, surface: usize) -> Vec<Vec<[f64; 3]>>;
    /// Lines of the surfaces of bodies that are still there.
    fn surface_outlines(&self) -> Vec<Outline>;
    /// Lines around the pieces: one around each in 2D, one around each face in 3D.
    fn piece_outlines(&self) -> Vec<Outline>;
    /// Surfaces that recede by wear.
    fn scars(&self) -> Vec<ScarView<'_>>;
    /// Number of dynamical systems.
    fn system_count(&self) -> usize;
    /// A dynamical system.
    fn system(&self, system: usize) -> Option<Box<dyn SystemView + '_>>;
    /// The dynamical system of a name.
    fn system_named(&self, name: &str) -> Option<usize>;
    /// The bodies that stand for the contactors of a dynamical system, in their order.
    fn bodies_of_system(&self, system: usize) -> &[u32];

    /// Number of contacts, open ones within the alert distance too.
    fn contact_count(&self) -> usize;
    /// Calls a function with each contact of the last step, in the order of their keys.
    fn visit_contacts(&self, visit: &mut dyn FnMut(&ContactView));
    /// End points of the contacts that [count](ContactView::counts): the candidate's centre, and
    /// the antagonist's centre or the closest point on its surface (m), the first in the periodic
    /// cell.
    fn contact_ends(&self) -> Vec<[[f64; 3]; 2]>;
    /// Bonds made so far.
    fn bonds_made(&self) -> u64;
    /// Bonds broken so far.
    fn bonds_broken(&self) -> u64;
    /// Mean damage of the bonds.
    fn mean_damage(&self) -> f64;
    /// What grains and contacts take in memory.
    fn memory_use(&self) -> MemoryUse;
    /// Diagnostics of the step size.
    fn step_size(&self) -> &StepSizeDiagnostics;

    /// The energy ledger (J; J/m in 2D).
    fn energies(&self) -> &Energy;
    /// The ledger of momentum (N s, N m s; in 2D per m).
    fn momentum(&self) -> &Momentum;
    /// Heat and current, as the case gives them.
    fn heat(&self) -> Option<&Heat>;
    /// Temperatures and the account of heat.
    fn heat_state(&self) -> Option<&HeatState>;
    /// Coefficient of thermal expansion of each body (1/K), zero where it keeps its size, and the
    /// dynamical systems that expand; `None` where no body expands.
    fn expanding(&self) -> Option<(&[f64], Vec<usize>)>;

    /// Centres of the parts of grains and first bodies that carry fields (m).
    fn grain_centres(&self) -> Vec<[f64; 3]>;
    /// These centres in the periodic cell (m).
    fn grain_points(&self) -> Vec<[f64; 3]>;
    /// The fields of the parts of grains and first bodies, in the order in which they are written.
    fn grain_fields(&self, with: GrainFields) -> Vec<FieldInfo>;
    /// Their values, in the same order.
    fn grain_values(&self, with: GrainFields) -> Vec<FieldValues>;
    /// The values of one of them.
    fn grain_field(&self, name: &str) -> Option<FieldValues>;
    /// The fields of contacts, in the order in which they are written.
    fn contact_fields(&self) -> Vec<FieldInfo>;
    /// Their values at all contacts, or at those that [count](ContactView::counts), in the same
    /// order.
    fn contact_values(&self, counted: bool) -> Vec<FieldValues>;
    /// The values of one of them.
    fn contact_field(&self, name: &str, counted: bool) -> Option<FieldValues>;
}

/// An angular velocity or a moment about world axes.
fn about_axes<S: Space>(spin: &S::Spin) -> [f64; 3] {
    match spin.padded() {
        [about_depth, ..] if S::D == 2 => [0.0, 0.0, about_depth],
        spin => spin,
    }
}

fn padded<V: VectorLike>(points: Vec<V>) -> Vec<[f64; 3]> {
    points.iter().map(VectorLike::padded).collect()
}

fn contact_view<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> ContactView {
    let force = contact.impulse * (1.0 / s.options.scheme.h);
    let candidate = contact.bodies[0] as usize;
    ContactView {
        key: contact.key,
        bodies: contact.bodies,
        interface: contact.law,
        point: (s.state.bodies.position[candidate] + contact.arms[0]).padded(),
        arms: contact.arms.map(|arm| arm.padded()),
        normal: contact.normal.padded(),
        gap: contact.gap,
        radius: contact.radius,
        force: force.padded(),
        normal_force: force.dot(&contact.normal),
        slides: contact.slides,
        central: contact.central,
        formed_at: contact.formed_at,
        bond: s.state.network.bond_state(contact),
        counts: contact.counts(),
    }
}

impl<S: Space> RunView for Simulation<S> {
    fn in_dimension(&self) -> InDimension<'_> {
        InDimension::of(self)
    }
    fn dimension(&self) -> usize {
        S::D
    }
    fn time(&self) -> f64 {
        self.state.time
    }
    fn steps(&self) -> u64 {
        self.state.steps
    }
    fn options(&self) -> &Options {
        &self.options
    }
    fn solver_in_force(&self) -> solve::Options {
        self.solver_in_force()
    }
    fn phase(&self) -> usize {
        self.state.control.phase()
    }
    fn finished(&self) -> bool {
        self.finished()
    }
    fn begun(&self) -> &[Begun] {
        self.state.control.begun()
    }
    fn gravity(&self) -> [f64; 3] {
        self.state.gravity.padded()
    }
    fn gravity_drive(&self) -> Option<&GravityDrive> {
        self.state.control.gravity_drive.as_ref()
    }
    fn gates(&self) -> &[(usize, f64)] {
        &self.state.control.gates
    }
    fn periodic(&self) -> &Periodic {
        &self.shapes.periodic
    }
    fn alert(&self) -> f64 {
        self.state.network.alert
    }
    fn laws(&self) -> &[Interface] {
        &self.laws
    }
    fn table(&self) -> &LawTable {
        &self.table
    }

    fn bodies(&self) -> BodyColumns<'_> {
        let bodies = &self.state.bodies;
        BodyColumns {
            id: &bodies.id,
            mass: &bodies.mass,
            inertia: &bodies.inertia,
            inverse_inertia: &bodies.inverse_inertia,
            length: &bodies.length,
            removed: &bodies.removed,
            driven: &bodies.driven,
            carriers: &bodies.carriers,
        }
    }
    fn grains(&self) -> Vec<usize> {
        self.state.bodies.grains().collect()
    }
    fn motion(&self, body: usize) -> Motion {
        let bodies = &self.state.bodies;
        Motion {
            position: bodies.position[body].padded(),
            rotation: S::rotation_numbers(&bodies.rotation[body]),
            velocity: bodies.velocity[body].padded(),
            spin: about_axes::<S>(&bodies.spin[body]),
        }
    }
    fn inverse_mass(&self, body: usize) -> [f64; 3] {
        self.state.bodies.inverse_mass[body].padded()
    }
    fn inertia_tensor(&self, body: usize) -> [f64; 9] {
        let bodies = &self.state.bodies;
        let uniform = S::Tensor::uniform(bodies.inertia[body]);
        let own = bodies.tensors.get(body).and_then(Option::as_ref);
        let own = own.map_or(uniform, |t| *t.own());
        let n = S::Spin::N;
        std::array::from_fn(|k| {
            let (i, j) = (k / 3, k % 3);
            if i < n && j < n { own.entry(i, j) } else { 0.0 }
        })
    }
    fn kinetic_energy(&self, body: usize) -> f64 {
        self.state.bodies.energy_of(body)
    }
    fn body_name(&self, body: u32) -> String {
        self.state.bodies.name(body)
    }
    fn contact_force_on(&self, name: &str) -> Option<[[f64; 3]; 2]> {
        let (force, moment) = self.contact_force_on(name)?;
        Some([force.padded(), about_axes::<S>(&moment)])
    }

    fn balls(&self) -> Vec<BallView> {
        let bodies = &self.state.bodies;
        let balls = self.shapes.balls.iter().map(|ball| BallView {
            body: ball.body,
            material: ball.material,
            radius: ball.radius,
            centre: detect::centre(ball, bodies).padded(),
            offset: ball.offset.padded(),
            area: ball.area.padded(),
        });
        balls.collect()
    }
    fn pieces(&self) -> Vec<PieceView> {
        let bodies = &self.state.bodies;
        let pieces = self.shapes.pieces.iter().map(|piece| {
            let boundary = piece.core.boundary();
            PieceView {
                body: piece.body,
                material: piece.material,
                size: piece.size,
                bound: piece.bound,
                rounding: piece.rounding,
                centre: detect::piece_centre(piece, bodies).padded(),
                offset: piece.offset.padded(),
                corners: padded(boundary.corners),
                faces: boundary.faces,
            }
        });
        pieces.collect()
    }
    fn surfaces(&self) -> Vec<SurfaceView> {
        let surfaces = self.shapes.surfaces.iter().map(|surface| SurfaceView {
            body: surface.body,
            material: surface.material,
            offset: surface.offset.padded(),
            flat: surface.shape.flat().is_some(),
        });
        surfaces.collect()
    }
    fn surface_lines(&self, surface: usize) -> Vec<Vec<[f64; 3]>> {
        let lines = self.shapes.surfaces[surface].shape.outline();
        lines.into_iter().map(padded).collect()
    }
    fn surface_outlines(&self) -> Vec<Outline> {
        let bodies = &self.state.bodies;
        let surfaces = self.shapes.surfaces.iter();
        let present = surfaces.filter(|f| !bodies.removed[f.body as usize]);
        let lines = present.flat_map(|surface| {
            let b = surface.body as usize;
            let place = move |p: &S::Vector| {
                let arm = S::rotate(&bodies.rotation[b], &(surface.offset + *p));
                (bodies.position[b] + arm).padded()
            };
            let chains = surface.shape.outline().into_iter();
            chains.map(move |chain| Outline {
                body: surface.body,
                points: chain.iter().map(place).collect(),
            })
        });
        lines.collect()
    }
    fn piece_outlines(&self) -> Vec<Outline> {
        let pieces = self.shapes.pieces.iter();
        let lines = pieces.flat_map(|piece| {
            let lines = placement::piece_outline(self, piece).into_iter();
            lines.map(|corners| Outline {
                body: piece.body,
                points: padded(corners),
            })
        });
        lines.collect()
    }
    fn scars(&self) -> Vec<ScarView<'_>> {
        let scars = self.state.scars.iter().map(|scar| ScarView {
            name: &scar.name,
            surface: scar.surface,
            thickness: scar.thickness,
            vertices: scar.vertices().count(),
            volume: scar.volume(),
            deepest: scar.deepest(),
        });
        scars.collect()
    }
    fn system_count(&self) -> usize {
        self.state.systems.len()
    }
    fn system(&self, system: usize) -> Option<Box<dyn SystemView + '_>> {
        let system = self.state.systems.get(system)?;
        let step = SystemStep {
            time: self.state.time,
            h: self.options.scheme.h,
            theta: self.options.scheme.theta,
            gravity: self.state.gravity,
        };
        Some(Box::new(SystemReader { system, step }))
    }
    fn system_named(&self, name: &str) -> Option<usize> {
        self.state.systems.named(name)
    }
    fn bodies_of_system(&self, system: usize) -> &[u32] {
        self.state.systems.bodies(system)
    }

    fn contact_count(&self) -> usize {
        self.state.network.contacts.len()
    }
    fn visit_contacts(&self, visit: &mut dyn FnMut(&ContactView)) {
        for contact in &self.state.network.contacts {
            visit(&contact_view(self, contact));
        }
    }
    fn contact_ends(&self) -> Vec<[[f64; 3]; 2]> {
        let contacts = self.state.network.counted_contacts();
        let ends = contacts.map(|contact| {
            let (a, b) = placement::ends(self, contact);
            let at = self.shapes.periodic.wrapped(a);
            [at.padded(), (b - a + at).padded()]
        });
        ends.collect()
    }
    fn bonds_made(&self) -> u64 {
        self.state.network.bonds_made()
    }
    fn bonds_broken(&self) -> u64 {
        self.state.network.bonds_broken()
    }
    fn mean_damage(&self) -> f64 {
        self.state.network.mean_damage()
    }
    fn memory_use(&self) -> MemoryUse {
        MemoryUse::of::<S>()
    }
    fn step_size(&self) -> &StepSizeDiagnostics {
        &self.state.network.step_size
    }

    fn energies(&self) -> &Energy {
        &self.state.energy
    }
    fn momentum(&self) -> &Momentum {
        &self.state.momentum
    }
    fn heat(&self) -> Option<&Heat> {
        self.heat()
    }
    fn heat_state(&self) -> Option<&HeatState> {
        self.state.heat.as_ref()
    }
    fn expanding(&self) -> Option<(&[f64], Vec<usize>)> {
        let expansion = ThermalExpansion::of(self)?;
        let systems = expansion.systems.iter().map(|e| e.system).collect();
        Some((&expansion.coefficient, systems))
    }

    fn grain_centres(&self) -> Vec<[f64; 3]> {
        GrainPart::all(self)
            .map(|part| part.centre.padded())
            .collect()
    }
    fn grain_points(&self) -> Vec<[f64; 3]> {
        let wrapped = |part: GrainPart<S>| self.shapes.periodic.wrapped(part.centre).padded();
        GrainPart::all(self).map(wrapped).collect()
    }
    fn grain_fields(&self, with: GrainFields) -> Vec<FieldInfo> {
        fields::grain_fields(self, with)
    }
    fn grain_values(&self, with: GrainFields) -> Vec<FieldValues> {
        fields::grain_values(self, with)
    }
    fn grain_field(&self, name: &str) -> Option<FieldValues> {
        fields::grain_field(self, name)
    }
    fn contact_fields(&self) -> Vec<FieldInfo> {
        fields::contact_fields(self)
    }
    fn contact_values(&self, counted: bool) -> Vec<FieldValues> {
        fields::contact_values(self, counted)
    }
    fn contact_field(&self, name: &str, counted: bool) -> Option<FieldValues> {
        fields::contact_field(self, name, counted)
    }
}
