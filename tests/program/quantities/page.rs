//! The tables of docs/outputs.md list what the shipped observers declare. With
//! `FRETWORK_WRITE_PAGES=1` the test writes them.

use fretwork::record::quantity::{Role, Topic};
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork_observe::standard;
use std::collections::BTreeMap;

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

/// Rows of a table of the statistics: name, unit and explanation of each column.
type Columns = Vec<[String; 3]>;

/// The columns of the statistics, by their observers. `NAME` stands for a measure, `BODY` for a
/// first body and `PART` for a part by which it is held.
fn columns() -> BTreeMap<String, Columns> {
    let mut all: BTreeMap<String, Columns> = BTreeMap::new();
    let cases = CASES.map(|case| (case, &[][..]));
    for (case, sets) in cases.into_iter().chain(FOR_COLUMNS) {
        let (LoadedCase { case, .. }, built) = built(case, sets);
        let measures: Vec<&str> = case.measures.iter().map(|m| m.name()).collect();
        let bodies = case.bodies.iter().map(|b| b.name.as_str());
        let bodies = bodies.chain(case.elastic.iter().map(|b| b.name.as_str()));
        let bodies = bodies.chain(case.half_spaces.iter().map(|b| b.name.as_str()));
        let bodies: Vec<&str> = bodies.collect();
        let after = |text: &str, names: &[&str]| {
            let rest = names.iter().filter_map(|name| text.strip_prefix(name));
            let mut rest = rest.filter(|rest| rest.is_empty() || rest.starts_with('_'));
            rest.next().map(str::to_owned)
        };
        for observer in standard::observers(&case, built.simulation.view(), 1.0).iter() {
            let own = observer.name();
            let measure = measures.iter().find_map(|name| own.strip_suffix(name));
            let kind = measure.map_or(own.as_str(), str::trim_end);
            let named = |name: &str| match (after(name, &measures), after(name, &bodies)) {
                (Some(rest), _) if measure.is_some() => format!("NAME{rest}"),
                (_, Some(rest)) if kind == "deformable bodies" => {
                    let (_, axis) = rest.rsplit_once('_').unwrap_or_default();
                    format!("BODY_PART_{axis}")
                }
                (_, Some(rest)) => format!("BODY{rest}"),
                _ => name.to_owned(),
            };
            let list = all.entry(kind.to_owned()).or_default();
            for column in observer.columns() {
                let name = named(&column.name);
                if list.iter().all(|row| row[0] != name) {
                    let doc = column.doc.replace('|', "\\|");
                    list.push([
                        name,
                        units(column.unit.heading(3), column.unit.heading(2)),
                        doc,
                    ]);
                }
            }
        }
    }
    all.retain(|_, list| !list.is_empty());
    all
}

/// A unit in space and in the plane.
fn units(space: &str, plane: &str) -> String {
    match space == plane {
        true => space.to_owned(),
        false => format!("{space}; {plane}"),
    }
}

fn table_of_columns(columns: &Columns) -> String {
    let mut out = String::from("| column | unit | meaning |\n|---|---|---|\n");
    for [name, unit, doc] in columns {
        out += &format!("| `{name}` | {unit} | {doc} |\n");
    }
    out
}

fn table(of_run: bool) -> String {
    let mut out = String::from("| path | unit | meaning |\n|---|---|---|\n");
    for (path, [space, plane], doc, _) in declared().into_iter().filter(|d| d.3 == of_run) {
        let unit = units(&space, &plane);
        let doc = doc.replace('|', "\\|");
        out += &format!("| `{path}` | {unit} | {doc} |\n");
    }
    out
}

#[test]
fn the_page_lists_every_quantity_with_its_unit() {
    let path = format!("{}/docs/outputs.md", env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(&path).unwrap();
    let mut made = page.clone();
    let quantities = [("results", false), ("run", true)];
    let quantities = quantities.map(|(name, of_run)| (name.to_owned(), table(of_run)));
    let columns = columns().into_iter();
    let columns = columns.map(|(of, list)| (format!("columns: {of}"), table_of_columns(&list)));
    for (name, table) in quantities.into_iter().chain(columns) {
        let begin = format!("<!-- {name} -->\n");
        let end = format!("<!-- end of {name} -->");
        let place = |mark: &str| {
            let place = made.find(mark);
            place.unwrap_or_else(|| panic!("docs/outputs.md has no mark {mark}"))
        };
        let (from, to) = (place(&begin) + begin.len(), place(&end));
        made.replace_range(from..to, &table);
    }
    if std::env::var_os("FRETWORK_WRITE_PAGES").is_some() {
        std::fs::write(&path, &made).unwrap();
        return;
    }
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (old, new) = (lines(&page), lines(&made));
    let missing: Vec<&String> = new.iter().filter(|l| !old.contains(l)).collect();
    let gone: Vec<&String> = old.iter().filter(|l| !new.contains(l)).collect();
    assert!(
        page == made,
        "docs/outputs.md is old; write it with FRETWORK_WRITE_PAGES=1 cargo test --test program \
         the_page_lists_every; it lacks {missing:#?} and still has {gone:#?}"
    );
}
