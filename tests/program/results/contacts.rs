//! Contacts in `results.h5`: forces with their directions, bodies, status, work of friction.

use super::ledger::table;
use super::{folder, run};
use hdf5::H5File;
use std::path::Path;

/// The contacts of one state: a column by name, and the bodies.
struct Contacts {
    file: H5File,
    first: usize,
    count: usize,
    time: f64,
}

impl Contacts {
    /// Reads a state counted from 0, or the last.
    fn of(path: &Path, state: Option<usize>) -> Self {
        let file = H5File::open(path).unwrap();
        let whole = |name: &str| {
            let set = file.dataset(&format!("views/contacts/{name}")).unwrap();
            set.read_raw::<i64>().unwrap()
        };
        let counts = whole("Lines/NumberOfCells");
        let state = state.unwrap_or(counts.len() - 1);
        let times = file.dataset("views/contacts/Steps/Values").unwrap();
        Self {
            first: counts[..state].iter().sum::<i64>() as usize,
            count: counts[state] as usize,
            time: times.read_raw::<f64>().unwrap()[state],
            file,
        }
    }

    fn column(&self, name: &str) -> Vec<f64> {
        let set = self
            .file
            .dataset(&format!("views/contacts/CellData/{name}"));
        set.unwrap()
            .read_slice::<f64>(&[self.first], &[self.count])
            .unwrap()
    }

    fn bodies(&self) -> Vec<[i64; 2]> {
        let read = |name: &str| {
            let set = self
                .file
                .dataset(&format!("views/contacts/CellData/{name}"));
            set.unwrap()
                .read_slice::<i64>(&[self.first], &[self.count])
                .unwrap()
        };
        let (one, other) = (read("body_1"), read("body_2"));
        one.into_iter().zip(other).map(|(a, b)| [a, b]).collect()
    }

    /// Force on `body_1` of each contact, from its components.
    fn forces(&self, dimension: usize) -> Vec<Vec<f64>> {
        let normal = vectors(self, "normal", dimension);
        let (pn, p1) = (
            self.column("force_normal"),
            self.column("force_tangential_1"),
        );
        let t1 = match dimension {
            2 => normal.iter().map(|n| vec![-n[1], n[0]]).collect(),
            _ => vectors(self, "tangent_1", 3),
        };
        let mut out = Vec::new();
        for k in 0..self.count {
            let mut f: Vec<f64> = (0..dimension)
                .map(|a| pn[k] * normal[k][a] + p1[k] * t1[k][a])
                .collect();
            if dimension == 3 {
                let p2 = self.column("force_tangential_2")[k];
                let (n, t) = (&normal[k], &t1[k]);
                for (a, f) in f.iter_mut().enumerate() {
                    let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                    *f += p2 * (n[b] * t[c] - n[c] * t[b]);
                }
            }
            out.push(f);
        }
        out
    }
}

fn vectors(contacts: &Contacts, name: &str, dimension: usize) -> Vec<Vec<f64>> {
    let axes: Vec<Vec<f64>> = ["x", "y", "z"][..dimension]
        .iter()
        .map(|a| contacts.column(&format!("{name}_{a}")))
        .collect();
    (0..contacts.count)
        .map(|k| axes.iter().map(|a| a[k]).collect())
        .collect()
}

/// Checks that the forces of the contacts of a driven body with this identity add up to those in
/// the statistics.
fn forces_add_up(case: &str, (body, id): (&str, i64), dimension: usize, sets: &[&str]) {
    let out = folder(&format!("forces-{dimension}"));
    let mut args = vec!["--set", "output.frames=0", "--set", "output.figures=false"];
    for set in sets {
        args.extend(["--set", *set]);
    }
    let (output, _) = run(&format!("cases/{case}.ron"), &out, &args);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let contacts = Contacts::of(&out.join("results.h5"), None);
    let columns = table(&out.join("statistics.csv"));
    let (forces, bodies) = (contacts.forces(dimension), contacts.bodies());
    let mut touching = 0;
    for (a, axis) in ["x", "y", "z"][..dimension].iter().enumerate() {
        let mut sum = 0.0;
        let mut size = 0.0;
        for (force, [one, other]) in forces.iter().zip(&bodies) {
            let sign = f64::from(i8::from(*one == id) - i8::from(*other == id));
            sum += sign * force[a];
            size += (sign * force[a]).abs();
            touching += u32::from(sign != 0.0 && force[a] != 0.0);
        }
        let received = *columns[&format!("{body}_f{axis}")].last().unwrap();
        assert!(
            (sum - received).abs() <= 1e-12 * size.max(received.abs()),
            "{axis}: contacts give {sum:e}, the statistics say {received:e}"
        );
    }
    assert!(touching > 3, "{touching}");
    // The recorded norm is that of the components.
    let (norm, one) = (
        contacts.column("force_tangential"),
        contacts.column("force_tangential_1"),
    );
    let two = match dimension {
        3 => contacts.column("force_tangential_2"),
        _ => vec![0.0; norm.len()],
    };
    for k in 0..norm.len() {
        assert!((norm[k] - one[k].hypot(two[k])).abs() <= 1e-12 * norm[k]);
    }
    let status = contacts.column("status");
    let state = contacts.column("state");
    for k in 0..status.len() {
        let carries = forces[k].iter().any(|f| *f != 0.0);
        let right = match status[k] as u32 {
            0 => !carries && state[k] == 0.0,
            1 | 2 => carries && state[k] != 1.0,
            3 => state[k] == 1.0,
            4 => !carries && state[k] == 2.0,
            _ => false,
        };
        assert!(
            right,
            "contact {k}: status {}, state {}",
            status[k], state[k]
        );
    }
    std::fs::remove_dir_all(out).ok();
}

#[test]
fn forces_of_contacts_add_up_to_those_on_a_body_in_the_plane() {
    // First bodies come after the 40 grains.
    forces_add_up("verification/energy", ("top", 41), 2, &["time.end=0.06"]);
}

#[test]
fn forces_of_contacts_add_up_to_those_on_a_body_in_space() {
    // First bodies come after the 480 grains.
    forces_add_up("shear_cell_3d", ("lid", 481), 3, &["time.end=0.02"]);
}

/// A sphere thrown at v = 1 m/s slides until 2 v/(7 mu g) = 0.097 s and then rolls; friction
/// dissipates m v^2/7.
#[test]
fn a_sphere_slides_and_then_rolls_and_friction_took_a_seventh() {
    let out = folder("status");
    let (output, summary) = run(
        "cases/verification/slide_to_roll_sphere.ron",
        &out,
        &["--set", "output.views=4"],
    );
    assert!(output.status.success());
    let path = out.join("results.h5");
    for state in 1..5 {
        let contacts = Contacts::of(&path, Some(state));
        assert_eq!(contacts.count, 1);
        let (pn, pt) = (
            contacts.column("force_normal"),
            contacts.column("force_tangential"),
        );
        let slides = contacts.time < 0.09;
        assert_eq!(contacts.column("status"), [if slides { 2.0 } else { 1.0 }]);
        if slides {
            assert!((pt[0] / pn[0] - 0.3).abs() < 1e-9, "{}", pt[0] / pn[0]);
        }
    }
    let contacts = Contacts::of(&path, None);
    let work: f64 = contacts.column("friction_work").iter().sum();
    let booked = summary["energy"]["friction"].as_f64().unwrap();
    assert!(
        (work - booked).abs() <= 1e-13 * booked,
        "{work:e} {booked:e}"
    );
    let mass = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.1f64.powi(3);
    assert!((work - mass / 7.0).abs() < 1e-3 * mass, "{work:e}");
    std::fs::remove_dir_all(out).ok();
}

/// Every dataset that grows, and every number that is written once, has a unit and a description.
#[test]
fn every_dataset_says_its_unit_and_what_it_is() {
    let out = folder("units");
    let (output, summary) = run(
        "cases/wheel_rail_rigid.ron",
        &out,
        &[
            "--set",
            "time.end=4e-3",
            "--set",
            "time.step=1e-4",
            "--set",
            "output.frames=0",
        ],
    );
    assert!(output.status.success());
    let file = H5File::open(out.join("results.h5")).unwrap();
    let mut seen = 0;
    for name in file.dataset_names() {
        let set = file.dataset(&name).unwrap();
        let text = |attribute: &str| set.attr(attribute).and_then(|a| a.read_string());
        assert!(
            text("doc").is_ok_and(|t| !t.is_empty()),
            "{name} has no doc"
        );
        let bare = ["case", "materials/", "plugins/", "checkpoints/"];
        if !bare.iter().any(|b| name.starts_with(b)) {
            assert!(
                text("unit").is_ok_and(|t| !t.is_empty()),
                "{name} has no unit"
            );
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen}");
    assert_eq!(summary["wear"]["unit"], "kg/(m s)");
    std::fs::remove_dir_all(out).ok();
}

/// Flows count from the start of the friction test: they are the wear since then over the time
/// since then.
#[test]
fn the_source_flow_counts_from_the_start_of_the_friction_test() {
    let out = folder("flows");
    let start = 0.1;
    let (output, summary) = run(
        "cases/verification/worn_slide_3d.ron",
        &out,
        &[
            "--set",
            "friction=Some((body: \"ball\", along: 0, normal: 2, start: 0.1))",
            "--set",
            "output.frames=0",
        ],
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let columns = table(&out.join("statistics.csv"));
    let (time, worn) = (&columns["time"], &columns["worn_first"]);
    let before = time.iter().position(|t| *t > start + 1e-9).unwrap() - 1;
    let last = time.len() - 1;
    assert!(worn[before] > 0.0 && worn[last] > worn[before]);
    let expected = 1000.0 * (worn[last] - worn[before]) / (time[last] - time[before]);
    let flow = summary["wear"]["Qs"].as_f64().unwrap();
    assert!(
        (flow / expected - 1.0).abs() < 1e-9,
        "{flow:e} {expected:e}"
    );
    assert_eq!(summary["wear"]["start"].as_f64(), Some(start));
    assert_eq!(summary["wear"]["unit"], "kg/s");
    std::fs::remove_dir_all(out).ok();
}
