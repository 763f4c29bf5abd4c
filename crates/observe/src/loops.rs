//! Shape of a fretting loop Q(delta): its crossings of Q = 0, Q/P at the reversals of the motion,
//! and its plateau.

use serde::{Deserialize, Serialize};

/// Observer of a loop, which receives sample by sample.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Loop {
    /// Displacement (m), Q (N), and the last non-zero increment of displacement (m).
    last: Option<[f64; 3]>,
    motion: f64,
    /// Lowest and highest displacement at Q = 0 in the cycle (m).
    crossings: Option<[f64; 2]>,
    /// Sum of |Q|/P over the reversals, and their number.
    reversals: (f64, u32),
    /// Path since the last reversal, and the longest path between two reversals so far (m): before
    /// the second one, twice that to the first.
    stroke: [f64; 2],
    /// Number of reversals since the first cycle.
    turns: u32,
    /// Path from the last reversal to Q = 0 (m).
    unloaded: Option<f64>,
    /// Sum of these paths in the cycle, and their number.
    unloading: (f64, u32),
    /// Work that the contact gives back from the last reversal to Q = 0 (J), and the sum of this
    /// work in the cycle.
    given_back: [f64; 2],
    /// Q/P of the last sample.
    ratio: f64,
    /// Reversals of the cycle after at least a tenth of the longest stroke.
    strokes: u32,
    /// Work of Q, and integral of P over the path (J), in equal parts of the strokes.
    parts: Vec<[f64; 2]>,
}

/// Number of these parts.
const PARTS: usize = 200;
/// Path from a reversal to sliding over the elastic travel 2 (delta* - delta_0) that the loop's
/// width at Q = 0 shows: 1 for a spring, 1/(2 (1 - (1/2)^(2/3))) for a sphere on a flat, by
/// Mindlin's loop.
const ROUNDED: f64 = 1.36;
/// Part of the stroke that is left out after that.
const CORNER: f64 = 0.02;
/// Share by which Q/P in the second quarter of a stroke may be below the straight line through the
/// second half: by more, it still rises towards its plateau.
const RISING: f64 = 0.03;

impl Loop {
    /// Starts the next cycle at the end of the last one.
    pub fn next_cycle(&mut self) {
        self.crossings = None;
        self.reversals = (0.0, 0);
        self.unloading = (0.0, 0);
        self.given_back[1] = 0.0;
        self.strokes = 0;
        self.parts = vec![[0.0; 2]; PARTS];
    }

    /// Adds a sample: the displacement at its end (m), and Q and P over it (N; N/m in 2D).
    pub fn add(&mut self, displacement: f64, q: f64, p: f64) {
        if let Some([before, q0, p0]) = self.last {
            let motion = displacement - before;
            if q0 * q < 0.0 || (q == 0.0 && q0 != 0.0) {
                let at = before + motion * q0 / (q0 - q);
                let [low, high] = self.crossings.unwrap_or([at, at]);
                self.crossings = Some([low.min(at), high.max(at)]);
            }
            let turns = motion * self.motion < 0.0;
            if turns {
                self.unloaded = None;
                self.given_back[0] = 0.0;
            }
            if self.unloaded.is_none() {
                self.given_back[0] -= (q * motion).min(0.0);
            }
            if turns && p0 > 0.0 {
                self.reversals.0 += q0.abs() / p0;
                self.reversals.1 += 1;
            }
            self.add_to_stroke(motion, turns, q, p);
            if self.unloaded.is_none() && q * motion > 0.0 {
                self.unloaded = Some(self.stroke[0]);
                if self.turns > 0 {
                    self.unloading.0 += self.stroke[0];
                    self.unloading.1 += 1;
                    self.given_back[1] += self.given_back[0];
                }
            }
            if motion != 0.0 {
                self.motion = motion;
            }
        }
        self.ratio = if p > 0.0 { q.abs() / p } else { 0.0 };
        self.last = Some([displacement, q, p]);
    }

    /// Returns how often the motion turned back in the cycle after more than a tenth of the longest
    /// stroke: twice in one period of a motion to and fro.
    pub fn strokes(&self) -> u32 {
        self.strokes
    }

    /// Returns |Q|/P of the last sample.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Returns the elastic energy that the tangential force keeps stored at |Q|/P (J; J/m in 2D):
    /// what the contact gives back after the reversals of the cycle, times the square of the ratio
    /// relative to that at these reversals.
    pub fn stored(&self, ratio: f64) -> f64 {
        let relative = ratio / self.reversal();
        let given_back = self.given_back[1] / f64::from(self.unloading.1.max(1));
        match relative.is_finite() {
            true => given_back * relative.min(1.0).powi(2),
            false => 0.0,
        }
    }

    fn add_to_stroke(&mut self, motion: f64, turns: bool, q: f64, p: f64) {
        let path = motion.abs();
        let [since, longest] = &mut self.stroke;
        if turns {
            self.turns = self.turns.saturating_add(1);
            if *since > 0.1 * *longest {
                self.strokes += 1;
            }
            // A motion usually starts in the middle of its stroke.
            *longest = match self.turns {
                1 => 2.0 * *since,
                2 => *since,
                _ => longest.max(*since),
            };
            *since = 0.0;
        }
        let middle = *since + 0.5 * path;
        *since += path;
        if *longest > 0.0 {
            self.parts.resize(PARTS, [0.0; 2]);
            let part = (middle / *longest * PARTS as f64) as usize;
            let [work, load] = &mut self.parts[part.min(PARTS - 1)];
            *work += q * motion;
            *load += p * path;
        }
    }

    /// Returns Q/P along the motion while the contact slides, weighted by the path; `None` before
    /// the first reversal. A stroke is the path between two reversals, the longest so far (twice
    /// the path to the first reversal, before there are two).
    ///
    /// Of a stroke of 2 delta* the first 2 (delta* - delta_0) are elastic, with the sliding
    /// amplitude delta_0 ([`Self::aperture`]). If the contact slides from the first quarter on, the
    /// middle half of the stroke counts, where the slopes of scars cancel (X. Jin, W. Sun, P. H.
    /// Shipway, Tribology International 102 (2016) 561). If Q/P still rises towards a plateau
    /// there, as of a layer of debris, it is the second half of the part that slides.
    pub fn plateau(&self) -> Option<f64> {
        let slides = match self.crossings {
            Some([low, high]) if high > low => ((high - low) / self.stroke[1]).min(1.0),
            _ => 1.0,
        };
        let elastic = ROUNDED * (1.0 - slides) + CORNER;
        if elastic <= 0.25 {
            // What a straight line through the second half is before it.
            let [second, third, last] = [0.25, 0.5, 0.75].map(|from| self.over(from, from + 0.25));
            if second? >= (1.0 - RISING) * (2.0 * third? - last?) {
                return self.over(0.25, 0.75);
            }
        }
        self.over(1.0 - 0.5 * slides, 1.0)
    }

    /// Returns Q/P along the motion over a part of the strokes.
    fn over(&self, from: f64, to: f64) -> Option<f64> {
        let place = |share: f64| (share * PARTS as f64).round() as usize;
        let parts = self.parts.iter().take(place(to)).skip(place(from));
        let sum = |k: usize| parts.clone().map(|part| part[k]).sum::<f64>();
        let (work, load) = (sum(0), sum(1));
        (load > 0.0).then(|| work / load)
    }

    /// Returns the slope of Q over the end of the strokes, relative to that after the reversals: 0
    /// where the whole contact slides, (1 - Q*/mu P)^(1/3) of a sphere in partial slip (K. L.
    /// Johnson, Contact Mechanics, 1985, 7.4). `None` where no stroke was complete.
    pub fn end_stiffness(&self) -> Option<f64> {
        const END: [f64; 3] = [0.92, 0.96, 1.0];
        let [before, last] = [self.over(END[0], END[1])?, self.over(END[1], END[2])?];
        let end = (last - before) / (END[2] - END[1]);
        let path = self.unloading.0 / f64::from(self.unloading.1.max(1)) / self.stroke[1];
        (self.turns > 1 && path > 0.0).then(|| end * path / self.reversal())
    }

    /// Returns whether the contact slides at the last sample: from the reversal to Q = 0 it is half
    /// of its elastic travel that has passed. `false` before the first reversal.
    pub fn slides(&self) -> bool {
        let elastic = self.unloaded.map(|path| 2.0 * ROUNDED * path);
        self.turns > 0 && elastic.is_some_and(|elastic| self.stroke[0] > elastic)
    }

    /// Returns half of the loop's width at Q = 0, the sliding amplitude (m).
    pub fn aperture(&self) -> f64 {
        self.crossings.map_or(0.0, |[low, high]| 0.5 * (high - low))
    }

    /// Returns the mean of |Q|/P over the reversals.
    pub fn reversal(&self) -> f64 {
        self.reversals.0 / f64::from(self.reversals.1.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The loop of a sphere on a flat in partial slip at Q* = share mu P, by Mindlin: on loading
    /// delta = delta_0 (1 - (1 - Q/mu P)^(2/3)), and by Masing's rule, after a reversal, twice that
    /// at half the force.
    fn mindlin(share: f64, steps: u32) -> (Loop, f64, f64) {
        let (p, mu, gross) = (100.0, 0.5, 2e-6);
        let load = |q: f64| gross * (1.0 - (1.0 - q / (mu * p)).powf(2.0 / 3.0));
        let most = share * mu * p;
        let amplitude = load(most);
        let mut l = Loop::default();
        let force =
            |k: u32| -most * (std::f64::consts::TAU * f64::from(k) / f64::from(steps)).cos();
        let mut work = 0.0;
        for _ in 0..2 {
            l.next_cycle();
            work = 0.0;
            let mut last = (-amplitude, -most);
            for k in 1..=steps {
                let q = force(k);
                let d = if 2 * k <= steps {
                    -amplitude + 2.0 * load(0.5 * (q + most))
                } else {
                    amplitude - 2.0 * load(0.5 * (most - q))
                };
                l.add(d, q, p);
                work += 0.5 * (q + last.1) * (d - last.0);
                last = (d, q);
            }
        }
        let ratio = work / (4.0 * most * amplitude);
        (l, ratio, amplitude - 2.0 * load(0.5 * most))
    }

    #[test]
    fn a_partial_slip_loop_has_mindlin_s_opening_and_energy() {
        // A = E_d/(4 Q* delta*) is from K. L. Johnson, Contact Mechanics (1985), 7.4.
        for (share, ratio) in [(0.25, 0.0160), (0.5, 0.0381), (0.75, 0.0736), (0.9, 0.1136)] {
            let (l, found, aperture) = mindlin(share, 4000);
            assert!((found - ratio).abs() < 6e-5, "{found} for {ratio}");
            assert!((l.aperture() / aperture - 1.0).abs() < 1e-4);
            assert!((l.reversal() / (share * 0.5) - 1.0).abs() < 1e-5);
            // The stiffness at half the unloading is that of the mean force.
            assert!(l.end_stiffness().unwrap() > 0.3, "{share}");
        }
    }

    #[test]
    fn a_rigid_slider_opens_its_loop_over_the_whole_stroke() {
        let mut l = Loop::default();
        let (a, n) = (1e-5, 1000);
        for k in 0..=2 * n {
            let phase = std::f64::consts::TAU * f64::from(k) / f64::from(n);
            l.add(a * phase.sin(), 40.0 * phase.cos().signum(), 100.0);
        }
        assert!((l.aperture() / a - 1.0).abs() < 1e-4);
        assert!((l.reversal() - 0.4).abs() < 1e-12);
    }

    /// An elastic slider (spring k, friction mu P) under +-a: Q rises by k delta after each
    /// reversal up to mu P at 2 mu P/k. The elastic travel is 8, 16 and 18 um of a stroke of 20 um.
    #[test]
    fn the_plateau_of_an_elastic_slider_is_the_same_for_any_stroke() {
        for stiffness in [1e7, 5e6, 4.5e6] {
            elastic_slider(stiffness);
        }
    }

    /// Returns the plateau of a rectangular loop at 0.4 with another force over the strokes, a
    /// function of the part of the stroke.
    fn with_force(more: impl Fn(f64) -> f64) -> f64 {
        let (a, n, p) = (1e-5, 4000, 100.0);
        let (mut l, mut x) = (Loop::default(), 0.0_f64);
        for step in 0..3 * n {
            if step % n == 0 {
                l.next_cycle();
            }
            let phase = std::f64::consts::TAU * (f64::from(step) + 1.0) / f64::from(n);
            let to = a * phase.sin();
            let along = (to - x).signum();
            let part = 0.5 * (1.0 + along * 0.5 * (x + to) / a);
            l.add(to, along * p * (0.4 + more(part)), p);
            x = to;
        }
        l.plateau().unwrap()
    }

    #[test]
    fn slopes_of_a_scar_cancel_and_a_slow_rise_is_left_out() {
        for slope in [0.05, 0.2] {
            let found = with_force(|s| slope * (s - 0.5));
            assert!((found - 0.4).abs() < 1e-3, "{slope}: {found}");
            let hooked = with_force(|s| 8.0 * slope * (s - 0.5).powi(3));
            assert!((hooked - 0.4).abs() < 1e-3, "{slope}: {hooked}");
        }
        // The force of a layer of debris, 0.1, 0.3 and 0.38 of the stroke behind the reversal.
        let rises = with_force(|s| -0.6 * (-s / 0.12).exp());
        assert!((rises - 0.4).abs() < 0.006, "{rises}");
    }

    fn elastic_slider(k: f64) {
        let (a, n, mu, p) = (1e-5, 4000, 0.4, 100.0);
        let (mut l, mut x, mut q) = (Loop::default(), 0.0, 0.0_f64);
        let (mut work, mut path) = (0.0, 0.0);
        for step in 0..=3 * n {
            let to = a * (std::f64::consts::TAU * f64::from(step) / f64::from(n)).sin();
            if step % n == 0 {
                (work, path) = (0.0, 0.0);
                l.next_cycle();
            }
            q = (q + k * (to - x)).clamp(-mu * p, mu * p);
            work += q * (to - x);
            path += p * (to - x).abs();
            x = to;
            l.add(x, q, p);
            // Path since the reversal, of a stroke of 2 a.
            let since = f64::from((4 * step + n) % (2 * n)) / f64::from(4 * n);
            let since = a * (1.0 - (std::f64::consts::TAU * since).cos());
            let slides = ROUNDED * 2.0 * mu * p / k;
            if step > n && since > 0.01 * a && (since - slides).abs() > 0.01 * a {
                assert_eq!(l.slides(), since > slides, "{step}");
            }
            if step == n - 1 {
                // The plateau counts from the first reversal.
                assert!((l.plateau().unwrap() / mu - 1.0).abs() < 1e-12);
            }
            if step == 3 * n - 1 {
                let stored = 0.5 * q * q / k;
                let off = l.stored(l.ratio()) / stored - 1.0;
                assert!(off.abs() < 1e-2, "{k}: {off}");
                assert!((l.plateau().unwrap() / mu - 1.0).abs() < 1e-12);
                assert!(l.end_stiffness().unwrap().abs() < 1e-9);
                // The energetic coefficient: 4 mu P (a - mu P/k) over 4 a P.
                let expected = mu * (1.0 - mu * p / k / a);
                assert!((work / path / expected - 1.0).abs() < 1e-2);
                // Slip: delta_0 = a - mu P/k.
                assert!((l.aperture() / (a - mu * p / k) - 1.0).abs() < 1e-2);
            }
        }
    }
}
