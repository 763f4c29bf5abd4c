//! Third body: profiles across its thickness and over time, clusters, force chains, flow regime,
//! and the distribution of dissipation. Definitions and criteria are in `docs/third_body.md`.

mod cells;
mod chains;
mod clusters;
mod cut;
mod dissipation;
mod figure;
mod gap;
mod regime;
mod snapshot;
mod tables;

use super::{grains, mean, since};
use crate::encoding::{self, EncodingError};
use crate::observer::{Observer, RunEnd};
use crate::output::Output;
use crate::picture::{Picture, PictureContent};
use crate::quantity::unit::{ENERGY, ONE};
use crate::quantity::{Findings, Topic, Unit};
use crate::statistics::{Column, Table};
use cells::{Block, History, MECHANISMS};
use clusters::Clusters;
use dissipation::{Dissipation, PairKind};
use fretwork_core::step::StepReport;
use fretwork_core::view::RunView;
use fretwork_scene::measures::ThirdBodySpec;
use gap::Faces;
use regime::{FlowProfile, FlowRegime, flow};
use serde::{Deserialize, Serialize};
use snapshot::LayerSnapshot;

/// Observer for [`fretwork_scene::measures::MeasureSpec::ThirdBody`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ThirdBody {
    /// Number of dimensions.
    dimension: usize,
    spec: ThirdBodySpec,
    faces: Option<Faces>,
    dissipation: Dissipation,
    /// Number of broken bonds of each body.
    lost: Vec<f64>,
    history: History,
    clusters: Clusters,
    /// Factor to divide out of masses.
    inertia_scaling: f64,
    /// Whether grains have temperatures.
    heated: bool,
    /// Time of the last sample, or of the start (s).
    seen: f64,
    /// Largest sliding velocity so far (m/s).
    fastest: f64,
    /// Number of rows so far, and the values that rows repeat until the next evaluation.
    rows: usize,
    row: Vec<f64>,
}

/// Fraction of the largest sliding velocity below which the motion is at a reversal, and no regime
/// is determined.
const TURNING: f64 = 1e-2;

/// Returns name, unit and description of the columns; `stress_lateral` exists in 3D only,
/// `temperature` where heat is computed.
const COLUMNS: [(&str, &str, &str); 21] = [
    ("thickness", "m", "thickness of the third body"),
    ("solid_fraction", "", "solid fraction between the faces"),
    (
        "coordination",
        "",
        "contacts that carry force, mean over the grains",
    ),
    (
        "granular_temperature",
        "m^2/s^2",
        "granular temperature between the faces",
    ),
    (
        "temperature",
        "K",
        "temperature of the grains between the faces, mean by mass",
    ),
    (
        "stress_across",
        "Pa",
        "normal stress across the layer, positive in compression",
    ),
    (
        "stress_along",
        "Pa",
        "normal stress along the sliding, positive in compression",
    ),
    (
        "stress_shear",
        "Pa",
        "shear stress: traction of the second body's side on the first body's side",
    ),
    (
        "stress_lateral",
        "Pa",
        "normal stress across the sliding in the layer, positive in compression",
    ),
    (
        "sliding",
        "m/s",
        "velocity of the second body's face relative to the first's",
    ),
    (
        "slip_first",
        "m/s",
        "velocity of the grains at the first body relative to it",
    ),
    (
        "slip_second",
        "m/s",
        "velocity of the second body relative to the grains at it",
    ),
    ("clusters", "", "clusters of two bonded grains or more"),
    ("cluster_mean", "", "grains of a cluster, mean by mass"),
    ("cluster_largest", "", "grains of the largest cluster"),
    (
        "chains",
        "",
        "fraction of the grains that are in force chains",
    ),
    (
        "chain_force",
        "",
        "fraction of the normal force between grains that chains carry",
    ),
    ("chain_length", "", "grains of a force chain, mean"),
    (
        "chain_angle",
        "rad",
        "mean angle of chains from the normal towards the sliding",
    ),
    (
        "interior_shear",
        "",
        "difference of velocity between 10 % and 90 % of the thickness over the sliding",
    ),
    (
        "regime",
        "",
        "0 none, 1 Couette, 2 agglomerated, 3 plug with wall slip, 4 mixed",
    ),
];

fn columns(
    dimension: usize,
    heated: bool,
) -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let shown = move |c: &(&str, &str, &str)| match c.0 {
        "stress_lateral" => dimension == 3,
        "temperature" => heated,
        _ => true,
    };
    COLUMNS.into_iter().filter(shown)
}

/// Whether the mean of a column over the run is a result.
fn is_averaged(part: &str) -> bool {
    !(part.starts_with("slip") || ["sliding", "interior_shear", "regime"].contains(&part))
}

impl ThirdBody {
    /// Name of its pictures.
    pub const PICTURE: &str = "chains";

    pub(super) fn new(spec: ThirdBodySpec, inertia_scaling: f64, run: &dyn RunView) -> Self {
        let (dimension, heated) = (run.dimension(), run.heat().is_some());
        Self {
            dimension,
            dissipation: Dissipation::new(spec.bins, Vec::new()),
            seen: spec.start,
            spec,
            faces: None,
            lost: Vec::new(),
            history: History::new(),
            clusters: Clusters::default(),
            inertia_scaling,
            heated,
            fastest: 0.0,
            rows: 0,
            row: vec![f64::NAN; columns(dimension, heated).count()],
        }
    }

    fn column(&self, part: &str) -> String {
        format!("{}_{part}", self.spec.name)
    }

    /// Returns whether the next step ends after the start: it is the first that counts, as in a
    /// friction test.
    fn due(&self, run: &dyn RunView) -> bool {
        run.time() + run.options().scheme.h > self.spec.start
    }

    /// Returns the flow at the end (over the last complete cycle of the friction test, or the
    /// second half of the time), the mass-weighted mean cluster size there, and a description of
    /// that interval.
    fn flow(&self, table: &Table) -> (Option<FlowProfile>, f64, String) {
        let all = self.history.whole().time;
        let cycle = table.last_cycle().filter(|(_, start)| *start >= all[0]);
        let (over, start) = match cycle {
            Some((number, start)) => (format!("from cycle {number} on"), start),
            None => ("over the second half".to_owned(), 0.5 * (all[0] + all[1])),
        };
        let late = self.history.since(start);
        let cluster = late.cluster / late.samples.max(1) as f64;
        (flow(&late.profile()), cluster, over)
    }

    fn row(&mut self, now: &LayerSnapshot) -> Vec<f64> {
        let whole = now.whole();
        let block = Block {
            cells: now.cells.clone(),
            ..Block::default()
        };
        let full = || block.bins().iter().filter(|c| c.mass > 0.0);
        let velocity = |c: Option<&cells::Cell>| c.map_or(f64::NAN, cells::Cell::velocity);
        let [first, last] = [velocity(full().next()), velocity(full().next_back())];
        self.fastest = self.fastest.max(now.sliding.abs());
        let slides = now.sliding.abs() > TURNING * self.fastest;
        let flow = flow(&block.profile()).filter(|_| slides);
        let stress = whole.stress();
        let mut row = vec![
            now.gap.thickness,
            whole.solid(),
            now.coordination,
            whole.granular_temperature(),
        ];
        row.extend(self.heated.then(|| whole.temperature()));
        row.extend_from_slice(&stress[..if self.dimension == 3 { 4 } else { 3 }]);
        row.extend([
            now.sliding,
            first,
            now.sliding - last,
            now.clusters.count as f64,
            now.clusters.mean,
            now.clusters.largest as f64,
            now.chains.grains,
            now.chains.force,
            now.chains.length,
            now.chains.angle,
            flow.map_or(f64::NAN, |f| f.interior),
            FlowRegime::of(flow.as_ref(), now.clusters.mean) as i32 as f64,
        ]);
        row
    }
}

impl Observer for ThirdBody {
    fn name(&self) -> String {
        super::name_of("third body", &self.spec.name)
    }

    fn begin(&mut self, run: &dyn RunView) {
        if self.faces.is_some() {
            return;
        }
        let (one, other) = &self.spec.between;
        self.faces = Faces::new(run, [one, other], self.spec.across, self.spec.bins);
        if let Some(faces) = &mut self.faces {
            faces.look(run, self.spec.extent, &grains(run));
        }
        self.dissipation = Dissipation::new(self.spec.bins, run.grain_flags());
        if self.faces.is_some() && self.due(run) {
            self.dissipation.begin(run);
        }
        self.lost = vec![0.0; run.bodies().len()];
        self.seen = self.seen.max(run.time());
    }

    fn needs_dissipation(&self) -> bool {
        true
    }

    fn after_step(&mut self, run: &dyn RunView, _: &StepReport) {
        for body in run.bond_breaks().iter().flat_map(|b| b.bodies) {
            self.lost[body as usize] += 1.0;
        }
        let Some(faces) = &self.faces else { return };
        if self.dissipation.counts() {
            self.dissipation
                .follow(run, faces, &faces.gap(run), self.spec.along);
        } else if self.due(run) {
            self.dissipation.begin(run);
            self.seen = run.time();
        }
    }

    fn columns(&self) -> Vec<Column> {
        let column = |(part, unit, doc)| Column::new(self.column(part), unit, doc);
        columns(self.dimension, self.heated).map(column).collect()
    }

    fn sample(&mut self, run: &dyn RunView) -> Vec<f64> {
        self.rows += 1;
        let looks = (self.rows - 1).is_multiple_of(self.spec.every);
        let Some(faces) = self.faces.as_mut().filter(|_| looks) else {
            return self.row.clone();
        };
        let all = grains(run);
        faces.look(run, self.spec.extent, &all);
        let mut now = LayerSnapshot::new(run, faces, &all, self.spec.along, &self.lost);
        self.row = self.row(&now);
        if self.dissipation.counts() && run.time() > self.seen {
            // The sign of the resistance is that against the sliding, also if the sliding
            // reciprocates.
            let sign = now.sliding.signum();
            now.cells.iter_mut().for_each(|c| c.moment[2] *= sign);
            for (cell, energy) in now.cells[1..].iter_mut().zip(self.dissipation.take()) {
                cell.energy = energy;
            }
            self.history.add(Block {
                time: [self.seen, run.time()],
                samples: 1,
                thickness: now.gap.thickness,
                cluster: now.clusters.mean,
                cells: now.cells,
            });
            self.seen = run.time();
        }
        self.clusters = now.clusters;
        self.row.clone()
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        let (flow, cluster, over) = self.flow(end.table);
        let regime = FlowRegime::of(flow.as_ref(), cluster);
        let said = regime.describe(flow.as_ref(), cluster);
        let doc = "flow regime of the layer";
        let text = format!("{said}; {over}");
        found
            .finding(&self.column("regime"), text, doc)
            .about(Topic::Regime);
        let means = Observer::columns(self)
            .into_iter()
            .zip(columns(self.dimension, self.heated));
        for (column, (part, ..)) in means.filter(|(_, c)| is_averaged(c.0)) {
            let value = mean(&since(end.table, &column.name, self.spec.start));
            let doc = format!("{}; mean over the run", column.doc);
            found.measure(&self.column(part), value, column.unit, doc);
        }
        let mut add = |part: &str, value: Option<f64>, unit: Unit, doc: String| {
            found.measure(&self.column(part), value, unit, doc);
        };
        let doc = "flow regime: 0 none, 1 Couette, 2 agglomerated, 3 plug with wall slip, 4 mixed";
        add("regime", Some(regime as i32 as f64), ONE, doc.to_owned());
        let flow = flow.as_ref();
        for (part, value, doc) in [
            (
                "interior_shear",
                flow.map(|f| f.interior),
                "velocity difference within the layer over the sliding",
            ),
            (
                "straightness",
                flow.map(|f| f.straight),
                "straightness of the velocity profile",
            ),
            (
                "slip_first_share",
                flow.map(|f| f.slip_first),
                "slip at the first body over the sliding",
            ),
            (
                "slip_second_share",
                flow.map(|f| f.slip_second),
                "slip at the second body over the sliding",
            ),
        ] {
            add(part, value, ONE, doc.to_owned());
        }
        let total = self.dissipation.total();
        add(
            "dissipated",
            Some(total),
            ENERGY,
            "energy dissipated in the layer and at its faces".to_owned(),
        );
        for (k, mechanism) in MECHANISMS.iter().enumerate() {
            let sum: f64 = self.dissipation.places.iter().map(|p| p[k]).sum();
            let doc = format!("energy dissipated by {mechanism}");
            let part = format!("dissipated_{mechanism}");
            add(&part, Some(sum), ENERGY, doc);
        }
        let load = self.dissipation.load;
        let mu = self.dissipation.friction();
        // What is kept is the energy stored by the grains and their bonds, less that supplied by
        // the bodies other than by sliding.
        for (part, value, doc) in [
            (
                "mu_from_forces",
                mu.map(|_| self.dissipation.work / load),
                "friction from forces",
            ),
            ("mu_from_dissipation", mu, "friction from the energy ledger"),
            (
                "mu_kept",
                mu.map(|mu| mu - total / load),
                "part of the friction that is stored, not dissipated",
            ),
        ] {
            add(part, value, ONE, doc.to_owned());
        }
        for (place, energies) in PairKind::ALL.iter().zip(&self.dissipation.places) {
            let sum: f64 = energies.iter().sum();
            let any = *energies != dissipation::Energies::default();
            let name = place.name(&self.spec.between);
            let share = (any && total != 0.0).then(|| sum / total);
            let doc = format!("share of the dissipation at {name}");
            add(&format!("share_{name}"), share, ONE, doc);
            let part = (any && load > 0.0).then(|| sum / load);
            let doc = format!("part of the friction that is dissipated at {name}");
            add(&format!("mu_{name}"), part, ONE, doc);
        }
    }

    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        vec![Picture {
            name: Self::PICTURE,
            shows: PictureContent::Chains(snapshot::links(run)),
        }]
    }

    fn picture_names(&self) -> Vec<&'static str> {
        vec![Self::PICTURE]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encoding::encode(self)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        *self = encoding::decode(from)?;
        Ok(())
    }

    fn file_names(&self) -> Vec<String> {
        let ends = [".csv", "_energy.csv", "_clusters.csv", ".png"];
        ends.map(|end| format!("{}{end}", self.spec.name)).to_vec()
    }

    fn figures(&self, _: &RunEnd<'_>) -> Vec<Output> {
        let name = &self.spec.name;
        let (whole, slices) = (self.history.whole(), self.history.slices(self.spec.slices));
        let text = |part: &str, text: String| Output::Text {
            file: format!("{name}{part}.csv"),
            text,
        };
        let mut outputs = vec![
            text(
                "",
                tables::profiles(&whole, &slices, self.dimension, self.heated),
            ),
            text(
                "_energy",
                tables::energies(&self.dissipation, &self.spec.between, self.dimension),
            ),
            text(
                "_clusters",
                tables::clusters(&self.clusters, self.inertia_scaling, self.dimension),
            ),
        ];
        let figure = figure::LayerFigure {
            whole: &whole,
            slices: &slices,
            between: &self.spec.between,
            column: &|part| self.column(part),
            dimension: self.dimension,
            heated: self.heated,
        };
        outputs.push(Output::leading(name, figure.charts(), 2));
        outputs
    }
}
