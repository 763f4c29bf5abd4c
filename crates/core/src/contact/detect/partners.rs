//! The pieces that each ball and piece may touch, and those adjacent to a pair.

use crate::contact::network::{Key, ShapeIndex};
use crate::geometry::convex::seam::AdjacentPiece;
use crate::geometry::shape::Shapes;
use crate::geometry::space::Space;
use std::sync::OnceLock;

/// Lists of pieces by ball or piece, built on first use: few steps of few scenes need them.
#[derive(Default)]
pub(super) struct Partners(OnceLock<Lists>);

/// The lists of all balls, then of all pieces, one after the other.
struct Lists {
    /// Index in `names` of the first entry of each list, then the length of `names`.
    starts: Vec<u32>,
    names: Vec<u32>,
}

impl Partners {
    /// Pieces that form a candidate pair with the ball or piece `name`, in the order of the pairs;
    /// `count` is the number of balls and pieces, `balls` that of balls.
    pub fn of(&self, pairs: &[(u32, u32)], count: usize, balls: usize, name: u32) -> &[u32] {
        let lists = self.0.get_or_init(|| Lists::new(pairs, count, balls));
        let at = ShapeIndex::of(name).place([balls, 0]);
        &lists.names[lists.starts[at] as usize..lists.starts[at + 1] as usize]
    }

    /// Returns the pieces that may continue either shape of a pair across a seam: those that form a
    /// candidate pair with the other shape. The antagonist is a piece. `cores` are the cores of all
    /// pieces in world axes, `centre` gives the centre of a piece (m).
    pub fn adjacent<'a, S: Space>(
        &self,
        pairs: &[(u32, u32)],
        shapes: &Shapes<S>,
        cores: &'a [S::Core],
        centre: impl Fn(usize) -> S::Vector,
        pair: [u32; 2],
    ) -> Vec<AdjacentPiece<'a, S>> {
        let balls = shapes.balls.len();
        let origin = centre((pair[1] & !Key::PIECE) as usize);
        let mut out = Vec::new();
        for (side, name) in pair.into_iter().enumerate() {
            let others = self.of(pairs, balls + shapes.pieces.len(), balls, name);
            for other in others.iter().filter(|other| **other != pair[1 - side]) {
                let k = (*other & !Key::PIECE) as usize;
                out.push(AdjacentPiece {
                    core: &cores[k],
                    at: shapes.periodic.shortest(centre(k) - origin),
                    rounding: shapes.pieces[k].rounding,
                    // Pieces near the candidate continue the antagonist, and the reverse.
                    of_candidate: side == 1,
                    name: *other,
                });
            }
        }
        out
    }
}

impl Lists {
    fn new(pairs: &[(u32, u32)], count: usize, balls: usize) -> Self {
        let with_pieces = || {
            let both = pairs.iter().filter(|p| p.1 & Key::SURFACE == 0);
            let ways = both.flat_map(|(a, b)| [(*a, *b), (*b, *a)]);
            ways.filter(|(_, piece)| piece & Key::PIECE != 0)
        };
        let place = |name: u32| ShapeIndex::of(name).place([balls, 0]);
        let mut starts = vec![0; count + 1];
        for (name, _) in with_pieces() {
            starts[place(name) + 1] += 1;
        }
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut names = vec![0; starts[count] as usize];
        let mut next = starts.clone();
        for (name, piece) in with_pieces() {
            let at = &mut next[place(name)];
            names[*at as usize] = piece;
            *at += 1;
        }
        Self { starts, names }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_listed_by_what_they_pair_with() {
        let piece = |k: u32| Key::PIECE | k;
        let pairs = [
            (0, 1),
            (0, piece(0)),
            (1, piece(2)),
            (1, Key::SURFACE),
            (piece(0), piece(1)),
            (piece(1), piece(2)),
            (piece(2), Key::SURFACE | 1),
        ];
        let partners = Partners::default();
        let of = |name: u32| partners.of(&pairs, 5, 2, name).to_vec();
        assert_eq!(of(0), [piece(0)]);
        assert_eq!(of(1), [piece(2)]);
        assert_eq!(of(piece(0)), [piece(1)]);
        assert_eq!(of(piece(1)), [piece(0), piece(2)]);
        assert_eq!(of(piece(2)), [piece(1)]);
    }
}
