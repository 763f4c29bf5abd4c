//! Flow regime of a third body, from the velocity profile across it.
//!
//! w(y) is the velocity of the grains relative to the first body over that of the second, 0 at the
//! first wall and 1 at the second without slip; y is normalised by the thickness. The terms are
//! those of Mollon, Tribol. Lett. 67 (2019) 120; the criteria are our own:
//!
//! - plug with wall slip: the interior, from y = 0.1 to 0.9, takes less than 20 % of the sliding;
//! - Couette: it takes more than 50 %, and a straight line through w there has R^2 above 0.9;
//! - agglomerated: neither, and the mass-weighted mean cluster has more than 10 grains;
//! - mixed: none of these, such as localised shear, or wall slip together with flow.

/// A flow regime; its discriminant is its code in the statistics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FlowRegime {
    /// There is no sliding, or there are too few bins.
    None = 0,
    /// Sheared throughout the thickness.
    Couette = 1,
    /// Agglomerates roll and shear.
    Agglomerated = 2,
    /// Moves as a rigid layer, with slip at the walls.
    Plug = 3,
    /// None of the others.
    Mixed = 4,
}

/// Interior shear over the sliding: upper limit of a plug, and lower limit of a Couette flow.
const SHEARED: [f64; 2] = [0.2, 0.5];
/// Smallest coefficient of determination of a linear profile.
const STRAIGHT: f64 = 0.9;
/// Mean cluster size up to which there are no agglomerates.
const LOOSE: f64 = 10.0;
/// Range of the interior, over the thickness.
const INTERIOR: [f64; 2] = [0.1, 0.9];

/// Characteristics of a profile of w.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FlowProfile {
    /// w(0.9) - w(0.1).
    pub interior: f64,
    /// R^2 of the least-squares line through the interior points; 0 if w is constant.
    pub straight: f64,
    /// w of the bin at the first body: the wall slip there over the sliding.
    pub slip_first: f64,
    /// 1 - w of the bin at the second body: the wall slip there.
    pub slip_second: f64,
}

/// Evaluates a profile of (y, w), ordered by y; needs three points in the interior.
pub(super) fn flow(points: &[(f64, f64)]) -> Option<FlowProfile> {
    let inner: Vec<(f64, f64)> = points
        .iter()
        .copied()
        .filter(|p| (INTERIOR[0]..=INTERIOR[1]).contains(&p.0))
        .collect();
    let (first, last) = (points.first()?, points.last()?);
    if inner.len() < 3 || !points.iter().all(|p| p.1.is_finite()) {
        return None;
    }
    Some(FlowProfile {
        interior: at(points, INTERIOR[1]) - at(points, INTERIOR[0]),
        straight: determination(&inner),
        slip_first: first.1,
        slip_second: 1.0 - last.1,
    })
}

/// Interpolates linearly, constant beyond the ends.
fn at(points: &[(f64, f64)], y: f64) -> f64 {
    let k = points.partition_point(|p| p.0 < y);
    match (k.checked_sub(1).map(|i| points[i]), points.get(k)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (y - a.0) / (b.0 - a.0),
        (Some(a), None) => a.1,
        (None, Some(b)) => b.1,
        (None, None) => f64::NAN,
    }
}

/// Returns R^2 of the least-squares line through points.
fn determination(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let xx = mean(&|p| (p.0 - x) * (p.0 - x));
    let xy = mean(&|p| (p.0 - x) * (p.1 - y));
    let yy = mean(&|p| (p.1 - y) * (p.1 - y));
    if xx > 0.0 && yy > 0.0 {
        xy * xy / (xx * yy)
    } else {
        0.0
    }
}

impl FlowRegime {
    /// The regime of a flow with a mass-weighted mean cluster size.
    pub fn of(flow: Option<&FlowProfile>, cluster: f64) -> Self {
        let Some(flow) = flow else { return Self::None };
        if flow.interior < SHEARED[0] {
            Self::Plug
        } else if flow.interior > SHEARED[1] && flow.straight > STRAIGHT {
            Self::Couette
        } else if cluster > LOOSE {
            Self::Agglomerated
        } else {
            Self::Mixed
        }
    }

    /// Returns name and criteria as a sentence.
    pub fn describe(self, flow: Option<&FlowProfile>, cluster: f64) -> String {
        let Some(f) = flow else {
            return "flow of the layer not known: the last state does not slide, or the layer has fewer than three bins"
                .to_owned();
        };
        let seen = format!(
            "the interior shears by {:.0} % of the sliding with R^2 {:.2}, slip {:.0} % and {:.0} % at the walls, \
             mean cluster {cluster:.1} grains",
            100.0 * f.interior,
            f.straight,
            100.0 * f.slip_first,
            100.0 * f.slip_second
        );
        let why = match self {
            Self::None => "none",
            Self::Couette => "Couette (interior above 50 %, R^2 above 0.9)",
            Self::Agglomerated => {
                "agglomerated (neither plug nor Couette, mean cluster above 10 grains)"
            }
            Self::Plug => "plug with wall slip (interior below 20 %)",
            Self::Mixed => "mixed (neither plug nor Couette, mean cluster of 10 grains or less)",
        };
        format!("{why}: {seen}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(w: impl Fn(f64) -> f64) -> FlowProfile {
        let y = (0..20).map(|k| (f64::from(k) + 0.5) / 20.0);
        let points: Vec<(f64, f64)> = y.map(|y| (y, w(y))).collect();
        flow(&points).unwrap()
    }

    #[test]
    fn regimes_are_told_apart() {
        let linear = profile(|y| y);
        assert!((linear.interior - 0.8).abs() < 1e-12 && (linear.straight - 1.0).abs() < 1e-12);
        assert!((linear.slip_first - 0.025).abs() < 1e-12);
        assert_eq!(FlowRegime::of(Some(&linear), 500.0), FlowRegime::Couette);
        // A plug moves with the first wall at 30 % of the sliding: slip 0.3 and 0.7.
        let plug = profile(|_| 0.3);
        assert_eq!(FlowRegime::of(Some(&plug), 500.0), FlowRegime::Plug);
        assert!((plug.slip_first - 0.3).abs() < 1e-12 && (plug.slip_second - 0.7).abs() < 1e-12);
        // All shear is in a band in the middle: R^2 of a step is 3/4.
        let step = profile(|y| if y < 0.5 { 0.0 } else { 1.0 });
        assert!((step.straight - 0.75).abs() < 0.01, "{}", step.straight);
        assert_eq!(FlowRegime::of(Some(&step), 1.0), FlowRegime::Mixed);
        assert_eq!(FlowRegime::of(Some(&step), 30.0), FlowRegime::Agglomerated);
        // Half of the sliding is at a wall, the other half distributed uniformly: 40 % in the
        // interior.
        assert_eq!(
            FlowRegime::of(Some(&profile(|y| 0.5 * y)), 1.0),
            FlowRegime::Mixed
        );
        assert_eq!(FlowRegime::of(None, 1.0), FlowRegime::None);
        assert!(flow(&[(0.25, 0.0), (0.75, 1.0)]).is_none());
    }
}
