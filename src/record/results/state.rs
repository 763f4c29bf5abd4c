//! Reads the grains of a state of `results.h5`, also of a run that was cut off or still goes on.

use crate::record::fclib::guard;
use hdf5::{H5File, H5Type};
use std::path::{Path, PathBuf};

/// A grain of a state, in SI units; unused components are zero, the spin of a plane case is the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Grain {
    /// Centre (m), within the period where there is one.
    pub at: [f64; 3],
    /// Radius (m).
    pub radius: f64,
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin: [f64; 3],
}

/// The grains of one state; first bodies are left out.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Number of the state, from 0.
    pub frame: usize,
    /// Its time (s).
    pub time: f64,
    /// The grains, in the order of the file.
    pub grains: Vec<Grain>,
}

/// Why a state cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// No file of results, or a damaged one.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A number that is too high.
    #[error("{} has the states {states}, not number {asked}", path.display())]
    NoFrame {
        /// The file.
        path: PathBuf,
        /// Which it has.
        states: String,
        /// Which was asked for.
        asked: usize,
    },
}

/// Reads a state (the last one without a `frame`) for a case of a dimension.
///
/// # Errors
/// A file that is not there, not of Fretwork, damaged, of the other dimension, or without that state.
pub fn read(path: &Path, frame: Option<usize>, dimension: usize) -> Result<State, StateError> {
    let unreadable = |reason: String| StateError::Unreadable {
        path: path.to_owned(),
        reason,
    };
    let length = match std::fs::metadata(path) {
        Ok(data) if data.is_file() => data.len(),
        Ok(_) => return Err(unreadable("it is not a file".to_owned())),
        Err(e) => return Err(unreadable(e.to_string())),
    };
    let file = guard(|| H5File::options().best_effort_locking().open(path))
        .map_err(|e| unreadable(format!("it is not a file of results ({e})")))?;
    let names = guard(|| Ok(file.dataset_names())).map_err(unreadable)?;
    // A declared size is a claim: nothing is allocated by it that the file could not hold.
    let grains = Grains {
        file,
        most: usize::try_from(length).unwrap_or(usize::MAX / 8) * 4 + (1 << 16),
    };
    let has = |name: &str| names.iter().any(|n| n == &format!("{ROOT}/{name}"));
    if !has("Points") {
        return Err(unreadable(
            "it has no `/views/grains`; name a `results.h5` of `fretwork run`".to_owned(),
        ));
    }
    let spins: &[&str] = match (dimension, has("PointData/spin_x")) {
        (2, false) => &["spin"],
        (3, true) => &["spin_x", "spin_y", "spin_z"],
        (2, true) => {
            return Err(unreadable(
                "its grains are of a case of dimension 3; take a run of a case of dimension 2"
                    .to_owned(),
            ));
        }
        _ => {
            return Err(unreadable(
                "its grains have no `spin_x`: it is of a case of dimension 2, or of an older version".to_owned(),
            ));
        }
    };
    grains.read(path, frame, spins)
}

/// Where the view of the grains stands.
const ROOT: &str = "views/grains";

struct Grains {
    file: H5File,
    /// Bytes that one column may take.
    most: usize,
}

impl Grains {
    fn read(&self, path: &Path, frame: Option<usize>, spins: &[&str]) -> Result<State, StateError> {
        let unreadable = |reason: String| StateError::Unreadable {
            path: path.to_owned(),
            reason,
        };
        // Columns of a run that was cut off may differ by their last state.
        let states = ["Steps/Values", "Steps/PointOffsets", "NumberOfPoints"]
            .map(|n| self.rows(n))
            .into_iter()
            .try_fold(usize::MAX, |least, n| Ok(least.min(n?)))
            .map_err(unreadable)?;
        let asked = frame.unwrap_or(states.saturating_sub(1));
        if asked >= states {
            if states == 0 {
                let reason = "it holds no state; run the case with `output.views` above 0";
                return Err(unreadable(reason.to_owned()));
            }
            return Err(StateError::NoFrame {
                path: path.to_owned(),
                states: format!("0 to {}", states - 1),
                asked,
            });
        }
        self.frame(asked, spins).map_err(unreadable)
    }

    fn frame(&self, frame: usize, spins: &[&str]) -> Result<State, String> {
        let time = self.slice::<f64>("Steps/Values", frame, 1)?[0];
        let whole = |name: &str| {
            let value = self.slice::<i64>(name, frame, 1)?[0];
            usize::try_from(value).map_err(|_| format!("`{name}` holds {value}"))
        };
        let (first, count) = (whole("Steps/PointOffsets")?, whole("NumberOfPoints")?);
        let points = self.slice::<f64>("Points", first, count)?;
        let column = |name: &str| self.slice::<f64>(&format!("PointData/{name}"), first, count);
        let (radius, body) = (column("radius")?, column("first_body")?);
        let axes = |names: &[&str]| {
            names
                .iter()
                .map(|n| column(n))
                .collect::<Result<Vec<_>, _>>()
        };
        // Files of older versions list balls alone.
        let corners = match self.rows("PointData/corners") {
            Ok(_) => column("corners")?,
            Err(_) => vec![0.0; count],
        };
        let polygons = (0..count)
            .filter(|k| body[*k] == 0.0 && corners[*k] > 0.0)
            .count();
        if polygons > 0 {
            return Err(format!(
                "state {frame} holds {polygons} polygons; only balls can be taken from another run"
            ));
        }
        let velocity = axes(&["velocity_x", "velocity_y", "velocity_z"])?;
        let spin = axes(spins)?;
        let at = |columns: &[Vec<f64>], k: usize| -> [f64; 3] {
            std::array::from_fn(|axis| columns.get(axis).map_or(0.0, |c| c[k]))
        };
        let mut grains = Vec::with_capacity(count);
        for k in (0..count).filter(|k| body[*k] == 0.0) {
            let grain = Grain {
                at: std::array::from_fn(|axis| points[3 * k + axis]),
                radius: radius[k],
                velocity: at(&velocity, k),
                spin: at(&spin, k),
            };
            let numbers = [grain.at, grain.velocity, grain.spin];
            if !(grain.radius > 0.0 && numbers.iter().flatten().all(|x| x.is_finite())) {
                return Err(format!(
                    "grain {k} of state {frame} has numbers that are none"
                ));
            }
            grains.push(grain);
        }
        if grains.is_empty() {
            return Err(format!("state {frame} holds no grains"));
        }
        Ok(State {
            frame,
            time,
            grains,
        })
    }

    fn rows(&self, name: &str) -> Result<usize, String> {
        let shape = guard(|| Ok(self.file.dataset(&format!("{ROOT}/{name}"))?.shape()))?;
        Ok(shape.first().copied().unwrap_or(0))
    }

    /// Rows of a dataset, as one list.
    fn slice<T: H5Type>(&self, name: &str, first: usize, count: usize) -> Result<Vec<T>, String> {
        let rows = self.rows(name)?;
        if first.checked_add(count).is_none_or(|end| end > rows) || count > self.most / 24 {
            return Err(format!("`{name}` is cut short: it has {rows} rows"));
        }
        if count == 0 {
            return Ok(Vec::new());
        }
        let values = guard(|| {
            let dataset = self.file.dataset(&format!("{ROOT}/{name}"))?;
            if dataset.shape().len() == 1 {
                dataset.read_slice::<T>(&[first], &[count])
            } else {
                let width = dataset.shape()[1];
                dataset.read_slice::<T>(&[first, 0], &[count, width])
            }
        })?;
        let width = if name == "Points" { 3 } else { 1 };
        if values.len() != count * width {
            return Err(format!("`{name}` has another shape than results have"));
        }
        Ok(values)
    }
}
