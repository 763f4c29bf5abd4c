//! Strips of a patch along the rolling, each with the friction of a layer over the passage.

use crate::fields::Vector;
use crate::friction::{Bound, Cells, Friction};
use crate::slider::{StripHistory, coefficient};
use crate::tangential::Tractions;
use fretwork_elastic::half_space::CellGrid;

/// A strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Its place across the rolling (m).
    pub across: f64,
    /// Coefficients of friction in the middles of equal parts of the passage, from the leading edge
    /// on.
    pub friction: Vec<f64>,
}

/// Friction by strips, linear between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Strips {
    /// Strips by ascending place.
    pub strips: Vec<Strip>,
    /// Whether both sides of the patch are alike, so that places are distances from its middle.
    pub symmetric: bool,
}

/// Cells of a row that are under pressure, from the trailing edge to the leading edge.
fn touching(pressure: &[f64]) -> Option<std::ops::RangeInclusive<usize>> {
    let first = pressure.iter().position(|p| *p > 0.0)?;
    let last = pressure.iter().rposition(|p| *p > 0.0)?;
    Some(first..=last)
}

impl Strips {
    /// Returns the coefficient at a place across the rolling (m) and along a passage, from -1 at
    /// the leading edge to 1.
    pub fn coefficient(&self, across: f64, place: f64) -> f64 {
        let across = if self.symmetric { across.abs() } else { across };
        let of = |strip: &Strip| coefficient(&strip.friction, place);
        let next = self.strips.partition_point(|s| s.across <= across);
        match (
            next.checked_sub(1).map(|k| &self.strips[k]),
            self.strips.get(next),
        ) {
            (Some(low), Some(high)) => {
                let share = (across - low.across) / (high.across - low.across);
                of(low) + share * (of(high) - of(low))
            }
            (Some(one), None) | (None, Some(one)) => of(one),
            (None, None) => 0.0,
        }
    }

    /// Returns the coefficient of each cell of a row at a place across the rolling, 0 without
    /// pressure.
    pub fn row(&self, across: f64, pressure: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; pressure.len()];
        let Some(range) = touching(pressure) else {
            return out;
        };
        let (first, count) = (*range.start(), range.clone().count() as f64);
        for cell in range {
            let from_trailing = ((cell - first) as f64 + 0.5) / count;
            out[cell] = self.coefficient(across, 1.0 - 2.0 * from_trailing);
        }
        out
    }
}

impl Friction for Strips {
    fn bounds(&self, cells: Cells<'_>, _: &[Vector]) -> Vec<Bound> {
        let columns = cells.grid.cells[0];
        let rows = cells.pressure.chunks(columns).enumerate();
        let bounds = rows.flat_map(|(k, pressure)| {
            let across = cells.grid.middle(k * columns)[1];
            let row = self.row(across, pressure).into_iter().zip(pressure);
            row.map(|(mu, p)| Bound {
                traction: mu * p,
                slope: 0.0,
            })
        });
        bounds.collect()
    }
}

/// Returns the places across the rolling of strips of equal width over the cells under pressure
/// (m); of one half of them if both are alike.
pub fn places(grid: &CellGrid, pressure: &[f64], count: usize, symmetric: bool) -> Vec<f64> {
    let rows = pressure.chunks(grid.cells[0]).enumerate();
    let held = rows.filter(|(_, row)| touching(row).is_some());
    let held: Vec<usize> = held.map(|(k, _)| k).collect();
    let edge = |row: usize| grid.from[1] + row as f64 * grid.size[1];
    let [Some(first), Some(last)] = [held.first(), held.last()] else {
        return Vec::new();
    };
    let (mut from, to) = (edge(*first), edge(last + 1));
    if symmetric {
        from = 0.0;
    }
    (0..count)
        .map(|k| from + (to - from) * (k as f64 + 0.5) / count as f64)
        .collect()
}

/// Returns what material undergoes on its way through the row at a place across the rolling (m), at
/// the edges of its cells from the leading edge on: the pressure, the traction, and the
/// displacement of the surfaces, of which the layer of a compliance (m/Pa) has its elastic part.
/// Both are counted against the traction, so that they are positive where it opposes the motion
/// along `sign`. `None` where nothing touches.
pub fn course(
    grid: &CellGrid,
    pressure: &[f64],
    tractions: &Tractions,
    compliance: f64,
    across: f64,
    sign: f64,
) -> Option<StripHistory> {
    let columns = grid.cells[0];
    let row = ((across - grid.from[1]) / grid.size[1]).floor();
    let row = (row.max(0.0) as usize).min(grid.cells[1] - 1);
    let range = touching(&pressure[row * columns..(row + 1) * columns])?;
    let cells: Vec<usize> = range.rev().map(|c| row * columns + c).collect();
    let count = cells.len();
    let mut out = StripHistory::default();
    let mut slipped = 0.0;
    for edge in 0..=count {
        if let Some(before) = edge.checked_sub(1) {
            slipped += sign * tractions.slip[cells[before]][0];
        }
        let beside = [edge.checked_sub(1), (edge < count).then_some(edge)];
        let mean = |of: &dyn Fn(usize) -> f64| {
            beside
                .into_iter()
                .flatten()
                .map(|k| 0.5 * of(cells[k]))
                .sum::<f64>()
        };
        let traction = -sign * mean(&|c| tractions.traction[c][0]);
        out.place.push(-1.0 + 2.0 * edge as f64 / count as f64);
        out.pressure.push(mean(&|c| pressure[c]));
        out.traction.push(traction);
        out.path.push(slipped + compliance * traction);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::Coulomb;
    use crate::motion::Creepage;
    use crate::patch::Patch;
    use fretwork_elastic::Elasticity;

    fn grid() -> CellGrid {
        CellGrid {
            from: [-7e-3, -5.5e-3],
            size: [14e-3 / 24.0, 11e-3 / 24.0],
            cells: [24, 24],
        }
    }

    fn patch(distance: &dyn Fn([f64; 2]) -> f64, layer: f64) -> Patch<'_> {
        let steel = Elasticity {
            young: 210e9,
            poisson: 0.3,
            density: 7850.0,
        };
        Patch {
            bodies: [steel; 2],
            layer,
            distance,
            load: 75e3,
        }
    }

    /// Strips of one coefficient are Coulomb's law.
    #[test]
    fn equal_strips_are_coulombs_law() {
        let distance = |[x, y]: [f64; 2]| x * x / 0.92 + y * y / 0.6;
        let strip = |across| Strip {
            across,
            friction: vec![0.4; 8],
        };
        let strips = Strips {
            strips: vec![strip(1e-3), strip(3e-3)],
            symmetric: true,
        };
        let creepage = Creepage {
            along: 2e-3,
            ..Creepage::default()
        };
        let of = |law: &dyn Friction| {
            let rolls = patch(&distance, 0.0).rolls(grid(), &creepage, law, 1.0);
            rolls.unwrap().force[0]
        };
        let (got, expected) = (of(&strips), of(&Coulomb(0.4)));
        assert!((got / expected - 1.0).abs() < 1e-6, "{got} {expected}");
    }

    /// In full slip the surfaces part by the creepage times the length of the row, but for their
    /// elastic deformation, which is none at both edges; the layer adds c tau, none at the edges.
    #[test]
    fn the_course_of_a_row_has_the_path_of_its_creepage() {
        let distance = |[x, y]: [f64; 2]| x * x / 0.92 + y * y / 0.6;
        for compliance in [0.0, 1e-14] {
            let creepage = Creepage {
                along: -0.02,
                ..Creepage::default()
            };
            let rolls = patch(&distance, compliance);
            let rolls = rolls.rolls(grid(), &creepage, &Coulomb(0.3), 1.0).unwrap();
            let p = &rolls.pressure.pressure;
            let places = places(&rolls.grid, p, 3, true);
            let course = course(
                &rolls.grid,
                p,
                &rolls.tractions,
                compliance,
                places[0],
                -1.0,
            )
            .unwrap();
            let length = (course.place.len() - 1) as f64 * rolls.grid.size[0];
            let path = course.path.last().unwrap();
            assert!(
                (path / (0.02 * length) - 1.0).abs() < 0.02,
                "{path} {length}"
            );
            for (q, p) in course.traction.iter().zip(&course.pressure) {
                assert!((q - 0.3 * p).abs() < 1e-3 * 0.3e9, "{q} {p}");
            }
            assert!(places.windows(2).all(|w| w[0] < w[1]) && places[2] < 5.5e-3);
        }
    }
}
