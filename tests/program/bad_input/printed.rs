//! Printed text: titles without terminal control characters, pairs that pass through each other,
//! paths of laws.

use super::trial::{PLANE, Trial, refusal, with};

#[test]
fn no_text_of_a_user_commands_the_terminal() {
    let bad = "a\\u{1b}[2Jb\\u{9b}31mc\\u{7}\\rd\\u{202e}e";
    // Names of bodies and interfaces cannot contain control characters.
    let titled = PLANE.replace("grains between a floor and a lid", bad);
    let case = titled
        .replace("\"lid\"", &format!("\"{bad}\""))
        .replace("name: \"grains\"", &format!("name: \"{bad}\""));
    let trial = Trial::new();
    trial.write("case.ron", &titled);
    trial.write("named.ron", &case);
    trial.write("wrong.ron", case.replace("along: 0", "along: 4"));
    trial.write(
        "body.ron",
        case.replace(&format!("body: \"{bad}\""), "body: \"x\\u{1b}[31m\""),
    );
    for arguments in [
        &["run", "case.ron"][..],
        &["run", "case.ron", "--json"],
        &["run", "case.ron", "--resume"],
        &["check", "case.ron"],
        &["check", "named.ron"],
        &["run", "named.ron"],
        &["run", "wrong.ron"],
        &["run", "body.ron"],
        &["run", "case.ron", "--set", "name=\u{1b}[2J"],
        &["run", "case.ron", "--set", "bodies.\u{1b}[2J.mass=1"],
        &["run", "\u{1b}[2J.ron"],
    ] {
        let output = trial.call(arguments);
        for stream in [&output.stdout, &output.stderr] {
            let text = String::from_utf8_lossy(stream);
            let commands = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
            let found = text.chars().find(|c| commands(*c));
            assert_eq!(found, None, "{arguments:?}: {text:?}");
        }
    }
    let output = trial.call(&["run", "case.ron", "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["case"], "a\u{1b}[2Jb\u{9b}31mc\u{7}\rd\u{202e}e");
}

#[test]
fn a_run_tells_of_materials_that_pass_through_each_other() {
    let two = with(
        PLANE,
        r#"{"grain": "stone"}"#,
        r#"{"grain": "stone", "wall": "stone"}"#,
    );
    let trial = Trial::new();
    trial.write(
        "case.ron",
        with(
            &two,
            r#"name: "floor", material: "grain""#,
            r#"name: "floor", material: "wall""#,
        ),
    );
    for (command, words) in [
        (
            "check",
            "no interface: grain and wall: they pass through each other",
        ),
        (
            "run",
            "no interface: grain and wall: they pass through each other",
        ),
    ] {
        let output = trial.call(&[command, "case.ron"]);
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn numbers_of_the_command_line() {
    let trial = Trial::new();
    trial.write("case.ron", PLANE);
    for option in ["--unconverged", "--residual"] {
        for value in ["NaN", "inf", "-0.1", "1e400", "much"] {
            refusal(
                &trial.call(&["trade", "case.ron", &format!("{option}={value}")]),
                &[option, "a number from 0"],
            );
        }
    }
    refusal(
        &trial.call(&["trade", "case.ron", "--unconverged=1.5"]),
        &["from 0 to 1"],
    );
    for value in ["NaN", "NaNs", "-5m", "-5m10m", "inf", "0", "1e400s"] {
        refusal(
            &trial.call(&["trade", "case.ron", &format!("--budget={value}")]),
            &["is not a time"],
        );
    }
    for (option, value) in [
        ("--output", "friction_coefficient=NaN"),
        ("--output", "friction_coefficient=-1%"),
        ("--output", "friction_coefficient=inf"),
        ("--seeds", "0"),
        ("--jobs", "-1"),
    ] {
        refusal(
            &trial.call(&["trade", "case.ron", &format!("{option}={value}")]),
            &[option],
        );
    }
    for value in ["NaN", "-1", "1e400"] {
        let option = format!("--law-timeout={value}");
        for arguments in [
            &["trade", "case.ron", &option][..],
            &["trade", "case.ron", "--law-timeout", value],
            &["run", "case.ron", "--law-timeout", value],
            &["law", "list", "--law-timeout", value],
        ] {
            refusal(
                &trial.call(arguments),
                &["--law-timeout", "give a time in seconds from 0"],
            );
        }
    }
    // A sign is no option: the sentence on the number comes.
    refusal(
        &trial.call(&["trade", "case.ron", "--residual", "-1"]),
        &["--residual", "a number from 0"],
    );
    for option in ["--to", "--rate", "--angle", "--pressure", "--velocities"] {
        for value in ["NaN", "inf", "-1", "1e400"] {
            refusal(
                &trial.call(&["law", "drive", "mac", &format!("{option}={value}")]),
                &[option],
            );
        }
    }
    for option in ["--tolerance", "--time-limit", "--max-iterations"] {
        for value in ["NaN", "inf", "-1", "0"] {
            refusal(
                &trial.call(&["solve", "x.hdf5", &format!("{option}={value}")]),
                &[option],
            );
        }
    }
    for value in ["0", "-1", "1.5", "NaN", "99999999999"] {
        refusal(
            &trial.call(&["run", "case.ron", &format!("--threads={value}")]),
            &["--threads"],
        );
    }
}
