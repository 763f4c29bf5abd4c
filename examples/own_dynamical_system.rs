//! A dynamical system of your own, which is not a rigid body: a block on a spring stands on a belt.
//! The belt takes it along until the force of the spring reaches the friction bound; then the block
//! oscillates about that position.
//!
//! ```sh
//! cargo run --release --no-default-features --features laws --example own_dynamical_system
//! ```

use fretwork::bodies::{Contactor, ContactorShape, Dof, DynamicalSystem, Nodes, TimeFunction};
use fretwork::bodies::{SystemStep, SystemWork};
use fretwork::geometry::space::{Dim2, Space, VectorLike};
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{BodySpec, InterfaceSpec, ShapeSpec};

type Vector = <Dim2 as Space>::Vector;

/// A mass that moves along x and y without rotating, on a spring along x. Its contactor is a ball.
#[derive(Clone, Debug)]
struct BlockOnSpring {
    mass: f64,
    stiffness: f64,
    radius: f64,
    /// Displacement from the unloaded spring (m) and velocity (m/s), x and y.
    displacement: [f64; 2],
    velocity: [f64; 2],
    /// Displacement and velocity at the start of the step.
    start: [[f64; 2]; 2],
    /// A^-1 = 1/(m + (h theta)^2 k) along x, 1/m along y.
    inverse: [f64; 2],
}

impl BlockOnSpring {
    /// The velocity of the step at which forces work, (1 - theta) v + theta v+.
    fn average(&self, step: &SystemStep<Dim2>) -> [f64; 2] {
        let [_, v] = self.start;
        [0, 1].map(|k| (1.0 - step.theta) * v[k] + step.theta * self.velocity[k])
    }
}

impl DynamicalSystem<Dim2> for BlockOnSpring {
    fn name(&self) -> &str {
        "a block on a spring"
    }

    fn freedoms(&self) -> usize {
        2
    }

    fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    fn set_velocity(&mut self, velocity: &[f64]) {
        self.velocity.copy_from_slice(velocity);
    }

    fn begin_step(&mut self, step: &SystemStep<Dim2>) {
        self.start = [self.displacement, self.velocity];
        let spring = (step.h * step.theta).powi(2) * self.stiffness;
        self.inverse = [1.0 / (self.mass + spring), 1.0 / self.mass];
    }

    fn advance(&mut self, time: f64) {
        for (x, v) in self.displacement.iter_mut().zip(self.velocity) {
            *x += time * v;
        }
    }

    /// Returns v + A^-1 h (F - K (q + h theta v)).
    fn free_velocity(&self, step: &SystemStep<Dim2>) -> Vec<f64> {
        let [q, v] = self.start;
        let spring = -self.stiffness * (q[0] + step.h * step.theta * v[0]);
        let force = [
            spring + self.mass * step.gravity[0],
            self.mass * step.gravity[1],
        ];
        (0..2)
            .map(|k| v[k] + self.inverse[k] * step.h * force[k])
            .collect()
    }

    fn solve(&self, impulse: &mut [f64]) {
        for (p, inverse) in impulse.iter_mut().zip(self.inverse) {
            *p *= inverse;
        }
    }

    /// Returns the work of gravity and the loss of the scheme; the spring is elastic, and there is
    /// no damping.
    fn work(&self, step: &SystemStep<Dim2>) -> SystemWork {
        let average = self.average(step);
        let [_, v] = self.start;
        let change = [0, 1].map(|k| self.velocity[k] - v[k]);
        let scheme = self.mass * (change[0].powi(2) + change[1].powi(2))
            + self.stiffness * (step.h * average[0]).powi(2);
        let along = step.gravity[0] * average[0] + step.gravity[1] * average[1];
        SystemWork {
            potential: -step.h * self.mass * along,
            scheme: (step.theta - 0.5) * scheme,
            ..SystemWork::default()
        }
    }

    fn kinetic_energy(&self) -> f64 {
        0.5 * self.mass * (self.velocity[0].powi(2) + self.velocity[1].powi(2))
    }

    fn stored_energy(&self) -> f64 {
        0.5 * self.stiffness * self.displacement[0].powi(2)
    }

    fn mass(&self) -> f64 {
        self.mass
    }

    // Contacts act on one node, whose velocities are the generalised ones.
    fn node_position(&self, _: u32) -> Vector {
        Vector::from_slice(&[self.displacement[0], self.radius + self.displacement[1]])
    }

    fn node_velocity(&self, _: u32, velocity: &[f64]) -> Vector {
        Vector::from_slice(velocity)
    }

    fn add_impulse(&self, _: u32, impulse: &Vector, generalised: &mut [f64]) {
        generalised[0] += impulse[0];
        generalised[1] += impulse[1];
    }

    fn contactors(&self) -> Vec<Contactor> {
        vec![Contactor {
            nodes: Nodes::one(0),
            radius: self.radius,
            shape: ContactorShape::Ball,
            material: 0, // the first of the case, by name
        }]
    }

    fn save(&self) -> Vec<u8> {
        let numbers = self.displacement.iter().chain(&self.velocity);
        numbers.flat_map(|x| x.to_le_bytes()).collect()
    }

    fn restore(&mut self, saved: &[u8]) -> bool {
        let numbers = saved
            .chunks(8)
            .filter_map(|b| b.try_into().ok().map(f64::from_le_bytes));
        let [x, y, u, v] = numbers.collect::<Vec<f64>>()[..] else {
            return false;
        };
        (self.displacement, self.velocity) = ([x, y], [u, v]);
        true
    }

    fn clone_box(&self) -> Box<dyn DynamicalSystem<Dim2>> {
        Box::new(self.clone())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (g, mu, belt, mass, stiffness) = (10.0, 0.4, 0.1, 2.0, 800.0);
    let laws = fretwork::shipped::search_path();
    let floor = BodySpec::new("belt", "rubber", ShapeSpec::half_space([0.0, 1.0], []));
    let case = CaseBuilder::in_plane("a block on a belt")
        .time(1e-4, 1.0)
        .gravity([0.0, -g])
        .own_material("rubber", 1200.0, "an example")
        .interface(InterfaceSpec::new(
            "dry",
            ("rubber", "rubber"),
            "coulomb",
            &[("mu", mu)],
        ))
        .body(floor.x(Dof::Velocity(TimeFunction::Constant(belt))));
    let mut simulation = case.load()?.build_in::<Dim2>(&laws)?;
    simulation.add_system(Box::new(BlockOnSpring {
        mass,
        stiffness,
        radius: 0.05,
        displacement: [0.0; 2],
        velocity: [belt, 0.0], // at rest on the belt
        start: [[0.0; 2]; 2],
        inverse: [0.0; 2],
    }));

    // The block sticks until x = mu m g/k and starts to slide with the velocity v of the belt: x =
    // mu m g/k + v/w sin(w t), w = sqrt(k/m).
    let hold = mu * mass * g / stiffness;
    let omega = (stiffness / mass).sqrt();
    let mut furthest: f64 = 0.0;
    while simulation.state.time < hold / belt + 2.0 / omega {
        simulation.step()?;
        let (t, stored) = (simulation.state.time, simulation.energies().elastic);
        let x = (2.0 * stored / stiffness).sqrt();
        let expected = match t - hold / belt {
            before if before < 0.0 => belt * t,
            after => hold + belt / omega * (omega * after).sin(),
        };
        assert!((x - expected).abs() < 2e-3 * hold, "{x} m at {t} s");
        furthest = furthest.max(x);
    }
    println!("held to {hold:.4} m, swung to {furthest:.5} m");
    assert!((furthest - hold - belt / omega).abs() < 1e-4 * furthest);

    let energy = simulation.energies();
    assert!(energy.friction > 0.0 && energy.residual.abs() < 1e-9 * energy.scale);
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
