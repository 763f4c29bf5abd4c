//! Folders that contain no run, and runs that did not end.

use super::{Trial, data, text};
use std::fs;

#[test]
fn a_folder_without_a_run_is_refused_with_a_sentence() {
    let trial = Trial::new("refused");
    trial.run("out", &[]);
    fs::create_dir(trial.path("empty")).unwrap();
    fs::create_dir(trial.path("foreign")).unwrap();
    fs::write(trial.path("foreign/results.h5"), "not HDF5 at all").unwrap();
    fs::create_dir(trial.path("other")).unwrap();
    fs::copy(
        concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/fclib/fc3d_OneContact_reduced.hdf5"
        ),
        trial.path("other/results.h5"),
    )
    .unwrap();
    fs::create_dir(trial.path("cut")).unwrap();
    let bytes = fs::read(trial.path("out/results.h5")).unwrap();
    fs::write(trial.path("cut/results.h5"), &bytes[..bytes.len() / 50]).unwrap();
    for (folder, words) in [
        ("nowhere", "does not exist"),
        ("case.ron", "is a file"),
        ("empty", "no results.h5"),
        ("foreign", "cannot be read"),
        ("other", "not of `fretwork run`"),
        ("cut", "results.h5"),
    ] {
        for args in [&["report", folder][..], &["compare", "out", folder]] {
            let output = trial.call(args);
            let said = text(&output);
            assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
            assert!(
                said.contains(words) && said.contains(folder) && !said.contains("panicked"),
                "{args:?}: {said}"
            );
        }
        assert!(!trial.path(folder).join("report.html").exists());
    }
    assert!(!trial.path("compare.html").exists());
    for args in [
        &["report", "out", "--size", "0"][..],
        &["report", "out", "--size", "3", "--full"],
        &["compare", "out"],
    ] {
        assert_eq!(trial.call(args).status.code(), Some(2), "{args:?}");
    }
}

#[test]
fn a_file_that_was_cut_anywhere_is_refused_or_shown_as_far_as_it_goes() {
    let trial = Trial::new("cut");
    trial.run("out", &[]);
    let bytes = fs::read(trial.path("out/results.h5")).unwrap();
    fs::create_dir(trial.path("part")).unwrap();
    for k in 1..12 {
        fs::write(
            trial.path("part/results.h5"),
            &bytes[..bytes.len() * k / 12],
        )
        .unwrap();
        let output = trial.call(&["report", "part"]);
        let said = text(&output);
        assert!(matches!(output.status.code(), Some(0 | 2)), "{k}: {said}");
        assert!(!said.contains("panicked"), "{k}: {said}");
    }
}

#[test]
fn a_run_without_its_summary_is_shown_as_not_finished() {
    let trial = Trial::new("killed");
    trial.run("out", &[]);
    fs::remove_file(trial.path("out/summary.json")).unwrap();
    let output = trial.call(&["report", "out"]);
    assert!(output.status.success(), "{}", text(&output));
    let page = trial.page("out/report.html");
    assert!(page.contains("Not finished") && page.contains("Last recorded row"));
    assert!(page.contains("There is no summary.json"));
    assert_eq!(data(&page)["scene"]["times"].as_array().unwrap().len(), 7);
    // A summary of another run is not used for this one.
    fs::write(
        trial.path("out/summary.json"),
        r#"{"case": "another", "trustworthy": true}"#,
    )
    .unwrap();
    assert!(trial.call(&["report", "out"]).status.success());
    let page = trial.page("out/report.html");
    assert!(page.contains("of another run") && !page.contains("class=\"verdict good\""));
}
