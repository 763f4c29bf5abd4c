//! Profiles of wheel and rail against the Manchester contact benchmark as the program CONTACT has
//! it (E. A. H. Vollebregt, github eve70a/CONTACT, commit d431cdb).

use super::pressed::steel;
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::patch::Patch;
use fretwork_rolling::{Coulomb, Creepage, Curve, Pair, Radius, Surfaces, Touching, normal};

/// Height of a rail head of arcs of 300, 80 and 13 mm that end at these half-widths (mm), downwards
/// from its top.
fn head(ends: [f64; 2], y: f64) -> f64 {
    let [large, middle, small] = [300.0, 80.0, 13.0_f64];
    let (sin, cos) = (ends[0] / large).asin().sin_cos();
    let second = [(large - middle) * sin, large - (large - middle) * cos];
    let (sin, cos) = ((ends[1] - second[0]) / middle).asin().sin_cos();
    let third = [
        second[0] + (middle - small) * sin,
        second[1] - (middle - small) * cos,
    ];
    let arc = |centre: [f64; 2], radius: f64| {
        centre[1] - (radius * radius - (y.abs() - centre[0]).powi(2)).sqrt()
    };
    match y.abs() {
        y if y <= ends[0] => arc([0.0, large], large),
        y if y <= ends[1] => arc(second, middle),
        _ => arc(third, small),
    }
}

/// Returns a shipped profile (mm).
fn shipped(name: &str) -> Vec<[f64; 2]> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../patches/profiles/");
    let text = std::fs::read_to_string(format!("{folder}{name}")).unwrap();
    let rows = text.lines().filter(|l| !l.starts_with(['#', 'y']));
    let rows = rows.map(|row| {
        let (y, z) = row.split_once(',').unwrap();
        [y.parse().unwrap(), z.parse().unwrap()]
    });
    rows.collect()
}

/// The shipped rail is that of its drawing: its arcs end 20.456 and 52.053 mm apart.
#[test]
fn the_shipped_rail_is_made_of_arcs() {
    let rows = shipped("60e1.csv");
    let rows = rows.iter().filter(|[y, _]| y.abs() < 35.9);
    let off = rows.map(|[y, z]| (z + head([10.228, 26.0265], *y)).abs());
    let off: Vec<f64> = off.collect();
    assert!(off.len() > 1000 && off.iter().all(|x| *x < 1e-6));
}

/// A case of the benchmark: whether it is the right wheel, lateral displacement (mm), roll and yaw
/// of the wheelset (rad), normal force (N), creepages of the rail along and across; then places of
/// the contact on rail and wheel (mm), its angle (rad), approach (mm), largest pressure (MPa) and
/// the force on the rail along and across (N).
type Benchmark = ([f64; 7], [f64; 7]);

/// Manchester contact benchmark, case, by CONTACT (`examples/mbench_a22_right.ref_out` and
/// `_left.ref_out`): S1002 on UIC 60 at 1:40, G 82 GPa, nu 0.28, friction 0.3, 10 kN on each wheel
/// of 460 mm.
const BENCHMARK: [Benchmark; 8] = [
    (
        [1.0, 0.0, 0.0, 0.0, 9997.0, -5.665e-5, 0.0],
        [-8.66, 1.8726, 0.0290, 1.596e-2, 338.3, 0.2783, -253.6],
    ),
    (
        [1.0, 1.0, -5.049e-5, 2.4e-3, 9827.0, 6.943e-4, 2.407e-3],
        [-18.5418, -9.0305, 0.0696, 2.448e-2, 741.3, -814.3, -2832.0],
    ),
    (
        [1.0, 2.5, -1.457e-4, 6.0e-3, 9787.0, 9.607e-4, 6.025e-3],
        [-20.0706, -12.0933, 0.0862, 2.461e-2, 730.4, -456.2, -2900.0],
    ),
    (
        [1.0, 4.5, -2.977e-4, 1.08e-2, 9726.0, 1.430e-3, 1.088e-2],
        [-22.6421, -16.7104, 0.1185, 2.310e-2, 625.5, -376.8, -2893.0],
    ),
    (
        [0.0, 1.0, -5.049e-5, 2.4e-3, 10050.0, -6.297e-4, 2.4e-3],
        [-5.2886, 6.2694, 0.0176, 1.946e-2, 423.9, 829.2, -2893.0],
    ),
    (
        [0.0, 3.0, -1.803e-4, 7.2e-3, 10030.0, -1.103e-3, 7.197e-3],
        [-3.2967, 10.3382, 0.0110, 2.128e-2, 498.8, 460.5, -2974.0],
    ),
    (
        [0.0, 6.0, -6.272e-4, 1.44e-2, 10020.0, -4.901e-3, 1.437e-2],
        [-2.5116, 14.3878, 0.0084, 2.278e-2, 578.5, 973.1, -2845.0],
    ),
    (
        [0.0, 8.0, -8.606e-3, 1.92e-2, 10020.0, -2.281e-2, 1.899e-2],
        [-2.3103, 20.3458, 0.0077, 2.458e-2, 701.1, 2310.0, -1921.0],
    ),
];

/// Returns wheel and rail of a case before they touch (m): the rail is that of the benchmark, whose
/// points arcs that end 20.96 and 52.0 mm apart meet within 5 um. Places are from the top of the
/// inclined rail, and y points away from the middle of the track, to the right on the right wheel.
fn wheel_and_rail(given: &[f64; 7]) -> Pair {
    let [right, lateral, roll, yaw, ..] = *given;
    let side = if right > 0.0 { 1.0 } else { -1.0 };
    let (sin, cos) = (1.0_f64 / 40.0).atan().sin_cos();
    let rail = (-1600..=1600).map(|k| {
        let y = 0.0225 * f64::from(k);
        let z = head([10.48, 26.0], y);
        let across = y * cos + z * sin - 300.0 * sin;
        [
            1e-3 * across,
            1e-3 * (y * sin - z * cos + 300.0 * (cos - 1.0)),
        ]
    });
    // Tape circles are 1500 mm apart, tops of the rails 1521.0652 mm, by their gauge of 1435 mm;
    // the wheelset rolls about the middle of its axle, and its yaw takes the wheels inward.
    let (sin, cos) = (side * roll).sin_cos();
    let moved = 750.0 * (cos - 1.0) - 460.0 * sin - 375.0 * yaw * yaw;
    let shift = 750.0 - 760.5326 + side * lateral + moved;
    let wheel = shipped("s1002.csv").into_iter().map(|[y, z]| {
        let across = y * cos + z * sin + shift;
        [1e-3 * across, 1e-3 * (z * cos - y * sin)]
    });
    Pair {
        profiles: [
            Curve::through(wheel.collect()).unwrap(),
            Curve::through(rail.collect()).unwrap(),
        ],
        radii: [
            Some(Radius {
                radius: 0.46,
                height: 0.0,
            }),
            None,
        ],
    }
}

/// Returns the contact under a force (N) about the centre of its pressures, and its grid.
fn pressed(pair: &Pair, at: f64, force: f64) -> (Touching, CellGrid) {
    let body = steel(2.0 * 82e9 * 1.28, 0.28);
    let mut touching = pair.about(at).unwrap();
    let mut half = [6e-3, 16e-3];
    let mut middle = 0.0;
    loop {
        let grid = CellGrid {
            from: [-half[0], middle - half[1]],
            size: half.map(|h| 2.0 * h / 48.0),
            cells: [48; 2],
        };
        let surfaces = Surfaces::new(grid, [body; 2], 0.0);
        let distance = (0..grid.len()).map(|c| distance(&touching, grid.middle(c)));
        let distance: Vec<f64> = distance.collect();
        let found = normal(&surfaces, &distance, force, None).unwrap();
        let cells = found.pressure.iter().enumerate().filter(|(_, p)| **p > 0.0);
        let cells: Vec<([f64; 2], f64)> = cells.map(|(c, p)| (grid.middle(c), *p)).collect();
        let largest = |of: &dyn Fn(&[f64; 2]) -> f64| {
            cells.iter().map(|(x, _)| of(x)).fold(f64::MIN, f64::max)
        };
        let ends = [-largest(&|x| -x[1]), largest(&|x| x[1])];
        let centre = cells.iter().map(|(x, p)| x[1] * p).sum::<f64>()
            / cells.iter().map(|(_, p)| p).sum::<f64>();
        let wide = [1.15 * largest(&|x| x[0]), 0.58 * (ends[1] - ends[0])];
        let fits = (0..2).all(|k| half[k] < 1.2 * (wide[k] + grid.size[k]));
        if fits && centre.abs() < 0.01 * half[1] {
            return (touching, grid);
        }
        touching = pair.about(touching.place(centre)).unwrap();
        middle = 0.5 * (ends[0] + ends[1]) - centre;
        half = [0, 1].map(|k| wide[k] + grid.size[k]);
    }
}

fn distance(touching: &Touching, [x, s]: [f64; 2]) -> f64 {
    0.5 * touching.along.at(s) * x * x + touching.distance.at(s)
}

/// Place, angle, approach, pressure and forces are those of CONTACT with cells of 0.2 mm. Its place
/// is the middle of the overlap of the bodies, not of the pressures, up to 4 % of the width aside.
#[test]
fn a_wheelset_of_the_manchester_benchmark() {
    let body = steel(2.0 * 82e9 * 1.28, 0.28);
    let mut wrong = Vec::new();
    for (given, expected) in &BENCHMARK {
        let [right, .., force, along, across] = *given;
        let side = if right > 0.0 { 1.0 } else { -1.0 };
        let mut pair = wheel_and_rail(given);
        let [at, _] = pair.put_down().unwrap();
        let (touching, grid) = pressed(&pair, at, force);
        let at = touching.middle[0];
        // The creepages are those of the wheel; along the rolling it is that at the reference of
        // CONTACT, the middle of the overlap of the bodies.
        let spin = touching.spin();
        let creepage = Creepage {
            along: -along + spin * (1e-3 * expected[0] - at),
            across: -side * across,
            spin,
        };
        let undeformed = |place| distance(&touching, place);
        let patch = Patch {
            bodies: [body; 2],
            layer: 0.0,
            distance: &undeformed,
            load: force,
        };
        let found = patch.refined(grid, &creepage, &Coulomb(0.3), 2.0).unwrap();
        let got = [
            1e3 * at,
            touching.inclination,
            1e3 * found.fine.pressure.approach,
            1e-6 * found.fine.pressure.largest(),
            -found.force[0],
            -side * found.force[1],
        ];
        let expected = [0, 2, 3, 4, 5, 6].map(|k| expected[k]);
        let limit = 0.3 * force;
        let within = [
            0.04 * 1e3 * grid.extent()[1],
            2e-3,
            0.01 * expected[2],
            0.015 * expected[3],
            0.01 * limit,
            0.01 * limit,
        ];
        println!("{given:?}\n  {got:?}\n  {expected:?}");
        for k in 0..got.len() {
            if (got[k] - expected[k]).abs() > within[k] {
                wrong.push((given[1], k, got[k], expected[k]));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// At a displacement of 5 mm CONTACT finds two patches on the right rail, and one at 4.5 mm (its
/// user guide, "The Manchester wheel-rail benchmark").
#[test]
fn two_places_of_contact_are_told() {
    for (given, others) in [
        ([1.0, 5.0, -3.554e-4, 0.012, 9619.0, 0.0, 0.0], 1),
        ([1.0, 4.5, -2.977e-4, 0.0108, 9726.0, 0.0, 0.0], 0),
    ] {
        let mut pair = wheel_and_rail(&given);
        let [at, _] = pair.put_down().unwrap();
        // Its approach is 27 um, at 4.5 mm 23 um.
        let found = pair.about(at).unwrap().others([-2e-3, 2e-3], 2.7e-5);
        assert_eq!(found.len(), others, "{found:?}");
    }
}
