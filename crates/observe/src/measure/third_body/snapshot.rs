//! State of the layer at an instant: its cells, and its values for a row of the statistics.

use super::cells::Cell;
use super::chains::{GrainPair, chains};
use super::clusters::{Clusters, clusters};
use super::cut;
use super::gap::{Faces, Gap};
use crate::coordination::degrees;
use crate::measure::Grain;
use crate::stress::each_moment;
use fretwork_core::contact::BondState;
use fretwork_core::geometry::space::ball_volume;
use fretwork_core::view::RunView;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Statistics of force chains.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ChainNumbers {
    /// Fraction of the grains in chains.
    pub grains: f64,
    /// Fraction of the normal force between grains that the links carry.
    pub force: f64,
    /// Mean number of grains per chain; 0 without chains.
    pub length: f64,
    /// Mean angle of the links from the normal of the layer towards the sliding (rad); NaN without
    /// chains.
    pub angle: f64,
}

/// The layer at an instant.
#[derive(Clone, Debug)]
pub(super) struct LayerSnapshot {
    /// Position and thickness of the layer.
    pub gap: Gap,
    /// Cells across the layer, as in [`super::cells::Block::cells`].
    pub cells: Vec<Cell>,
    /// Velocity of the second body's face relative to the first's, along the sliding (m/s).
    pub sliding: f64,
    /// Mean number of contacts that carry force per grain.
    pub coordination: f64,
    /// Clusters.
    pub clusters: Clusters,
    /// Chains.
    pub chains: ChainNumbers,
}

/// Volume fraction of a grain in a cell.
struct Share {
    grain: u32,
    cell: u32,
    share: f64,
}

impl LayerSnapshot {
    /// Evaluates the layer. `lost` is the number of broken bonds of each body.
    pub fn new(
        run: &dyn RunView,
        faces: &Faces,
        all: &[Grain],
        along: usize,
        lost: &[f64],
    ) -> Self {
        let gap = faces.gap(run);
        let (floor, slide) = faces.sliding(run);
        let flags = run.grain_flags();
        let mut cells = vec![Cell::default(); gap.bins + 2];
        cells[1..=gap.bins]
            .iter_mut()
            .for_each(|c| c.space = gap.bin_volume());
        let mut shares = Vec::with_capacity(3 * all.len());
        for (k, grain) in all.iter().enumerate() {
            cut::share(run, &gap, grain, |cell, share| {
                if share > 0.0 {
                    let (grain, cell) = (k as u32, cell as u32);
                    shares.push(Share { grain, cell, share });
                }
            });
        }
        let (bodies, dimension) = (run.bodies(), run.dimension());
        let degree = degrees(run);
        let held = held(run);
        let mut means = vec![(0.0, 0.0, Vector3::zeros()); cells.len()];
        for Share { grain, cell, share } in &shares {
            let (grain, cell) = (&all[*grain as usize], *cell as usize);
            let (b, mass) = (grain.body, share * grain.mass);
            let velocity = Vector3::from(bodies.velocity.at(b)) - floor;
            let depth = gap.depth(&grain.at.into()) / gap.thickness;
            let mean = &mut means[cell];
            *mean = (
                mean.0 + mass,
                mean.1 + mass * depth,
                mean.2 + velocity * mass,
            );
            let (v, slide) = (velocity[along], slide[along]);
            let spin = Vector3::from(bodies.spin.at(b));
            let c = &mut cells[cell];
            c.volume += share * ball_volume(dimension, grain.radius);
            c.mass += mass;
            c.height += mass * depth;
            c.momentum += mass * v;
            c.drive += mass * v * slide;
            c.square += mass * slide * slide;
            c.spin += mass * if dimension == 2 { spin[2] } else { spin.norm() };
            c.grains += share;
            c.contacts += share * f64::from(degree[b]);
            c.bonds += share * held[b];
            c.broken += share * lost[b];
            c.warmth += mass * run.temperature(b).unwrap_or_default();
        }
        granular_temperature(run, &gap, &floor, all, &shares, &means, &mut cells);
        stress(run, &gap, along, &mut cells);
        let free = || flags.iter().zip(&degree).filter(|(free, _)| **free);
        let contacts: f64 = free().map(|(_, d)| f64::from(*d)).sum();
        Self {
            coordination: contacts / free().count().max(1) as f64,
            sliding: slide[along],
            clusters: clusters(run, &flags),
            chains: chain_numbers(run, &gap, along, &flags),
            gap,
            cells,
        }
    }

    /// Returns the sum over the bins between the faces.
    pub fn whole(&self) -> Cell {
        let mut sum = Cell::default();
        self.cells[1..=self.gap.bins].iter().for_each(|c| sum += c);
        sum
    }
}

/// Returns mass times granular temperature |v - <v>(y)|^2/D, with <v>(y) interpolated linearly
/// between the mean positions and velocities of the bins, so that an affine field has zero
/// temperature.
fn granular_temperature(
    run: &dyn RunView,
    gap: &Gap,
    floor: &Vector3<f64>,
    all: &[Grain],
    shares: &[Share],
    means: &[(f64, f64, Vector3<f64>)],
    cells: &mut [Cell],
) {
    let full = means[1..=gap.bins].iter().filter(|m| m.0 > 0.0);
    let points: Vec<(f64, Vector3<f64>)> = full.map(|m| (m.1 / m.0, m.2 * (1.0 / m.0))).collect();
    let (velocity, dimension) = (run.bodies().velocity, run.dimension() as f64);
    for Share { grain, cell, share } in shares {
        let (grain, cell) = (&all[*grain as usize], *cell as usize);
        if !(1..=gap.bins).contains(&cell) {
            continue;
        }
        let depth = gap.depth(&grain.at.into()) / gap.thickness;
        let v = Vector3::from(velocity.at(grain.body)) - *floor - mean_at(&points, depth);
        cells[cell].granular += share * grain.mass * v.dot(&v) / dimension;
    }
}

/// Interpolates linearly between the adjacent points, or extrapolates from the last two.
fn mean_at(points: &[(f64, Vector3<f64>)], place: f64) -> Vector3<f64> {
    if points.len() < 2 {
        return points.first().map_or(Vector3::zeros(), |p| p.1);
    }
    let k = points.partition_point(|p| p.0 < place);
    let k = k.clamp(1, points.len() - 1);
    let (a, b) = (&points[k - 1], &points[k]);
    if b.0 <= a.0 {
        return a.1;
    }
    // Thin bins at a wall may hold the same grains at nearly the same mean position, so the
    // extrapolation is limited.
    let ratio = ((place - a.0) / (b.0 - a.0)).clamp(-1.0, 2.0);
    a.1 + (b.1 - a.1) * ratio
}

/// Returns the number of intact bonds of each body.
fn held(run: &dyn RunView) -> Vec<f64> {
    let mut held = vec![0.0; run.bodies().len()];
    run.visit_contacts(&mut |contact| {
        if let BondState::Intact { .. } = contact.bond {
            contact.bodies.iter().for_each(|b| held[*b as usize] += 1.0);
        }
    });
    held
}

/// Returns the Love-Weber stress, with each branch distributed by its length in the bins.
fn stress(run: &dyn RunView, gap: &Gap, along: usize, cells: &mut [Cell]) {
    let across = gap.across;
    let lateral = (0..run.dimension()).find(|k| *k != across && *k != along);
    let position = run.bodies().position;
    each_moment(run, |body, force, branch| {
        let from = gap.depth(&position.at(body));
        let to = from + gap.side * branch[across];
        let moment = [
            force[across] * branch[across],
            force[along] * branch[along],
            // Traction of the second body's side on the first body's side along the sliding.
            -gap.side * force[along] * branch[across],
            lateral.map_or(0.0, |k| force[k] * branch[k]),
        ];
        let (low, high) = (from.min(to), from.max(to));
        let below = |d: f64| (d - low) / (high - low);
        gap.share(low, high, below, |cell, share| {
            let sums = cells[cell].moment.iter_mut().zip(moment);
            sums.for_each(|(sum, m)| *sum += share * m);
        });
    });
}

/// Returns the links of the force chains, as sorted pairs of bodies.
pub(super) fn links(run: &dyn RunView) -> Vec<[u32; 2]> {
    let (loads, pairs) = loads(run, &run.grain_flags());
    let found = chains(&loads, run.dimension() == 2, &pairs);
    // Pairs are sorted.
    let ends = found.links.iter().map(|k| pairs[*k].ends);
    ends.map(|e| e.map(|b| b as u32)).collect()
}

fn chain_numbers(run: &dyn RunView, gap: &Gap, along: usize, grain: &[bool]) -> ChainNumbers {
    let (loads, pairs) = loads(run, grain);
    let found = chains(&loads, run.dimension() == 2, &pairs);
    let grains = grain.iter().filter(|g| **g).count().max(1) as f64;
    let all: f64 = pairs.iter().map(|p| p.force).sum();
    let (mut force, mut sin, mut cos) = (0.0, 0.0, 0.0);
    for pair in found.links.iter().map(|k| &pairs[*k]) {
        force += pair.force;
        // A link has no orientation: doubling its angle makes opposite directions equal.
        let angle = 2.0 * pair.branch[along].atan2(gap.side * pair.branch[gap.across]);
        sin += angle.sin();
        cos += angle.cos();
    }
    let mean = 0.5 * sin.atan2(cos);
    ChainNumbers {
        grains: found.grains as f64 / grains,
        force: if all > 0.0 { force / all } else { 0.0 },
        length: found.grains as f64 / found.count.max(1) as f64,
        angle: if found.count > 0 {
            mean.clamp(-FRAC_PI_2, FRAC_PI_2)
        } else {
            f64::NAN
        },
    }
}

/// Returns the stresses of the grains, and the pairs of grains that press on each other.
fn loads(run: &dyn RunView, grain: &[bool]) -> (Vec<Matrix3<f64>>, Vec<GrainPair>) {
    let bodies = run.bodies();
    let of_ball = |radius: f64| ball_volume(run.dimension(), radius);
    let mut volume = vec![0.0; bodies.len()];
    for ball in run.balls() {
        volume[ball.body as usize] += of_ball(ball.radius);
    }
    for piece in run.pieces() {
        volume[piece.body as usize] += of_ball(piece.size);
    }
    for grain in run.surfaces().into_iter().filter(|f| f.closed) {
        let body = grain.body as usize;
        volume[body] += of_ball(bodies.length[body]);
    }
    let mut loads = vec![Matrix3::zeros(); bodies.len()];
    each_moment(run, |body, force, branch| {
        let moment = force * branch.transpose();
        loads[body] += (moment + moment.transpose()) * (0.5 / volume[body]);
    });
    let mut pressed: Vec<([u32; 2], f64)> = Vec::new();
    run.visit_contacts(&mut |contact| {
        let force = Vector3::from(contact.normal).dot(&Vector3::from(contact.impulse));
        let [a, b] = contact.bodies;
        if force > 0.0 && grain[a as usize] && grain[b as usize] {
            pressed.push(([a.min(b), a.max(b)], force));
        }
    });
    pressed.sort_by_key(|p| p.0);
    let mut pairs: Vec<GrainPair> = Vec::with_capacity(pressed.len());
    for (ends, force) in pressed {
        let ends = ends.map(|b| b as usize);
        if let Some(last) = pairs.last_mut().filter(|p| p.ends == ends) {
            last.force += force;
            continue;
        }
        let [a, b] = ends.map(|b| Vector3::from(bodies.position.at(b)));
        let branch = run.periodic().shortest(b - a);
        pairs.push(GrainPair {
            ends,
            branch,
            force,
        });
    }
    (loads, pairs)
}
