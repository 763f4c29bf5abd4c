//! Level of detail of the states in the page.

use crate::html::arrays::NumberType;

/// If fewer states than this fit at a level of detail, a coarser level is chosen.
const ENOUGH: [usize; 3] = [10, 8, 5];
/// Number of states that are always shown, with fewer grains if necessary.
const MIN_SHOWN_STATES: usize = 4;

/// Level of detail of the states of a page; the finest shows all that was recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Detail {
    /// 0: all; 1: fields in 254 intervals; 2: without the less usual fields of contacts; 3: without
    /// contacts.
    level: u8,
    /// One grain in this many is shown.
    pub every: usize,
}

impl Default for Detail {
    fn default() -> Self {
        Self { level: 0, every: 1 }
    }
}

/// Fields of contacts that are omitted last, since the viewer draws bonds and force chains by them.
const USUAL: [&str; 4] = ["state", "status", "damage", "force_normal"];

impl Detail {
    /// Returns the next coarser level if too few of `count` states of `size` bytes each fit into
    /// `bytes`.
    pub fn coarser(self, fit: usize, count: usize, size: usize, bytes: usize) -> Option<Self> {
        let enough = ENOUGH
            .get(usize::from(self.level))
            .copied()
            .unwrap_or(MIN_SHOWN_STATES);
        if fit >= enough.min(count) {
            return None;
        }
        match self.level {
            0..3 => Some(Self {
                level: self.level + 1,
                ..self
            }),
            _ if self.every > 1 => None,
            _ => Some(Self {
                every: (MIN_SHOWN_STATES.min(count) * size)
                    .div_ceil(bytes.max(1))
                    .max(2),
                ..self
            }),
        }
    }

    /// Number format of the values of fields.
    pub fn kind(self) -> NumberType {
        if self.level == 0 {
            NumberType::U16
        } else {
            NumberType::U8
        }
    }

    /// Whether contacts are shown.
    pub fn contacts(self) -> bool {
        self.level < 3
    }

    /// Whether a field of contacts is kept.
    pub fn keeps(self, field: &str) -> bool {
        self.level < 2 || USUAL.contains(&field)
    }

    /// Describes what is omitted, in sentences without a full stop.
    pub fn sentences(self) -> Vec<String> {
        let mut out = vec![match self.level {
            0 => "positions and fields are rounded to 1/65,000 of their range".to_owned(),
            _ => "positions are rounded to 1/65,000 of their range, fields to 1/254".to_owned(),
        }];
        match self.level {
            2 => out.push(format!(
                "of the fields of contacts only {} are here",
                USUAL.join(", ")
            )),
            3 => out.push("contacts are left out".to_owned()),
            _ => {}
        }
        if self.every > 1 {
            out.push(format!("one of {} grains is shown", self.every));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn detail_goes_down_until_enough_states_fit() {
        let mut detail = Detail::default();
        assert_eq!(detail.coarser(10, 21, 1, 10), None);
        // A limit equal to the number of states needs no coarser detail.
        assert_eq!(detail.coarser(3, 3, 1, 3), None);
        let mut steps = 0;
        while let Some(next) = detail.coarser(1, 21, 1000, 1000) {
            detail = next;
            steps += 1;
        }
        assert_eq!((detail.level, detail.every, steps), (3, 4, 4));
        assert!(!detail.contacts() && detail.keeps("damage") && !detail.keeps("gap"));
    }
}
