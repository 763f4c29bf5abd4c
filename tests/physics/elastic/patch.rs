//! Patch test of the contact: a uniform pressure goes through the contact of two meshes, whatever their points.
//!
//! Source: R. L. Taylor and P. Papadopoulos, "On a patch test for contact problems in two dimensions", Computational methods in nonlinear
//! mechanics (1991).

use super::*;

const WIDTH: f64 = 0.01;
const HEIGHT: f64 = 0.005;
/// Approach of the far sides (m).
const SUNK: f64 = 1e-5;

/// Cells over the width: even, or with sizes that grow along it.
fn across(cells: usize, growth: f64) -> Vec<f64> {
    let place = |k: usize| match growth {
        1.0 => k as f64 / cells as f64,
        g => (g.powi(k as i32) - 1.0) / (g.powi(cells as i32) - 1.0),
    };
    (0..=cells).map(|k| WIDTH * (place(k) - 0.5)).collect()
}

/// Two blocks between smooth walls, the upper one pressed on the lower: most difference of the stress across of an element, and of the pressure on a
/// point, over the mean pressure.
fn pressed(low: &[f64], high: &[f64], strain: Strain, mu: f64) -> [f64; 2] {
    pressed_on(low, high, strain, mu, |x, _| {
        block(&[x.to_vec(), even(0.0, HEIGHT, 4)]).unwrap()
    })
}

/// The same of meshes of the given width, from zero to `HEIGHT`, that touch with the side of that name.
fn pressed_on(
    low: &[f64],
    high: &[f64],
    strain: Strain,
    mu: f64,
    mesh: impl Fn(&[f64], &str) -> Mesh<Dim2>,
) -> [f64; 2] {
    let mut s = scene::<Dim2>(&Sketch {
        bodies: crate::extremes::bench::plane::<Dim2>("far", 0.0, 0.0, 1.0)
            .replace("shapes:", "position: [0.0, -1.0], shapes:"),
        mu,
        solver: "tolerance: 1e-13, norm: Velocity, method: Newton,".to_owned(),
        ..sketch(1e-3, 1.0)
    });
    let [left, right] = ["left", "right"].map(|part| support(part, &[Some(Dof::Fixed), None]));
    let floor = support("bottom", &[None, Some(Dof::Fixed)]);
    let lid = support("top", &[None, ramp(-SUNK, 10e-3)]);
    let held = [left.clone(), right.clone(), floor];
    let below = mesh(low, "top").moved(&nalgebra::Vector2::new(0.0, -HEIGHT));
    let mut spec = body(below, STEEL, &held);
    (spec.strain, spec.touching) = (strain, Touching::Surface("top"));
    add(&mut s, spec);
    let held = [left, right, lid];
    let mut spec = body(mesh(high, "bottom"), STEEL, &held);
    (spec.name, spec.strain) = ("upper", strain);
    spec.touching = Touching::Points("bottom");
    add(&mut s, spec);
    go(&mut s, 14);
    closes(&s, 1e-9);
    let pressure = -holder(&s, 1, "top", 1).force / WIDTH;
    let stresses = [0, 1].map(|b| mesh_stress(&s, b));
    let off = |yy: &f64| (yy / -pressure - 1.0).abs();
    let stress = stresses.iter().flatten().map(off).fold(0.0, f64::max);
    let mut on_points = vec![0.0; high.len()];
    for c in &s.state.network.contacts {
        let x = s.state.bodies.position[c.bodies[0] as usize].x;
        let nearest = (0..high.len()).min_by(|a, b| {
            let far = |k: &usize| (high[*k] - x).abs();
            far(a).total_cmp(&far(b))
        });
        on_points[nearest.unwrap()] += c.impulse.y / s.options.scheme.h;
    }
    let last = high.len() - 1;
    let pressures = on_points.iter().enumerate().map(|(k, f)| {
        let length = 0.5 * (high[(k + 1).min(last)] - high[k.saturating_sub(1)]);
        (f / (length * pressure) - 1.0).abs()
    });
    [stress, pressures.fold(0.0, f64::max)]
}

fn mesh_stress(s: &Simulation<Dim2>, system: usize) -> Vec<f64> {
    mesh(s, system).stress.iter().map(|s| s[1]).collect()
}

/// Whatever the meshes, the coarser one touching by its points or its surface.
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
    for (low, high) in &meshes {
        for mu in [0.0, 0.3] {
            let [stress, pressure] = pressed(low, high, Strain::Small, mu);
            println!(
                "{} on {} cells, mu {mu}: stress off by {stress:e}, pressure by {pressure:e}",
                high.len() - 1,
                low.len() - 1
            );
            assert!(stress < 1e-6 && pressure < 1e-6, "{stress:e} {pressure:e}");
        }
    }
}

/// On cells that double with the distance from the contact, of even and odd numbers.
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
        let grid = Grid::coarsened(&[x.to_vec(), y], &coarsening, 100_000).unwrap();
        mapped_grid::<Dim2>(&grid, |p| *p).unwrap()
    };
    for (low, high) in [(40, 40), (37, 28), (28, 37)] {
        for strain in [Strain::Small, Strain::NeoHookean] {
            let [stress, pressure] =
                pressed_on(&across(low, 1.0), &across(high, 1.0), strain, 0.3, mesh);
            println!(
                "{high} on {low} cells that double: stress off by {stress:e}, pressure by {pressure:e}"
            );
            assert!(stress < 1e-9 && pressure < 1e-9, "{stress:e} {pressure:e}");
        }
    }
}

/// In large strain too: the stress is that of Cauchy, on the area that is held by the walls.
#[test]
fn strain_follows_rotation_in_the_patch_too() {
    for strain in LARGE {
        let [stress, pressure] = pressed(&across(10, 1.0), &across(7, 1.0), strain, 0.3);
        println!("{strain:?}: stress off by {stress:e}, pressure by {pressure:e}");
        assert!(stress < 1e-6 && pressure < 1e-6, "{stress:e} {pressure:e}");
    }
}

/// In space points act on their nearest place alone, and a uniform pressure goes through with the error that the documentation states.
#[test]
fn in_space_single_points_are_off() {
    let mut s = scene::<Dim3>(&Sketch {
        bodies: crate::extremes::bench::plane::<Dim3>("far", 0.0, 0.0, 1.0)
            .replace("shapes:", "position: [0.0, 0.0, -1.0], shapes:"),
        mu: 0.0,
        solver: "tolerance: 1e-12, norm: Velocity, method: Newton,".to_owned(),
        ..sketch(1e-3, 1.0)
    });
    let cube = |cells: usize, z: f64| {
        let x = across(cells, 1.0);
        block::<Dim3>(&[x.clone(), x, even(z, z + HEIGHT, 3)]).unwrap()
    };
    let walls = |last: Support| {
        let x = ["left", "right"].map(|part| support(part, &[Some(Dof::Fixed), None, None]));
        let y = ["front", "back"].map(|part| support(part, &[None, Some(Dof::Fixed), None]));
        let mut all: Vec<Support> = x.into_iter().chain(y).collect();
        all.push(last);
        all
    };
    let held = walls(support("bottom", &[None, None, Some(Dof::Fixed)]));
    let mut spec = body(cube(6, -HEIGHT), STEEL, &held);
    spec.touching = Touching::Surface("top");
    add(&mut s, spec);
    let held = walls(support("top", &[None, None, ramp(-SUNK, 10e-3)]));
    let mut spec = body(cube(5, 0.0), STEEL, &held);
    (spec.name, spec.touching) = ("upper", Touching::Points("bottom"));
    add(&mut s, spec);
    go(&mut s, 14);
    closes(&s, 1e-9);
    let pressure = -holder(&s, 1, "top", 2).force / (WIDTH * WIDTH);
    let stress = |b: usize| mesh(&s, b).stress.iter().map(|s| s[2]).collect::<Vec<_>>();
    let off = [0, 1].map(|b| {
        let squares = stress(b)
            .iter()
            .map(|zz| (zz / -pressure - 1.0).powi(2))
            .collect::<Vec<_>>();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    });
    println!("in space, 5 on 6 cells: stress off by {off:?} (root mean square)");
    assert!(off.iter().all(|off| *off < 0.11), "{off:?}");
}
