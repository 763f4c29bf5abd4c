//! Invalid settings of heat in a case.

use super::trial::{PLANE, refused, with};

/// The 2D case with a material that conducts, and these settings of heat.
fn heat(text: &str) -> String {
    let case = with(
        PLANE,
        "\"grain\": \"stone\"",
        "\"grain\": \"verification_steel\"",
    );
    let case = with(
        &case,
        "    bodies: [",
        &format!("    heat: ({text}),\n    bodies: ["),
    );
    with(&case, "parameters_from: \"laws\",", "transport: \"holm\",")
}

#[test]
fn a_material_that_says_nothing_of_heat() {
    let case = with(PLANE, "    bodies: [", "    heat: (),\n    bodies: [");
    let case = with(&case, "\"grain\": \"stone\"", "\"grain\": ‸\"stone\"");
    refused(
        &case,
        &["thermal conductivity of `grain`", "`stone.ron`", "W/(m K)"],
    );
}

#[test]
fn a_law_that_reads_temperatures_without_any() {
    let case = with(
        PLANE,
        "contact: \"coulomb\"",
        "contact: ‸\"thermal-friction\"",
    );
    let case = with(&case, "parameters: (contact: {\"mu\": 0.3}),", "");
    refused(
        &case,
        &["`thermal-friction` reads temperatures", "`heat: ()`"],
    );
}

#[test]
fn bodies_that_are_not_there_or_have_no_ends() {
    refused(
        &heat("bodies: {\"flor\": ‸(store: Insulated)}"),
        &["no first body `flor`", "did you mean `floor`?"],
    );
    refused(
        &heat("bodies: {\"floor\": (store: ‸Lumped())}"),
        &["its volume is not known", "Lumped(capacity: 1.0)"],
    );
    refused(
        &with(
            &heat("bodies: {\"floor\": (store: ‸HalfSpace(x: 4))}"),
            "    periodic: (x: 0.4),\n",
            "",
        ),
        &["a plane has no ends", "over: ["],
    );
    refused(
        &heat("bodies: {\"floor\": (store: ‸HalfSpace())}"),
        &["divided along one axis", "HalfSpace(x: 40)"],
    );
    refused(
        &heat("bodies: {\"floor\": ‸(store: Insulated, power: 2.0)}"),
        &["is insulated"],
    );
    refused(
        &heat("bodies: {\"floor\": ‸(power: 2.0)}"),
        &["keeps its temperature", "`store: Lumped()`"],
    );
}

#[test]
fn numbers_that_cannot_be() {
    refused(&heat("initial: ‸-3.0"), &["in kelvin and not below zero"]);
    refused(&heat("shares: (friction: ‸1.5)"), &["from 0 to 1"]);
    refused(&heat("every: ‸0"), &["must be at least 1"]);
    refused(&heat("theta: ‸0.2"), &["between 0.5 and 1"]);
    refused(&heat("clock: ‸0.0"), &["above zero"]);
}

#[test]
fn a_circuit_that_is_none() {
    let supply = "supply: Voltage(1.0)";
    refused(
        &heat(&format!(
            "circuit: (from: \"floor\", to: ‸\"floor\", {supply})"
        )),
        &["enters and leaves the same body"],
    );
    let open = with(
        &heat(&format!(
            "circuit: ‸(from: \"floor\", to: \"lid\", {supply})"
        )),
        "transport: \"holm\",",
        "",
    );
    refused(&open, &["no current can flow"]);
}

#[test]
fn bodies_that_cannot_expand() {
    // The material has all properties for heat except its expansion.
    let oxide = with(&heat("expansion: true"), "_steel\"", "_oxide\"");
    refused(
        &with(&oxide, "\"grain\": \"", "\"grain\": ‸\""),
        &["coefficient of linear expansion of `grain`", "1/K"],
    );
    // A row of balls over the whole period, which would have to become longer.
    let row = heat("expansion: true, bodies: {\"floor\": (store: ‸Lumped())}");
    let balls =
        "shapes: [Balls([([0.05, -0.05], 0.05), ([0.15, -0.05], 0.05), ([0.25, -0.05], 0.05)])]";
    refused(
        &with(&row, "shapes: [HalfSpace(normal: [0.0, 1.0])]", balls),
        &["more than half of the period", "`Fixed`"],
    );
    // The grains deform.
    let soft = with(
        &heat("expansion: ‸true"),
        "    output: (",
        "    elastic_grains: [(material: \"grain\")],\n    output: (",
    );
    refused(&soft, &["grains that deform do not expand", "rigid grains"]);
    // Walls alone do not expand.
    let case = with(
        &heat("expansion: ‸true"),
        "periodic: (x: 0.4),",
        "detection: (alert: 1e-3, skin: 1e-3),",
    );
    let first = case.find("    grains: [").expect("grains");
    let last = case.find("    friction: (").expect("friction");
    let walls = format!("{}    grains: [],\n{}", &case[..first], &case[last..]);
    refused(&walls, &["no body of the case expands", "`Lumped`"]);
}
