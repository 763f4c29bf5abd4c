//! Points sorted along one axis, to find the points that may lie near another one without comparing
//! all pairs.

use crate::geometry::periodic::Periodic;
use crate::geometry::space::{Space, VectorLike};

/// Points sorted along the axis in which they extend the farthest.
pub(super) struct SortedCentres {
    axis: usize,
    period: Option<f64>,
    /// Coordinates in the period, in increasing order, with the indices of the points.
    along: Vec<(f64, u32)>,
}

impl SortedCentres {
    pub fn new<S: Space>(places: &[S::Vector], periodic: &Periodic) -> Self {
        let extent = |axis: usize| {
            let all = places.iter().map(|x| x[axis]);
            let ends = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
            ends[1] - ends[0]
        };
        let axis = (0..S::D).max_by(|a, b| extent(*a).total_cmp(&extent(*b)));
        let axis = axis.unwrap_or_default();
        let period = periodic.period[axis];
        let inside = |x: f64| period.map_or(x, |p| x - p * (x / p).floor());
        let along = places.iter().enumerate();
        let mut along: Vec<(f64, u32)> = along.map(|(k, x)| (inside(x[axis]), k as u32)).collect();
        along.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            axis,
            period,
            along,
        }
    }

    /// Returns all points that may lie within a distance (m) of a point, in the order of the list;
    /// some lie farther.
    pub fn near<V: VectorLike>(&self, at: &V, distance: f64, out: &mut Vec<u32>) {
        out.clear();
        // Rounding of coordinates must not lose a point.
        let distance = distance * (1.0 + 1e-9) + 1e-12 * at[self.axis].abs();
        let images = match self.period {
            Some(period) if 2.0 * distance >= period => {
                out.extend(self.along.iter().map(|(_, k)| *k));
                out.sort_unstable();
                return;
            }
            Some(period) => {
                let x = at[self.axis] - period * (at[self.axis] / period).floor();
                [Some(x), Some(x - period), Some(x + period)]
            }
            None => [Some(at[self.axis]), None, None],
        };
        for x in images.into_iter().flatten() {
            let from = self.along.partition_point(|(y, _)| *y < x - distance);
            let rest = self.along[from..].iter();
            out.extend(
                rest.take_while(|(y, _)| *y <= x + distance)
                    .map(|(_, k)| *k),
            );
        }
        out.sort_unstable();
        out.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    /// Narrow and wide searches, with and without a period, miss no point within the distance and
    /// keep the order of the list.
    #[test]
    fn none_within_the_distance_is_missing() {
        let places: Vec<_> = (0..200u32)
            .map(|k| {
                let t = f64::from(k);
                Vector2::new(3.0 * (1.7 * t).sin() + 0.5, 0.3 * (0.9 * t).cos())
            })
            .collect();
        for period in [None, Some(2.5)] {
            let periodic = Periodic {
                period: [period, None, None],
            };
            let sorted = SortedCentres::new::<Dim2>(&places, &periodic);
            let mut found = Vec::new();
            for (at, distance) in places.iter().flat_map(|x| [(x, 0.01), (x, 0.4), (x, 2.0)]) {
                sorted.near(at, distance, &mut found);
                assert!(found.is_sorted_by(|a, b| a < b));
                for (k, other) in places.iter().enumerate() {
                    let apart = periodic.shortest(*other - *at);
                    assert!(apart.norm() > distance || found.contains(&(k as u32)));
                }
            }
        }
    }
}
