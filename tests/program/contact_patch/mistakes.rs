//! Questions that are refused, or answered with a note.

use super::{patch, said};

/// Expects that a question is refused in these words.
fn refused(base: &[&str], arguments: &[&str], words: &str) {
    let output = patch(&[base, arguments].concat());
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
    assert!(text.contains(words), "{arguments:?}: {text}");
}

#[test]
fn wrong_questions_are_refused_with_what_to_change() {
    let base = ["--radius", "1m", "--material", "rail_steel_r260"];
    for (arguments, words) in [
        (&["--load", "75 km"][..], "load: "),
        (&["--load", "7.6t"], "its weight, 74.53 kN"),
        (&["--load", "7,5kN"], "decimal comma; give `7.5kN`"),
        (&["--load", "75", "kN"], "`kN` belongs to no option"),
        (&["--load", "-1N"], "above zero"),
        (&["--load", "1N", "--creepage", "1%"], "give friction"),
        (&["--load", "1N", "--displacement", "1um"], "give friction"),
        (&["--load", "1N/m", "--across", "1m"], "line contact"),
        (&["--load", "1N", "--across=-1m"], "conform"),
        (&["--load", "1N", "--friction", "2..1"], "no range"),
        (
            &["--load", "1N", "--friction", "0.3", "--wear", "1e-4"],
            "give friction and creepage",
        ),
        (
            &["--load", "1N", "--friction-of", "/nowhere"],
            "summary.json",
        ),
        (&["--load", "1N", "--accept", "pressure"], "--friction-of"),
        (&["--load", "1N", "--window", "1m"], "wider than the patch"),
        (&["--load", "1N", "--hardness", "50 HRC"], "HBW or HV"),
        (
            &["--load", "1N", "--hardness", "260"],
            "`260 HBW` or `260 MPa`",
        ),
        (&["--load", "1N", "--yield", "500"], "write `500 MPa`"),
        (&["--load", "1N", "--young", "210"], "write `210 GPa`"),
        (
            &["--load", "1N", "--friction", "0.3", "--creepage", "2"],
            "in per cent write 2 %",
        ),
        (
            &[
                "--load",
                "1N/m",
                "--friction",
                "0.3",
                "--displacement",
                "1um",
            ],
            "line contact",
        ),
    ] {
        refused(&base, arguments, words);
    }
    let rolls = ["--load", "1N", "--friction", "0.3", "--creepage", "2%"];
    for (more, words) in [
        (
            ["--displacement", "1um"],
            "one is of rolling, the other of fretting",
        ),
        (
            ["--wear", "1e-13 1/Pa"],
            "K is k times the hardness, a pure number: 0.000255 with",
        ),
        (["--wear", "1e-13"], "looks like k in 1/Pa"),
    ] {
        refused(&base, &[&rolls[..], &more].concat(), words);
    }
    for (arguments, words) in [
        (
            &["--radius", "1m", "--material", "rail_steel_r26"][..],
            "did you mean `rail_steel_r260`",
        ),
        (
            &["--radius", "1m", "--material", "steel_er7"],
            "did you mean `wheel_steel_er7`",
        ),
        (
            &["--radius", "1m"],
            "material: name the materials of both bodies",
        ),
        (
            &["--radius", "0,46m", "--material", "rail_steel_r260"],
            "write 0.46m",
        ),
    ] {
        refused(&["--load", "1kN"], arguments, words);
    }
    let text = said(&["--help"]);
    assert!(text.contains("A wheel on a rail") && text.contains("--creepage"));
}

/// What is likely to be meant otherwise is answered as it is written, with a note.
#[test]
fn unlikely_questions_are_answered_with_a_note() {
    let steel = ["--load", "75kN", "--material", "rail_steel_r260"];
    let large = said(&[&steel[..], &["--radius", "460,flat"]].concat());
    assert!(
        large.contains("RADIUS IN METRES") && large.contains("460mm"),
        "{large}"
    );
    let speed = ["--radius", "0.46m", "--friction", "0.3", "--speed", "30m/s"];
    let speed = said(&[&steel[..], &speed].concat());
    assert!(speed.contains("SPEED NOT USED"), "{speed}");
    let hard = ["--radius", "0.46m", "--hardness", "260HBW"];
    said(&[&steel[..], &hard].concat());
}
