//! The curve of a bond that carries its strength over a plateau before it softens linearly.

/// From the opening u_0 at the strength the traction has a plateau to u_p, then decreases linearly
/// to zero at u_f, with energy = strength (u_f + u_p - u_0)/2.
pub(crate) struct Trapezoid {
    first: f64,
    end: f64,
    last: f64,
}

impl Trapezoid {
    /// Returns the curve with u_0 `first` (m), energy over strength `length` (m), and `plateau`
    /// between 0 (none) and 1: the longest plateau that the energy allows, to u_0/2 + length, where
    /// u_f = u_p.
    pub fn new(first: f64, length: f64, plateau: f64) -> Self {
        let longest = 0.5 * first + length;
        let end = first + plateau * (longest - first);
        let last = 2.0 * length + first - end;
        // A bond that stores more than the energy at its strength breaks at its strength.
        let last = if longest <= first { first } else { last };
        Self { first, end, last }
    }

    /// Returns the fraction of the strength that the bond carries at an opening beyond u_0 (m);
    /// `None` once it is broken.
    pub fn share(&self, u: f64) -> Option<f64> {
        if u >= self.last || self.last <= self.first {
            None
        } else if u <= self.end {
            Some(1.0)
        } else {
            Some((self.last - u) / (self.last - self.end))
        }
    }
}
