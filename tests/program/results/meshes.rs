//! Fields of deformable bodies in `results.h5` agree with the other files of the run.

use super::{folder, run};
use fretwork::record::results::Reader;
use std::path::Path;

/// A field of a mesh over its states.
pub(super) struct Field<'a> {
    pub(super) reader: &'a Reader,
    pub(super) group: String,
}

impl Field<'_> {
    pub(super) fn states(&self) -> usize {
        let group = &self.group;
        self.reader.rows(&format!("{group}/Steps/Values")).unwrap()
    }

    /// The values of a field at a state; `place` is `Point` or `Cell`.
    pub(super) fn values(&self, place: &str, name: &str, width: usize, state: usize) -> Vec<f64> {
        let Self { reader, group } = self;
        let offset = format!("{group}/Steps/{place}DataOffsets/{name}");
        let first = reader.whole(&offset, (state, 1)).unwrap()[0] as usize;
        let count = reader.whole(&format!("{group}/NumberOf{place}s"), (0, 1));
        let count = count.unwrap()[0] as usize;
        let name = format!("{group}/{place}Data/{name}");
        reader.numbers(&name, (first, count), width).unwrap()
    }

    pub(super) fn last(&self, place: &str, name: &str, width: usize) -> Vec<f64> {
        self.values(place, name, width, self.states() - 1)
    }
}

/// Sum of a column of a table.
fn total(path: &Path, column: &str) -> f64 {
    let mut table = csv::Reader::from_path(path).unwrap();
    let headers = table.headers().unwrap().clone();
    let k = headers.iter().position(|h| h.starts_with(column)).unwrap();
    let values = table
        .records()
        .map(|r| r.unwrap()[k].parse::<f64>().unwrap());
    values.sum()
}

/// Rows of numbers of a legacy file after the line that begins with a word.
pub(super) fn legacy(path: &Path, begins: &str, rows: usize) -> Vec<f64> {
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().skip_while(|l| !l.starts_with(begins)).skip(1);
    let numbers = lines.filter(|l| !l.is_empty() && !l.starts_with("LOOKUP"));
    let rows = numbers.take(rows).flat_map(str::split_whitespace);
    rows.map(|x| x.parse().unwrap()).collect()
}

fn assert_near(name: &str, a: f64, b: f64, scale: f64) {
    assert!((a - b).abs() <= 1e-12 * scale, "{name}: {a} and {b}");
}

/// Checks that tractions along a surface add up to the forces of its contacts.
fn check_surface(out: &Path, reader: &Reader, name: &str, axes: &[&str]) {
    let surface = Field {
        reader,
        group: format!("views/surfaces/{name}"),
    };
    let area = surface.last("Point", "area", 1);
    let sum = |values: &mut dyn Iterator<Item = f64>| -> f64 {
        values.zip(&area).map(|(t, area)| t * area).sum()
    };
    let table = out.join(format!("{name}_tractions.csv"));
    let normal = total(&table, "normal_force");
    assert!(normal > 0.0);
    let pressure = surface.last("Point", "pressure", 1);
    let found = sum(&mut pressure.iter().copied());
    assert_near(name, found, normal, normal);
    let traction = surface.last("Point", "traction", 3);
    for (k, axis) in axes.iter().enumerate() {
        let force = total(&table, &format!("force_{axis}"));
        let found = sum(&mut traction.iter().skip(k).step_by(3).copied());
        assert_near(axis, found, force, normal);
    }
    let status = surface.last("Point", "status", 1);
    for zone in [0.0, 1.0, 2.0] {
        assert!(status.contains(&zone), "{name}: no point has status {zone}");
    }
    assert!(surface.values("Point", "pressure", 1, 0) == vec![0.0; area.len()]);
}

#[test]
fn fields_of_bodies_of_finite_elements_are_those_of_the_other_files() {
    let out = folder("meshes");
    let sets = [
        "time.end=0.016",
        "output.frames=0",
        "output.figures=false",
        "uncertainty.repeats=0",
    ];
    let sets = sets.iter().flat_map(|s| ["--set", s]).collect::<Vec<_>>();
    let (output, _) = run("cases/cylinder_on_flat_fretting.ron", &out, &sets);
    assert!(output.status.success());
    let reader = Reader::open(&out.join("results.h5")).unwrap();
    for name in ["flat", "cylinder"] {
        let mesh = Field {
            reader: &reader,
            group: format!("views/meshes/{name}"),
        };
        assert_eq!(mesh.states(), 5);
        let file = out.join(format!("{name}.vtk"));
        let displacement = mesh.last("Point", "displacement", 3);
        let rows = displacement.len() / 3;
        let legacy_displacement = legacy(&file, "VECTORS displacement", rows);
        assert_eq!(displacement, legacy_displacement);
        // The rows of the tensor are xx xy xz, xy yy yz, xz yz zz.
        let stress = mesh.last("Cell", "stress", 6);
        let tensors = legacy(&file, "TENSORS stress", stress.len() / 2);
        for (own, legacy) in stress.chunks_exact(6).zip(tensors.chunks_exact(9)) {
            let order = [0, 4, 8, 1, 5, 2].map(|k| legacy[k]);
            assert_eq!(own, order);
        }
        let von_mises = mesh.last("Cell", "von_mises", 1);
        let rows = von_mises.len();
        assert_eq!(von_mises, legacy(&file, "SCALARS von_mises", rows + 1));
        check_surface(&out, &reader, name, &["x", "y"]);
        assert!(out.join(format!("mesh_{name}.vtkhdf")).exists());
        assert!(out.join(format!("surface_{name}.vtkhdf")).exists());
    }
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn tractions_of_half_spaces_sum_up_to_their_forces() {
    let out = folder("half-space-surfaces");
    let sets = ["time.end=0.02", "output.frames=1", "uncertainty.repeats=0"];
    let sets = sets.iter().flat_map(|s| ["--set", s]).collect::<Vec<_>>();
    let (output, _) = run("cases/sphere_on_flat_fretting.ron", &out, &sets);
    assert!(output.status.success());
    let reader = Reader::open(&out.join("results.h5")).unwrap();
    assert!(!reader.has("views/meshes/flat/Points"));
    assert!(out.join("frames/slip_00000032.png").exists());
    for name in ["flat", "sphere"] {
        check_surface(&out, &reader, name, &["x", "y", "z"]);
        // Stick and slip are drawn at the end, and with the pictures of the run.
        assert!(out.join(format!("{name}_slip.png")).exists());
    }
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn a_case_without_deformable_bodies_has_no_meshes() {
    let out = folder("no-meshes");
    let (output, _) = run("cases/verification/energy.ron", &out, &[]);
    assert!(output.status.success());
    let file = hdf5::H5File::open(out.join("results.h5")).unwrap();
    let named = |n: &String| n.contains("meshes") || n.contains("surfaces");
    assert!(!file.dataset_names().iter().any(named));
    std::fs::remove_dir_all(out).ok();
}
