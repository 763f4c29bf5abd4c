//! Cases of grains on a floor, each in its own folder.

use crate::temp::TempFolder;
use fretwork::geometry::space::Space;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::PathBuf;
use std::process::Command;

const STONE: &str = r#"(doc: "stone", density: (value: 2600.0, unit: "kg/m^3", source: "quartz"))"#;

/// A case of a dimension with one list of `grains` on a floor, and more bodies.
pub fn case(dimension: usize, material: &str, grains: &str, bodies: &str) -> String {
    let (up, weight) = if dimension == 2 {
        ("0.0, 1.0", "0.0, -9.81")
    } else {
        ("0.0, 0.0, 1.0", "0.0, 0.0, -9.81")
    };
    format!(
        r#"(
    name: "a sample", dimension: {dimension}, seed: 4,
    time: (step: 5e-5, end: 0.02), gravity: [{weight}], periodic: (x: 0.2),
    materials: {{"grain": "{material}"}},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "coulomb", parameters: (contact: {{"mu": 0.4}}))],
    bodies: [(name: "floor", material: "grain", shapes: [HalfSpace(normal: [{up}])]), {bodies}],
    grains: [{grains}],
    output: (frames: 0, views: 4, figures: false),
)"#
    )
}

/// A folder of a test with two materials, removed at its end.
pub struct Folder(pub TempFolder);

/// A simulation, and the description of grains that were generated or read.
pub struct Sampled<S: Space> {
    pub simulation: Simulation<S>,
    pub samples: Vec<String>,
}

impl Folder {
    /// Makes a new folder of this name.
    pub fn new(name: &str) -> Self {
        let folder = TempFolder::new(&format!("grains-{name}"));
        std::fs::create_dir_all(folder.join("materials")).unwrap();
        let folder = Self(folder);
        folder.write("materials/stone.ron", STONE);
        folder.write("materials/heavy.ron", &STONE.replace("2600", "5200"));
        folder
    }

    /// Writes a file in the folder.
    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    /// Writes and runs a case with the results in the folder `out`, which is returned.
    pub fn record(&self, case: &str) -> PathBuf {
        let (path, out) = (self.write("first.ron", case), self.0.join("out"));
        let output = Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(["run".as_ref(), path.as_os_str(), "--out".as_ref()])
            .arg(&out)
            .arg("--force")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        out
    }

    /// Writes and builds a case.
    pub fn build<S: Space>(&self, case: &str) -> Result<Sampled<S>, String> {
        let path = self.write("case.ron", case);
        let loaded = load(&path, &[]).map_err(|e| e.to_string())?;
        let built = loaded.build(&search_path()).map_err(|e| e.to_string())?;
        let simulation = built.simulation.into_dimension();
        Ok(Sampled {
            simulation: simulation.map_err(|_| "it has another dimension".to_owned())?,
            samples: built.samples,
        })
    }
}
