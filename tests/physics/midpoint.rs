//! Damage coupled at the midpoint of a step: laws with internal variables, and bonds that rotate.

use crate::scene;
use fretwork::geometry::space::Dim2;

/// State of a bond: damage, internal variables, and the energy that it released (J/m).
#[derive(Debug, PartialEq)]
struct Left {
    damage: f64,
    variables: Vec<f64>,
    released: f64,
}

/// The bond of the verification cases between disks of radius 1 m, the upper of which has an
/// imposed motion, after `steps` steps of 20 ms in total.
fn moved(dofs: &str, laws: &[&str], coupling: &str, steps: u32) -> Left {
    let mut sets = vec![
        format!("bodies.1.dofs={dofs}"),
        format!("time.step={:e}", 0.02 / f64::from(steps)),
        "time.end=0.02".to_owned(),
        format!("coupling={coupling}"),
    ];
    sets.extend(laws.iter().map(|l| format!("interfaces.grain.{l}")));
    let loaded = scene::loaded("verification/bond_mode_1", &sets);
    let mut s = scene::simulation::<Dim2>(&loaded);
    for _ in 0..steps {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let memory = &s.state.network.memory[0];
    assert_eq!(memory.bonds.len(), 1);
    Left {
        damage: memory.bonds[0].damage,
        variables: memory.variables.iter().map(|v| v[0]).collect(),
        released: s.state.energy.fracture,
    }
}

/// Three pulls, each longer than the one before.
const PULLS: &str = "(x: Velocity(Constant(0.0)), rz: Fixed, y: Displacement(Table([(0.0, 0.0), (0.004, 6e-6), (0.008, 1e-6), (0.012, 7e-6), (0.016, 1e-6), (0.02, 8e-6)])))";

/// With imposed openings nothing is left to the coupling: damage and internal variables are those
/// of explicit coupling, to the last bit, so the prediction has no effect on them.
#[test]
fn a_prediction_leaves_no_trace_in_the_variables_of_a_law() {
    let elastic = [
        "cohesion=elastic-bond",
        "parameters.cohesion={\"k_n\": 1e12, \"k_t\": 1e12}",
    ];
    let damaging = [
        (
            "nguyen",
            "{\"strength\": 1e7, \"energy\": 5e2, \"length\": 2e-5}",
        ),
        (
            "roe-siegmund",
            "{\"strength\": 1e7, \"energy\": 5e2, \"length\": 4e-5, \"endurance\": 0.25}",
        ),
        (
            "exponential-softening",
            "{\"strength\": 1e6, \"energy\": 5.0}",
        ),
    ];
    for (law, parameters) in damaging {
        let remembers = law != "exponential-softening";
        let [damage, parameters] = [
            format!("damage={law}"),
            format!("parameters.damage={parameters}"),
        ];
        let laws = [elastic[0], elastic[1], &damage, &parameters];
        let [explicit, middle] = ["Explicit", "Midpoint"].map(|c| moved(PULLS, &laws, c, 1000));
        assert!(
            explicit.damage > 0.05 && explicit.damage < 1.0,
            "{law}: {explicit:?}"
        );
        assert_eq!(!explicit.variables.is_empty(), remembers, "{law}");
        assert_eq!(
            (middle.damage, &middle.variables),
            (explicit.damage, &explicit.variables),
            "{law}"
        );
        // The released energy differs by the first-order error of explicit coupling.
        assert!(
            middle.released != explicit.released && middle.released > 0.0,
            "{law}: {middle:?}"
        );
    }
}

/// A pull with a rotation: shear, tension and a bending moment of one bond. The released energy
/// converges with the second order of the step, that of explicit coupling with the first.
#[test]
fn what_a_turned_bond_releases_is_of_the_second_order() {
    let dofs =
        "(x: Velocity(Constant(1e-4)), y: Velocity(Constant(2e-4)), rz: Velocity(Constant(3e-4)))";
    let laws = [
        "cohesion=parallel-bond",
        "parameters.cohesion={\"k_n\": 1e12, \"k_t\": 5e11, \"sigma_c\": 1e30, \"tau_c\": 1e30}",
        "damage=exponential-softening",
        "parameters.damage={\"strength\": 1e6, \"energy\": 10.0}",
    ];
    // The reference has a relative second-order error of 1e-9.
    let exact = moved(dofs, &laws, "Midpoint", 20_000).released;
    let error = |coupling: &str, steps: u32| {
        let left = moved(dofs, &laws, coupling, steps);
        assert!(left.damage > 0.3 && left.damage < 1.0, "{left:?}");
        left.released / exact - 1.0
    };
    let steps = [200, 400, 800];
    let [explicit, middle] = ["Explicit", "Midpoint"].map(|c| steps.map(|n| error(c, n)));
    println!("{exact}: {explicit:?} and {middle:?}");
    assert!(
        (explicit[0] / explicit[2] - 4.0).abs() < 0.2,
        "{explicit:?}"
    );
    // The onset of damage lies somewhere in a step, so single ratios scatter about four.
    assert!(middle[0] / middle[2] > 10.0, "{middle:?}");
    assert!(middle[2].abs() < 0.02 * explicit[2].abs(), "{middle:?}");
}
