//! Time series in bounded memory: when it is full, every second point is dropped.

use serde::{Deserialize, Serialize};

/// Equidistant points, including the first, and the last one separately.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DecimatedSeries<T> {
    points: Vec<T>,
    /// The last point, if it is not among the points.
    last: Option<T>,
    /// Interval of stored points: one of `each` points is stored.
    each: u64,
    seen: u64,
}

impl<T> Default for DecimatedSeries<T> {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            last: None,
            each: 1,
            seen: 0,
        }
    }
}

impl<T> DecimatedSeries<T> {
    /// Largest number of points; at least half of them remain.
    pub const MAX: usize = 2048;

    /// Adds a point.
    pub fn add(&mut self, point: T) {
        let kept = self.seen.is_multiple_of(self.each);
        self.seen += 1;
        if !kept {
            self.last = Some(point);
            return;
        }
        if self.points.len() == Self::MAX {
            let mut k = 0;
            self.points.retain(|_| {
                k += 1;
                k % 2 == 1
            });
            self.each *= 2;
        }
        // After thinning an even number of stored points, this point is still one of every `each`.
        self.points.push(point);
        self.last = None;
    }

    /// Iterates over the stored points and the last one.
    pub fn points(&self) -> impl Iterator<Item = &T> {
        self.points.iter().chain(&self.last)
    }

    /// The last point.
    pub fn last(&self) -> Option<&T> {
        self.last.as_ref().or(self.points.last())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_all_there_or_equally_far_apart_with_both_ends() {
        for count in [0, 1, 5, 2048, 2049, 4096, 4097, 4101, 100_001] {
            let mut series = DecimatedSeries::default();
            (0..count).for_each(|k: u64| series.add(k));
            let points: Vec<u64> = series.points().copied().collect();
            assert_eq!(series.last().copied(), count.checked_sub(1));
            assert_eq!(points.last(), series.last());
            if count <= DecimatedSeries::<u64>::MAX as u64 {
                assert_eq!(points, (0..count).collect::<Vec<_>>());
                continue;
            }
            assert!(
                points.len() > DecimatedSeries::<u64>::MAX / 2
                    && points.len() <= DecimatedSeries::<u64>::MAX + 1
            );
            let apart: Vec<u64> = points.windows(2).map(|w| w[1] - w[0]).collect();
            let (end, rest) = apart.split_last().unwrap();
            assert!(points[0] == 0 && rest.iter().all(|d| *d == rest[0]) && *end <= rest[0]);
        }
    }
}
