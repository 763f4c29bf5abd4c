//! Free bricks that lie flush act as one floor for sliding bodies, and an edge that is due to the
//! error of the solver is reported.

use crate::extremes::bench::{Sketch, floor};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::step::Simulation;

/// Width and height of free bricks, and side of a sliding box (m), at the default alert distance, a
/// twentieth of the radius of the smallest grain. The last number is the permitted error of the
/// box's velocity at the default tolerance; a box seven times as heavy as a brick has a larger one.
const BRICKS: [([f64; 2], f64, f64, f64); 3] = [
    ([0.2, 0.2], 0.1, 3.5e-3, 1e-3),
    ([0.5, 0.2], 0.1, 3.5e-3, 1e-3),
    ([0.15, 0.06], 0.25, 4e-3, 2e-2),
];

/// A row of flush bricks that lie free on a floor, and a box that slides over them at a speed
/// (m/s); `last` tells whether the box is the last grain or the first.
fn on_bricks<S: Space>(
    [width, height]: [f64; 2],
    side: f64,
    speed: f64,
    last: bool,
) -> (String, usize) {
    let grain = |size: [f64; 3], [x, y, z]: [f64; 3], velocity: f64| {
        let [a, b, c] = size.map(|d| 0.5 * d);
        match S::D {
            2 => format!(
                "(at: [{x:?}, {z:?}], points: [(-{a:?}, -{c:?}), ({a:?}, -{c:?}), ({a:?}, {c:?}), (-{a:?}, {c:?})], velocity: [{velocity:?}, 0.0])"
            ),
            _ => format!(
                "(at: [{x:?}, {y:?}, {z:?}], size: ({:?}, {:?}, {:?}), velocity: [{velocity:?}, 0.0, 0.0])",
                2.0 * a,
                2.0 * b,
                2.0 * c
            ),
        }
    };
    let count = (2.2 / width).round() as usize;
    let middle = |k: usize| [width * (k as f64 + 0.5), 0.0, 0.5 * height];
    let mut all: Vec<String> = (0..count)
        .map(|k| grain([width, 0.3, height], middle(k), 0.0))
        .collect();
    let slider = if last { count } else { 0 };
    let at = [0.1 + 0.5 * side, 0.02, height + 0.5 * side];
    all.insert(slider, grain([side; 3], at, speed));
    let kind = ["Polygons", "Polyhedra"][S::D - 2];
    let grains = format!("{kind}(material: \"m0\", grains: [{}])", all.join(", "));
    (grains, slider)
}

/// A box that slides over free bricks without friction.
#[derive(Clone)]
struct Slide {
    /// Width and height of a brick, and the side of the box (m).
    brick: [f64; 2],
    side: f64,
    /// Alert distance (m), speed (m/s) and step (s).
    alert: f64,
    speed: f64,
    step: f64,
    /// Fields of the solver, and the coefficient of restitution.
    solver: &'static str,
    restitution: f64,
    /// Whether the box is the last grain or the first.
    last: bool,
}

/// Relative change of the velocity of the box after 1.5 m, and the number of edges that it met.
fn slide<S: Space>(slide: &Slide) -> (f64, u64) {
    let Slide { speed, step, .. } = *slide;
    let (grains, slider) = on_bricks::<S>(slide.brick, slide.side, speed, slide.last);
    let (contact, of_contact) = match slide.restitution > 0.0 {
        true => (
            "newton-restitution",
            format!(", \"e_n\": {:?}", slide.restitution),
        ),
        false => ("coulomb", String::new()),
    };
    let sketch = Sketch {
        step,
        mu: 0.0,
        contact,
        of_contact,
        solver: slide.solver.to_owned(),
        detection: [slide.alert, 1e-2],
        bodies: floor::<S>(),
        grains,
        ..Sketch::default()
    };
    let mut s: Simulation<S> = sketch.build().unwrap_or_else(|e| panic!("{e}"));
    let first = s.state.bodies.grains().next().expect("grains");
    for _ in 0..(1.5 / (speed * step)).round() as usize {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let velocity = s.state.bodies.velocity[first + slider];
    let changed = (velocity[0] / speed - 1.0).abs();
    let edges = s.state.network.step_size.edges;
    println!(
        "{}D, bricks of {:?} m, {speed} m/s, steps of {step} s, alert {} m, e {}, last {}, {}: changed by {changed:.2e}, {edges} edges",
        S::D,
        slide.brick,
        slide.alert,
        slide.restitution,
        slide.last,
        slide.solver
    );
    (changed, edges)
}

/// Free bricks sink by the tolerance of the solver under a sliding body, and drift apart: the
/// leading edge of the box is below the top of the next brick by the distance sunk. Without
/// friction the box keeps its velocity.
fn slides_over_free_bricks<S: Space>(last: bool) {
    for (speed, step, solver) in [
        (0.2, 1e-3, ""),
        (0.5, 1e-3, ""),
        (0.7, 1e-3, ""),
        (1.305, 1e-3, ""),
        (0.5, 2e-4, ""),
        (0.7, 1e-3, "tolerance: 1e-6"),
    ] {
        for (brick, side, alert, at_default) in BRICKS {
            let allowed = if solver.is_empty() { at_default } else { 1e-3 };
            let (changed, edges) = slide::<S>(&Slide {
                brick,
                side,
                alert,
                speed,
                step,
                solver,
                restitution: 0.0,
                last,
            });
            assert!(changed < allowed);
            // A heavy box may meet an edge, which is reported.
            assert!(edges == 0 || at_default > 1e-3);
        }
    }
}

#[test]
fn free_bricks_are_one_floor() {
    for last in [true, false] {
        slides_over_free_bricks::<Dim2>(last);
        slides_over_free_bricks::<Dim3>(last);
    }
}

/// If the alert distance is small for the bricks, they sink by more than counts as flush, and the
/// next brick may stop the box, which is reported.
#[test]
fn an_edge_of_the_solution_is_told() {
    let mut reported = 0;
    for (alert, speed) in [1e-3, 1e-4]
        .into_iter()
        .flat_map(|alert| [0.2, 0.5, 0.7, 1.305].map(|speed| (alert, speed)))
    {
        let heavy = Slide {
            brick: [0.15, 0.06],
            side: 0.25,
            alert,
            speed,
            step: 1e-3,
            solver: "",
            restitution: 0.0,
            last: true,
        };
        for restitution in [0.0, 1.0] {
            let heavy = Slide {
                restitution,
                ..heavy.clone()
            };
            for (changed, edges) in [slide::<Dim2>(&heavy), slide::<Dim3>(&heavy)] {
                assert!(changed < 2e-2 || edges > 0);
                reported += usize::from(edges > 0);
            }
            let (_, edges) = slide::<Dim2>(&Slide {
                solver: "tolerance: 1e-7",
                ..heavy
            });
            assert_eq!(edges, 0);
        }
        let (_, edges) = slide::<Dim2>(&Slide {
            brick: [0.2, 0.2],
            side: 0.1,
            ..heavy
        });
        assert_eq!(edges, 0);
    }
    println!("{reported} of 32 reported");
    assert!(reported > 12);
}
