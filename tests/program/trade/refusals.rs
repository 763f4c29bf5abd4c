//! Invalid input of a study, and outputs that a case does not have.

use super::{BOND, Folder, HEAP, call};
use std::path::Path;

#[test]
fn wrong_input_is_answered_with_the_nearest_name() {
    let folder = Folder::new("wrong");
    let out = folder.out();
    for (arguments, said) in [
        (&["--setting", "stpe"][..], "did you mean `step`?"),
        (&["--setting", "precision"], "f64 only"),
        // The former name is read, and reported.
        (&["--knob", "stpe"], "did you mean `step`?"),
        (&["--knob", "precision"], "renamed: write --setting"),
        (&["--setting", "grains"], "no lattice or deposit"),
        (
            &["--output", "frction_coefficient=1%"],
            "did you mean `friction_coefficient`?",
        ),
        (
            &["--output", "elastic=1%"],
            "did you mean `energy.elastic`?",
        ),
        (
            &["--output", "fracture=1%"],
            "it is not a number but a group",
        ),
        (
            &["--output", "statistics.kinetc=1%"],
            "did you mean `statistics.kinetic`?",
        ),
        (&["--output", "energy.fracture=0%"], "above zero"),
        (
            &["--output", "energy.residual=1%"],
            "its exact value is zero",
        ),
        (
            &["--vary", "tme.step=1e-8,2e-8"],
            "did you mean `time.step`?",
        ),
        (&["--vary", "time.step=1e-8"], "two values or more"),
        (&["--vary", "time.step=-1,2e-8"], "must be positive"),
        (
            &["--exact", "energy.fractur=1"],
            "no --output has this name",
        ),
        (&["--budget", "soon"], "is not a time"),
        (&["--budget", "NaN"], "is not a time"),
        (
            &["--unconverged", "NaN"],
            "a number from 0 to 1 is expected",
        ),
        (&["--residual=-1"], "a number from 0 up is expected"),
        (&["--output", "energy.fracture=NaN%"], "a number above zero"),
        (&["--output", "energy.fracture=100%"], "less than 100 %"),
        (
            &["--output", "measures.bulk_mu"],
            "a run of this case has no such output",
        ),
        (&["--output", "wear.Qs"], "has a wear law"),
        (&["--output", "wear.Qw"], "no circuit of grains"),
        (&["--output", "biaxial.angle"], "no biaxial test"),
        (&["--output", "plugins"], "it is not a number but a group"),
        (
            &["--output", "statistics.M"],
            "a run of this case has no such output",
        ),
        (
            &["--vary", "time.step=2e-8,2.0e-8"],
            "2e-8 and 2.0e-8 are the same case",
        ),
        (
            &["--set", "solver.method=Newton", "--setting", "test_every"],
            "does not iterate in sweeps",
        ),
        (
            &["--set", "time.step=1e-13", "--budget", "3s"],
            "one run of the case as it is takes",
        ),
        (&["--vary", "seed=1,2"], "for more seeds give --seeds"),
        (
            &["--vary", "output.every=1,2"],
            "the command sets this itself",
        ),
        (
            &[
                "--output",
                "energy.fracture",
                "--output",
                "energy.fracture=2%",
            ],
            "given twice",
        ),
    ] {
        let all = [&[BOND, "--out", &out][..], arguments].concat();
        let output = call(&all);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(said), "{arguments:?}: {text}");
    }
}

/// An output that a case does not have is reported before anything runs, with the existing ones:
/// nothing is left on disk.
#[test]
fn outputs_that_a_case_does_not_have_are_refused_before_a_run() {
    let folder = Folder::new("absent");
    let (case, out) = (folder.file("heap.ron", HEAP), folder.out());
    for (output, why) in [
        ("friction_coefficient", "no friction test"),
        ("cycles.2.work", "no friction test"),
        ("damage_ratio", "no interface of the case makes bonds"),
        ("energy.fracture", "has a damage law"),
        ("wear.Qs", "no interface of the case has a wear law"),
        ("jump.cycles", "has no jumps over cycles"),
        ("measures.layer_flow", "did you mean"),
        ("statistics.slide", "a run of this case has no such output"),
    ] {
        let answer = call(&[&case, "--out", &out, "--output", output]);
        let said = String::from_utf8_lossy(&answer.stderr);
        assert_eq!(answer.status.code(), Some(2), "{output}: {said}");
        if output != "measures.layer_flow" {
            assert!(said.contains(why), "{output}: {said}");
        }
        // The message lists the outputs of the case, or its columns.
        let list = if output.starts_with("statistics") {
            "kinetic"
        } else {
            "energy.friction"
        };
        assert!(said.contains(list), "{output}: {said}");
        assert!(!said.contains("there are friction_coefficient"), "{said}");
        assert!(!Path::new(&out).exists(), "{output} left something");
    }
    // The default outputs are those that exist, and there are none here.
    let answer = call(&[&case, "--out", &out]);
    let said = String::from_utf8_lossy(&answer.stderr);
    assert_eq!(answer.status.code(), Some(2), "{said}");
    assert!(said.contains("name an output"), "{said}");
}
