//! Conduction along a surface, between the half-spaces below neighbouring pieces of it.

use crate::diffusion::node::add;
use crate::diffusion::{DiffusionError, Node, Store};
use std::ops::Range;

/// Value of D h/w^2 above which a step leaves no difference between neighbours beyond rounding.
const EVEN: f64 = 1e10;

/// The pieces of a surface along one of its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnAxis {
    /// Number of pieces.
    pub count: u32,
    /// Width of each piece (m).
    pub width: f64,
    /// Whether the last piece is a neighbour of the first; otherwise no heat flows through either
    /// end.
    pub periodic: bool,
}

/// Half-spaces of one material and one grid below the pieces of a surface, between which heat flows
/// tangentially: at each depth dT/dt = D (d2T/dx2 + d2T/dy2), in finite volumes of the widths of
/// the pieces.
///
/// The flow along the depth and that along each axis of the surface are separate steps, one after
/// another (G. Strang, SIAM J. Numer. Anal. 5 (1968) 506-517): each is implicit, conserves heat
/// and, with theta = 1, stays within the range of the temperatures. The result equals that of all
/// directions at once where D h/w^2 is small, with the diffusivity D, the step h and the width w.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// The nodes, the last axis running fastest.
    pub nodes: Range<usize>,
    /// One axis in two dimensions, two in three.
    pub axes: Vec<ColumnAxis>,
    /// Diffusivity D (m^2/s).
    pub diffusivity: f64,
}

impl Columns {
    /// Returns D h/w^2 along the axis where it is largest, for a step (s).
    pub fn number(&self, h: f64) -> f64 {
        let each = self.axes.iter().filter(|a| a.count > 1);
        each.map(|a| self.diffusivity * h / (a.width * a.width))
            .fold(0.0, f64::max)
    }

    /// Lets heat flow along the axes for a step (s), in their order or in reverse; returns the
    /// change of the stored heat (J), which is rounding.
    pub(crate) fn conduct(&self, nodes: &mut [Node], h: f64, theta: f64, reverse: bool) -> f64 {
        let mut order: Vec<usize> = (0..self.axes.len()).collect();
        if reverse {
            order.reverse();
        }
        let mut stored = 0.0;
        let mut change = Vec::new();
        for axis in order {
            let ColumnAxis {
                count,
                width,
                periodic,
            } = self.axes[axis];
            if count < 2 {
                continue;
            }
            let number = (self.diffusivity * h / (width * width)).min(EVEN);
            let line = Line::new(count as usize, number, theta, periodic);
            let after = self.axes[axis + 1..].iter().map(|a| a.count as usize);
            let stride: usize = after.product();
            for first in 0..self.nodes.len() / (count as usize * stride) {
                for offset in 0..stride {
                    let start = self.nodes.start + first * count as usize * stride + offset;
                    stored += line.conduct(nodes, (start, stride), &mut change);
                }
            }
        }
        stored
    }

    /// # Errors
    /// Fails for an invalid number, or nodes that are not half-spaces with the same grid.
    pub(crate) fn check(&self, nodes: &[Node]) -> Result<(), DiffusionError> {
        let refuse = |what, node, value, expected| {
            Err(DiffusionError::Number {
                what,
                node,
                value,
                expected,
            })
        };
        let first = self.nodes.start;
        let widths = self.axes.iter().map(|a| ("width of a piece", a.width));
        for (what, value) in widths.chain([("diffusivity", self.diffusivity)]) {
            if !(value > 0.0 && value.is_finite()) {
                return refuse(what, first, value, "a number above zero");
            }
        }
        let count: usize = self.axes.iter().map(|a| a.count as usize).product();
        if count != self.nodes.len() || self.nodes.end > nodes.len() {
            let expected = "as many half-spaces as pieces";
            return refuse("number of pieces", first, count as f64, expected);
        }
        let points = |node: &Node| match &node.store {
            Store::HalfSpace(space) => space.grid.points(),
            _ => 0,
        };
        let same = points(&nodes[first]);
        let each = self.nodes.clone().map(|k| (k, points(&nodes[k])));
        match each.into_iter().find(|(_, p)| *p != same || *p == 0) {
            None => Ok(()),
            Some((k, p)) => refuse(
                "number of points over the depth",
                k,
                p as f64,
                "that of the first half-space of its surface",
            ),
        }
    }
}

/// Solves (1 + theta r L) d = -r L T along a line of pieces, with the second difference L and r = D
/// h/w^2: the same matrix at each depth.
struct Line {
    /// Number r.
    number: f64,
    /// Whether the line is closed, so that the first piece is a neighbour of the last.
    closed: bool,
    /// Off-diagonal of the matrix, positive.
    beside: f64,
    /// Inverse pivots of the elimination.
    inverse: Vec<f64>,
    /// Correction of each piece per difference of the two ends where the line is closed (J.
    /// Sherman, W. J. Morrison, Ann. Math. Stat. 21 (1950) 124-127); empty for a line with ends.
    closing: Vec<f64>,
}

impl Line {
    fn new(count: usize, number: f64, theta: f64, periodic: bool) -> Self {
        // Two pieces that are neighbours on both sides have two faces between them.
        let number = match periodic && count == 2 {
            true => 2.0 * number,
            false => number,
        };
        let closed = periodic && count > 2;
        let beside = theta * number;
        // The matrix is that of the line with ends, plus beside (e_first - e_last)(e_first -
        // e_last)^T, of rank one, if it is closed.
        let mut diagonal = vec![1.0 + 2.0 * beside; count];
        (diagonal[0], diagonal[count - 1]) = (1.0 + beside, 1.0 + beside);
        let mut inverse = Vec::with_capacity(count);
        let mut last = 0.0;
        for d in diagonal {
            last = 1.0 / (d - beside * beside * last);
            inverse.push(last);
        }
        let mut line = Self {
            number,
            closed,
            beside,
            inverse,
            closing: Vec::new(),
        };
        if closed {
            let mut z = vec![0.0; count];
            (z[0], z[count - 1]) = (beside, -beside);
            line.solve(&mut z, 1);
            let scale = 1.0 / (1.0 + z[0] - z[count - 1]);
            line.closing = z.into_iter().map(|z| z * scale).collect();
        }
        line
    }

    /// Solves for all depths at once, with the right-hand sides of a piece one after another,
    /// without the part that closes the line.
    fn solve(&self, change: &mut [f64], points: usize) {
        let count = self.inverse.len();
        for k in 0..count {
            let (before, own) = change.split_at_mut(k * points);
            let own = &mut own[..points];
            if k > 0 {
                for (x, before) in own.iter_mut().zip(&before[(k - 1) * points..]) {
                    *x += self.beside * before;
                }
            }
            own.iter_mut().for_each(|x| *x *= self.inverse[k]);
        }
        for k in (0..count - 1).rev() {
            let (own, after) = change.split_at_mut((k + 1) * points);
            let factor = self.beside * self.inverse[k];
            for (x, after) in own[k * points..].iter_mut().zip(&after[..points]) {
                *x += factor * after;
            }
        }
    }

    /// Corrects the changes at each depth for rounding, so that their sum is zero.
    fn keep_heat(&self, change: &mut [f64], points: usize) {
        let count = self.inverse.len();
        for p in 0..points {
            let of = |k: usize| change[k * points + p];
            let mean = (0..count).map(of).sum::<f64>() / count as f64;
            (0..count).for_each(|k| change[k * points + p] -= mean);
        }
    }

    /// Changes the temperatures of a line that starts at a node and continues by a stride; returns
    /// the stored heat (J).
    fn conduct(&self, nodes: &mut [Node], place: (usize, usize), change: &mut Vec<f64>) -> f64 {
        let (start, stride) = place;
        let count = self.inverse.len();
        let temperature = |nodes: &[Node], k: usize| match &nodes[start + k * stride].store {
            Store::HalfSpace(space) => space.temperature.clone(),
            _ => Vec::new(),
        };
        let first = temperature(nodes, 0);
        let points = first.len();
        change.clear();
        change.resize(count * points, 0.0);
        let mut before = first.clone();
        for k in 0..count {
            // This is the flow through the face between a piece and the next; the last piece has
            // one only on a closed line.
            let next = match k + 1 == count {
                false => (k + 1, temperature(nodes, k + 1)),
                true if self.closed => (0, first.clone()),
                true => break,
            };
            for (p, (own, other)) in before.iter().zip(&next.1).enumerate() {
                let flow = self.number * (other - own);
                change[k * points + p] += flow;
                change[next.0 * points + p] -= flow;
            }
            before = next.1;
        }
        self.solve(change, points);
        if self.closed {
            for p in 0..points {
                let ends = change[p] - change[(count - 1) * points + p];
                for (k, z) in self.closing.iter().enumerate() {
                    change[k * points + p] -= z * ends;
                }
            }
        }
        if self.number > 1.0 {
            self.keep_heat(change, points);
        }
        let mut stored = 0.0;
        for (k, change) in change.chunks(points.max(1)).enumerate() {
            let node = &mut nodes[start + k * stride];
            if let Store::HalfSpace(space) = &mut node.store {
                stored += space.change(change);
                node.temperature = space.temperature[0];
            }
        }
        stored
    }
}

impl crate::diffusion::HalfSpace {
    /// Adds changes of temperature (K) at all depths; returns the stored heat (J).
    fn change(&mut self, change: &[f64]) -> f64 {
        let mut stored = 0.0;
        let each = self.temperature.iter_mut().zip(&mut self.lost);
        for (((t, lost), by), c) in each.zip(change).zip(&self.grid.capacity) {
            add(t, lost, *by);
            stored += c * by;
        }
        self.area * stored
    }
}
