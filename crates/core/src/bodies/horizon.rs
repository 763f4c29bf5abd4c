//! The next kink of functions of time and drives, and the longest step that resolves them.

use super::drive::Dof;
use super::time_function::TimeFunction;

/// Number of steps in a period of a sine or in a ramp that resolve it: linear interpolation between
/// 20 points has an error of (pi/20)^2/2, 1.2 % of the amplitude.
pub const STEPS_A_PERIOD: f64 = 20.0;

impl TimeFunction {
    /// Returns the first time after `t` (s) at which it or its derivative jumps; infinite if there
    /// is none.
    pub fn next_kink(&self, t: f64) -> f64 {
        let after = |times: &[f64]| {
            let later = times.iter().filter(|x| **x > t);
            later.fold(f64::INFINITY, |first, x| first.min(*x))
        };
        match self {
            Self::Constant(_) => f64::INFINITY,
            Self::Ramp { start, end, .. } => after(&[*start, *end]),
            Self::Sine { start, .. } => after(&[*start]),
            Self::Table(points) => {
                let next = points.partition_point(|p| p.0 <= t);
                points.get(next).map_or(f64::INFINITY, |p| p.0)
            }
        }
    }

    /// Returns the longest step from `t` on (s) that resolves the function; infinite where it is
    /// constant, and for tables, which are linear up to the next kink.
    pub fn resolved_step(&self, t: f64) -> f64 {
        match self {
            Self::Sine {
                amplitude,
                frequency,
                ..
            } if *amplitude != 0.0 && *frequency > 0.0 => 1.0 / (STEPS_A_PERIOD * frequency),
            Self::Ramp {
                from,
                to,
                start,
                end,
            } if from != to && t < *end => (end - start) / STEPS_A_PERIOD,
            Self::Table(points) => {
                let next = points.partition_point(|p| p.0 <= t);
                let piece = next.checked_sub(1).and_then(|k| points.get(k..=next));
                piece
                    .filter(|p| p[0].1 != p[1].1)
                    .map_or(f64::INFINITY, |p| (p[1].0 - p[0].0) / STEPS_A_PERIOD)
            }
            _ => f64::INFINITY,
        }
    }
}

impl Dof {
    /// Returns the first time after `t` (s) at which a stage ends or a function of any stage has a
    /// kink; infinite if there is none.
    pub fn next_kink(&self, t: f64) -> f64 {
        let ends = match self {
            Self::Stages(stages) => stages.iter().filter_map(|s| s.until).find(|end| *end > t),
            _ => None,
        };
        let kinks = self.drives().filter_map(Self::function);
        let kinks = kinks.map(|f| f.next_kink(t));
        kinks.fold(ends.unwrap_or(f64::INFINITY), f64::min)
    }

    /// Returns the longest step from `t` on (s) that resolves the active drive; infinite where that
    /// is constant.
    pub fn resolved_step(&self, t: f64) -> f64 {
        let function = self.at(t).function();
        function.map_or(f64::INFINITY, |f| f.resolved_step(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::Stage;

    #[test]
    fn kinks_and_what_resolves_a_function_lie_ahead() {
        let ramp = TimeFunction::Ramp {
            from: 0.0,
            to: 1.0,
            start: 1.0,
            end: 3.0,
        };
        assert_eq!(
            [0.0, 1.0, 3.0].map(|t| ramp.next_kink(t)),
            [1.0, 3.0, f64::INFINITY]
        );
        assert_eq!(
            [0.0, 1.0, 3.0].map(|t| ramp.resolved_step(t)),
            [0.1, 0.1, f64::INFINITY]
        );
        let table = TimeFunction::Table(vec![(0.0, 1.0), (1.0, 1.0), (2.0, 5.0)]);
        assert_eq!(
            [-1.0, 0.5, 1.0, 2.0].map(|t| table.next_kink(t)),
            [0.0, 1.0, 2.0, f64::INFINITY]
        );
        assert_eq!(
            [-1.0, 0.5, 1.0, 2.0].map(|t| table.resolved_step(t)),
            [f64::INFINITY, f64::INFINITY, 0.05, f64::INFINITY]
        );
        let sine = TimeFunction::Sine {
            amplitude: 1.0,
            frequency: 0.5,
            phase: 0.0,
            offset: 0.0,
            start: 0.2,
        };
        assert_eq!((sine.next_kink(0.0), sine.resolved_step(0.0)), (0.2, 0.1));
        let staged = Dof::Stages(vec![
            Stage::new(Some(0.5), Dof::Fixed),
            Stage::new(None, Dof::Force(ramp)),
        ]);
        assert_eq!([0.0, 0.5].map(|t| staged.next_kink(t)), [0.5, 1.0]);
        assert_eq!(
            [0.0, 0.5].map(|t| staged.resolved_step(t)),
            [f64::INFINITY, 0.1]
        );
    }
}
