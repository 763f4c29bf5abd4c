//! Files written by wear, and the end of a run in which a surface was worn through.

use crate::scene;
use crate::temp::TempFolder;
use fretwork::geometry::space::Dim2;
use fretwork::scene::standard::{self, Cut};
use fretwork::step::Simulation;
use std::process::{Command, Output};

struct Folder(TempFolder);

impl Folder {
    fn new(name: &str) -> Self {
        Self(TempFolder::new(&format!("scar-{name}")))
    }

    fn read(&self, name: &str) -> String {
        let path = self.0.join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }
}

fn run(out: &Folder, sets: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command
        .args(["run", "--verbose"])
        .arg(scene::file("verification/worn_slide"))
        .arg("--out")
        .arg(&out.0);
    for set in sets {
        command.args(["--set", set]);
    }
    command.output().unwrap()
}

fn build(sets: &[String]) -> Simulation<Dim2> {
    let loaded = scene::loaded("verification/worn_slide", sets);
    scene::simulation(&loaded)
}

/// The rows have x, z, z_first and depth.
fn rows(table: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    table.lines().skip(1).map(numbers).collect()
}

#[test]
fn a_worn_profile_is_read_again_as_it_was_written() {
    for above in [false, true] {
        let out = Folder::new(if above { "above" } else { "below" });
        // In the second scene the rail is above the block; both are upside down.
        let flipped = [
            "bodies.rail.shapes.0.side=Above",
            "bodies.block.position=[-0.15, -0.101]",
            "bodies.block.dofs.y=Force(Constant(2000.0))",
            "time.end=0.3",
        ];
        let sets: &[&str] = if above { &flipped } else { &flipped[3..] };
        let done = run(&out, sets);
        assert_eq!(
            done.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        let table = out.read("scar_rail.csv");
        assert_eq!(
            table.lines().next(),
            Some("x [m],z [m],z_first [m],depth [m]")
        );
        let rows = rows(&table);
        let up = if above { 1.0 } else { -1.0 };
        assert!(rows.windows(2).all(|w| w[0][0] < w[1][0]));
        assert!(rows.iter().all(|r| r[1] == r[2] + up * r[3] && r[3] >= 0.0));
        assert!(rows.iter().any(|r| r[3] > 1e-5));
        // The volume by the trapezoidal rule of the written depths is compared with summary and
        // statistics.
        let volume: f64 = rows
            .windows(2)
            .map(|w| 0.5 * (w[1][0] - w[0][0]) * (w[0][3] + w[1][3]))
            .sum();
        let summary: serde_json::Value = serde_json::from_str(&out.read("summary.json")).unwrap();
        let of = |v: &serde_json::Value| v.as_f64().unwrap();
        assert!((of(&summary["scars"][0]["volume"]) / volume - 1.0).abs() < 1e-10);
        assert!((of(&summary["wear"]["volume_first_bodies"]) / volume - 1.0).abs() < 1e-10);
        let statistics = out.read("statistics.csv");
        let header: Vec<&str> = statistics.lines().next().unwrap().split(',').collect();
        let at = header
            .iter()
            .position(|h| h.starts_with("rail_worn"))
            .unwrap();
        let last: Vec<&str> = statistics.lines().last().unwrap().split(',').collect();
        assert!((last[at].parse::<f64>().unwrap() / volume - 1.0).abs() < 1e-10);
        assert!(out.0.join("scar_rail.png").exists());
        // The next run reads the table as a profile, to the last bit.
        let file = out.0.join("scar_rail.csv");
        let shape = format!(
            "bodies.rail.shapes=[Profile(file: \"{}\", side: {})]",
            file.display(),
            if above { "Above" } else { "Below" }
        );
        let s = build(&[shape, "bodies.block.position=[-0.15, 0.5]".into()]);
        let mut again = s.shapes.surfaces[0].shape.outline().remove(0);
        if above {
            again.reverse();
        }
        assert_eq!(again.len(), rows.len());
        assert!(
            again
                .iter()
                .zip(&rows)
                .all(|(p, r)| p.x == r[0] && p.y == r[1])
        );
    }
}

/// Archard's law with k = 1e-8: a block drawn over a flat profile wears it by k P s, and V/(P s) of
/// the summary is k, for the body that wears. Mean depth times the worn area is the volume.
#[test]
fn the_specific_wear_rate_is_that_of_the_law() {
    let out = Folder::new("rate");
    let flat =
        "bodies.rail.shapes.0=Profile(side: Below, points: [(-0.3, 0.0), (0.1, 0.0), (0.8, 0.0)])";
    let test = "friction=(body: \"block\", along: 0, normal: 1)";
    let done = run(&out, &[flat, test, "time.end=0.6", "output.frames=0"]);
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    let summary: serde_json::Value = serde_json::from_str(&out.read("summary.json")).unwrap();
    let wear = &summary["wear"];
    let of = |v: &serde_json::Value| v.as_f64().unwrap();
    let bodies = wear["bodies"].as_array().unwrap();
    assert_eq!(
        (bodies.len(), bodies[0]["body"].as_str()),
        (1, Some("rail"))
    );
    let rate = of(&bodies[0]["specific_rate"]);
    assert!((rate / 1e-8 - 1.0).abs() < 1e-3, "{rate}");
    // The load is 2000 N/m, over 0.7 m/s for 0.6 s.
    assert!(
        (of(&wear["load_path"]) / 840.0 - 1.0).abs() < 3e-3,
        "{wear}"
    );
    assert!((of(&bodies[0]["volume"]) / of(&summary["scars"][0]["volume"]) - 1.0).abs() < 1e-10);
    let rows = rows(&out.read("scar_rail.csv"));
    let deepest = rows.iter().map(|r| r[3]).fold(0.0, f64::max);
    assert!((of(&bodies[0]["depth_max"]) / deepest - 1.0).abs() < 1e-10);
    // All three vertices are worn; the mean depth, weighted by their lengths, is over 1.1 m.
    assert!(rows.iter().all(|r| r[3] > 0.0));
    assert!((of(&bodies[0]["depth_mean"]) * 1.1 / of(&bodies[0]["volume"]) - 1.0).abs() < 1e-10);
    let printed = String::from_utf8_lossy(&done.stdout);
    assert!(
        printed.contains("wear of rail") && printed.contains(" mm3/(N m)"),
        "{printed}"
    );
}

#[test]
fn a_profile_worn_through_stops_the_run_with_all_on_disk() {
    let out = Folder::new("through");
    let done = run(
        &out,
        &["bodies.rail.wears.thickness=1.5e-5", "output.every=7"],
    );
    assert_eq!(done.status.code(), Some(1));
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(said.contains("`rail` is worn through at ["), "{said}");
    let summary: serde_json::Value = serde_json::from_str(&out.read("summary.json")).unwrap();
    let stopped = summary["stopped"].as_str().unwrap();
    assert!(
        stopped.contains("worn through") && stopped.contains("wears.thickness"),
        "{stopped}"
    );
    let steps = summary["steps"].as_u64().unwrap();
    assert!((1..999).contains(&steps), "{steps}");
    // The last step is in the statistics, and in the scar.
    let statistics = out.read("statistics.csv");
    let last = statistics.lines().last().unwrap();
    let number: f64 = last.split(',').next().unwrap().parse().unwrap();
    assert_eq!(number, steps as f64, "{last}");
    let deepest = rows(&out.read("scar_rail.csv"))
        .iter()
        .map(|r| r[3])
        .fold(0.0, f64::max);
    assert!((1.5e-5..2.5e-5).contains(&deepest), "{deepest}");
    let depth = summary["scars"][0]["depth"].as_f64().unwrap();
    assert!((depth / deepest - 1.0).abs() < 1e-14, "{depth} {deepest}");
    assert!(out.0.join("results.h5").exists() && out.0.join("scar_rail.png").exists());
}

#[test]
fn wheel_and_rail_of_the_standards_are_shapes() {
    let cut = Cut {
        spacing: 1e-3,
        from: None,
        to: None,
        inclination: None,
    };
    let name = fretwork::scene::case::StandardName::S1002;
    let points = standard::points(name, &cut).unwrap();
    let wheel = "bodies.rail.shapes=[StandardProfile(name: S1002, spacing: 1e-3)]";
    let s = build(&[wheel.into(), "bodies.block.position=[0.0, -0.5]".into()]);
    let mut chain = s.shapes.surfaces[0].shape.outline().remove(0);
    chain.reverse();
    assert_eq!(chain.len(), points.len());
    assert!(chain.iter().zip(&points).all(|(p, q)| (p.x, p.y) == *q));
    let rail = "bodies.rail.shapes=[StandardProfile(name: Rail60E1, inclination: Some(40.0), from: Some(-0.03))]";
    let s = build(&[rail.into(), "bodies.block.position=[0.0, 0.5]".into()]);
    let chain = s.shapes.surfaces[0].shape.outline().remove(0);
    // A chain that is solid below goes from left to right.
    assert!(chain[0].x < chain[chain.len() - 1].x);
    assert!(chain.iter().all(|p| p.y <= 1e-12));
}
