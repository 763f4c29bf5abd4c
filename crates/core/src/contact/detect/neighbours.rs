//! Broad phase: pairs of shapes within the range of the neighbour list.

use super::sorted_centres::SortedCentres;
use super::{CollisionScene, frame};
use crate::contact::network::{Key, Network};
use crate::geometry::grid::{self, Balls};
use crate::geometry::space::{Space, VectorLike};
use crate::threads;

/// Shapes per task.
const CHUNK: usize = 2048;
/// Approximate time to test a shape against a surface (ns).
const COST: f64 = 20.0;

/// The neighbour list is built for this multiple of the spin of rotating surfaces.
const TURNING: f64 = 1.5;

/// Additional range around a body (m): its displacement in a step if it is fast, otherwise zero.
fn widening(widened: &[f64], body: u32) -> f64 {
    widened.get(body as usize).copied().unwrap_or(0.0)
}

/// A search for all pairs that may touch.
pub(super) struct NeighbourSearch<'a, S: Space> {
    scene: &'a CollisionScene<'a, S>,
    /// Centres of the balls, then of the convex pieces (m).
    centres: &'a [S::Vector],
    /// Radii of the bounding balls of these shapes (m), widened around fast bodies.
    radii: Vec<f64>,
    /// Largest distance of two bounding balls in the list (m).
    reach: f64,
    /// Whether each body never moves.
    still: Vec<bool>,
    parallel: bool,
}

impl<'a, S: Space> NeighbourSearch<'a, S> {
    pub(super) fn new(
        network: &Network<S>,
        scene: &'a CollisionScene<'a, S>,
        centres: &'a [S::Vector],
        parallel: bool,
    ) -> Self {
        let shapes = scene.shapes;
        let mut radii: Vec<f64> = shapes.balls.iter().map(|b| b.radius).collect();
        radii.extend(shapes.pieces.iter().map(|p| p.bound));
        if !network.widened.is_empty() {
            let of = shapes.balls.iter().map(|b| b.body);
            let of = of.chain(shapes.pieces.iter().map(|p| p.body));
            let radii = radii.iter_mut().zip(of);
            radii.for_each(|(r, b)| *r += widening(&network.widened, b));
        }
        Self {
            scene,
            centres,
            radii,
            reach: network.alert + network.skin,
            still: scene.bodies.fixed_bodies(),
            parallel,
        }
    }

    /// Returns body, material and key of the ball or piece at an index in the list of centres.
    #[inline]
    fn owner(&self, at: u32) -> (u32, u16, u32) {
        let shapes = self.scene.shapes;
        match shapes.balls.get(at as usize) {
            Some(ball) => (ball.body, ball.material, at),
            None => {
                let k = at - shapes.balls.len() as u32;
                let piece = &shapes.pieces[k as usize];
                (piece.body, piece.material, k | Key::PIECE)
            }
        }
    }

    /// Returns whether two bodies can touch at all.
    #[inline]
    fn may_touch(&self, i: u32, j: u32) -> bool {
        let (a, b, bodies) = (i as usize, j as usize, self.scene.bodies);
        !(i == j
            || bodies.removed[a]
            || bodies.removed[b]
            || (self.still[a] && self.still[b])
            || bodies.belong_together(a, b))
    }

    /// Returns the pairs of balls and pieces.
    pub(super) fn pairs_of_balls(&self) -> Vec<(u32, u32)> {
        let (shapes, reach) = (self.scene.shapes, self.reach);
        let keep = |a: u32, b: u32| {
            let (a, b) = (self.owner(a), self.owner(b));
            self.may_touch(a.0, b.0) && self.scene.laws.get(a.1, b.1).is_some()
        };
        let balls = Balls {
            centres: self.centres,
            radii: &self.radii,
            reach,
            periodic: &shapes.periodic,
        };
        let mut pairs = grid::pairs(&balls, self.parallel, keep);
        if !shapes.pieces.is_empty() {
            let name = |at: u32| self.owner(at).2;
            pairs.iter_mut().for_each(|p| *p = (name(p.0), name(p.1)));
        }
        pairs
    }

    /// Returns the pairs of balls and pieces with surfaces, surface by surface, and the spin of
    /// each surface for which the list is valid (rad/s), zero where rotation does not move it.
    pub(super) fn pairs_with_surfaces(
        &self,
        widened: &[f64],
        velocities: &[(S::Vector, S::Spin)],
        h: f64,
    ) -> (Vec<(u32, u32)>, Vec<f64>) {
        let (surfaces, periodic) = (&self.scene.shapes.surfaces, &self.scene.shapes.periodic);
        let all: Vec<u32> = (0..self.radii.len() as u32).collect();
        let any_closed = surfaces.iter().any(|s| s.shape.is_closed());
        let sorted = any_closed.then(|| SortedCentres::new::<S>(self.centres, periodic));
        let largest = self.radii.iter().copied().fold(0.0, f64::max);
        let divide = threads::worth_dividing(self.parallel, surfaces.len() * all.len(), COST);
        let size_of_task = threads::chunk_size(CHUNK);
        let of_surface = |s: usize| {
            let surface = &surfaces[s];
            let vertices = surface.shape.moving_vertices().iter();
            let size = vertices.map(|x| x.norm()).fold(0.0, f64::max);
            let spin = velocities[surface.body as usize].1;
            let sweeps = self.scene.sweeps(surface, &spin);
            let search = SurfaceSearch {
                s,
                size,
                sweep: sweeps.then(|| TURNING * spin.norm() * h),
                extra: widening(widened, surface.body),
            };
            let mut around = Vec::new();
            let candidates = match &sorted {
                Some(sorted) if surface.shape.is_closed() => {
                    let (origin, _) = frame(surface, self.scene.bodies);
                    let most = size + largest + self.reach + search.extra;
                    sorted.near(&origin, most, &mut around);
                    &around
                }
                _ => &all,
            };
            let found = threads::map_chunks(divide, candidates, size_of_task, |_, candidates| {
                self.near_surface(&search, candidates)
            });
            let spin = if sweeps { TURNING * spin.norm() } else { 0.0 };
            (found.concat(), spin)
        };
        let found = threads::map_ranges(divide, surfaces.len(), 1, |s| of_surface(s.start));
        let (mut pairs, mut turning) = (Vec::new(), Vec::with_capacity(surfaces.len()));
        for (of_surface, spin) in found {
            pairs.extend(of_surface);
            turning.push(spin);
        }
        (pairs, turning)
    }

    /// Returns the pairs of some balls and pieces with a surface.
    fn near_surface(&self, search: &SurfaceSearch, candidates: &[u32]) -> Vec<(u32, u32)> {
        let CollisionScene {
            shapes,
            bodies,
            laws,
        } = *self.scene;
        let surface = &shapes.surfaces[search.s];
        let (origin, rotation) = frame(surface, bodies);
        let pivot = bodies.position[surface.body as usize];
        let closed = surface.shape.is_closed();
        let mut pairs = Vec::new();
        for at in candidates {
            let (body, material, name) = self.owner(*at);
            let radius = self.radii[*at as usize];
            let known = laws.get(material, surface.material).is_some();
            if !known || !self.may_touch(body, surface.body) {
                continue;
            }
            let centre = self.centres[*at as usize];
            let mut reach = radius + self.reach + search.extra;
            let mut apart = centre - origin;
            let pair = (name, search.s as u32 | Key::SURFACE);
            if closed {
                apart = shapes.periodic.shortest(apart);
                let far = apart.norm();
                if far > search.size + reach {
                    continue;
                }
                if far < search.size {
                    // Inside a grain a shape may touch at any depth.
                    pairs.push(pair);
                    continue;
                }
            }
            if let Some(sweep) = search.sweep {
                reach += sweep * ((centre - pivot).norm() + radius);
            }
            if surface.shape.near(&S::unrotate(&rotation, &apart), reach) {
                pairs.push(pair);
            }
        }
        pairs
    }
}

/// The search for shapes near a surface.
struct SurfaceSearch {
    /// Index of the surface.
    s: usize,
    /// Distance of the farthest vertex from the origin of a surface that deforms (m); else zero.
    size: f64,
    /// Angle by which the surface may turn before the list is built again (rad); `None` if it
    /// deforms, or if the rotation leaves it unchanged.
    sweep: Option<f64>,
    /// Additional range if the surface is fast (m).
    extra: f64,
}

/// Merges sorted pairs with others in any order; the result is sorted, with each pair once.
pub(super) fn joined(pairs: Vec<(u32, u32)>, mut more: Vec<(u32, u32)>) -> Vec<(u32, u32)> {
    if more.is_empty() {
        return pairs;
    }
    more.sort_unstable();
    more.dedup();
    let mut out = Vec::with_capacity(pairs.len() + more.len());
    let mut more = more.into_iter().peekable();
    for pair in pairs {
        while let Some(other) = more.next_if(|other| *other <= pair) {
            if other < pair {
                out.push(other);
            }
        }
        out.push(pair);
    }
    out.extend(more);
    out
}

#[cfg(test)]
mod tests {
    use super::joined;

    #[test]
    fn joined_pairs_are_sorted_and_single() {
        let pairs: Vec<(u32, u32)> = (0..20).map(|k| (k / 3, 2 * k)).collect();
        for step in [1, 2, 7, 50] {
            let more: Vec<_> = (0..40).map(|k| (k * step % 9, k)).collect();
            let more = [more.clone(), more].concat();
            let mut all = [pairs.clone(), more.clone()].concat();
            all.sort_unstable();
            all.dedup();
            assert_eq!(joined(pairs.clone(), more), all);
        }
        assert_eq!(joined(Vec::new(), vec![(2, 1), (1, 2)]), [(1, 2), (2, 1)]);
        assert_eq!(joined(pairs.clone(), Vec::new()), pairs);
    }
}
