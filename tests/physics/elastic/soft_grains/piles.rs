//! Piles at rest on their floor.

use super::*;

/// A pile between walls at rest: the floor carries its weight.
fn rests<S: Space>(what: &str, grains: &str, elements: usize, steps: usize) -> Simulation<S> {
    let mut bodies = String::new();
    let w = 0.03;
    for (axis, name) in ["x", "y"].iter().enumerate().take(S::D - 1) {
        for side in [-1.0, 1.0] {
            let (mut normal, mut at) = (vec![0.0; S::D], vec![0.0; S::D]);
            normal[axis] = -side;
            at[axis] = side * w;
            bodies += &wall(
                &format!("{name}{}", if side < 0.0 { "low" } else { "high" }),
                &normal,
                &at,
                "",
            );
        }
    }
    let mut normal = vec![0.0; S::D];
    normal[S::D - 1] = 1.0;
    let bodies = wall("floor", &normal, &vec![0.0; S::D], "") + &bodies;
    let mut s = Soft {
        step: 5e-4,
        theta: 1.0,
        gravity: down(S::D),
        elements,
        damping: 1e-3,
        tolerance: 1e-7,
        bodies,
        grains: grains.to_owned(),
        ..Soft::default()
    }
    .build::<S>();
    for _ in 0..steps {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let weight: f64 = (0..s.state.systems.len())
        .map(|k| s.state.systems.get(k).unwrap().mass() * G)
        .sum();
    let floor = s
        .state
        .bodies
        .driven
        .iter()
        .find(|d| d.name == "floor")
        .unwrap()
        .body;
    let mut walls = 0.0;
    for d in &s.state.bodies.driven {
        walls -= force_on_others(&s, d.body as usize, S::D - 1);
    }
    let carried = -force_on_others(&s, floor as usize, S::D - 1);
    println!(
        "{what}: carried {} of the weight, with walls {}, kinetic {:e}, deepest {:e} R",
        carried.abs() / weight,
        walls.abs() / weight,
        s.state.energy.kinetic,
        deepest(&s) / R
    );
    // Spheres still creep at the end, by accelerations of some 1e-4 of gravity.
    near(weight, walls.abs(), 5e-4);
    assert!(deepest(&s) < 0.01 * R);
    closes(&s, 1e-9);
    s
}

/// Deepest vertex of one grain inside of another (m), by crossings of a ray and distances from
/// edges.
fn overlap_of_outlines(s: &Simulation<Dim2>) -> f64 {
    let outlines: Vec<Vec<Vector2<f64>>> = s
        .shapes
        .surfaces
        .iter()
        .map(|f| {
            let (at, turn) = (
                &s.state.bodies.position[f.body as usize],
                &s.state.bodies.rotation[f.body as usize],
            );
            let points = f.shape.moving_vertices().iter();
            points.map(|x| at + Dim2::rotate(turn, x)).collect()
        })
        .collect();
    let mut deep = 0.0f64;
    for (i, one) in outlines.iter().enumerate() {
        for (j, other) in outlines.iter().enumerate() {
            for p in one.iter().filter(|_| i != j) {
                let edges = other.windows(2);
                let crossings = edges.clone().filter(|e| {
                    (e[0].y > p.y) != (e[1].y > p.y)
                        && p.x < e[0].x + (p.y - e[0].y) / (e[1].y - e[0].y) * (e[1].x - e[0].x)
                });
                if crossings.count() % 2 == 1 {
                    let far = edges.map(|e| {
                        let along = e[1] - e[0];
                        let t = ((p - e[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                        (p - e[0] - along * t).norm()
                    });
                    deep = deep.max(far.fold(f64::INFINITY, f64::min));
                }
            }
        }
    }
    deep
}

#[test]
fn piles_rest_on_their_floor() {
    let mut all = Vec::new();
    for (k, x) in [-0.0199, 0.0005, 0.0199, -0.011, 0.012, -0.002]
        .iter()
        .enumerate()
    {
        all.push(ball_at(
            &[
                *x,
                if k < 3 {
                    1.05 * R + 0.003 * (k as f64)
                } else {
                    3.6 * R + 0.02 * (k as f64 - 3.0)
                },
            ],
            &[],
        ));
    }
    let s = rests::<Dim2>("disks", &disks("soft", &all), 3, 2000);
    let deep = overlap_of_outlines(&s);
    println!("outlines overlap by {:e} R", deep / R);
    assert!(deep < 0.01 * R);
    let mut polygons = String::new();
    for (k, (x, y, sides)) in [
        (-0.018, 0.011, 5),
        (0.004, 0.011, 6),
        (-0.005, 0.035, 4),
        (0.012, 0.06, 3),
    ]
    .iter()
    .enumerate()
    {
        polygons += &format!(
            "Polygons(material: \"soft\", grains: [(at: [{x:?}, {y:?}], regular: ({sides}, {R:?}), angle: {:?})]),",
            0.3 * k as f64
        );
    }
    let s = rests::<Dim2>("polygons", &polygons, 3, 2000);
    let deep = overlap_of_outlines(&s);
    println!("outlines overlap by {:e} R", deep / R);
    assert!(deep < 0.01 * R);
}

#[test]
fn piles_rest_on_their_floor_in_space() {
    let spheres = disks(
        "soft",
        &[
            ball_at(&[0.001, 0.0, 1.05 * R], &[]),
            ball_at(&[0.0, 0.002, 3.2 * R], &[]),
        ],
    );
    rests::<Dim3>("spheres", &spheres, 2, 1200);
    let blocks = cuboid("soft", [0.0, 0.0, 0.0101], [0.03, 0.03, 0.02], "")
        + &cuboid(
            "soft",
            [0.002, 0.001, 0.0302],
            [0.02, 0.02, 0.02],
            "turned: [0.0, 0.0, 0.4]",
        );
    rests::<Dim3>("cuboids", &blocks, 1, 800);
}
