//! Eigenfrequencies of a bar: w = pi c/(2 L) if it is clamped at one end, w = pi c/L if both ends
//! are free, with c = sqrt(E/rho) (nu = 0).

use super::*;
use std::f64::consts::PI;

/// The lowest angular frequency of a bar along x in small strain, by inverse iteration of A^-1 M
/// with A = M + s K.
fn lowest(cells: usize, clamped: bool) -> f64 {
    let (length, width) = (1.0, 1.0 / cells as f64);
    let material = Elasticity {
        poisson: 0.0,
        ..STEEL
    };
    let mesh = block::<Dim2>(&[even(0.0, length, cells), even(0.0, width, 1)]).unwrap();
    let points = mesh.points().len() as u32;
    let mut supports = vec![
        support("bottom", &[None, Some(Dof::Fixed)]),
        support("top", &[None, Some(Dof::Fixed)]),
    ];
    if clamped {
        supports.push(support("left", &[Some(Dof::Fixed), None]));
    }
    let mut system = ElasticBody::<Dim2>::new(body(mesh, material, &supports)).unwrap();
    let n = system.freedoms();
    let step = |h| SystemStep {
        time: 0.0,
        h,
        theta: 1.0,
        gravity: Vector2::zeros(),
    };
    // A is M where the step is short.
    system.begin_step(&step(1e-12));
    let mass: Vec<f64> = (0..n)
        .map(|c| {
            let mut unit = vec![0.0; n];
            unit[c] = 1.0;
            system.solve(&mut unit);
            if unit[c] > 0.0 { 1.0 / unit[c] } else { 0.0 }
        })
        .collect();
    let wave = (material.young / material.density).sqrt();
    let h = length / wave;
    system.begin_step(&step(h));
    let mut x: Vec<f64> = (0..n).map(|c| (c as f64 + 0.3).sin()).collect();
    let mut growth = 0.0;
    // The first mode is the translation along x.
    let along: Vec<f64> = (0..n)
        .map(|c| {
            let mut unit = vec![0.0; n];
            unit[c] = 1.0;
            let moves = |p: u32| system.node_velocity(p, &unit)[0] != 0.0;
            f64::from(u8::from((0..points).any(moves)))
        })
        .collect();
    for _ in 0..200 {
        if !clamped {
            let dot = |a: &[f64]| (0..n).map(|c| a[c] * mass[c] * along[c]).sum::<f64>();
            let mean = dot(&x) / dot(&along);
            x.iter_mut().zip(&along).for_each(|(x, e)| *x -= mean * e);
        }
        let norm = x
            .iter()
            .zip(&mass)
            .map(|(x, m)| m * x * x)
            .sum::<f64>()
            .sqrt();
        let mut next: Vec<f64> = x.iter().zip(&mass).map(|(x, m)| m * x / norm).collect();
        let before = next.clone();
        system.solve(&mut next);
        let both = next.iter().zip(&before);
        growth = both.map(|(a, b)| a * b).sum::<f64>();
        x = next;
    }
    ((1.0 / growth - 1.0) / (h * h)).sqrt()
}

use fretwork::bodies::SystemStep;
use nalgebra::Vector2;

#[test]
fn a_bar_has_its_frequencies() {
    let wave = (STEEL.young / STEEL.density).sqrt();
    for (clamped, expected) in [(true, 0.5 * PI * wave), (false, PI * wave)] {
        let off = [5, 10, 20].map(|cells| lowest(cells, clamped) / expected - 1.0);
        let orders = [off[0] / off[1], off[1] / off[2]].map(f64::log2);
        println!("clamped {clamped}: off by {off:?}, orders {orders:?}");
        assert!(off[2].abs() < 2e-3, "{off:?}");
        assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.2), "{orders:?}");
    }
}
