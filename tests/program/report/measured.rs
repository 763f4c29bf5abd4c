//! Measured curves in the figures of a run, in its page and as PNG files.

use super::{Trial, chart_numbers, data, text};
use std::fs;

/// A loop of a rig with semicolons and decimal commas.
const LOOP: &str = include_str!("loop.csv");

/// Returns the points of the measured series of a page, by the heading of its chart.
fn measured(page: &str) -> Vec<(String, Vec<(f32, f32)>)> {
    let (data, numbers) = (data(page), chart_numbers(page));
    let mut out = Vec::new();
    for figure in data["figures"].as_array().unwrap() {
        for series in figure["series"].as_array().into_iter().flatten() {
            let label = series["label"].as_str().unwrap_or_default();
            if label.starts_with("measured: ") {
                let of = |key: &str| numbers[series[key].as_str().unwrap()].iter().copied();
                let points = of("x").zip(of("y")).collect();
                out.push((figure["title"].as_str().unwrap().to_owned(), points));
            }
        }
    }
    out
}

#[test]
fn loops_and_friction_by_cycle_are_drawn_beside_those_of_the_run() {
    let trial = Trial::new("measured");
    trial.run("out", &[]);
    fs::write(trial.path("loop.csv"), LOOP).unwrap();
    fs::write(trial.path("mu.txt"), "N  COF\n1  0,41\n2  0,43\n").unwrap();
    let files = ["--measured", "loop.csv", "--measured", "mu.txt"];
    let depth = ["--depth", "10mm"];
    let output = trial.call(&[&["report", "out"], &files[..], &depth].concat());
    assert!(output.status.success(), "{}", text(&output));
    let found = measured(&trial.page("out/report.html"));
    let [(_, curve), (_, cycles)] = found.as_slice() else {
        panic!("{found:?}");
    };
    // The run is two-dimensional: 1 N over 10 mm is 100 N/m.
    assert_eq!((curve.len(), cycles.len()), (8, 2));
    for ((x, y), (delta, force)) in [(curve[0], (-2e-3, -115.0)), (curve[1], (-1.0005e-3, 98.0))] {
        assert!(
            (x - delta).abs() < 1e-9 && (y - force).abs() < 1e-4,
            "{x} {y}"
        );
    }
    assert_eq!(cycles.as_slice(), [(1.0, 0.41), (2.0, 0.43)]);
    for name in ["fretting_loops", "friction_coefficient"] {
        let picture = fs::read(trial.path(&format!("out/{name}_measured.png"))).unwrap();
        assert!(picture.starts_with(b"\x89PNG"), "{name}");
    }
    // Without measured curves the page has none, and only their pictures go.
    let own = trial.path("out/fretting_loops.png");
    fs::write(&own, b"of the run").unwrap();
    assert!(trial.call(&["report", "out"]).status.success());
    assert!(measured(&trial.page("out/report.html")).is_empty());
    for name in ["fretting_loops", "friction_coefficient"] {
        assert!(!trial.path(&format!("out/{name}_measured.png")).exists());
    }
    assert!(own.exists());
    trial.run("two", &["seed=6"]);
    let args = ["compare", "out", "two", "--out", "both.html"];
    let output = trial.call(&[&args[..], &files, &depth].concat());
    assert!(output.status.success(), "{}", text(&output));
    assert_eq!(measured(&trial.page("both.html")).len(), 2);
    assert!(trial.path("both_fretting_loops.png").exists());
}

#[test]
fn columns_are_named_by_options() {
    let trial = Trial::new("measured-columns");
    trial.run("out", &[]);
    fs::write(trial.path("a.csv"), "Weg\tKraft\n0,5\t1\n1,5\t2\n").unwrap();
    fs::write(trial.path("bare.csv"), "0.5,1\n1.5,2\n").unwrap();
    for (file, columns) in [
        ("a.csv", "delta=Weg (um),Q=Kraft (N/m)"),
        ("bare.csv", "delta=1 (um),Q=2 (N/m)"),
    ] {
        let args = ["report", "out", "--measured", file, "--columns", columns];
        let output = trial.call(&args);
        assert!(output.status.success(), "{}", text(&output));
        let found = measured(&trial.page("out/report.html"));
        assert_eq!(found[0].1, [(0.5e-6, 1.0), (1.5e-6, 2.0)], "{file}");
    }
}

#[test]
fn what_does_not_fit_is_refused_with_what_to_change() {
    let trial = Trial::new("measured-refused");
    trial.run("out", &[]);
    for (content, more, words) in [
        (LOOP, &[][..], "--depth"),
        ("a;b\n1;2\n", &[], "needs `delta` and `Q`"),
        (
            "delta;Q [N/m]\n1;2\n",
            &[],
            "the unit of `delta` is not known",
        ),
        ("delta [s];Q [N/m]\n1;2\n", &[], "does not measure the same"),
        (
            "delta [um];Q [N/m]\n1;x\n",
            &[],
            "line 2: the value of `Q` `x` is not a number",
        ),
        (
            "delta [um];Q [N/m]\n1.000,5;2\n",
            &[],
            "line 2: the value of `delta` `1.000,5` has a point and a comma",
        ),
        (
            "delta [um];Q [N/m]\n1.234,5;2.345,5\n0,5;1\n",
            &[],
            "line 2: the value of `delta` `1.234,5` has a point and a comma",
        ),
        ("delta,mu\n1,5,0,4\n", &[], "semicolons or tabs"),
        ("x [mm];depth [um]\n1;2\n", &[], "no scar"),
        (
            "delta [um];Q [N/m]\n1;2\n",
            &["--columns", "Q=F"],
            "no measured file has a column `F`",
        ),
        (
            "delta [um];Q [N/m]\n1;2\n",
            &["--columns", "Weg=delta"],
            "NAME is one of delta, Q",
        ),
        ("delta [um];Q [N]\n1;2\n", &["--depth", "0"], "above zero"),
    ] {
        fs::write(trial.path("m.csv"), content).unwrap();
        let args = [&["report", "out", "--measured", "m.csv"], more].concat();
        let output = trial.call(&args);
        let said = text(&output);
        assert_eq!(output.status.code(), Some(2), "{content:?}: {said}");
        assert!(said.contains(words), "{content:?}: {said}");
    }
    let output = trial.call(&["report", "out", "--depth", "1mm"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
}
