//! Names, units and descriptions in the files of a run are those of the registries of fields and
//! columns, and the page of the outputs has only registered fields.

use super::documented::{field_tables, undocumented};
use super::folder;
use fretwork::fields::{FieldList, Fields, orientation};
use fretwork::geometry::space::{Dim2, Dim3, Space};
use fretwork::record::mesh_fields::{MeshField, of_bodies, of_grains, of_surfaces};
use fretwork::record::{RunOptions, run, statistics_columns};
use fretwork::scene::{Built, LoadedCase, load};
use fretwork::shipped::search_path;
use hdf5::H5File;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Unit and description by name.
type Known = BTreeMap<String, [String; 2]>;

fn known<'a>(fields: impl IntoIterator<Item = (&'a str, &'a str, &'a str)>) -> Known {
    let entry = |(name, unit, doc): (&str, &str, &str)| {
        let unit = if unit.is_empty() { "1" } else { unit };
        (name.to_owned(), [unit.to_owned(), doc.to_owned()])
    };
    fields.into_iter().map(entry).collect()
}

fn of_list<S: Space, T>(fields: &FieldList<S, T>) -> Known {
    known(fields.iter().map(|f| (f.name, f.unit, f.doc)))
}

fn of_mesh<T>(fields: &[MeshField<T>]) -> Known {
    known(fields.iter().map(|f| (f.name, f.unit, f.doc)))
}

/// Returns the datasets of the file in these groups.
fn written(file: &H5File, groups: &[&str]) -> Known {
    let mut out = Known::new();
    for path in file.dataset_names() {
        let Some((group, name)) = path.rsplit_once('/') else {
            continue;
        };
        if !groups.contains(&group) {
            continue;
        }
        let set = file.dataset(&path).unwrap();
        let attributes = ["unit", "doc"].map(|a| set.attr(a).unwrap().read_string().unwrap());
        assert!(attributes.iter().all(|a| !a.is_empty()), "{path}");
        out.insert(name.to_owned(), attributes);
    }
    out
}

/// Runs a case for one step.
fn ran(case: &str, out: &Path, check: &dyn Fn(&H5File)) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(case);
    let read = load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    let sets = [
        format!("time.end={}", read.case.time.step),
        "output.frames=0".to_owned(),
        "output.views=1".to_owned(),
        "output.shear=1.0".to_owned(),
    ];
    let loaded = load(&path, &sets).unwrap_or_else(|e| panic!("{e}"));
    let search = search_path();
    let built = loaded.build(&search).unwrap_or_else(|e| panic!("{e}"));
    statistics_agree(&loaded, built, out);
    check(&H5File::open(out.join("results.h5")).unwrap());
    std::fs::remove_dir_all(out).ok();
}

/// The columns of `statistics.csv`, of `/statistics` and of the observers are equal.
fn statistics_agree(loaded: &LoadedCase, built: Built, out: &Path) {
    let columns = statistics_columns(&loaded.case, built.simulation.view());
    let dimension = built.simulation.dimension();
    let options = RunOptions {
        out: out.to_owned(),
        threads: 1,
    };
    run(loaded, built, &options, &mut |_| {}).unwrap();
    let expected = known(
        columns
            .iter()
            .map(|c| (c.name.as_str(), c.unit.heading(dimension), c.doc)),
    );
    assert_eq!(expected.len(), columns.len(), "two columns of one name");
    let file = H5File::open(out.join("results.h5")).unwrap();
    assert_eq!(written(&file, &["statistics"]), expected);
    let table = std::fs::read_to_string(out.join("statistics.csv")).unwrap();
    let heads = table.lines().next().unwrap().split(',');
    let named: Vec<String> = columns
        .iter()
        .map(|c| match c.unit.heading(dimension) {
            "" => c.name.clone(),
            unit => format!("{} [{unit}]", c.name),
        })
        .collect();
    assert_eq!(heads.collect::<Vec<_>>(), named);
    for view in ["grains", "contacts", "bodies"] {
        assert!(out.join(format!("{view}.vtkhdf")).exists(), "{view}");
    }
}

/// Fields of grains and contacts in the file are those of the registry, and those that observers
/// add, which are in the page.
fn views_agree<S: Space>(file: &H5File) {
    let mut fields = Fields::<S>::default();
    orientation().into_iter().for_each(|f| fields.grains.add(f));
    let contacts = written(file, &["views/contacts/CellData"]);
    assert_eq!(contacts, of_list(&fields.contacts));
    let mut grains = written(file, &["views/grains/PointData"]);
    for (name, field) in of_list(&fields.grains) {
        assert_eq!(grains.remove(&name), Some(field), "{name}");
    }
    let of_observers: Vec<&str> = grains.keys().map(String::as_str).collect();
    assert_eq!(of_observers, ["cluster", "damage", "shear"]);
    let units = grains.iter().map(|(name, [unit, _])| {
        let unit = if unit == "1" { "" } else { unit.as_str() };
        (name.as_str(), unit)
    });
    let missing = undocumented(units);
    assert!(
        missing.is_empty(),
        "the pages of the outputs lack {missing:?}"
    );
    let bodies = written(file, &["views/bodies/CellData"]);
    assert_eq!(bodies.keys().collect::<Vec<_>>(), ["body", "velocity"]);
    // First bodies are shown, whatever their shape.
    let shown = file.dataset("views/bodies/CellData/body").unwrap();
    assert!(shown.shape()[0] > 0);
    // Vectors have three numbers, with which viewers draw arrows.
    for field in [
        "contacts/CellData/force",
        "contacts/CellData/normal",
        "grains/PointData/velocity",
    ] {
        let set = file.dataset(&format!("views/{field}")).unwrap();
        assert_eq!(set.shape()[1..], [3], "{field}");
    }
}

#[test]
fn names_in_the_files_are_those_of_the_registry_in_the_plane() {
    let case = "cases/verification/voronoi_plate.ron";
    ran(case, &folder("names-2"), &views_agree::<Dim2>);
}

#[test]
fn names_in_the_files_are_those_of_the_registry_in_space() {
    let case = "cases/verification/voronoi_plate_3d.ron";
    ran(case, &folder("names-3"), &views_agree::<Dim3>);
}

#[test]
fn names_on_meshes_are_those_of_the_registry() {
    let case = "cases/verification/elastic/patch.ron";
    ran(case, &folder("names-meshes"), &|file| {
        let of = |group: &str| {
            let groups = ["PointData", "CellData"].map(|place| format!("views/{group}/{place}"));
            written(file, &groups.each_ref().map(String::as_str))
        };
        assert_eq!(of("meshes/lower"), of_mesh(&of_bodies()));
        assert_eq!(of("surfaces/lower"), of_mesh(&of_surfaces(2)));
    });
}

#[test]
fn no_field_is_documented_that_no_registry_has() {
    fn names<S: Space>() -> [BTreeSet<String>; 5] {
        let mut fields = Fields::<S>::default();
        let more = orientation()
            .into_iter()
            .chain([fretwork::fields::removed()]);
        more.for_each(|f| fields.grains.add(f));
        fields.grains.add(fretwork::fields::heat_of_grains());
        for field in fretwork::fields::heat_of_contacts() {
            fields.contacts.add(field);
        }
        [
            of_list(&fields.grains),
            of_list(&fields.contacts),
            of_mesh(&of_bodies()),
            of_mesh(&of_grains()),
            of_mesh(&of_surfaces(S::D)),
        ]
        .map(|known| known.into_keys().collect())
    }
    let (plane, space) = (names::<Dim2>(), names::<Dim3>());
    // Further fields are those of observers, and those stored once.
    let more: [&[&str]; 5] = [&["shear", "damage", "cluster"], &[], &[], &["body"], &[]];
    let tables = field_tables();
    let kinds: Vec<&str> = tables.iter().map(|(kind, _)| kind.as_str()).collect();
    assert_eq!(
        kinds,
        [
            "grains",
            "contacts",
            "meshes",
            "grains that deform",
            "surfaces"
        ]
    );
    for (k, (kind, listed)) in tables.iter().enumerate() {
        let mut unknown: Vec<&String> = listed.difference(&plane[k]).collect();
        unknown.retain(|name| !space[k].contains(*name) && !more[k].contains(&name.as_str()));
        assert!(
            unknown.is_empty(),
            "the pages of the outputs have fields of {kind} that no run writes: {unknown:?}"
        );
    }
}
