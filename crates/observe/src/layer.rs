//! Energy balance of the bodies between the driven bodies, from contact forces and the paths of the
//! driven bodies.
//!
//! The driven bodies do the work -sum (h p . v_theta + moment . w_theta) on the rest through their
//! contacts: it is dissipated in contacts or stored by the other bodies. The ledger's external work
//! is not used here, so the two balances check each other.

use fretwork_core::process::sliding::{SlidingBody, SlidingPart};
use fretwork_core::view::RunView;
use nalgebra::Vector3;
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

/// Sliding of the rubbed body in a step.
#[derive(Clone, Copy, Debug)]
pub struct Rubbing<'a> {
    /// The rubbed body.
    pub body: &'a SlidingBody,
    /// Work of sliding over the step (J; J/m in 2D).
    pub work: f64,
}

/// Observer of the balance.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LayerBalance {
    /// Velocities of the driven bodies at the end of the last processed step.
    velocity: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// Potential energy, and dissipation by the scheme, of the driven bodies, which the ledger
    /// includes.
    apart: f64,
    other: f64,
    /// External work in the ledger at the end of the last processed step.
    external: f64,
}

impl LayerBalance {
    /// Starts from the current state.
    pub fn new(run: &dyn RunView) -> Self {
        Self {
            velocity: velocities(run),
            apart: 0.0,
            other: 0.0,
            external: run.energies().external_work,
        }
    }

    /// Adds the last step; the work of sliding of a friction test is kept separately. Where the
    /// rubbed body deforms, the work of all other drives is that of the ledger.
    pub fn follow(&mut self, run: &dyn RunView, test: Option<Rubbing<'_>>) {
        let external = run.energies().external_work;
        let deforms = test.filter(|t| matches!(t.body.part, SlidingPart::System { .. }));
        if deforms.is_some() {
            self.other += external - self.external;
        }
        self.other -= test.map_or(0.0, |t| t.work);
        self.external = external;
        let (h, theta) = (run.options().scheme.h, run.options().scheme.theta);
        let now = velocities(run);
        let (bodies, gravity) = (run.bodies(), Vector3::from(run.gravity()));
        let steps = run.started().into_iter().zip(&now).zip(run.received());
        for (d, ((started, (v1, w1)), received)) in steps.enumerate() {
            let [v0, w0] = started.map(Vector3::from);
            let [impulse, moment] = received.map(Vector3::from);
            let b = bodies.driven[d].body as usize;
            let (v, w) = (
                v0 * (1.0 - theta) + *v1 * theta,
                w0 * (1.0 - theta) + *w1 * theta,
            );
            if deforms.is_none() {
                self.other -= impulse.dot(&v) + moment.dot(&w);
            }
            let (dv, dw) = (*v1 - v0, *w1 - w0);
            self.apart -= h * bodies.mass[b] * gravity.dot(&v);
            self.apart += (theta - 0.5)
                * (bodies.mass[b] * dv.dot(&dv) + dw.dot(&angular_momentum(run, b, &dw)));
        }
        self.velocity = now;
    }

    /// The balance at the end of the last processed step.
    pub fn balance(&self, run: &dyn RunView) -> Balance {
        let (e, bodies) = (run.energies(), run.bodies());
        let driven = bodies.driven.iter().zip(&self.velocity);
        let kinetic: f64 = driven
            .map(|(driven, (v, w))| {
                let b = driven.body as usize;
                0.5 * (bodies.mass[b] * v.dot(v) + w.dot(&angular_momentum(run, b, w)))
            })
            .sum();
        let kept = e.kinetic - kinetic + e.potential + e.elastic + e.carried;
        Balance {
            // Work of the projection against loads does not pass through a contact.
            taken: e.dissipated() + e.scheme + kept + run.projection_work() - self.apart,
            other: self.other,
        }
    }
}

fn velocities(run: &dyn RunView) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let bodies = run.bodies();
    let of = |body: usize| (bodies.velocity.at(body).into(), bodies.spin.at(body).into());
    let driven = bodies.driven.iter();
    driven.map(|d| of(d.body as usize)).collect()
}

fn angular_momentum(run: &dyn RunView, body: usize, spin: &Vector3<f64>) -> Vector3<f64> {
    run.angular_momentum(body, (*spin).into()).into()
}
