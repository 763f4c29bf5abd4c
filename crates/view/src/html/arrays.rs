//! Arrays of numbers for the page: quantised, named, compressed with gzip and encoded in base64.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde::Serialize;
use std::collections::HashMap;
use std::io::Write as _;

/// Number format of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum NumberType {
    /// 254 intervals between the smallest and the largest value.
    U8,
    /// 65,534 intervals between the smallest and the largest value.
    U16,
    /// Integers below 2^32.
    U32,
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

#[derive(Clone, Debug, Serialize)]
struct Head {
    name: String,
    kind: NumberType,
    count: usize,
    at: usize,
    low: f64,
    high: f64,
}

/// Named arrays: a JSON header for each, then the numbers of all arrays, each starting at a
/// multiple of eight bytes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arrays {
    heads: Vec<Head>,
    bytes: Vec<u8>,
    /// Names of the arrays that can be found again, by the bits of their values.
    known: HashMap<Vec<u64>, String>,
}

impl Arrays {
    /// Adds an array.
    pub fn push(&mut self, name: impl Into<String>, kind: NumberType, values: &[f64]) {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let low = finite().fold(f64::INFINITY, f64::min);
        let high = finite().fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        while !self.bytes.len().is_multiple_of(8) {
            self.bytes.push(0);
        }
        self.heads.push(Head {
            name: name.into(),
            kind,
            count: values.len(),
            at: self.bytes.len(),
            low,
            high,
        });
        // The largest code represents a value that is not a number.
        let code = |v: f64, most: f64| match (v.is_finite(), high > low) {
            (false, _) => most,
            (true, false) => 0.0,
            (true, true) => ((v - low) / (high - low) * (most - 1.0)).round(),
        };
        match kind {
            NumberType::U8 => self
                .bytes
                .extend(values.iter().map(|v| code(*v, 255.0) as u8)),
            NumberType::U16 => {
                // Differences between neighbours are small: they compress better with low and high
                // bytes stored separately.
                let codes: Vec<u16> = values.iter().map(|v| code(*v, 65535.0) as u16).collect();
                self.bytes.extend(codes.iter().map(|c| *c as u8));
                self.bytes.extend(codes.iter().map(|c| (c >> 8) as u8));
            }
            NumberType::U32 => self
                .bytes
                .extend(values.iter().flat_map(|v| (*v as u32).to_le_bytes())),
            NumberType::F32 => self
                .bytes
                .extend(values.iter().flat_map(|v| (*v as f32).to_le_bytes())),
            NumberType::F64 => self
                .bytes
                .extend(values.iter().flat_map(|v| v.to_le_bytes())),
        }
    }

    /// Adds an array of numbers unless an identical one exists; returns its name.
    pub fn number(&mut self, values: &[f64]) -> String {
        let bits: Vec<u64> = values.iter().map(|v| v.to_bits()).collect();
        if let Some(name) = self.known.get(&bits) {
            return name.clone();
        }
        let name = format!("#{}", self.known.len());
        self.push_known(&name, NumberType::F32, values);
        name
    }

    /// Adds an array that [`Self::number`] finds again.
    pub fn push_known(&mut self, name: &str, kind: NumberType, values: &[f64]) {
        self.push(name, kind, values);
        let bits = values.iter().map(|v| v.to_bits()).collect();
        self.known.entry(bits).or_insert_with(|| name.to_owned());
    }

    /// Removes the arrays that another set contains with identical bits.
    pub fn without_those_of(&self, other: &Self) -> Self {
        let theirs: HashMap<&str, (&Head, &[u8])> = other
            .parts()
            .map(|(head, bytes)| (head.name.as_str(), (head, bytes)))
            .collect();
        let mut out = Self::default();
        for (head, bytes) in self.parts() {
            let same = theirs.get(head.name.as_str()).is_some_and(|(h, b)| {
                let range = |h: &Head| (h.low.to_bits(), h.high.to_bits(), h.kind);
                range(h) == range(head) && *b == bytes
            });
            if same {
                continue;
            }
            while !out.bytes.len().is_multiple_of(8) {
                out.bytes.push(0);
            }
            let at = out.bytes.len();
            out.heads.push(Head { at, ..head.clone() });
            out.bytes.extend_from_slice(bytes);
        }
        out
    }

    fn parts(&self) -> impl Iterator<Item = (&Head, &[u8])> {
        self.heads.iter().map(|head| {
            let size = match head.kind {
                NumberType::U8 => 1,
                NumberType::U16 => 2,
                NumberType::U32 | NumberType::F32 => 4,
                NumberType::F64 => 8,
            };
            (head, &self.bytes[head.at..head.at + size * head.count])
        })
    }

    /// Returns all arrays as one text: length of the headers, headers, numbers; gzip, base64.
    pub fn packed(&self) -> String {
        let mut heads = serde_json::to_vec(&self.heads).unwrap_or_default();
        while !(4 + heads.len()).is_multiple_of(8) {
            heads.push(b' ');
        }
        let mut all = Vec::with_capacity(4 + heads.len() + self.bytes.len());
        all.extend((heads.len() as u32).to_le_bytes());
        all.extend(heads);
        all.extend(&self.bytes);
        gzip_base64(&all)
    }
}

/// Returns bytes compressed with gzip and encoded in base64. Writing to memory cannot fail.
pub(crate) fn gzip_base64(bytes: &[u8]) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::new(6));
    let packed = encoder.write_all(bytes).and_then(|()| encoder.finish());
    STANDARD.encode(packed.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_equal_is_left_out_and_the_rest_keeps_its_bytes() {
        let mut first = Arrays::default();
        first.push("a", NumberType::U8, &[0.0, 1.0, f64::NAN]);
        first.push("b", NumberType::F64, &[2.5]);
        let mut second = Arrays::default();
        second.push("a", NumberType::U8, &[0.0, 1.0, f64::NAN]);
        second.push("b", NumberType::F64, &[3.5]);
        let rest = second.without_those_of(&first);
        let parts: Vec<_> = rest
            .parts()
            .map(|(h, b)| (h.name.clone(), b.to_vec()))
            .collect();
        assert_eq!(parts, [("b".to_owned(), 3.5f64.to_le_bytes().to_vec())]);
        let codes: Vec<_> = first.parts().map(|(_, b)| b.to_vec()).collect();
        assert_eq!(codes[0], [0, 254, 255]);
        // The range belongs to the array: equal codes over another range are another array.
        let mut third = Arrays::default();
        third.push("a", NumberType::U8, &[0.0, 2.0, f64::NAN]);
        assert_eq!(third.without_those_of(&first).parts().count(), 1);
    }
}
