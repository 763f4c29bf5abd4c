//! Every shipped law in turn: its internal variables, bonds and deferred wear continue bit by bit.

use super::common::Folder;
use super::state::goes_on;
use crate::scene::tables;
use fretwork::AnySimulation;
use fretwork::laws::Kind;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork_abi::FLAG_TEMPERATURE;

/// A row of balls is moved to and fro on another row, with loose balls on it; x is along the rows.
fn case(dimension: usize, laws: &str, heated: bool) -> String {
    let (material, heat) = match heated {
        false => ("verification_grain", ""),
        true => (
            "verification_steel",
            "heat: (bodies: {\"above\": (store: Lumped(capacity: 1e3))}, flash: 1e9, every: 2, \
             circuit: (from: \"above\", to: \"below\", supply: Voltage(1e-2))),",
        ),
    };
    let up = |x: f64, y: f64| match dimension {
        2 => format!("[{x:.2}, {y:.2}]"),
        _ => format!("[{x:.2}, 0.0, {y:.2}]"),
    };
    let balls = (0..5).map(|k| format!("({}, 1.0)", up(2.0 * f64::from(k), 0.0)));
    let row = balls.collect::<Vec<_>>().join(", ");
    let (axis, low, high) = match dimension {
        2 => ("y", "[0.0, 3.5]", "[8.0, 8.0]"),
        _ => ("z", "[0.0, -1.0, 3.5]", "[8.0, 1.0, 8.0]"),
    };
    format!(
        r#"(
    name: "a row over a row", dimension: {dimension}, seed: 3, time: (step: 2e-5, end: 1.0), gravity: {},
    materials: {{"grain": "{material}"}}, {heat}
    solver: (tolerance: 1e-8, norm: Velocity),
    detection: (alert: 2e-2, skin: 0.1),
    interfaces: [(name: "grain", between: ("grain", "grain"), {laws})],
    bodies: [
        (name: "below", material: "grain", shapes: [Balls([{row}])]),
        (
            name: "above", material: "grain", position: {}, mass: 1e4, inertia: 1e4, shapes: [Balls([{row}])],
            dofs: (x: Velocity(Sine(amplitude: 1.0, frequency: 400.0)), {axis}: Force(Constant(-1e5))),
        ),
    ],
    grains: [Lattice(material: "grain", count: 12, radius: (0.4, 0.6), low: {low}, high: {high})],
)"#,
        up(0.0, -9.81),
        up(0.4, 1.96),
    )
}

/// Resumes a run with a law in a dimension; returns whether the law supports it.
fn goes_on_with(kind: Kind, name: &str, dimension: usize) -> bool {
    let bond = "contact: \"coulomb\", cohesion: \"elastic-bond\"";
    let plugin = search_path().find(kind, name);
    let plugin = plugin.unwrap_or_else(|e| panic!("{e}"));
    let heated = kind == Kind::TRANSPORT || plugin.flags & FLAG_TEMPERATURE != 0;
    let conducts = if heated {
        ", transport: \"oxide-film\""
    } else {
        ""
    };
    let folder = Folder::new(&format!("law-{kind}-{name}-{dimension}"));
    std::fs::create_dir_all(&folder.0).unwrap();
    let tables = tables(&plugin, &folder.0);
    let laws = match kind.word() {
        // The material has no moduli.
        "contact" if name == "hertz-mindlin" => {
            let young = ["young_1", "young_2"].map(|p| format!("\"{p}\": 1e9"));
            let poisson = ["poisson_1", "poisson_2"].map(|p| format!("\"{p}\": 0.3"));
            let all = [young, poisson].concat().join(", ");
            format!("contact: \"{name}\", parameters: (contact: {{{all}}})")
        }
        "contact" => format!("contact: \"{name}\"{conducts}{tables}"),
        "cohesion" => format!("contact: \"coulomb\", cohesion: \"{name}\""),
        "damage" => format!("{bond}, damage: \"{name}\"{conducts}"),
        "wear" => {
            format!("{bond}, damage: \"linear-softening\", wear: \"{name}\"{conducts}{tables}")
        }
        _ => format!("{bond}, damage: \"linear-softening\", transport: \"{name}\""),
    };
    let file = folder.0.join("case.ron");
    std::fs::write(&file, case(dimension, &laws, heated)).unwrap();
    let loaded = load(&file, &[]).unwrap_or_else(|e| panic!("{kind} {name}: {e}"));
    let built = || loaded.build(&search_path()).map(|built| built.simulation);
    match [built(), built()] {
        [Ok(AnySimulation::Plane(a)), Ok(AnySimulation::Plane(b))] => goes_on([*a, *b], 70, 70),
        [Ok(AnySimulation::Space(a)), Ok(AnySimulation::Space(b))] => goes_on([*a, *b], 70, 70),
        [Err(e), _] if e.to_string().contains("dimensions only") => return false,
        [Err(e), _] => panic!("{kind} {name}: {e}"),
        _ => panic!("{kind} {name}: built once in two ways"),
    }
    true
}

#[test]
fn every_law_goes_on_with_the_same_bits() {
    let laws = search_path().laws();
    assert!(laws.len() >= 36, "{} laws", laws.len());
    for (kind, name, _) in laws {
        let served = [2, 3].map(|d| goes_on_with(kind, &name, d));
        assert!(served.contains(&true), "{kind} {name} serves no dimension");
    }
}
