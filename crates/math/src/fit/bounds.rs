//! The region of the parameters of a fit: a box, with order relations between parameters.
//!
//! A search uses unlimited unit coordinates. A coordinate outside [0, 1] is reflected at the ends
//! of its range until it is inside, and parameters in the wrong order are exchanged: the function
//! that the search sees is continuous and a reflected repetition of the region, so that a minimum
//! at a limit is also a minimum for the search, and no penalty with a weight is needed.

use crate::design::scale::Scale;
use thiserror::Error;

/// A parameter with its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name of the parameter.
    pub name: String,
    /// Range of the parameter, linear or logarithmic.
    pub scale: Scale,
}

/// Reason why the region is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum BoundsError {
    /// A range is wrong.
    #[error("parameter {name}: {reason}")]
    Range {
        /// The parameter.
        name: String,
        /// Reason.
        reason: String,
    },
    /// An order names a parameter that does not exist.
    #[error("an order names parameter number {0}, but there are only {1}")]
    Unknown(usize, usize),
    /// Orders are circular.
    #[error("the orders of {0} go round in a circle: leave one out")]
    Circle(String),
    /// No values satisfy an order.
    #[error(
        "{small} must not exceed {large}, but its smallest value lies above the largest of {large}"
    )]
    Empty {
        /// The parameter that must not be larger.
        small: String,
        /// The other parameter.
        large: String,
    },
}

/// The region of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    parameters: Vec<Parameter>,
    /// Pairs (a, b) with the value of a at most that of b, sorted so that a pair that ends in a
    /// comes before those that start there.
    orders: Vec<(usize, usize)>,
    /// Smallest and largest values that the orders permit.
    ranges: Vec<(f64, f64)>,
}

impl Bounds {
    /// Creates the region of `parameters` where for each pair (a, b) of `orders` (numbers of
    /// parameters) the value of a is at most that of b.
    ///
    /// # Errors
    ///
    /// A range has whole numbers or is empty, or orders name no parameter, are circular or cannot
    /// be satisfied.
    pub fn new(parameters: Vec<Parameter>, orders: &[(usize, usize)]) -> Result<Self, BoundsError> {
        let count = parameters.len();
        let mut ranges = Vec::with_capacity(count);
        for parameter in &parameters {
            let range_error = |reason: String| BoundsError::Range {
                name: parameter.name.clone(),
                reason,
            };
            parameter
                .scale
                .check()
                .map_err(|e| range_error(e.to_string()))?;
            match parameter.scale {
                Scale::Linear { from, to } | Scale::Logarithmic { from, to } => {
                    ranges.push((from, to));
                }
                Scale::Integer { .. } => {
                    return Err(range_error("a fit varies no whole numbers: make a study of its values, or fit the other parameters for each".into()));
                }
            }
        }
        if let Some((a, b)) = orders.iter().find(|(a, b)| *a.max(b) >= count) {
            return Err(BoundsError::Unknown(*a.max(b), count));
        }
        let mut bounds = Self {
            orders: bounds_order(&parameters, orders)?,
            parameters,
            ranges,
        };
        for &(a, b) in &bounds.orders {
            bounds.ranges[b].0 = bounds.ranges[b].0.max(bounds.ranges[a].0);
        }
        for &(a, b) in bounds.orders.iter().rev() {
            bounds.ranges[a].1 = bounds.ranges[a].1.min(bounds.ranges[b].1);
        }
        let name = |i: usize| bounds.parameters[i].name.clone();
        let empty = |i: &usize| bounds.ranges[*i].0 > bounds.ranges[*i].1;
        if let Some((a, b)) = bounds.orders.iter().find(|(a, b)| empty(a) || empty(b)) {
            return Err(BoundsError::Empty {
                small: name(*a),
                large: name(*b),
            });
        }
        Ok(bounds)
    }

    /// The parameters, in the order of the coordinates.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Number of parameters.
    pub fn len(&self) -> usize {
        self.parameters.len()
    }

    /// Returns whether there are no parameters.
    pub fn is_empty(&self) -> bool {
        self.parameters.is_empty()
    }

    /// Returns the values of the parameters at a point of unlimited unit coordinates; they are in
    /// the region.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        let scales = self.parameters.iter().map(|p| p.scale);
        let mut values: Vec<f64> = scales.zip(point).map(|(s, u)| s.at(mirrored(*u))).collect();
        self.repair(&mut values);
        values
    }

    /// Brings values into the region: those in the wrong order are exchanged until all are in
    /// order, then each is moved to the nearest value that its range and the order permit. Values
    /// in the region are not changed.
    pub fn repair(&self, values: &mut [f64]) {
        // A chain of ordered pairs is sorted after at most one round per pair.
        for _ in 0..self.orders.len() {
            for &(a, b) in &self.orders {
                if values[a] > values[b] {
                    values.swap(a, b);
                }
            }
        }
        for (value, (low, high)) in values.iter_mut().zip(&self.ranges) {
            *value = value.clamp(*low, *high);
        }
        // The ranges are such that a raised value remains within its own.
        for &(a, b) in &self.orders {
            values[b] = values[b].max(values[a]);
        }
    }

    /// Returns the unit coordinates, in [0, 1], of values of the parameters.
    pub fn point(&self, values: &[f64]) -> Vec<f64> {
        let scales = self.parameters.iter().map(|p| p.scale);
        scales.zip(values).map(|(s, v)| s.place(*v)).collect()
    }

    /// Returns the point of the region, in unit coordinates within [0, 1], that has the values of a
    /// point of unlimited coordinates.
    pub fn folded(&self, point: &[f64]) -> Vec<f64> {
        self.point(&self.values(point))
    }
}

/// Returns a coordinate reflected at 0 and 1 until it is inside.
fn mirrored(coordinate: f64) -> f64 {
    let turn = coordinate.rem_euclid(2.0);
    if turn > 1.0 { 2.0 - turn } else { turn }
}

/// Returns the orders sorted by how many others come before them; parameters without a smaller one
/// come first.
fn bounds_order(
    parameters: &[Parameter],
    orders: &[(usize, usize)],
) -> Result<Vec<(usize, usize)>, BoundsError> {
    let mut depth = vec![0; parameters.len()];
    for _ in 0..parameters.len() {
        for &(a, b) in orders {
            depth[b] = depth[b].max(depth[a] + 1);
        }
    }
    // Without a circle no chain is longer than the list.
    if let Some(&(a, b)) = orders
        .iter()
        .find(|(a, b)| depth[*b] <= depth[*a] || depth[*b] >= parameters.len())
    {
        let names = [a, b].map(|i| parameters[i].name.as_str());
        return Err(BoundsError::Circle(names.join(", ")));
    }
    let mut sorted = orders.to_vec();
    sorted.sort_by_key(|(a, b)| (depth[*a], depth[*b], *a, *b));
    sorted.dedup();
    Ok(sorted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn linear(name: &str, from: f64, to: f64) -> Parameter {
        Parameter {
            name: name.into(),
            scale: Scale::Linear { from, to },
        }
    }

    fn chain() -> Bounds {
        let last = Parameter {
            name: "c".into(),
            scale: Scale::Logarithmic {
                from: 0.05,
                to: 5.0,
            },
        };
        let parameters = vec![linear("a", 0.0, 1.0), linear("b", 0.1, 0.8), last];
        Bounds::new(parameters, &[(1, 2), (0, 1)]).unwrap()
    }

    /// Any point of unlimited coordinates gives values in their ranges and in order; values in the
    /// region stay.
    #[test]
    fn every_point_lies_in_the_region() {
        let bounds = chain();
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        for _ in 0..2000 {
            let point: Vec<f64> = (0..3).map(|_| rng.random_range(-4.0..4.0)).collect();
            let v = bounds.values(&point);
            assert!(v[0] <= v[1] && v[1] <= v[2], "{v:?}");
            assert!(
                v[0] >= 0.0 && (0.1..=0.8).contains(&v[1]) && v[2] <= 5.0,
                "{v:?}"
            );
            let mut again = v.clone();
            bounds.repair(&mut again);
            assert_eq!(again, v);
            for (u, w) in bounds.values(&bounds.folded(&point)).iter().zip(&v) {
                assert!((u - w).abs() < 1e-13 * w.abs().max(1e-2), "{u} {w}");
            }
        }
    }

    /// Without orders the reflections of a point have its values, and the mapping is continuous
    /// across the ends.
    #[test]
    fn mirrors_at_the_ends() {
        let bounds = Bounds::new(vec![linear("a", 2.0, 4.0)], &[]).unwrap();
        for image in [0.3, -0.3, 1.7, 2.3, -1.7] {
            assert!((bounds.values(&[image])[0] - 2.6).abs() < 1e-14);
        }
        let step = bounds.values(&[1.0 + 1e-9])[0] - bounds.values(&[1.0 - 1e-9])[0];
        assert!(step.abs() < 1e-14);
    }

    /// Two parameters of the same range in the wrong order change places.
    #[test]
    fn the_wrong_order_is_mirrored() {
        let both = vec![linear("a", 0.0, 1.0), linear("b", 0.0, 1.0)];
        let bounds = Bounds::new(both, &[(0, 1)]).unwrap();
        assert_eq!(bounds.values(&[0.75, 0.25]), [0.25, 0.75]);
        assert_eq!(bounds.values(&[0.25, 0.75]), [0.25, 0.75]);
    }

    #[test]
    fn errors_say_what_to_change() {
        let both = || vec![linear("a", 2.0, 3.0), linear("b", 0.0, 1.0)];
        let text = |orders: &[(usize, usize)]| Bounds::new(both(), orders).unwrap_err().to_string();
        assert!(
            text(&[(0, 1)]).contains("a must not exceed b"),
            "{}",
            text(&[(0, 1)])
        );
        assert!(text(&[(0, 1), (1, 0)]).contains("circle"));
        assert!(text(&[(0, 0)]).contains("circle"));
        assert!(text(&[(0, 2)]).contains("number 2"));
        assert!(Bounds::new(both(), &[(1, 0)]).is_ok());
        let whole = Parameter {
            name: "n".into(),
            scale: Scale::Integer { from: 1, to: 3 },
        };
        assert!(
            Bounds::new(vec![whole], &[])
                .unwrap_err()
                .to_string()
                .contains("whole numbers")
        );
    }
}
