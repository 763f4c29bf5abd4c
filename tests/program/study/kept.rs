//! Runs that are kept, and those that are made again.

use super::{BEAD, Folder, HEAP, json, mu, numbers, values};
use std::process::Command;

/// The table has the results of the runs by number, setting and seed; a second call makes no run.
#[test]
fn the_table_is_what_the_runs_left() {
    let folder = Folder::new("table");
    folder.study(&mu("0.1, 0.3"), "seeds: 2");
    let study = folder.run();
    assert_eq!(numbers(&study, "point"), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(numbers(&study, "setting"), [1.0, 1.0, 2.0, 2.0]);
    assert_eq!(numbers(&study, "seed"), [3.0, 4.0, 3.0, 4.0]);
    assert_eq!(numbers(&study, "friction"), [0.1, 0.1, 0.3, 0.3]);
    assert_eq!(study["columns"]["energy.friction"]["unit"], "J/m");
    let names = values(&study, "folder");
    for (k, value) in numbers(&study, "energy.friction").into_iter().enumerate() {
        let place = folder.0.join("out/runs").join(names[k].as_str().unwrap());
        let summary = json(&place.join("summary.json"));
        assert_eq!(summary["energy"]["friction"].as_f64(), Some(value));
        assert_eq!(summary["seed"].as_f64(), Some(numbers(&study, "seed")[k]));
        assert_eq!(summary["identity"], values(&study, "identity")[k]);
        assert!(!place.join("results.h5").exists());
    }
    // Seeds give different samples.
    assert_ne!(
        numbers(&study, "energy.friction")[0],
        numbers(&study, "energy.friction")[1]
    );
    let changed = |path: &std::path::PathBuf| {
        std::fs::metadata(path.join("run.json"))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before: Vec<_> = folder.runs().iter().map(changed).collect();
    assert_eq!(folder.run(), study);
    assert_eq!(
        folder.runs().iter().map(changed).collect::<Vec<_>>(),
        before
    );
    let csv = std::fs::read_to_string(folder.0.join("out/table.csv")).unwrap();
    assert!(
        csv.starts_with("point,setting,seed,friction,energy.friction [J/m],status,"),
        "{csv}"
    );
    assert_eq!(csv.lines().count(), 5);
}

/// One more value needs one more run; a value in another spelling needs none; another material
/// needs all.
#[test]
fn only_what_is_new_is_run() {
    let folder = Folder::new("new");
    folder.study(&mu("0.1, 0.3"), "");
    folder.run();
    assert_eq!(folder.runs().len(), 2);
    folder.study(&mu("0.1, 3e-1, 0.5"), "");
    folder.run();
    assert_eq!(folder.runs().len(), 3);
    // Comments and defaults do not change the content of a case.
    folder.put(
        "heap.ron",
        &format!(
            "// A heap.\n{}",
            HEAP.replace("seed: 3,", "seed: 3, periodic: (),")
        ),
    );
    let words = folder.call(&["check", "study.ron", "--out", "out"]);
    let said = String::from_utf8_lossy(&words.stdout).into_owned();
    assert!(said.contains("of which 0 are to be made"), "{said}");
    folder.put("materials/bead.ron", &BEAD.replace("2500", "2600"));
    folder.run();
    assert_eq!(folder.runs().len(), 6);
}

/// A case without random numbers has perturbed steps instead of seeds, also if the study sets its
/// whole `time`.
#[test]
fn perturbed_steps_take_the_place_of_seeds() {
    let folder = Folder::new("perturbed");
    let case = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("cases/verification/slide_to_stop.ron");
    let text = format!(
        r#"(case: {case:?}, set: ["time=(step: 1e-3, end: 0.01)"], outputs: ["statistics.time:last"], seeds: 3,
            factors: [Values(name: "tolerance", key: "solver.tolerance", values: [1e-9])])"#
    );
    folder.put("study.ron", &text);
    let study = folder.run();
    let ends: Vec<f64> = values(&study, "statistics.time:last")
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect();
    for (k, end) in ends.iter().enumerate() {
        let expected = 0.01 * (1.0 + 1e-10 * k as f64);
        assert!((end / expected - 1.0).abs() < 1e-12, "{ends:?}");
    }
}

/// A run that fails is a row with its reason, and the study succeeds.
#[test]
fn failed_runs_are_rows() {
    let folder = Folder::new("failed");
    folder.study(
        r#"Values(name: "iterations", key: "solver.max_iterations", values: [5000, 1])"#,
        "",
    );
    let study = folder.run();
    assert_eq!(study["runs"]["failed"], 1);
    assert_eq!(values(&study, "status")[1], "rejected");
    let reason = values(&study, "reason")[1].as_str().unwrap();
    assert!(reason.contains("did not converge"), "{reason}");
    assert_eq!(values(&study, "status")[0], "done");
    // The table of settings gives the status of its runs.
    let page = std::fs::read_to_string(folder.0.join("out/study.html")).unwrap();
    assert!(page.contains("<th scope=\"row\">2</th><td>1</td><td>rejected</td>"));
    // A combination that the case rejects although it accepts each value alone, and a run that
    // takes too long.
    let set = r#"set: ["interfaces.all.parameters.contact.mu=${0.5 - sign}"]"#;
    folder.study(r#"Values(name: "sign", values: [0.1, 1.0])"#, set);
    let study = folder.run();
    assert_eq!(values(&study, "status")[1], "refused");
    let reason = values(&study, "reason")[1].as_str().unwrap();
    assert!(reason.contains("`mu`"), "{reason}");
    // Other engines treat it as a result.
    let point = folder.call(&["point", "study.ron", "2", "--out", "out"]);
    assert!(point.status.success());
    folder.put("heap.ron", &HEAP.replace("end: 0.05", "end: 500.0"));
    folder.study(&mu("0.1"), "");
    let words = [
        "run",
        "study.ron",
        "--out",
        "out",
        "--limit",
        "0.3s",
        "--json",
    ];
    let study = folder.answer(&words);
    assert_eq!(values(&study, "status")[0], "stopped");
}

/// Runs of another study by another program, case or file are not mistaken for its own, and its
/// tables are not replaced by empty ones.
#[test]
fn tables_are_not_replaced_by_empty_ones() {
    let folder = Folder::new("empty");
    folder.study(&mu("0.1"), "");
    folder.run();
    let table = folder.0.join("out/table.csv");
    let before = std::fs::read_to_string(&table).unwrap();
    folder.put("heap.ron", &HEAP.replace("end: 0.05", "end: 0.03"));
    let output = folder.call(&["collect", "study.ron", "--out", "out"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("tables are left as they are"), "{said}");
    assert_eq!(std::fs::read_to_string(&table).unwrap(), before);
}

/// After SIGINT the finished runs exist, and the command makes the rest.
#[cfg(unix)]
#[test]
fn an_interrupted_study_goes_on() {
    let folder = Folder::new("interrupted");
    folder.put("heap.ron", &HEAP.replace("end: 0.05", "end: 1.0"));
    folder.study(&mu("0.1, 0.2, 0.3, 0.4, 0.5, 0.6"), "");
    let words = ["run", "study.ron", "--out", "out"];
    let mut child = folder
        .command(&words)
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    while folder.runs().is_empty() {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
    assert_eq!(child.wait().unwrap().code(), Some(1));
    let done = folder.runs();
    assert!(!done.is_empty() && done.len() < 6, "{}", done.len());
    let study = folder.run();
    assert_eq!(study["runs"]["done"], 6);
    assert!(done.iter().all(|place| folder.runs().contains(place)));
}
