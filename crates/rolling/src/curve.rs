//! A curve through points, smooth enough for a contact.

/// A curve through points with ascending places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    places: Vec<f64>,
    values: Vec<f64>,
}

impl Curve {
    /// Returns the curve through points, two or more; `None` where two are at one place, or a
    /// number is not finite.
    pub fn through(mut points: Vec<[f64; 2]>) -> Option<Self> {
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let finite = points.iter().flatten().all(|x| x.is_finite());
        let apart = points.windows(2).all(|w| w[0][0] < w[1][0]);
        (finite && apart && points.len() > 1).then(|| Self {
            places: points.iter().map(|p| p[0]).collect(),
            values: points.iter().map(|p| p[1]).collect(),
        })
    }

    /// Returns the curve with all values larger by a number.
    pub fn raised(&self, by: f64) -> Self {
        Self {
            places: self.places.clone(),
            values: self.values.iter().map(|v| v + by).collect(),
        }
    }

    /// Places of the points, ascending.
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// Values at the points.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// First and last place.
    pub fn ends(&self) -> [f64; 2] {
        [self.places[0], self.places[self.places.len() - 1]]
    }

    /// Whether a place is between the ends.
    pub fn knows(&self, at: f64) -> bool {
        let [from, to] = self.ends();
        (from..=to).contains(&at)
    }

    /// Returns the value at a place, see [`Curve::value_and_slope`].
    pub fn at(&self, at: f64) -> f64 {
        self.value_and_slope(at).0
    }

    /// Returns value and slope at a place, without kinks, in which pressures would be infinite: on
    /// a cubic between two points with the slopes there of parabolas through three points, and
    /// straight on beyond the ends.
    pub fn value_and_slope(&self, at: f64) -> (f64, f64) {
        let (places, values) = (&self.places, &self.values);
        let last = places.len() - 1;
        if at <= places[0] || at >= places[last] {
            let end = if at <= places[0] { 0 } else { last };
            let slope = self.slope(end);
            return (values[end] + slope * (at - places[end]), slope);
        }
        let next = places.partition_point(|p| *p <= at).clamp(1, last);
        let width = places[next] - places[next - 1];
        let x = (at - places[next - 1]) / width;
        let [from, to] = [next - 1, next].map(|k| width * self.slope(k));
        let (a, b) = (values[next - 1], values[next]);
        let cubic = 2.0 * (a - b) + from + to;
        let square = 3.0 * (b - a) - 2.0 * from - to;
        let value = a + x * (from + x * (square + x * cubic));
        (value, (from + x * (2.0 * square + x * 3.0 * cubic)) / width)
    }

    /// Slope at a point.
    fn slope(&self, k: usize) -> f64 {
        let (places, last) = (&self.places, self.places.len() - 1);
        match k {
            _ if last == 1 => self.chord(0),
            0 => self.chord(0) - (places[1] - places[0]) * self.bend(1),
            k if k == last => self.chord(k - 1) + (places[k] - places[k - 1]) * self.bend(k - 1),
            k => self.chord(k - 1) + (places[k] - places[k - 1]) * self.bend(k),
        }
    }

    fn chord(&self, k: usize) -> f64 {
        (self.values[k + 1] - self.values[k]) / (self.places[k + 1] - self.places[k])
    }

    /// Half of the second derivative of the parabola through a point and its neighbours.
    fn bend(&self, k: usize) -> f64 {
        (self.chord(k) - self.chord(k - 1)) / (self.places[k + 1] - self.places[k - 1])
    }

    /// Returns the curvature of the parabola that is nearest to the curve within a range, by least
    /// squares at `SAMPLES` places.
    pub fn curvature(&self, [from, to]: [f64; 2]) -> f64 {
        // Legendre's polynomial of second degree is orthogonal to straight lines on even places up
        // to terms that its mean takes away.
        let place = |k: usize| 2.0 * k as f64 / (SAMPLES - 1) as f64 - 1.0;
        let mean = (0..SAMPLES).map(|k| place(k).powi(2)).sum::<f64>() / SAMPLES as f64;
        let (mut over, mut under) = (0.0, 0.0);
        for k in 0..SAMPLES {
            let weight = place(k).powi(2) - mean;
            over += weight * self.at(0.5 * (from + to) + 0.5 * (to - from) * place(k));
            under += weight * weight;
        }
        2.0 * over / under / (0.5 * (to - from)).powi(2)
    }
}

/// Number of places of a fit.
const SAMPLES: usize = 101;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_met_between_uneven_points() {
        let f = |x: f64| 3.0 * x * x - 2.0 * x + 1.0;
        let places = [-1.0, -0.4, 0.1, 0.9, 2.0];
        let curve = Curve::through(places.map(|x| [x, f(x)]).to_vec()).unwrap();
        for k in 0..=30 {
            let x = -1.0 + 0.1 * f64::from(k);
            let (value, slope) = curve.value_and_slope(x);
            assert!((value - f(x)).abs() < 1e-13 && (slope - 6.0 * x + 2.0).abs() < 1e-12);
        }
        assert!((curve.at(3.0) - f(2.0) - 10.0).abs() < 1e-12);
        assert!((curve.curvature([-0.5, 1.5]) - 6.0).abs() < 1e-12);
        assert!(curve.knows(2.0) && !curve.knows(2.1));
    }

    #[test]
    fn points_at_one_place_are_no_curve() {
        assert!(Curve::through(vec![[0.0, 1.0], [0.0, 2.0]]).is_none());
        assert!(Curve::through(vec![[0.0, f64::NAN], [1.0, 2.0]]).is_none());
    }
}
