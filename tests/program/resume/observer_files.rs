//! An observer of a user of the library with its own table and pictures: they are in the folder of
//! the run, are continued by a resumed run, and those of an older run are removed when a run
//! starts.

use super::common::{Folder, files, same};
use crate::scene;
use fretwork::record::checkpoint::FolderState;
use fretwork::record::encoding::{EncodingError, decode, encode};
use fretwork::record::output::Output;

use fretwork::record::{
    Observer, Paint, Picture, PictureContent, Run, RunEnd, RunOptions, RunView, Summary, stopped,
};
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::step::StepReport;
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;

/// Writes the largest speed of the balls every ten steps as a table, and pictures in which each
/// ball has its own colour.
#[derive(Debug, Default)]
struct Speeds {
    rows: Vec<(f64, f64)>,
}

impl Observer for Speeds {
    fn name(&self) -> String {
        "speeds".to_owned()
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        if run.steps().is_multiple_of(10) {
            let bodies = 0..run.bodies().len();
            let speeds = bodies.map(|body| run.motion(body).speed());
            self.rows.push((run.time(), speeds.fold(0.0, f64::max)));
        }
    }

    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        let paints = (0..run.balls().len()).map(|k| Paint::Layer(k as i64));
        vec![Picture {
            name: "balls",
            shows: PictureContent::Paints(paints.collect()),
        }]
    }

    fn picture_names(&self) -> Vec<&'static str> {
        vec!["balls"]
    }

    fn files(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let mut text = "time [s],speed [m/s]\n".to_owned();
        for (time, speed) in &self.rows {
            writeln!(text, "{time:e},{speed:e}").unwrap();
        }
        let file = "speeds.csv".to_owned();
        vec![Output::Text { file, text }]
    }

    fn file_names(&self) -> Vec<String> {
        vec!["speeds.csv".to_owned()]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.rows)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.rows = decode(from)?;
        Ok(())
    }
}

const SETS: [&str; 4] = [
    "output.checkpoint=Never",
    "output.frames=2",
    "output.width=200",
    "output.figures=false",
];

/// Newton's cradle, 600 steps.
fn cradle() -> (LoadedCase, Built) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/newton_cradle.ron");
    let loaded = load(&path, &SETS.map(str::to_owned)).unwrap_or_else(|e| panic!("{e}"));
    let built = scene::built(&loaded);
    (loaded, built)
}

/// Runs to the end or to a step, from the start or from the state in the folder.
fn run(folder: &Folder, until: Option<u64>, resumed: bool) -> Summary {
    let (loaded, built) = cradle();
    let options = RunOptions {
        out: folder.0.clone(),
        threads: 1,
    };
    let stop = resumed.then(|| match stopped(&loaded, &built, &options) {
        Ok(FolderState::State(stop)) => stop,
        other => panic!("no state to resume: {:?}", other.err()),
    });
    let mut run = Run::new(&loaded, built, &options).observe(Speeds::default());
    if let Some(stop) = stop {
        run = run.resume(stop);
    }
    let summary = run.execute(&mut |p| match until == Some(p.steps.0) {
        true => ControlFlow::Break("wanted".to_owned()),
        false => ControlFlow::Continue(()),
    });
    summary.unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_table_of_an_observer_goes_on_over_a_resumption() {
    let (whole, parts) = (Folder::new("table-whole"), Folder::new("table-parts"));
    run(&whole, None, false);
    let table = |folder: &Folder| std::fs::read_to_string(folder.0.join("speeds.csv")).unwrap();
    let text = table(&whole);
    assert_eq!(text.lines().count(), 1 + 60);
    // The first ball arrives with 1 m/s, and balls of equal mass that lose nothing pass it on.
    for line in text.lines().skip(1) {
        let speed: f64 = line.split_once(',').unwrap().1.parse().unwrap();
        assert!((speed - 1.0).abs() < 1e-6, "{line}");
    }
    assert!(run(&parts, Some(255), false).run.interrupted);
    assert_eq!(table(&parts).lines().count(), 1 + 25);
    run(&parts, None, true);
    same(&whole.0, &parts.0);
}

/// An observer with a file of a given name.
#[derive(Debug)]
struct Named(&'static str);

impl Observer for Named {
    fn name(&self) -> String {
        "named".to_owned()
    }

    fn file_names(&self) -> Vec<String> {
        vec![self.0.to_owned()]
    }
}

/// Names of the program's files are rejected before anything is written or removed.
#[test]
fn a_file_of_an_observer_is_none_of_the_programs() {
    let folder = Folder::new("observer-own");
    for name in [
        "results.h5",
        "Results.H5",
        "results.h5.part",
        "results.lock",
        "statistics.csv",
        "summary.json",
        "summary.part",
        "report.html",
        "frames",
        "energy.png",
    ] {
        let (loaded, built) = cradle();
        let options = RunOptions {
            out: folder.0.clone(),
            threads: 1,
        };
        let run = Run::new(&loaded, built, &options).observe(Named(name));
        let refused = run.execute(&mut |_| panic!("a step of a run with {name}"));
        let said = refused.map(|_| ()).unwrap_err().to_string();
        assert!(
            said.contains("two files in the folder of the results are named")
                && said.contains(&name.to_lowercase()),
            "{name}: {said}"
        );
        assert!(!folder.0.exists(), "{name}");
    }
    // Another name is allowed.
    let (loaded, built) = cradle();
    let options = RunOptions {
        out: folder.0.clone(),
        threads: 1,
    };
    let run = Run::new(&loaded, built, &options).observe(Named("mine.h5"));
    run.execute(&mut |_| ControlFlow::Break("enough".to_owned()))
        .unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn files_and_pictures_of_an_observer_are_removed_when_a_run_starts_over() {
    let folder = Folder::new("observer-again");
    run(&folder, None, false);
    let first = files(&folder.0);
    let pictures = |all: &[String]| {
        all.iter()
            .filter(|f| f.starts_with("frames/balls_"))
            .count()
    };
    assert_eq!(pictures(&first), 3);
    // The folder has a picture of a longer run, and two files that no observer names.
    let old = folder.0.join("frames/balls_00099999.png");
    let others = ["frames/mine_00000001.png", "speeds.csv.bak"];
    std::fs::write(&old, "old").unwrap();
    for other in others {
        std::fs::write(folder.0.join(other), "other").unwrap();
    }
    // The table of the old run is removed as soon as the new run has begun.
    let (loaded, built) = cradle();
    let options = RunOptions {
        out: folder.0.clone(),
        threads: 1,
    };
    let table = folder.0.join("speeds.csv");
    let mut seen = None;
    let run = Run::new(&loaded, built, &options).observe(Speeds::default());
    run.execute(&mut |_| {
        seen.get_or_insert_with(|| (table.exists(), old.exists()));
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(seen, Some((false, false)));
    let mut wanted = first;
    wanted.extend(others.map(str::to_owned));
    wanted.sort();
    assert_eq!(files(&folder.0), wanted);
}
