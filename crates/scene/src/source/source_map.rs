//! Map from the text in use back to the file and the `--set` arguments it is made of.

use std::ops::Range;

/// A contiguous range of the text in use.
#[derive(Debug, Clone)]
struct SourceRange {
    length: usize,
    from: RangeOrigin,
}

/// Origin of a range of the text.
#[derive(Debug, Clone)]
enum RangeOrigin {
    /// The file, from this byte on.
    File(usize),
    /// Inserted by the parser for the text at this byte of the file.
    Added(usize),
    /// Written in place of these bytes of the file.
    InPlaceOf(Range<usize>),
    /// A `--set` argument.
    Set {
        /// Index.
        set: usize,
        /// Byte range in the argument.
        argument: Range<usize>,
        /// Byte range of the file that it replaced.
        landed: Range<usize>,
    },
}

/// Location of a range of the text in use.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RangeLocation {
    /// Byte range in the file.
    pub span: Range<usize>,
    /// Index of the `--set` that contained the text, and the byte range in its argument.
    pub set: Option<(usize, Range<usize>)>,
}

/// The text in use, as ranges of the file and of `--set` arguments.
///
/// Maps positions in the modified text to positions in the file, whose line numbers are the only
/// ones that the user can look up.
#[derive(Debug, Clone, Default)]
pub(super) struct SourceMap(Vec<SourceRange>);

impl SourceMap {
    /// Returns the map of an unmodified file of this length.
    pub fn whole(length: usize) -> Self {
        let from = RangeOrigin::File(0);
        Self(vec![SourceRange { length, from }])
    }

    /// Adds text to the end that is the file's own from this byte on.
    pub fn push_from(&mut self, length: usize, file: usize) {
        let from = RangeOrigin::File(file);
        self.0.push(SourceRange { length, from });
    }

    /// Adds text to the end that stands for these bytes of the file.
    pub fn push_for(&mut self, length: usize, file: Range<usize>) {
        let from = RangeOrigin::InPlaceOf(file);
        self.0.push(SourceRange { length, from });
    }

    /// Returns the location of a range of the text in use.
    pub fn place(&self, span: &Range<usize>) -> RangeLocation {
        self.place_in(span, &self.starts())
    }

    /// Returns the location of a range of the text in use, where the ranges begin at `starts`.
    fn place_in(&self, span: &Range<usize>, starts: &[usize]) -> RangeLocation {
        let (start, first) = self.range_at(span.start, starts);
        match &first.from {
            RangeOrigin::Set {
                set,
                argument,
                landed,
            } => {
                let exact = argument.len() == first.length;
                let shift =
                    |at: usize| argument.start + at.saturating_sub(start).min(argument.len());
                let within = if exact {
                    shift(span.start)..shift(span.end).max(shift(span.start))
                } else {
                    argument.clone()
                };
                RangeLocation {
                    span: landed.clone(),
                    set: Some((*set, within)),
                }
            }
            RangeOrigin::Added(file) => RangeLocation {
                span: *file..*file,
                set: None,
            },
            RangeOrigin::InPlaceOf(file) => RangeLocation {
                span: file.clone(),
                set: None,
            },
            RangeOrigin::File(file) => {
                let begin = file + (span.start - start).min(first.length);
                let (last_start, last) =
                    self.range_at(span.end.saturating_sub(1).max(span.start), starts);
                let end = match &last.from {
                    RangeOrigin::File(file) => {
                        file + (span.end - last_start.min(span.end)).min(last.length)
                    }
                    RangeOrigin::Added(file) => *file,
                    RangeOrigin::InPlaceOf(file) => file.end,
                    RangeOrigin::Set { landed, .. } => landed.end,
                };
                RangeLocation {
                    span: begin..end.max(begin),
                    set: None,
                }
            }
        }
    }

    /// Returns the range that contains a byte (the last one, for the end of the text), and its
    /// start.
    fn range_at(&self, at: usize, starts: &[usize]) -> (usize, &SourceRange) {
        const NOTHING: &SourceRange = &SourceRange {
            length: 0,
            from: RangeOrigin::File(0),
        };
        let k = starts.partition_point(|start| *start <= at);
        let k = k.saturating_sub(1);
        match (self.0.get(k), starts.get(k)) {
            (Some(piece), Some(start)) => (*start, piece),
            _ => (0, NOTHING),
        }
    }

    /// Records text inserted by the parser before a byte.
    pub fn insert(&mut self, at: usize, length: usize) {
        let place = self.place(&(at..at));
        let from = match place.set {
            Some((set, argument)) => RangeOrigin::Set {
                set,
                argument: argument.start..argument.start,
                landed: place.span,
            },
            None => RangeOrigin::Added(place.span.start),
        };
        let mut pieces = Vec::with_capacity(self.0.len() + 2);
        let mut start = 0;
        let mut new = Some(SourceRange { length, from });
        for piece in &self.0 {
            let end = start + piece.length;
            if at < end && new.is_some() {
                let left = at.saturating_sub(start);
                if left > 0 {
                    pieces.push(piece.part(0, left));
                }
                pieces.extend(new.take());
                pieces.push(piece.part(left, piece.length - left));
            } else {
                pieces.push(piece.clone());
            }
            start = end;
        }
        pieces.extend(new);
        self.0 = pieces;
    }

    /// Records that a `--set` replaced `range`: lengths, and byte ranges of the argument.
    pub fn replace(&mut self, range: &Range<usize>, set: usize, parts: &[(usize, Range<usize>)]) {
        let landed = self.place(range).span;
        let parts = parts.iter().map(|(length, argument)| SourceRange {
            length: *length,
            from: RangeOrigin::Set {
                set,
                argument: argument.clone(),
                landed: landed.clone(),
            },
        });
        self.splice(range, parts.collect());
    }

    /// Replaces ranges of the text, in their order and apart from each other, by texts of these
    /// lengths that stand for them.
    pub fn rewrite_all(&mut self, edits: &[(Range<usize>, usize)]) {
        let starts = self.starts();
        let mut pieces = Vec::with_capacity(self.0.len() + 2 * edits.len());
        let mut k = 0;
        let mut copy = |pieces: &mut Vec<SourceRange>, from: usize, to: usize| {
            while let Some(piece) = self.0.get(k) {
                let (start, end) = (starts[k], starts[k] + piece.length);
                let (begin, stop) = (from.max(start), to.min(end));
                if begin < stop {
                    pieces.push(piece.part(begin - start, stop - begin));
                }
                if end > to {
                    break;
                }
                k += 1;
            }
        };
        let mut at = 0;
        for (range, length) in edits {
            copy(&mut pieces, at, range.start);
            let from = match self.place_in(range, &starts) {
                RangeLocation {
                    span,
                    set: Some((set, argument)),
                } => RangeOrigin::Set {
                    set,
                    argument,
                    landed: span,
                },
                RangeLocation { span, .. } => RangeOrigin::InPlaceOf(span),
            };
            let length = *length;
            pieces.push(SourceRange { length, from });
            at = range.end;
        }
        copy(&mut pieces, at, usize::MAX);
        self.0 = pieces;
    }

    /// The byte at which each range begins.
    fn starts(&self) -> Vec<usize> {
        let begin = |at: &mut usize, piece: &SourceRange| {
            let start = *at;
            *at += piece.length;
            Some(start)
        };
        self.0.iter().scan(0, begin).collect()
    }

    fn splice(&mut self, range: &Range<usize>, parts: Vec<SourceRange>) {
        let mut pieces = Vec::with_capacity(self.0.len() + parts.len() + 1);
        let mut after = Vec::new();
        let mut start = 0;
        for piece in &self.0 {
            let end = start + piece.length;
            if start < range.start {
                pieces.push(piece.part(0, range.start.min(end) - start));
            }
            if end > range.end {
                let cut = range.end.max(start) - start;
                after.push(piece.part(cut, piece.length - cut));
            }
            start = end;
        }
        pieces.extend(parts);
        pieces.extend(after);
        self.0 = pieces;
    }
}

impl SourceRange {
    fn part(&self, skip: usize, length: usize) -> SourceRange {
        let from = match &self.from {
            RangeOrigin::File(start) => RangeOrigin::File(start + skip),
            RangeOrigin::Added(at) => RangeOrigin::Added(*at),
            RangeOrigin::InPlaceOf(file) => RangeOrigin::InPlaceOf(file.clone()),
            RangeOrigin::Set {
                set,
                argument,
                landed,
            } => {
                let begin = argument.start + skip;
                let exact = argument.len() == self.length;
                RangeOrigin::Set {
                    set: *set,
                    argument: if exact {
                        begin..begin + length
                    } else {
                        argument.clone()
                    },
                    landed: landed.clone(),
                }
            }
        };
        SourceRange { length, from }
    }
}
