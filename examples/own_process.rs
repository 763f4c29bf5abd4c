//! A process of your own: the drag of a fluid on all grains, at the point of each step at which
//! forces act. A ball falls towards its terminal velocity, which is compared with a closed form.
//!
//! ```sh
//! cargo run --release --no-default-features --example own_process
//! ```

use fretwork::geometry::space::{Dim3, Space, VectorLike};
use fretwork::laws::SearchPath;
use fretwork::process::{Process, ProcessError};
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{GrainSpec, OneGrain};
use fretwork::step::Simulation;

/// The drag -c v on each grain.
#[derive(Debug)]
struct Drag {
    /// The drag coefficient c (N s/m).
    coefficient: f64,
}

impl<S: Space> Process<S> for Drag {
    fn name(&self) -> &str {
        "drag"
    }

    fn before_detection(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        // The mean of the velocities before and after a step gives the drag to second order: with b
        // = h c/(2 m) the impulse of the step is -h c v/(1 + b), before gravity acts.
        for body in s.state.bodies.grains() {
            let b = 0.5 * s.options.scheme.h * self.coefficient / s.state.bodies.mass[body];
            let free = s.state.bodies.velocity[body] + s.state.gravity * (0.5 * s.options.scheme.h);
            let impulse = free * (-s.options.scheme.h * self.coefficient / (1.0 + b));
            // The work of the impulse goes into the energy ledger as work from outside.
            s.apply_impulse(body, &impulse, &S::Spin::zero());
        }
        Ok(())
    }

    /// The process has no state, so a run with it may repeat steps to estimate its error.
    fn repeats(&self) -> bool {
        true
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (g, c, radius) = (9.81, 0.02, 0.005);
    let case = CaseBuilder::in_space("a ball in oil")
        .time(1e-3, 0.5)
        .gravity([0.0, 0.0, -g])
        .own_material("steel", 7800.0, "an example")
        .grains(GrainSpec::balls("steel", [OneGrain::new([0.0; 3], radius)]));
    // Processes act on the simulation of one dimension, whose data are public.
    let mut simulation = case.load()?.build_in::<Dim3>(&SearchPath::new(&[]))?;
    simulation.add_process(Drag { coefficient: c });

    // The closed form is v = (m g/c) (1 - exp(-c t/m)).
    let mass = simulation.state.bodies.mass[0];
    for _ in 0..500 {
        simulation.step()?;
        let expected = mass * g / c * (1.0 - (-c * simulation.state.time / mass).exp());
        assert!((-simulation.velocities()[0].z - expected).abs() < 1e-5 * expected);
    }
    let (v, terminal) = (-simulation.velocities()[0].z, mass * g / c);
    println!("{v:.4} m/s of a terminal velocity of {terminal:.4} m/s");
    let energy = simulation.energies();
    assert!(energy.external_work < 0.0 && energy.residual.abs() < 1e-9 * energy.scale);
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
