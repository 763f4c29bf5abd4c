//! A contact law of your own, linked into the program: friction that increases with the sliding
//! speed. A block thrown along a plane stops as a closed form says.
//!
//! ```sh
//! cargo run --release --no-default-features --example own_law
//! ```
//! A law can also be built as a library that cases name: `fretwork law new`, see
//! `docs/write_your_own_law.md`.

use fretwork::laws::{BuiltInLaws, SearchPath};
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{BodySpec, GrainSpec, InterfaceSpec, OnePolyhedron, ShapeSpec};
use fretwork_law::{ContactLaw, Friction, Law, Site, parameters};
use std::ops::ControlFlow;

parameters! {
    /// Friction coefficient mu = mu_0 + c |u_t|.
    pub struct Viscous {
        mu_0: "" = 0.1, 0.0, f64::INFINITY, "friction coefficient at rest";
        c: "s/m" = 0.0, 0.0, f64::INFINITY, "growth with the sliding velocity";
    }
}

impl Law for Viscous {
    const NAME: &'static str = "viscous-friction";
    const DOC: &'static str = "friction that grows with the sliding velocity";
    const REFERENCE: &'static str = "an example";
}

impl ContactLaw for Viscous {
    fn friction(&self, site: &Site, _state: &[f64]) -> Friction {
        let [_, t1, t2] = site.velocity;
        Friction {
            mu: self.mu_0 + self.c * t1.hypot(t2),
            ..Friction::default()
        }
    }
}

fretwork_law::plugin_table!(contact Viscous);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let laws = SearchPath::new(&[]).with_built_in(BuiltInLaws::new([&TABLE]));
    let (g, mu_0, c, v_0) = (9.81, 0.1, 0.2, 1.0);
    let law = [("mu_0", mu_0), ("c", c)];
    let block = OnePolyhedron {
        velocity: vec![v_0, 0.0, 0.0],
        ..OnePolyhedron::cuboid([0.0, 0.0, 0.01], (0.2, 0.2, 0.02))
    };
    let mut simulation = CaseBuilder::in_space("a block thrown along a plane")
        .time(1e-4, 1.0)
        .gravity([0.0, 0.0, -g])
        .own_material("stone", 2600.0, "an example")
        .interface(InterfaceSpec::new(
            "dry",
            ("stone", "stone"),
            "viscous-friction",
            &law,
        ))
        .body(BodySpec::new(
            "floor",
            "stone",
            ShapeSpec::half_space([0.0, 0.0, 1.0], []),
        ))
        .grains(GrainSpec::polyhedra("stone", [block]))
        .build(&laws)?
        .simulation;

    // The closed form solves m dv/dt = -m g (mu_0 + c v) until v = 0.
    let stop = (1.0 + c * v_0 / mu_0).ln() / (g * c);
    let speed = |t: f64| ((v_0 + mu_0 / c) * (-g * c * t).exp() - mu_0 / c).max(0.0);
    let ended = simulation.run_until(1.0, |now, _| {
        let (v, expected) = (now.motion(0).velocity[0], speed(now.time()));
        assert!((v - expected).abs() < 1e-3 * v_0, "{v} at {} s", now.time());
        if v.abs() < 1e-5 {
            return ControlFlow::Break(now.time());
        }
        ControlFlow::Continue(())
    })?;
    let ControlFlow::Break(stood) = ended else {
        return Err("it did not stop".into());
    };
    println!("stopped after {stood:.4} s, closed form {stop:.4} s");
    assert!((stood - stop).abs() < 1e-3);
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
