//! Standard wheel and rail profiles as polylines.
//!
//! In the case x is the standard's lateral axis and z points up. A wheel's profile is upside down,
//! with its flange at negative x reaching below; the gauge side of a rail is at negative x. The
//! origin is the datum of the tread for a wheel, and the middle of the running surface for a rail,
//! or the highest point if the rail is inclined.

mod rail_60e1;
mod s1002;

use super::case::{Side, StandardName};

/// Section of a profile, and its resolution.
#[derive(Clone, Copy, Debug)]
pub struct Cut {
    /// Longest segment (m).
    pub spacing: f64,
    /// Start along the standard's lateral axis (m).
    pub from: Option<f64>,
    /// End along the standard's lateral axis (m).
    pub to: Option<f64>,
    /// n of an inclination 1:n.
    pub inclination: Option<f64>,
}

/// A profile as drawn in its standard: lateral positions and heights in mm, heights positive as in
/// the standard.
trait Drawing {
    /// Returns the lateral positions where its segments meet, and its ends, from left to right
    /// (mm).
    fn joints(&self) -> Vec<f64>;
    /// Height at a lateral position between the ends (mm).
    fn height(&self, y: f64) -> f64;
}

/// Returns the side of the profile on which the solid is.
pub fn side(name: StandardName) -> Side {
    match name {
        StandardName::S1002 => Side::Above,
        StandardName::Rail60E1 => Side::Below,
    }
}

/// Samples the points of a profile, from left to right (m), at most `spacing` apart and with one at
/// each joint of segments.
///
/// # Errors
/// The field at fault and the reason.
pub fn points(name: StandardName, cut: &Cut) -> Result<Vec<(f64, f64)>, (&'static str, String)> {
    let rail;
    let drawing: &dyn Drawing = match name {
        StandardName::S1002 => &s1002::S1002,
        StandardName::Rail60E1 => {
            rail = rail_60e1::Rail60E1::new();
            &rail
        }
    };
    if !(cut.spacing.is_finite() && cut.spacing >= 1e-7) {
        let message = format!(
            "the spacing of points is at least 1e-7 m, got {:e}",
            cut.spacing
        );
        return Err(("spacing", message));
    }
    let joints = drawing.joints();
    let (first, last) = (joints[0], joints[joints.len() - 1]);
    let range = format!(
        "the profile reaches from {:.6} to {:.6} m",
        1e-3 * first,
        1e-3 * last
    );
    let end = |field, given: Option<f64>, own: f64| match given.map(|x| 1e3 * x) {
        None => Ok(own),
        Some(y) if (first..=last).contains(&y) => Ok(y),
        Some(y) => Err((field, format!("{range}, not to {:e} m", 1e-3 * y))),
    };
    // The flank below a rail's head is omitted by default: on a rail inclined 1:20 it is vertical.
    let own = match name {
        StandardName::S1002 => (first, last),
        StandardName::Rail60E1 => (joints[1], joints[joints.len() - 2]),
    };
    let (from, to) = (end("from", cut.from, own.0)?, end("to", cut.to, own.1)?);
    if from >= to {
        return Err(("to", format!("`from` must be left of `to`; {range}")));
    }
    let mut stops = vec![from];
    stops.extend(joints.iter().copied().filter(|y| from < *y && *y < to));
    stops.push(to);
    let mut chain = vec![(from, drawing.height(from))];
    for w in stops.windows(2) {
        divide(drawing, w[0], w[1], 1e3 * cut.spacing, &mut chain);
    }
    let tilt = match (name, cut.inclination) {
        (_, None) => None,
        (StandardName::S1002, Some(_)) => {
            return Err((
                "inclination",
                "a wheel has no inclination; incline the rail".into(),
            ));
        }
        (StandardName::Rail60E1, Some(n)) if n.is_finite() && n >= 10.0 => Some(n),
        (StandardName::Rail60E1, Some(n)) => {
            return Err((
                "inclination",
                format!("the n of 1:n is at least 10, got {n}"),
            ));
        }
    };
    if let Some(n) = tilt {
        let rail = rail_60e1::Rail60E1::new();
        for point in &mut chain {
            *point = rail.inclined(*point, n);
        }
    }
    // Both standards measure heights into the gap between wheel and rail, downwards.
    Ok(chain
        .into_iter()
        .map(|(y, z)| (1e-3 * y, -1e-3 * z))
        .collect())
}

/// Appends points up to `b` (mm), equidistant along the profile.
fn divide(drawing: &dyn Drawing, a: f64, b: f64, spacing: f64, out: &mut Vec<(f64, f64)>) {
    const FINE: usize = 2000;
    let place = |k: usize| a + (b - a) * k as f64 / FINE as f64;
    let mut length = vec![0.0; FINE + 1];
    for k in 0..FINE {
        let rise = drawing.height(place(k + 1)) - drawing.height(place(k));
        length[k + 1] = length[k] + rise.hypot(place(k + 1) - place(k));
    }
    let whole = length[FINE];
    // Slightly more points than needed, since the length is measured along fine chords.
    let count = (1.001 * whole / spacing).ceil().max(1.0) as usize;
    for i in 1..count {
        let at = whole * i as f64 / count as f64;
        let k = length.partition_point(|l| *l <= at).clamp(1, FINE) - 1;
        let part = (at - length[k]) / (length[k + 1] - length[k]);
        let y = place(k) + part * (place(k + 1) - place(k));
        out.push((y, drawing.height(y)));
    }
    out.push((b, drawing.height(b)));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(spacing: f64) -> Cut {
        Cut {
            spacing,
            from: None,
            to: None,
            inclination: None,
        }
    }

    #[test]
    fn segments_are_no_longer_than_asked_and_go_right() {
        for name in [StandardName::S1002, StandardName::Rail60E1] {
            for (inclination, spacing) in [(None, 1e-3), (Some(40.0), 2e-4), (Some(20.0), 1e-3)] {
                let cut = Cut {
                    inclination,
                    ..cut(spacing)
                };
                let chain = match (name, inclination) {
                    (StandardName::S1002, Some(_)) => continue,
                    _ => points(name, &cut).unwrap(),
                };
                for w in chain.windows(2) {
                    let (x, z) = (w[1].0 - w[0].0, w[1].1 - w[0].1);
                    assert!(x > 0.0 && x.hypot(z) <= 1.01 * spacing, "{name:?} {w:?}");
                }
            }
        }
    }

    /// An inclined rail has its highest point at the origin.
    #[test]
    fn the_apex_of_an_inclined_rail_is_the_origin() {
        for n in [20.0, 30.0, 40.0] {
            let cut = Cut {
                inclination: Some(n),
                ..cut(1e-5)
            };
            let chain = points(StandardName::Rail60E1, &cut).unwrap();
            let top = chain
                .iter()
                .copied()
                .fold((0.0, -1.0), |a, b| if b.1 > a.1 { b } else { a });
            assert!(
                top.1 <= 1e-15 && top.1 > -1e-9 && top.0.abs() < 2e-5,
                "{n} {top:?}"
            );
        }
    }

    #[test]
    fn what_is_outside_the_profile_is_refused() {
        let outside = Cut {
            from: Some(-0.08),
            ..cut(1e-3)
        };
        let (field, message) = points(StandardName::S1002, &outside).unwrap_err();
        assert_eq!(field, "from");
        assert!(
            message.contains("from -0.070000 to 0.060000 m"),
            "{message}"
        );
        assert_eq!(
            points(StandardName::S1002, &cut(0.0)).unwrap_err().0,
            "spacing"
        );
    }
}
