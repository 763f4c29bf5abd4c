//! Contacts on mean places besides the patch test: wear of meshes that do not match, stick and
//! slip, many facets below one point, and the end of a surface.

use super::wear::{agree, case};
use super::*;
use fretwork_observe::nearest_places::NearestPlaces;
use fretwork_observe::tractions::{ContactZone, SurfaceState};

/// Blocks of steel with other cells in place of the bodies of a case: `low` and `high` are the
/// lines along each horizontal axis of the lower and the upper block.
struct Blocks {
    half_width: [f64; 2],
    size: [f64; 2],
    below: &'static str,
    above: &'static str,
    lower: &'static str,
    /// Profile of its upper side.
    profile: &'static str,
    /// Whether the upper block has the material `soft`.
    soft: bool,
    sets: Vec<String>,
}

impl Blocks {
    fn build<S: Space>(&self) -> Simulation<S> {
        let mesh = |k: usize| {
            let (half, size) = (self.half_width[k], self.size[k]);
            let across = format!("(from: {:e}, to: {half:e}, size: {size:e})", -half);
            let [from, to] = [[-5e-3, 0.0], [0.0, 5e-3]][k];
            let up = format!("(from: {from:e}, to: {to:e}, size: 2.5e-3)");
            let profile = [self.profile, ""][k];
            match S::D {
                2 => format!("Block(x: {across}, y: {up} {profile})"),
                _ => format!("Block(x: {across}, y: {across}, z: {up} {profile})"),
            }
        };
        let elastic = format!(
            "elastic=[
                (name: \"lower\", material: \"steel\", mesh: {}, supports: [{}], touches: Surface(\"top\") {}),
                (name: \"upper\", material: \"{}\", mesh: {}, supports: [{}], touches: Points(\"bottom\")),
            ]",
            mesh(0),
            self.below,
            self.lower,
            if self.soft { "soft" } else { "steel" },
            mesh(1),
            self.above,
        );
        let name = match S::D {
            2 => "verification/elastic/wavy_block",
            _ => "verification/elastic/sphere_loop",
        };
        let mut sets = vec![
            "half_spaces=[]".to_owned(),
            "bodies=[]".to_owned(),
            "materials={\"steel\": \"contact_steel\"}".to_owned(),
            "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", parameters: (contact: {\"mu\": 0.3}))]".to_owned(),
            elastic,
            "solver.method=Newton".to_owned(),
            "solver.tolerance=1e-10".to_owned(),
            "detection=(alert: 2e-5, skin: 2e-4)".to_owned(),
        ];
        sets.extend(self.sets.iter().cloned());
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        case::<S>(name, &sets)
    }
}

/// An interface of steel with wear and this friction.
fn worn(mu: f64) -> String {
    format!(
        "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"coulomb\", wear: \"archard\", \
         parameters: (contact: {{\"mu\": {mu}}}, wear: {{\"k\": 2e-11}}))]"
    )
}

/// Depths of the scar within a distance of the middle (m).
fn depths<S: Space>(s: &Simulation<S>, within: f64) -> Vec<f64> {
    let scar = &s.state.scars[0];
    let near = |at: &S::Vector| (0..S::D - 1).all(|k| at[k].abs() < within);
    let found = scar.vertices().filter(|(v, _)| near(&v.at));
    found.map(|(_, depth)| depth).collect()
}

/// Coarse points under an even pressure wear a fine surface as evenly as points that match it: 25
/// MPa, +-20 um.
#[test]
fn coarse_points_wear_a_fine_surface_evenly() {
    let run = |size: f64| {
        let blocks = Blocks {
            half_width: [8e-3, 4e-3],
            size: [2.5e-4, size],
            below: "(part: \"bottom\", x: Fixed, y: Fixed)",
            above: "(
                part: \"top\", x: Displacement(Sine(amplitude: 2e-5, frequency: 20.0, start: 0.01)),
                y: Force(Ramp(from: 0.0, to: -2e5, start: 0.0, end: 5e-3)),
            )",
            lower: ", wears: (thickness: 1e-3)",
            profile: "",
            soft: false,
            sets: vec![worn(0.3), "time.step=2.5e-4".to_owned()],
        };
        let mut s = blocks.build::<Dim2>();
        let mut booked = 0.0;
        for _ in 0..240 {
            let report = s.step().unwrap_or_else(|e| panic!("{e}"));
            assert!(report.solver.converged);
            booked += report.totals.worn_first;
        }
        let scar = &s.state.scars[0];
        agree("scar", booked, scar.volume(), 1e-12);
        let sum: f64 = scar.vertices().map(|(v, d)| v.tributary * d).sum();
        agree("depths", booked, sum, 1e-12);
        (booked, depths(&s, 2e-3))
    };
    let ((volume, matching), (coarse_volume, coarse)) = (run(2.5e-4), run(1e-3));
    println!("{matching:?}\n{coarse:?}");
    agree("volume", volume, coarse_volume, 1e-2);
    for (expected, found) in matching.iter().zip(&coarse) {
        near(*expected, *found, 0.05);
    }
}

/// In 3D, too, coarse points remove material evenly from a fine surface.
#[test]
fn coarse_points_wear_a_fine_surface_evenly_in_space() {
    let run = |size: f64| {
        let blocks = Blocks {
            half_width: [6e-3, 4e-3],
            size: [1e-3, size],
            below: "(part: \"bottom\", x: Fixed, y: Fixed, z: Fixed)",
            above: "(
                part: \"top\", x: Displacement(Sine(amplitude: 2e-5, frequency: 20.0, start: 2e-3)), y: Fixed,
                z: Force(Ramp(from: 0.0, to: -1600.0, start: 0.0, end: 2e-3)),
            )",
            lower: ", wears: (thickness: 1e-3)",
            profile: "",
            soft: false,
            sets: vec![
                worn(0.01),
                "time.step=1e-3".to_owned(),
            ],
        };
        let mut s = blocks.build::<Dim3>();
        go(&mut s, 30);
        let scar = &s.state.scars[0];
        let sum: f64 = scar.vertices().map(|(v, d)| v.tributary * d).sum();
        agree("depths", scar.volume(), sum, 1e-12);
        (scar.volume(), depths(&s, 1.5e-3))
    };
    let ((volume, matching), (coarse_volume, coarse)) = (run(1e-3), run(2e-3));
    println!("{matching:?}\n{coarse:?}");
    agree("volume", volume, coarse_volume, 1e-2);
    for (expected, found) in matching.iter().zip(&coarse) {
        near(*expected, *found, 0.1);
    }
}

/// Two blocks of equal width between smooth walls in 3D, pressed with 50 MPa: the lower one with
/// cells of a given size, the upper one with four cells.
fn pressed(size: f64) -> Simulation<Dim3> {
    const HELD: &str = "(part: \"left\", x: Fixed), (part: \"right\", x: Fixed), (part: \"front\", y: Fixed), (part: \"back\", y: Fixed), ";
    let below = format!("{HELD} (part: \"bottom\", z: Fixed)");
    let above = format!(
        "{HELD} (part: \"top\", z: Force(Ramp(from: 0.0, to: -5e3, start: 0.0, end: 6e-4)))"
    );
    let blocks = Blocks {
        half_width: [5e-3; 2],
        size: [size, 5e-3],
        below: below.leak(),
        above: above.leak(),
        lower: "",
        profile: "",
        soft: false,
        sets: vec!["time.step=1e-4".to_owned(), "time.theta=1.0".to_owned()],
    };
    let mut s = blocks.build::<Dim3>();
    go(&mut s, 10);
    s
}

/// A surface that carries an even pressure is closed everywhere, however much finer it is than the
/// points that touch it.
#[test]
fn a_fine_surface_under_full_pressure_is_not_open() {
    let s = pressed(5e-4);
    for system in 0..2 {
        let state = SurfaceState::of(&s, system).unwrap();
        for (pressure, zone) in state.pressure.iter().zip(&state.zone) {
            near(50e6, *pressure, 1e-5);
            assert_ne!(*zone, ContactZone::Open);
        }
    }
}

/// Thousands of facets lie below one point: 3,200 below the middle one, 40 by 40 cells under 2
/// by 2.
#[test]
fn a_point_faces_as_many_facets_as_there_are() {
    let s = pressed(2.5e-4);
    assert!(s.acted_on_mean_places().all(|(_, mean)| mean));
    assert_eq!(NearestPlaces::of(&s).warning(), None);
    for pressure in SurfaceState::of(&s, 0).unwrap().pressure {
        near(50e6, pressure, 1e-5);
    }
}

/// A soft block on a stiff one of equal width, both free at one side, is pressed by 0.35 % of its
/// modulus. It widens by one or two per mille more than the stiff one, so that the points at that
/// edge leave the surface. Their facets remain on it, and carry the load as before.
fn beyond_the_end<S: Space>() {
    let up = S::D - 1;
    let (half, size, pressure): (f64, f64, f64) = (4e-3, 8e-4, 3.5e3);
    let force = -pressure * (2.0 * half).powi(up as i32);
    let axis = ["x", "y", "z"][up];
    let sides = [
        "(part: \"left\", x: Fixed),",
        "(part: \"front\", y: Fixed),",
    ];
    let sides = sides[..up].concat();
    let load = format!("Force(Ramp(from: 0.0, to: {force:e}, start: 0.0, end: 5e-3))");
    let blocks = Blocks {
        half_width: [half; 2],
        size: [size; 2],
        below: format!("{sides} (part: \"bottom\", {axis}: Fixed)").leak(),
        above: format!("{sides} (part: \"top\", {axis}: {load})").leak(),
        lower: "",
        profile: "",
        soft: true,
        sets: vec![
            "materials={\"steel\": \"contact_steel\", \"soft\": \"verification_rubber\"}".to_owned(),
            "interfaces=[(name: \"contact\", between: (\"steel\", \"soft\"), contact: \"coulomb\", parameters: (contact: {\"mu\": 0.0}))]".to_owned(),
            "time.step=1e-3".to_owned(),
        ],
    };
    let mut s = blocks.build::<S>();
    go(&mut s, 12);
    let upper = SurfaceState::of(&s, 1).unwrap();
    let beside = |k: usize| upper.place(k)[0] > half + 1e-5;
    let count = (0..upper.surface.points.len())
        .filter(|k| beside(*k))
        .count();
    assert!(count == 11usize.pow(up as u32 - 1), "{count}");
    assert!(s.acted_on_mean_places().all(|(_, mean)| mean));
    for contact in &s.state.network.contacts {
        near(1.0, contact.normal[up], 1e-3);
    }
    let lower = SurfaceState::of(&s, 0).unwrap();
    for (what, pressures) in [("upper", &upper.pressure), ("lower", &lower.pressure)] {
        let far = |p: &f64| (p / pressure - 1.0).abs();
        let most = pressures.iter().map(far).fold(0.0, f64::max);
        println!("{}D, {what}: pressure off by {most:e}", S::D);
        assert!(most < 0.06, "{pressures:?}");
    }
}

#[test]
fn points_beyond_the_end_of_a_surface_are_held_by_their_facets() {
    beyond_the_end::<Dim2>();
    beyond_the_end::<Dim3>();
}

/// The points of one half-space touch the surface of another: on equal cells the nearest place is
/// the mean place, wherever the points are.
#[test]
fn nearest_places_are_told_where_cells_differ() {
    let found = |size: &str| {
        let cells = format!("half_spaces.1.x=(from: -2.5e-3, to: 2.5e-3, size: {size})");
        let mut s = case::<Dim2>("fretting_wear_elastic", &[&cells]);
        go(&mut s, 60);
        NearestPlaces::of(&s)
    };
    assert_eq!(found("5e-5"), NearestPlaces::default());
    let other = found("4e-5");
    assert!(
        other.contacts == other.of && other.contacts > 10,
        "{other:?}"
    );
    let text = other.warning().unwrap();
    assert!(text.contains("100 % of the load"), "{text}");
}

/// Points above the valleys of a saw touch two of its sides: their area carries tension once, so
/// that the total is the strength times the width.
#[test]
fn tension_acts_once_at_a_crease() {
    let (half, strength) = (4e-3, 1e6);
    let blocks = Blocks {
        half_width: [half; 2],
        size: [1e-3; 2],
        below: "(part: \"bottom\", x: Fixed, y: Fixed)",
        above: "(part: \"top\", x: Fixed, y: Displacement(Ramp(from: 0.0, to: 8e-8, start: 0.0, end: 5e-3)))",
        lower: "",
        profile: ", profile: (side: \"top\", shape: Wave(amplitude: 1e-9, x: 2e-3))",
        soft: false,
        sets: vec![format!(
            "interfaces=[(name: \"contact\", between: (\"steel\", \"steel\"), contact: \"mohr-coulomb\", \
             parameters: (contact: {{\"mu\": 0.3, \"cohesion\": {strength:e}, \"tension\": {strength:e}}}))]"
        )],
    };
    let mut s = blocks.build::<Dim2>();
    go(&mut s, 30);
    let contacts = s.state.network.contact_count(false);
    assert!(contacts > 9, "{contacts} contacts of 9 points");
    near(
        2.0 * half * strength,
        holder(&s, 1, "top", 1).force.abs(),
        1e-6,
    );
}
