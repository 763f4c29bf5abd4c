//! Blocks as meshes of deformable bodies: their cells, and their rounded sides.

use super::Builder;
use crate::case::{CoarsenSpec, LineSpec, MeshProfileSpec, RoundSpec};
use crate::source::InputError;
use fretwork_elastic::AnyMesh;
use fretwork_elastic::generate::{BlockGrid, Coarsening, GridError, even, graded};
use fretwork_elastic::mesh::MeshError;

/// Largest number of points of a block along an axis, and in total.
const MAX_LINE: f64 = 1e5;
const MAX_POINTS: usize = 1_000_000;

/// Options of a block in addition to its lines.
pub(super) struct BlockShape<'a> {
    pub(super) round: Option<&'a RoundSpec>,
    pub(super) profile: Option<&'a MeshProfileSpec>,
    pub(super) coarsen: Option<&'a CoarsenSpec>,
}

impl Builder<'_> {
    /// A block between lines along x, y and, in 3D, z.
    pub(super) fn block(
        &self,
        here: &str,
        lines: [Option<&LineSpec>; 3],
        shape: &BlockShape,
    ) -> Result<AnyMesh, InputError> {
        match (self.dimension(), lines[2]) {
            (2, Some(_)) => {
                let message = "a block in two dimensions has no z; leave it out";
                return Err(self.fail(format!("{here}.z"), message));
            }
            (3, None) => return Err(self.fail(here, "a block in three dimensions needs `z`")),
            _ => {}
        }
        let along = |(axis, line): (&str, Option<&LineSpec>)| {
            let found = coordinates(line?);
            Some(found.map_err(|(below, why)| self.fail(format!("{here}.{axis}.{below}"), why)))
        };
        let named = ["x", "y", "z"].into_iter().zip(lines);
        let lines: Result<Vec<Vec<f64>>, _> = named.filter_map(along).collect();
        let grid = self.grid(here, &lines?, shape.coarsen)?;
        match (shape.round, shape.profile) {
            (None, None) => self.mapped(here, &grid, &|p| p),
            (Some(round), None) => self.rounded(&format!("{here}.round"), &grid, round),
            (None, Some(profile)) => self.profiled(&format!("{here}.profile"), &grid, profile),
            (Some(_), Some(_)) => {
                let message = "a block is `round` or has a `profile`; leave one out";
                Err(self.fail(format!("{here}.profile"), message))
            }
        }
    }

    /// The cells of a block.
    fn grid(
        &self,
        here: &str,
        lines: &[Vec<f64>],
        coarsen: Option<&CoarsenSpec>,
    ) -> Result<BlockGrid, InputError> {
        let built = match coarsen {
            None => {
                let points: usize = lines.iter().map(Vec::len).product();
                if points > MAX_POINTS {
                    let message = format!(
                        "the block has {points} points, more than {MAX_POINTS}; make its elements larger, or let them grow away from `fine`"
                    );
                    return Err(self.fail(here, message));
                }
                BlockGrid::new(lines)
            }
            Some(CoarsenSpec { from, ratio }) => {
                let coarsening = Coarsening {
                    from,
                    ratio: *ratio,
                };
                BlockGrid::coarsened(lines, &coarsening, MAX_POINTS)
            }
        };
        built.map_err(|error| {
            let below = match error {
                GridError::Side(..) => ".coarsen.from",
                GridError::Ratio(_) => ".coarsen.ratio",
                GridError::Nothing { .. } | GridError::Single | GridError::OneRow { .. } => {
                    ".coarsen"
                }
                GridError::Lines | GridError::TooMany(_) => "",
            };
            self.fail(format!("{here}{below}"), error.to_string())
        })
    }

    /// Divides the cells of a grid whose points are moved.
    pub(super) fn mapped(
        &self,
        here: &str,
        grid: &BlockGrid,
        map: &dyn Fn([f64; 3]) -> [f64; 3],
    ) -> Result<AnyMesh, InputError> {
        AnyMesh::mapped(self.dimension(), grid, map).map_err(|error| {
            let bent = matches!(error, MeshError::Inverted(..) | MeshError::Flat(..));
            let more = match bent && grid.is_coarsened() {
                true => {
                    "; the side bends too much for cells that double there: let them double further away (`fine` or a smaller `growth` along the axis of their rows, \
                     or a smaller `ratio` in `coarsen`), or leave `coarsen` out"
                }
                false => "",
            };
            self.fail(here, format!("{error}{more}"))
        })
    }

    /// Rounds a side of a block; the displacement of points behind it decreases with depth.
    fn rounded(
        &self,
        here: &str,
        grid: &BlockGrid,
        round: &RoundSpec,
    ) -> Result<AnyMesh, InputError> {
        let up = self.dimension() - 1;
        let ends: Vec<[f64; 2]> = grid
            .lines()
            .iter()
            .map(|l| [l[0], l[l.len() - 1]])
            .collect();
        let [bottom, top] = ends[up];
        let into = match round.side.as_str() {
            "bottom" => 1.0,
            "top" => -1.0,
            other => {
                let message = format!("only `top` and `bottom` can be round, got `{other}`");
                return Err(self.fail(format!("{here}.side"), message));
            }
        };
        let curved = if round.cylinder { 1 } else { up };
        let middle: Vec<f64> = ends.iter().map(|[a, b]| 0.5 * (a + b)).collect();
        let squared: f64 = (0..curved).map(|k| (ends[k][1] - middle[k]).powi(2)).sum();
        let deepest = round.radius - (round.radius * round.radius - squared).sqrt();
        if !(round.radius > 0.0 && deepest < 0.9 * (top - bottom)) {
            let message = format!(
                "a radius of {} m does not fit: the side would recede by more than 0.9 of the height of the block, {} m",
                round.radius,
                top - bottom
            );
            return Err(self.fail(format!("{here}.radius"), message));
        }
        let map = |p: [f64; 3]| {
            let squared: f64 = (0..curved).map(|k| (p[k] - middle[k]).powi(2)).sum();
            let sagitta = squared / (round.radius + (round.radius * round.radius - squared).sqrt());
            let from = if into > 0.0 {
                top - p[up]
            } else {
                p[up] - bottom
            };
            let mut out = p;
            out[up] += into * sagitta * from / (top - bottom);
            out
        };
        self.mapped(here, grid, &map)
    }
}

/// Returns the points of a line, or the invalid field and the reason.
fn coordinates(line: &LineSpec) -> Result<Vec<f64>, (&'static str, String)> {
    let LineSpec {
        from,
        to,
        size,
        fine,
        growth,
    } = *line;
    if !(from.is_finite() && to.is_finite() && to > from) {
        return Err((
            "to",
            format!("`to` must be above `from`, got {from} and {to}"),
        ));
    }
    if !(size > 0.0 && size.is_finite()) {
        return Err((
            "size",
            format!("the size of an element must be positive, got {size}"),
        ));
    }
    let (low, high) = fine.unwrap_or((from, to));
    if !(from <= low && low < high && high <= to) {
        let message =
            format!("`fine` must lie within {from} and {to} and rise, got ({low}, {high})");
        return Err(("fine", message));
    }
    if !(1.0..=10.0).contains(&growth) {
        return Err((
            "growth",
            format!("a growth must be from 1 to 10, got {growth}"),
        ));
    }
    let grown = |length: f64| {
        if growth > 1.0 + 1e-9 {
            (1.0 + length * (growth - 1.0) / size).ln() / growth.ln()
        } else {
            length / size
        }
    };
    if (high - low) / size + grown(low - from) + grown(to - high) > MAX_LINE {
        return Err((
            "size",
            format!("elements of {size} m are more than {MAX_LINE} in a line"),
        ));
    }
    let cells = ((high - low) / size).round().max(1.0) as usize;
    let before = graded(low, from, size, growth);
    let after = graded(high, to, size, growth);
    let before = before.iter().skip(1).rev().copied();
    let before = before.filter(|_| low > from);
    let after = after.iter().skip(1).copied().filter(|_| to > high);
    Ok(before.chain(even(low, high, cells)).chain(after).collect())
}
