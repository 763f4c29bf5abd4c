//! Processes in a scene that is stepped by hand: their state between steps is saved with the
//! simulation and complete at the end, and bodies that their impulses send through others are
//! reported.

use fretwork::geometry::space::{Dim2, Space};
use fretwork::process::{Process, ProcessError};
use fretwork::record::encoding::{EncodingError, decode, encode};
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{GrainSpec, InterfaceSpec, OneGrain};
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use nalgebra::Vector2;

/// Counts the states between steps.
#[derive(Debug, Default)]
struct Counter(u64);

impl<S: Space> Process<S> for Counter {
    fn name(&self) -> &str {
        "counter"
    }

    fn between_steps(&mut self, _: &mut Simulation<S>) -> Result<(), ProcessError> {
        self.0 += 1;
        Ok(())
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.0)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.0 = decode(from)?;
        Ok(())
    }
}

/// Throws the first grain at the second once.
#[derive(Debug)]
struct Throw(f64);

impl Process<Dim2> for Throw {
    fn name(&self) -> &str {
        "throw"
    }

    fn before_detection(&mut self, s: &mut Simulation<Dim2>) -> Result<(), ProcessError> {
        let impulse = Vector2::new(s.state.bodies.mass[0] * std::mem::take(&mut self.0), 0.0);
        if impulse.x != 0.0 {
            s.apply_impulse(0, &impulse, &Default::default());
        }
        Ok(())
    }
}

fn two_grains() -> Simulation<Dim2> {
    let grains = [
        OneGrain::new([0.0, 0.0], 0.01),
        OneGrain::new([0.05, 0.0], 0.01),
    ];
    let built = CaseBuilder::in_plane("two grains")
        .time(1e-3, 1.0)
        .own_material("glass", 2500.0, "an example")
        .interface(InterfaceSpec::new(
            "dry",
            ("glass", "glass"),
            "coulomb",
            &[],
        ))
        .grains(GrainSpec::balls("glass", grains))
        .load()
        .and_then(|case| case.build_in(&search_path()));
    built.unwrap_or_else(|e| panic!("{e}"))
}

fn count(s: &Simulation<Dim2>) -> u64 {
    s.process::<Counter>().expect("the counter").0
}

/// A state that is saved directly after a step continues with what is due between steps; the
/// process also receives the last state.
#[test]
fn what_is_due_between_steps_is_not_lost() {
    let mut s = two_grains();
    s.add_process(Counter::default());
    for _ in 0..3 {
        s.step().unwrap();
    }
    // The third state is seen by the next step, or at the end.
    assert_eq!(count(&s), 2);
    let mut resumed = two_grains();
    resumed.add_process(Counter::default());
    assert!(resumed.restore(s.state.clone()));
    resumed
        .restore_processes(&s.save_processes().unwrap())
        .unwrap();
    for s in [&mut s, &mut resumed] {
        s.step().unwrap();
        s.end().unwrap();
        assert_eq!(count(s), 4);
        s.end().unwrap();
        assert_eq!(count(s), 4);
    }
}

/// An impulse that sends a grain through another in the half step before detection is reported; an
/// impulse that does not is not.
#[test]
fn an_impulse_that_sends_a_grain_through_another_is_reported() {
    for (speed, reported) in [(0.5, false), (160.0, true)] {
        let mut s = two_grains();
        s.add_process(Throw(speed));
        s.step().unwrap();
        let passed = s.state.network.step_size.passed;
        assert_eq!(passed > 0, reported, "{speed} m/s: {passed}");
    }
}
