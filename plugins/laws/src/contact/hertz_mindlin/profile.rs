//! The tangential displacement of a contact by radius: what the history of load and displacement
//! left of stick and slip.
//!
//! By the method of dimensionality reduction a sphere in contact is a row of independent springs at
//! the distances x from its middle. At an overlap d the spring at x is pressed by d - s, s = x^2/R,
//! and carries a tangential displacement u up to the share beta of that, beyond which it slips; one
//! that parts carries none. For contacts that are loaded and sheared in any order this is the
//! theory of Cattaneo, Mindlin and Deresiewicz, annulus by annulus (V. L. Popov, M. Hess, Method of
//! Dimensionality Reduction in Contact Mechanics and Friction (2015) 5.4; J. Jaeger, Arch. Appl.
//! Mech. 65 (1995) 478). Under a constant load u is piecewise linear in s, and so exact here; for
//! other histories the least corners are left out.

/// Tangential components (m, or N).
pub type Pair = [f64; 2];

/// Corners that are kept from step to step, with the edge of the contact.
pub const KEPT: usize = 6;
/// Corners while a step is followed.
const MOST: usize = 3 * KEPT + 4;
/// Excess over the bound that is rounding, as a share of it.
const ROUNDING: f64 = 1e-12;

/// u as a function of s: straight between corners, the last of which is the edge of the contact
/// with u = 0.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    corners: [(f64, Pair); MOST],
    count: usize,
}

/// a - b.
pub fn minus(a: Pair, b: Pair) -> Pair {
    [a[0] - b[0], a[1] - b[1]]
}

/// a . b.
pub fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// |a|.
pub fn norm(a: Pair) -> f64 {
    dot(a, a).sqrt()
}

/// A vector made no longer than a bound.
fn limited(u: Pair, bound: f64) -> Pair {
    let size = norm(u);
    if size > bound {
        u.map(|x| x * (bound / size))
    } else {
        u
    }
}

/// The value at a share of the way.
fn between(a: Pair, b: Pair, share: f64) -> Pair {
    [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
}

impl Profile {
    /// A contact of this overlap (m) without displacement.
    pub fn flat(edge: f64) -> Self {
        let mut out = Self {
            corners: [(0.0, [0.0; 2]); MOST],
            count: 0,
        };
        out.push(0.0, [0.0; 2]);
        out.push(edge, [0.0; 2]);
        out
    }

    /// From corners in increasing order, of which the first is the middle; those beyond the edge
    /// are left out.
    pub fn new(corners: &[(f64, Pair)], edge: f64) -> Self {
        let mut out = Self::flat(edge);
        out.count = 0;
        for (s, u) in corners.iter().take(KEPT - 1) {
            let last = out.count.checked_sub(1).map_or(-1.0, |k| out.corners[k].0);
            if *s > last && *s < edge {
                out.push(*s, *u);
            }
        }
        if out.count == 0 {
            out.push(0.0, [0.0; 2]);
        }
        out.push(edge, [0.0; 2]);
        out
    }

    fn push(&mut self, s: f64, u: Pair) {
        if self.count < MOST {
            self.corners[self.count] = (s, u);
            self.count += 1;
        }
    }

    /// The corners without the edge.
    pub fn corners(&self) -> &[(f64, Pair)] {
        &self.corners[..self.count.saturating_sub(1)]
    }

    /// Where u ends (m).
    pub fn edge(&self) -> f64 {
        self.corners[self.count - 1].0
    }

    /// Displaces all of the contact.
    pub fn shift(&mut self, by: Pair) {
        for (_, u) in &mut self.corners[..self.count] {
            *u = [u[0] + by[0], u[1] + by[1]];
        }
    }

    /// Goes to another overlap: springs that part are lost, new ones have no displacement.
    fn reach(&mut self, edge: f64) {
        if edge >= self.edge() {
            if edge > self.edge() {
                self.push(edge, [0.0; 2]);
            }
            return;
        }
        let inside = (0..self.count).find(|k| self.corners[*k].0 >= edge);
        let k = inside.unwrap_or(self.count - 1).max(1);
        let ((s0, u0), (s1, u1)) = (self.corners[k - 1], self.corners[k]);
        let share = if s1 > s0 {
            (edge - s0) / (s1 - s0)
        } else {
            1.0
        };
        self.corners[k] = (edge, between(u0, u1, share.clamp(0.0, 1.0)));
        self.count = k + 1;
    }

    /// Goes to an overlap (m) and lets slip what is beyond the bound beta (d - s).
    pub fn slip(&mut self, edge: f64, beta: f64) {
        self.reach(edge);
        let bound = |s: f64| beta * (edge - s).max(0.0);
        let old = *self;
        self.count = 0;
        for k in 0..old.count {
            let (s, u) = old.corners[k];
            let (b, size) = (bound(s), norm(u));
            if k > 0 {
                let (s0, u0) = old.corners[k - 1];
                let over = [
                    norm(u0) - bound(s0) * (1.0 + ROUNDING),
                    size - b * (1.0 + ROUNDING),
                ];
                let passes = over[0] * over[1] < 0.0;
                let x = if passes {
                    crossing([u0, u], [bound(s0), b])
                } else {
                    None
                };
                let from = match x {
                    Some(x) if over[0] > 0.0 => [0.0, x],
                    Some(x) => [x, 1.0],
                    None if over[0] > 0.0 => [0.0, 1.0],
                    None => [1.0; 2],
                };
                // Where it slips the direction of slip may change along it.
                let mut at = |x: f64| {
                    let (s, u) = (s0 + x * (s - s0), between(u0, u, x));
                    self.push(s, limited(u, bound(s)));
                };
                if from[0] > 0.0 && from[0] < 1.0 {
                    at(from[0]);
                }
                if from[0] < from[1] {
                    at(0.5 * (from[0] + from[1]));
                }
                if from[1] < 1.0 {
                    at(from[1]);
                }
            }
            self.push(s, limited(u, b));
        }
        self.prune();
    }

    /// Leaves out corners on straight lines, and the least until as many are left as are kept.
    fn prune(&mut self) {
        let largest = (0..self.count)
            .map(|k| norm(self.corners[k].1))
            .fold(0.0, f64::max);
        let width = self.edge();
        loop {
            let bends = (1..self.count.saturating_sub(1)).map(|k| (k, self.bend(k)));
            let least = bends.min_by(|a, b| a.1.total_cmp(&b.1));
            match least {
                Some((k, bend)) if self.count > KEPT || bend <= 1e-9 * largest * width * width => {
                    self.leave_out(k);
                }
                _ => return,
            }
        }
    }

    /// Leaves out a corner; the one before it makes up for what that changes of the force, but not
    /// by more displacement than there was.
    fn leave_out(&mut self, k: usize) {
        let ([x, y], [p, q]) = (self.part(k).0, self.part(k + 1).0);
        let most = norm(self.corners[k].1).max(norm(self.corners[k - 1].1));
        let most = most.max(norm(self.corners[k.saturating_sub(2)].1));
        self.corners.copy_within(k + 1..self.count, k);
        self.count -= 1;
        let now = self.part(k).0;
        let width = self.corners[k].0.sqrt() - self.corners[k.saturating_sub(2)].0.sqrt();
        if width > 0.0 {
            let u = &mut self.corners[k - 1].1;
            let more = |all: f64, now: f64| 2.0 * (all - now) / width;
            let made_up = [u[0] + more(x + p, now[0]), u[1] + more(y + q, now[1])];
            *u = limited(made_up, most);
        }
    }

    /// How far a corner is off the line between its neighbours, times the square of the width
    /// between these: what its loss displaces of the force, with how far.
    fn bend(&self, k: usize) -> f64 {
        let [(s0, u0), (s, u), (s1, u1)] = [k - 1, k, k + 1].map(|k| self.corners[k]);
        if s1 <= s0 {
            return 0.0;
        }
        let off = minus(u, between(u0, u1, (s - s0) / (s1 - s0)));
        norm(off) * (s1 - s0).powi(2)
    }

    /// The integrals of u (m^1.5) and of |u|^2 (m^2.5) over sqrt(s): the force and twice the
    /// energy, each over the shear modulus 8 G* and sqrt(R).
    pub fn sums(&self) -> (Pair, f64) {
        let (mut force, mut squares) = ([0.0; 2], 0.0);
        for k in 1..self.count {
            let ([x, y], more) = self.part(k);
            force = [force[0] + x, force[1] + y];
            squares += more;
        }
        (force, squares)
    }

    /// What the part between a corner and the one before it adds to [`Self::sums`].
    fn part(&self, k: usize) -> (Pair, f64) {
        // Of three points by Gauss: exact, since u is of second order in sqrt(s).
        const AT: f64 = 0.774_596_669_241_483_4;
        const WEIGHTS: [f64; 3] = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
        let ((s0, u0), (s1, u1)) = (self.corners[k - 1], self.corners[k]);
        let (mut force, mut squares) = ([0.0; 2], 0.0);
        if s1 > s0 {
            let (r0, r1) = (s0.sqrt(), s1.sqrt());
            let (middle, half) = (0.5 * (r0 + r1), 0.5 * (r1 - r0));
            for (at, weight) in [-AT, 0.0, AT].into_iter().zip(WEIGHTS) {
                let r = middle + half * at;
                let u = between(u0, u1, (r * r - s0) / (s1 - s0));
                let weight = weight * (r1 - r0);
                force = [force[0] + weight * u[0], force[1] + weight * u[1]];
                squares += weight * dot(u, u);
            }
        }
        (force, squares)
    }
}

/// Where between two points the length of u passes the bound.
fn crossing([u0, u1]: [Pair; 2], [b0, b1]: [f64; 2]) -> Option<f64> {
    let (du, db) = (minus(u1, u0), b1 - b0);
    let (a, b, c) = (
        dot(du, du) - db * db,
        dot(u0, du) - b0 * db,
        dot(u0, u0) - b0 * b0,
    );
    let root = (b * b - a * c).max(0.0).sqrt();
    let q = -(b + root.copysign(b));
    let inside = |x: &f64| *x > 0.0 && *x < 1.0;
    [c / q, q / a].into_iter().find(inside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Many springs side by side, followed one by one: s_i, with weights d(sqrt s).
    struct Springs {
        u: Vec<Pair>,
        width: f64,
        beta: f64,
    }

    impl Springs {
        fn new(beta: f64) -> Self {
            Self {
                u: vec![[0.0; 2]; 1000],
                width: 1.5 / 1000.0,
                beta,
            }
        }

        fn step(&mut self, d: f64, by: Pair) -> Pair {
            let mut sum = [0.0; 2];
            for (k, u) in self.u.iter_mut().enumerate() {
                let x = (k as f64 + 0.5) * self.width;
                let bound = self.beta * (d - x * x).max(0.0);
                *u = [u[0] + by[0], u[1] + by[1]];
                let size = norm(*u);
                if size > bound {
                    *u = u.map(|x| x * bound / size);
                }
                sum = [sum[0] + u[0] * self.width, sum[1] + u[1] * self.width];
            }
            sum
        }
    }

    /// The largest difference of the force from that of many springs, over the largest force, on a
    /// path of overlap and displacement.
    fn off(beta: f64, path: impl Fn(f64) -> (f64, Pair)) -> f64 {
        const STEPS: usize = 1000;
        let (mut springs, mut profile) = (Springs::new(beta), Profile::flat(0.0));
        let mut at = path(0.0).1;
        let (mut worst, mut largest) = (0.0f64, 0.0f64);
        for k in 1..=STEPS {
            let (d, u) = path(k as f64 / STEPS as f64);
            let by = minus(u, at);
            at = u;
            profile.slip(d, beta);
            profile.shift(by);
            profile.slip(d, beta);
            let (got, wanted) = (profile.sums().0, springs.step(d, by));
            worst = worst.max(norm(minus(got, wanted)));
            largest = largest.max(norm(wanted));
        }
        worst / largest
    }

    /// Forces on paths of load and displacement against those of 1000 springs, for a small and a
    /// large friction.
    #[test]
    fn follows_any_history_of_load_and_displacement() {
        let ramp = |t: f64, points: &[(f64, f64)]| {
            let k = points.iter().rposition(|p| p.0 <= t).unwrap();
            match points.get(k + 1) {
                Some(next) => {
                    let share = (t - points[k].0) / (next.0 - points[k].0);
                    points[k].1 + share * (next.1 - points[k].1)
                }
                None => points[k].1,
            }
        };
        type Path<'a> = (&'a str, Box<dyn Fn(f64) -> (f64, Pair) + 'a>);
        let paths: Vec<Path> = vec![
            (
                "lift",
                Box::new(|t| {
                    (
                        ramp(t, &[(0.0, 0.0), (0.3, 1.0), (0.6, 1.0), (1.0, 0.4)]),
                        [ramp(t, &[(0.0, 0.0), (0.3, 0.0), (0.6, 0.2)]), 0.0],
                    )
                }),
            ),
            (
                "constant load",
                Box::new(|t| (1.0, [0.2 * (4.0 * TAU * t).sin(), 0.0])),
            ),
            ("oblique", Box::new(|t| (t, [0.3 * t, 0.0]))),
            (
                "oblique and back",
                Box::new(|t| {
                    (
                        1.001 - (2.0 * t - 1.0).abs(),
                        [0.3 - 0.3 * (2.0 * t - 1.0).abs(), 0.0],
                    )
                }),
            ),
            (
                "held",
                Box::new(|t| {
                    (
                        1.0 + 0.3 * (10.0 * TAU * t).sin(),
                        [ramp(t, &[(0.0, 0.0), (0.1, 0.2)]), 0.0],
                    )
                }),
            ),
            (
                "out of phase",
                Box::new(|t| {
                    (
                        1.0 + 0.4 * (10.0 * TAU * t).sin(),
                        [0.25 * (10.0 * TAU * t).cos(), 0.0],
                    )
                }),
            ),
            (
                "in phase",
                Box::new(|t| {
                    (
                        1.0 + 0.4 * (10.0 * TAU * t).sin(),
                        [0.25 * (10.0 * TAU * t).sin(), 0.0],
                    )
                }),
            ),
            (
                "around",
                Box::new(|t| {
                    (
                        1.0 + 0.4 * (3.0 * TAU * t).sin(),
                        [
                            0.2 * (5.0 * TAU * t).sin(),
                            0.2 * (7.0 * TAU * t).cos() - 0.2,
                        ],
                    )
                }),
            ),
        ];
        for (name, path) in &paths {
            for beta in [0.3, 0.7, 12.0] {
                let off = off(beta, path);
                // A rim that moves while all slides along leaves more corners than are kept.
                let many = ["out of phase", "around"].contains(name);
                let allowed = if many { 0.08 } else { 0.015 };
                assert!(off < allowed, "{name}, {beta}: {off}");
            }
        }
    }
}
