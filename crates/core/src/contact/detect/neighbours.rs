//! Broad phase: pairs of shapes within the range of the neighbour list.

use super::sorted::Sorted;
use super::{LawTable, frame};
use crate::bodies::Bodies;
use crate::contact::network::{Key, Network};
use crate::geometry::grid;
use crate::geometry::shape::Shapes;
use crate::geometry::space::{Space, VectorLike};

/// The neighbour list is built for this multiple of the spin of rotating surfaces.
const TURNING: f64 = 1.5;

/// Additional range around a fast body (m): the list extends as far as it moves.
fn widening(widened: &[f64], body: u32) -> f64 {
    widened.get(body as usize).copied().unwrap_or(0.0)
}

/// A search for all pairs that may touch.
pub(super) struct NeighbourSearch<'a, S: Space> {
    shapes: &'a Shapes<S>,
    bodies: &'a Bodies<S>,
    laws: &'a LawTable,
    /// Centres of the balls, then of the convex pieces (m).
    centres: &'a [S::Vector],
    /// Radii of their bounding balls (m), widened around fast bodies.
    radii: Vec<f64>,
    /// Range beyond these (m).
    reach: f64,
    /// Whether each body never moves.
    still: Vec<bool>,
}

impl<'a, S: Space> NeighbourSearch<'a, S> {
    pub(super) fn new(
        network: &Network<S>,
        shapes: &'a Shapes<S>,
        bodies: &'a Bodies<S>,
        laws: &'a LawTable,
        centres: &'a [S::Vector],
    ) -> Self {
        let mut radii: Vec<f64> = shapes.balls.iter().map(|b| b.radius).collect();
        radii.extend(shapes.pieces.iter().map(|p| p.bound));
        if !network.widened.is_empty() {
            let of = shapes.balls.iter().map(|b| b.body);
            let of = of.chain(shapes.pieces.iter().map(|p| p.body));
            let radii = radii.iter_mut().zip(of);
            radii.for_each(|(r, b)| *r += widening(&network.widened, b));
        }
        Self {
            shapes,
            bodies,
            laws,
            centres,
            radii,
            reach: network.alert + network.skin,
            still: bodies.still(),
        }
    }

    /// Returns body, material and key of the ball or piece at an index in the list of centres.
    #[inline]
    fn owner(&self, at: u32) -> (u32, u16, u32) {
        match self.shapes.balls.get(at as usize) {
            Some(ball) => (ball.body, ball.material, at),
            None => {
                let k = at - self.shapes.balls.len() as u32;
                let piece = &self.shapes.pieces[k as usize];
                (piece.body, piece.material, k | Key::PIECE)
            }
        }
    }

    /// Returns whether two bodies can touch at all.
    #[inline]
    fn may_touch(&self, i: u32, j: u32) -> bool {
        let (a, b) = (i as usize, j as usize);
        !(i == j
            || self.bodies.removed[a]
            || self.bodies.removed[b]
            || (self.still[a] && self.still[b])
            || self.bodies.belong_together(a, b))
    }

    /// Returns the pairs of balls and pieces.
    pub(super) fn pairs_of_balls(&self) -> Vec<(u32, u32)> {
        let periodic = &self.shapes.periodic;
        let pairs = grid::pairs(self.centres, &self.radii, self.reach, periodic, |a, b| {
            let (a, b) = (self.owner(a), self.owner(b));
            self.may_touch(a.0, b.0) && self.laws.get(a.1, b.1).is_some()
        });
        if self.shapes.pieces.is_empty() {
            return pairs;
        }
        let name = |at: u32| self.owner(at).2;
        pairs.iter().map(|p| (name(p.0), name(p.1))).collect()
    }

    /// Adds the pairs of balls and pieces with surfaces; returns the spin of each surface for which the list is
    /// valid (rad/s), zero where rotation does not move it.
    pub(super) fn add_pairs_with_surfaces(
        &self,
        pairs: &mut Vec<(u32, u32)>,
        widened: &[f64],
        velocities: &[(S::Vector, S::Spin)],
        h: f64,
    ) -> Vec<f64> {
        let mut turning = Vec::with_capacity(self.shapes.surfaces.len());
        let all: Vec<u32> = (0..self.radii.len() as u32).collect();
        let any_closed = self.shapes.surfaces.iter().any(|s| s.shape.is_closed());
        let sorted = any_closed.then(|| Sorted::new::<S>(self.centres, &self.shapes.periodic));
        let largest = self.radii.iter().copied().fold(0.0, f64::max);
        let mut around = Vec::new();
        for (s, surface) in self.shapes.surfaces.iter().enumerate() {
            let (origin, rotation) = frame(surface.body, &surface.offset, self.bodies);
            let pivot = self.bodies.position[surface.body as usize];
            let spin = velocities[surface.body as usize].1;
            let follows = surface.shape.deforms();
            let sweeps = !follows
                && !surface
                    .shape
                    .keeps_place(&S::unrotate_spin(&rotation, &spin));
            let closed = surface.shape.is_closed();
            let vertices = surface.shape.moving_vertices().iter();
            let size = vertices.map(|x| x.norm()).fold(0.0, f64::max);
            let spin = if sweeps { TURNING * spin.norm() } else { 0.0 };
            turning.push(spin);
            let extra = widening(widened, surface.body);
            let candidates = match &sorted {
                Some(sorted) if closed => {
                    let most = size + largest + self.reach + extra;
                    sorted.near(&origin, most, &mut around);
                    &around
                }
                _ => &all,
            };
            for at in candidates {
                let (body, material, name) = self.owner(*at);
                let radius = self.radii[*at as usize];
                let known = self.laws.get(material, surface.material).is_some();
                if known && self.may_touch(body, surface.body) {
                    let centre = self.centres[*at as usize];
                    let mut reach = radius + self.reach + extra;
                    let mut apart = centre - origin;
                    if closed {
                        apart = self.shapes.periodic.shortest(apart);
                        let far = apart.norm();
                        if far > size + reach {
                            continue;
                        }
                        if far < size {
                            // Within a grain no place is too deep.
                            pairs.push((name, s as u32 | Key::SURFACE));
                            continue;
                        }
                    }
                    let local = S::unrotate(&rotation, &apart);
                    if sweeps {
                        reach += spin * h * ((centre - pivot).norm() + radius);
                    }
                    if surface.shape.near(&local, reach) {
                        pairs.push((name, s as u32 | Key::SURFACE));
                    }
                }
            }
        }
        turning
    }
}
