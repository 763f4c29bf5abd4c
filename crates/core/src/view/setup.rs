//! Additions of a case to a simulation before its first step.

use super::RunControl;
use crate::bodies::Dof;
use crate::bodies::pressure::{Servo, ServoTarget};
use crate::contact::detect;
use crate::geometry::space::{Space, VectorLike};
use crate::heat::{ExpandingSystem, Heat, HeatState};
use crate::process::circuit::{CircuitParameters, CircuitProcess, Intervals};
use crate::process::cycle::CycleClock;
use crate::process::expansion::ThermalExpansion;
use crate::process::heat::HeatFlow;
use crate::process::jump::{JumpSpec, Jumps};
use crate::process::sliding::SlidingBody;
use crate::step::Simulation;
use crate::step::control::{GravityDrive, Phase};
use crate::wear::Scar;

/// A point of a deformable body, behind a surface of another body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointBehind {
    /// The body of the point.
    pub point: u32,
    /// The body of the surface.
    pub surface: u32,
    /// Distance behind the surface (m).
    pub depth: f64,
}

/// A simulation before its first step.
pub trait RunSetup: RunControl {
    /// Sets gravity (m/s^2), and its time dependence.
    fn set_gravity(&mut self, gravity: [f64; 3], drive: Option<GravityDrive>);
    /// Checks the pressures of a drive.
    ///
    /// # Errors
    /// A wall is missing or not plane, or no length is defined along an axis.
    fn check_pressures(&self, target: &ServoTarget, drive: &Dof) -> Result<(), String>;
    /// Adds the pressures of a drive.
    ///
    /// # Errors
    /// The errors of [`RunSetup::check_pressures`].
    fn add_pressures(&mut self, target: &ServoTarget, drive: &Dof) -> Result<(), String>;
    /// Measures the loaded areas of all pressures.
    fn measure_areas(&mut self);
    /// Lets a surface recede by wear, every `every` steps, in the frame of its body; it is worn
    /// through at the depth `thickness` (m). Returns whether it can wear.
    fn add_scar(&mut self, surface: usize, name: String, thickness: f64, every: u64) -> bool;
    /// Removes a driven body, by its index among them, at a time (s).
    fn add_gate(&mut self, place: usize, time: f64);
    /// Adds a phase after the existing ones.
    fn add_phase(&mut self, phase: Phase);
    /// Gives driven bodies their imposed velocities at time zero.
    fn set_in_motion(&mut self);
    /// Computes heat from now on.
    fn add_heat(&mut self, heat: Heat, state: HeatState);
    /// Lets bodies expand with temperature ([`ThermalExpansion::add_to`]): rigid bodies by
    /// coefficients of linear expansion (1/K), one per body, and dynamical systems.
    fn add_expansion(&mut self, coefficient: Vec<f64>, systems: Vec<ExpandingSystem>);
    /// Adds jumps over cycles; see [`Jumps::new`].
    fn add_jumps(&mut self, spec: JumpSpec, clock: CycleClock, test: SlidingBody, steps: [u64; 2]);
    /// Adds the tribological circuit, which starts at a time (s).
    fn add_circuit(&mut self, spec: CircuitParameters, start: f64, intervals: Intervals);
    /// Returns the first point of a deformable body that is farther behind a surface with which it
    /// interacts than the alert distance. Points are searched up to twice the length of their body
    /// in the plane, and up to `sizes` times their own size in space, where the cost of a search
    /// grows with the square of the distance.
    fn point_behind(&self, sizes: f64) -> Option<PointBehind>;
}

impl<S: Space> RunSetup for Simulation<S> {
    fn set_gravity(&mut self, gravity: [f64; 3], drive: Option<GravityDrive>) {
        self.state.gravity = S::Vector::from_slice(&gravity);
        self.state.control.gravity = self.state.gravity;
        self.state.control.gravity_drive = drive;
    }
    fn check_pressures(&self, target: &ServoTarget, drive: &Dof) -> Result<(), String> {
        Servo::of(&self.state.bodies, &self.shapes, target, drive).map(drop)
    }
    fn add_pressures(&mut self, target: &ServoTarget, drive: &Dof) -> Result<(), String> {
        let servos = Servo::of(&self.state.bodies, &self.shapes, target, drive)?;
        self.state.control.servos.extend(servos);
        Ok(())
    }
    fn measure_areas(&mut self) {
        self.measure_areas();
    }
    fn add_scar(&mut self, surface: usize, name: String, thickness: f64, every: u64) -> bool {
        let carried = &self.shapes.surfaces[surface];
        let origin = self.state.bodies.position[carried.body as usize] + carried.offset;
        let scar = Scar::new(name, surface, carried, thickness, every);
        let wears = scar.is_some();
        if let Some(scar) = scar {
            self.follow_wear(scar.shifted(origin));
        }
        wears
    }
    fn add_gate(&mut self, place: usize, time: f64) {
        self.state.control.removals.push((place, time));
    }
    fn add_phase(&mut self, phase: Phase) {
        self.phases.push(phase);
    }
    fn set_in_motion(&mut self) {
        self.set_in_motion();
    }
    fn add_heat(&mut self, heat: Heat, state: HeatState) {
        HeatFlow::add_to(self, heat, state);
    }
    fn add_expansion(&mut self, coefficient: Vec<f64>, systems: Vec<ExpandingSystem>) {
        ThermalExpansion::add_to(self, coefficient, systems);
    }
    fn add_jumps(&mut self, spec: JumpSpec, clock: CycleClock, test: SlidingBody, steps: [u64; 2]) {
        let jumps = Jumps::new(spec, clock, test, steps, self);
        self.add_process(jumps);
    }
    fn add_circuit(&mut self, spec: CircuitParameters, start: f64, intervals: Intervals) {
        self.add_process(CircuitProcess::new(spec, start, intervals));
    }
    fn point_behind(&self, sizes: f64) -> Option<PointBehind> {
        let bodies = &self.state.bodies;
        let system = |body: u32| bodies.carrier(body as usize).map(|c| c.system);
        for point in self.shapes.balls.iter().filter(|b| b.radius == 0.0) {
            let centre = detect::centre(point, bodies);
            let own = system(point.body);
            let length = own.and_then(|k| self.state.systems.get(k as usize));
            let reach = match S::D {
                2 => length.map_or(0.0, |s| 2.0 * s.length()),
                _ => sizes * bodies.length[point.body as usize],
            };
            for surface in &self.shapes.surfaces {
                let other = surface.body as usize;
                let apart = own != system(surface.body);
                if !apart || self.table.get(point.material, surface.material).is_none() {
                    continue;
                }
                let arm = S::unrotate(&bodies.rotation[other], &(centre - bodies.position[other]));
                let mut near = Vec::new();
                surface
                    .shape
                    .closest_points(&(arm - surface.offset), reach, &mut near);
                let nearest = near
                    .iter()
                    .min_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()));
                let depth = nearest.map_or(0.0, |touch| -touch.distance);
                if depth > self.state.network.alert {
                    return Some(PointBehind {
                        point: point.body,
                        surface: surface.body,
                        depth,
                    });
                }
            }
        }
        None
    }
}
