//! Runs of a window of a contact: its area, its pressure, and the course of its friction test.

use super::output::column;
use fretwork_scene::Case;
use std::path::Path;

/// Returns the area of the periodic window of a case with a friction test (m²; 2D m): the product
/// of its periods across the direction of the load. `None` without such a test; 0 where the window
/// is not periodic.
pub fn area(case: &Case) -> Option<f64> {
    let periods = [case.periodic.x, case.periodic.y, case.periodic.z];
    let test = case.friction.as_ref()?;
    let within = (0..case.dimension as usize).filter(|axis| *axis != test.normal);
    within.map(|axis| periods[axis]).product()
}

/// Returns a column of the statistics of a run from a time on (s), with two rows or more.
pub fn since(folder: &Path, name: &str, start: f64) -> Option<Vec<f64>> {
    let path = folder.join("statistics.csv");
    let (time, values) = (column(&path, "time")?, column(&path, name)?);
    let rows = time.iter().zip(values);
    let late = rows.filter(|(t, _)| **t >= start * (1.0 - 1e-9));
    Some(late.map(|(_, v)| v).collect()).filter(|list: &Vec<f64>| list.len() > 1)
}

/// Returns the mean normal force of the rows of the friction test (N; 2D N/m).
pub fn normal_force(folder: &Path, start: f64) -> Option<f64> {
    let rows = since(folder, "P", start)?;
    Some(rows.iter().sum::<f64>() / rows.len() as f64)
}

/// Returns the mean pressure in the friction test of a run (Pa), where its window is periodic.
pub fn mean_pressure(case: &Case, folder: &Path) -> Option<f64> {
    let area = area(case).filter(|a| *a > 0.0)?;
    let start = case.friction.as_ref()?.start;
    Some(normal_force(folder, start)? / area)
}

/// The course of a friction test, a row for each recorded step.
#[derive(Clone, Debug, Default)]
pub struct FrictionCourse {
    /// Time (s).
    pub time: Vec<f64>,
    /// Displacement of the moved body (m).
    pub delta: Vec<f64>,
    /// Tangential force (N; 2D N/m).
    pub tangential: Vec<f64>,
    /// Normal force (N; 2D N/m).
    pub normal: Vec<f64>,
    /// Volume worn off first bodies so far (m³; 2D m²); empty without wear.
    pub worn: Vec<f64>,
}

impl FrictionCourse {
    /// Reads the statistics of a run from a time on (s); `None` where it has no friction test.
    pub fn read(folder: &Path, start: f64) -> Option<Self> {
        let of = |name: &str| since(folder, name, start);
        Some(Self {
            time: of("time")?,
            delta: of("delta")?,
            tangential: of("Q")?,
            normal: of("P")?,
            worn: of("worn_first").unwrap_or_default(),
        })
    }
}
