//! Invalid profiles, and surfaces that nothing can wear.

use super::trial::{PLANE, SOLID, Trial, refused, with};

const FLOOR: &str =
    r#"(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])])"#;

/// The 2D case with another floor.
fn floor(text: &str) -> String {
    with(PLANE, FLOOR, text)
}

fn profile(points: &str) -> String {
    floor(&format!(
        r#"(name: "floor", material: "grain", shapes: [‸Profile(points: {points}, side: Below)])"#
    ))
}

/// A wear law for the interface of the case.
fn law(case: &str, contact: &str, wear: &str) -> String {
    with(
        case,
        r#"contact: "coulomb","#,
        &format!(r#"contact: "{contact}", wear: {wear},"#),
    )
}

const WEARS: &str = r#"(name: "floor", material: "grain", shapes: [Profile(points: [(0.0, 0.0), (0.2, 0.0), (0.4, 0.0)], side: Below)], wears: ‸(thickness: 1e-3))"#;

#[test]
fn a_profile_that_crosses_itself() {
    refused(
        &profile("[(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.1, 0.1), (0.1, -0.1), (0.4, -0.1)]"),
        &[
            "crosses itself at (1.000000e-1, 0.000000e0) m",
            "the segment after point 0 meets the one after point 3",
        ],
    );
    refused(
        &profile("[(0.0, 0.0), (0.0, 0.2), (0.0, 0.1), (0.4, 0.1)]"),
        &["crosses itself"],
    );
}

#[test]
fn a_profile_that_goes_back() {
    refused(
        &profile("[(0.0, 0.0), (0.3, 0.0), (0.2, 0.1), (0.4, 0.1)]"),
        &["from left to right", "point 2 at x = 2e-1 m"],
    );
}

#[test]
fn a_profile_from_a_file() {
    let case = |fields: &str| {
        floor(&format!(
            r#"(name: "floor", material: "grain", shapes: [Profile({fields}, side: Below)])"#
        ))
    };
    refused(
        &case(r#"points: [(0.0, 0.0), (0.4, 0.0)], file: ‸"p.csv""#),
        &["by `points` or by a `file`, not by both"],
    );
    let trial = Trial::new();
    let missing = trial.write("case.ron", case(r#"file: "nowhere.csv""#));
    trial.refuses(&missing, &[], &["nowhere.csv"]);
    for (table, says) in [
        ("x,y\n0,0\n", "unknown column `y`"),
        ("x [kg],z\n0,0\n", "`kg` is not a unit of length"),
        ("x,z\n0,0\n0,0\n0.4,0\n", "equals the one before it"),
        ("x,z\n0,0\nhalf,0\n", "`half` of `x` is not a number"),
    ] {
        trial.write("p.csv", table);
        let case = trial.write("case.ron", case(r#"file: "p.csv""#));
        trial.refuses(&case, &[], &[says, "p.csv"]);
    }
}

#[test]
fn standard_profiles_with_fields_that_they_lack() {
    let case = |fields: &str| {
        floor(&format!(
            r#"(name: "floor", material: "grain", shapes: [StandardProfile({fields})])"#
        ))
    };
    refused(&case("name: ‸Rail60E2"), &["Rail60E1"]);
    refused(
        &case("name: S1002, from: ‸-0.08"),
        &["from -0.070000 to 0.060000 m"],
    );
    refused(
        &case("name: S1002, inclination: ‸40.0"),
        &["incline the rail"],
    );
    refused(&case("name: Rail60E1, inclination: ‸2.0"), &["at least 10"]);
    refused(&case("name: Rail60E1, spacing: ‸0.0"), &["at least 1e-7 m"]);
}

#[test]
fn wear_that_cannot_be() {
    let archard = |floor_text: &str| law(&floor(floor_text), "coulomb", r#""archard""#);
    refused(
        &archard(
            r#"(name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])], wears: ‸(thickness: 1e-3))"#,
        ),
        &[
            "no shape of the body `floor` can wear",
            "a Profile, RoughProfile or StandardProfile",
        ],
    );
    refused(
        &floor(WEARS),
        &[
            "no interface of the material `grain` has a wear law",
            "leave `wears` out",
        ],
    );
    refused(
        &archard(&WEARS.replace("‸(thickness: 1e-3)", "(thickness: ‸0.0)")),
        &["a thickness must be positive"],
    );
    refused(
        &archard(&WEARS.replace("‸(thickness: 1e-3)", "(thickness: 1e-3, every: ‸0)")),
        &["must be at least 1"],
    );
    refused(
        &archard(&WEARS.replace("(0.2, 0.0)", "(0.2, 0.0), (0.2, -0.1)")),
        &["is vertical between points 1 and 2"],
    );
    let field = "rms: 1e-4)]),";
    let drum = with(SOLID, field, "rms: 1e-4), ], wears: ‸(thickness: 1e-3)),");
    refused(
        &drum,
        &["no interface of the material `grain` has a wear law"],
    );
}

#[test]
fn wear_laws_that_find_no_slip_or_no_friction() {
    let smooth = WEARS.replace('‸', "");
    for wear in ["dissipated-energy", "t-gamma"] {
        let case = law(&floor(&smooth), "frictionless", &format!(r#"‸"{wear}""#));
        let case = case.replace(r#"parameters: (contact: {"mu": 0.3}),"#, "");
        refused(
            &case,
            &[
                "takes its volume from the work of friction",
                "`frictionless` leaves none",
            ],
        );
    }
    // The lid has the floor's material too; it is held, and there are no grains.
    let case = r#"(
    name: "held",
    dimension: 2,
    time: (step: 1e-3, end: 0.002),
    materials: {"grain": "stone"},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "coulomb", wear: "archard")],
    bodies: [
        (name: "floor", material: "grain", shapes: [Profile(points: [(0.0, 0.0), (0.4, 0.0)], side: Below)], wears: ‸(thickness: 1e-3)),
        (name: "block", material: "grain", shapes: [Balls([([0.0, 0.0], 0.1)])], position: [0.2, 0.1]),
    ],
    output: (frames: 0, views: 0, figures: false),
)"#;
    refused(case, &["nothing slips on the body `floor`"]);
}
