//! The account of grains between first bodies, contact and outside.

use super::trial::{PLANE, refused, with};

/// The case with a bonding law and this circuit.
fn circuit(words: &str) -> String {
    let bonded = with(
        PLANE,
        r#"contact: "coulomb","#,
        r#"contact: "coulomb", cohesion: "elastic-bond","#,
    );
    with(
        &bonded,
        "    friction: (",
        &format!("    circuit: ({words}),\n    friction: ("),
    )
}

#[test]
fn a_base_that_is_no_body() {
    refused(
        &circuit(r#"bases: [‸"flor"]"#),
        &[
            "there is no body `flor`",
            "expected one of floor, lid",
            "floor",
        ],
    );
    refused(&circuit("bases: ‸[]"), &["needs a first body"]);
}

#[test]
fn a_base_without_bonds() {
    let unbonded = with(
        PLANE,
        "    friction: (",
        "    circuit: (bases: [‸\"floor\"]),\n    friction: (",
    );
    refused(&unbonded, &["no grain can belong to it"]);
    refused(
        &circuit(r#"bases: ["floor"], bonds: [‸"grain"]"#),
        &["there is no interface `grain`", "grains"],
    );
}

#[test]
fn zones_that_overlap_or_are_none() {
    let zone = |low: &str, high: &str| {
        format!(
            r#"bases: ["floor"], zones: [(name: "a", low: [0.0, 0.0], high: [0.1, 0.1]), {low}, {high})]"#
        )
    };
    refused(
        &circuit(&zone(
            r#"‸(name: "b", low: [0.05, 0.05]"#,
            "high: [0.2, inf]",
        )),
        &["`b` overlaps `a`"],
    );
    refused(
        &circuit(&zone(r#"(name: "b", low: [0.3, 0.0]"#, "high: ‸[0.2, 0.1]")),
        &["must be above 0.3 along axis 0"],
    );
    refused(
        &circuit(&zone(r#"(name: "b", low: ‸[0.3]"#, "high: [0.4, 0.1]")),
        &["a corner has 2 numbers"],
    );
}

#[test]
fn a_zone_beyond_one_side_of_a_period() {
    let open = r#"bases: ["floor"], zones: [(name: "far", low: [0.01, -inf], high: ‸[inf, inf])]"#;
    refused(
        &circuit(open),
        &["along axis 0, which is periodic", "give both sides"],
    );
}

#[test]
fn an_account_that_never_begins() {
    refused(
        &circuit(r#"bases: ["floor"], start: ‸9.0"#),
        &["must begin within the run"],
    );
}
