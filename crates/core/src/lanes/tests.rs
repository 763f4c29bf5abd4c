//! Operations on several numbers give the same bits as on one.

use super::{InstructionSet, Lane, Mask, Wide};

/// Numbers of all kinds: zeros, subnormal numbers, infinities, NaN.
const NUMBERS: [f64; 12] = [
    0.0,
    -0.0,
    1.0,
    -1.5,
    f64::MIN_POSITIVE,
    5e-324,
    f64::MAX,
    -f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    3.7e-9,
];

/// Returns the results of all operations on two numbers in each lane.
fn results<L: Lane>(a: L, b: L) -> Vec<L> {
    let choose = |mask: L::Mask| L::select(mask, L::all(1.0), L::all(2.0));
    vec![
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        a.greatest(b),
        a.least(b),
        a.sqrt(),
        a.abs(),
        a.with_sign_of(b),
        choose(a.above(b)),
        choose(a.below(b)),
        choose(a.at_least(b)),
        choose(a.at_most(b)),
        choose(!a.above(b)),
        choose(a.above(b) & a.above(L::all(0.0))),
        choose(a.above(b) | a.above(L::all(0.0))),
        L::select(a.above(b), a, b),
    ]
}

/// Returns the number of each lane.
fn numbers<L: Lane>(of: impl Fn(usize) -> f64) -> L {
    let numbers: Vec<f64> = (0..L::WIDTH).map(of).collect();
    let each = L::each(|k| (&raw const numbers[k]).cast_mut());
    // SAFETY: the addresses are those of numbers.
    unsafe { L::gather(each) }
}

/// Returns the number in a lane.
fn lane<L: Lane>(x: L, k: usize) -> f64 {
    let mut out = vec![0.0; L::WIDTH];
    let first = out.as_mut_ptr();
    // SAFETY: there are as many numbers as lanes.
    unsafe { L::scatter(L::each(|k| first.add(k)), &x) };
    out[k]
}

/// Compares the operations on several numbers with those on one.
struct Compare;

fn compare<L: Lane>() {
    let count = NUMBERS.len();
    for at in 0..count * count {
        let of = |k: usize| [NUMBERS[(at + k) % count], NUMBERS[(at + k) / count % count]];
        let (a, b): (L, L) = (numbers(|k| of(k)[0]), numbers(|k| of(k)[1]));
        let several = results(a, b);
        for k in 0..L::WIDTH {
            let [x, y] = of(k);
            for (which, one) in results(x, y).into_iter().enumerate() {
                let found = lane(several[which], k);
                let same = found.to_bits() == one.to_bits() || found.is_nan() && one.is_nan();
                assert!(same, "operation {which} of {x} and {y}: {found}, not {one}");
            }
        }
        let all = (0..L::WIDTH).all(|k| of(k)[0] > of(k)[1]);
        let any = (0..L::WIDTH).any(|k| of(k)[0] > of(k)[1]);
        assert_eq!((a.above(b).all(), a.above(b).any()), (all, any));
    }
}

impl Wide for Compare {
    #[inline(always)]
    fn run<L4: Lane, L8: Lane>(self) {
        compare::<L4>();
        compare::<L8>();
    }
}

#[test]
fn all_widths_compute_the_same() {
    for with in InstructionSet::of_this_machine() {
        // SAFETY: the machine has these instructions.
        unsafe { with.run(Compare) };
    }
}
