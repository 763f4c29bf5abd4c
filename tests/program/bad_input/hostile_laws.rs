//! Laws that hang, exit or crash while they are loaded or in a step, and laws with impossible
//! outputs.

use super::trial::{Trial, refusal};
use super::trust::{own, run, says};
use std::path::PathBuf;

/// A run of 40,000 steps, more than the laws here allow, with saved states.
const LONG: [&str; 6] = [
    "--set",
    "time.end=40.0",
    "--set",
    "output.checkpoint=Steps(50)",
    "--law-timeout",
    "5",
];

fn library(trial: &Trial) -> PathBuf {
    let files = std::fs::read_dir(trial.path("")).unwrap().flatten();
    let mut files = files.map(|f| f.path());
    files
        .find(|p| p.to_string_lossy().contains("contact_own"))
        .unwrap()
}

#[test]
fn a_library_that_hangs_when_it_is_loaded() {
    for fault in ["HANGS_WHEN_LOADED", "HANGS_WHEN_ASKED"] {
        let (trial, _) = own(fault);
        let words = ["contact_own", "has not come back from loading for 0.5 s"];
        refusal(&run(&trial, &["--law-timeout", "0.5"]), &words);
        assert!(!trial.path("results").exists());
        let file = library(&trial);
        let file = file.to_str().unwrap();
        for law in ["show", "certify"] {
            let name = if law == "show" { "own" } else { file };
            let call = [
                "law",
                law,
                name,
                "--plugin-path",
                ".",
                "--law-timeout",
                "0.5",
            ];
            refusal(&trial.call(&call), &words);
        }
    }
}

#[cfg(unix)]
#[test]
fn a_library_that_exits_or_crashes_when_it_is_loaded() {
    let (trial, _) = own("EXITS_WHEN_LOADED");
    refusal(
        &run(&trial, &[]),
        &["contact_own", "in loading (it called exit)"],
    );
    let (trial, _) = own("CRASHES_WHEN_LOADED");
    refusal(
        &run(&trial, &[]),
        &["contact_own", "crashed in loading (SIGSEGV"],
    );
    // The other laws are still listed.
    let listed = trial.call(&["law", "list", "--plugin-path", "."]);
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let line = |part: &str| listed.lines().find(|l| l.contains(part)).unwrap();
    assert!(line(" own ").contains("unusable") && line(" own ").contains("SIGSEGV"));
    assert!(line("coulomb ").contains("friction"), "{listed}");
}

/// The pages of the library are mapped but missing: the dynamic linker receives a signal.
#[cfg(target_os = "linux")]
#[test]
fn a_library_that_is_cut_short() {
    let (trial, _) = own("GOOD");
    let file = library(&trial);
    let whole = std::fs::read(&file).unwrap();
    for share in [1, 2, 5, 8] {
        std::fs::write(&file, &whole[..whole.len() * share / 10]).unwrap();
        refusal(&run(&trial, &[]), &["cannot use the plugin", "contact_own"]);
    }
    std::fs::write(&file, &whole).unwrap();
    assert!(run(&trial, &[]).status.success());
}

#[test]
fn a_library_that_prints_when_it_is_loaded() {
    let (trial, _) = own("PRINTS_WHEN_LOADED");
    assert!(run(&trial, &[]).status.success());
}

/// Output of a library is not taken for an answer of the process that tests it.
#[cfg(unix)]
#[test]
fn a_library_that_prints_what_the_program_tells_itself() {
    let (trial, _) = own("SPOOFS");
    assert!(run(&trial, &[]).status.success());
    let certified = trial.call(&["law", "certify", "own", "--plugin-path", "."]);
    let said = String::from_utf8_lossy(&certified.stderr);
    assert_eq!(certified.status.code(), Some(0), "{said}");
    let table = String::from_utf8_lossy(&certified.stdout);
    assert!(table.contains("  certified"), "{table}");
    let (trial, _) = own("SPOOFS_AND_EXITS");
    refusal(
        &run(&trial, &[]),
        &["contact_own", "opening it ended a process that tried it"],
    );
    assert!(!trial.path("results").exists());
}

/// Rows and a summary with the reason exist, and the run can be resumed.
fn stopped(trial: &Trial, why: &str) {
    let out = |name: &str| trial.path(&format!("results/case/{name}"));
    let summary = std::fs::read_to_string(out("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let steps = summary["steps"].as_u64().unwrap() as usize;
    // The law allows a thousand calls. Each step makes one or more of them, since grains touch the
    // floor from the start. It makes up to four: a few steps in a hundred are repeated twice
    // (`uncertainty`), and a step may be solved twice.
    assert!((250..=1000).contains(&steps), "{steps}");
    let said = summary["stopped"].as_str().unwrap();
    assert!(said.contains(why), "{said}");
    let table = std::fs::read_to_string(out("statistics.csv")).unwrap();
    assert_eq!(table.lines().count(), steps + 1);
    let results = hdf5::H5File::open(out("results.h5")).unwrap();
    let rows = results.dataset("/statistics/step").unwrap();
    assert_eq!(rows.read_raw::<f64>().unwrap().len(), steps);
}

#[cfg(unix)]
#[test]
fn a_law_that_ends_the_program_in_a_step() {
    for (fault, why) in [
        (
            "EXITS",
            "`own` ended the program in prepare (it called exit)",
        ),
        ("CRASHES", "`own` crashed in prepare (SIGSEGV"),
        ("ABORTS", "`own` crashed in prepare (SIGABRT"),
        (
            "ENDS_ITS_THREAD",
            "`own` crashed in prepare (it threw an exception, or ended its thread)",
        ),
        (
            "THROWS",
            "`own` crashed in prepare (it threw an exception, or ended its thread)",
        ),
        #[cfg(target_arch = "x86_64")]
        ("DIVIDES", "`own` crashed in prepare (SIGFPE"),
    ] {
        let (trial, _) = own(fault);
        for threads in ["1", "2"] {
            let more = [&LONG[..], &["--threads", threads]].concat();
            says(
                &run(&trial, &more),
                1,
                &[why, "a summary.json that says so"],
            );
            stopped(&trial, why);
        }
        let again = run(&trial, &[&LONG[..], &["--resume"]].concat());
        says(&again, 1, &[why]);
        let said = String::from_utf8_lossy(&again.stdout).into_owned();
        assert!(said.contains("resuming the run"), "{said}");
    }
}

/// A run without states that a law ended is not started again without request, which would replace
/// its rows.
#[cfg(unix)]
#[test]
fn rows_that_a_law_left_without_a_state_are_not_replaced() {
    let (trial, _) = own("ABORTS");
    let never = ["--set", "time.end=40.0", "--set", "output.checkpoint=Never"];
    says(&run(&trial, &never), 1, &["`own` crashed in prepare"]);
    let table = || std::fs::read(trial.path("results/case/statistics.csv")).unwrap();
    let before = table();
    assert!(before.len() > 1000);
    says(
        &run(&trial, &[&never[..], &["--resume"]].concat()),
        1,
        &[
            "before it had saved a state to resume from",
            "`own` crashed in prepare",
            "--force in place of --resume",
        ],
    );
    assert!(table() == before);
    says(&run(&trial, &never), 1, &["`own` crashed in prepare"]);
}

/// Nothing in the process can detect `_exit`. The folder does not show the run as finished, and it
/// can be resumed.
#[cfg(unix)]
#[test]
fn a_law_that_ends_the_process_at_once() {
    let (trial, _) = own("EXITS_AT_ONCE");
    let output = run(&trial, &LONG);
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(!said.contains("results in"), "{said}");
    assert!(!trial.path("results/case/summary.json").exists());
    trial.compile_law("own", "0");
    let refused = run(&trial, &[&LONG[..], &["--resume"]].concat());
    refusal(
        &refused,
        &["the library of the contact law `own` has changed"],
    );
}

#[test]
fn answers_that_cannot_be() {
    for (fault, words) in [
        ("BOUNCES=2.0", ["2e0 as `out_restitution_n`", "[0, 1]"]),
        ("BOUNCES=-3.0", ["-3e0 as `out_restitution_n`", "[0, 1]"]),
        ("DRIVES", ["-1e-1 as `out_friction`", "[0, infinity)"]),
    ] {
        let (trial, _) = own(fault);
        let output = run(&trial, &[]);
        says(&output, 1, &words);
        says(
            &output,
            1,
            &[
                "the contact law `own` gave",
                "in Prepare at contact 0 of its batch",
                "(interface `grains`, contact of bodies",
            ],
        );
        // A constant law is called once, without a contact.
        trial.compile_bad_law("own", "FW_FLAG_CONSTANT", fault);
        let output = run(&trial, &[]);
        says(&output, 1, &words);
        says(&output, 1, &["(interface `grains`)"]);
    }
}

/// A crash, an exit or a hang fails one line of the certificate, which names the check.
#[cfg(unix)]
#[test]
fn certificates_of_laws_that_end_the_process() {
    for (fault, why) in [
        (
            "EXITS",
            "`own` ended the program in prepare (it called exit), while `",
        ),
        ("CRASHES", "`own` crashed in prepare (SIGSEGV"),
        (
            "EXITS_AT_ONCE",
            "it ended the process (exit code 0), while `",
        ),
        ("LOOPS", "`own` has not come back from prepare for 0.5 s"),
    ] {
        let (trial, _) = own(fault);
        let call = [
            "law",
            "certify",
            "own",
            "--plugin-path",
            ".",
            "--law-timeout",
            "0.5",
        ];
        let output = trial.call(&call);
        says(&output, 1, &["not certified: contact law `own`"]);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let line = said.lines().find(|l| l.contains("comes back")).unwrap();
        assert!(line.contains("FAIL") && line.contains(why), "{said}");
        assert!(line.contains("while `dissipation` was tested"), "{said}");
    }
}

/// A process without memory proves nothing about the law that it tests: no shipped law is blamed
/// under limits that are reached in a test.
#[cfg(target_os = "linux")]
#[test]
fn a_law_that_could_not_be_tested_is_not_blamed() {
    let mut untested = 0;
    for limit in (40_000..=130_000).step_by(5_000) {
        let call = format!("ulimit -v {limit} && exec \"$0\" law certify coulomb");
        let output = std::process::Command::new("sh")
            .args(["-c", &call, env!("CARGO_BIN_EXE_fretwork")])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let table = String::from_utf8_lossy(&output.stdout).into_owned();
        if format!("{said}{table}").contains("memory ran out") {
            assert!(!said.contains("not certified"), "{limit}: {said}");
            assert!(!table.contains("NOT certified"), "{limit}: {table}");
        }
        if said.contains("could not be tested: ") {
            assert_eq!(output.status.code(), Some(1), "{said}");
            untested += 1;
        }
    }
    assert!(untested > 0, "no limit was met in a test");
}

/// Rounding and subnormal numbers are restored for the caller: the run equals that of a law which
/// does not change them, and the certificate reports the change.
#[cfg(target_arch = "x86_64")]
#[test]
fn a_law_that_changes_rounding_changes_no_number() {
    let rows = |trial: &Trial| {
        assert!(run(trial, &["--set", "time.end=0.2"]).status.success());
        std::fs::read(trial.path("results/case/statistics.csv")).unwrap()
    };
    let (good, _) = own("GOOD");
    let expected = rows(&good);
    for (fault, when) in [
        ("ROUNDS_UP", "in a call"),
        ("FLUSHES_WHEN_LOADED", "while it is loaded"),
    ] {
        let (trial, _) = own(fault);
        assert!(rows(&trial) == expected, "{fault}");
        let certified = trial.call(&["law", "certify", "own", "--plugin-path", "."]);
        let table = String::from_utf8_lossy(&certified.stdout).into_owned();
        let line = table
            .lines()
            .find(|l| l.contains("floating point"))
            .unwrap();
        assert!(line.contains("FAIL") && line.contains(when), "{line}");
    }
}

#[cfg(unix)]
#[test]
fn what_a_law_prints_is_no_part_of_an_answer() {
    let (trial, _) = own("PRINTS");
    let output = run(&trial, &["--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["steps"], 2);
    assert!(String::from_utf8_lossy(&output.stderr).contains("a step"));
}

#[cfg(unix)]
#[test]
fn a_law_that_changes_the_folder_moves_no_results() {
    let (trial, _) = own("MOVES");
    let output = run(&trial, &[]);
    says(&output, 0, &[]);
    let out = trial.path("results/case");
    assert!(out.join("summary.json").exists() && out.join("report.html").exists());
}

#[test]
fn flags_of_a_later_interface_are_refused() {
    let trial = Trial::new();
    trial.compile_law("own", "(1ull << 40)");
    let shown = trial.call(&["law", "show", "own", "--plugin-path", "."]);
    refusal(
        &shown,
        &["sets flags that this program does not know (0x10000000000)"],
    );
}

/// A file in the working folder is named without a folder: the linker would search it among the
/// system's libraries.
#[test]
fn a_library_is_certified_in_its_own_folder() {
    let (trial, _) = own("SPOOFS");
    let file = library(&trial);
    let name = file.file_name().unwrap().to_str().unwrap();
    says(&trial.call(&["law", "certify", name]), 0, &[]);
    trial.write("libbroken.so", "no library");
    says(
        &trial.call(&["law", "certify", "libbroken.so"]),
        2,
        &["is not a loadable library ("],
    );
}
