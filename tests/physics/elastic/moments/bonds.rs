//! A grain on a parallel bond, which resists bending and twist: stiff ground gives the results of
//! rigid ground.

use super::*;
use fretwork::geometry::space::Dim3;

/// Stiffness of the bonds (Pa/m).
const K: f64 = 1e9;

/// Acceleration along the ground (m/s^2).
const PULL: f64 = 1e-2;

/// A grain bonded to the body below it.
fn bonded<S: Space>(step: f64, theta: f64, twist: f64, place: &[f64]) -> Rolling {
    let mut at = place.to_vec();
    at[S::D - 1] = R;
    let mut spin = vec![0.0; S::Spin::N];
    spin[S::Spin::N - 1] = twist;
    Rolling {
        step,
        theta,
        mu: 0.0,
        contact: "coulomb",
        interface: "cohesion: \"parallel-bond\", bonds: Start, area_factor: 0.1,",
        parameters: format!(
            ", cohesion: {{\"k_n\": {K:?}, \"k_t\": {K:?}, \"sigma_c\": 1e20, \"tau_c\": 1e20}}"
        ),
        grains: grain(&at, &vec![0.0; S::D], &spin),
        tolerance: 1e-11,
        ..Rolling::default()
    }
}

/// Radius of the bond (m), its area and its moments of inertia in bending and in torsion.
pub fn section<S: Space>(s: &Simulation<S>) -> [f64; 4] {
    let network = &s.state.network;
    let bonds = network.contacts.iter().filter_map(|c| network.bond(c));
    let areas: Vec<f64> = bonds.map(|b| b.area).collect();
    let [area] = areas[..] else {
        panic!("one bond: {areas:?}")
    };
    let pi = std::f64::consts::PI;
    match S::D {
        2 => [0.5 * area, area, area.powi(3) / 12.0, 0.0],
        _ => {
            let bend = area * area / (4.0 * pi);
            [(area / pi).sqrt(), area, bend, 2.0 * bend]
        }
    }
}

/// Rotation of a grain at rest whose weight pulls along the ground, with steps far longer than its
/// period (rad): about -z in 2D, about y in 3D.
fn bent<S: Space>(ground: Ground, young: f64) -> (f64, f64) {
    // The grain is away from the sides of facets: a contact with the next facet has no bond.
    let mut s = ground.under::<S>(
        &bonded::<S>(1.0, 1.0, 0.0, &[1e-3, 2e-3, 0.0][..S::D]),
        young,
    );
    s.state.gravity = S::Vector::zero();
    s.state.gravity[0] = PULL;
    let mut turned = 0.0;
    for _ in 0..12 {
        go(&mut s, 1);
        let spin = spin(&s);
        turned += if S::D == 2 { -spin[0] } else { spin[1] };
    }
    closes(&s, 1e-8);
    let weight = s.state.bodies.mass[ball(&s)] * PULL;
    let [_, _, bending, _] = section(&s);
    (turned, weight * R / (K * bending))
}

fn bends<S: Space>(grounds: &[Ground]) {
    let (rigid, expected) = bent::<S>(Ground::Rigid, 1.0);
    println!("{}D, rigid: {rigid:e} of {expected:e} rad", S::D);
    near(expected, rigid, 1e-6);
    for ground in grounds {
        let off = [1e7, 1e9].map(|young| {
            let (turned, _) = bent::<S>(*ground, young);
            let off = turned / rigid - 1.0;
            println!("{}D {ground:?}, {young:e} Pa: off by {off:e}", S::D);
            off
        });
        // Softer ground rotates further, by an angle that decreases with its modulus.
        assert!(off[1] > 0.0 && off[1] < 1e-4, "{off:?}");
        near(100.0 * off[1], off[0], 0.02);
    }
}

#[test]
fn a_bond_bends_a_grain_as_on_rigid_ground() {
    bends::<Dim2>(&[
        BLOCK,
        Ground::Block(Strain::NeoHookean, 16, Touching::Surface("top")),
        Ground::Block(Strain::Corotational, 16, Touching::Surface("top")),
    ]);
    bends::<Dim3>(&[Ground::Block(Strain::Small, 4, Touching::Surface("top"))]);
}

/// A sphere oscillates about the normal, with w^2 = k_t J/I, by the theta scheme, as on rigid
/// ground.
#[test]
fn a_bond_twists_a_sphere_as_on_rigid_ground() {
    for ground in [
        Ground::Rigid,
        Ground::Block(Strain::Small, 8, Touching::Surface("top")),
        Ground::Block(Strain::Small, 8, Touching::Points("top")),
        Ground::HalfSpace(8, Cells::Surface),
        // The middle of a cell is below the sphere.
        Ground::HalfSpace(9, Cells::Points),
    ] {
        let (theta, start) = (0.6, 0.1);
        let mut s = ground.under::<Dim3>(&bonded::<Dim3>(1e-5, theta, start, &[0.0; 3]), 1e13);
        s.state.gravity = nalgebra::Vector3::zeros();
        go(&mut s, 1);
        let h = s.options.scheme.h;
        let [_, _, _, torsion] = section(&s);
        let squared = K * torsion / (0.4 * s.state.bodies.mass[ball(&s)] * R * R);
        let (mut angle, mut expected, mut off) = (0.0, start, 0.0f64);
        for k in 0..400 {
            if k > 0 {
                go(&mut s, 1);
            }
            let before = expected;
            let length = h * theta;
            expected -= h * squared * (angle + length * before) / (1.0 + length * length * squared);
            angle += h * ((1.0 - theta) * before + theta * expected);
            off = off.max((spin(&s)[2] - expected).abs());
        }
        println!(
            "{ground:?}: {:e} rad a step, spin off by {:e}",
            squared.sqrt() * h,
            off / start
        );
        assert!(off < 1e-6 * start);
        closes(&s, 1e-9);
    }
}

/// A grain bonded over a vertex is pulled onto the next facet, where the bond continues.
#[test]
fn a_bond_goes_on_at_the_next_facet() {
    for pull in [PULL, -PULL] {
        let mut s = BLOCK.under::<Dim2>(&bonded::<Dim2>(1.0, 1.0, 0.0, &[0.0, 0.0]), 1e9);
        s.state.gravity = nalgebra::Vector2::new(pull, 0.0);
        let mut turned = 0.0;
        for _ in 0..12 {
            go(&mut s, 1);
            turned -= spin(&s)[0];
        }
        let [_, _, bending, _] = section(&s);
        let expected = s.state.bodies.mass[ball(&s)] * pull * R / (K * bending);
        println!("turned by {turned:e} of {expected:e} rad");
        near(expected, turned, 1e-3);
        assert_eq!(s.state.network.bonds_broken(), 0);
        closes(&s, 1e-8);
    }
}
