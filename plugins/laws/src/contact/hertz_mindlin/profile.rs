//! The tangential displacement of a contact as a function of the radius, which stores the history
//! of stick and slip under varying load and displacement.
//!
//! By the method of dimensionality reduction a sphere in contact is a row of independent springs at
//! the distances x from its middle. At an overlap d the spring at x is compressed by d - s, with
//! s = x^2/R. It carries a tangential displacement u of at most beta (d - s), beyond which it
//! slips; a spring that is not compressed carries none. For contacts that are loaded and sheared in
//! any order this is the theory of Cattaneo, Mindlin and Deresiewicz, annulus by annulus (V. L.
//! Popov, M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction (2015) 5.4;
//! J. Jaeger, Arch. Appl. Mech. 65 (1995) 478). Under a constant load u is piecewise linear in s,
//! so its representation here is exact; for other histories the least significant corners are
//! removed.

/// Tangential components (m, or N).
pub type Pair = [f64; 2];

/// Number of corners that are stored from step to step, including the edge of the contact.
pub const KEPT: usize = 6;
/// Number of corners within a step.
const MAX_CORNERS: usize = 3 * KEPT + 4;
/// Excess over the friction bound that is attributed to rounding, relative to the bound.
const ROUNDING: f64 = 1e-12;

/// Function u(s), linear between corners. The last corner is the edge of the contact, where u = 0.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    corners: [(f64, Pair); MAX_CORNERS],
    count: usize,
}

/// Returns a - b.
pub fn minus(a: Pair, b: Pair) -> Pair {
    [a[0] - b[0], a[1] - b[1]]
}

/// Returns the dot product of a and b.
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
    /// Returns a contact of this overlap (m) without displacement.
    pub fn flat(edge: f64) -> Self {
        let mut out = Self {
            corners: [(0.0, [0.0; 2]); MAX_CORNERS],
            count: 0,
        };
        out.push(0.0, [0.0; 2]);
        out.push(edge, [0.0; 2]);
        out
    }

    /// Returns the profile with these corners in increasing order, the first of which is the
    /// middle. Corners beyond the edge are removed.
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
        if self.count < MAX_CORNERS {
            self.corners[self.count] = (s, u);
            self.count += 1;
        }
    }

    /// The corners without the edge.
    pub fn corners(&self) -> &[(f64, Pair)] {
        &self.corners[..self.count.saturating_sub(1)]
    }

    /// Value of s at the edge of the contact (m).
    pub fn edge(&self) -> f64 {
        self.corners[self.count - 1].0
    }

    /// Displaces the whole contact.
    pub fn shift(&mut self, by: Pair) {
        for (_, u) in &mut self.corners[..self.count] {
            *u = [u[0] + by[0], u[1] + by[1]];
        }
    }

    /// Changes the overlap: springs that part are removed, new ones have no displacement.
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

    /// Changes the overlap (m), and limits the displacement to beta (d - s) by slip.
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
                // Where springs slip, the direction of slip may vary with s.
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

    /// Removes corners on straight lines, then the least significant ones until the limit is met.
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

    /// Removes a corner. The corner before it compensates the change of the force, but its
    /// displacement does not exceed the largest one before.
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

    /// Returns the distance of a corner from the line between its neighbours, times the square of
    /// their distance: a measure of the error of the force if the corner is removed.
    fn bend(&self, k: usize) -> f64 {
        let [(s0, u0), (s, u), (s1, u1)] = [k - 1, k, k + 1].map(|k| self.corners[k]);
        if s1 <= s0 {
            return 0.0;
        }
        let off = minus(u, between(u0, u1, (s - s0) / (s1 - s0)));
        norm(off) * (s1 - s0).powi(2)
    }

    /// Returns the integrals of u (m^1.5) and of |u|^2 (m^2.5) over sqrt(s). Multiplied by the
    /// shear modulus 8 G* and sqrt(R) they are the force and twice the energy.
    pub fn sums(&self) -> (Pair, f64) {
        let (mut force, mut squares) = ([0.0; 2], 0.0);
        for k in 1..self.count {
            let ([x, y], more) = self.part(k);
            force = [force[0] + x, force[1] + y];
            squares += more;
        }
        (force, squares)
    }

    /// Contribution to [`Self::sums`] of the segment between a corner and the one before it.
    fn part(&self, k: usize) -> (Pair, f64) {
        // Gauss' rule with three points is exact, since u is of second order in sqrt(s).
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

/// Returns where between two points the magnitude of u exceeds the bound.
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

    /// Reference model: many springs side by side, each followed separately: s_i, with weights
    /// d(sqrt s).
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

    /// Largest difference of the force from that of many springs, over the largest force, on a path
    /// of overlap and displacement.
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

    /// Forces on paths of load and displacement are compared with those of 1000 springs, for a
    /// small and a large friction.
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
                // A rim that moves while the whole contact slips leaves more corners than are
                // stored.
                let many = ["out of phase", "around"].contains(name);
                let allowed = if many { 0.08 } else { 0.015 };
                assert!(off < allowed, "{name}, {beta}: {off}");
            }
        }
    }
}
