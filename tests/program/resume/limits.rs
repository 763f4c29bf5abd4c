//! Limits of the system on a run, on its time and on the size of its files: it ends with a message,
//! and can be resumed when the limit is lifted.

use super::common::{Folder, Job, last_frame, said, same};
use fretwork::record::checkpoint::FrameKind;
use std::path::Path;
use std::process::{Command, Output};

/// A table that is larger than the results file: every step has a row of digits.
const SETS: [&str; 6] = [
    "output.checkpoint=Never",
    "output.frames=0",
    "output.views=0",
    "output.figures=false",
    "output.every=1",
    "time.end=3.0",
];

const JOB: Job<'static> = Job {
    case: "verification/energy",
    sets: &SETS,
};

/// Starts a run in a shell that has set a limit.
fn limited(limit: &str, job: &Job<'_>, out: &Path, extra: &[&str]) -> Output {
    let run = job.command(out, extra);
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("ulimit {limit} && exec \"$@\""), "sh"])
        .arg(run.get_program())
        .args(run.get_args())
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    shell.output().unwrap()
}

fn size(out: &Path, name: &str) -> u64 {
    std::fs::metadata(out.join(name)).map_or(0, |m| m.len())
}

/// Unit of a shell's limit on the size of files (bytes).
fn block() -> u64 {
    let reported = Command::new("sh")
        .args([
            "-c",
            "ulimit -f 8 && head -c 100000 /dev/zero | cat > \"$0\"; exec true",
        ])
        .arg(std::env::temp_dir().join(format!("fretwork-block-{}", std::process::id())))
        .output();
    let path = std::env::temp_dir().join(format!("fretwork-block-{}", std::process::id()));
    let block = std::fs::metadata(&path).unwrap().len() / 8;
    std::fs::remove_file(&path).unwrap();
    assert!(reported.is_ok() && [512, 1024].contains(&block), "{block}");
    block
}

/// The table grows beyond the limit, and the results do not: their state is saved, and the run
/// continues without the limit.
#[test]
fn a_table_that_may_not_grow_leaves_a_state() {
    let (whole, out) = (Folder::new("limit-whole"), Folder::new("limit"));
    JOB.done(&whole.0, &["--no-report"]);
    let (table, results) = (
        size(&whole.0, "statistics.csv"),
        size(&whole.0, "results.h5"),
    );
    // The limit has room for most of the rows.
    let limit = (table * 3 / 4).max(results) / block();
    assert!(limit * block() < table, "{table} {results}");
    let reported = limited(&format!("-f {limit}"), &JOB, &out.0, &["--no-report"]);
    let reported = said(&reported, 1);
    assert!(
        reported.contains("statistics.csv") && reported.contains("ulimit -f"),
        "{reported}"
    );
    assert!(last_frame(&out.0).is_some_and(|f| f.kind == FrameKind::State));
    let reported = JOB.done(&out.0, &["--resume", "--no-report"]);
    assert!(reported.contains("resuming the run"), "{reported}");
    same(&whole.0, &out.0);
}

/// `ulimit -t` sets the soft and the hard limit to equal times.
#[test]
fn a_limit_on_time_ends_a_run_with_a_sentence() {
    let long = [&SETS[..5], &["time.end=1000.0"]].concat();
    let job = Job {
        case: JOB.case,
        sets: &long,
    };
    let out = Folder::new("limit-time");
    let reported = said(&limited("-t 4", &job, &out.0, &["--no-report"]), 1);
    assert!(
        reported.contains(
            "interrupted by SIGXCPU (the limit on the time of the processor, ulimit -t) after step"
        ),
        "{reported}"
    );
    assert!(last_frame(&out.0).is_some_and(|f| f.kind == FrameKind::State));
}
