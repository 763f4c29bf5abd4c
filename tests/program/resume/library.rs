//! A run of the library with an observer and a process that are defined here: their results are in
//! its files, its checkpoints and its summary, and a callback stops it.

use super::common::{Folder, marked, same};
use fretwork::energy::Energy;
use fretwork::geometry::space::{Dim3, Space, VectorLike};
use fretwork::process::{Process, ProcessError};
use fretwork::record::checkpoint::FolderState;
use fretwork::record::encoding::{EncodingError, decode, encode};
use fretwork::record::output::Output;
use fretwork::record::quantity::Findings;
use fretwork::record::quantity::unit::METRE;
use fretwork::record::results::PreviousResults;
use fretwork::record::statistics::Column;
use fretwork::record::summary::Uncertainty;
use fretwork::record::{Observer, Run, RunEnd, RunError, RunOptions, RunView, Summary, stopped};
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork::step::{Simulation, StepReport};
use std::ops::ControlFlow;
use std::path::Path;

/// The mean gap of all contacts, and its mean over the steps.
#[derive(Debug, Default)]
struct MeanGap {
    sum: f64,
    steps: u64,
}

fn mean_gap(run: &dyn RunView) -> f64 {
    let mut sum = 0.0;
    run.visit_contacts(&mut |contact| sum += contact.gap);
    sum / run.contact_count().max(1) as f64
}

impl Observer for MeanGap {
    fn name(&self) -> String {
        "mean gap".to_owned()
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        self.sum += mean_gap(run);
        self.steps += 1;
    }

    fn columns(&self) -> Vec<Column> {
        vec![Column::new("mean_gap", "m", "mean gap of all contacts")]
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        vec![mean_gap(run)]
    }

    fn report(&self, _: &RunEnd<'_>, found: &mut Findings) {
        let mean = self.sum / self.steps as f64;
        found.measure("mean_gap_of_run", mean, METRE, "mean gap of the run");
    }

    fn files(&self, end: &RunEnd<'_>) -> Vec<Output> {
        let text = format!("{} steps, {:e}\n", end.simulation.steps(), self.sum);
        let file = "mean_gap.txt".to_owned();
        vec![Output::Text { file, text }]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&(self.sum, self.steps))
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        (self.sum, self.steps) = decode(from)?;
        Ok(())
    }
}

/// Pushes a ball along x with a force that decreases with the impulse that it gave: F = F0 (1 -
/// J/J0).
#[derive(Debug)]
struct Push {
    body: usize,
    given: f64,
}

const FORCE: f64 = 0.5;
const LIMIT: f64 = 0.02;

impl<S: Space> Process<S> for Push {
    fn name(&self) -> &str {
        "push"
    }

    fn before_detection(&mut self, s: &mut Simulation<S>) -> Result<(), ProcessError> {
        let mut impulse = S::Vector::zero();
        impulse[0] = s.options.scheme.h * FORCE * (1.0 - self.given / LIMIT);
        self.given += impulse[0];
        s.apply_impulse(self.body, &impulse, &S::Spin::zero());
        Ok(())
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.given)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.given = decode(from)?;
        Ok(())
    }
}

const SETS: [&str; 2] = ["output.checkpoint=Never", "output.frames=2"];

/// Newton's cradle with a push on the middle ball.
fn cradle() -> (LoadedCase, Built) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/newton_cradle.ron");
    let loaded = load(&path, &SETS.map(str::to_owned)).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build(&search_path());
    let mut built = built.unwrap_or_else(|e| panic!("{e}"));
    let simulation = built.simulation.get_mut::<Dim3>().unwrap();
    simulation.add_process(Push {
        body: 2,
        given: 0.0,
    });
    (loaded, built)
}

fn options(folder: &Folder) -> RunOptions {
    RunOptions {
        out: folder.0.clone(),
        threads: 1,
    }
}

/// Stops the run in a folder after a number of steps.
fn stop_after(folder: &Folder, step: u64) -> Summary {
    let (loaded, built) = cradle();
    let options = options(folder);
    let run = Run::new(&loaded, built, &options).observe(MeanGap::default());
    let stopped = run.execute(&mut |p| match p.steps.0 == step {
        true => ControlFlow::Break("had enough".to_owned()),
        false => ControlFlow::Continue(()),
    });
    stopped.unwrap_or_else(|e| panic!("{e}"))
}

/// Resumes the run in a folder to its end.
fn resume(folder: &Folder, observer: Option<MeanGap>) -> Result<Summary, RunError> {
    let (loaded, built) = cradle();
    let options = options(folder);
    let FolderState::State(stop) = stopped(&loaded, &built, &options)? else {
        panic!("no state to go on from");
    };
    let mut run = Run::new(&loaded, built, &options).resume(stop);
    if let Some(observer) = observer {
        run = run.observe(observer);
    }
    run.execute(&mut |_| ControlFlow::Continue(()))
}

#[test]
fn an_observer_and_a_process_of_a_user_are_recorded() {
    let folder = Folder::new("library-whole");
    let (loaded, built) = cradle();
    let mass = built.simulation.bodies().mass[0];
    let options = options(&folder);
    let run = Run::new(&loaded, built, &options).observe(MeanGap::default());
    let summary = run.execute(&mut |_| ControlFlow::Continue(())).unwrap();
    assert!(summary.run.stopped.is_none());
    // Three pairs of balls are half a millimetre apart. Half a step, at whose end gaps are
    // measured, moves the pushed ball by h v/2 towards one of them, v = h F0/m.
    let kept = PreviousResults::open(&folder.0.join("results.h5")).unwrap();
    let names = ["mean_gap", "kinetic", "external_work"].map(str::to_owned);
    let columns = kept.statistics(&names, 600).unwrap();
    let gap = 5e-4 - 0.5 * 1e-4 * (1e-4 * FORCE / mass) / 3.0;
    assert!((columns[0][0] - gap).abs() < 1e-12, "{}", columns[0][0]);
    let text = std::fs::read_to_string(folder.0.join("statistics.csv")).unwrap();
    assert!(text.lines().next().unwrap().ends_with(",mean_gap [m]"));
    let found = summary.found.number("measures.mean_gap_of_run").unwrap();
    let mean = columns[0].iter().sum::<f64>() / 600.0;
    assert!((found / mean - 1.0).abs() < 1e-12);
    let unit = summary.found.text("measure_units.mean_gap_of_run");
    assert_eq!(unit, Some("m"));
    assert!(folder.0.join("mean_gap.txt").exists());
    // J = J0 (1 - (1 - h F0/J0)^n), and the work of the push is the gain of kinetic energy: impacts
    // with e = 1 dissipate nothing.
    let given = LIMIT * (1.0 - (1.0 - 1e-4 * FORCE / LIMIT).powi(600));
    assert!(given > 0.5 * LIMIT && mass > 0.0);
    let e = summary.found.get::<Energy>().unwrap();
    let gain = e.kinetic - mass;
    assert!(
        e.external_work > 0.0 && (gain / e.external_work - 1.0).abs() < 1e-6,
        "{gain} {e:?}"
    );
    assert!(e.relative_residual() < 1e-9);
}

#[test]
fn a_callback_stops_a_run_with_all_its_files_and_it_goes_on_with_the_same_bits() {
    let (whole, folder) = (Folder::new("library-one"), Folder::new("library-two"));
    let (loaded, built) = cradle();
    let options = options(&whole);
    let run = Run::new(&loaded, built, &options).observe(MeanGap::default());
    run.execute(&mut |_| ControlFlow::Continue(())).unwrap();

    let summary = stop_after(&folder, 250);
    let said = summary.run.stopped.unwrap();
    assert_eq!(said, "had enough after step 250 of 600");
    assert!(summary.run.interrupted && summary.found.number("steps") == Some(250.0));
    let text = std::fs::read_to_string(folder.0.join("summary.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["stopped"], said);
    let rows = std::fs::read_to_string(folder.0.join("statistics.csv")).unwrap();
    assert_eq!(rows.lines().count(), 251);
    assert!(!marked(&folder.0.join("results.h5")));
    for file in [
        "grains.vtkhdf",
        "contacts.vtkhdf",
        "bodies.vtkhdf",
        "shapes.vtkhdf",
        "mean_gap.txt",
    ] {
        assert!(folder.0.join(file).exists(), "{file}");
    }

    resume(&folder, Some(MeanGap::default())).unwrap_or_else(|e| panic!("{e}"));
    same(&whole.0, &folder.0);
}

#[test]
fn a_run_does_not_go_on_without_its_observers() {
    let folder = Folder::new("library-without");
    stop_after(&folder, 20);
    let error = resume(&folder, None).unwrap_err().to_string();
    assert!(error.contains("observers"), "{error}");
    resume(&folder, Some(MeanGap::default())).unwrap_or_else(|e| panic!("{e}"));
}

/// The effect of a user's process in a step cannot be undone unless the process says so: the run
/// then does not estimate its error.
#[test]
fn steps_with_a_process_that_does_not_permit_it_are_not_repeated() {
    let folder = Folder::new("library-repeats");
    let (mut loaded, built) = cradle();
    loaded.case.uncertainty.repeats = Some(5);
    let options = options(&folder);
    let run = Run::new(&loaded, built, &options);
    let summary = run.execute(&mut |_| ControlFlow::Continue(())).unwrap();
    let repeats = &summary.found.get::<Uncertainty>().unwrap().repeats;
    let reason = repeats.reason.as_deref().unwrap_or_default();
    assert!(repeats.places == 0 && reason.contains("`push`"), "{reason}");
}

#[test]
fn two_columns_of_one_name_are_refused() {
    let folder = Folder::new("library-twice");
    let (loaded, built) = cradle();
    let options = options(&folder);
    let run = Run::new(&loaded, built, &options);
    let run = run.observe(MeanGap::default()).observe(MeanGap::default());
    let error = run.execute(&mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(
        matches!(&error, RunError::NameTwice { name, .. } if name == "mean_gap"),
        "{error}"
    );
}
