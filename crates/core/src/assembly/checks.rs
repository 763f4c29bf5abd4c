//! Numbers of pairs of grains in a scene, counted before any pair is stored.

use super::SceneParts;
use crate::contact::detect::{LawTable, centre};
use crate::geometry::grid::{self, Balls};
use crate::geometry::space::{Space, VectorLike};

/// A place where more grains are close to each other than is possible.
#[derive(Clone, Debug, PartialEq)]
pub struct Overcrowding {
    /// Index of a body at this place.
    pub body: u32,
    /// Position (m).
    pub at: [f64; 3],
    /// Number of shapes at this place.
    pub count: usize,
    /// Size of the grid cell in which they are counted (m).
    pub size: f64,
    /// An upper bound of the number of pairs in the whole scene.
    pub pairs: f64,
}

impl<S: Space> SceneParts<S> {
    /// Radii of all balls, and of the bounding balls of the convex parts (m).
    pub(super) fn all_radii(&self) -> Vec<f64> {
        let pieces = self.shapes.pieces.iter().map(|p| p.bound);
        let balls = self.shapes.balls.iter().map(|b| b.radius);
        balls.chain(pieces).collect()
    }

    pub(super) fn pairs_of_bodies(&self, reach: f64) -> f64 {
        let of = |body: u32| self.bodies.position[body as usize];
        let balls = self.shapes.balls.iter().map(|b| of(b.body));
        let centres: Vec<S::Vector> = balls
            .chain(self.shapes.pieces.iter().map(|p| of(p.body)))
            .collect();
        grid::pairs_bound(&Balls {
            centres: &centres,
            radii: &self.all_radii(),
            reach,
            periodic: &self.shapes.periodic,
        })
    }

    pub(super) fn find_overcrowding(
        &self,
        reach: f64,
        most: &dyn Fn(usize) -> usize,
        table: &LawTable,
    ) -> Option<Overcrowding> {
        let balls = &self.shapes.balls;
        let owner = |at: u32| match balls.get(at as usize) {
            Some(ball) => (ball.body, ball.material),
            None => {
                let piece = &self.shapes.pieces[at as usize - balls.len()];
                (piece.body, piece.material)
            }
        };
        let mut centres: Vec<S::Vector> = balls.iter().map(|b| centre(b, &self.bodies)).collect();
        centres.extend(self.shapes.pieces.iter().map(|p| {
            let b = p.body as usize;
            self.bodies.position[b] + S::rotate(&self.bodies.rotation[b], &p.offset)
        }));
        let radii = self.all_radii();
        let still = self.bodies.fixed_bodies();
        let keep = |a: u32, b: u32| {
            let ((i, m), (j, n)) = (owner(a), owner(b));
            i != j && !(still[i as usize] && still[j as usize]) && table.get(m, n).is_some()
        };
        let all = Balls {
            centres: &centres,
            radii: &radii,
            reach,
            periodic: &self.shapes.periodic,
        };
        let dense = grid::dense_cell(&all, most(centres.len()), keep)?;
        Some(Overcrowding {
            body: owner(dense.ball).0,
            at: centres[dense.ball as usize].padded(),
            count: dense.count,
            size: dense.size,
            pairs: grid::pairs_bound(&all),
        })
    }
}
