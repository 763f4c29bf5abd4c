//! A ball on the middle of a facet: its force is distributed to the corners of the facet, in small
//! and in large strain, from below and from above.

use super::*;

const RUBBER: Elasticity = Elasticity {
    young: 2e6,
    poisson: 0.4,
    density: 1000.0,
};

/// Normal force of a ball that is moved 10 um into a block, and the load that the block's far side
/// carries (N/m).
fn force(strain: Strain, above: bool) -> f64 {
    let (side, depth, radius) = (0.01, 1e-5, 3e-3);
    let sign = if above { 1.0 } else { -1.0 };
    let ball = format!(
        "(name: \"ball\", material: \"m0\", shapes: [Balls([([0.0, 0.0], {radius:?})])], position: [3e-4, {:?}], \
         dofs: (x: Fixed, y: Displacement(Ramp(from: 0.0, to: {:?}, start: 0.0, end: 10.0)), rz: Fixed)),",
        sign * radius,
        -sign * depth
    );
    let mut s = scene::<Dim2>(&Sketch {
        bodies: ball,
        mu: 0.3,
        ..sketch(1.0, 1.0)
    });
    let height = if above { [-side, 0.0] } else { [0.0, side] };
    let mesh = [even(-side, side, 8), even(height[0], height[1], 4)];
    let (held, touches) = if above {
        ("bottom", "top")
    } else {
        ("top", "bottom")
    };
    let held_part = [support(held, &[Some(Dof::Fixed), Some(Dof::Fixed)])];
    let mut spec = body(block::<Dim2>(&mesh).unwrap(), RUBBER, &held_part);
    (spec.strain, spec.touching) = (strain, Touching::Surface(touches));
    add(&mut s, spec);
    go(&mut s, 12);
    closes(&s, 1e-8);
    let contacts = s.state.network.contacts.iter();
    let pressed = contacts.map(|c| c.impulse[1].abs()).sum::<f64>();
    near(pressed, holder(&s, 0, held, 1).force.abs(), 1e-6);
    pressed
}

#[test]
fn a_ball_on_a_facet() {
    let small = force(Strain::Small, true);
    assert!(small > 0.0);
    for strain in [Strain::Small, Strain::Corotational, Strain::NeoHookean] {
        let [up, down] = [true, false].map(|above| force(strain, above));
        println!("{strain:?}: {up} and {down} N/m, {small} in small strain");
        near(up, down, 1e-6);
        near(small, up, 0.02);
    }
}
