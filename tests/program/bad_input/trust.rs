//! Libraries that others may have placed, that are not those of the case, and that write beyond
//! their columns.

use super::trial::{PLANE, Trial, refusal, with};
use std::path::PathBuf;
use std::process::Output;

/// A trial whose case uses the law `own` in its folder.
pub fn own(fault: &str) -> (Trial, PathBuf) {
    let trial = Trial::new();
    trial.compile_bad_law("own", "0", fault);
    let case = with(PLANE, r#"contact: "coulomb""#, r#"contact: "own""#);
    let case = with(&case, r#"parameters_from: "laws","#, "");
    // The grains touch the floor.
    let case = trial.write("case.ron", case.replace("0.011]", "0.01]"));
    (trial, case)
}

pub fn run(trial: &Trial, more: &[&str]) -> Output {
    let folder = trial.path("");
    let mut words = vec!["run", "case.ron", "--plugin-path", folder.to_str().unwrap()];
    words.extend_from_slice(more);
    trial.call(&words)
}

pub fn says(output: &Output, code: i32, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{said}");
    for word in words {
        assert!(said.contains(word), "`{word}` in: {said}");
    }
}

#[cfg(unix)]
#[test]
fn a_folder_or_library_that_anybody_may_write_to() {
    use std::os::unix::fs::PermissionsExt;
    let (trial, _) = own("GOOD");
    let mode = |path: &PathBuf, mode| {
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
    };
    let folder = trial.path("");
    let files = std::fs::read_dir(&folder).unwrap().flatten();
    let library = files
        .map(|f| f.path())
        .find(|p| p.to_string_lossy().contains("contact_own"))
        .unwrap();
    mode(&folder, 0o777);
    refusal(
        &run(&trial, &[]),
        &["anybody may write to", "mode 0777", "--trust-plugins"],
    );
    assert!(run(&trial, &["--trust-plugins"]).status.success());
    for law in [
        vec!["show", "own"],
        vec!["certify", "own"],
        vec!["drive", "own"],
    ] {
        let mut words = vec!["law"];
        words.extend(law);
        words.extend(["--plugin-path", "."]);
        refusal(&trial.call(&words), &["anybody may write to"]);
    }
    let listed = trial.call(&["law", "list", "--plugin-path", "."]);
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    assert!(
        listed.contains("unusable") && listed.contains("anybody may write to"),
        "{listed}"
    );
    mode(&folder, 0o755);
    mode(&library, 0o666);
    refusal(&run(&trial, &[]), &["anybody may write to", "contact_own"]);
    mode(&library, 0o644);
    assert!(run(&trial, &[]).status.success());
}

#[test]
fn a_library_that_is_not_the_pinned_one() {
    let (trial, case) = own("GOOD");
    let shown = trial.call(&["law", "show", "own", "--plugin-path", "."]);
    let shown = String::from_utf8_lossy(&shown.stdout).into_owned();
    let sum = shown
        .lines()
        .find_map(|l| l.trim().strip_prefix("sha256"))
        .map(str::trim)
        .unwrap();
    let text = std::fs::read_to_string(&case).unwrap();
    let pinned = |law: &str, pin: &str| {
        let pins = format!("    pins: {{\"{law}\": \"{pin}\"}},\n    friction: (");
        trial.write("case.ron", with(&text, "    friction: (", &pins));
    };
    pinned("contact/own", sum);
    assert!(run(&trial, &[]).status.success());
    let other = "0".repeat(64);
    pinned("contact/own", &other);
    refusal(&run(&trial, &[]), &["case.ron:", sum, &other, "as pinned"]);
    pinned("contact/own", "0a1b");
    refusal(&run(&trial, &[]), &["64 hexadecimal digits", "law show"]);
    pinned("contact/owl", sum);
    refusal(
        &run(&trial, &[]),
        &["no interface uses the law `contact/owl`", "contact/own"],
    );
}

#[test]
fn a_law_that_writes_behind_its_columns() {
    let (trial, _) = own("SPILLS");
    says(
        &run(&trial, &[]),
        1,
        &[
            "the contact law `own` wrote behind the end of a column in Prepare",
            "interface `grains` uses this law at",
            "case.ron:13:22",
        ],
    );
}

/// Two interfaces have one law, which fails in the second: the error refers to that line.
#[test]
fn the_interface_that_failed_is_the_one_that_is_shown() {
    let (trial, case) = own("DRIVES_IF_ROUGH");
    let text = std::fs::read_to_string(&case).unwrap();
    let text = with(
        &text,
        r#"{"grain": "stone"}"#,
        r#"{"grain": "stone", "wall": "stone"}"#,
    );
    let text = with(
        &text,
        r#"(name: "floor", material: "grain""#,
        r#"(name: "floor", material: "wall""#,
    );
    let walls = r#"        (name: "walls", between: ("grain", "wall"), contact: "own", parameters: (contact: {"mu": 0.4})),"#;
    let first = with(
        &text,
        "interfaces: [\n",
        &format!("interfaces: [\n{walls}\n"),
    );
    let last = with(
        &text,
        "    ],\n    bodies",
        &format!("{walls}\n    ],\n    bodies"),
    );
    for (text, line) in [(first, 9), (last, 16)] {
        trial.write("case.ron", text);
        says(
            &run(&trial, &["--out", &format!("out-{line}")]),
            1,
            &[
                "as `out_friction`",
                "(interface `walls`",
                "interface `walls` uses this law at",
                &format!("case.ron:{line}:"),
            ],
        );
    }
}

/// A library that is replaced after it was tested is not opened.
#[cfg(target_os = "linux")]
#[test]
fn a_library_that_is_replaced_while_it_is_tried() {
    let (trial, _) = own("SWAPS");
    let files = std::fs::read_dir(trial.path("")).unwrap().flatten();
    let library = files
        .map(|f| f.path())
        .find(|p| p.to_string_lossy().contains("contact_own"))
        .unwrap();
    let swaps = std::fs::read(&library).unwrap();
    for command in ["show", "drive", "certify"] {
        std::fs::write(&library, &swaps).unwrap();
        trial.write("next", "another library");
        refusal(
            &trial.call(&["law", command, "own", "--plugin-path", "."]),
            &["contact_own", "changed while it was being opened"],
        );
    }
    // A run tests all libraries of its case at first; a library that was added later is tested
    // alone.
    std::fs::write(&library, &swaps).unwrap();
    trial.write("next", "another library");
    refusal(&run(&trial, &[]), &["contact_own", "cannot use the plugin"]);
    assert!(!trial.path("results").exists());
}

#[cfg(unix)]
#[test]
fn a_folder_farther_up_or_behind_a_link_that_anybody_may_write_to() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let (trial, _) = own("GOOD");
    let files = std::fs::read_dir(trial.path("")).unwrap().flatten();
    let library = files
        .map(|f| f.path())
        .find(|p| p.to_string_lossy().contains("contact_own"))
        .unwrap();
    let name = library.file_name().unwrap();
    let (up, laws, linked) = (
        trial.path("up"),
        trial.path("up/laws"),
        trial.path("linked"),
    );
    for folder in [&laws, &linked] {
        std::fs::create_dir_all(folder).unwrap();
    }
    std::fs::rename(&library, laws.join(name)).unwrap();
    symlink(laws.join(name), linked.join(name)).unwrap();
    symlink("up/laws", trial.path("way")).unwrap();
    let mode = |mode| {
        std::fs::set_permissions(&up, std::fs::Permissions::from_mode(mode)).unwrap();
    };
    for folder in ["up/laws", "linked", "way", "linked/../way"] {
        let words = ["run", "case.ron", "--plugin-path", folder];
        mode(0o777);
        let said = refusal(&trial.call(&words), &["mode 0777", "--trust-plugins"]);
        assert!(said.contains("/up (mode"), "{folder}: {said}");
        let trusting = [&words[..], &["--trust-plugins"]].concat();
        assert!(trial.call(&trusting).status.success());
        // Others may not rename files that they do not own.
        mode(0o1777);
        assert!(trial.call(&words).status.success(), "{folder}");
        mode(0o755);
        assert!(trial.call(&words).status.success(), "{folder}");
    }
}

#[test]
fn a_law_that_does_not_come_back() {
    let (trial, _) = own("LOOPS");
    let more = [
        "--law-timeout",
        "0.5",
        "--set",
        "time.end=40.0",
        "--set",
        "output.checkpoint=Steps(50)",
    ];
    let output = run(&trial, &more);
    says(
        &output,
        1,
        &[
            "the contact law `own` has not come back from prepare",
            "all rows up to this step and a summary.json",
        ],
    );
    // No computed result is lost, and the summary gives the reason.
    let out = |name: &str| trial.path(&format!("results/case/{name}"));
    let summary = std::fs::read_to_string(out("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let steps = summary["steps"].as_u64().unwrap() as usize;
    assert!(steps > 1000, "{steps}");
    let why = summary["stopped"].as_str().unwrap();
    assert!(why.contains("`own` has not come back"), "{why}");
    assert!(summary["cycles"].as_array().is_some_and(|c| !c.is_empty()));
    let table = std::fs::read_to_string(out("statistics.csv")).unwrap();
    assert_eq!(table.lines().count(), steps + 1);
    let results = hdf5::H5File::open(out("results.h5")).unwrap();
    let rows = results.dataset("/statistics/step").unwrap();
    let rows = rows.read_raw::<f64>().unwrap();
    assert_eq!(rows.len(), steps);
    assert_eq!(rows.last(), Some(&(steps as f64)));
    // The run counts as stopped, not as ended: it can be resumed, and hangs again.
    let again = run(&trial, &[&more[..], &["--resume"]].concat());
    says(&again, 1, &["has not come back from prepare"]);
    let said = String::from_utf8_lossy(&again.stdout).into_owned();
    assert!(said.contains("resuming the run"), "{said}");
}

/// In the trial steps of `check` a law that fails is reported, and one that does not return does
/// not block the command.
#[test]
fn check_times_steps_of_laws_that_fail_and_hang() {
    for (fault, says) in [
        ("FAILS", "of a trial FAILED, and a run will too"),
        ("SPILLS", "step 1 of a trial FAILED"),
        ("HANGS", "then one of more than"),
    ] {
        let (trial, case) = own(fault);
        let long = std::fs::read_to_string(&case).unwrap();
        trial.write("case.ron", long.replace("end: 0.002", "end: 20.0"));
        let folder = trial.path("");
        // The watch over laws would end the command with code 1 much later.
        let words = [
            "check",
            "--verbose",
            "case.ron",
            "--plugin-path",
            folder.to_str().unwrap(),
        ];
        let output = trial.call(&words);
        let text = String::from_utf8_lossy(&output.stdout);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{fault}: {said}");
        let line = text.lines().find(|l| l.trim().starts_with("run time"));
        assert!(line.is_some_and(|l| l.contains(says)), "{fault}: {text}");
    }
}
