//! Biaxial test: stresses, strains, compacity and coordination of the grains between four flat
//! walls.
//!
//! Stresses and the axial strain are positive in compression, the volumetric strain in expansion.
//! In 2D forces are per metre of depth, so a force over a length is a pressure.

mod outcome;

pub use outcome::BiaxialOutcome;
pub(crate) use outcome::report_none;

use super::coordination::{Coordination, coordination};
use super::figures;
use super::output::Output;
use super::quantity::Findings;
use super::statistics::Column;
use super::stress::{love_weber, plane_invariants};
use crate::observer::{Observer, RunEnd};
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::geometry::space::ball_volume;
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use fretwork_scene::case::BiaxialSpec;

/// A flat wall normal to an axis.
#[derive(Clone, Copy, Debug)]
struct Wall {
    /// Index among the driven bodies.
    place: usize,
    /// Index of the body.
    body: usize,
    /// Position of its face in the body's frame, along the axis (m).
    offset: f64,
}

/// Observer of a biaxial test.
#[derive(Clone, Debug)]
pub struct Biaxial {
    /// Axis of loading, and the other axis.
    axes: [usize; 2],
    /// Low and high wall of each axis.
    walls: [[Wall; 2]; 2],
    /// Time from which strains are measured (s).
    start: f64,
    /// Distances between the walls along the two axes at the start (m).
    reference: [f64; 2],
    solid: f64,
}

/// Measured values at the end of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct BiaxialState {
    /// Axial and lateral stress, from the walls (Pa).
    pub walls: [f64; 2],
    /// Mean of the two (Pa).
    pub pressure_walls: f64,
    /// Mean Love-Weber stress of the contacts (Pa).
    pub pressure_contacts: f64,
    /// Deviator over mean pressure, (axial - lateral)/(axial + lateral), from the walls.
    pub deviator_ratio: f64,
    /// Sine of the mobilised friction angle, from the principal Love-Weber stresses of the
    /// contacts.
    pub sin_phi: f64,
    /// Decrease of the axial length over its initial value.
    pub axial_strain: f64,
    /// Increase of the volume over its initial value.
    pub volumetric_strain: f64,
    /// Volume of the grains over that between the walls.
    pub compacity: f64,
    /// Coordination number of the grains.
    pub coordination: Coordination,
}

impl Biaxial {
    /// Files of its figures.
    pub const FIGURES: [&str; 1] = ["biaxial.png"];

    /// Finds the walls, whose names and shapes were checked by [`fretwork_scene::biaxial`].
    pub fn new(spec: &BiaxialSpec, run: &dyn RunView) -> Option<Self> {
        let axial = axis_of(run, &spec.axial.0)?;
        let axes = [axial, 1 - axial.min(1)];
        let (bodies, surfaces) = (run.bodies(), run.surfaces());
        let wall = |name: &str, axis: usize| {
            let place = bodies.driven.iter().position(|d| d.name == name)?;
            let body = bodies.driven[place].body;
            let face = surfaces.iter().find(|f| f.body == body)?;
            Some(Wall {
                place,
                body: body as usize,
                offset: face.offset[axis],
            })
        };
        let pair = |names: &(String, String), axis: usize| {
            Some([wall(&names.0, axis)?, wall(&names.1, axis)?])
        };
        let balls = run.balls().into_iter().map(|b| (b.body, b.radius));
        let pieces = run.pieces().into_iter().map(|p| (p.body, p.size));
        let closed = surfaces.iter().filter(|f| f.closed);
        let deformable = closed.map(|f| (f.body, bodies.length[f.body as usize]));
        let grains = balls
            .chain(pieces)
            .chain(deformable)
            .filter(|(body, _)| !bodies.driven.iter().any(|d| d.body == *body));
        let mut test = Self {
            axes,
            walls: [pair(&spec.axial, axes[0])?, pair(&spec.lateral, axes[1])?],
            start: spec.start,
            reference: [1.0; 2],
            solid: grains
                .map(|(_, radius)| ball_volume(run.dimension(), radius))
                .sum(),
        };
        test.reference = test.lengths(run);
        Some(test)
    }

    /// Returns the distances between the faces along the two axes (m).
    fn lengths(&self, run: &dyn RunView) -> [f64; 2] {
        let position = run.bodies().position;
        [0, 1].map(|k| {
            let [low, high] = self.walls[k].map(|w| position.at(w.body)[self.axes[k]] + w.offset);
            high - low
        })
    }

    /// Whether the test has started.
    fn begun(&self, run: &dyn RunView) -> bool {
        run.time() > self.start + 0.5 * run.options().scheme.h
    }

    /// Processes the last step.
    pub fn follow(&mut self, run: &dyn RunView) {
        if !self.begun(run) {
            self.reference = self.lengths(run);
        }
    }

    /// Returns the volume of the grains (m^3; m^2 in 2D).
    pub fn solid(&self) -> f64 {
        self.solid
    }

    /// Returns the mean mass of a grain (kg; kg/m in 2D), including inertia scaling.
    pub fn grain_mass(&self, run: &dyn RunView) -> f64 {
        let (grains, mass) = (run.grains(), run.bodies().mass);
        grains.iter().map(|b| mass[*b]).sum::<f64>() / grains.len().max(1) as f64
    }

    /// Returns the measured values for the last step.
    pub fn state(&self, run: &dyn RunView) -> BiaxialState {
        let lengths = self.lengths(run);
        let volume = lengths[0] * lengths[1];
        // Grains push the low wall in the negative direction of the axis and the high wall in the
        // positive one, with equal forces at rest.
        let received = run.received();
        let walls = [0, 1].map(|k| {
            let [low, high] = self.walls[k].map(|w| received[w.place][0][self.axes[k]]);
            0.5 * (high - low) / (run.options().scheme.h * lengths[1 - k])
        });
        let (pressure_contacts, sin_phi) = plane_invariants(&love_weber(run, volume));
        let sum = walls[0] + walls[1];
        let [l0, l1] = [0, 1].map(|k| lengths[k] / self.reference[k]);
        BiaxialState {
            walls,
            pressure_walls: 0.5 * sum,
            pressure_contacts,
            deviator_ratio: if sum > 0.0 {
                (walls[0] - walls[1]) / sum
            } else {
                0.0
            },
            sin_phi,
            axial_strain: 1.0 - l0,
            volumetric_strain: l0 * l1 - 1.0,
            compacity: self.solid / volume,
            coordination: coordination(run),
        }
    }

    /// Returns the columns of the statistics.
    pub fn columns() -> Vec<Column> {
        let c = Column::new;
        vec![
            c("sigma_axial", "Pa", "axial stress, from the walls"),
            c("sigma_lateral", "Pa", "lateral stress, from the walls"),
            c("p_walls", "Pa", "mean of the two"),
            c("p_contacts", "Pa", "mean Love-Weber stress of the contacts"),
            c("q_over_p", "", "(axial - lateral)/(axial + lateral)"),
            c(
                "sin_phi",
                "",
                "(major - minor)/(major + minor) of the principal Love-Weber stresses",
            ),
            c("axial_strain", "", "shortening since the start of the test"),
            c(
                "volumetric_strain",
                "",
                "expansion since the start of the test",
            ),
            c(
                "compacity",
                "",
                "volume of grains over that between the walls",
            ),
            c("coordination", "", "contacts that carry force, per grain"),
            c(
                "coordination_carried",
                "",
                "contacts that carry force, per grain, without rattlers",
            ),
            c("rattlers", "", "fraction of grains that carry no force"),
        ]
    }
}

impl Observer for Biaxial {
    fn name(&self) -> String {
        "biaxial test".to_owned()
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        self.follow(run);
    }

    fn columns(&self) -> Vec<Column> {
        Self::columns()
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        self.state(run).row()
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let mass = self.grain_mass(end.simulation);
        BiaxialOutcome::new(end.table, self.start, mass).report(found);
    }

    fn file_names(&self) -> Vec<String> {
        Self::FIGURES.map(str::to_owned).to_vec()
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        vec![figures::biaxial::charts(self.start)]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.reference)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.reference = decode(from)?;
        Ok(())
    }
}

impl BiaxialState {
    /// Returns the values of [`Biaxial::columns`].
    pub fn row(&self) -> Vec<f64> {
        let z = &self.coordination;
        vec![
            self.walls[0],
            self.walls[1],
            self.pressure_walls,
            self.pressure_contacts,
            self.deviator_ratio,
            self.sin_phi,
            self.axial_strain,
            self.volumetric_strain,
            self.compacity,
            z.mean,
            z.carried,
            z.rattlers,
        ]
    }
}

/// Returns the axis normal to the face of a wall.
fn axis_of(run: &dyn RunView, name: &str) -> Option<usize> {
    let body = run.bodies().driven.iter().find(|d| d.name == name)?.body;
    let face = run.surfaces().iter().position(|f| f.body == body)?;
    let outline = run.surface_lines(face);
    let (a, b) = (outline.first()?.first()?, outline.first()?.last()?);
    let along = [b[0] - a[0], b[1] - a[1]];
    Some(if along[0].abs() > along[1].abs() {
        1
    } else {
        0
    })
}
