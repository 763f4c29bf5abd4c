//! Hierarchy of bounding boxes of the segments of a chain, to find the segments near a position
//! without testing all. Successive segments of a chain are near each other, so that no sorting is
//! needed.

use nalgebra::Vector2;

type V = Vector2<f64>;

/// Boxes per group.
const GROUP: usize = 8;

/// An axis-aligned box; its boundary belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    /// Least coordinates (m).
    pub low: V,
    /// Greatest coordinates (m).
    pub high: V,
}

impl BoundingBox {
    /// Returns the box of all positions within `reach` (m) of a centre along the axes.
    pub fn around(centre: &V, reach: f64) -> Self {
        Self {
            low: V::new(centre.x - reach, centre.y - reach),
            high: V::new(centre.x + reach, centre.y + reach),
        }
    }

    /// Moves the box along x (m).
    pub fn shifted(&self, x: f64) -> Self {
        Self {
            low: V::new(self.low.x + x, self.low.y),
            high: V::new(self.high.x + x, self.high.y),
        }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    fn joined(boxes: &[Self]) -> Self {
        let mut all = boxes[0];
        for one in &boxes[1..] {
            (all.low, all.high) = (all.low.inf(&one.low), all.high.sup(&one.high));
        }
        all
    }
}

/// The bounding boxes of a chain, level by level.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    /// Boxes of the segments, then of the groups of each level; the last level has one box.
    levels: Vec<Vec<BoundingBox>>,
}

impl BoxTree {
    /// Sets the boxes of the segments, in the order of the chain.
    pub fn set(&mut self, segments: impl Iterator<Item = BoundingBox>) {
        if self.levels.is_empty() {
            self.levels.push(Vec::new());
        }
        self.levels[0].clear();
        self.levels[0].extend(segments);
        let mut level = 0;
        while self.levels[level].len() > 1 {
            let groups: Vec<BoundingBox> = self.levels[level]
                .chunks(GROUP)
                .map(BoundingBox::joined)
                .collect();
            level += 1;
            match self.levels.get_mut(level) {
                Some(known) => *known = groups,
                None => self.levels.push(groups),
            }
        }
        self.levels.truncate(level + 1);
    }

    /// Calls `each` with the segments whose box meets a window, in order, until it returns false;
    /// returns whether it never did.
    pub fn visit(&self, bounds: &BoundingBox, each: &mut impl FnMut(usize) -> bool) -> bool {
        let top = self.levels.len();
        top == 0 || self.descend(top - 1, 0, bounds, each)
    }

    fn descend(
        &self,
        level: usize,
        group: usize,
        bounds: &BoundingBox,
        each: &mut impl FnMut(usize) -> bool,
    ) -> bool {
        let boxes = &self.levels[level];
        let first = group * GROUP;
        for (k, one) in boxes.iter().enumerate().skip(first).take(GROUP) {
            if bounds.meets(one) {
                let goes_on = if level == 0 {
                    each(k)
                } else {
                    self.descend(level - 1, k, bounds, each)
                };
                if !goes_on {
                    return false;
                }
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_segments_in_a_window_are_found_in_order() {
        for count in [0u32, 1, 2, 8, 9, 64, 65, 700] {
            let segment = |k: u32| {
                let t = 0.1 * f64::from(k);
                BoundingBox::around(&V::new(t.cos() * t, t.sin() * t), 0.05 * t)
            };
            let mut boxes = BoxTree::default();
            // The boxes of another chain are replaced.
            boxes.set((0..90).map(segment));
            boxes.set((0..count).map(segment));
            for k in 0..200 {
                let t = 0.35 * f64::from(k);
                let centre = V::new(t.sin() * t, (1.3 * t).cos() * t);
                let bounds = BoundingBox::around(&centre, 0.02 * t);
                let mut found = Vec::new();
                let mut push = |k| {
                    found.push(k as u32);
                    true
                };
                assert!(boxes.visit(&bounds, &mut push));
                let meets = |k: &u32| bounds.meets(&segment(*k));
                assert!(found.iter().copied().eq((0..count).filter(meets)));
                let any = !boxes.visit(&bounds, &mut |_| false);
                assert_eq!(any, !found.is_empty());
            }
        }
    }
}
