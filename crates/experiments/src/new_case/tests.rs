//! Files are made for every geometry, are read as they are meant, and wrong answers are corrected.

use super::*;
use crate::patch::PatchFile;
use crate::patch::fretting::strokes;
use crate::patch::rolling::creepages;
use crate::patch::tests::laws;
use fretwork_scene::load_text;
use std::path::Path;

fn ball() -> Question {
    Question::new(Geometry::SphereOnFlat)
        .with("material", "rail_steel_r260")
        .with("radius", "10mm")
        .with("load", "50 N")
        .with("amplitude", "20 um")
}

fn wheel() -> Question {
    Question::new(Geometry::WheelOnRail)
        .with("material", "wheel_steel_er7,rail_steel_r260")
        .with("radius", "0.46m")
        .with("load", "75kN")
        .with("speed", "100km/h")
        .with("creepage", "0.5%")
}

#[test]
fn what_is_missing_or_does_not_belong_is_named() {
    let keys = |question: &Question| question.missing().map(|i| i.key).collect::<Vec<_>>();
    assert_eq!(
        keys(&Question::new(Geometry::SphereOnFlat)),
        ["material", "radius", "load", "amplitude"]
    );
    assert_eq!(keys(&ball().with("debris", "magnetite")), ["debris-size"]);
    assert_eq!(keys(&ball()), [""; 0]);
    for (question, words) in [
        (
            Question::new(Geometry::Window),
            "material: give the materials",
        ),
        (
            ball().with("creepage", "1%"),
            "creepage: a sphere-on-flat has none; it has",
        ),
        (
            ball().with("debris-size", "1um"),
            "debris-size: a sphere-on-flat has none without `debris`",
        ),
        (ball().with("load", "200 N/mm"), "load: "),
        (
            ball().with("load", "-5 N"),
            "load: `-5 N` must be above zero",
        ),
        (
            ball().with("material", "rail_steel_r26"),
            "did you mean `rail_steel_r260`?",
        ),
        (ball().with("wear", "3"), "wear: K = 3 is above 1"),
        (
            ball().with("wear", "1e-15"),
            "a pure number: 2.55e-6 with 2.550 GPa; with its unit, `1e-15 1/Pa`, it is taken as k",
        ),
        (
            ball().with("wear", "1e-4 1/Pa"),
            "a K is written without a unit",
        ),
        (
            ball().with("radius", "10"),
            "radius: `10` has no unit; write `10 mm`, or `10 m`",
        ),
        (
            ball().with("load", "50"),
            "load: `50` has no unit; write `50 N`",
        ),
        (
            ball().with("friction", "60"),
            "friction: no pair of solids has a friction coefficient of 60",
        ),
        (
            ball().with("amplitude", "1e-12 m"),
            "amplitude: 1 pm is 0.0040 of the distance of atoms",
        ),
        (
            ball()
                .with("load", "1 MN")
                .with("radius", "10 m")
                .with("amplitude", "5nm"),
            "next to nothing of it slips; take",
        ),
        (
            ball().with("debris", "magnetit").with("debris-size", "1um"),
            "debris: there is no file `magnetit.ron`",
        ),
        (
            wheel().with("creepage", "60 %"),
            "creepage: a creepage of 0.6 is more than 0.5",
        ),
        (wheel().with("creepage", "2"), "in per cent write 2 %"),
        (wheel().with("creepage", "0.5"), "Write `0.5%`, or `50%`"),
        (
            wheel().with("rail-radius", "300"),
            "rail-radius: `300` has no unit; write `300 mm`, or `300 m`",
        ),
        (
            ball()
                .with("debris", "magnetite")
                .with("debris-size", "1um")
                .with("amplitude", "0.1um"),
            "the middle of the contact sticks",
        ),
        (
            ball()
                .with("debris", "magnetite")
                .with("debris-size", "1mm"),
            "debris-size: 20 grains are wider than the contact",
        ),
        (
            ball()
                .with("debris", "magnetite")
                .with("debris-size", "1nm"),
            "take fewer cycles, a smaller amplitude or larger grains",
        ),
    ] {
        let error = question.make(&laws()).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn the_window_of_a_ball_has_its_pressure_slip_and_inertia() {
    let question = ball()
        .with("debris", "magnetite")
        .with("debris-size", "1 um");
    let made = question.make(&laws()).unwrap();
    let loaded = load_text("new.ron", &made.text, Path::new(""), &[]).unwrap();
    loaded.build(&laws()).unwrap();
    let case = &loaded.case;
    // Hertz: E* 115.38 GPa, a = (3 P R/(4 E*))^(1/3), p0 = 3 P/(2 pi a^2).
    let modulus = 210e9 / (2.0 * (1.0 - 0.3f64.powi(2)));
    let a = (3.0 * 50.0 * 0.01 / (4.0 * modulus)).cbrt();
    let p0 = 3.0 * 50.0 / (2.0 * std::f64::consts::PI * a * a);
    let length = case.periodic.x.unwrap();
    assert!(length <= 0.2 * a + 1e-12, "{length} of {a}");
    let text = &made.text;
    assert!(text.contains(&q(p0, "Pa")), "{text}");
    // Mindlin: delta* = 3 mu P (2 - nu)/(8 G a).
    let shear = 210e9 / 2.6;
    let onset = 3.0 * 0.6 * 50.0 * 1.7 / (8.0 * shear * a);
    assert!(
        text.contains(&format!("amplitude: {}", q(20e-6 - onset, "m"))),
        "{text}"
    );
    // I = v d/h sqrt(rho/P) at the largest velocity is what the comment says.
    let velocity = 2.0 * std::f64::consts::PI * 20.0 * (20e-6 - onset);
    let height = 0.83 * 8.0 * 1e-6;
    let scaled = 5170.0 * case.inertia_scaling;
    let inertial = velocity * 1e-6 / height * (scaled / p0).sqrt();
    assert!((inertial / 5e-3 - 1.0).abs() < 1e-2, "{inertial}");
}

#[test]
fn elastic_bodies_without_debris_make_a_patch() {
    let cylinder = Question::new(Geometry::CylinderOnFlat)
        .with("material", "rail_steel_r260")
        .with("radius", "10mm")
        .with("length", "10mm")
        .with("load", "200N/mm")
        .with("amplitude", "20um")
        .with("wear", "1e-14 1/Pa");
    let fast = wheel().with("creepage", "30 %");
    for (question, points) in [(ball(), 3), (wheel(), 5), (fast, 4), (cylinder, 3)] {
        let made = question.make(&laws()).unwrap();
        assert_eq!(made.made, Made::Patch);
        let folder = std::env::temp_dir().join(format!("fretwork-new-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("new.ron");
        std::fs::write(&path, &made.text).unwrap();
        let file = PatchFile::read(&path).unwrap_or_else(|e| panic!("{e}\n{}", made.text));
        let (creepages, strokes) = (creepages(&file).unwrap(), strokes(&file).unwrap().1);
        assert_eq!(creepages.len() + strokes.len(), points);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn every_line_fits_a_page() {
    let pad = Question::new(Geometry::FlatOnFlat)
        .with("material", "rail_steel_r260")
        .with("area", "25 mm^2")
        .with("load", "100 N")
        .with("amplitude", "50 um")
        .with("debris", "rail_steel_r260")
        .with("debris-size", "5 um");
    let text = pad.make(&laws()).unwrap().text;
    for line in text.lines().filter(|l| l.trim_start().starts_with("//")) {
        assert!(line.chars().count() <= 100, "{line}");
    }
}
