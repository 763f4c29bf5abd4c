//! Wrong input, one mistake at a time: the program ends with exit code 2 and says where the mistake
//! stands, what was expected, and which valid name is nearest. It never panics.

#[path = "bad_input/circuit.rs"]
mod circuit;
#[path = "bad_input/command_line.rs"]
mod command_line;
#[path = "bad_input/geometry.rs"]
mod geometry;
#[path = "bad_input/hostile_laws.rs"]
mod hostile_laws;
#[path = "bad_input/limits.rs"]
mod limits;
#[path = "bad_input/mutations.rs"]
mod mutations;
#[path = "bad_input/names.rs"]
mod names;
#[path = "bad_input/numbers.rs"]
mod numbers;
#[path = "bad_input/polygons.rs"]
mod polygons;
#[path = "bad_input/stages.rs"]
mod stages;
#[path = "bad_input/text.rs"]
mod text;
#[path = "bad_input/trial.rs"]
mod trial;
#[path = "bad_input/trust.rs"]
mod trust;
#[path = "bad_input/wear.rs"]
mod wear;

use trial::{PLANE, SOLID, Trial};

#[test]
fn the_cases_without_a_mistake_run() {
    for case in [PLANE, SOLID] {
        let trial = Trial::new();
        trial.write("case.ron", case);
        let output = trial.call(&["run", "case.ron", "--json"]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(trial.path("results/case/summary.json").is_file());
    }
}
