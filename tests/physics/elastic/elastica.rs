//! A cantilever under a large force at its end: the elastica (K. E. Bisshopp and D. C. Drucker,
//! "Large deflection of cantilever beams", Q. Appl. Math. 3 (1945)).

use super::*;
use crate::extremes::bench::floor;

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.0625;

/// Deflection across the beam and shortening along it, over its length, for P L^2/(E I). With the
/// slope a at the end, sqrt(2 P L^2/(E I)) = int_0^a dt/sqrt(sin a - sin t), w = int sin t ds, L -
/// u = int cos t ds.
fn elastica(load: f64) -> [f64; 2] {
    // The substitution t = a (1 - s^2) removes the root from the integrand.
    let integrals = |a: f64| {
        let n = 2000;
        (0..n).fold([0.0; 3], |sum, k| {
            let s = (f64::from(k) + 0.5) / f64::from(n);
            let t = a * (1.0 - s * s);
            let dt = 2.0 * a * s / f64::from(n) / (a.sin() - t.sin()).sqrt();
            [sum[0] + dt, sum[1] + dt * t.sin(), sum[2] + dt * t.cos()]
        })
    };
    let (mut low, mut high) = (1e-6, 0.5 * std::f64::consts::PI - 1e-9);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if integrals(middle)[0] > (2.0 * load).sqrt() {
            high = middle;
        } else {
            low = middle;
        }
    }
    let [length, across, along] = integrals(low);
    [across / length, 1.0 - along / length]
}

#[test]
fn the_elastica_has_its_table() {
    // The columns are P L^2/(E I), w/L, u/L.
    let table = [
        (1.0, 0.302, 0.056),
        (2.0, 0.493, 0.161),
        (5.0, 0.714, 0.388),
    ];
    for (load, across, along) in table {
        let [w, u] = elastica(load);
        assert!(
            (w - across).abs() < 1e-3 && (u - along).abs() < 1e-3,
            "{load}: {w}, {u}"
        );
    }
}

/// Mesh with the middle facet of its end as the part `tip`: a holder of the whole end would keep it
/// from rotating.
fn with_tip(mesh: &Mesh<Dim2>) -> Mesh<Dim2> {
    let points = |name: &str| -> Vec<u32> {
        let facets = mesh.part(name).unwrap().iter();
        facets
            .flat_map(|f| mesh.facet(*f as usize))
            .copied()
            .collect()
    };
    let end = points("right");
    let height = |pair: &[u32]| -> f64 {
        let sum: f64 = pair.iter().map(|p| mesh.points()[*p as usize].y).sum();
        (0.5 * sum / HEIGHT - 0.51).abs()
    };
    let middle = end
        .chunks_exact(2)
        .min_by(|a, b| height(a).total_cmp(&height(b)));
    let parts = [("left", points("left")), ("tip", middle.unwrap().to_vec())];
    let parts = parts.map(|(name, points)| (name.to_owned(), points)).into();
    let elements = mesh.elements().flatten().copied().collect();
    Mesh::new(mesh.points().to_vec(), elements, &parts).unwrap()
}

/// Deflection and shortening of the middle of the end over the length, at rest.
fn bent(strain: Strain, load: f64, cells: usize) -> [f64; 2] {
    let material = Elasticity {
        poisson: 0.0,
        ..RUBBER
    };
    let force = load * material.young * HEIGHT.powi(3) / 12.0 / (LENGTH * LENGTH);
    let mut s = scene::<Dim2>(&Sketch {
        bodies: floor::<Dim2>().replace("shapes:", "position: [0.0, -5.0], shapes:"),
        ..sketch(5.0, 1.0)
    });
    let x = even(0.0, LENGTH, 16 * cells);
    let beam = with_tip(&block::<Dim2>(&[x, even(0.0, HEIGHT, cells)]).unwrap());
    let drive = TimeFunction::Ramp {
        from: 0.0,
        to: force,
        start: 0.0,
        end: 50.0,
    };
    let supports = [
        support("left", &[Some(Dof::Fixed), Some(Dof::Fixed)]),
        support("tip", &[None, Some(Dof::Force(drive))]),
    ];
    let mut spec = body(beam, material, &supports);
    spec.strain = strain;
    add(&mut s, spec);
    let mut iterations = 0;
    for _ in 0..14 {
        go(&mut s, 1);
        iterations += s.state.systems.get(0).unwrap().linearisations();
    }
    closes(&s, 1e-8);
    let mesh = mesh(&s, 0);
    let ends = mesh.points.iter().zip(&mesh.displacement);
    let tip: Vec<_> = ends
        .filter(|(x, _)| x[0] > LENGTH * (1.0 - 1e-9))
        .map(|(_, u)| *u)
        .collect();
    let mean = |axis: usize| tip.iter().map(|u| u[axis]).sum::<f64>() / tip.len() as f64;
    println!(
        "{strain:?}, {cells} cells: {} {}, {iterations} iterations in 14 steps",
        mean(1),
        -mean(0)
    );
    [mean(1) / LENGTH, -mean(0) / LENGTH]
}

#[test]
fn a_cantilever_bends_as_the_elastica() {
    let load = 1.0;
    let expected = elastica(load);
    let found = [4, 8, 16].map(|cells| bent(Strain::Corotational, load, cells));
    for k in 0..2 {
        // Triangles are too stiff in bending: their relative error is the square of their size.
        let excess = found.map(|f| (expected[k] / f[k]) - 1.0);
        let orders = [excess[0] / excess[1], excess[1] / excess[2]].map(f64::log2);
        let [b, c] = [1.0 / found[1][k], 1.0 / found[2][k]];
        let extrapolated = 1.0 / (c + (c - b) / 3.0);
        println!("{k}: orders {orders:?}, {extrapolated} for {}", expected[k]);
        near(expected[k], extrapolated, 0.02);
        assert!(orders[1] > 1.3, "{orders:?}");
    }
}
