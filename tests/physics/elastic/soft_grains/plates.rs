//! A disk between two plates: approach and stress at its centre.

use super::*;

/// A disk under a force between two rigid plates, at rest (N/m).
fn pressed_disk(elements: usize, force: f64) -> Simulation<Dim2> {
    let top = format!(
        "mass: 1.0, dofs: (x: Fixed, y: Force(Ramp(from: 0.0, to: {:?}, start: 0.0, end: 0.1)), rz: Fixed)",
        -force
    );
    let mut s = Soft {
        step: 0.01,
        theta: 1.0,
        elements,
        mu: 0.0,
        bodies: wall("floor", &[0.0, 1.0], &[0.0, 0.0], "")
            + &wall("top", &[0.0, -1.0], &[0.0, 2.0 * R], &top),
        grains: disks("soft", &[ball_at(&[0.0, R], &[])]),
        ..Soft::default()
    }
    .build::<Dim2>();
    go(&mut s, 80);
    s
}

/// The approach of the plates is 2 P/(pi E*) (2 ln(4 R/a) - 1) with a^2 = 4 P R/(pi E*), E* =
/// E/(1 - nu^2) (K. L. Johnson, Contact Mechanics, 1985, equations 5.56 and 4.43), and the stress
/// at the centre of the disk sigma_x = 2 P/(pi D), sigma_y = -6 P/(pi D) (S. P. Timoshenko and J.
/// N. Goodier, Theory of Elasticity, article 41).
#[test]
fn a_disk_between_plates() {
    let modulus = 1e6 / (1.0 - NU * NU);
    let a = 0.15 * R;
    let force = PI * modulus * a * a / (4.0 * R);
    let expected = 2.0 * force / (PI * modulus) * (2.0 * (4.0 * R / a).ln() - 1.0);
    let mut off = Vec::new();
    for elements in [4, 6, 8] {
        let s = pressed_disk(elements, force);
        let top = s.state.bodies.driven.iter().find(|d| d.name == "top");
        let top = s.state.bodies.position[top.unwrap().body as usize].y;
        near(force, force_on_others(&s, 0, 1).abs(), 1e-6);
        let mesh = mesh(&s, 0);
        // The elements around the centre.
        let (mut stress, mut area) = ([0.0; 2], 0.0);
        for (element, sigma) in mesh.elements.chunks_exact(3).zip(&mesh.stress) {
            if element.contains(&0) {
                let corners: Vec<_> = element.iter().map(|p| mesh.points[*p as usize]).collect();
                let own = fretwork::elastic::element::Simplex::<Dim2>::new(&corners).unwrap();
                area += own.volume;
                stress[0] += own.volume * sigma[0];
                stress[1] += own.volume * sigma[1];
            }
        }
        let of = force / (PI * 2.0 * R);
        let [x, y] = stress.map(|s| s / area / of);
        let approach = (2.0 * R - top) / expected;
        println!(
            "{elements} elements: approach {approach}, stress at the centre {x} and {y} P/(pi D) of 2 and -6"
        );
        off.push([approach - 1.0, x - 2.0, y + 6.0].map(f64::abs));
        closes(&s, 1e-9);
    }
    // With 12 elements the values are 0.992, 1.91 and -5.87.
    assert!(
        off[2][0] < 0.02 && off[2][1] < 0.2 && off[2][2] < 0.25,
        "{off:?}"
    );
    assert!(
        off.windows(2)
            .all(|o| o[1][1] < 0.8 * o[0][1] && o[1][2] < 0.8 * o[0][2]),
        "{off:?}"
    );
}
