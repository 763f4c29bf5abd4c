//! Four contacts at once in the lanes of a vector register. The operations and their order are those of a
//! single contact, so that results are bitwise identical.

mod frame;
mod lever;
#[cfg(test)]
mod tests;
mod vector;
mod wide;

pub use frame::{Moving, Tuple};
pub use vector::{Lanes, Records};
pub use wide::Wide;

use super::visit::Visit;
use super::{Bonded, FullRow, LeverRow, Loose, PlainRow, Row, SolverBodies, SolverBody};
use crate::geometry::space::{Dim2, Dim3, Space};
use std::any::TypeId;
use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

/// Vector instructions that a machine has. AVX-512 is used for its registers, which are twice as many; the code is written for 256 bits. It comes with fused
/// multiplication and addition, which the compiler does not form from separate operations, so that the bits are the same.
#[derive(Clone, Copy, Debug)]
pub(super) enum Instructions {
    Avx2,
    Avx512,
}

impl Instructions {
    /// The best that this machine has.
    fn of_this_machine() -> Option<Self> {
        // What the features of `all_avx512` imply, too.
        let avx512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("f16c");
        if !is_x86_feature_detected!("avx2") {
            None
        } else if avx512 {
            Some(Self::Avx512)
        } else {
            Some(Self::Avx2)
        }
    }
}

/// Visits a block of rows, see [`super::visit::visit`]; returns whether this machine and these rows support
/// vector instructions.
pub fn visit<S: Space, R: Row<S>>(
    rows: &mut [R],
    groups: &[u32],
    solver_bodies: &SolverBodies<S>,
    what: &mut impl Visit,
) -> bool {
    match Instructions::of_this_machine() {
        // SAFETY: the machine has them.
        Some(with) => unsafe { visit_with(with, rows, groups, solver_bodies, what) },
        None => false,
    }
}

/// Visits a block of rows as [`visit`] does.
///
/// # Safety
/// The machine has the instructions; bodies and groups are as [`visit`] asks.
unsafe fn visit_with<S: Space, R: Row<S>>(
    with: Instructions,
    rows: &mut [R],
    groups: &[u32],
    solver_bodies: &SolverBodies<S>,
    what: &mut impl Visit,
) -> bool {
    let (count, first, solver_bodies) = (rows.len(), rows.as_mut_ptr(), solver_bodies.at(0));
    debug_assert!(groups.last().map(|end| (end - groups[0]) as usize) == Some(count));
    macro_rules! of {
        ($($row:ty),*) => {$(
            if TypeId::of::<R>() == TypeId::of::<$row>() {
                let rows = first.cast::<$row>();
                // SAFETY: the machine has the instructions, the type was checked, and body indices satisfy the
                // contract of `SolverBodies`.
                unsafe {
                    match with {
                        Instructions::Avx2 => all_avx2(rows, groups, count, solver_bodies.cast(), what),
                        Instructions::Avx512 => all_avx512(rows, groups, count, solver_bodies.cast(), what),
                    }
                };
                return true;
            }
        )*};
    }
    of!(
        PlainRow<Dim2>,
        FullRow<Dim2>,
        LeverRow<Dim2, Loose<Dim2>>,
        LeverRow<Dim2, Bonded<Dim2>>,
        PlainRow<Dim3>,
        FullRow<Dim3>
    );
    false
}

/// # Safety
/// As for [`all`], on a machine with AVX2.
#[target_feature(enable = "avx2")]
unsafe fn all_avx2<W: Wide, V: Visit>(
    rows: *mut W,
    groups: &[u32],
    count: usize,
    solver_bodies: *mut SolverBody<W::Space>,
    what: &mut V,
) {
    // SAFETY: as asked for.
    unsafe { all(rows, groups, count, solver_bodies, what) }
}

/// # Safety
/// As for [`all`], on a machine with AVX-512.
#[target_feature(enable = "avx2,avx512f,avx512vl,avx512dq")]
unsafe fn all_avx512<W: Wide, V: Visit>(
    rows: *mut W,
    groups: &[u32],
    count: usize,
    solver_bodies: *mut SolverBody<W::Space>,
    what: &mut V,
) {
    // SAFETY: as asked for.
    unsafe { all(rows, groups, count, solver_bodies, what) }
}

/// Inlined into the two functions above, which are compiled for their instructions.
///
/// # Safety
/// There are `count` rows, of bodies of `solver_bodies`; their groups are as `visit` says. Only those two functions call it.
#[inline(always)]
unsafe fn all<W: Wide, V: Visit>(
    rows: *mut W,
    groups: &[u32],
    count: usize,
    solver_bodies: *mut SolverBody<W::Space>,
    what: &mut V,
) {
    let mut idle = Idle {
        row: W::idle(),
        body: SolverBody::idle(),
    };
    for group in groups.windows(2) {
        let [mut first, end] = [group[0], group[1]].map(|k| (k - groups[0]) as usize);
        // SAFETY: as above; bodies of contacts taken together differ where they are written.
        unsafe {
            while V::TWO_REGISTERS && W::Space::D == 3 && first + 4 < end {
                let idle = &mut idle;
                let one = Four::new(rows, [first, end, count], solver_bodies, idle);
                let two = Four::new(rows, [first + 4, end, count], solver_bodies, idle);
                what.visit_wide(&[one.row, two.row], &[one.a, two.a], &[one.b, two.b], first);
                first += 8;
            }
            while first < end {
                let one = Four::new(rows, [first, end, count], solver_bodies, &mut idle);
                what.visit_wide(&[one.row], &[one.a], &[one.b], first);
                first += 4;
            }
        }
    }
}

/// Fills the lanes without a contact: their bodies are immovable, and nothing is stored.
struct Idle<W: Wide> {
    row: W,
    body: SolverBody<W::Space>,
}

/// Four rows and the records of their bodies.
struct Four<W: Wide> {
    row: [*mut W; 4],
    a: [*mut SolverBody<W::Space>; 4],
    b: [*mut SolverBody<W::Space>; 4],
}

/// Prefetch distance in contacts.
const AHEAD: usize = 16;

impl<W: Wide> Four<W> {
    /// Loads the rows from `first` up to at most `end`, the end of the group.
    ///
    /// # Safety
    /// There are `count` rows, whose bodies are in `solver_bodies`.
    #[inline(always)]
    unsafe fn new(
        rows: *mut W,
        [first, end, count]: [usize; 3],
        solver_bodies: *mut SolverBody<W::Space>,
        idle: &mut Idle<W>,
    ) -> Self {
        // SAFETY: as above.
        unsafe {
            if first + AHEAD + 4 <= count {
                for k in 0..4 {
                    for body in (*rows.add(first + AHEAD + k)).bodies() {
                        _mm_prefetch::<_MM_HINT_T0>(solver_bodies.add(body as usize).cast());
                    }
                }
            }
            if first + 4 <= end {
                let row = [0, 1, 2, 3].map(|k| rows.add(first + k));
                return Self {
                    row,
                    a: row.map(|r| solver_bodies.add((*r).bodies()[0] as usize)),
                    b: row.map(|r| solver_bodies.add((*r).bodies()[1] as usize)),
                };
            }
            let body = &raw mut idle.body;
            let mut four = Self {
                row: [&raw mut idle.row; 4],
                a: [body; 4],
                b: [body; 4],
            };
            for k in 0..end.saturating_sub(first) {
                let row = rows.add(first + k);
                four.row[k] = row;
                four.a[k] = solver_bodies.add((*row).bodies()[0] as usize);
                four.b[k] = solver_bodies.add((*row).bodies()[1] as usize);
            }
            four
        }
    }
}
