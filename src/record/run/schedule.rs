//! When rows, states, pictures and checkpoints of a run are due.

use super::Recorder;
use crate::scene::case::Checkpoint;

impl Recorder<'_> {
    /// Returns the number of steps of the case until the next record, which is the most that one
    /// step of the simulation may span. With `every: 1`, the default, rows do not limit the span: a
    /// row then follows each step of the simulation, however many steps of the case it spans,
    /// unless measures and tests average over rows.
    pub(super) fn until_record(&self) -> u64 {
        let case = &self.loaded.case;
        let output = &case.output;
        let averages =
            case.friction.is_some() || case.biaxial.is_some() || !case.measures.is_empty();
        let every = |n: u64| (n > 0).then(|| n - self.done % n);
        let checkpoint = match output.checkpoint {
            Checkpoint::Steps(n) => every(n),
            Checkpoint::Seconds(_) | Checkpoint::Never => None,
        };
        let records = [
            every(output.every).filter(|_| output.every > 1 || averages),
            every(output.fclib),
            checkpoint,
            until_next(self.done, self.spread, output.views),
            until_next(self.done, self.spread, output.frames),
        ];
        records.into_iter().flatten().min().unwrap_or(u64::MAX)
    }
}

/// Whether one of `count` events, spread evenly over `total` steps, falls on this step.
pub(super) fn due(step: u64, total: u64, count: u32) -> bool {
    count > 0 && events(step, total, count) > events(step - 1, total, count)
}

/// How many of `count` events, spread evenly over `total` steps, fall on the steps up to this one.
fn events(step: u64, total: u64, count: u32) -> u128 {
    u128::from(step) * u128::from(count) / u128::from(total.max(1))
}

/// Number of steps from this one to the next of `count` events, spread evenly over `total` steps;
/// `None` if `count` is zero.
fn until_next(step: u64, total: u64, count: u32) -> Option<u64> {
    let next = events(step, total, count) + 1;
    let at = (next * u128::from(total.max(1))).div_ceil(u128::from(count.max(1)));
    (count > 0).then(|| u64::try_from(at).map_or(u64::MAX, |at| at - step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_event_is_the_first_step_on_which_one_is_due() {
        for (total, count) in [(200, 20), (200, 12), (7, 3), (5, 20), (100, 1)] {
            for step in 0..total {
                let first = (step + 1..).find(|k| due(*k, total, count));
                assert_eq!(until_next(step, total, count), first.map(|k| k - step));
            }
        }
        assert_eq!(until_next(3, 10, 0), None);
    }
}
