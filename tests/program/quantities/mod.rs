//! Quantities are declared by observers and shown by everything else: the quantity of one observer
//! in one file appears everywhere, no other source names a quantity, and the page on outputs lists
//! them all.

mod experiments;
mod named;
mod page;
mod wrong_names;

use crate::resume::common::Folder;
use fretwork::record::observer::{Event, EventTable};
use fretwork::record::quantity::unit::{ENERGY, METRE};
use fretwork::record::quantity::{Catalogue, Findings};
use fretwork::record::statistics::Column;
use fretwork::record::{
    Observer, Observers, Run, RunEnd, RunOptions, RunView, Summary, check_names, run_observers,
};
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork::step::StepReport;
use fretwork_experiments::runs::output::OutputName;
use fretwork_experiments::runs::unit::unit_of;
use std::ops::ControlFlow;
use std::path::Path;

/// The greatest height that a ball reached, and an event for each step in which it is higher than
/// in all before.
#[derive(Debug, Default)]
struct Summit {
    highest: f64,
    events: Vec<Event>,
}

impl Observer for Summit {
    fn name(&self) -> String {
        "summit".to_owned()
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        let (bodies, up) = (0..run.bodies().len(), run.dimension() - 1);
        let heights = bodies.map(|body| run.motion(body).position[up]);
        let now = heights.fold(f64::NEG_INFINITY, f64::max);
        if run.steps() == 1 || now > self.highest {
            self.highest = now;
            self.events.push(Event {
                table: "summits",
                row: vec![run.time(), now],
                list: Vec::new(),
            });
        }
    }

    fn columns(&self) -> Vec<Column> {
        vec![Column::new("summit", "m", "highest place so far")]
    }

    fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
        vec![self.highest]
    }

    fn event_tables(&self) -> Vec<EventTable> {
        let columns = vec![
            Column::new("time", "s", "when a ball was higher than before"),
            Column::new("height", "m", "how high it was"),
        ];
        vec![EventTable {
            name: "summits",
            columns,
            list: None,
        }]
    }

    fn after_processes(&mut self, _: &dyn RunView) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    fn report(&self, _: &RunEnd<'_>, found: &mut Findings) {
        let doc = "highest place that a ball reached";
        let summit = found.add("summit.highest", self.highest, METRE, doc);
        summit.headline("highest summit");
        let climb = found.add("summit.climbs.0.work", 2.5, ENERGY, "work of a climb");
        climb.secondary("work of the climb");
    }
}

fn cradle() -> (LoadedCase, Built) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/newton_cradle.ron");
    let sets = ["time.end=0.01", "output.frames=0", "output.figures=false"].map(str::to_owned);
    let loaded = load(&path, &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build(&search_path());
    (loaded, built.unwrap_or_else(|e| panic!("{e}")))
}

fn ran(folder: &Folder) -> Summary {
    let (loaded, built) = cradle();
    let options = RunOptions {
        out: folder.0.clone(),
        threads: 1,
    };
    let run = Run::new(&loaded, built, &options).observe(Summit::default());
    run.execute(&mut |_| ControlFlow::Continue(())).unwrap()
}

#[test]
fn a_quantity_and_events_of_one_observer_are_found_everywhere() {
    let folder = Folder::new("quantities-one");
    let summary = ran(&folder);
    let highest = summary.found.number("summit.highest").unwrap();
    assert!(highest.is_finite());
    let shown = fretwork::record::quantity::quantity(highest, "m");

    // summary.json has the value by its path, with its description.
    let text = std::fs::read_to_string(folder.0.join("summary.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["summit"]["highest"], highest);
    assert_eq!(json["summit"]["climbs"][0]["work"], 2.5);
    let catalogue = Catalogue::of(&json);
    let entry = catalogue.entry("summit.highest").unwrap();
    assert_eq!(entry.unit.as_deref(), Some("m"));
    assert_eq!(entry.doc, "highest place that a ball reached");

    // The statistics have it.
    let rows = std::fs::read_to_string(folder.0.join("statistics.csv")).unwrap();
    assert!(rows.lines().next().unwrap().ends_with(",summit [m]"));

    // The results file has it.
    let file = hdf5::H5File::open(folder.0.join("results.h5")).unwrap();
    let heights = file.dataset("events/summits/height").unwrap();
    let values = heights.read_raw::<f64>().unwrap();
    assert!(!values.is_empty() && values.is_sorted() && *values.last().unwrap() == highest);
    let times = file.dataset("events/summits/time").unwrap();
    assert_eq!(times.read_raw::<f64>().unwrap().len(), values.len());

    // The terminal shows it.
    let text = summary.text(false);
    assert!(text.contains(&format!("highest summit {shown}")), "{text}");

    // Report and comparison show it.
    let options = fretwork_view::Options {
        bytes: None,
        law: &|_, _| None,
        measured: &[],
    };
    let page = fretwork_view::report(&folder.0, &options).unwrap().page;
    let other = Folder::new("quantities-two");
    ran(&other);
    let both = folder.0.join("both.html");
    fretwork_view::compare(&[folder.0.clone(), other.0.clone()], &both, &[]).unwrap();
    for page in [page, both] {
        let page = std::fs::read_to_string(page).unwrap();
        assert!(page.contains("highest summit") && page.contains("work of the climb"));
    }

    // Studies, fits and trades accept it as an output.
    for (name, value, unit) in [
        ("summit.highest", highest, "m"),
        ("summit.climbs.0.work", 2.5, "J"),
        ("statistics.summit:max", highest, "m"),
    ] {
        let output = OutputName::parse(name).unwrap();
        assert_eq!(output.read(&json, &folder.0), Some(value));
        assert_eq!(unit_of(&output, &catalogue, &folder.0), unit);
    }
}

/// An event of a table that its observer did not declare ends the run with a message, and is not
/// lost silently.
#[test]
fn events_without_a_table_are_refused() {
    #[derive(Debug)]
    struct Stray;
    impl Observer for Stray {
        fn name(&self) -> String {
            "stray".to_owned()
        }
        fn after_processes(&mut self, _: &dyn RunView) -> Vec<Event> {
            vec![Event {
                table: "strays",
                row: vec![1.0],
                list: Vec::new(),
            }]
        }
    }
    let folder = Folder::new("quantities-stray");
    let (loaded, built) = cradle();
    let options = RunOptions {
        out: folder.0.clone(),
        threads: 1,
    };
    let run = Run::new(&loaded, built, &options).observe(Stray);
    let error = run.execute(&mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(error.to_string().contains("the table `strays`"), "{error}");
}

/// Two tables of one name would be one group of the results file. Nothing of the case names them,
/// so the error has no line.
#[test]
fn two_tables_of_events_of_one_name_are_refused() {
    #[derive(Debug)]
    struct Again;
    impl Observer for Again {
        fn name(&self) -> String {
            "again".to_owned()
        }
        fn event_tables(&self) -> Vec<EventTable> {
            Summit::default().event_tables()
        }
    }
    let (loaded, built) = cradle();
    let mut observers = run_observers(&loaded, built.simulation.view());
    observers.push(Box::new(Summit::default()));
    check_names(&loaded, &observers).unwrap();
    observers.push(Box::new(Again));
    let error = check_names(&loaded, &observers).unwrap_err();
    let said = "two tables of events are named `summits`";
    assert!(error.line == 0 && error.message.contains(said), "{error}");
}

/// Values are matched to columns by their order, so their number is checked in every row.
#[test]
fn an_observer_gives_a_value_for_each_of_its_columns() {
    #[derive(Debug)]
    struct Short;
    impl Observer for Short {
        fn name(&self) -> String {
            "short".to_owned()
        }
        fn columns(&self) -> Vec<Column> {
            ["a", "b"].map(|name| Column::new(name, "m", "")).into()
        }
        fn sample(&mut self, _: &dyn RunView) -> Vec<f64> {
            vec![1.0]
        }
    }
    let (_, built) = cradle();
    let mut observers = Observers::default();
    observers.push(Box::new(Short));
    let error = observers.sample(built.simulation.view()).unwrap_err();
    assert_eq!(
        (error.observer.as_str(), error.values, error.columns),
        ("short", 1, 2)
    );
}

/// Numbers in lists have them too.
#[test]
fn every_number_of_a_run_has_a_unit() {
    let folder = Folder::new("quantities-units");
    let summary = ran(&folder);
    for q in summary.quantities().all() {
        let number = q.value.is_number();
        assert!(
            !number || !q.unit.symbol(3).is_empty(),
            "{} has no unit",
            q.name()
        );
        assert!(
            !number || !q.doc.is_empty(),
            "{} has no explanation",
            q.name()
        );
    }
}
