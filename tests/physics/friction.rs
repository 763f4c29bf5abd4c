//! The friction coefficient is that of sliding, whatever moves, and wear is per distance of slip.

use crate::scene;
use fretwork::record::Summary;

fn ran(case: &str, sets: &[&str]) -> Summary {
    let sets = [&["output.figures=false", "output.frames=0"], sets].concat();
    scene::ran(case, &sets, |_| {})
}

fn number(summary: &Summary, name: &str) -> f64 {
    let found = summary.found.number(name);
    found.unwrap_or_else(|| panic!("no {name}"))
}

/// mu 0.4, P 10 N, r 10 mm, omega 2 pi rad/s: a path of 62.83 mm a turn, V = k P s.
#[test]
fn a_pin_on_a_turning_disc_has_the_friction_and_wear_of_its_contact() {
    let path = 2.0 * std::f64::consts::TAU * 0.01;
    for body in ["pin", "disc"] {
        let of = format!("friction.body={body}");
        let found = ran("verification/pin_on_disc", &[&of]);
        let near = |name: &str, expected: f64| {
            let got = number(&found, name);
            assert!((got / expected - 1.0).abs() < 5e-3, "{body}: {name} {got}");
        };
        near("friction_coefficient", 0.4);
        near("energetic_coefficient", 0.4);
        near("friction_from_dissipation", 0.4);
        near("wear.load_path", 10.0 * path);
        near("wear.volume_first_bodies", 1e-13 * 10.0 * path);
        // K = k H with the nominal 260 HBW.
        let worn = |k: usize, name: &str| found.found.number(&format!("wear.bodies.{k}.{name}"));
        let hardness = 260.0 * 9.80665e6;
        let (rates, coefficients): (Vec<f64>, Vec<f64>) = (0..2)
            .filter_map(|k| Some((worn(k, "specific_rate")?, worn(k, "archard_coefficient")?)))
            .unzip();
        assert!(!rates.is_empty());
        for (k, coefficient) in rates.iter().zip(coefficients) {
            assert!((coefficient / (k * hardness) - 1.0).abs() < 1e-9);
        }
        assert!(
            (rates.iter().sum::<f64>() / 1e-13 - 1.0).abs() < 5e-3,
            "{rates:?}"
        );
    }
}

/// Q and P of both contacts add up, and it does not matter which of the bodies moves.
#[test]
fn a_strip_between_two_blocks_has_the_load_of_both() {
    let still = "bodies.strip.dofs.x=Fixed";
    let moving = ["below", "above"].map(|b| format!("bodies.{b}.dofs.x=Velocity(Constant(-0.7))"));
    let moves = [still, &moving[0], &moving[1]];
    for sets in [&[] as &[&str], &moves] {
        let found = ran("verification/two_sided_friction", sets);
        for (name, expected) in [
            ("friction_coefficient", 0.3),
            ("friction_from_dissipation", 0.3),
            ("cycles.0.normal_force", 200.0),
            ("cycles.0.tangential_amplitude", 60.0),
            ("wear.load_path", 200.0 * 0.7 * 0.2),
        ] {
            let got = number(&found, name);
            assert!(
                (got / expected - 1.0).abs() < 0.02,
                "{sets:?}: {name} {got}"
            );
        }
    }
}

/// A sphere in partial slip has no coefficient of sliding, and beyond it, from a stroke of +-1.468
/// um, that of the law, mu 0.6, for any stroke.
#[test]
fn partial_slip_has_no_coefficient_of_sliding() {
    let with = |amplitude: &str| {
        let drive = format!(
            "half_spaces.1.dofs.x=Displacement(Sine(amplitude:{amplitude},frequency:20.0,start:0.01))"
        );
        ran("sphere_on_flat_fretting", &[&drive])
    };
    let stuck = with("5e-7");
    assert_eq!(stuck.found.number("friction_coefficient"), None);
    assert!(number(&stuck, "peak_friction") < 0.6);
    assert!(number(&stuck, "energy_ratio") < 0.2 && number(&stuck, "slip_ratio") < 0.2);
    for amplitude in ["3e-6", "6e-6"] {
        let slides = with(amplitude);
        let mu = number(&slides, "friction_coefficient");
        assert!((mu / 0.6 - 1.0).abs() < 0.01, "{amplitude}: {mu}");
        let energetic = number(&slides, "energetic_coefficient");
        assert!(energetic < 0.9 * mu, "{amplitude}: {energetic}");
    }
}

const COARSE: [&str; 4] = [
    "half_spaces.0.x.size=1.2e-4",
    "half_spaces.0.y.size=1.2e-4",
    "half_spaces.1.x.size=1.2e-4",
    "half_spaces.1.y.size=1.2e-4",
];

/// The specific wear rate is the k of the law for any stroke and number of cycles, though a part of
/// each stroke is elastic, and the first cycle stores elastic energy.
#[test]
fn the_wear_rate_of_an_elastic_contact_is_that_of_its_law() {
    for (amplitude, end) in [("2e-6", "0.11"), ("6e-6", "0.11"), ("2e-6", "0.51")] {
        let drive = format!(
            "half_spaces.1.dofs.x=Displacement(Sine(amplitude:{amplitude},frequency:20.0,start:0.01))"
        );
        let end = format!("time.end={end}");
        let wear = [
            &end,
            "interfaces.contact.wear=archard",
            "interfaces.contact.parameters.wear={\"k\":1e-13}",
            &drive,
        ];
        let found = ran(
            "sphere_on_flat_fretting",
            &[&COARSE[..], &wear[..]].concat(),
        );
        let rate = number(&found, "wear.bodies.0.specific_rate");
        assert!((rate / 1e-13 - 1.0).abs() < 0.01, "{amplitude}: {rate}");
    }
}

/// A stroke of the flat is one of the sphere; a motion to and fro without a known period has no
/// coefficient of sliding.
#[test]
fn the_period_is_that_of_what_moves() {
    let sine = "Displacement(Sine(amplitude:3e-6,frequency:20.0,start:0.01))";
    let flat = format!("half_spaces.0.dofs=(x:{sine})");
    let found = ran(
        "sphere_on_flat_fretting",
        &[&COARSE[..], &[&flat, "half_spaces.1.dofs.x=Fixed"][..]].concat(),
    );
    let mu = number(&found, "friction_coefficient");
    assert!((mu / 0.6 - 1.0).abs() < 0.01, "{mu}");
    assert_eq!(found.found.number("cycles.1.cycle"), Some(2.0));
    let table = "half_spaces.1.dofs.x=Displacement(Table([(0.01,0.0),(0.0225,3e-6),(0.0475,-3e-6),(0.0725,3e-6),(0.0975,-3e-6),(0.11,0.0)]))";
    let found = ran(
        "sphere_on_flat_fretting",
        &[&COARSE[..], &[table][..]].concat(),
    );
    assert_eq!(found.found.number("friction_coefficient"), None);
}

/// A ramp in partial slip has no coefficient of sliding, and no wear rate; one to beyond gross slip
/// (delta* = 1.47 um, by Mindlin) has the mu put in, and the k of its law.
#[test]
fn a_ramp_has_a_coefficient_once_it_slides() {
    let ramp = |to: &str| {
        let x = format!(
            "half_spaces.1.dofs.x=Displacement(Ramp(from:0.0,to:{to},start:0.01,end:0.11))"
        );
        let wear = [
            "interfaces.contact.wear=archard",
            "interfaces.contact.parameters.wear={\"k\":1e-13}",
            &x,
        ];
        let sets = [&COARSE[..], &wear[..]].concat();
        ran("sphere_on_flat_fretting", &sets)
    };
    for to in ["0.5e-6", "1e-6", "1.4e-6"] {
        let found = ramp(to);
        assert_eq!(found.found.number("friction_coefficient"), None, "{to}");
        let rate = found.found.number("wear.bodies.0.specific_rate");
        assert_eq!(rate, None, "{to}");
    }
    for (to, within) in [("3e-6", 0.01), ("1e-5", 1e-3)] {
        let found = ramp(to);
        let mu = number(&found, "friction_coefficient");
        assert!((mu / 0.6 - 1.0).abs() < within, "{to}: {mu}");
        let rate = number(&found, "wear.bodies.0.specific_rate");
        assert!((rate / 1e-13 - 1.0).abs() < 0.04, "{to}: {rate}");
    }
}

/// Two pins on opposite sides of a disc slide in opposite directions. mu is that of each, and each
/// body wears by the k of the law over the path of its own contacts, whichever is tested and
/// whether along its motion or not.
#[test]
fn contacts_that_slide_in_opposite_directions_do_not_cancel() {
    let pin = |name: &str, x: f64| {
        format!(
            "(name: \"{name}\", material: \"steel\", mass: 0.01, position: [{x}, 0.0, 0.003], \
             shapes: [Balls([([0.0, 0.0, 0.0], 0.003)])], dofs: (z: Force(-10.0)))"
        )
    };
    let bodies = format!(
        "bodies=[(name: \"disc\", material: \"steel\", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])], \
         dofs: (rz: Velocity(6.283185307179586))), {}, {}]",
        pin("pin", 0.01),
        pin("other", -0.01)
    );
    for (body, along) in [("disc", "1"), ("pin", "1"), ("pin", "0")] {
        let [of, axis] = [
            format!("friction.body={body}"),
            format!("friction.along={along}"),
        ];
        let found = ran(
            "verification/pin_on_disc",
            &[&bodies, "time.end=0.5", &of, &axis],
        );
        if along == "1" {
            for name in [
                "friction_coefficient",
                "energetic_coefficient",
                "friction_from_dissipation",
            ] {
                let mu = number(&found, name);
                // The ledger has the contacts of the other pin too.
                if body == "disc" || name != "friction_from_dissipation" {
                    assert!((mu / 0.4 - 1.0).abs() < 5e-3, "{body}: {name} {mu}");
                }
            }
        } else {
            assert_eq!(found.found.number("friction_coefficient"), None);
        }
        let rates: Vec<f64> = (0..3)
            .filter_map(|k| {
                found
                    .found
                    .number(&format!("wear.bodies.{k}.specific_rate"))
            })
            .collect();
        assert!(!rates.is_empty());
        for rate in rates {
            assert!((rate / 1e-13 - 1.0).abs() < 5e-3, "{body} {along}: {rate}");
        }
    }
}

/// A free ball on a vibrating plate rolls and is carried: there is no sliding to be in a regime.
#[test]
fn a_free_ball_on_a_vibrating_plate_is_not_in_gross_slip() {
    let bodies = "bodies=[(name: \"plate\", material: \"steel\", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])], \
         dofs: (x: Displacement(Sine(amplitude: 1e-4, frequency: 10.0, start: 0.0)))), \
         (name: \"ball\", material: \"steel\", mass: 0.01, position: [0.01, 0.0, 0.003], \
         shapes: [Balls([([0.0, 0.0, 0.0], 0.003)])], dofs: (x: Free, z: Free))]";
    let sets = [
        bodies,
        "gravity=[0.0,0.0,-9.81]",
        "time.end=0.5",
        "friction.body=plate",
        "friction.along=0",
    ];
    let found = ran("verification/pin_on_disc", &sets);
    assert_eq!(found.found.number("friction_coefficient"), None);
    // In the first cycle the plate starts at once, and the ball slides until it rolls.
    assert_eq!(found.found.text("cycles.4.regime"), Some("partial"));
}

/// Bodies on a disc of the case of a pin on it, which rests or turns by `rz`.
fn on_disc(rz: &str, pins: &[(&str, [f64; 2], &str)]) -> String {
    let pins = pins.iter().map(|(name, [x, y], dofs)| {
        format!(
            "(name: \"{name}\", material: \"steel\", mass: 0.01, position: [{x}, {y}, 0.003], \
             shapes: [Balls([([0.0, 0.0, 0.0], 0.003)])], dofs: ({dofs}))"
        )
    });
    let pins: Vec<String> = pins.collect();
    format!(
        "bodies=[(name: \"disc\", material: \"steel\", shapes: [HalfSpace(normal: [0.0, 0.0, 1.0])], \
         dofs: ({rz})), {}]",
        pins.join(", ")
    )
}

/// Contacts that slide oblique to the axis of the test have the mu put in (0.4): three pins on a
/// disc, a pin between the axes, one that goes in a circle, and one with a ripple on the rotation.
#[test]
fn friction_is_in_the_plane_of_the_contacts() {
    let load = "z: Force(-10.0)";
    let turns = "rz: Velocity(6.283185307179586)";
    let circle = "x: Displacement(Sine(amplitude: 1e-4, frequency: 10.0)), \
                  y: Displacement(Sine(amplitude: 1e-4, frequency: 10.0, phase: 1.5707963)), z: Force(-10.0)";
    let ripple = "y: Displacement(Sine(amplitude: 1e-3, frequency: 10.0)), z: Force(-10.0)";
    let half = 0.75_f64.sqrt() * 0.01;
    let three = [
        ("pin", [0.01, 0.0], load),
        ("second", [-0.005, half], load),
        ("third", [-0.005, -half], load),
    ];
    for (name, bodies, body, along) in [
        ("three pins", on_disc(turns, &three), "disc", "1"),
        (
            "45 degrees",
            on_disc(turns, &[("pin", [0.007, 0.007], load)]),
            "pin",
            "1",
        ),
        (
            "circle",
            on_disc("", &[("pin", [0.0; 2], circle)]),
            "pin",
            "0",
        ),
        (
            "ripple",
            on_disc(turns, &[("pin", [0.01, 0.0], ripple)]),
            "pin",
            "1",
        ),
    ] {
        let [of, axis] = [
            format!("friction.body={body}"),
            format!("friction.along={along}"),
        ];
        let found = ran(
            "verification/pin_on_disc",
            &[&bodies, "time.end=0.5", &of, &axis],
        );
        let mu = number(&found, "friction_coefficient");
        assert!((mu / 0.4 - 1.0).abs() < 0.01, "{name}: {mu}");
        let rates: Vec<f64> = (0..4)
            .filter_map(|k| {
                found
                    .found
                    .number(&format!("wear.bodies.{k}.specific_rate"))
            })
            .collect();
        assert!(!rates.is_empty(), "{name}");
        for rate in rates {
            assert!((rate / 1e-13 - 1.0).abs() < 0.01, "{name}: {rate}");
        }
    }
}

/// Forces below mu P, one way and to and fro: the contact sticks, and neither friction nor wear
/// have a coefficient, whatever rounding moves it by.
#[test]
fn a_contact_that_sticks_has_no_coefficient() {
    for force in ["2.0", "Sine(amplitude: 3.0, frequency: 10.0)"] {
        let dofs = format!("x: Force({force}), z: Force(-10.0)");
        let bodies = on_disc("", &[("pin", [0.0; 2], &dofs)]);
        let sets = [
            &bodies,
            "time.end=0.5",
            "friction.along=0",
            "friction.body=pin",
        ];
        let sets: Vec<&str> = sets.into_iter().collect();
        let found = ran("verification/pin_on_disc", &sets);
        assert_eq!(found.found.number("friction_coefficient"), None, "{force}");
        for k in 0..2 {
            let rate = found
                .found
                .number(&format!("wear.bodies.{k}.specific_rate"));
            assert_eq!(rate, None, "{force}");
        }
    }
}

/// A stroke before the first cycle that counts slips as those of the cycles, partly.
#[test]
fn wear_before_the_start_of_the_test_has_its_path_of_slip() {
    let drive = "half_spaces.1.dofs.x=Displacement(Sine(amplitude:2e-6,frequency:20.0,start:0.01))";
    let wear = [
        "time.end=0.16",
        "friction.start=0.06",
        "interfaces.contact.wear=archard",
        "interfaces.contact.parameters.wear={\"k\":1e-13}",
        drive,
    ];
    let sets = [&COARSE[..], &wear[..]].concat();
    let found = ran("sphere_on_flat_fretting", &sets);
    let rate = number(&found, "wear.bodies.0.specific_rate");
    assert!((rate / 1e-13 - 1.0).abs() < 0.03, "{rate}");
}
