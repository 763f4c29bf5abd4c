//! Every column and every key that a run writes is in docs/outputs.md or a page in docs/outputs.

use crate::pages::{output_pages, read};
use fretwork::fields::{Fields, orientation, removed};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::record::mesh_fields::{of_bodies, of_grains, of_surfaces};
use fretwork::record::statistics_columns;
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use fretwork_observe::standard::declared;
use std::collections::BTreeSet;

/// The pages of the outputs, one after another.
fn text() -> String {
    output_pages().iter().map(|path| read(path)).collect()
}

/// Texts between backticks in the pages.
fn documented() -> BTreeSet<String> {
    let page = text();
    let words = page
        .lines()
        .flat_map(|line| line.split('`').skip(1).step_by(2));
    words.map(str::to_owned).collect()
}

fn missing(loaded: &LoadedCase, built: &Built, page: &BTreeSet<String>) -> Vec<String> {
    let case = &loaded.case;
    // Names that a case chose are BODY and NAME in the page.
    let bodies = case.bodies.iter().map(|b| (b.name.as_str(), "BODY"));
    let measures = case.measures.iter().map(|m| (m.name(), "NAME"));
    let chosen: Vec<(&str, &str)> = bodies.chain(measures).collect();
    let known = |column: &str| {
        let spelled = chosen.iter().flat_map(|(name, word)| {
            let rest = column.strip_prefix(name);
            rest.into_iter()
                .flat_map(move |rest| [format!("{word}{rest}"), format!("{word}_*")])
        });
        page.contains(column) || spelled.into_iter().any(|c| page.contains(&c))
    };
    let columns = statistics_columns(case, built.simulation.view());
    let names = columns.into_iter().map(|c| c.name);
    names.filter(|name| !known(name)).collect()
}

#[test]
fn every_column_of_the_shipped_cases_is_documented() {
    let page = documented();
    for case in [
        "wheel_rail_rigid",
        "third_body_steady",
        "fretting_wear_jump",
        "plane_shear",
        "fault_propagation",
        "rotating_drum_3d",
        "silo",
        "biaxial",
        "verification/thermal/network",
    ] {
        let path = format!("{}/cases/{case}.ron", env!("CARGO_MANIFEST_DIR"));
        let loaded = load(path.as_ref(), &[]).unwrap_or_else(|e| panic!("{e}"));
        let built = loaded.build(&search_path());
        let missing = missing(&loaded, &built.unwrap_or_else(|e| panic!("{e}")), &page);
        assert!(
            missing.is_empty(),
            "{case}: the pages of the outputs lack {missing:?}"
        );
    }
}

/// Fields without a row in the pages, or whose row has another unit.
pub(super) fn undocumented<'a>(fields: impl Iterator<Item = (&'a str, &'a str)>) -> Vec<&'a str> {
    let page = text();
    let described = |(name, unit): &(&str, &str)| {
        let mut rows = page.lines().filter(|l| l.starts_with('|'));
        rows.any(|row| row.contains(&format!("`{name}`")) && row.contains(unit))
    };
    let missing = fields.filter(|f| !described(f));
    missing.map(|(name, _)| name).collect()
}

/// Tables of fields in the pages: their objects, and the names in their first column.
pub(super) fn field_tables() -> Vec<(String, BTreeSet<String>)> {
    let page = text();
    let mut tables: Vec<(String, BTreeSet<String>)> = Vec::new();
    let mut open = false;
    for line in page.lines() {
        let Some(first) = line.strip_prefix('|').and_then(|l| l.split('|').next()) else {
            open = false;
            continue;
        };
        if let Some(kind) = first.trim().strip_prefix("of ") {
            let kind = kind.split(',').next().unwrap_or(kind);
            tables.push((kind.to_owned(), BTreeSet::new()));
            open = true;
        } else if let (true, Some((_, names))) = (open, tables.last_mut()) {
            names.extend(first.split('`').skip(1).step_by(2).map(str::to_owned));
        }
    }
    tables
}

#[test]
fn every_field_of_the_views_is_documented() {
    fn missing<S: Space>() -> Vec<String> {
        let mut fields = Fields::<S>::default();
        let more = orientation().into_iter().chain([removed()]);
        more.for_each(|f| fields.grains.add(f));
        let grains = fields.grains.iter().map(|f| (f.name, f.unit));
        let contacts = fields.contacts.iter().map(|f| (f.name, f.unit));
        let meshes = of_bodies().map(|f| (f.name, f.unit));
        let surfaces = of_surfaces(S::D).map(|f| (f.name, f.unit));
        let soft = of_grains().map(|f| (f.name, f.unit));
        let of_bodies = meshes.into_iter().chain(surfaces).chain(soft);
        let missing = undocumented(grains.chain(contacts).chain(of_bodies));
        missing.into_iter().map(str::to_owned).collect()
    }
    for missing in [missing::<Dim2>(), missing::<Dim3>()] {
        assert!(
            missing.is_empty(),
            "the pages of the outputs lack {missing:?}"
        );
    }
}

#[test]
fn every_key_of_the_summary_is_documented() {
    let page = documented();
    let path = format!(
        "{}/cases/wheel_rail_fretting.ron",
        env!("CARGO_MANIFEST_DIR")
    );
    let loaded = load(path.as_ref(), &[]).unwrap_or_else(|e| panic!("{e}"));
    let built = loaded.build_in::<Dim2>(&search_path());
    let built = built.unwrap_or_else(|e| panic!("{e}"));
    let found = declared(&loaded.case, &built);
    let summary = serde_json::to_value(&found).unwrap();
    let keys = summary.as_object().unwrap().keys();
    let missing: Vec<&String> = keys.filter(|key| !page.contains(*key)).collect();
    assert!(
        missing.is_empty(),
        "the pages of the outputs lack {missing:?}"
    );
}
