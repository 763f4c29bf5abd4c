//! The tables of docs/outputs.md and of the pages in docs/outputs list what the shipped observers
//! declare. With `FRETWORK_WRITE_PAGES=1` the test writes them.

use crate::pages::{output_pages, read, settle};
use fretwork::record::RunEnd;
use fretwork::record::quantity::{Findings, Role, Topic};
use fretwork::record::statistics::Table;
use fretwork::record::summary::Uncertainty;
use fretwork::scene::case::Case;
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork_observe::first_bodies::WearMaterials;
use fretwork_observe::standard;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// Cases that together have all observers.
const CASES: [&str; 8] = [
    "wheel_rail_fretting",
    "third_body_steady",
    "fretting_wear_jump",
    "shear_cell_3d",
    "biaxial",
    "silo",
    "verification/rubber_block",
    "surface_temperatures",
];

/// Cases that together with those above have all columns of the statistics, with their `--set`
/// arguments.
const FOR_COLUMNS: [(&str, &[&str]); 5] = [
    ("fretting_resistance", &[]),
    ("rotating_drum_2d", &[]),
    ("fault_propagation", &[]),
    ("plane_shear", &[]),
    ("wheel_rail_fretting", &["accuracy=0.05"]),
];

/// Path, units in 3D and 2D, explanation, and whether it describes the course of the run.
pub type Declared = (String, [String; 2], String, bool);

fn add(loaded: &LoadedCase, built: &Built, all: &mut Vec<Declared>) {
    let found = standard::declared(&loaded.case, built.simulation.view());
    let spelled =
        |unit: fretwork::record::quantity::Unit| [3, 2].map(|d| unit.symbol(d).to_owned());
    // Names that a case chose are replaced.
    let chosen = |path: &str| {
        ["measures.", "measure_units.", "findings."]
            .iter()
            .any(|g| path.starts_with(g))
    };
    // A list without entries stands for what its entries will be.
    let values = found
        .all()
        .iter()
        .filter(|q| !found.expects_below(&q.name()));
    let now = values.map(|q| {
        let run = q.role == Role::Diagnostic || q.topic == Topic::Run;
        (q.pattern(), spelled(q.unit), q.doc.clone(), run)
    });
    let later = found.expected().iter().map(|e| {
        let group = e.path.split('.').next().unwrap_or_default();
        let of_run = found
            .all()
            .iter()
            .find(|q| q.pattern().split('.').next() == Some(group));
        let run = of_run.is_some_and(|q| q.role == Role::Diagnostic || q.topic == Topic::Run);
        (e.path.clone(), spelled(e.unit), e.doc.clone(), run)
    });
    all.extend(now.chain(later).filter(|d| !chosen(&d.0)));
}

fn built(case: &str, sets: &[&str]) -> (LoadedCase, Built) {
    let path = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let loaded = load(path.as_ref(), &sets).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build(&search_path());
    (loaded, built.unwrap_or_else(|e| panic!("{e}")))
}

/// All numbers that the shipped observers declare, by their paths.
pub fn declared() -> Vec<Declared> {
    let mut all = Vec::new();
    for case in CASES {
        let (loaded, built) = built(case, &[]);
        add(&loaded, &built, &mut all);
    }
    let mut first: BTreeMap<String, Declared> = BTreeMap::new();
    for d in all.into_iter().filter(|d| !d.1[0].is_empty()) {
        first.entry(d.0.clone()).or_insert(d);
    }
    first.into_values().collect()
}

/// Rows of a table of the statistics or of measures: name, unit and explanation.
type Rows = Vec<[String; 3]>;

/// Names that a case chose.
struct Chosen<'a> {
    measures: Vec<&'a str>,
    bodies: Vec<&'a str>,
}

/// What follows one of these names at the start of a text, after it or after `_`.
fn after(text: &str, names: &[&str]) -> Option<String> {
    let rest = names.iter().filter_map(|name| text.strip_prefix(name));
    let mut rest = rest.filter(|rest| rest.is_empty() || rest.starts_with('_'));
    rest.next().map(str::to_owned)
}

impl<'a> Chosen<'a> {
    fn of(case: &'a Case) -> Self {
        let bodies = case.bodies.iter().map(|b| b.name.as_str());
        let bodies = bodies.chain(case.elastic.iter().map(|b| b.name.as_str()));
        let bodies = bodies.chain(case.half_spaces.iter().map(|b| b.name.as_str()));
        Self {
            measures: case.measures.iter().map(|m| m.name()).collect(),
            bodies: bodies.collect(),
        }
    }

    /// The kind of an observer by its name, and whether it is a measure.
    fn kind<'b>(&self, observer: &'b str) -> (&'b str, bool) {
        let mut measures = self.measures.iter();
        let measure = measures.find_map(|name| observer.strip_suffix(name));
        (measure.map_or(observer, str::trim_end), measure.is_some())
    }

    /// The name of a column of a kind of observer.
    fn column(&self, name: &str, (kind, is_measure): (&str, bool)) -> String {
        match (after(name, &self.measures), after(name, &self.bodies)) {
            (Some(rest), _) if is_measure => format!("NAME{rest}"),
            (_, Some(rest)) if kind == "deformable bodies" => {
                let (_, axis) = rest.rsplit_once('_').unwrap_or_default();
                format!("BODY_PART_{axis}")
            }
            (_, Some(rest)) => format!("BODY{rest}"),
            _ => name.to_owned(),
        }
    }

    /// The path of a number of a measure; `None` of another number.
    fn measure(&self, path: &str) -> Option<String> {
        let name = path.strip_prefix("measures.")?;
        Some(match after(name, &self.measures) {
            Some(rest) => format!("measures.NAME{}", self.without_bodies(&rest)),
            None => path.to_owned(),
        })
    }

    /// A text with `BODY` for the names of bodies in the places of a third body.
    fn without_bodies(&self, text: &str) -> String {
        let mut text = text.to_owned();
        for one in &self.bodies {
            for other in &self.bodies {
                text = text.replace(&format!("{one}_{other}"), "BODY_BODY");
            }
            text = text.replace(&format!("{one}_grain"), "BODY_grain");
        }
        text
    }
}

/// Cases that together have all columns and measures, with their `--set` arguments.
fn all_cases() -> Vec<(LoadedCase, Built)> {
    let cases = CASES.map(|case| (case, &[][..])).into_iter();
    let cases = cases.chain(FOR_COLUMNS);
    cases.map(|(case, sets)| built(case, sets)).collect()
}

fn add_row(rows: &mut Rows, name: String, unit: String, doc: &str) {
    if rows.iter().all(|row| row[0] != name) {
        rows.push([name, unit, doc.replace('|', "\\|")]);
    }
}

/// The columns of the statistics, by their observers. `NAME` stands for a measure, `BODY` for a
/// first body and `PART` for a part by which it is held.
fn columns(cases: &[(LoadedCase, Built)]) -> BTreeMap<String, Rows> {
    let mut all: BTreeMap<String, Rows> = BTreeMap::new();
    for (LoadedCase { case, .. }, built) in cases {
        let chosen = Chosen::of(case);
        for observer in
            standard::observers(case, built.simulation.view(), &WearMaterials::default()).iter()
        {
            let own = observer.name();
            let kind = chosen.kind(&own);
            let list = all.entry(kind.0.to_owned()).or_default();
            for column in observer.columns() {
                let unit = units(column.unit.heading(3), column.unit.heading(2));
                add_row(list, chosen.column(&column.name, kind), unit, column.doc);
            }
        }
    }
    all.retain(|_, list| !list.is_empty());
    all
}

/// The columns of the tables of events, by the tables.
fn events(cases: &[(LoadedCase, Built)]) -> BTreeMap<&'static str, Rows> {
    let mut all: BTreeMap<&str, Rows> = BTreeMap::new();
    for (LoadedCase { case, .. }, built) in cases {
        let observers =
            standard::observers(case, built.simulation.view(), &WearMaterials::default());
        for table in observers.event_tables() {
            let list = all.entry(table.name).or_default();
            for column in table.columns.into_iter().chain(table.list) {
                let unit = units(column.unit.heading(3), column.unit.heading(2));
                add_row(list, column.name, unit, column.doc);
            }
        }
    }
    all
}

/// The numbers of measures, by their observers.
fn measures(cases: &[(LoadedCase, Built)]) -> BTreeMap<String, Rows> {
    let mut all: BTreeMap<String, Rows> = BTreeMap::new();
    for (LoadedCase { case, .. }, built) in cases {
        let (chosen, run) = (Chosen::of(case), built.simulation.view());
        let observers = standard::observers(case, run, &WearMaterials::default());
        let end = RunEnd {
            simulation: run,
            table: &Table::new(observers.columns(), run.dimension()),
            title: "",
            uncertainty: &Uncertainty::default(),
            wall: Duration::ZERO,
        };
        for observer in observers.iter() {
            let mut found = Findings::new(run.dimension());
            observer.report(&end, &mut found);
            let own = observer.name();
            let list = all.entry(chosen.kind(&own).0.to_owned()).or_default();
            let now = found.all().iter().map(|q| (q.name(), q.unit, &q.doc));
            let later = found.expected().iter();
            let later = later.map(|e| (e.path.clone(), e.unit, &e.doc));
            for (path, unit, doc) in now.chain(later) {
                if let Some(path) = chosen.measure(&path) {
                    let unit = units(unit.symbol(3), unit.symbol(2));
                    add_row(list, path, unit, &chosen.without_bodies(doc));
                }
            }
        }
    }
    all
}

/// A unit in space and in the plane.
fn units(space: &str, plane: &str) -> String {
    match space == plane {
        true => space.to_owned(),
        false => format!("{space}; {plane}"),
    }
}

fn table_of_columns(columns: &Rows) -> String {
    let mut out = String::from("| column | unit | meaning |\n|---|---|---|\n");
    for [name, unit, doc] in columns {
        out += &format!("| `{name}` | {unit} | {doc} |\n");
    }
    out
}

fn table_of_measures(cases: &[(LoadedCase, Built)]) -> String {
    let mut out = String::from("| of | path | unit | meaning |\n|---|---|---|---|\n");
    for (kind, mut rows) in measures(cases) {
        rows.sort();
        for [path, unit, doc] in rows {
            out += &format!("| {kind} | `{path}` | {unit} | {doc} |\n");
        }
    }
    out
}

/// The first name of a path: `energy` of `energy.friction`.
fn group(path: &str) -> &str {
    path.split('.').next().unwrap_or(path)
}

/// The table of the numbers of these groups.
fn table(declared: &[&Declared], groups: &[&str]) -> String {
    let mut out = String::from("| path | unit | meaning |\n|---|---|---|\n");
    let wanted = declared.iter().filter(|d| groups.contains(&group(&d.0)));
    for (path, [space, plane], doc, _) in wanted {
        let unit = units(space, plane);
        let doc = doc.replace('|', "\\|");
        out += &format!("| `{path}` | {unit} | {doc} |\n");
    }
    out
}

/// The tables of numbers, by their marks: `<!-- results: energy wear -->` in a page is the place of
/// the results whose paths begin with `energy` or `wear`. Each group has one mark.
fn tables_of_groups(pages: &[String]) -> Vec<(String, String)> {
    let all = declared();
    let mut tables = Vec::new();
    for (kind, of_run) in [("results", false), ("run", true)] {
        let declared: Vec<&Declared> = all.iter().filter(|d| d.3 == of_run).collect();
        let mut left: BTreeSet<&str> = declared.iter().map(|d| group(&d.0)).collect();
        let begin = format!("<!-- {kind}: ");
        let lines = pages.iter().flat_map(|page| page.lines());
        let marks = lines.filter_map(|l| l.strip_prefix(&*begin)?.strip_suffix(" -->"));
        for mark in marks {
            let groups: Vec<&str> = mark.split_whitespace().collect();
            for of in &groups {
                let once = left.remove(of);
                assert!(once, "`{of}` has several marks, or no number, of {kind}");
            }
            tables.push((format!("{kind}: {mark}"), table(&declared, &groups)));
        }
        assert!(
            left.is_empty(),
            "no page of the outputs has a mark {begin}... --> with {left:?}"
        );
    }
    tables
}

#[test]
fn the_page_lists_every_quantity_with_its_unit() {
    let paths = output_pages();
    let mut pages: Vec<String> = paths.iter().map(|path| read(path)).collect();
    let cases = all_cases();
    let columns = columns(&cases).into_iter();
    let columns = columns.map(|(of, list)| (format!("columns: {of}"), table_of_columns(&list)));
    let measures = ("measures".to_owned(), table_of_measures(&cases));
    let events = events(&cases).into_iter();
    let events = events.map(|(of, list)| (format!("events: {of}"), table_of_columns(&list)));
    let mut tables = tables_of_groups(&pages);
    tables.push(measures);
    tables.extend(columns.chain(events));
    for (name, table) in tables {
        let begin = format!("<!-- {name} -->\n");
        let end = format!("<!-- end of {name} -->");
        let page = pages.iter_mut().find(|page| page.contains(&begin));
        let page = page.unwrap_or_else(|| panic!("no page of the outputs has the mark {begin}"));
        let from = page.find(&begin).unwrap() + begin.len();
        let to = page[from..].find(&end).map(|k| from + k);
        let to = to.unwrap_or_else(|| panic!("no page of the outputs has the mark {end}"));
        page.replace_range(from..to, &table);
    }
    let made = paths.iter().zip(&pages);
    let settled = made.map(|(path, made)| settle(path, made, "the_page_lists_every"));
    let old: Vec<String> = settled.filter_map(Result::err).collect();
    assert!(old.is_empty(), "{}", old.join("\n"));
}
