//! A quarter of an elastic sphere on a quarter of an elastic block of equal material, by their
//! meshes: Hertz's point contact (Johnson, "Contact Mechanics", section 4.2), a^3 = 3 P R/(4 E*),
//! p(r) = p0 sqrt(1 - r^2/a^2) with p0 = 3 P/(2 pi a^2).

use super::*;
use fretwork_observe::tractions::SurfaceState;
use nalgebra::Vector3;

const RADIUS: f64 = 0.05;
const A: f64 = 1e-3;
const FAR: f64 = 16.0 * A;
const STEP: f64 = 1e-3;

/// Coordinates along the contact and away from it, with `n` elements over the half-width.
fn coordinates(n: usize) -> [Vec<f64>; 2] {
    let size = A / n as f64;
    let middle = even(0.0, 1.25 * A, (5 * n).div_ceil(4));
    let outside = graded(1.25 * A, FAR, size, 1.5);
    let along = middle.into_iter().chain(outside.into_iter().skip(1));
    [along.collect(), graded(0.0, FAR, size, 1.4)]
}

/// Half-width from the second moment of the pressure, 2 P a^2/5, relative to Hertz's, and root mean
/// square difference of the pressure on facets within 0.8 a relative to p0, on the sphere and on
/// the block.
fn pressed(block_cells: usize, sphere_cells: usize) -> [f64; 3] {
    let modulus = 0.5 * STEEL.plane_strain();
    let load = 4.0 * modulus * A.powi(3) / (3.0 * RADIUS);
    let mut s = scene::<Dim3>(&Sketch {
        bodies: crate::extremes::bench::plane::<Dim3>("far", 0.0, 0.0, 1.0)
            .replace("shapes:", "position: [0.0, 0.0, -1.0], shapes:"),
        mu: 0.0,
        solver: "tolerance: 1e-10, norm: Velocity, method: Newton,".to_owned(),
        ..sketch(STEP, 1.0)
    });
    let walls = |part: &str, drive: Dof| {
        let fixed = || Some(Dof::Fixed);
        [
            support("left", &[fixed(), None, None]),
            support("front", &[None, fixed(), None]),
            support(part, &[None, None, Some(drive)]),
        ]
    };
    let [x, mut z] = coordinates(block_cells);
    z.iter_mut().for_each(|z| *z = -*z);
    z.reverse();
    let held = walls("bottom", Dof::Fixed);
    let mut spec = body(block::<Dim3>(&[x.clone(), x, z]).unwrap(), STEEL, &held);
    spec.touching = Touching::Surface("top");
    add(&mut s, spec);
    let [x, z] = coordinates(sphere_cells);
    let round = |p: &Vector3<f64>| {
        let squared = p.x * p.x + p.y * p.y;
        let rise = RADIUS - (RADIUS * RADIUS - squared).sqrt();
        Vector3::new(p.x, p.y, p.z + rise * (1.0 - p.z / FAR))
    };
    let mesh = mapped_block::<Dim3>(&[x.clone(), x, z], round).unwrap();
    let down = TimeFunction::Ramp {
        from: 0.0,
        to: -0.25 * load,
        start: 0.0,
        end: 2.0 * STEP,
    };
    let held = walls("top", Dof::Force(down));
    let mut spec = body(mesh, STEEL, &held);
    (spec.name, spec.touching) = ("sphere", Touching::Points("bottom"));
    add(&mut s, spec);
    go(&mut s, 4);
    closes(&s, 1e-9);
    let (mut total, mut moment) = (0.0, 0.0);
    for c in &s.state.network.contacts {
        let at = s.state.bodies.position[c.bodies[0] as usize];
        let p = c.impulse.norm() / STEP;
        total += p;
        moment += p * (at.x * at.x + at.y * at.y);
    }
    near(0.25 * load, total, 1e-3);
    let peak = 1.5 * load / (std::f64::consts::PI * A * A);
    let off = [1, 0].map(|system| {
        let state = SurfaceState::of(&s, system).unwrap();
        let corners = state.surface.facets.chunks_exact(3);
        let (mut sum, mut count) = (0.0, 0);
        for (corners, facet) in corners.zip(state.facets()) {
            let at = corners.iter().map(|k| state.surface.points[*k as usize]);
            let middle = at.fold(Vector3::zeros(), |sum, x| sum + x / 3.0);
            let r = middle.xy().norm() / A;
            if r < 0.8 {
                let expected = peak * (1.0 - r * r).sqrt();
                sum += (facet.pressure - expected).powi(2);
                count += 1;
            }
        }
        (sum / f64::from(count)).sqrt() / peak
    });
    [(2.5 * moment / total).sqrt() / A, off[0], off[1]]
}

/// Meshes that do not match are as accurate as those that do.
#[test]
fn hertz_between_two_bodies() {
    let cells = [(4, 4), (4, 5), (5, 4), (4, 3), (3, 4)];
    let found = cells.map(|(block, sphere)| pressed(block, sphere));
    for ((block, sphere), found) in cells.iter().zip(&found) {
        println!(
            "{sphere} on {block} elements over a: half-width, pressure off on sphere and block {found:.4?}"
        );
        near(1.0, found[0], 0.03);
        assert!(found[1] < 0.07 && found[2] < 0.07, "{found:?}");
    }
}
