//! The tables of docs/outputs.md list what the shipped observers declare. With
//! `FRETWORK_WRITE_PAGES=1` the test writes them.

use fretwork::record::quantity::{Role, Topic};
use fretwork::scene::{Built, Loaded, load};
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

/// Path, units in space and in the plane, explanation, and whether it is of the course of the run.
pub type Declared = (String, [String; 2], String, bool);

fn add(loaded: &Loaded, built: &Built, all: &mut Vec<Declared>) {
    let found = standard::declared(&loaded.case, built.simulation.view());
    let spelled =
        |unit: fretwork::record::quantity::Unit| [3, 2].map(|d| unit.symbol(d).to_owned());
    // Names that a case chose.
    let chosen = |path: &str| {
        ["measures.", "measure_units.", "findings."]
            .iter()
            .any(|g| path.starts_with(g))
    };
    let now = found.all().iter().map(|q| {
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

/// All numbers that the shipped observers declare, by their paths.
pub fn declared() -> Vec<Declared> {
    let mut all = Vec::new();
    for case in CASES {
        let path = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
        let loaded = load(path.as_ref(), &[]).unwrap_or_else(|e| panic!("{e}"));
        let built = loaded.build(&search_path());
        let built = built.unwrap_or_else(|e| panic!("{e}"));
        add(&loaded, &built, &mut all);
    }
    let mut first: BTreeMap<String, Declared> = BTreeMap::new();
    for d in all.into_iter().filter(|d| !d.1[0].is_empty()) {
        first.entry(d.0.clone()).or_insert(d);
    }
    first.into_values().collect()
}

fn table(of_run: bool) -> String {
    let mut out = String::from("| path | unit | meaning |\n|---|---|---|\n");
    for (path, [space, plane], doc, _) in declared().into_iter().filter(|d| d.3 == of_run) {
        let unit = match space == plane {
            true => space,
            false => format!("{space}; {plane}"),
        };
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
    for (name, of_run) in [("results", false), ("run", true)] {
        let (begin, end) = (
            format!("<!-- {name} -->\n"),
            format!("<!-- end of {name} -->"),
        );
        let from = made.find(&begin).expect("the page has the mark") + begin.len();
        let to = made.find(&end).expect("the page has the mark");
        made.replace_range(from..to, &table(of_run));
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
