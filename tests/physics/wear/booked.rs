//! To which bodies wear is booked, and with which hardness and rate.

use crate::scene;
use fretwork::record::Summary;

fn text(summary: &Summary) -> String {
    let text = summary.text(true);
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Balls on a block have no surface: what wears is theirs, with the k of the law over the load of
/// both contacts, and not that of grains, of which there are none.
#[test]
fn what_wears_without_a_surface_is_of_the_bodies() {
    let sets = [
        "output.figures=false",
        "interfaces.grain.wear=archard",
        "interfaces.grain.parameters.wear={\"k\": 1e-13}",
    ];
    let found = scene::ran("verification/two_sided_friction", &sets, |_| {});
    let rate = found.found.number("wear.rate_third_body").unwrap();
    assert!((rate / 1e-13 - 1.0).abs() < 0.02, "{rate}");
    let said = text(&found);
    assert!(
        said.contains("wear of below, above, strip together"),
        "{said}"
    );
    assert!(!said.contains("between grains"), "{said}");
}

/// The softer of two materials gives H; where the other body has the surface, the run says so.
#[test]
fn wear_of_the_body_with_the_surface_names_a_softer_counterpart() {
    let booked = "booked to it as the body with the surface, though its counterpart is softer";
    for (disc, pin, softer) in [
        ("rail_steel_r260", "wheel_steel_er7", true),
        ("wheel_steel_er7", "rail_steel_r260", false),
    ] {
        let materials = format!("materials={{\"disc\": \"{disc}\", \"pin\": \"{pin}\"}}");
        let sets = [
            "output.figures=false",
            "output.frames=0",
            "interfaces.steel.between=(\"disc\", \"pin\")",
            "bodies.disc.material=disc",
            "bodies.pin.material=pin",
            &materials,
        ];
        let found = scene::ran("verification/pin_on_disc", &sets, |_| {});
        let said = text(&found);
        assert!(said.contains("(H 235 HBW of wheel_steel_er7)"), "{said}");
        assert_eq!(said.contains(booked), softer, "{said}");
    }
}
