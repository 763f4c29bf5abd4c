//! Tables of a law over slip, slip velocity, pressure and temperature.

use core::fmt;

/// Number of axes: slip, slip velocity, pressure, temperature.
pub const AXES: usize = 4;

/// The table of a law: values with their intervals over slip (m), slip velocity (m/s), pressure
/// (Pa) and temperature (K), on a grid of points. See [`fretwork_abi::FwBatch::table`].
#[derive(Clone, Copy, Default)]
pub struct Table(&'static [f64]);

/// A value of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// The value.
    pub value: f64,
    /// Lower end of its interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Whether a coordinate is outside of the table: the value is then that at its border.
    pub outside: bool,
}

impl Reading {
    /// Returns the value at a place in its interval: -1 is the lower end, 0 the value, 1 the upper
    /// end.
    pub fn within(&self, place: f64) -> f64 {
        let end = if place < 0.0 { self.low } else { self.high };
        self.value + place.abs() * (end - self.value)
    }
}

impl fmt::Debug for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Table({} numbers)", self.0.len())
    }
}

impl Table {
    /// Takes the numbers of a table, in the order of [`fretwork_abi::FwBatch::table`]. Numbers that
    /// are not those of a table read as no table.
    pub fn new(numbers: &'static [f64]) -> Self {
        let counts = numbers.get(..AXES).unwrap_or_default().iter();
        let counts = counts.map(|n| *n as usize);
        let (points, values) = counts.fold((0_usize, 1_usize), |(sum, product), n| {
            (sum.saturating_add(n), product.saturating_mul(n))
        });
        let length = values.saturating_mul(3).saturating_add(points);
        match values > 0 && numbers.len() == length.saturating_add(AXES) {
            true => Self(numbers),
            false => Self::default(),
        }
    }

    /// Returns whether there is no table.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns whether the table depends on an axis: 0 slip, 1 slip velocity, 2 pressure, 3
    /// temperature.
    pub fn depends_on(&self, axis: usize) -> bool {
        self.0.get(axis).is_some_and(|n| *n > 1.0)
    }

    /// Returns the value at a point, linear between the points of the table in each axis; nothing
    /// without a table.
    pub fn at(&self, point: [f64; AXES]) -> Option<Reading> {
        let counts = self.0.get(..AXES)?;
        let counts: [usize; AXES] = core::array::from_fn(|k| counts[k] as usize);
        let mut axes = &self.0[AXES..];
        let mut outside = false;
        // First of the two points about each coordinate, and share of the second.
        let mut between = [(0, 0.0); AXES];
        for ((n, x), between) in counts.into_iter().zip(point).zip(&mut between) {
            let (own, rest) = axes.split_at(n);
            axes = rest;
            if n == 1 {
                continue;
            }
            let within = x.clamp(own[0], own[n - 1]);
            outside |= !(own[0]..=own[n - 1]).contains(&x);
            let next = own.partition_point(|p| *p <= within).clamp(1, n - 1);
            let [low, high] = [own[next - 1], own[next]];
            *between = (next - 1, ((within - low) / (high - low)).clamp(0.0, 1.0));
        }
        let size: usize = counts.iter().product();
        let column = |column: usize| {
            let values = &axes[column * size..(column + 1) * size];
            let corner = |corner: usize| {
                let mut weight = 1.0;
                let mut place = 0;
                for (k, (first, share)) in between.into_iter().enumerate() {
                    let second = corner >> k & 1;
                    weight *= if second == 1 { share } else { 1.0 - share };
                    place = place * counts[k] + (first + second).min(counts[k] - 1);
                }
                if weight == 0.0 {
                    0.0
                } else {
                    weight * values[place]
                }
            };
            (0..1 << AXES).map(corner).sum::<f64>()
        };
        Some(Reading {
            value: column(0),
            low: column(1),
            high: column(2),
            outside,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of two velocities and three pressures: 0.1 + v + p/10, with an interval of 0.01
    /// below and 0.02 above.
    fn table() -> Table {
        let mut numbers = vec![1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 4.0, 293.0];
        for by in [0.0, -0.01, 0.02] {
            for v in [0.0, 1.0] {
                numbers.extend([0.0, 1.0, 4.0].map(|p| 0.1 + v + 0.1 * p + by));
            }
        }
        Table::new(numbers.leak())
    }

    #[test]
    fn is_linear_between_its_points() {
        let table = table();
        assert!(table.depends_on(1) && table.depends_on(2));
        assert!(!table.depends_on(0) && !table.depends_on(3));
        for (v, p) in [(0.0, 0.0), (1.0, 4.0), (0.25, 0.5), (0.75, 2.5), (0.5, 1.0)] {
            let got = table.at([7.0, v, p, 900.0]).unwrap();
            assert!((got.value - (0.1 + v + 0.1 * p)).abs() < 1e-14, "{got:?}");
            assert!((got.within(-1.0) - got.value + 0.01).abs() < 1e-14);
            assert!((got.within(0.5) - got.value - 0.01).abs() < 1e-14);
            assert!(!got.outside);
        }
    }

    #[test]
    fn ends_at_its_border_and_says_so() {
        for (v, p, border) in [(2.0, 1.0, 1.2), (0.5, 9.0, 1.0), (-1.0, 0.0, 0.1)] {
            let got = table().at([0.0, v, p, 0.0]).unwrap();
            assert!(got.outside && (got.value - border).abs() < 1e-14, "{got:?}");
        }
    }

    #[test]
    fn numbers_of_another_length_are_no_table() {
        for numbers in [
            &[][..],
            &[1.0],
            &[1.0, 1.0, 1.0, 1.0, 0.0],
            &[0.0; 4],
            &[-1.0; 9],
        ] {
            let table = Table::new(numbers.to_vec().leak());
            assert!(table.is_empty() && table.at([0.0; 4]).is_none());
        }
    }
}
