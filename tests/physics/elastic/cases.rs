//! Cases of `cases/verification/elastic/` compared with the closed forms that they name.

use super::*;
use crate::scene;

/// The steel of the cases (`contact_steel`), and its modulus without lateral strain (Pa).
const POISSON: f64 = 0.28;
const YOUNG: f64 = 209.92e9;
const UNIAXIAL: f64 = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
const DENSITY: f64 = 7800.0;

fn case(name: &str) -> Simulation<Dim2> {
    scene::case(&format!("verification/elastic/{name}"), &[])
}

#[test]
fn a_pressure_goes_through_meshes_that_do_not_match() {
    let mut s = case("patch");
    go(&mut s, 12);
    let pressure = 5e5 / 0.01;
    for body in [0, 1] {
        for across in mesh(&s, body).stress.iter().map(|stress| stress[1]) {
            near(-pressure, across, 1e-8);
        }
    }
    near(
        -0.01 * pressure / UNIAXIAL,
        holder(&s, 1, "top", 1).displacement,
        1e-8,
    );
    closes(&s, 1e-9);
}

#[test]
fn a_wall_carries_the_wave_of_a_bar() {
    let mut s = case("bar");
    let (h, force) = (1e-6, 0.02 * 0.1 * (UNIAXIAL * DENSITY).sqrt());
    let impulses: Vec<f64> = (0..500)
        .map(|_| {
            go(&mut s, 1);
            s.state.network.contacts.iter().map(|c| c.impulse.y).sum()
        })
        .collect();
    let pushed = impulses.iter().filter(|p| **p > 0.5 * force * h).count();
    near(2.0 / (UNIAXIAL / DENSITY).sqrt(), pushed as f64 * h, 0.02);
    // These steps lie between the arrival and the departure of the front, which the mesh smears.
    let middle = &impulses[60..300];
    near(force, middle.iter().sum::<f64>() / (240.0 * h), 0.02);
    // The bar rebounds with its initial speed.
    near(2.0 * 0.1 * DENSITY * 0.02, impulses.iter().sum(), 0.02);
    closes(&s, 1e-6);
}

#[test]
fn a_cantilever_gives_way_as_timoshenko_says() {
    let mut s = case("cantilever");
    go(&mut s, 40);
    let (force, length, height) = (1e3, 0.1_f64, 0.01_f64);
    let bending =
        force * length.powi(3) / (3.0 * YOUNG / (1.0 - POISSON * POISSON) * height.powi(3) / 12.0);
    let shear = 1.2 * force * length / (YOUNG / (2.0 * (1.0 + POISSON)) * height);
    near(
        -(bending + shear),
        holder(&s, 0, "right", 1).displacement,
        0.02,
    );
}
