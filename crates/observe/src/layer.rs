//! Energy balance of the bodies between the driven bodies, from contact forces and the paths of the
//! driven bodies.
//!
//! The driven bodies do the work -sum (h p . v_theta + moment . w_theta) on the rest through their
//! contacts: it is dissipated in contacts or stored by the other bodies. The ledger's external work
//! is not used here, so the two balances check each other.

use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::process::cycle::{SlidingBody, SlidingPart};
use fretwork_core::step::Simulation;
use serde::{Deserialize, Serialize};

/// Energies since the start (J; J/m in 2D).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Energy dissipated in all contacts, and stored (kinetic, potential, elastic) by bodies that
    /// are not driven.
    pub taken: f64,
    /// Work of the driven bodies on their contacts, except the tangential drive of the test.
    pub other: f64,
}

/// Observer of the balance.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Layer<S: Space> {
    /// Velocities of the driven bodies at the end of the last processed step.
    velocity: Vec<(S::Vector, S::Spin)>,
    /// Potential energy, and dissipation by the scheme, of the driven bodies, which the ledger
    /// includes.
    apart: f64,
    other: f64,
    /// External work in the ledger at the end of the last processed step.
    external: f64,
}

impl<S: Space> Layer<S> {
    /// Starts from the current state.
    pub fn new(s: &Simulation<S>) -> Self {
        Self {
            velocity: velocities(s),
            apart: 0.0,
            other: 0.0,
            external: s.state.energy.external_work,
        }
    }

    /// Takes in the last step. Of a test its body and the work of its drive (J; J/m) are given,
    /// which is kept apart. Where the body of the test deforms, the work of all other drives is
    /// that of the ledger.
    pub fn follow(&mut self, s: &Simulation<S>, test: Option<(&SlidingBody, f64)>) {
        let external = s.state.energy.external_work;
        let deforms = test.filter(|(body, _)| matches!(body.part, SlidingPart::System { .. }));
        if let Some((_, work)) = deforms {
            self.other += external - self.external - work;
        }
        self.external = external;
        let (h, theta) = (s.options.scheme.h, s.options.scheme.theta);
        let now = velocities(s);
        let steps = s.state.started.iter().zip(&now).zip(&s.state.received);
        for (d, (((v0, w0), (v1, w1)), (impulse, moment))) in steps.enumerate() {
            let b = s.state.bodies.driven[d].body as usize;
            let (v, w) = (
                *v0 * (1.0 - theta) + *v1 * theta,
                *w0 * (1.0 - theta) + *w1 * theta,
            );
            if deforms.is_none() {
                self.other -= impulse.dot(&v) + moment.dot(&w);
            }
            if let Some((body, _)) = test.filter(|(body, _)| body.part == SlidingPart::Driven(d)) {
                self.other += impulse[body.along] * v[body.along];
            }
            let (dv, dw) = (*v1 - *v0, *w1 - *w0);
            self.apart -= h * s.state.bodies.mass[b] * s.state.gravity.dot(&v);
            self.apart += (theta - 0.5)
                * (s.state.bodies.mass[b] * dv.dot(&dv)
                    + dw.dot(&s.state.bodies.angular_momentum(b, &dw)));
        }
        self.velocity = now;
    }

    /// The balance at the end of the last processed step.
    pub fn balance(&self, s: &Simulation<S>) -> Balance {
        let e = &s.state.energy;
        let driven = s.state.bodies.driven.iter().zip(&self.velocity);
        let kinetic: f64 = driven
            .map(|(driven, (v, w))| {
                let b = driven.body as usize;
                0.5 * (s.state.bodies.mass[b] * v.dot(v)
                    + w.dot(&s.state.bodies.angular_momentum(b, w)))
            })
            .sum();
        let kept = e.kinetic - kinetic + e.potential + e.elastic + e.carried;
        Balance {
            // Work of the projection against loads does not pass through a contact.
            taken: e.dissipated() + e.scheme + kept + s.state.projection_work - self.apart,
            other: self.other,
        }
    }
}

fn velocities<S: Space>(s: &Simulation<S>) -> Vec<(S::Vector, S::Spin)> {
    let of = |body: u32| {
        (
            s.state.bodies.velocity[body as usize],
            s.state.bodies.spin[body as usize],
        )
    };
    s.state.bodies.driven.iter().map(|d| of(d.body)).collect()
}
