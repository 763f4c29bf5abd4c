//! Makes a study from code: a case at several values of a key, each run by the program in a
//! separate process, and one table of the results.
//!
//! ```sh
//! cargo build --release
//! cargo run --release --example study
//! ```

use fretwork::bodies::{Dof, TimeFunction};
use fretwork::experiments::RunSetup;
use fretwork::experiments::study::execute::{execute, missing};
use fretwork::experiments::study::plan::{Location, Plan};
use fretwork::experiments::study::rows::Rows;
use fretwork::experiments::study::spec::StudyFile;
use fretwork::experiments::study::write;
use fretwork::scene::CaseBuilder;
use fretwork::scene::case::{BodySpec, InterfaceSpec, ShapeSpec};
use fretwork::{program, record, shipped};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

const STUDY: &str = r#"(
    case: "slider.ron",
    factors: [
        Values(
            name: "friction",
            key: "interfaces.dry.parameters.contact.mu",
            values: [0.1, 0.2, 0.4],
        ),
    ],
    outputs: ["energy.friction"],
)"#;

/// Path of the program that makes the runs: in the folder above that of this example.
fn built_program() -> Result<PathBuf, Box<dyn std::error::Error>> {
    let own = std::env::current_exe()?;
    let folder = own
        .parent()
        .and_then(Path::parent)
        .ok_or("no folder of programs")?;
    let program = folder.join(format!("fretwork{}", std::env::consts::EXE_SUFFIX));
    match program.is_file() {
        true => Ok(program),
        false => Err(format!("{} is missing: cargo build --release", program.display()).into()),
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = built_program()?;
    let command = vec![file.clone().into_os_string()];
    program::declare(program::Program { file, command });

    // A slider is pressed down with 100 N and pulled along a plane at 0.1 m/s (per metre of depth).
    let folder = std::env::temp_dir().join(format!("fretwork-study-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let case = CaseBuilder::in_plane("a slider on a plane")
        .time(1e-4, 0.02)
        .material("steel", "rail_steel_r260")
        .material("glass", "glass_bead")
        .interface(InterfaceSpec::new(
            "dry",
            ("steel", "glass"),
            "coulomb",
            &[("mu", 0.3)],
        ))
        .body(BodySpec::new(
            "floor",
            "steel",
            ShapeSpec::half_space([0.0, 1.0], [0.0, 0.0]),
        ))
        .body(
            BodySpec::new("slider", "glass", ShapeSpec::balls([([0.0, 0.0], 0.01)]))
                .position([0.0, 0.01])
                .x(Dof::Velocity(TimeFunction::Constant(0.1)))
                .y(Dof::Force(TimeFunction::Constant(-100.0))),
        );
    std::fs::write(folder.join("slider.ron"), case.case().to_ron()?)?;
    std::fs::write(folder.join("study.ron"), STUDY)?;

    // The plan lists the runs; each factor is checked against the case before any run is made.
    let setup = RunSetup {
        search: shipped::search_path(),
        plugins: Vec::new(),
        observers: record::run_observers,
        check_names: record::check_names,
    };
    let out = folder.join("results");
    std::fs::create_dir_all(&out)?;
    let place = Location {
        out: &out,
        cache: None,
        setup: &setup,
    };
    let plan = Plan::new(&StudyFile::read(&folder.join("study.ron"))?, place)?;
    assert_eq!(plan.count(), 3);

    // Two runs are made at a time. A run that is stored is not made again.
    let stop = AtomicBool::new(false);
    let ended = execute(&plan, missing(&plan), 2, None, &stop, &|point, run| {
        println!(
            "run {} ({}) took {:.2} s",
            point.number,
            plan.words(point),
            run.wall
        );
    })?;
    assert_eq!((ended, missing(&plan).len()), (3, 0));

    // The table has the work of friction, mu x 100 N over 2 mm. The files of the study are
    // table.csv, settings.csv, a page and a picture.
    let rows = Rows::of(&plan);
    for (work, mu) in rows.trusted("energy.friction").iter().zip([0.1, 0.2, 0.4]) {
        let (work, expected) = (work.ok_or("a run is not trusted")?, mu * 100.0 * 2e-3);
        println!("mu = {mu}: {work:.6} J/m");
        assert!((work - expected).abs() < 0.01 * expected);
    }
    write(&plan, &rows)?;
    assert!(out.join("table.csv").is_file());
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn std::error::Error>> {
    main()
}
