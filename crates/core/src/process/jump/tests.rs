//! Jumps over cycles whose wear and work are given.

use super::*;
use crate::bodies::{Dof, TimeFunction};
use crate::geometry::polyline::Polyline;
use crate::geometry::space::Dim2;
use crate::process::sliding::SlidingPart;
use crate::wear::Scar;
use nalgebra::Vector2;

/// Number of steps of a cycle, and their length (s).
const STEPS: u32 = 4;
const H: f64 = 0.25;

/// A surface with a scar, and a driven body that slides along x.
struct Test {
    s: Simulation<Dim2>,
    jumps: Jumps,
}

/// Returns jumps after `after` cycles with `control` control cycles.
fn spec(after: u32, control: u32) -> JumpSpec {
    JumpSpec {
        after,
        control,
        ..JumpSpec::default()
    }
}

impl Test {
    fn new(spec: JumpSpec) -> Self {
        let mut s = Simulation::<Dim2>::of_disks(&[]);
        let chain = [0.0, 1.0, 2.0, 3.0].map(|x| Vector2::new(x, 0.0)).to_vec();
        s.add_surface(Polyline::new(chain, None).unwrap());
        let scar = Scar::new("rail".into(), 0, &s.shapes.surfaces[0], 1e300, 1).unwrap();
        s.state.scars.push(scar);
        let speed = Dof::Velocity(TimeFunction::Constant(1.0));
        let body = s.state.bodies.add(Vector2::zeros(), 1.0, 1.0, 1.0);
        s.drive(body, [speed, Dof::Fixed, Dof::Fixed]);
        s.options.scheme.h = H;
        let place = s.state.bodies.driven.len() - 1;
        s.state.bodies.velocity[body as usize].x = 1.0;
        s.state.started[place].0.x = 1.0;
        let test = SlidingBody {
            part: SlidingPart::Driven(place),
            along: 0,
            normal: 1,
        };
        let clock = CycleClock::new(0.0, Some(f64::from(STEPS) * H), 1e9);
        let steps = [u64::from(STEPS), 1_000_000];
        let mut jumps = Jumps::new(spec, clock, test, steps, &s);
        // Processes act before the first step too.
        jumps.between_steps(&mut s).unwrap();
        Self { s, jumps }
    }

    /// Computes a cycle in which each represented cycle wears this amount (m^2) with this
    /// distribution and takes this work (J/m); returns the number of cycles that it represented.
    fn cycle(&mut self, wears: impl Fn(u32) -> f64, work: f64) -> u32 {
        let (s, jumps) = (&mut self.s, &mut self.jumps);
        let stands = s.state.network.cycle_multiplier as u32;
        let before = jumps.represented;
        let worn: f64 = (before + 1..=before + stands).map(wears).sum();
        for _ in 0..STEPS {
            for (vertex, part) in [(1, 0.75), (2, 0.25)] {
                let part = part * worn / f64::from(STEPS);
                s.state.scars[0]
                    .wear_vertices([(vertex, 1.0)], part)
                    .unwrap();
            }
            // The drive acts with this force against that of the contacts, over a displacement of H
            // at 1 m/s.
            let place = s.state.received.len() - 1;
            s.state.received[place].0.x = -work / f64::from(STEPS);
            s.state.steps += 1;
            s.state.time = s.state.steps as f64 * H;
            jumps.between_steps(s).unwrap();
        }
        assert_eq!(jumps.represented, before + stands);
        stands
    }
}

/// Wear that grows by the same amount from cycle to cycle is summed exactly by a parabola, and by
/// the straight line of the first jump, if the mean of control cycles represents their middle:
/// jumps then have no error, and the requested number of control cycles follows each.
#[test]
fn growth_in_a_straight_line_has_no_error_with_any_number_of_control_cycles() {
    for control in 1..=4 {
        let mut test = Test::new(JumpSpec {
            at_most: 40,
            ..spec(5, control)
        });
        let stood: Vec<u32> = (0..60)
            .map(|_| test.cycle(|c| 2.0 + 0.125 * f64::from(c), 1.0))
            .collect();
        let summary = test.jumps.outcome(&test.s);
        assert!(summary.jumps.len() > 5);
        for jump in &summary.jumps {
            assert!(jump.error < 1e-12, "{control} control cycles: {jump:?}");
        }
        assert!(summary.error_estimate.unwrap() < 1e-11);
        // The length of the first jump is that of the cycles before it; later ones are twice as
        // long up to the limit.
        let jumps: Vec<u32> = summary.jumps.iter().map(|j| j.cycles).collect();
        assert_eq!(jumps[..4], [5, 10, 20, 40]);
        assert!(stood[..5].iter().all(|n| *n == 1));
        let between = stood[5..].split(|n| *n > 1).skip(1);
        let between: Vec<usize> = between.map(<[u32]>::len).collect();
        let (_, whole) = between.split_last().unwrap();
        assert!(whole.iter().all(|n| *n == control as usize), "{stood:?}");
        // These are the numbers of cycles before the first jump, and before the second.
        let first = &summary.jumps[..2];
        assert_eq!((first[0].after, first[1].after), (5, 10 + control));
    }
}

/// After three cycles a fourth represents three: at half of it 1.5 cycles are done, of which one
/// was skipped. At its end all six are done, of which two were skipped.
#[test]
fn cycles_are_counted_within_one_that_stands_for_several() {
    let mut test = Test::new(spec(3, 2));
    let at = |test: &Test, cycles: f64| {
        let time = cycles * f64::from(STEPS) * H;
        (test.jumps.cycles_at(time), test.jumps.jumped_at(time))
    };
    for _ in 0..3 {
        test.cycle(|_| 1.0, 1.0);
    }
    assert_eq!(test.s.state.network.cycle_multiplier, 3.0);
    assert_eq!(at(&test, 3.0), (3.0, 0.0));
    assert_eq!(at(&test, 3.5), (4.5, 1.0));
    test.cycle(|_| 1.0, 1.0);
    assert_eq!(at(&test, 4.0), (6.0, 2.0));
    assert_eq!(at(&test, 4.25), (6.25, 2.0));
}

/// The work of the cycles after a jump is compared with that of the cycle before it: 3 J/m, then
/// twice 4 and 5.
#[test]
fn the_change_of_work_is_that_of_the_mean_control_cycle() {
    let mut test = Test::new(spec(3, 2));
    let works = [1.0, 2.0, 3.0, 99.0, 4.0, 5.0, 99.0, 4.0, 2.0];
    let stood: Vec<u32> = works.iter().map(|w| test.cycle(|_| 1.0, *w)).collect();
    assert_eq!(stood, [1, 1, 1, 3, 1, 1, 6, 1, 1]);
    let summary = test.jumps.outcome(&test.s);
    let changes: Vec<f64> = summary.jumps.iter().map(|j| j.work_change).collect();
    assert_eq!(changes.len(), 2);
    // The second is compared with the last control cycle of the first.
    for (found, expected) in changes.iter().zip([4.5 / 3.0 - 1.0, 1.0 - 3.0 / 5.0]) {
        assert!((found - expected).abs() < 1e-12, "{changes:?}");
    }
}

/// A jump of n cycles of constant wear w in which the laws wore a share too much has an error of
/// that share of n w, and so does the whole run at least.
#[test]
fn what_a_jump_wears_too_much_is_its_error() {
    let mut test = Test::new(spec(2, 1));
    for _ in 0..2 {
        test.cycle(|_| 1.0, 1.0);
    }
    assert_eq!(test.cycle(|_| 1.25, 1.0), 2);
    // The jump is not checked yet.
    assert_eq!(test.jumps.outcome(&test.s).unchecked_cycles, 2);
    test.cycle(|_| 1.0, 1.0);
    let summary = test.jumps.outcome(&test.s);
    assert_eq!(summary.jumps.len(), 1);
    assert!((summary.jumps[0].error - 0.25 / 1.25).abs() < 1e-12);
    // The total is 2 + 2.5 + 1.
    let estimate = summary.error_estimate.unwrap();
    assert!((estimate - SAFETY * 0.5 / 5.5).abs() < 1e-12, "{estimate}");
    assert_eq!(
        (summary.computed_cycles, summary.represented_cycles),
        (4, 5)
    );
}

/// The run ends at the requested number of cycles; the last jumps take a third of the remaining
/// cycles.
#[test]
fn jumps_become_shorter_towards_the_end() {
    let mut test = Test::new(JumpSpec {
        cycles: Some(50),
        ..spec(2, 1)
    });
    while !Process::<Dim2>::finished(&test.jumps) {
        let left = 50 - test.jumps.represented;
        let stands = test.cycle(|_| 1.0, 1.0);
        assert!(stands <= 1.max((left - 1) / 3), "{stands} of {left}");
    }
    assert_eq!(test.jumps.represented, 50);
}
