//! Invalid input, one error at a time: the program ends with exit code 2 and reports the position
//! of the error, what was expected, and the nearest valid name. It never panics.

mod circuit;
mod command_line;
mod deformable;
mod deformable_mesh;
mod files;
mod geometry;
mod half_space;
mod heat;
mod hostile_laws;
#[cfg(target_os = "linux")]
mod kept_certificates;
mod limits;
#[cfg(target_os = "linux")]
mod linked;
mod magnitudes;
mod mistakes;
mod mutations;
mod names;
mod numbers;
mod polygons;
mod printed;
mod soft_grains;
mod spelling;
mod stages;
mod text;
mod trial;
mod trust;
mod units;
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
