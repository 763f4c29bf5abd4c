//! The columns of a batch: they are collected from the network, passed to plugins, and read back.

use super::function::Call;
use super::interface::LoadedLaw;
use super::kind::Kind;
pub use super::outputs::{Outputs, Triple};
use super::step_info::StepInfo;
use crate::contact::ContactHeat;
use fretwork_abi::FwBatch;
use std::ptr::{null, null_mut};

/// The columns of one batch; the buffers are reused from step to step.
#[derive(Debug, Default)]
pub struct BatchColumns {
    /// Number of contacts.
    pub n: usize,
    /// Gap (m).
    pub gap: Vec<f64>,
    /// Area (m^2).
    pub area: Vec<f64>,
    /// Reduced radius (m).
    pub radius: Vec<f64>,
    /// Age (s).
    pub age: Vec<f64>,
    /// Opening (m).
    pub opening: Triple,
    /// Relative velocity (m/s).
    pub velocity: Triple,
    /// Impulse (N s).
    pub impulse: Triple,
    /// Damage.
    pub damage: Vec<f64>,
    /// Undamaged stored energy (J/m^2).
    pub energy_intact: Vec<f64>,
    /// Undamaged traction (Pa).
    pub intact: Triple,
    /// Slip over the step (m).
    pub slip: Vec<f64>,
    /// Friction work over the step (J).
    pub friction_work: Vec<f64>,
    /// Time under a compressive impulse (s).
    pub compression_time: Vec<f64>,
    /// Rotation of the bond (rad); empty unless the cohesion law resists rotation.
    pub rotation: Triple,
    /// Undamaged moment over the area (N m/m^2); empty unless the cohesion law resists rotation.
    pub intact_moment: Triple,
    /// Overlap (m); empty unless the contact law is compliant.
    pub overlap: Vec<f64>,
    /// Effective mass along the normal (kg); empty unless the contact law is compliant.
    pub effective_mass: Vec<f64>,
    /// Force of the tangential spring (N), along t1 and t2; empty unless the contact law is
    /// compliant.
    pub spring: [Vec<f64>; 2],
    /// Force of the tangential spring at the start of the step (N), for commit.
    pub spring_before: [Vec<f64>; 2],
    /// Temperatures of contact, candidate and antagonist (K); empty where no heat is computed.
    pub temperature: [Vec<f64>; 3],
    /// Thermal conductivity of the pair (W/(m K)); empty where no heat is computed.
    pub conductivity: Vec<f64>,
    /// Electrical resistivity of the pair (ohm m); empty where no current flows.
    pub resistivity: Vec<f64>,
    /// Internal variables at the start of the step.
    pub state: Vec<Vec<f64>>,
    /// Internal variables at the end of the step.
    pub state_next: Vec<Vec<f64>>,
    /// Outputs.
    pub out: Outputs,
    /// Whether the last call wrote beyond the end of a column.
    pub overrun: bool,
}

/// Number of guard values behind each output column, which reveal an overrun.
const GUARD_VALUES: usize = 8;
/// Guard value: a NaN with a payload that no law computes.
const CANARY: u64 = 0x7ff4_f37e_0b5e_55ed;

/// Appends guard values to a column.
fn guard(column: &mut Vec<f64>) {
    column.reserve(GUARD_VALUES);
    for place in &mut column.spare_capacity_mut()[..GUARD_VALUES] {
        place.write(f64::from_bits(CANARY));
    }
}

/// Returns whether the guard values of a column were overwritten, and removes them.
fn overrun(column: &mut Vec<f64>) -> bool {
    let guards = column.spare_capacity_mut()[..GUARD_VALUES].iter();
    // SAFETY: `guard` wrote them, and the column has not been reallocated since.
    guards
        .into_iter()
        .any(|p| unsafe { p.assume_init_read() }.to_bits() != CANARY)
}

/// Sizes a column whose values are all set afterwards.
fn fit(column: &mut Vec<f64>, n: usize) {
    if column.len() != n {
        column.resize(n, 0.0);
    }
}

/// Columns of a batch beyond those that every batch has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contents {
    /// Columns along t2, in three dimensions.
    pub spatial: bool,
    /// Rotations of bonds.
    pub rotates: bool,
    /// Columns of compliant contacts.
    pub compliant: bool,
    /// Springs at the start of the step, in addition to those at its end.
    pub after: bool,
    /// Temperatures and conductivities.
    pub heat: bool,
    /// Resistivities.
    pub current: bool,
}

/// Converts columns to the pointers of a batch: null for columns that are not in use.
struct Pointers {
    /// Number of contacts.
    n: usize,
    /// Whether space has three dimensions.
    spatial: bool,
}

impl Pointers {
    fn input(&self, column: &[f64]) -> *const f64 {
        if column.len() == self.n {
            column.as_ptr()
        } else {
            null()
        }
    }

    fn output(&self, column: &mut [f64]) -> *mut f64 {
        if column.len() == self.n {
            column.as_mut_ptr()
        } else {
            null_mut()
        }
    }

    fn input_3d(&self, column: &[f64]) -> *const f64 {
        if self.spatial {
            self.input(column)
        } else {
            null()
        }
    }

    fn output_3d(&self, column: &mut [f64]) -> *mut f64 {
        if self.spatial {
            self.output(column)
        } else {
            null_mut()
        }
    }
}

impl BatchColumns {
    fn inputs(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let single = [
            &mut self.gap,
            &mut self.area,
            &mut self.radius,
            &mut self.age,
            &mut self.compression_time,
            &mut self.damage,
            &mut self.energy_intact,
            &mut self.slip,
            &mut self.friction_work,
            &mut self.overlap,
            &mut self.effective_mass,
        ];
        let triples = [
            &mut self.opening,
            &mut self.velocity,
            &mut self.impulse,
            &mut self.intact,
            &mut self.rotation,
            &mut self.intact_moment,
        ];
        let all = single.into_iter().chain(triples.into_iter().flatten());
        let heat = self.temperature.iter_mut();
        let heat = heat.chain([&mut self.conductivity, &mut self.resistivity]);
        all.chain(&mut self.spring)
            .chain(&mut self.spring_before)
            .chain(heat)
    }

    /// Clears the inputs.
    pub fn clear(&mut self) {
        self.n = 0;
        self.inputs().for_each(Vec::clear);
        self.state.clear();
        self.state_next.clear();
    }

    /// Sizes the inputs that a gather sets for `n` contacts, and empties the others. Internal
    /// variables and outputs are sized separately.
    pub(super) fn begin(&mut self, n: usize, contents: Contents) {
        self.n = n;
        let count = |used: bool| if used { n } else { 0 };
        for column in [
            &mut self.gap,
            &mut self.area,
            &mut self.radius,
            &mut self.age,
            &mut self.compression_time,
            &mut self.damage,
        ] {
            fit(column, n);
        }
        for triple in [&mut self.opening, &mut self.velocity, &mut self.impulse] {
            fit(&mut triple[0], n);
            fit(&mut triple[1], n);
            fit(&mut triple[2], count(contents.spatial));
        }
        for column in &mut self.rotation {
            fit(column, count(contents.rotates));
        }
        let springs = [&mut self.overlap, &mut self.effective_mass];
        for column in springs.into_iter().chain(&mut self.spring) {
            fit(column, count(contents.compliant));
        }
        for column in &mut self.spring_before {
            fit(column, count(contents.compliant && contents.after));
        }
        let heat = self.temperature.iter_mut().chain([&mut self.conductivity]);
        heat.for_each(|column| fit(column, count(contents.heat)));
        fit(&mut self.resistivity, count(contents.current));
        let given = [
            &mut self.energy_intact,
            &mut self.slip,
            &mut self.friction_work,
        ];
        let intact = self.intact.iter_mut().chain(&mut self.intact_moment);
        given.into_iter().chain(intact).for_each(Vec::clear);
    }

    /// Fills the columns of heat for the members from the data of all contacts.
    pub(super) fn take_heat(&mut self, thermal: &ContactHeat, members: &[usize]) {
        for (k, at) in members.iter().enumerate() {
            let seen = &thermal.temperatures[*at];
            for (column, value) in self.temperature.iter_mut().zip(seen.temperature) {
                column[k] = value;
            }
            let [conductivity, resistivity] = thermal.pairs[seen.pair as usize].material;
            self.conductivity[k] = conductivity;
            if thermal.current {
                self.resistivity[k] = resistivity;
            }
        }
    }

    /// Sizes the columns of an internal variable, at the start and at the end of the step, and
    /// returns them.
    pub(super) fn fit_state(&mut self, variable: usize) -> [&mut [f64]; 2] {
        let count = self.state.len().max(variable + 1);
        [&mut self.state, &mut self.state_next].map(|columns| {
            columns.resize_with(count, Vec::new);
            fit(&mut columns[variable], self.n);
            &mut columns[variable][..]
        })
    }

    /// Copies the cohesion law's outputs for the undamaged bond to the inputs of the damage law.
    pub fn expose_intact(&mut self) {
        std::mem::swap(&mut self.energy_intact, &mut self.out.energy);
        std::mem::swap(&mut self.intact, &mut self.out.traction);
        std::mem::swap(&mut self.intact_moment, &mut self.out.moment);
        // Restores the sizes of the outputs after the buffers were swapped.
        self.out.energy.resize(self.n, 0.0);
        for column in self.out.traction.iter_mut().chain(&mut self.out.moment) {
            column.resize(self.n, 0.0);
        }
    }

    /// Applies a change to each output column, given the number of its values: columns of compliant
    /// contacts are empty unless the law is compliant, and columns of transport unless heat is
    /// computed.
    fn each_output(&mut self, change: impl Fn(&mut Vec<f64>, usize)) {
        self.out.every().for_each(|column| change(column, self.n));
        let n = self.overlap.len();
        self.out.springs().for_each(|column| change(column, n));
        let n = self.temperature[0].len();
        self.out.transport().for_each(|column| change(column, n));
    }

    /// Sizes the outputs. Values of earlier calls are cleared only where [`Self::clear_outputs`]
    /// does not follow.
    pub(super) fn fit_outputs(&mut self) {
        self.each_output(fit);
    }

    /// Sets the columns that a call of a law writes to zero.
    pub(super) fn clear_outputs(&mut self, kind: Kind, call: Call) {
        for output in (kind.spec().outputs)(&mut self.out, call) {
            output.values.fill(0.0);
        }
    }

    /// Resizes the outputs to zeros.
    pub fn size_outputs(&mut self) {
        self.each_output(|column, n| {
            column.clear();
            column.resize(n, 0.0);
        });
    }

    /// Runs `call` with the batch of these columns.
    pub fn with_batch<R>(
        &mut self,
        loaded: &LoadedLaw,
        info: &StepInfo,
        degradation: f64,
        call: impl FnOnce(&FwBatch) -> R,
    ) -> R {
        let (first, count) = (loaded.first_variable, loaded.variables());
        let states = self.state_next.iter_mut().skip(first).take(count);
        self.out.all().chain(states).for_each(guard);
        let pointers = Pointers {
            n: self.n,
            spatial: info.dimension == 3,
        };
        let state = self.state.iter().skip(first).take(count);
        let state: Vec<*const f64> = state.map(|v| pointers.input(v)).collect();
        let next = self.state_next.iter_mut().skip(first).take(count);
        let next: Vec<*mut f64> = next.map(|v| pointers.output(v)).collect();
        let energy = if loaded.plugin.kind == Kind::CONTACT {
            &mut self.out.contact_energy_t
        } else {
            &mut self.out.energy
        };
        let energy = pointers.output(energy);
        let answer = call(&FwBatch {
            out_energy: energy,
            degradation,
            parameters: loaded.parameters.as_ptr(),
            table: if loaded.table.is_empty() {
                null()
            } else {
                loaded.table.as_ptr()
            },
            table_length: loaded.table.len(),
            state: if state.is_empty() {
                null()
            } else {
                state.as_ptr()
            },
            state_next: if next.is_empty() {
                null()
            } else {
                next.as_ptr()
            },
            ..self.batch(&pointers, info)
        });
        let states = self.state_next.iter_mut().skip(first).take(count);
        let written = self.out.all().chain(states);
        self.overrun = written.fold(false, |broken, column| broken | overrun(column));
        answer
    }

    /// Returns the batch of these columns, without a law's parameters and internal variables.
    fn batch(&mut self, pointers: &Pointers, info: &StepInfo) -> FwBatch {
        let out = &mut self.out;
        FwBatch {
            size: size_of::<FwBatch>(),
            n: pointers.n,
            dimension: info.dimension,
            reserved: 0,
            time: info.time,
            h: info.h,
            theta: info.theta,
            degradation: 0.0,
            parameters: null(),
            state: null(),
            state_next: null(),
            gap: pointers.input(&self.gap),
            area: pointers.input(&self.area),
            radius: pointers.input(&self.radius),
            age: pointers.input(&self.age),
            opening_n: pointers.input(&self.opening[0]),
            opening_t1: pointers.input(&self.opening[1]),
            opening_t2: pointers.input_3d(&self.opening[2]),
            velocity_n: pointers.input(&self.velocity[0]),
            velocity_t1: pointers.input(&self.velocity[1]),
            velocity_t2: pointers.input_3d(&self.velocity[2]),
            impulse_n: pointers.input(&self.impulse[0]),
            impulse_t1: pointers.input(&self.impulse[1]),
            impulse_t2: pointers.input_3d(&self.impulse[2]),
            damage: pointers.input(&self.damage),
            energy_intact: pointers.input(&self.energy_intact),
            intact_n: pointers.input(&self.intact[0]),
            intact_t1: pointers.input(&self.intact[1]),
            intact_t2: pointers.input_3d(&self.intact[2]),
            slip: pointers.input(&self.slip),
            friction_work: pointers.input(&self.friction_work),
            pressed: pointers.input(&self.compression_time),
            rotation_n: pointers.input_3d(&self.rotation[0]),
            rotation_t1: pointers.input(&self.rotation[1]),
            rotation_t2: pointers.input_3d(&self.rotation[2]),
            intact_moment_n: pointers.input_3d(&self.intact_moment[0]),
            intact_moment_t1: pointers.input(&self.intact_moment[1]),
            intact_moment_t2: pointers.input_3d(&self.intact_moment[2]),
            out_friction: pointers.output(&mut out.friction),
            out_restitution_n: pointers.output(&mut out.restitution_n),
            out_restitution_t: pointers.output(&mut out.restitution_t),
            out_tension_strength: pointers.output(&mut out.tension_strength),
            out_shear_cohesion: pointers.output(&mut out.shear_cohesion),
            out_rolling: pointers.output(&mut out.rolling),
            out_spinning: pointers.output(&mut out.spinning),
            out_traction_n: pointers.output(&mut out.traction[0]),
            out_traction_t1: pointers.output(&mut out.traction[1]),
            out_traction_t2: pointers.output_3d(&mut out.traction[2]),
            out_stiffness_n: pointers.output(&mut out.stiffness_n),
            out_stiffness_t: pointers.output(&mut out.stiffness_t),
            out_damping_n: pointers.output(&mut out.damping_n),
            out_damping_t: pointers.output(&mut out.damping_t),
            out_energy: pointers.output(&mut out.energy),
            out_damage: pointers.output(&mut out.damage),
            out_volume: pointers.output(&mut out.volume),
            out_moment_n: pointers.output_3d(&mut out.moment[0]),
            out_moment_t1: pointers.output(&mut out.moment[1]),
            out_moment_t2: pointers.output_3d(&mut out.moment[2]),
            out_stiffness_twist: pointers.output(&mut out.stiffness_twist),
            out_stiffness_bend: pointers.output(&mut out.stiffness_bend),
            overlap: pointers.input(&self.overlap),
            effective_mass: pointers.input(&self.effective_mass),
            spring_t1: pointers.input(&self.spring[0]),
            spring_t2: pointers.input_3d(&self.spring[1]),
            spring_before_t1: pointers.input(&self.spring_before[0]),
            spring_before_t2: pointers.input_3d(&self.spring_before[1]),
            out_contact_force_n: pointers.output(&mut out.contact_force[0]),
            out_contact_force_t1: pointers.output(&mut out.contact_force[1]),
            out_contact_force_t2: pointers.output_3d(&mut out.contact_force[2]),
            out_contact_stiffness_n: pointers.output(&mut out.contact_stiffness_n),
            out_contact_stiffness_t: pointers.output(&mut out.contact_stiffness_t),
            out_contact_unloading_t: pointers.output(&mut out.contact_unloading_t),
            out_contact_damping_n: pointers.output(&mut out.contact_damping_n),
            out_contact_damping_t: pointers.output(&mut out.contact_damping_t),
            temperature: pointers.input(&self.temperature[0]),
            temperature_candidate: pointers.input(&self.temperature[1]),
            temperature_antagonist: pointers.input(&self.temperature[2]),
            conductivity: pointers.input(&self.conductivity),
            resistivity: pointers.input(&self.resistivity),
            out_conductance: pointers.output(&mut out.conductance),
            out_electric_conductance: pointers.output(&mut out.electric_conductance),
            table: null(),
            table_length: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A call finds its outputs at zero, whatever their values were before; outputs of other calls
    /// are kept.
    #[test]
    fn what_a_call_writes_is_cleared() {
        for kind in Kind::BUILT_IN {
            for call in [Call::Prepare, Call::Commit, Call::Energy] {
                let mut columns = BatchColumns::default();
                (columns.n, columns.overlap, columns.temperature[0]) =
                    (2, vec![0.0; 2], vec![0.0; 2]);
                columns.size_outputs();
                columns.out.all().for_each(|column| column.fill(7.0));
                let sum = |columns: &mut BatchColumns| -> f64 {
                    columns.out.all().flat_map(|column| column.iter()).sum()
                };
                let before = sum(&mut columns);
                columns.clear_outputs(kind, call);
                let written: Vec<f64> = (kind.spec().outputs)(&mut columns.out, call)
                    .iter()
                    .flat_map(|output| output.values.to_vec())
                    .collect();
                assert!(written.iter().all(|x| *x == 0.0), "{kind} {call:?}");
                assert_eq!(sum(&mut columns), before - 7.0 * written.len() as f64);
            }
        }
    }
}
