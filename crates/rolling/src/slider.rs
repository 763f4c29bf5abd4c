//! A layer that is elastic up to its friction, fitted to the course of a passage through the patch.
//!
//! ```text
//! tau = (D - D_pl)/c   and   |tau| <= mu(x) p
//! ```
//!
//! D is the displacement of the surfaces relative to each other since the leading edge, D_pl its
//! part that is slip, c the compliance of the layer (m/Pa), and x the place between the leading
//! edge, -1, and the trailing edge, 1.

/// The course of a passage, at ascending places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StripHistory {
    /// Places between -1 and 1.
    pub place: Vec<f64>,
    /// Relative displacement of the surfaces (m).
    pub path: Vec<f64>,
    /// Pressure (Pa).
    pub pressure: Vec<f64>,
    /// Traction (Pa).
    pub traction: Vec<f64>,
}

/// A layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slider {
    /// Coefficients of friction in the middles of equal parts of the passage, linear between them.
    pub friction: Vec<f64>,
    /// Compliance (m/Pa).
    pub compliance: f64,
}

/// A layer that fits a course best.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fitted {
    /// The layer.
    pub slider: Slider,
    /// Lowest and highest compliance that fits nearly as well (m/Pa); the lowest is 0 where a rigid
    /// layer does.
    pub compliances: [f64; 2],
    /// Which parts slip, so that their friction follows from the course; that of others is the
    /// friction of the nearest one that does.
    pub slips: Vec<bool>,
    /// Root of the mean square of the difference of the tractions over the largest pressure.
    pub error: f64,
}

/// Number of compliances that are tried, of those between the neighbours of the best one, and ratio
/// of the largest to the lowest.
const TRIED: (usize, usize, f64) = (49, 21, 1e4);
/// Number of times that friction follows from the parts that slip.
const ROUNDS: usize = 12;
/// Error over the largest pressure that is none.
const EXACT: f64 = 1e-6;
/// Ratio of the ends of the interval of a compliance that is known.
const KNOWN: f64 = 10.0;
/// Increase of the squared error, times the number of parts, up to which a compliance fits: square
/// of the half-width of a 95 % interval over the standard deviation, for one parameter.
const FITS: f64 = 4.0;

impl Slider {
    /// Returns the coefficient at a place.
    pub fn coefficient(&self, place: f64) -> f64 {
        coefficient(&self.friction, place)
    }

    /// Returns the tractions along a course (Pa), and where the layer slips.
    pub fn tractions(&self, course: &StripHistory) -> (Vec<f64>, Vec<bool>) {
        let mut slipped = 0.0;
        let steps = course.place.iter().zip(&course.path).zip(&course.pressure);
        let step = |((place, path), pressure): ((&f64, &f64), &f64)| {
            let elastic = (path - slipped) / self.compliance;
            let bound = self.coefficient(*place) * pressure;
            let traction = elastic.clamp(-bound, bound);
            slipped = path - self.compliance * traction;
            (traction, elastic.abs() > bound)
        };
        steps.map(step).unzip()
    }
}

/// Returns the value at a place of coefficients in the middles of equal parts.
pub fn coefficient(friction: &[f64], place: f64) -> f64 {
    let last = friction.len() - 1;
    let at = 0.5 * (place + 1.0) * friction.len() as f64 - 0.5;
    let at = at.clamp(0.0, last as f64);
    let low = (at as usize).min(last.saturating_sub(1));
    let share = at - low as f64;
    friction[low] + share * (friction[(low + 1).min(last)] - friction[low])
}

impl Fitted {
    /// Fits a layer to a course: its compliance with one coefficient for all of the passage, since
    /// with many of them a rigid layer whose friction rises from 0 fits as well, and then `parts`
    /// coefficients with that compliance. `None` where the course does not slide, or has no rows.
    pub fn of(course: &StripHistory, parts: usize) -> Option<Self> {
        let most = |list: &[f64]| list.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let (pressure, traction) = (most(&course.pressure), most(&course.traction));
        let largest = most(&course.path) / traction;
        if !(largest.is_finite() && largest > 0.0 && pressure > 0.0) || parts == 0 {
            return None;
        }
        let (count, finer, ratio) = TRIED;
        let stiffest = largest / ratio;
        let power = |k: usize, count: usize| k as f64 / (count - 1) as f64;
        let with = |compliance: f64| (compliance, course.with_one(compliance, pressure));
        let coarse = (0..count).map(|k| with(stiffest * ratio.powf(power(k, count))));
        let mut tried: Vec<(f64, f64)> = coarse.collect();
        // The stiffest of those that fit alike.
        let best = |tried: &[(f64, f64)]| {
            let better = |best: usize, k: usize| if tried[k].1 < tried[best].1 { k } else { best };
            (0..tried.len()).fold(0, better)
        };
        let near = best(&tried);
        let ends = [near.saturating_sub(1), (near + 1).min(count - 1)].map(|k| tried[k].0);
        let between = (0..finer).map(|k| ends[0] * (ends[1] / ends[0]).powf(power(k, finer)));
        let between: Vec<(f64, f64)> = between.map(with).collect();
        tried.extend(between);
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (compliance, error) = tried[best(&tried)];
        let fits =
            |(_, other): &&(f64, f64)| other.powi(2) <= (1.0 + FITS / parts as f64) * error.powi(2);
        let low = tried.iter().find(fits).map_or(0.0, |t| t.0);
        let high = tried.iter().rev().find(fits).map_or(largest, |t| t.0);
        let compliances = [if low <= stiffest { 0.0 } else { low }, high];
        let known = compliances[0] > 0.0 && high <= KNOWN * low;
        let used = if known { compliance } else { stiffest };
        let mut fitted = Self::with_parts(course, parts, used, pressure);
        fitted.compliances = compliances;
        Some(fitted)
    }

    /// Returns whether the course determines the compliance: within a factor of ten.
    pub fn knows_compliance(&self) -> bool {
        let [low, high] = self.compliances;
        low > 0.0 && high <= KNOWN * low
    }

    fn with_parts(course: &StripHistory, parts: usize, compliance: f64, pressure: f64) -> Self {
        let mut slider = Slider {
            friction: vec![course.late_friction(); parts],
            compliance,
        };
        let part = |place: f64| {
            let at = 0.5 * (place + 1.0) * parts as f64;
            (at.max(0.0) as usize).min(parts - 1)
        };
        let mut slips = vec![false; parts];
        for _ in 0..ROUNDS {
            let (_, slipping) = slider.tractions(course);
            let mut counts = vec![[0usize; 2]; parts];
            for (place, slips) in course.place.iter().zip(&slipping) {
                let count = &mut counts[part(*place)];
                count[0] += 1;
                count[1] += usize::from(*slips);
            }
            let now: Vec<bool> = counts.iter().map(|[all, slip]| 2 * slip > *all).collect();
            let known = (0..parts).filter(|k| now[*k]).filter_map(|own| {
                let mu = course.friction(&|k| slipping[k] && part(course.place[k]) == own)?;
                Some((own, mu))
            });
            let known: Vec<(usize, f64)> = known.collect();
            if known.is_empty() {
                break;
            }
            let nearest = |own: usize| {
                let away = |(k, _): &&(usize, f64)| k.abs_diff(own);
                known.iter().min_by_key(away).map_or(0.0, |(_, mu)| *mu)
            };
            let friction: Vec<f64> = (0..parts).map(nearest).collect();
            let settled = friction == slider.friction && now == slips;
            (slider.friction, slips) = (friction, now);
            if settled {
                break;
            }
        }
        Self {
            error: course.error(&slider) / pressure,
            compliances: [0.0; 2],
            slips,
            slider,
        }
    }
}

impl StripHistory {
    /// Returns the friction of rows, their tractions over their pressures; `None` without pressure.
    fn friction(&self, of: &dyn Fn(usize) -> bool) -> Option<f64> {
        let rows = (0..self.place.len()).filter(|k| of(*k));
        let [q, p] = rows.fold([0.0; 2], |sum, k| {
            [sum[0] + self.traction[k], sum[1] + self.pressure[k]]
        });
        (p > 0.0).then(|| (q / p).max(0.0))
    }

    /// Returns the friction of the second half of the path.
    fn late_friction(&self) -> f64 {
        let end = self.path.last().copied().unwrap_or_default().abs();
        self.friction(&|k| self.path[k].abs() >= 0.5 * end)
            .unwrap_or(0.0)
    }

    /// Returns the root of the mean square of the difference from the tractions of a layer (Pa).
    fn error(&self, slider: &Slider) -> f64 {
        let (traction, _) = slider.tractions(self);
        let squares = traction.iter().zip(&self.traction);
        let squares: f64 = squares.map(|(a, b)| (a - b).powi(2)).sum();
        (squares / traction.len() as f64).sqrt()
    }

    /// Returns the error over the largest pressure with a compliance and one coefficient, that of
    /// the rows that slip.
    fn with_one(&self, compliance: f64, pressure: f64) -> f64 {
        let mut slider = Slider {
            friction: vec![self.late_friction()],
            compliance,
        };
        for _ in 0..ROUNDS {
            let (_, slipping) = slider.tractions(self);
            match self.friction(&|k| slipping[k]) {
                Some(mu) if mu != slider.friction[0] => slider.friction[0] = mu,
                _ => break,
            }
        }
        (self.error(&slider) / pressure).max(EXACT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A passage under Hertz' pressure with a slip that grows towards the trailing edge, and the
    /// tractions of a layer of known friction and compliance.
    fn passage(slip: f64, friction: &[f64], compliance: f64) -> StripHistory {
        let rows = 400;
        let mut course = StripHistory::default();
        for k in 0..rows {
            let place = -1.0 + 2.0 * (k as f64 + 0.5) / rows as f64;
            course.place.push(place);
            course.path.push(slip * (0.5 * (place + 1.0)).powi(2));
            course.pressure.push(1e9 * (1.0 - place * place).sqrt());
        }
        let slider = Slider {
            friction: friction.to_vec(),
            compliance,
        };
        course.traction = slider.tractions(&course).0;
        course
    }

    #[test]
    fn a_passage_of_small_slip_gives_friction_and_compliance() {
        let compliance = 1e-15;
        let course = passage(2e-6, &[0.4; 20], compliance);
        let fitted = Fitted::of(&course, 20).unwrap();
        assert!(fitted.knows_compliance(), "{:?}", fitted.compliances);
        let off = fitted.slider.compliance / compliance - 1.0;
        assert!(off.abs() < 0.05, "{off}");
        assert!(
            fitted
                .slider
                .friction
                .iter()
                .all(|mu| (mu / 0.4 - 1.0).abs() < 0.02)
        );
        assert!(!fitted.slips[0] && fitted.slips[19], "{:?}", fitted.slips);
    }

    #[test]
    fn a_passage_that_slips_throughout_gives_friction_alone() {
        let falling: Vec<f64> = (0..20).map(|k| 0.5 - 0.01 * f64::from(k)).collect();
        let course = passage(1e-3, &falling, 1e-16);
        let fitted = Fitted::of(&course, 20).unwrap();
        assert!(!fitted.knows_compliance() && fitted.compliances[0] == 0.0);
        assert!(fitted.slips.iter().all(|s| *s), "{:?}", fitted.slips);
        for (got, expected) in fitted.slider.friction.iter().zip(&falling) {
            assert!((got - expected).abs() < 0.002, "{got} {expected}");
        }
    }

    #[test]
    fn coefficients_are_linear_between_middles_of_parts() {
        let mu = [0.1, 0.3];
        for (place, expected) in [(-1.0, 0.1), (-0.5, 0.1), (0.0, 0.2), (0.5, 0.3), (1.0, 0.3)] {
            assert!((coefficient(&mu, place) - expected).abs() < 1e-12);
        }
        assert_eq!(coefficient(&[0.2], 0.3), 0.2);
        assert!(Fitted::of(&StripHistory::default(), 4).is_none());
    }
}
