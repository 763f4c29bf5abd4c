//! Damaged files, equal in every run: for any bytes, reading returns a problem or an error message,
//! quickly and with little memory.

use super::shared;
use fretwork::record::fclib::{self, FclibError};
use fretwork::solve::local::Reduction;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::time::{Duration, Instant};

thread_local! {
    /// Largest single allocation of this thread so far, since other tests of this program run in
    /// parallel.
    static LARGEST: Cell<usize> = const { Cell::new(0) };
}

fn asked_for(bytes: usize) {
    // A thread that is ending has no such variable any more.
    let _ = LARGEST.try_with(|l| l.set(l.get().max(bytes)));
}

struct Watched;

// SAFETY: every call is passed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Watched {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        asked_for(layout.size());
        // SAFETY: the caller fulfils the contract of the allocator.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        asked_for(layout.size());
        // SAFETY: the caller fulfils the contract of the allocator.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        asked_for(size);
        // SAFETY: the caller fulfils the contract of the allocator.
        unsafe { System.realloc(at, layout, size) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: the caller fulfils the contract of the allocator.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static WATCHED: Watched = Watched;

/// Limit on a single allocation; the files have some ten to thirty thousand bytes.
const MAX_ALLOCATION: usize = 4 << 20;

/// Bytes that are most likely to cause errors in sizes and addresses.
const EXTREMES: [u8; 6] = [0x00, 0x01, 0x7f, 0x80, 0xfe, 0xff];

fn damaged(bytes: &[u8], rng: &mut Pcg64) -> Vec<u8> {
    let mut out = bytes.to_vec();
    // The structure is a small part of the file: half of the hits aim at bytes that are not zero.
    let aim = |rng: &mut Pcg64, out: &[u8]| {
        let at = rng.random_range(0..out.len());
        match rng.random_range(0..2) {
            0 => at,
            _ => (at..out.len()).find(|k| out[*k] != 0).unwrap_or(at),
        }
    };
    for _ in 0..rng.random_range(1..=4) {
        let at = aim(rng, &out);
        match rng.random_range(0..6) {
            0 => out[at] ^= 1 << rng.random_range(0..8),
            1 => out[at] = EXTREMES[rng.random_range(0..EXTREMES.len())],
            2 => out[at] = rng.random_range(0..=255),
            3 => {
                let end = (at + rng.random_range(1..=8)).min(out.len());
                let x = EXTREMES[rng.random_range(0..EXTREMES.len())];
                out[at..end].fill(x);
            }
            4 => {
                // The replacement is a number of eight bytes from elsewhere in the file: an
                // existing address.
                let from = aim(rng, &out);
                let count = 8.min(out.len() - at.max(from));
                out.copy_within(from..from + count, at);
            }
            _ if rng.random_range(0..4) == 0 => out.truncate(at.max(1)),
            _ => out[at] = out[at].wrapping_add(1),
        }
    }
    out
}

#[test]
fn damaged_files_are_refused_without_a_panic() {
    // The files are small, so that their structure is hit often; the last is in the newer format,
    // with checksums and attributes.
    let files = [
        "gfc3d_Example00_badly_scaled.hdf5",
        "fc2d_SliderCrankLagrangian00000.hdf5",
        "foreign_types.hdf5",
    ]
    .map(|name| std::fs::read(shared(name)).unwrap());
    let rounds: usize = std::env::var("FRETWORK_FUZZ_ROUNDS").map_or(2000, |n| n.parse().unwrap());
    let name = format!("fretwork-fclib-damage-{}.hdf5", std::process::id());
    let path = std::env::temp_dir().join(name);
    let mut rng =
        Pcg64::seed_from_u64(std::env::var("FRETWORK_FUZZ_SEED").map_or(7, |n| n.parse().unwrap()));
    let (mut read, mut refused, mut slowest, mut most) = (0, 0, Duration::ZERO, 0);
    let mut kinds = std::collections::BTreeMap::<String, usize>::new();
    for round in 0..rounds {
        let bytes = damaged(&files[round % files.len()], &mut rng);
        std::fs::write(&path, &bytes).unwrap();
        LARGEST.set(0);
        let start = Instant::now();
        let result = fclib::read(&path);
        fclib::read_solution(&path).ok();
        slowest = slowest.max(start.elapsed());
        let largest = LARGEST.get();
        most = most.max(largest);
        let keep = || {
            let kept = path.with_extension("kept.hdf5");
            std::fs::write(&kept, &bytes).unwrap();
            kept
        };
        if largest > MAX_ALLOCATION {
            panic!(
                "round {round}: {largest} bytes at once, {}",
                keep().display()
            );
        }
        match result {
            Ok(problem) => {
                read += 1;
                if let fclib::Problem::Global(g) = problem {
                    Reduction::new(&g.problem).ok();
                }
            }
            Err(e) => {
                refused += 1;
                let said = e.to_string();
                assert!(
                    said.contains(&*path.to_string_lossy()) && said.len() > 40,
                    "{said}"
                );
                *kinds.entry(kind(&e)).or_default() += 1;
            }
        }
    }
    std::fs::remove_file(&path).ok();
    eprintln!("{read} read, {refused} refused {kinds:?}, slowest {slowest:?}, largest {most}");
    // Both results must occur often enough for the test to be meaningful.
    assert!(
        read > rounds / 10 && refused > rounds / 10,
        "{read} read, {refused} refused"
    );
    assert!(slowest < Duration::from_secs(2), "{slowest:?}");
}

fn kind(e: &FclibError) -> String {
    let text = format!("{e:?}");
    text.split(' ').next().unwrap_or_default().to_owned()
}

#[test]
fn every_length_of_a_cut_file_is_refused_or_read() {
    let bytes = std::fs::read(shared("fc2d_SliderCrankLagrangian00000.hdf5")).unwrap();
    let name = format!("fretwork-fclib-cut-{}.hdf5", std::process::id());
    let path = std::env::temp_dir().join(name);
    for length in (0..bytes.len()).step_by(37).chain([1, 7, 8, 9, 95, 96, 97]) {
        std::fs::write(&path, &bytes[..length]).unwrap();
        let e = fclib::read(&path).unwrap_err();
        match length {
            0..8 => assert!(matches!(e, FclibError::NotHdf5 { .. }), "{length}: {e}"),
            _ => assert!(!matches!(e, FclibError::NotHdf5 { .. }), "{length}: {e}"),
        }
    }
    std::fs::remove_file(&path).ok();
}
