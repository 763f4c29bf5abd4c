//! Laws that link to libraries beside them: these are part of the law, whatever else is loaded, and
//! nothing else is loaded with them.

use super::trial::{PLANE, Trial, refusal, with};
use super::trust::{run, says};
use std::os::unix::fs::PermissionsExt;

/// The case with the law `own`.
fn own_case() -> String {
    let case = with(PLANE, r#"contact: "coulomb""#, r#"contact: "own""#);
    with(&case, r#"parameters_from: "laws","#, "")
}

/// The case with `own` between grains, and a second law between grains and walls.
fn two_interfaces(second: &str) -> String {
    let case = own_case().replace(
        r#"{"grain": "stone"}"#,
        r#"{"grain": "stone", "wall": "stone"}"#,
    );
    let case = case.replace(
        r#"(name: "floor", material: "grain""#,
        r#"(name: "floor", material: "wall""#,
    );
    let walls = format!(
        r#"        (name: "walls", between: ("grain", "wall"), contact: "{second}", parameters: (contact: {{"mu": 0.4}})),"#
    );
    let case = with(
        &case,
        "interfaces: [\n",
        &format!("interfaces: [\n{walls}\n"),
    );
    // The grains touch the floor.
    case.replace("0.011]", "0.01]")
}

/// A trial with a helper in `lib`.
fn with_helper() -> Trial {
    let trial = Trial::new();
    trial.compile_helper("lib", "0.3");
    trial.compile_linked_law("own", "lib", "$ORIGIN/lib");
    trial
}

fn shown(trial: &Trial, law: &str) -> String {
    let shown = trial.call(&["law", "show", law, "--plugin-path", "."]);
    says(&shown, 0, &[]);
    String::from_utf8_lossy(&shown.stdout).into_owned()
}

/// SHA-256 of a law with its linked libraries.
fn sum(trial: &Trial, law: &str) -> String {
    let shown = shown(trial, law);
    assert!(
        shown.contains("links to") && shown.contains("libhelper.so"),
        "{shown}"
    );
    let line = shown.lines().find(|l| l.contains("sha256")).unwrap();
    line.split_whitespace().last().unwrap().to_owned()
}

/// A library that a law links to runs with it: it is checked, pinned and recorded with the law.
#[test]
fn a_library_that_a_law_links_to_is_a_part_of_it() {
    let trial = with_helper();
    trial.write("case.ron", own_case());
    let first = sum(&trial, "own");
    says(&run(&trial, &[]), 0, &[]);
    let summary = std::fs::read_to_string(trial.path("results/case/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let link = summary["plugins"][0]["links"][0].as_str().unwrap();
    assert!(link.contains("libhelper.so "), "{link}");
    // A pin covers the helper: with another helper the law is another one.
    let library = trial.compile_helper("lib", "0.4");
    assert_ne!(sum(&trial, "own"), first);
    let pin = format!("pins.contact/own={first}");
    refusal(
        &run(&trial, &["--set", &pin]),
        &["has the SHA-256", "as pinned"],
    );
    std::fs::set_permissions(&library, std::fs::Permissions::from_mode(0o666)).unwrap();
    refusal(
        &run(&trial, &[]),
        &["it links to", "libhelper.so", "anybody may write to"],
    );
}

/// On the second loading the helper is already in the process: the law has an equal SHA-256.
#[test]
fn a_linked_law_is_opened_for_two_interfaces() {
    let trial = with_helper();
    trial.write("case.ron", two_interfaces("own"));
    says(&run(&trial, &[]), 0, &[]);
    let pin = format!("pins.contact/own={}", sum(&trial, "own"));
    says(&run(&trial, &["--set", &pin, "--out", "pinned"]), 0, &[]);
    let summary = std::fs::read_to_string(trial.path("pinned/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    for law in summary["plugins"].as_array().unwrap() {
        let links = law["links"].as_array().unwrap();
        assert_eq!(links.len(), 1, "{law}");
    }
}

#[test]
fn two_laws_link_to_one_library() {
    let trial = with_helper();
    trial.compile_linked_law("other", "lib", "$ORIGIN/lib");
    trial.write("case.ron", two_interfaces("other"));
    let pins = ["own", "other"].map(|law| format!("pins.contact/{law}={}", sum(&trial, law)));
    says(
        &run(&trial, &["--set", &pins[0], "--set", &pins[1]]),
        0,
        &[],
    );
    let listed = trial.call(&["law", "list", "--plugin-path", "."]);
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    for law in [" own ", " other "] {
        let line = listed.lines().find(|l| l.contains(law)).unwrap();
        assert!(!line.contains("unusable"), "{line}");
    }
    // All are loaded before the first is tested; the test does not wait until all shipped laws are
    // tested.
    let mut certify = trial.start(&["law", "certify", "--all", "--plugin-path", "."]);
    std::thread::sleep(std::time::Duration::from_secs(2));
    let running = certify.try_wait().unwrap();
    certify.kill().ok();
    let said = certify.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&said.stderr).into_owned();
    assert!(running.is_none_or(|s| s.success()), "{said}");
    assert!(!said.contains("changed while"), "{said}");
}

/// Two files have one name: the linker uses the first for both, so the second law is not that of
/// its file.
#[test]
fn two_libraries_of_one_name_do_not_stand_for_each_other() {
    let trial = with_helper();
    trial.compile_helper("lib2", "0.5");
    trial.compile_linked_law("other", "lib2", "$ORIGIN/lib2");
    for law in ["own", "other"] {
        assert!(shown(&trial, law).contains("libhelper.so"));
    }
    trial.write("case.ron", two_interfaces("other"));
    refusal(
        &run(&trial, &[]),
        &["lib2/libhelper.so", "did not load that file", "soname"],
    );
    assert!(!trial.path("results").exists());
}

/// The linker prefers a variant for the processor in a sub-folder: no code of it runs unexamined.
#[test]
fn where_the_linker_looks_depends_on_no_machine() {
    let words = ["what ", "links to depends on the machine"];
    let trial = with_helper();
    trial.write("case.ron", own_case());
    let folder = trial.path("lib/glibc-hwcaps/x86-64-v2");
    std::fs::create_dir_all(&folder).unwrap();
    let variant = folder.join("libhelper.so");
    std::fs::copy(trial.path("lib/libhelper.so"), &variant).unwrap();
    std::fs::set_permissions(&variant, std::fs::Permissions::from_mode(0o666)).unwrap();
    let trusting = run(&trial, &["--trust-plugins"]);
    for output in [run(&trial, &[]), trusting] {
        let said = refusal(&output, &words);
        assert!(
            said.contains("glibc-hwcaps/x86-64-v2/libhelper.so"),
            "{said}"
        );
    }
    std::fs::remove_file(&variant).unwrap();
    says(&run(&trial, &[]), 0, &[]);
    for word in ["$LIB", "${PLATFORM}"] {
        trial.compile_linked_law("own", "lib", &format!("$ORIGIN/{word}:$ORIGIN/lib"));
        let said = refusal(&run(&trial, &["--out", "other"]), &words);
        assert!(said.contains(word), "{said}");
    }
}
