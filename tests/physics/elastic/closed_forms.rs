//! Uniform large strain of the neo-Hookean material (J. Bonet and R. D. Wood, "Nonlinear Continuum
//! Mechanics for Finite Element Analysis", 2nd edition, section 6.4.3): the first Piola-Kirchhoff
//! stress P = mu (F - F^-T) + lambda ln J F^-T, and Cauchy's sigma = P F^T/J.

use super::*;
use crate::extremes::bench::floor;
use fretwork::geometry::space::Dim3;

const SIDE: f64 = 0.01;

fn hyperelastic<S: Space>(mesh: Mesh<S>, supports: &[Support]) -> BodySpec<'_, Mesh<S>> {
    let mut spec = body(mesh, RUBBER, supports);
    spec.strain = Strain::NeoHookean;
    spec
}

/// Stress P along a stretched axis at a volume ratio.
fn nominal(stretch: f64, volume: f64) -> f64 {
    let (l, g) = (RUBBER.lambda(), RUBBER.shear());
    g * (stretch - 1.0 / stretch) + l * volume.ln() / stretch
}

/// Lateral stretch at which the lateral stress P vanishes, for one direction (the other is held) or
/// for two equal ones.
fn across(stretch: f64, directions: i32) -> f64 {
    let (mut low, mut high) = (0.2f64, 5.0f64);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if nominal(middle, stretch * middle.powi(directions)) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}

/// A part that does not move along an axis.
fn fixed<S: Space>(part: &str, axis: usize) -> Support {
    let mut axes = vec![None; S::D];
    axes[axis] = Some(Dof::Fixed);
    support(part, &axes)
}

fn cube<S: Space>(cells: usize) -> Mesh<S> {
    let line = |from: f64| even(from, from + SIDE, cells);
    let lines = [line(0.0), line(0.0), line(0.0)];
    block::<S>(&lines[..S::D]).unwrap()
}

/// Force of the upper holder (N; N/m) at rest after a displacement by a fraction of the height,
/// with sides that are held or free.
fn squeezed<S: Space>(share: f64, confined: bool) -> f64 {
    let mut s = scene::<S>(&Sketch {
        bodies: floor::<S>().replace(
            "shapes:",
            if S::D == 2 {
                "position: [0.0, -1.0], shapes:"
            } else {
                "position: [0.0, 0.0, -1.0], shapes:"
            },
        ),
        ..sketch(1.0, 1.0)
    });
    let up = S::D - 1;
    let mut driven = vec![None; S::D];
    driven[up] = ramp(share * SIDE, 10.0);
    let mut supports = vec![
        fixed::<S>("bottom", up),
        support("top", &driven),
        fixed::<S>("left", 0),
    ];
    if S::D == 3 {
        supports.push(fixed::<S>("front", 1));
    }
    if confined {
        supports.push(fixed::<S>("right", 0));
        if S::D == 3 {
            supports.push(fixed::<S>("back", 1));
        }
    }
    add(&mut s, hyperelastic(cube::<S>(2), &supports));
    go(&mut s, 14);
    closes(&s, 1e-9);
    holder(&s, 0, "top", up).force
}

fn follows_the_closed_form<S: Space>() {
    let directions = S::D as i32 - 1;
    for share in [-0.5, -0.3, 0.3, 0.5] {
        let stretch = 1.0 + share;
        let area = SIDE.powi(directions);
        near(
            nominal(stretch, stretch) * area,
            squeezed::<S>(share, true),
            1e-6,
        );
        let volume = stretch * across(stretch, directions).powi(directions);
        near(
            nominal(stretch, volume) * area,
            squeezed::<S>(share, false),
            1e-6,
        );
    }
}

#[test]
fn compression_and_extension() {
    follows_the_closed_form::<Dim2>();
    follows_the_closed_form::<Dim3>();
}

/// Simple shear by gamma has P_xy = mu gamma, sigma_xy = mu gamma, sigma_xx = mu gamma^2, and no
/// force along y.
#[test]
fn simple_shear() {
    let gamma = 0.5;
    let mut s = scene::<Dim2>(&Sketch {
        bodies: floor::<Dim2>().replace("shapes:", "position: [0.0, -1.0], shapes:"),
        ..sketch(1.0, 1.0)
    });
    let supports = [
        support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
        support("top", &[ramp(gamma * SIDE, 10.0), Some(Dof::Fixed)]),
    ];
    // With one cell no side can bulge.
    add(&mut s, hyperelastic(cube::<Dim2>(1), &supports));
    go(&mut s, 14);
    closes(&s, 1e-9);
    let g = RUBBER.shear();
    near(g * gamma * SIDE, holder(&s, 0, "top", 0).force, 1e-6);
    assert!(holder(&s, 0, "top", 1).force.abs() < 1e-6 * g * gamma * SIDE);
    for [xx, yy, zz, _, _, xy] in mesh(&s, 0).stress {
        near(g * gamma * gamma, xx, 1e-6);
        near(g * gamma, xy, 1e-6);
        assert!(yy.abs().max(zz.abs()) < 1e-6 * g);
    }
}

/// A smooth rigid lid presses a block with free sides by a fifth: the sum of its contact forces is
/// that of uniaxial strain.
#[test]
fn a_block_under_a_lid() {
    under_a_lid::<Dim2>();
    under_a_lid::<Dim3>();
}

fn under_a_lid<S: Space>() {
    let (up, directions, stretch) = (S::D - 1, S::D as i32 - 1, 0.8);
    let [normal, position, axis] = match S::D {
        2 => [
            "[0.0, -1.0]".to_owned(),
            format!("[0.0, {SIDE:?}]"),
            "y".to_owned(),
        ],
        _ => [
            "[0.0, 0.0, -1.0]".to_owned(),
            format!("[0.0, 0.0, {SIDE:?}]"),
            "z".to_owned(),
        ],
    };
    let drop = (stretch - 1.0) * SIDE;
    let forces = [false, false, true].map(|parallel| {
        let mut s = scene::<S>(&Sketch {
            bodies: format!(
                "(name: \"lid\", material: \"m0\", shapes: [HalfSpace(normal: {normal})], position: {position}, \
                 dofs: ({axis}: Displacement(Ramp(from: 0.0, to: {drop:?}, start: 0.0, end: 10.0)))),"
            ),
            mu: 0.0,
            solver: "tolerance: 1e-12, norm: Velocity, method: Newton,".to_owned(),
            ..sketch(1.0, 1.0)
        });
        s.options.solver.parallel = parallel;
        let mut supports = vec![fixed::<S>("bottom", up), fixed::<S>("left", 0)];
        if S::D == 3 {
            supports.push(fixed::<S>("front", 1));
        }
        let mut spec = hyperelastic(cube::<S>(if S::D == 2 { 4 } else { 2 }), &supports);
        spec.touching = Touching::Points("top");
        add(&mut s, spec);
        let mut most = 0;
        for _ in 0..14 {
            go(&mut s, 1);
            most = most.max(s.state.systems.get(0).unwrap().linearisations());
        }
        closes(&s, 1e-9);
        let contacts = s.state.network.contacts.iter();
        let force = contacts.map(|c| c.impulse[up].abs()).sum::<f64>() / s.options.scheme.h;
        let volume = stretch * across(stretch, directions).powi(directions);
        let expected = -nominal(stretch, volume) * SIDE.powi(directions);
        println!("lid in {}D: {force} for {expected}, up to {most} iterations", S::D);
        near(expected, force, 1e-6);
        near(expected, holder(&s, 0, "bottom", up).force, 1e-6);
        force.to_bits()
    });
    // Results are bit-identical, also with two threads.
    assert!(forces.iter().all(|f| *f == forces[0]));
}

/// All measures of strain agree as the load vanishes: the difference decreases with the load, for a
/// stubby cantilever in shear and compression.
#[test]
fn small_loads_are_linear() {
    let moved = |strain: Strain, load: f64| {
        let mut s = scene::<Dim2>(&Sketch {
            bodies: floor::<Dim2>().replace("shapes:", "position: [0.0, -1.0], shapes:"),
            ..sketch(1.0, 1.0)
        });
        let force = |f: f64| Some(Dof::Force(TimeFunction::Constant(f * RUBBER.young * SIDE)));
        let supports = [
            support("bottom", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
            support("top", &[force(load), force(-2.0 * load)]),
        ];
        let mut spec = body(cube::<Dim2>(3), RUBBER, &supports);
        spec.strain = strain;
        add(&mut s, spec);
        go(&mut s, 8);
        [0, 1].map(|axis| holder(&s, 0, "top", axis).displacement)
    };
    for strain in LARGE {
        let off = [1e-2, 1e-3, 1e-4].map(|load| {
            let [small, large] = [Strain::Small, strain].map(|which| moved(which, load));
            (large[0] / small[0] - 1.0)
                .abs()
                .max((large[1] / small[1] - 1.0).abs())
        });
        let orders = [off[0] / off[1], off[1] / off[2]].map(f64::log10);
        println!("{strain:?}: off by {off:?}, orders {orders:?}");
        assert!(off[2] < 2e-3 && orders.iter().all(|o| *o > 0.9), "{off:?}");
    }
}
