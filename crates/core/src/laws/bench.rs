//! A test bench for interface laws: drives a single contact, without bodies, along a prescribed
//! path, like a testing machine.

pub mod fracture;
pub mod scale;
pub mod spring;

use super::batch::{CallChecks, LawBatch};
use super::bond_step::BondStep;
use super::error::LawError;
use super::function::Call;
use super::interface::{Interface, LoadedLaw};
use super::kind::Kind;
use super::step_info::StepInfo;
use serde::Serialize;

/// State of a contact on the bench.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchState {
    /// Time (s).
    pub time: f64,
    /// Opening (n, t1, t2) (m).
    pub opening: [f64; 3],
    /// Rotation (twist, bending, bending) (rad).
    pub rotation: [f64; 3],
    /// Damage.
    pub damage: f64,
    /// Time under compression (s).
    pub compression_time: f64,
    /// Internal variables of the laws, slot after slot.
    pub variables: Vec<f64>,
}

/// Prescribed motion in a step, and the temperatures of the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchMotion {
    /// Opening at its end (m).
    pub opening: [f64; 3],
    /// Rotation at its end (rad).
    pub rotation: [f64; 3],
    /// Gap at its end (m), for laws without opening.
    pub gap: f64,
    /// Compressive pressure over the area (Pa).
    pub pressure: f64,
    /// Temperatures of candidate and antagonist (K), of equal effusivities.
    pub temperatures: [f64; 2],
}

/// Temperature of bodies for which none is given (K): 20 degrees Celsius.
pub const ROOM_TEMPERATURE: f64 = 293.15;
/// Thermal conductivity (W/(m K)) and electrical resistivity (ohm m) of the pair on the bench:
/// steel.
pub const STEEL: [f64; 2] = [50.0, 2e-7];

impl Default for BenchMotion {
    /// The contact is at rest, closed, without a load, at room temperature.
    fn default() -> Self {
        Self {
            opening: [0.0; 3],
            rotation: [0.0; 3],
            gap: 0.0,
            pressure: 0.0,
            temperatures: [ROOM_TEMPERATURE; 2],
        }
    }
}

/// Outputs of the laws at the end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BenchOutputs {
    /// Traction (Pa); a positive normal part pulls together.
    pub traction: [f64; 3],
    /// Moment over the area (N m/m^2).
    pub moment: [f64; 3],
    /// Stiffnesses: normal, tangential, twist, bending.
    pub stiffness: [f64; 4],
    /// Stored energy (J/m^2).
    pub stored: f64,
    /// Damage.
    pub damage: f64,
    /// Friction coefficient.
    pub mu: f64,
    /// Normal and tangential restitution.
    pub restitution: [f64; 2],
    /// Attraction without opening, tension and shear (Pa).
    pub strength: [f64; 2],
    /// Rolling and spinning friction lengths (m).
    pub rolling: [f64; 2],
    /// Volume removed over the step (m^3).
    pub worn: f64,
    /// Thermal (W/K) and electrical (S) conductance.
    pub conductance: [f64; 2],
}

/// A testing machine for contacts under one interface law.
#[derive(Debug)]
pub struct Bench {
    law: Interface,
    dimension: u32,
    area: f64,
    radius: f64,
    /// Thermal conductivity (W/(m K)) and electrical resistivity (ohm m) of the pair.
    material: [f64; 2],
    batch: LawBatch,
    declared_damage: Vec<f64>,
}

impl Bench {
    /// Creates a bench for contacts of a reduced radius (m) and of the area that the interface
    /// derives from it.
    pub fn new(law: Interface, dimension: u32, radius: f64) -> Self {
        let area = law.area.area(dimension as usize, radius);
        Self {
            law,
            dimension,
            area,
            radius,
            material: STEEL,
            batch: LawBatch::default(),
            declared_damage: Vec::new(),
        }
    }

    /// Gives the contacts this area (m^2; m in 2D) instead of the one derived from the radius.
    #[must_use]
    pub fn of_area(mut self, area: f64) -> Self {
        self.area = area;
        self
    }

    /// Gives the pair this thermal conductivity (W/(m K)) and electrical resistivity (ohm m); the
    /// default is steel.
    #[must_use]
    pub fn of_material(mut self, material: [f64; 2]) -> Self {
        self.material = material;
        self
    }

    /// Accepts outputs outside their physical range, such as negative friction, for callers that
    /// check them.
    #[must_use]
    pub fn lenient(mut self) -> Self {
        self.batch.checks = CallChecks::Lenient;
        self
    }

    /// Makes every law call twice in guarded memory, so that every invalid write is detected; slow.
    #[must_use]
    pub fn guarded(mut self) -> Self {
        self.batch.checks = CallChecks::Guarded(Box::default());
        self
    }

    /// Repeats every law call and compares the outputs, to detect data races between threads.
    #[must_use]
    pub fn repeating(mut self) -> Self {
        self.batch.checks = CallChecks::Repeated;
        self
    }

    /// Returns the law under test.
    pub fn law(&self) -> &Interface {
        &self.law
    }

    /// Returns the damage that the laws returned in the last step, before the host enforced that it
    /// does not decrease.
    pub fn declared_damage(&self) -> &[f64] {
        &self.declared_damage
    }

    /// Returns the area of the contacts (m^2).
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the state of a new contact: an intact bond if the cohesion law has an opening.
    pub fn fresh(&self) -> BenchState {
        BenchState {
            time: 0.0,
            opening: [0.0; 3],
            rotation: [0.0; 3],
            damage: if self.law.opens() { 0.0 } else { 1.0 },
            compression_time: 0.0,
            variables: self.law.initial(),
        }
    }

    /// Moves a batch of contacts by one step of `h` seconds, with one motion per contact.
    ///
    /// # Errors
    /// The law's error, with the index of the contact.
    pub fn step(
        &mut self,
        states: &mut [BenchState],
        motions: &[BenchMotion],
        h: f64,
    ) -> Result<Vec<BenchOutputs>, LawError> {
        let mut answers = vec![BenchOutputs::default(); states.len()];
        let info = StepInfo {
            dimension: self.dimension,
            time: states.first().map_or(0.0, |s| s.time),
            h,
            theta: 0.5,
            correction: 0.0,
        };
        self.contact(states, motions, &info, &mut answers)?;
        let bond_step = self.update_damage(states, motions, &info)?;
        for (k, answer) in answers.iter_mut().enumerate() {
            answer.damage = bond_step.damage.get(k).copied().unwrap_or(states[k].damage);
        }
        self.cohesion(states, motions, &info, &bond_step, &mut answers)?;
        let broke: Vec<f64> = answers.iter().map(|a| a.damage).collect();
        self.end(states, motions, &info, &broke, &mut answers)?;
        for (state, (motion, answer)) in states.iter_mut().zip(motions.iter().zip(&answers)) {
            state.time += h;
            state.opening = motion.opening;
            state.rotation = motion.rotation;
            state.damage = answer.damage;
            state.compression_time = if motion.pressure > 0.0 {
                state.compression_time + h
            } else {
                0.0
            };
        }
        Ok(answers)
    }

    /// Moves one contact by one step of `h` seconds.
    ///
    /// # Errors
    /// The law's error.
    pub fn step_one(
        &mut self,
        state: &mut BenchState,
        motion: &BenchMotion,
        h: f64,
    ) -> Result<BenchOutputs, LawError> {
        let (states, motions) = (std::slice::from_mut(state), std::slice::from_ref(motion));
        Ok(self.step(states, motions, h)?[0])
    }

    /// Fills the input columns of the laws with the openings at the start or the end of the step.
    fn fill(&mut self, states: &[BenchState], motions: &[BenchMotion], info: &StepInfo, end: bool) {
        let c = &mut self.batch.columns;
        c.clear();
        c.n = states.len();
        let rotates = self.law.rotates();
        let compliant = self.law.compliant();
        let heated = self.law.reads_temperatures();
        for (state, motion) in states.iter().zip(motions) {
            if heated {
                let [first, second] = motion.temperatures;
                let all = [0.5 * (first + second), first, second];
                for (column, t) in c.temperature.iter_mut().zip(all) {
                    column.push(t);
                }
                c.conductivity.push(self.material[0]);
                c.resistivity.push(self.material[1]);
            }
            if compliant {
                c.overlap.push((-motion.gap).max(0.0));
                c.effective_mass.push(0.0);
                let forces = c.spring.iter_mut().chain(&mut c.spring_before);
                forces.for_each(|t| t.push(0.0));
            }
            c.gap.push(motion.gap);
            c.area.push(self.area);
            c.radius.push(self.radius);
            c.age.push(state.time);
            c.compression_time.push(state.compression_time);
            c.damage.push(state.damage);
            c.impulse[0].push(info.h * self.area * motion.pressure);
            c.impulse[1].push(0.0);
            c.impulse[2].push(0.0);
            for k in 0..3 {
                let (from, to) = (state.opening[k], motion.opening[k]);
                c.velocity[k].push((to - from) / info.h);
                c.opening[k].push(if end { to } else { from });
                if rotates {
                    let (from, to) = (state.rotation[k], motion.rotation[k]);
                    c.rotation[k].push(if end { to } else { from });
                }
            }
        }
        for v in 0..self.law.variables() {
            let column: Vec<f64> = states.iter().map(|s| s.variables[v]).collect();
            c.state_next.push(column.clone());
            c.state.push(column);
        }
        c.size_outputs();
    }

    fn keep(&self, states: &mut [BenchState]) {
        for (v, column) in self.batch.columns.state_next.iter().enumerate() {
            for (state, value) in states.iter_mut().zip(column) {
                state.variables[v] = *value;
            }
        }
    }

    fn contact(
        &mut self,
        states: &[BenchState],
        motions: &[BenchMotion],
        info: &StepInfo,
        answers: &mut [BenchOutputs],
    ) -> Result<(), LawError> {
        self.fill(states, motions, info, false);
        let contact = self.law.contact().clone();
        self.batch.run(&contact, info, 0.0, Call::Prepare)?;
        let out = &self.batch.columns.out;
        for (k, answer) in answers.iter_mut().enumerate() {
            answer.mu = out.friction[k];
            answer.restitution = [out.restitution_n[k], out.restitution_t[k]];
            answer.strength = [out.tension_strength[k], out.shear_cohesion[k]];
            answer.rolling = [out.rolling[k], out.spinning[k]];
        }
        Ok(())
    }

    fn update_damage(
        &mut self,
        states: &mut [BenchState],
        motions: &[BenchMotion],
        info: &StepInfo,
    ) -> Result<BondStep, LawError> {
        let mut bond_step = BondStep::default();
        if self.law.opens() {
            self.fill(states, motions, info, true);
            self.batch.update_damage(&self.law, info, &mut bond_step)?;
            self.declared_damage
                .clone_from(&self.batch.columns.out.damage);
            self.keep(states);
        }
        Ok(bond_step)
    }

    fn cohesion(
        &mut self,
        states: &[BenchState],
        motions: &[BenchMotion],
        info: &StepInfo,
        bond_step: &BondStep,
        answers: &mut [BenchOutputs],
    ) -> Result<(), LawError> {
        let Some(cohesion) = self.law.cohesion().cloned() else {
            return Ok(());
        };
        self.fill(states, motions, info, true);
        let opens = self.law.opens();
        if opens {
            self.batch.columns.damage.clone_from(&bond_step.damage);
        }
        self.batch.run(&cohesion, info, 0.0, Call::Prepare)?;
        let out = &self.batch.columns.out;
        for (k, answer) in answers.iter_mut().enumerate() {
            answer.strength[0] += out.tension_strength[k];
            answer.strength[1] += out.shear_cohesion[k];
            if !opens {
                continue;
            }
            let (t, m) = (&out.traction, &out.moment);
            answer.traction = [t[0][k], t[1][k], t[2][k]];
            answer.moment = [m[0][k], m[1][k], m[2][k]];
            answer.stiffness = [
                out.stiffness_n[k],
                out.stiffness_t[k],
                out.stiffness_twist[k],
                out.stiffness_bend[k],
            ];
            if self.law.tension_only() && answer.traction[0] < 0.0 {
                answer.traction[0] = 0.0;
                answer.stiffness[0] = 0.0;
            }
            answer.stored = bond_step.stored(&self.law, k);
        }
        Ok(())
    }

    /// Evaluates the laws that act on every contact, and wear.
    fn end(
        &mut self,
        states: &mut [BenchState],
        motions: &[BenchMotion],
        info: &StepInfo,
        damage: &[f64],
        answers: &mut [BenchOutputs],
    ) -> Result<(), LawError> {
        let on_contacts = self.law.loaded().filter(|l| !self.law.acts_on_bonds(l));
        let acting: Vec<LoadedLaw> = on_contacts.cloned().collect();
        for loaded in acting {
            // Laws whose outputs are used at the start of a step update their variables here; the
            // others receive the slip.
            let answers_first = loaded.plugin.kind.spec().functions.contains(&Call::Prepare);
            if answers_first && loaded.variables() == 0 {
                continue;
            }
            self.fill(states, motions, info, true);
            if !answers_first {
                self.slide(motions, info, damage, answers);
            }
            self.batch.run(&loaded, info, 0.0, Call::Commit)?;
            if loaded.plugin.kind == Kind::WEAR {
                for (answer, volume) in answers.iter_mut().zip(&self.batch.columns.out.volume) {
                    answer.worn = *volume;
                }
            }
            if loaded.plugin.kind == Kind::TRANSPORT {
                let out = &self.batch.columns.out;
                let columns = out.conductance.iter().zip(&out.electric_conductance);
                for (answer, (thermal, electric)) in answers.iter_mut().zip(columns) {
                    answer.conductance = [*thermal, *electric];
                }
            }
            self.keep(states);
        }
        Ok(())
    }

    /// Computes damage, slip and friction work at the end of a step.
    fn slide(
        &mut self,
        motions: &[BenchMotion],
        info: &StepInfo,
        damage: &[f64],
        answers: &[BenchOutputs],
    ) {
        let c = &mut self.batch.columns;
        c.damage.copy_from_slice(damage);
        for (k, answer) in answers.iter().enumerate() {
            let slip = info.h * c.velocity[1][k].hypot(c.velocity[2][k]);
            let force = (motions[k].pressure * self.area).max(0.0);
            c.slip.push(slip);
            c.friction_work.push(answer.mu * force * slip);
        }
    }
}
