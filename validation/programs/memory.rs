//! Memory per grain and per contact, counted to the byte, for each feature.
//!
//! `cargo run --release --example memory` makes scenes of disks, spheres, and bricks in 2D and 3D
//! at two sizes, steps them, and prints the table of `docs/dev/memory.md`. Grains are counted in
//! scenes without contacts, contacts in packed layers, each by the difference between the two
//! sizes, so that fixed costs cancel.

#[path = "../../tests/support/counting.rs"]
mod counting;
#[path = "../../tests/support/features.rs"]
mod features;

use counting::{held, peak};
use features::{BASE, BONDS, FEATURES, Feature};
use fretwork::bodies::Bodies;
use fretwork::contact::Bond;
use fretwork::geometry::shape::Ball;
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::scene::load_text;
use fretwork::shipped::search_path;
use fretwork::solve::Problem;
use fretwork::step::Simulation;
use std::fmt::Write as _;
use std::path::Path;

#[global_allocator]
static COUNTING: counting::Counting = counting::Counting;

/// Features measured here in addition to the shared ones.
const MORE: [Feature; 2] = [
    ("projection of overlaps", &["solver.projection=1e-3"]),
    (
        "implicit coupling",
        &[
            "interfaces.0.cohesion=mac",
            "interfaces.0.damage=mac",
            "coupling=Implicit(tolerance: 1e-3, max_iterations: 50)",
        ],
    ),
];

/// Shape of the grains.
#[derive(Clone, Copy, PartialEq)]
enum Grains {
    Balls,
    Bricks,
}

/// Memory of a scene.
struct Held {
    grains: f64,
    contacts: f64,
    live: f64,
    /// Peak beyond that during a step.
    step: f64,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "| scene | feature | contacts per grain | per grain | per contact | in a step: per grain | per contact | `check`: per grain | per contact |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let all = [&FEATURES[..], &MORE].concat();
    scene::<Dim2>("disks", Grains::Balls, &all)?;
    scene::<Dim3>("spheres", Grains::Balls, &all)?;
    scene::<Dim2>("bricks in the plane", Grains::Bricks, &[BASE, BONDS])?;
    scene::<Dim3>("bricks in space", Grains::Bricks, &[BASE, BONDS])?;
    Ok(())
}

/// Approximate numbers of contacts at the two sizes, just below 2^15 and 2^16. Growing lists double
/// their capacity when full, and are nearly full here; just after doubling they take twice as much.
const CONTACTS: [f64; 2] = [32_400.0, 64_800.0];

fn scene<S: Space>(
    name: &str,
    grains: Grains,
    features: &[Feature],
) -> Result<(), Box<dyn std::error::Error>> {
    for (feature, sets) in features {
        let each = match (grains, S::D) {
            (Grains::Balls, _) => 3.0,
            (Grains::Bricks, 2) => 6.0,
            (Grains::Bricks, _) => 12.0,
        };
        let sizes = CONTACTS.map(|n| (n / each) as usize);
        let of = |count: usize, apart: bool| measure::<S>(grains, count, apart, sets);
        let [few, many] = [of(sizes[0], true)?, of(sizes[1], true)?];
        let more = many.grains - few.grains;
        let (grain, in_step) = ((many.live - few.live) / more, (many.step - few.step) / more);
        let [few, many] = [of(sizes[0], false)?, of(sizes[1], false)?];
        let (grains_more, more) = (many.grains - few.grains, many.contacts - few.contacts);
        let contact = (many.live - few.live - grain * grains_more) / more;
        let step = (many.step - few.step - in_step * grains_more) / more;
        let [check_grain, check_contact] = check::<S>(grains, sets);
        println!(
            "| {name} | {feature} | {:.2} | {grain:.0} B | {contact:.0} B | {in_step:.0} B | {step:.0} B | {check_grain} B | {check_contact} B |",
            more / grains_more
        );
    }
    Ok(())
}

/// Estimate of `fretwork check` from the sizes of the types, including a bond if there is one.
fn check<S: Space>(grains: Grains, sets: &[&str]) -> [usize; 2] {
    let [plain, full, levers, bonded] = Problem::<S>::BYTES_A_CONTACT;
    let bonds = sets.iter().any(|s| s.contains("cohesion"));
    let made = bonds && !sets.iter().any(|s| s.contains("Never"));
    let sort = Problem::<S>::BYTES_TO_SORT;
    let row = match (grains, bonds) {
        (Grains::Bricks, true) => bonded,
        (Grains::Bricks, false) => levers,
        (Grains::Balls, true) => full,
        (Grains::Balls, false) => plain,
    };
    let beside = Simulation::<S>::BYTES_A_CONTACT;
    let bond = if made { size_of::<Bond<S>>() } else { 0 };
    let state = Bodies::<S>::BYTES + size_of::<Ball<S>>() + size_of::<S::Vector>();
    [
        state + Problem::<S>::BYTES_A_BODY,
        row + sort + beside + bond,
    ]
}

const RADIUS: f64 = 1e-3;

/// A case of `count` grains: separate, or in a layer of constant depth.
fn case<S: Space>(grains: Grains, count: usize, apart: bool) -> String {
    let wide = 2.0 * RADIUS * (1.0 + 2e-6);
    let (axes, up) = if S::D == 2 {
        (2, "0.0, 1.0")
    } else {
        (3, "0.0, 0.0, 1.0")
    };
    let gravity = up.replace("1.0", if apart { "0.0" } else { "-9.81" });
    let mut period = String::new();
    let list = match (grains, apart) {
        (Grains::Balls, true) => {
            let mut list = String::from("List(material: \"grain\", grains: [");
            let side = (count as f64).powf(1.0 / axes as f64).ceil() as usize;
            for k in 0..count {
                let place = |k: usize| (2.0 * k as f64 + 1.0) * wide;
                let at: Vec<String> = (0..axes)
                    .map(|a| format!("{:e}", place(k / side.pow(a) % side)))
                    .collect();
                let _ = write!(list, "(at: [{}], radius: {RADIUS:e}),", at.join(", "));
            }
            list + "])"
        }
        (Grains::Balls, false) if axes == 2 => {
            let width = (count as f64 / 20.0).ceil() * wide;
            period = format!("periodic: (x: {width:e}),");
            format!(
                "Lattice(material: \"grain\", count: {count}, radius: ({RADIUS:e}, {RADIUS:e}), low: [0.0, 0.0], high: [{width:e}, {:e}])",
                25.0 * wide
            )
        }
        (Grains::Balls, false) => {
            let side = (count as f64 / 10.0).sqrt().ceil() * wide;
            period = format!("periodic: (x: {side:e}, y: {side:e}),");
            format!(
                "Lattice(material: \"grain\", count: {count}, radius: ({RADIUS:e}, {RADIUS:e}), low: [0.0, 0.0, 0.0], high: [{side:e}, {side:e}, {:e}])",
                12.0 * wide
            )
        }
        (Grains::Bricks, _) => {
            let gap = if apart { 3.0 * RADIUS } else { 0.0 };
            let thick = if axes == 2 { "" } else { "thickness: 2e-3," };
            // Above the floor if they do not lie on it.
            let at = up.replace("1.0", &format!("{gap:e}"));
            format!(
                "BlockWall(material: \"grain\", rows: 20, columns: {}, block: (4e-3, 2e-3), {thick} gap: {gap:e}, at: [{at}])",
                count / 20
            )
        }
    };
    format!(
        r#"(
    name: "memory", dimension: {}, time: (step: 1e-4, end: 1.0), gravity: [{gravity}], {period}
    solver: (max_iterations: 60),
    materials: {{"grain": "glass_bead"}},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": 0.3}}))],
    bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [{up}])])],
    grains: [{list}],
)"#,
        S::D
    )
}

fn measure<S: Space>(
    grains: Grains,
    count: usize,
    apart: bool,
    sets: &[&str],
) -> Result<Held, Box<dyn std::error::Error>> {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let before = held();
    let mut s: Simulation<S> = {
        let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
        let text = case::<S>(grains, count, apart);
        let loaded = load_text("memory.ron", &text, &cases, &sets)?;
        loaded.build_in::<S>(&search_path())?
    };
    for _ in 0..STEPS {
        s.step()?;
    }
    let live = held() - before;
    let mut step = 0;
    for _ in 0..3 {
        let (done, most) = peak(|| s.step());
        done?;
        step = step.max(most);
    }
    Ok(Held {
        grains: s.state.bodies.len() as f64,
        contacts: s.state.network.contacts.len() as f64,
        live: live as f64,
        step: step as f64,
    })
}

/// Steps before counting, in which one-time allocations are made.
const STEPS: u32 = 10;
