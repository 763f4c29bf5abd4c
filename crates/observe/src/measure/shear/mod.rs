//! Plane shear of the grains between two heights, away from the walls.
//!
//! The shear rate is the slope of v_x over height. The stress is that of the contacts plus that of
//! the motion (da Cruz et al., Phys. Rev. E 72 (2005) 021309, section II), the momentum flux across
//! a layer: (sum f l + sum m v' v')/V, with the part of each branch l that lies between the
//! heights, and v' relative to the mean velocity of the layers, a straight line over the height.
//! The solid fraction counts the part of each grain between the heights. The inertial number is
//! rate sqrt(m/p) with the mean mass in 2D, and rate d sqrt(density/p) in 3D.
//!
//! A row of the statistics has means over the steps since the row before: contacts between rigid
//! grains carry impulses, and the pressure of one step differs from that of the next by as much as
//! its mean. In the summary mu and I are computed from the mean stresses and the mean rate, with
//! confidence intervals from blocks of time.

mod means;
mod sums;

use crate::chart::Axis;
use crate::encoding::{self, EncodingError};
use crate::figures::history;
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::quantity::Findings;
use crate::statistics::{Column, Table};
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use means::{Means, RESULTS};
use sums::{ShearedLayer, Sums};

/// Observer for [`fretwork_scene::measures::MeasureSpec::Shear`].
#[derive(Clone, Debug)]
pub struct Shear {
    /// Number of dimensions.
    dimension: usize,
    name: String,
    layer: ShearedLayer,
    start: f64,
    /// Velocities at the start of a step, by body (m/s).
    before: Vec<[f64; 3]>,
    /// Sums since the last row.
    row: Sums,
    /// Sums from which the last row was computed.
    last: Sums,
    /// Sums since `start`.
    whole: Sums,
}

const PARTS: [(&str, &str, &str); 8] = [
    ("rate", "1/s", "shear rate of the grains"),
    (
        "p",
        "Pa",
        "normal stress across the layers, of contacts and motion",
    ),
    (
        "mu",
        "",
        "shear stress over normal stress, of contacts and motion",
    ),
    ("phi", "", "solid fraction"),
    ("I", "", "inertial number"),
    (
        "tau",
        "Pa",
        "shear stress, of contacts and motion: traction of the upper side on the lower",
    ),
    (
        "p_kinetic",
        "Pa",
        "part of the normal stress that the motion of the grains carries",
    ),
    (
        "tau_kinetic",
        "Pa",
        "part of the shear stress that the motion of the grains carries",
    ),
];

impl Shear {
    pub(super) fn new(dimension: usize, name: String, [low, high]: [f64; 2], start: f64) -> Self {
        Self {
            dimension,
            name,
            layer: ShearedLayer { low, high },
            start,
            before: Vec::new(),
            row: Sums::default(),
            last: Sums::default(),
            whole: Sums::default(),
        }
    }

    fn column(&self, part: &str) -> String {
        format!("{}_{part}", self.name)
    }

    fn means(&self, table: &Table) -> Option<Means> {
        let column = |part: &str| table.column(&self.column(part));
        let columns = ["rate", "p", "tau", "phi"].map(column);
        let inertial = |rate: f64, p: f64| self.whole.inertial(self.dimension, rate, p);
        let kinetic = ["p_kinetic", "tau_kinetic"].map(column);
        Means::new(
            &table.column("time"),
            &columns,
            &kinetic,
            self.start,
            inertial,
        )
    }
}

impl Observer for Shear {
    fn name(&self) -> String {
        super::name_of("shear", &self.name)
    }

    fn before_step(&mut self, run: &dyn RunView) {
        self.before.clear();
        self.before.extend(run.bodies().velocity.iter());
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        let h = run.options().scheme.h;
        let step = self.layer.step(run, &self.before, h);
        self.row += &step;
        if run.time() > self.start {
            self.whole += &step;
        }
    }

    fn columns(&self) -> Vec<Column> {
        let column = |(part, unit, doc)| Column::new(self.column(part), unit, doc);
        PARTS.into_iter().map(column).collect()
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        // A second request at the same time gives the same row.
        if self.row.time > 0.0 {
            self.last = std::mem::take(&mut self.row);
        }
        let mut sums = self.last;
        if sums.time <= 0.0 {
            // Before the first step there is no momentum flux; the weight cancels.
            let now: Vec<[f64; 3]> = run.bodies().velocity.iter().collect();
            sums = self.layer.step(run, &now, 1.0);
            sums.contacts = [0.0; 2];
        }
        let [p, tau] = sums.stress();
        let [p_kinetic, tau_kinetic] = sums.kinetic();
        let rate = sums.rate / sums.time;
        vec![
            rate,
            p,
            if p > 0.0 { tau.abs() / p } else { 0.0 },
            sums.solid / sums.time,
            sums.inertial(self.dimension, rate, p),
            tau,
            p_kinetic,
            tau_kinetic,
        ]
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let means = self.means(end.table);
        if let Some(means) = &means {
            let doc = "means of plane shear, and what they are worth";
            found.finding(&self.name, means.describe(), doc);
        }
        let values = means.map_or([None; RESULTS.len()], |means| means.values());
        for ((part, unit, doc), value) in RESULTS.into_iter().zip(values) {
            found.measure(&self.column(part), value, unit, doc);
        }
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encoding::encode(&(&self.row, &self.last, &self.whole))
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        (self.row, self.last, self.whole) = encoding::decode(from)?;
        Ok(())
    }

    fn file_names(&self) -> Vec<String> {
        vec![format!("{}.png", self.name)]
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let chart = |part: &str, heading: &str, name: &str| {
            history(heading, Axis::of_rows(name), &[("", self.column(part))])
        };
        let panels = [
            chart("mu", "Effective friction", "friction coefficient µ = τ/p"),
            chart("phi", "Solid fraction", "solid fraction φ"),
            chart("I", "Inertial number", "inertial number I"),
            chart("p", "Pressure", "normal stress p"),
        ];
        vec![Output::figure(&self.name, panels, 2)]
    }
}
