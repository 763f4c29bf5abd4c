//! Where two bodies with profiles across the motion touch, and their distance along the normal
//! there.
//!
//! A profile is the height of a surface over a place across the motion; the first body is above the
//! second one, and neither yaws, so that they touch in the plane of the profiles. In the frame of
//! the contact s is along the common tangent, inclined by the contact angle delta, and n along the
//! normal. A body of revolution has, at a place of its profile n(s) and radius r there, the
//! curvature along the motion
//!
//! ```text
//! (cos delta - n'(s) sin delta)/r
//! ```
//!
//! since its surface rises by x²/(2 r) along the vertical, which is inclined in that frame.

use crate::curve::Curve;
use thiserror::Error;

/// Two profiles do not touch as bodies that roll over each other.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum TouchingError {
    /// They are beside each other.
    #[error("the profiles do not overlap")]
    Apart,
    /// They touch at an end of a profile.
    #[error("the profiles touch at the end of a profile")]
    AtEnd {
        /// The body whose profile ends there, 0 or 1.
        body: usize,
        /// The place (m).
        at: f64,
    },
}

/// Two bodies by their profiles.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Heights of both surfaces over the place across the motion (m).
    pub profiles: [Curve; 2],
    /// Radii along the motion, of bodies that are no plane there.
    pub radii: [Option<Radius>; 2],
}

/// Radius of a body of revolution (m) at a height (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radius {
    /// The radius.
    pub radius: f64,
    /// The height at which it is.
    pub height: f64,
}

/// A contact in its frame.
#[derive(Clone, Debug)]
pub struct Touching {
    /// Place and height of its middle (m).
    pub middle: [f64; 2],
    /// Contact angle: inclination of the common tangent (rad).
    pub inclination: f64,
    /// Radii of the bodies at the middle (m).
    pub radii: [Option<f64>; 2],
    /// Both profiles, n over s (m).
    pub profiles: [Curve; 2],
    /// Distance of the bodies over s (m), 0 where it is least.
    pub distance: Curve,
    /// Relative curvature along the motion over s (1/m).
    pub along: Curve,
}

/// Places of a distance over those of the profiles, and their largest number.
const FINER: f64 = 2.0;
const MOST: f64 = 2e4;
/// Height of a crest between two places of contact over the approach, at least.
const CREST: f64 = 0.05;

impl Pair {
    /// Puts the first body down on the second one; returns the place at which they touch, where
    /// their vertical distance was least, and how far it went down (m).
    ///
    /// # Errors
    /// The profiles do not overlap, or touch at an end of one.
    pub fn put_down(&mut self) -> Result<[f64; 2], TouchingError> {
        let [first, second] = &self.profiles;
        let ends = [first.ends(), second.ends()];
        let from = ends[0][0].max(ends[1][0]);
        let to = ends[0][1].min(ends[1][1]);
        if from >= to {
            return Err(TouchingError::Apart);
        }
        let gap = |at: f64| first.at(at) - second.at(at);
        let rows = self.profiles.iter().flat_map(Curve::places);
        let mut places: Vec<f64> = rows.copied().filter(|p| *p > from && *p < to).collect();
        places.extend([from, to]);
        places.sort_by(f64::total_cmp);
        places.dedup();
        let least = (0..places.len()).min_by(|a, b| gap(places[*a]).total_cmp(&gap(places[*b])));
        let least = least.unwrap_or(0);
        if least == 0 || least + 1 == places.len() {
            let side = usize::from(least != 0);
            let body = usize::from(ends[1][side] == places[least]);
            let at = places[least];
            return Err(TouchingError::AtEnd { body, at });
        }
        // The slope of the gap is continuous, and changes its sign between the neighbours.
        let (mut from, mut to) = (places[least - 1], places[least + 1]);
        for _ in 0..60 {
            let middle = 0.5 * (from + to);
            match first.value_and_slope(middle).1 < second.value_and_slope(middle).1 {
                true => from = middle,
                false => to = middle,
            }
        }
        let at = 0.5 * (from + to);
        let down = gap(at);
        self.profiles[0] = self.profiles[0].raised(-down);
        if let Some(radius) = &mut self.radii[0] {
            radius.height -= down;
        }
        Ok([at, down])
    }

    /// Returns the contact about a place (m), with the mean of the inclinations there.
    ///
    /// # Errors
    /// The profiles do not overlap along its tangent.
    pub fn about(&self, at: f64) -> Result<Touching, TouchingError> {
        let [above, below] = self.profiles.each_ref().map(|p| p.value_and_slope(at));
        let inclination = (0.5 * (above.1 + below.1)).atan();
        let middle = [at, 0.5 * (above.0 + below.0)];
        let turned = |profile: &Curve| turned(profile, middle, inclination);
        let [Some(first), Some(second)] = self.profiles.each_ref().map(turned) else {
            return Err(TouchingError::Apart);
        };
        let (from, to) = (
            first.ends()[0].max(second.ends()[0]),
            first.ends()[1].min(second.ends()[1]),
        );
        if from >= to {
            return Err(TouchingError::Apart);
        }
        let spacing = typical_spacing(&first).min(typical_spacing(&second));
        let count = (FINER * (to - from) / spacing).ceil().clamp(2.0, MOST) as usize;
        let places = (0..=count).map(|k| from + (to - from) * k as f64 / count as f64);
        let places: Vec<f64> = places.collect();
        let distance = |s: &f64| first.at(*s) - second.at(*s);
        let least = places.iter().map(distance).fold(f64::INFINITY, f64::min);
        let (sin, cos) = inclination.sin_cos();
        let signs = [-1.0, 1.0];
        let along = |s: f64| -> f64 {
            let bodies = [&first, &second].into_iter().zip(&self.radii).zip(signs);
            let of = |((profile, radius), sign): ((&Curve, &Option<Radius>), f64)| {
                let radius = radius.as_ref()?;
                let (n, slope) = profile.value_and_slope(s);
                let height = middle[1] + s * sin + n * cos;
                Some((cos - sin * slope) / (radius.radius + sign * (height - radius.height)))
            };
            bodies.filter_map(of).sum()
        };
        let at_middle = |k: usize| {
            let radius = self.radii[k].as_ref()?;
            Some(radius.radius + signs[k] * (middle[1] - radius.height))
        };
        let curve =
            |of: &dyn Fn(f64) -> f64| Curve::through(places.iter().map(|s| [*s, of(*s)]).collect());
        let distance = curve(&|s| distance(&s) - least);
        let (Some(distance), Some(along)) = (distance, curve(&along)) else {
            return Err(TouchingError::Apart);
        };
        Ok(Touching {
            middle,
            inclination,
            radii: [at_middle(0), at_middle(1)],
            profiles: [first, second],
            distance,
            along,
        })
    }
}

impl Touching {
    /// Spin creepage of the contact angle (1/m), of the first body relative to the second one: the
    /// surfaces of both pass with velocities that differ across the patch by those of their radii.
    pub fn spin(&self) -> f64 {
        let over: f64 = self.radii.iter().flatten().map(|r| 1.0 / r).sum();
        -self.inclination.sin() * over
    }

    /// Returns the place across the motion of a place in the frame (m).
    pub fn place(&self, s: f64) -> f64 {
        let n = 0.5 * (self.profiles[0].at(s) + self.profiles[1].at(s));
        self.middle[0] + s * self.inclination.cos() - n * self.inclination.sin()
    }

    /// Returns the inclinations of the contact (rad), from the least to the largest, within a range
    /// of its frame.
    pub fn inclinations(&self, within: [f64; 2]) -> [f64; 2] {
        let places = self.distance.places().iter();
        let places = places.filter(|s| (within[0]..=within[1]).contains(*s));
        let of = |s: &f64| {
            let slopes = self.profiles.each_ref().map(|p| p.value_and_slope(*s).1);
            self.inclination + (0.5 * (slopes[0] + slopes[1])).atan()
        };
        let start = [self.inclination; 2];
        places
            .map(of)
            .fold(start, |[low, high], i| [low.min(i), high.max(i)])
    }

    /// Returns places of the frame outside of a range at which the distance is least all around and
    /// below an approach of the bodies (m), with the distance (m): the bodies may touch there too.
    /// Between them and the range the bodies are farther apart by a share of the approach, which
    /// scatter of the profiles is not.
    pub fn others(&self, outside: [f64; 2], approach: f64) -> Vec<[f64; 2]> {
        let (places, values) = (self.distance.places(), self.distance.values());
        let below = places.partition_point(|s| *s < outside[0]);
        let above = places.partition_point(|s| *s <= outside[1]);
        let sides: [Vec<usize>; 2] = [(0..below).rev().collect(), (above..places.len()).collect()];
        let mut found = Vec::new();
        for side in sides {
            let (mut crest, mut least) = (0.0_f64, None::<usize>);
            for k in side {
                match least {
                    Some(low) if values[k] < values[low] => least = Some(k),
                    Some(low) if values[k] > values[low] + CREST * approach => {
                        found.push([places[low], values[low]]);
                        (crest, least) = (values[k], None);
                    }
                    Some(_) => {}
                    None if values[k] > crest => crest = values[k],
                    None if values[k] < approach.min(crest - CREST * approach) => {
                        least = Some(k);
                    }
                    None => {}
                }
            }
        }
        found
    }
}

/// Returns a profile in the frame of a contact, as far as it is a function there.
fn turned(profile: &Curve, middle: [f64; 2], inclination: f64) -> Option<Curve> {
    let (sin, cos) = inclination.sin_cos();
    let all = profile.places().iter().zip(profile.values());
    let all = all.map(|(y, z)| [y - middle[0], z - middle[1]]);
    let all = all.map(|[y, z]| [y * cos + z * sin, z * cos - y * sin]);
    let all: Vec<[f64; 2]> = all.collect();
    let near = profile.places().partition_point(|y| *y < middle[0]);
    let near = near.min(all.len() - 1);
    let rises = |k: &usize| all[*k][0] > all[k - 1][0];
    let last = (near + 1..all.len()).find(|k| !rises(k));
    let first = (1..=near).rev().find(|k| !rises(k));
    Curve::through(all[first.unwrap_or(0)..last.unwrap_or(all.len())].to_vec())
}

/// Median distance between the points of a curve (m).
fn typical_spacing(curve: &Curve) -> f64 {
    let mut apart: Vec<f64> = curve.places().windows(2).map(|w| w[1] - w[0]).collect();
    apart.sort_by(f64::total_cmp);
    apart[apart.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(from: f64, to: f64, of: impl Fn(f64) -> f64) -> Curve {
        let place = |k: u32| from + (to - from) * f64::from(k) / 400.0;
        let points = (0..=400).map(|k| [place(k), of(place(k))]);
        Curve::through(points.collect()).unwrap()
    }

    /// A cone of 1:20 on a rail head of 300 mm touches where the head is as steep; the distance
    /// along the normal is that of a circle from its tangent, and the curvature along the motion
    /// that of a cone, cos delta over its radius.
    #[test]
    fn a_cone_on_a_round_head() {
        let (head, slope, radius) = (0.3_f64, 0.05_f64, 0.46);
        let mut pair = Pair {
            profiles: [
                curve(-0.03, 0.05, |y| slope * y),
                curve(-0.035, 0.035, |y| (head * head - y * y).sqrt() - head),
            ],
            radii: [
                Some(Radius {
                    radius,
                    height: 0.0,
                }),
                None,
            ],
        };
        let delta = slope.atan();
        let [at, _] = pair.put_down().unwrap();
        assert!((at + head * delta.sin()).abs() < 1e-7, "{at}");
        let found = pair.about(at).unwrap();
        assert!((found.inclination - delta).abs() < 1e-8);
        let here = radius - slope * at;
        for s in [-0.012, -0.003, 0.004, 0.01] {
            let sagitta = head - (head * head - s * s).sqrt();
            assert!((found.distance.at(s) - sagitta).abs() < 1e-9, "{s}");
            let along = delta.cos() / (here - s * delta.sin());
            assert!((found.along.at(s) / along - 1.0).abs() < 1e-5);
        }
        let spin = -delta.sin() / here;
        assert!((found.spin() / spin - 1.0).abs() < 1e-12);
        assert!((found.distance.curvature([-0.002, 0.002]) * head - 1.0).abs() < 1e-4);
        let place = found.place(0.004);
        assert!((place - at - 0.004 * delta.cos()).abs() < 1e-5);
    }

    /// Surfaces of a wheel that rolls have the velocities of rigid rotation: their difference from
    /// those of the rail, over the speed, is the spin times the place.
    #[test]
    fn spin_is_that_of_rigid_rotation() {
        let (radius, delta, speed) = (0.46, 0.3_f64, 20.0);
        // About an axle along y, the bottom of the wheel moves backwards.
        let turning = speed / radius;
        let velocity = |s: f64| -turning * (radius - s * delta.sin()) + speed;
        let found = Touching {
            middle: [0.0; 2],
            inclination: delta,
            radii: [Some(radius), None],
            profiles: [curve(-1.0, 1.0, |_| 0.0), curve(-1.0, 1.0, |_| 0.0)],
            distance: curve(-1.0, 1.0, |s| s * s),
            along: curve(-1.0, 1.0, |_| 1.0),
        };
        // Slip along x is xi - phi y.
        let slip = -found.spin() * 1e-3;
        assert!((velocity(1e-3) / speed / slip - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_second_place_within_the_approach_is_found() {
        let mut pair = Pair {
            profiles: [
                curve(-0.03, 0.03, |y| {
                    (10.0 * (y + 0.01).powi(2)).min(2e-5 + 10.0 * (y - 0.015).powi(2))
                }),
                curve(-0.02, 0.02, |_| 0.0),
            ],
            radii: [None; 2],
        };
        let [at, _] = pair.put_down().unwrap();
        assert!((at + 0.01).abs() < 1e-6);
        let found = pair.about(at).unwrap();
        assert!(found.others([-0.002, 0.002], 1e-5).is_empty());
        let others = found.others([-0.002, 0.002], 5e-5);
        assert_eq!(others.len(), 1);
        assert!((others[0][0] - 0.025).abs() < 2e-4 && (others[0][1] - 2e-5).abs() < 1e-6);
    }

    #[test]
    fn profiles_that_do_not_touch_are_refused() {
        let flat = |from: f64, to: f64| curve(from, to, |_| 0.0);
        let of = |first: Curve, second: Curve| Pair {
            profiles: [first, second],
            radii: [None; 2],
        };
        let apart = of(flat(0.0, 1.0), flat(2.0, 3.0)).put_down();
        assert_eq!(apart, Err(TouchingError::Apart));
        let at_end = of(curve(-1.0, 0.5, |y| -y), flat(-2.0, 2.0)).put_down();
        assert_eq!(at_end, Err(TouchingError::AtEnd { body: 0, at: 0.5 }));
    }
}
