//! Independence of the results: they must not depend on how contacts are found, or on whether the
//! state was saved.

use super::*;

/// Some disks and squares that fall on each other.
fn falling(order: [usize; 4]) -> Soft {
    let all = [
        disks("soft", &[ball_at(&[-0.011, R + 1e-4], &[])]),
        square("soft", [0.012, R + 1e-4], 2.0 * R, 0.0, ""),
        disks("soft", &[ball_at(&[0.001, 0.031], &[0.1, -0.5])]),
        square("soft", [0.004, 0.056], 0.015, 0.3, "velocity: [0.0, -0.5]"),
    ];
    Soft {
        step: 1e-4,
        gravity: down(2),
        damping: 1e-4,
        elements: 3,
        tolerance: 1e-12,
        bodies: wall("floor", &[0.0, 1.0], &[0.0, 0.0], ""),
        grains: order.iter().map(|k| all[*k].clone()).collect(),
        ..Soft::default()
    }
}

fn places(s: &Simulation<Dim2>) -> [Vector2<f64>; 4] {
    let mut out = [Vector2::zeros(); 4];
    for (k, at) in out.iter_mut().enumerate() {
        *at = place_of(s, k);
    }
    out.sort_by(|a, b| a.y.total_cmp(&b.y));
    out
}

#[test]
fn the_answer_does_not_depend_on_how_contacts_are_found() {
    let order = [0, 1, 2, 3];
    let run = |case: &Soft| {
        let mut s = case.build::<Dim2>();
        go(&mut s, 300);
        (places(&s), bits(&s))
    };
    let case = falling(order);
    let (known, known_bits) = run(&case);
    let compare = |what: &str, (found, _): ([Vector2<f64>; 4], Vec<u8>), most: f64| {
        let off = known
            .iter()
            .zip(&found)
            .fold(0.0f64, |m, (a, b)| m.max((a - b).norm()));
        println!("{what}: {:e} R", off / R);
        assert!(off < most * R, "{what}: {off:e}");
    };
    for skin in [1e-4, 5e-3] {
        let case = Soft {
            detection: [case.detection[0], skin],
            ..case.clone()
        };
        compare(&format!("skin {skin}"), run(&case), 1e-9);
    }
    let case2 = Soft {
        detection: [2.0 * case.detection[0], 1e-3],
        ..case.clone()
    };
    compare("twice the alert distance", run(&case2), 1e-9);
    // Attraction has its own range.
    let sticky = |alert: f64| {
        let case = Soft {
            contact: (
                "mohr-coulomb",
                ", \"cohesion\": 2000.0, \"tension\": 1000.0, \"range\": 1e-5".to_owned(),
            ),
            detection: [alert, 1e-3],
            ..case.clone()
        };
        let mut s = case.build::<Dim2>();
        go(&mut s, 300);
        assert!(s.state.energy.adhesion > 0.0);
        closes(&s, 1e-9);
        places(&s)
    };
    let held = sticky(case.detection[0]);
    for factor in [0.5, 2.0] {
        let found = sticky(factor * case.detection[0]);
        let off = held.iter().zip(&found);
        let off = off.fold(0.0f64, |m, (a, b)| m.max((a - b).norm()));
        println!(
            "with cohesion, {factor} of the alert distance: {:e} R",
            off / R
        );
        assert!(off < 1e-9 * R, "{off:e}");
    }
    let other = [2, 0, 3, 1];
    compare("another order", run(&falling(other)), 1e-6);
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let (_, found) = pool.install(|| run(&case));
        assert!(found == known_bits, "{threads} threads");
    }
}

#[test]
fn a_saved_state_goes_on_with_the_same_bits() {
    let case = falling([0, 1, 2, 3]);
    let (mut whole, mut resumed) = (case.build::<Dim2>(), case.build::<Dim2>());
    go(&mut whole, 150);
    let bytes = bits(&whole);
    let saved: State<Dim2> = decode(&bytes).unwrap();
    assert!(resumed.restore(saved));
    assert!(bits(&resumed) == bytes);
    go(&mut whole, 150);
    go(&mut resumed, 150);
    assert!(!whole.state.network.contacts.is_empty());
    assert!(bits(&whole) == bits(&resumed));
}
