//! Change of the contact forces in a step, from which the step length is adapted.

use crate::contact::Key;
use nalgebra::Vector3;

/// Forces of all contacts in the last step (N; N/m in 2D), in the order of their keys; the
/// third component is zero in the plane.
#[derive(Clone, Debug, Default)]
pub struct ContactForces(pub(super) Vec<(Key, Vector3<f64>)>);

impl ContactForces {
    /// Returns the root of the sum of squared differences, divided by that of the forces before or
    /// after, whichever is larger; 0 without forces.
    pub fn change(&self, after: &Self) -> f64 {
        let (mut old, mut new) = (self.0.iter().peekable(), after.0.iter().peekable());
        let (mut difference, mut sums) = (0.0, [0.0; 2]);
        loop {
            let (a, b) = match (old.peek(), new.peek()) {
                (None, None) => break,
                (Some(a), Some(b)) if a.0 == b.0 => (old.next(), new.next()),
                (Some(a), Some(b)) if a.0 < b.0 => (old.next(), None),
                (Some(_), None) => (old.next(), None),
                _ => (None, new.next()),
            };
            let force = |of: Option<&(Key, Vector3<f64>)>| of.map_or(Vector3::zeros(), |x| x.1);
            let (a, b) = (force(a), force(b));
            difference += (a - b).dot(&(a - b));
            sums[0] += a.dot(&a);
            sums[1] += b.dot(&b);
        }
        let size = sums[0].max(sums[1]);
        if size > 0.0 {
            (difference / size).sqrt()
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forces(list: &[(u32, f64)]) -> ContactForces {
        let key = |candidate| Key {
            candidate,
            antagonist: 9,
            feature: 0,
        };
        ContactForces(
            list.iter()
                .map(|(k, f)| (key(*k), Vector3::new(0.0, *f, 0.0)))
                .collect(),
        )
    }

    #[test]
    fn forces_that_come_and_go_count_in_full() {
        let before = forces(&[(0, 3.0), (1, 4.0)]);
        assert_eq!(before.change(&before), 0.0);
        assert!((before.change(&forces(&[(0, 3.0), (1, 3.5)])) - 0.1).abs() < 1e-15);
        // A force of 4 N ends, a force of 3 N begins.
        let after = forces(&[(0, 3.0), (2, 3.0)]);
        assert!((before.change(&after) - 1.0).abs() < 1e-15);
        assert!((after.change(&before) - 1.0).abs() < 1e-15);
        assert_eq!(before.change(&forces(&[])), 1.0);
        assert_eq!(forces(&[]).change(&forces(&[])), 0.0);
    }
}
