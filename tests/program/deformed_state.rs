//! Deformable grains of another run: a deposit that is sheared in a second case moves as in one
//! run; rigid grains become deformable, and vice versa; mismatches are named.

use super::grains::Folder;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;
use std::process::Command;

/// Time of the deposit and steps after it.
const DEPOSIT: f64 = 0.02;
const STEPS: usize = 200;
const STEP: f64 = 5e-5;

const ELASTIC: &str =
    "elastic_grains: [(material: \"grain\", elements: 2, damping: (mass: 0.0, stiffness: 1e-5))],";
const STATE: &str = r#"State(results: "out", material: "grain")"#;

fn soft(young: &str) -> String {
    format!(
        "(doc: \"soft\", density: (value: 1000.0, unit: \"kg/m^3\", source: \"chosen\"), properties: {{\
         \"young\": (value: {young}, unit: \"Pa\", source: \"chosen\"), \"poisson\": (value: 0.3, source: \"chosen\")}})"
    )
}

/// A ball, and a brick across the border of the period that rotates as it falls.
fn grains<S: Space>() -> String {
    match S::D {
        2 => "List(material: \"grain\", grains: [(at: [0.1, 0.0101], radius: 0.01, spin: [3.0])]), \
              Polygons(material: \"grain\", grains: [(at: [0.1995, 0.0121], angle: 0.2, \
              points: [(-0.01, -0.01), (0.01, -0.01), (0.01, 0.01), (-0.01, 0.01)], velocity: [0.2, -0.2], spin: [-4.0])]),"
            .to_owned(),
        _ => "List(material: \"grain\", grains: [(at: [0.1, 0.0, 0.0101], radius: 0.01, spin: [3.0, 1.0, 2.0])]), \
              Polyhedra(material: \"grain\", grains: [(at: [0.1995, 0.0, 0.0121], size: (0.02, 0.018, 0.02), \
              velocity: [0.2, 0.1, -0.2], spin: [1.0, -3.0, 2.0])]),"
            .to_owned(),
    }
}

/// The grains are on a floor that begins to move along x at a given time.
fn case<S: Space>(grains: &str, elastic: &str, begins: f64) -> String {
    let (up, weight) = match S::D {
        2 => ("0.0, 1.0", "0.0, -9.81"),
        _ => ("0.0, 0.0, 1.0", "0.0, 0.0, -9.81"),
    };
    format!(
        "(name: \"deposit\", dimension: {}, time: (step: {STEP:?}, end: {DEPOSIT:?}, theta: 0.5), gravity: [{weight}], periodic: (x: 0.2),\n\
         detection: (alert: 1e-4, skin: 1e-3), solver: (tolerance: 1e-11, norm: Velocity, max_iterations: 100000),\n\
         materials: {{\"grain\": \"soft\"}},\n\
         interfaces: [(name: \"grains\", between: (\"grain\", \"grain\"), contact: \"coulomb\", parameters: (contact: {{\"mu\": 0.4}}))],\n\
         bodies: [(name: \"floor\", material: \"grain\", shapes: [HalfSpace(normal: [{up}])],\n\
         dofs: (x: Velocity(Ramp(from: 0.0, to: 0.3, start: {begins:?}, end: {:?}))))],\n\
         grains: [{grains}],\n {elastic}\n uncertainty: (repeats: 0),\n output: (frames: 0, views: 2, figures: false))",
        S::D,
        begins + 5e-3,
    )
}

/// A folder with the state of a deposit.
fn deposit<S: Space>(name: &str, elastic: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("materials/soft.ron", &soft("1e6"));
    let path = folder.write("first.ron", &case::<S>(&grains::<S>(), elastic, DEPOSIT));
    let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
        .args(["run".as_ref(), path.as_os_str(), "--out".as_ref()])
        .arg(folder.0.join("out"))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    folder
}

fn built<S: Space>(folder: &Folder, case: &str) -> (Simulation<S>, String) {
    let built = folder.build::<S>(case).unwrap_or_else(|e| panic!("{e}"));
    (built.simulation, built.samples.concat())
}

/// Force of all contacts on the upper bodies (N; N/m in 2D).
fn force<S: Space>(s: &Simulation<S>) -> S::Vector {
    let contacts = s.state.network.contacts.iter();
    contacts.fold(S::Vector::zero(), |sum, c| {
        let up = if c.bodies[1] == 0 { 1.0 } else { -1.0 };
        sum + c.impulse * (up / s.options.scheme.h)
    })
}

/// Positions of the points of all grains, moved near the origin if there is a period.
fn places<S: Space>(s: &Simulation<S>) -> Vec<S::Vector> {
    let mut out = Vec::new();
    for k in 0..s.state.systems.len() {
        let mesh = s.state.systems.get(k).unwrap().deformed_mesh().unwrap();
        out.extend(
            mesh.points
                .iter()
                .zip(&mesh.displacement)
                .map(|(x, u)| *x + *u),
        );
    }
    out
}

fn apart<S: Space>(a: &Simulation<S>, b: &Simulation<S>) -> f64 {
    let (ours, theirs) = (places(a), places(b));
    assert_eq!(ours.len(), theirs.len());
    let pairs = ours.iter().zip(&theirs);
    let off = pairs.map(|(x, y)| a.shapes.periodic.shortest(*x - *y).norm());
    off.fold(0.0, f64::max)
}

fn goes_on<S: Space>(name: &str) {
    let folder = deposit::<S>(name, ELASTIC);
    let (mut one, _) = built::<S>(&folder, &case::<S>(&grains::<S>(), ELASTIC, DEPOSIT));
    for _ in 0..(DEPOSIT / STEP).round() as usize {
        one.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let (mut second, samples) = built::<S>(&folder, &case::<S>(STATE, ELASTIC, 0.0));
    assert!(samples.contains("2 with their deformation"), "{samples}");
    let (kinetic, stored) = second.state.systems.energies();
    let (of_one, stored_of_one) = one.state.systems.energies();
    println!(
        "{}D: kinetic energy {kinetic:e} of {of_one:e} J, strain energy {stored:e} of {stored_of_one:e} J, points off by {:e} m",
        S::D,
        apart(&one, &second)
    );
    assert!(
        (kinetic - of_one).abs() < 1e-9 * of_one
            && (stored - stored_of_one).abs() < 1e-9 * stored_of_one
    );
    assert!(stored > 1e-6 * of_one && apart(&one, &second) < 1e-12);
    let (mut most, mut off) = (0.0f64, 0.0f64);
    for _ in 0..STEPS {
        one.step().unwrap_or_else(|e| panic!("{e}"));
        second.step().unwrap_or_else(|e| panic!("{e}"));
        let forces = (force(&one), force(&second));
        most = most.max(forces.0.norm());
        off = off.max((forces.0 - forces.1).norm());
    }
    println!(
        "{}D: forces up to {most:e} N, off by {off:e} N, points by {:e} m",
        S::D,
        apart(&one, &second)
    );
    assert!(most > 0.1 && off < 1e-6 * most && apart(&one, &second) < 1e-9);
    assert!(second.state.energy.relative_residual() < 1e-9);
}

#[test]
fn a_deposit_of_grains_that_deform_goes_on() {
    goes_on::<Dim2>("deformed-plane");
    goes_on::<Dim3>("deformed-space");
}

#[test]
fn rigid_grains_of_a_deposit_deform_and_the_other_way() {
    let folder = deposit::<Dim2>("deform-later", "");
    let (mut s, _) = built::<Dim2>(&folder, &case::<Dim2>(STATE, ELASTIC, 0.0));
    assert_eq!(s.state.systems.len(), 2);
    assert_eq!(s.state.systems.energies().1, 0.0);
    let (rigid, _) = built::<Dim2>(&folder, &case::<Dim2>(STATE, "", 0.0));
    for (a, b) in s
        .state
        .systems
        .bodies(0)
        .iter()
        .zip(rigid.state.bodies.grains())
    {
        let (soft, hard) = (&s.state.bodies, &rigid.state.bodies);
        assert_eq!(soft.position[*a as usize], hard.position[b]);
        assert_eq!(soft.velocity[*a as usize], hard.velocity[b]);
    }
    for _ in 0..STEPS {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    assert!(s.state.systems.energies().1 > 0.0);
    assert!(s.state.energy.relative_residual() < 1e-9);

    let folder = deposit::<Dim2>("rigid-later", ELASTIC);
    let (mut s, samples) = built::<Dim2>(&folder, &case::<Dim2>(STATE, "", 0.0));
    assert!(
        samples.contains("without the deformation of 2"),
        "{samples}"
    );
    assert!(s.state.systems.is_empty() && s.state.bodies.grains().count() == 2);
    for _ in 0..STEPS {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    assert!(s.state.energy.relative_residual() < 1e-9);
}

#[test]
fn a_deformation_that_does_not_fit_is_named() {
    let folder = deposit::<Dim2>("deformed-otherwise", ELASTIC);
    let refused = |elastic: &str, words: &[&str]| {
        let case = case::<Dim2>(STATE, elastic, 0.0);
        let said = folder.build::<Dim2>(&case).map(|_| ()).unwrap_err();
        for word in words {
            assert!(said.contains(word), "{said}");
        }
    };
    let finer = ELASTIC.replace("elements: 2", "elements: 3");
    refused(&finer, &["give `elements` as that run has it", "points"]);
    folder.write("materials/soft.ron", &soft("2e6"));
    refused(ELASTIC, &["`young`", "von Mises"]);
}
