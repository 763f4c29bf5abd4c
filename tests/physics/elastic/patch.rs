//! Patch test of the contact: a uniform pressure is transmitted through the contact of two meshes
//! with any points.
//!
//! Source: R. L. Taylor and P. Papadopoulos, "On a patch test for contact problems in two
//! dimensions", Computational methods in nonlinear mechanics (1991).

use super::*;

const WIDTH: f64 = 0.01;
const HEIGHT: f64 = 0.005;
/// Approach of the far sides (m).
const SUNK: f64 = 1e-5;

/// Coordinates of cells over the width: even, or with sizes that grow along it.
fn across(cells: usize, growth: f64) -> Vec<f64> {
    let place = |k: usize| match growth {
        1.0 => k as f64 / cells as f64,
        g => (g.powi(k as i32) - 1.0) / (g.powi(cells as i32) - 1.0),
    };
    (0..=cells).map(|k| WIDTH * (place(k) - 0.5)).collect()
}

/// Two blocks between smooth walls, the upper one pressed on the lower. Returns the largest
/// difference of the stress across an element, and of the pressure on a point, relative to the mean
/// pressure. The arguments give the cells over the width along each axis.
fn pressed<S: Space>(low: &[f64], high: &[f64], strain: Strain, mu: f64) -> [f64; 2] {
    pressed_on::<S>(low, high, strain, mu, |x, _| {
        let mut sides = vec![x.to_vec(); S::D - 1];
        sides.push(even(0.0, HEIGHT, 4));
        block::<S>(&sides).unwrap()
    })
}

/// Does as [`pressed`] with meshes of the given width, from zero to `HEIGHT`, that touch with the
/// side of that name.
fn pressed_on<S: Space>(
    low: &[f64],
    high: &[f64],
    strain: Strain,
    mu: f64,
    mesh: impl Fn(&[f64], &str) -> Mesh<S>,
) -> [f64; 2] {
    let up = S::D - 1;
    let mut far = vec![0.0; S::D];
    far[up] = -1.0;
    let mut s = scene::<S>(&Sketch {
        bodies: crate::extremes::bench::plane::<S>("far", 0.0, 0.0, 1.0)
            .replace("shapes:", &format!("position: {far:?}, shapes:")),
        mu,
        solver: "tolerance: 1e-13, norm: Velocity, method: Newton,".to_owned(),
        ..sketch(1e-3, 1.0)
    });
    let along = |axis: usize, drive: Option<Dof>| {
        let mut axes = vec![None; S::D];
        axes[axis] = drive;
        axes
    };
    let walls = |part: &str, drive: Option<Dof>| {
        let sides = [("left", 0), ("right", 0), ("front", 1), ("back", 1)];
        let sides = sides.into_iter().take(2 * up);
        let mut all: Vec<Support> = sides
            .map(|(side, axis)| support(side, &along(axis, Some(Dof::Fixed))))
            .collect();
        all.push(support(part, &along(up, drive)));
        all
    };
    let mut below = S::Vector::zero();
    below[up] = -HEIGHT;
    let held = walls("bottom", Some(Dof::Fixed));
    let mut spec = body(mesh(low, "top").moved(&below), STEEL, &held);
    (spec.strain, spec.touching) = (strain, Touching::Surface("top"));
    add(&mut s, spec);
    let held = walls("top", ramp(-SUNK, 10e-3));
    let mut spec = body(mesh(high, "bottom"), STEEL, &held);
    (spec.name, spec.strain) = ("upper", strain);
    spec.touching = Touching::Points("bottom");
    add(&mut s, spec);
    go(&mut s, 14);
    closes(&s, 1e-9);
    let pressure = -holder(&s, 1, "top", up).force / WIDTH.powi(up as i32);
    let stresses = [0, 1].map(|b| mesh_stress(&s, b));
    let off = |zz: &f64| (zz / -pressure - 1.0).abs();
    let stress = stresses.iter().flatten().map(off).fold(0.0, f64::max);
    assert!(s.acted_on_mean_places().all(|(_, mean)| mean));
    let upper = s.state.systems.get(1).unwrap();
    let touching = upper.touching_surface().unwrap();
    let mut on_points = vec![0.0; touching.points.len()];
    for c in &s.state.network.contacts {
        let at = s.state.bodies.position[c.bodies[0] as usize];
        let far = |k: &usize| (upper.node_position(touching.nodes[*k]) - at).norm();
        let nearest = (0..on_points.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
        on_points[nearest.unwrap()] += c.impulse[up] / s.options.scheme.h;
    }
    let pressures = on_points.iter().zip(&touching.areas);
    let pressures = pressures.map(|(force, area)| (force / (area * pressure) - 1.0).abs());
    [stress, pressures.fold(0.0, f64::max)]
}

/// Stress of each element along the last axis (Pa).
fn mesh_stress<S: Space>(s: &Simulation<S>, system: usize) -> Vec<f64> {
    mesh(s, system).stress.iter().map(|s| s[S::D - 1]).collect()
}

/// Tests two blocks with each of these pairs of meshes, with and without friction.
fn goes_through<S: Space>(meshes: &[(Vec<f64>, Vec<f64>)], strain: Strain) {
    for (low, high) in meshes {
        for mu in [0.0, 0.3] {
            let [stress, pressure] = pressed::<S>(low, high, strain, mu);
            println!(
                "{}D, {strain:?}, {} on {} cells, mu {mu}: stress off by {stress:.1e}, pressure by {pressure:.1e}",
                S::D,
                high.len() - 1,
                low.len() - 1
            );
            assert!(stress < 1e-8 && pressure < 1e-8, "{stress:e} {pressure:e}");
        }
    }
}

/// The coarser mesh touches by its points or by its surface.
#[test]
fn a_uniform_pressure_goes_through_meshes_that_do_not_match() {
    let meshes = [
        (across(10, 1.0), across(10, 1.0)),
        (across(10, 1.0), across(7, 1.0)),
        (across(7, 1.0), across(10, 1.0)),
        (across(6, 1.0), across(14, 1.1)),
        (across(14, 1.1), across(6, 1.0)),
        (across(9, 0.9), across(8, 1.15)),
    ];
    goes_through::<Dim2>(&meshes, Strain::Small);
}

/// In 3D the triangles of the two surfaces intersect in any way.
#[test]
fn a_uniform_pressure_goes_through_in_space() {
    let meshes = [
        (across(5, 1.0), across(5, 1.0)),
        (across(6, 1.0), across(5, 1.0)),
        (across(5, 1.0), across(6, 1.0)),
        (across(3, 1.0), across(8, 1.2)),
        (across(8, 1.2), across(3, 1.0)),
        (across(6, 0.8), across(5, 1.3)),
    ];
    goes_through::<Dim3>(&meshes, Strain::Small);
}

/// The cells double with the distance from the contact; their numbers are even and odd.
#[test]
fn a_uniform_pressure_goes_through_cells_that_double() {
    let mesh = |x: &[f64], side: &str| {
        let mut y = graded(0.0, HEIGHT, WIDTH / 40.0, 1.4);
        if side == "top" {
            y = y.iter().rev().map(|y| HEIGHT - y).collect();
        }
        let coarsening = Coarsening {
            from: side,
            ratio: 1.0,
        };
        let grid = BlockGrid::coarsened(&[x.to_vec(), y], &coarsening, 100_000).unwrap();
        mapped_grid::<Dim2>(&grid, |p| *p).unwrap()
    };
    for (low, high) in [(40, 40), (37, 28), (28, 37)] {
        for strain in [Strain::Small, Strain::NeoHookean] {
            let [stress, pressure] =
                pressed_on::<Dim2>(&across(low, 1.0), &across(high, 1.0), strain, 0.3, mesh);
            println!(
                "{high} on {low} cells that double: stress off by {stress:e}, pressure by {pressure:e}"
            );
            assert!(stress < 1e-9 && pressure < 1e-9, "{stress:e} {pressure:e}");
        }
    }
}

/// In large strain the stress is that of Cauchy, on the area held by the walls.
#[test]
fn strain_follows_rotation_in_the_patch_too() {
    for strain in LARGE {
        goes_through::<Dim2>(&[(across(10, 1.0), across(7, 1.0))], strain);
        goes_through::<Dim3>(&[(across(4, 1.0), across(3, 1.2))], strain);
    }
}
