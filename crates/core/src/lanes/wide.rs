//! Lanes of several contacts: four in each of `U` groups of vector registers.

use super::{Lane, Mask, Record, SUMS};
use std::mem::MaybeUninit;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Four numbers in one or two vector registers. A comparison sets all bits of a number, or none.
pub(super) trait Four: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// Returns four copies of a number.
    fn all(x: f64) -> Self;
    /// Creates the register from four numbers.
    fn new(x: [f64; 4]) -> Self;
    /// Reads four numbers from memory.
    fn load(from: &[f64; 4]) -> Self;
    /// Writes the numbers to memory.
    fn store(self, to: &mut [f64; 4]);
    fn add(self, with: Self) -> Self;
    fn sub(self, with: Self) -> Self;
    fn mul(self, with: Self) -> Self;
    fn div(self, with: Self) -> Self;
    fn greatest(self, with: Self) -> Self;
    fn least(self, with: Self) -> Self;
    fn sqrt(self) -> Self;
    fn above(self, with: Self) -> Self;
    fn at_least(self, with: Self) -> Self;
    fn and(self, with: Self) -> Self;
    fn or(self, with: Self) -> Self;
    fn xor(self, with: Self) -> Self;
    /// Returns `yes` where a comparison holds, `no` elsewhere.
    fn select(mask: Self, yes: Self, no: Self) -> Self;
    /// Returns a bit for each number where a comparison holds.
    fn bits(self) -> i32;
    /// Reads columns of four numbers from each of four places.
    ///
    /// # Safety
    /// There must be four numbers at each place.
    unsafe fn load_columns(from: [*mut f64; 4]) -> [Self; 4];
    /// Reads columns of two numbers from each of four places.
    ///
    /// # Safety
    /// There must be two numbers at each place.
    unsafe fn load_pairs(from: [*mut f64; 4]) -> [Self; 2];
    /// Transposes four columns to rows.
    fn rows(columns: [Self; 4]) -> [Self; 4];
    /// Writes two columns to four places.
    ///
    /// # Safety
    /// There must be two numbers at each place.
    unsafe fn store_pairs(to: [*mut f64; 4], columns: [Self; 2]);
}

/// A number for each of `4 U` contacts.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<F, const U: usize>([F; U]);

/// A condition for each of these contacts.
#[derive(Clone, Copy)]
pub struct Conditions<F, const U: usize>([F; U]);

#[inline(always)]
fn by_group<F: Four, const U: usize>(mut a: [F; U], b: [F; U], of: impl Fn(F, F) -> F) -> [F; U] {
    for u in 0..U {
        a[u] = of(a[u], b[u]);
    }
    a
}

macro_rules! operator {
    ($trait:ident for $type:ident, $name:ident, $of:ident) => {
        impl<F: Four, const U: usize> $trait for $type<F, U> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, with: Self) -> Self {
                Self(by_group(self.0, with.0, F::$of))
            }
        }
    };
}
operator!(Add for Lanes, add, add);
operator!(Sub for Lanes, sub, sub);
operator!(Mul for Lanes, mul, mul);
operator!(Div for Lanes, div, div);
operator!(BitAnd for Conditions, bitand, and);
operator!(BitOr for Conditions, bitor, or);

impl<F: Four, const U: usize> Neg for Lanes<F, U> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(by_group(self.0, [F::all(-0.0); U], F::xor))
    }
}

impl<F: Four, const U: usize> Not for Conditions<F, U> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        let every = F::all(f64::from_bits(u64::MAX));
        Self(by_group(self.0, [every; U], F::xor))
    }
}

impl<F: Four, const U: usize> Mask for Conditions<F, U> {
    #[inline(always)]
    fn any(self) -> bool {
        let mut any = self.0[0];
        for u in 1..U {
            any = any.or(self.0[u]);
        }
        any.bits() != 0
    }
    #[inline(always)]
    fn all(self) -> bool {
        let mut all = self.0[0];
        for u in 1..U {
            all = all.and(self.0[u]);
        }
        all.bits() == ALL
    }
}

/// Calls a function with the first number of each group of four of `$count` numbers, and other
/// arguments.
macro_rules! by_fours {
    ($count:expr, $do:ident($($with:expr),*)) => {
        by_fours!($count, $do($($with),*), 0 4 8 12 16 20 24 28 32 36 40 44)
    };
    ($count:expr, $do:ident $with:tt, $($at:literal)+) => {
        const { assert!($count < 48) };
        // This is not a loop, so that the values stay in registers.
        $(if $at + 4 <= $count {
            by_fours!(call $do $at $with);
        })+
    };
    (call $do:ident $at:literal ($($with:expr),*)) => {
        $do($($with,)* $at)
    };
}

/// Reads the columns of four numbers from the `at`-th on.
///
/// # Safety
/// The records and `to` have as many numbers.
#[inline(always)]
unsafe fn gather_four<F: Four, T, const U: usize>(from: &[[*mut T; 4]; U], to: *mut F, at: usize) {
    for u in 0..U {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let columns = F::load_columns(numbers(&from[u], at));
            for k in 0..4 {
                to.add((at + k) * U + u).write(columns[k]);
            }
        }
    }
}

/// Reads the columns of two numbers.
///
/// # Safety
/// The conditions of [`gather_four`].
#[inline(always)]
unsafe fn gather_two<F: Four, T, const U: usize>(from: &[[*mut T; 4]; U], to: *mut F, at: usize) {
    for u in 0..U {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let columns = F::load_pairs(numbers(&from[u], at));
            for k in 0..2 {
                to.add((at + k) * U + u).write(columns[k]);
            }
        }
    }
}

/// Reads the column of one number.
///
/// # Safety
/// The conditions of [`gather_four`].
#[inline(always)]
unsafe fn gather_one<F: Four, T, const U: usize>(from: &[[*mut T; 4]; U], to: *mut F, at: usize) {
    for u in 0..U {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let [a, b, c, d] = numbers(&from[u], at);
            to.add(at * U + u).write(F::new([*a, *b, *c, *d]));
        }
    }
}

/// The places of the `at`-th numbers of four records.
///
/// # Safety
/// The records have as many numbers.
#[inline(always)]
unsafe fn numbers<T>([a, b, c, d]: &[*mut T; 4], at: usize) -> [*mut f64; 4] {
    // SAFETY: guaranteed by the caller.
    unsafe {
        [
            a.cast::<f64>().add(at),
            b.cast::<f64>().add(at),
            c.cast::<f64>().add(at),
            d.cast::<f64>().add(at),
        ]
    }
}

/// Writes four columns, starting at column `at`, for a group of contacts: to the records whose bits
/// are set.
///
/// # Safety
/// The written records and `from`, which has `U` groups, have as many numbers.
#[inline(always)]
unsafe fn scatter_four<F: Four, T, const U: usize>(
    to: &[*mut T; 4],
    bits: i32,
    from: *const F,
    _: GroupStride<U>,
    at: usize,
) {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let column = from.add(at * U);
        let rows = F::rows([
            *column,
            *column.add(U),
            *column.add(2 * U),
            *column.add(3 * U),
        ]);
        let to = numbers(to, at);
        for k in 0..4 {
            if bits == ALL || bits >> k & 1 == 1 {
                rows[k].store(&mut *to[k].cast());
            }
        }
    }
}

/// Writes a column.
///
/// # Safety
/// The conditions of [`scatter_four`].
#[inline(always)]
unsafe fn scatter_one<F: Four, T, const U: usize>(
    to: &[*mut T; 4],
    bits: i32,
    from: *const F,
    _: GroupStride<U>,
    at: usize,
) {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let (mut column, to) = ([0.0; 4], numbers(to, at));
        (*from.add(at * U)).store(&mut column);
        for k in 0..4 {
            if bits == ALL || bits >> k & 1 == 1 {
                *to[k] = column[k];
            }
        }
    }
}

/// Number of groups, which is the distance of columns.
struct GroupStride<const U: usize>;

/// The bits of four numbers.
const ALL: i32 = 15;

impl<F: Four, const U: usize> Lane for Lanes<F, U> {
    const WIDTH: usize = 4 * U;
    type Mask = Conditions<F, U>;
    type Each<T: Copy> = [[T; 4]; U];

    #[inline(always)]
    fn all(x: f64) -> Self {
        Self([F::all(x); U])
    }
    #[inline(always)]
    fn greatest(self, other: Self) -> Self {
        Self(by_group(self.0, other.0, F::greatest))
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self(by_group(self.0, other.0, F::least))
    }
    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for x in &mut self.0 {
            *x = x.sqrt();
        }
        self
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let magnitude = F::all(f64::from_bits(u64::MAX >> 1));
        Self(by_group(self.0, [magnitude; U], F::and))
    }
    #[inline(always)]
    fn with_sign_of(self, sign: Self) -> Self {
        let sign = by_group(sign.0, [F::all(-0.0); U], F::and);
        Self(by_group(self.abs().0, sign, F::or))
    }
    #[inline(always)]
    fn above(self, other: Self) -> Self::Mask {
        Conditions(by_group(self.0, other.0, F::above))
    }
    #[inline(always)]
    fn below(self, other: Self) -> Self::Mask {
        other.above(self)
    }
    #[inline(always)]
    fn at_least(self, other: Self) -> Self::Mask {
        Conditions(by_group(self.0, other.0, F::at_least))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        other.at_least(self)
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, mut no: Self) -> Self {
        for u in 0..U {
            no.0[u] = F::select(mask.0[u], yes.0[u], no.0[u]);
        }
        no
    }

    #[inline(always)]
    fn each<T: Copy>(of: impl Fn(usize) -> T) -> Self::Each<T> {
        let mut out = [[of(0); 4]; U];
        for u in 0..U {
            for k in 0..4 {
                out[u][k] = of(4 * u + k);
            }
        }
        out
    }
    #[inline(always)]
    fn map<T: Copy, V: Copy>(each: Self::Each<T>, of: impl Fn(T) -> V) -> Self::Each<V> {
        Self::each(|k| of(each[k / 4][k % 4]))
    }

    #[inline(always)]
    unsafe fn gather<T: Record>(from: Self::Each<*mut T>) -> T::With<Self> {
        const { assert!(size_of::<T::With<Self>>() == T::COUNT * size_of::<Self>()) };
        let mut out = MaybeUninit::<T::With<Self>>::uninit();
        let to = out.as_mut_ptr().cast::<F>();
        let (from, count) = (&from, T::COUNT);
        // SAFETY: guaranteed by the caller; `With` has the same numbers in the same order.
        unsafe {
            by_fours!(T::COUNT, gather_four(from, to));
            match count % 4 {
                3 if count > 4 => gather_four(from, to, count - 4),
                3 => {
                    gather_two(from, to, 0);
                    gather_one(from, to, 2);
                }
                2 => gather_two(from, to, count - 2),
                1 => gather_one(from, to, count - 1),
                _ => {}
            }
        }
        // SAFETY: all numbers of the record were written.
        unsafe { out.assume_init() }
    }

    #[inline(always)]
    unsafe fn scatter<T: Record>(to: Self::Each<*mut T>, value: &T::With<Self>) {
        // SAFETY: guaranteed by the caller.
        unsafe { scatter::<F, T, U>(to, value, [ALL; U]) }
    }

    #[inline(always)]
    unsafe fn scatter_where<T: Record>(
        mask: Self::Mask,
        to: Self::Each<*mut T>,
        value: &T::With<Self>,
    ) {
        // SAFETY: guaranteed by the caller.
        unsafe {
            let mut bits = [0; U];
            for u in 0..U {
                bits[u] = mask.0[u].bits();
            }
            scatter::<F, T, U>(to, value, bits)
        }
    }

    #[inline(always)]
    fn add_to(self, sums: &mut [f64; SUMS], _: usize) {
        let mut out = F::load(sums);
        for x in self.0 {
            out = out.add(x);
        }
        out.store(sums);
    }

    #[inline(always)]
    fn raise(self, most: &mut [f64; SUMS], most_at: &mut [f64; SUMS], at: usize) {
        let (mut greatest, mut place) = (F::load(most), F::load(most_at));
        for (u, x) in self.0.into_iter().enumerate() {
            let here = F::new([0, 1, 2, 3].map(|k| (at + 4 * u + k) as f64));
            let more = x.above(greatest);
            greatest = F::select(more, x, greatest);
            place = F::select(more, here, place);
        }
        greatest.store(most);
        place.store(most_at);
    }
}

/// Writes the records whose bits are set.
///
/// # Safety
/// The records must be valid, and nobody else may access them.
#[inline(always)]
unsafe fn scatter<F: Four, T: Record, const U: usize>(
    to: [[*mut T; 4]; U],
    value: &T::With<Lanes<F, U>>,
    bits: [i32; U],
) {
    let from = std::ptr::from_ref(value).cast::<F>();
    let count = T::COUNT;
    let end = count - count % 4;
    for u in 0..U {
        let (to, bits) = (&to[u], bits[u]);
        // SAFETY: guaranteed by the caller; `With` has the same numbers in the same order.
        unsafe {
            let from = from.add(u);
            if bits == ALL {
                by_fours!(T::COUNT, scatter_four(to, ALL, from, GroupStride::<U>));
            } else {
                by_fours!(T::COUNT, scatter_four(to, bits, from, GroupStride::<U>));
            }
            if count % 4 >= 2 && bits == ALL {
                let columns = [*from.add(end * U), *from.add((end + 1) * U)];
                F::store_pairs(numbers(to, end), columns);
            } else if count % 4 >= 2 {
                scatter_one(to, bits, from, GroupStride::<U>, end);
                scatter_one(to, bits, from, GroupStride::<U>, end + 1);
            }
            if count % 2 == 1 {
                scatter_one(to, bits, from, GroupStride::<U>, count - 1);
            }
        }
    }
}
