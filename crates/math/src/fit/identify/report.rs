//! Results for each parameter, and for combinations of parameters.

use super::information::{Information, Model};
use crate::fit::bounds::Bounds;
use crate::statistics::distribution::{chi_squared_upper, student_quantile};
use crate::statistics::interval::{CONFIDENCE, Interval};
use serde::Serialize;

/// Component of a direction above which a parameter is named in it.
const NAMED: f64 = 0.2;

/// Component of an undetermined direction above which a parameter is undetermined.
const INVOLVED: f64 = 0.2;

/// An end of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The smallest value.
    Lowest,
    /// The largest value.
    Highest,
}

/// Estimate of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterEstimate {
    /// Name of the parameter.
    pub name: String,
    /// Estimated value.
    pub value: f64,
    /// Whether the data determine it; otherwise its intervals are the whole range.
    pub determined: bool,
    /// Interval of 95 %, within the range. One-sided for a parameter at an end.
    pub interval: Interval,
    /// Interval that, jointly with those of the other parameters, contains the true values in 95 %
    /// (Bonferroni).
    pub simultaneous: Interval,
    /// Whether the range, and not the data, limits the interval below.
    pub open_below: bool,
    /// Whether the range, and not the data, limits the interval above.
    pub open_above: bool,
    /// End of its range at which it lies, if the squares decrease beyond: the range should be
    /// extended, or the end is physical.
    pub at: Option<End>,
}

/// A combination of parameters in unit coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Parameters with their components, the largest first (to a tenth) and positive; the squares
    /// of all components sum to 1. Small components are left out.
    pub parts: Vec<(usize, f64)>,
    /// Singular value: the change of the data by a step over the whole range, in standard errors.
    pub singular_value: f64,
    /// Half-width of the interval of 95 % along the direction, with the range as 1; `None` if
    /// unlimited.
    pub half_width: Option<f64>,
    /// Whether the data determine the direction better than the range does.
    pub determined: bool,
}

impl Direction {
    /// Describes the direction, as "k up, mu down"; `names` are those of all parameters.
    pub fn words(&self, names: &[&str]) -> String {
        let part = |(i, component): &(usize, f64)| {
            let way = if *component > 0.0 { "up" } else { "down" };
            format!("{} {way}", names.get(*i).copied().unwrap_or("?"))
        };
        self.parts.iter().map(part).collect::<Vec<_>>().join(", ")
    }
}

/// Estimates of the parameters of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// One per parameter.
    pub estimates: Vec<ParameterEstimate>,
    /// Correlation of the estimates, one row per parameter; `None` where one is at an end or not
    /// determined.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Combinations of parameters, the best determined first.
    pub directions: Vec<Direction>,
    /// Weighted sum of squares at the estimate.
    pub chi_squared: f64,
    /// Ratio of `chi_squared` to its expected value: about 1 if the model describes the data.
    /// `None` without degrees of freedom.
    pub reduced: Option<f64>,
    /// Probability of such a ratio by chance; `None` without degrees of freedom, or if no standard
    /// deviations are given.
    pub p: Option<f64>,
    /// Whether the model describes the data: p is not below 5 %, or unknown.
    pub describes: bool,
    /// Factor of all standard errors: above 1 where the model does not describe the data.
    pub widened: f64,
    /// Whether the estimate is at the edge of the neighbourhood: the minimum is farther out, and
    /// runs around it are missing.
    pub at_edge: bool,
    /// Derivative of the estimates by the simulated values, in unit coordinates: one row per
    /// parameter, one column per value. To first order -H^-1 J^T W; zero for a parameter at an end,
    /// and along directions that are not determined.
    pub influence: Vec<Vec<f64>>,
}

pub(super) fn report(bounds: &Bounds, model: &Model<'_>) -> Identification {
    let n = bounds.len();
    let minimum = model.minimise();
    let free: Vec<usize> = (0..n).filter(|i| minimum.held[*i] == 0).collect();
    let values = model.measured.len();
    let degrees = values.saturating_sub(free.len());
    let share = model.noise_share(&minimum.point);
    let explained: f64 = model
        .noise()
        .iter()
        .zip(model.sigma)
        .zip(&model.weights)
        .map(|((noise, sigma), w)| w * (sigma * sigma + share * noise))
        .sum();
    let reduced =
        (degrees > 0).then(|| minimum.chi_squared / (explained * degrees as f64 / values as f64));
    let p = reduced
        .filter(|_| model.sigma_known)
        .and_then(|r| chi_squared_upper(r * degrees as f64, degrees as f64));
    let describes = p.is_none_or(|p| p >= 1.0 - CONFIDENCE);
    let scale = match reduced {
        Some(reduced) if !(model.sigma_known && describes) => reduced,
        _ => 1.0,
    };
    let of_errors = if model.sigma_known && describes {
        f64::INFINITY
    } else {
        degrees as f64
    };

    let all: Vec<usize> = (0..n).collect();
    let whole = model.information(&minimum.point, &all, scale);
    let part = model.information(&minimum.point, &free, scale);
    let estimates = (0..n)
        .map(|i| {
            let (information, place) = match free.iter().position(|f| *f == i) {
                Some(place) => (&part, place),
                None => (&whole, i),
            };
            let spread = Spread::of(
                information,
                place,
                of_errors,
                model.surrogate.degrees as f64,
            );
            estimate(bounds, i, minimum.point[i], minimum.held[i], spread)
        })
        .collect();
    let correlation = (0..n)
        .map(|i| (0..n).map(|j| correlation(&part, &free, i, j)).collect())
        .collect();
    Identification {
        estimates,
        correlation,
        directions: directions(&whole),
        chi_squared: minimum.chi_squared,
        reduced,
        p,
        describes,
        widened: scale.sqrt(),
        at_edge: minimum.at_edge,
        influence: (0..n).map(|i| influence(&part, &free, i, values)).collect(),
    }
}

fn influence(information: &Information, free: &[usize], i: usize, values: usize) -> Vec<f64> {
    match free.iter().position(|f| *f == i) {
        Some(row) => information.by_value.row(row).iter().copied().collect(),
        None => vec![0.0; values],
    }
}

/// Standard error of a parameter in unit coordinates, with its degrees of freedom.
#[derive(Clone, Copy)]
struct Spread {
    error: f64,
    degrees: f64,
}

impl Spread {
    /// Returns the spread; `None` where the parameter is part of an undetermined direction.
    fn of(information: &Information, i: usize, of_errors: f64, of_noise: f64) -> Option<Self> {
        if is_undetermined(information, i) {
            return None;
        }
        let (a, b) = (
            information.by_measurement[(i, i)],
            information.by_simulation[(i, i)],
        );
        let variance = a + b;
        let inverse = (a * a / of_errors + b * b / of_noise) / (variance * variance);
        Some(Self {
            error: variance.sqrt(),
            degrees: if inverse > 0.0 {
                (1.0 / inverse).max(1.0)
            } else {
                f64::INFINITY
            },
        })
    }
}

fn is_undetermined(information: &Information, i: usize) -> bool {
    let involved = |a: &super::information::Axis| !a.determined && a.vector[i].abs() > INVOLVED;
    information.axes.iter().any(involved)
}

fn estimate(
    bounds: &Bounds,
    i: usize,
    point: f64,
    held: i8,
    spread: Option<Spread>,
) -> ParameterEstimate {
    let parameter = &bounds.parameters()[i];
    let ends = |miss: f64| -> (f64, f64) {
        // The probability to be outside the interval is at one end, or divided between two.
        let one_sided = held != 0;
        let tail = if one_sided { miss } else { 0.5 * miss };
        let half_width = spread
            .and_then(|s| Some(student_quantile(1.0 - tail, s.degrees)? * s.error))
            .filter(|h| h.is_finite())
            .unwrap_or(f64::INFINITY);
        match held {
            -1 => (0.0, point + half_width),
            1 => (point - half_width, 1.0),
            _ => (point - half_width, point + half_width),
        }
    };
    let interval = |(low, high): (f64, f64)| Interval {
        low: parameter.scale.at(low),
        high: parameter.scale.at(high),
    };
    let miss = 1.0 - CONFIDENCE;
    let alone = ends(miss);
    ParameterEstimate {
        name: parameter.name.clone(),
        value: parameter.scale.at(point),
        determined: spread.is_some(),
        interval: interval(alone),
        simultaneous: interval(ends(miss / bounds.len() as f64)),
        open_below: alone.0 <= 0.0,
        open_above: alone.1 >= 1.0,
        at: match held {
            -1 => Some(End::Lowest),
            1 => Some(End::Highest),
            _ => None,
        },
    }
}

fn correlation(information: &Information, free: &[usize], i: usize, j: usize) -> Option<f64> {
    let place = |i: usize| free.iter().position(|f| *f == i);
    let (a, b) = (place(i)?, place(j)?);
    if is_undetermined(information, a) || is_undetermined(information, b) {
        return None;
    }
    let covariance = |a, b| information.by_measurement[(a, b)] + information.by_simulation[(a, b)];
    Some((covariance(a, b) / (covariance(a, a) * covariance(b, b)).sqrt()).clamp(-1.0, 1.0))
}

fn directions(information: &Information) -> Vec<Direction> {
    let direction = |axis: &super::information::Axis| {
        let mut parts: Vec<(usize, f64)> = axis.vector.iter().copied().enumerate().collect();
        // Of components of about equal size the first parameter's counts as the largest.
        parts.sort_by(|a, b| {
            let size = |c: f64| (c.abs() * 10.0).round();
            size(b.1).total_cmp(&size(a.1)).then(a.0.cmp(&b.0))
        });
        let sign = parts.first().map_or(1.0, |p| p.1.signum());
        parts.retain(|p| p.1.abs() >= NAMED);
        parts.iter_mut().for_each(|p| p.1 *= sign);
        Direction {
            parts,
            singular_value: axis.eigenvalue.max(0.0).sqrt(),
            half_width: Some(axis.half_width).filter(|h| h.is_finite()),
            determined: axis.determined,
        }
    };
    information.axes.iter().map(direction).collect()
}
