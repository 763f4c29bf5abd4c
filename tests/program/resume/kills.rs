//! SIGKILL at random moments: the files can be opened, and the run resumes to bit-identical
//! results.
//!
//! A few kills are made in the test suite, and a hundred every night (`.ci/nightly`), by
//! `FRETWORK_KILLS=100 cargo test --release --test program resume::kills -- --nocapture`.

use super::common::{Folder, IN_PLACE, Job, last_frame, marked, same};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::process::Stdio;
use std::time::{Duration, Instant};

fn kills() -> u32 {
    let kills = std::env::var("FRETWORK_KILLS");
    kills.ok().and_then(|n| n.parse().ok()).unwrap_or(5)
}

/// A file that is copied and replaced is never seen incomplete.
#[test]
fn kills_at_random_moments_lose_nothing() {
    kill_at_random("kills", 20, None);
}

/// Kills lose nothing of a file that grows in place, as large ones do: from the first flush on, or
/// after some flushes.
#[test]
fn kills_at_random_moments_lose_nothing_of_a_file_that_grows_in_place() {
    kill_at_random("kills-in-place", 21, Some("0"));
    kill_at_random("kills-on-the-way", 22, Some("2500000"));
}

/// Kills lose no fields of deformable bodies, which are the largest part of such a file.
#[test]
fn kills_at_random_moments_lose_no_fields_of_deformable_bodies() {
    let sets = [
        "time.end=0.012",
        "output.checkpoint=Steps(3)",
        "output.views=24",
        "output.frames=0",
        "output.figures=false",
    ];
    let job = Job {
        case: "cylinder_on_flat_fretting",
        sets: &sets,
    };
    kill_job(job, "kills-meshes", 23, Some("4000000"));
}

fn kill_at_random(name: &str, seed: u64, in_place: Option<&str>) {
    // Checkpoints and flushes are as frequent as possible, so that many kills meet one.
    let sets = [
        "time.end=0.012",
        "output.checkpoint=Steps(3)",
        "output.views=60",
        "output.frames=2",
        "output.figures=false",
    ];
    let job = Job {
        case: "shear_cell_3d",
        sets: &sets,
    };
    kill_job(job, name, seed, in_place);
}

fn kill_job(job: Job<'_>, name: &str, seed: u64, in_place: Option<&str>) {
    let kills = if in_place.is_some() {
        kills() / 2
    } else {
        kills()
    };
    let whole = Folder::new(&format!("{name}-whole"));
    let begun = Instant::now();
    job.done(&whole.0, &[]);
    let length = begun.elapsed();
    let mut rng = Pcg64::seed_from_u64(seed);
    let (mut killed, mut ended, mut with_file) = (0, 0, 0);
    let folder = Folder::new(name);
    while killed < kills {
        // Delays are short too: a kill may occur during the creation of the file, or its
        // replacement by the resumed one.
        let share: f64 = rng.random_range(0.0f64..1.0);
        let wait = length.mul_f64(share * share);
        let mut command = job.command(&folder.0, &["--resume"]);
        command.envs(in_place.map(|limit| (IN_PLACE, limit)));
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(wait.min(Duration::from_secs(60)));
        let before = child.try_wait().unwrap();
        child.kill().unwrap();
        child.wait().unwrap();
        if let Some(status) = before {
            assert!(status.success(), "{status}");
            same(&whole.0, &folder.0);
            std::fs::remove_dir_all(&folder.0).unwrap();
            ended += 1;
            continue;
        }
        killed += 1;
        if killed % 10 == 0 {
            println!("{killed} kills");
        }
        if folder.0.join("results.h5").exists() {
            with_file += 1;
            if in_place.is_none() {
                assert!(!marked(&folder.0.join("results.h5")), "after kill {killed}");
            }
            let frame = last_frame(&folder.0);
            assert!(frame.is_some(), "after kill {killed}: no whole checkpoint");
        }
    }
    job.done(&folder.0, &["--resume"]);
    same(&whole.0, &folder.0);
    println!(
        "{killed} kills, {with_file} of them left a file; {ended} runs came to their end between them"
    );
    assert!(with_file > 0);
}
