//! A folder belongs to one run: another run or resumption in it, or a report of it meanwhile, is
//! rejected and changes nothing.

use super::common::{Folder, IN_PLACE, Job, files, last_frame, said, same};
use fretwork::record::checkpoint::FrameKind;
use fretwork_store::folder_lock::{FolderLock, RUN_LOCK};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// The run is long enough to be met.
const SETS: [&str; 3] = [
    "output.checkpoint=Steps(50)",
    "output.frames=0",
    "output.every=1",
];

const JOB: Job<'static> = Job {
    case: "verification/energy",
    sets: &SETS,
};

fn report(out: &Path) -> std::process::Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
    command.arg("report").arg(out).output().unwrap()
}

fn refused(output: &std::process::Output, words: &str) {
    let reported = said(output, 2);
    assert!(reported.contains(words), "{reported}");
}

/// Whether a run owns the folder.
fn held(out: &Path) -> bool {
    FolderLock::shared(out, RUN_LOCK).is_err()
}

/// Tries all commands in the folder while a run, new or resumed, writes there.
fn all_refused(out: &Path) {
    let words = "another run is writing in";
    let before = files(out).len();
    refused(&JOB.run(out, &[]), words);
    refused(&JOB.run(out, &["--resume"]), words);
    refused(&report(out), "a run is writing in it");
    assert_eq!(files(out).len(), before);
}

#[test]
fn a_folder_is_one_runs() {
    let whole = Folder::new("owner-whole");
    JOB.done(&whole.0, &[]);
    let out = Folder::new("owner");
    for more in [&[][..], &["--resume"]] {
        let mut child = JOB.start(&out.0, more);
        let begun = Instant::now();
        while last_frame(&out.0).is_none_or(|f| f.kind != FrameKind::State) || !held(&out.0) {
            assert!(begun.elapsed() < Duration::from_secs(300), "no checkpoint");
            std::thread::sleep(Duration::from_millis(2));
        }
        // The process is stopped, so that it does not end meanwhile.
        let stop = |number: i32| {
            // SAFETY: no memory is touched; the child has not been waited for, so the number is its
            // own.
            assert_eq!(unsafe { libc::kill(child.id() as libc::pid_t, number) }, 0);
        };
        stop(libc::SIGSTOP);
        // The process may continue for a moment, and complete a file.
        let mut status = 0;
        // SAFETY: the child has not been waited for, and the status is a local variable.
        let of =
            unsafe { libc::waitpid(child.id() as libc::pid_t, &raw mut status, libc::WUNTRACED) };
        assert!(
            of == child.id() as libc::pid_t && libc::WIFSTOPPED(status),
            "{status}"
        );
        all_refused(&out.0);
        stop(libc::SIGCONT);
        child.kill().unwrap();
        child.wait().unwrap();
    }
    // The system releases the lock of a killed run; the results are bit-identical to those of an
    // undisturbed run.
    JOB.done(&out.0, &["--resume"]);
    same(&whole.0, &out.0);
    said(&report(&out.0), 0);
}

/// A run that is stopped once it has saved a state.
struct Held(std::process::Child);

impl Held {
    fn start(out: &Path) -> Self {
        let mut command = JOB.command(out, &[]);
        command
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::piped());
        let held = Self(command.spawn().unwrap());
        let begun = Instant::now();
        while last_frame(out).is_none_or(|f| f.kind != FrameKind::State) {
            assert!(begun.elapsed() < Duration::from_secs(300), "no checkpoint");
            std::thread::sleep(Duration::from_millis(2));
        }
        held.signal(libc::SIGSTOP);
        // The signal is on its way; until it has arrived the run may still complete a file.
        let mut status = 0;
        // SAFETY: the status is a local variable, and a stopped child is not reaped.
        let stopped =
            unsafe { libc::waitpid(held.0.id() as libc::pid_t, &raw mut status, libc::WUNTRACED) };
        assert!(stopped > 0 && libc::WIFSTOPPED(status), "status {status}");
        held
    }

    fn signal(&self, number: i32) {
        // SAFETY: no memory is touched; the child has not been waited for, so the number is its
        // own.
        assert_eq!(unsafe { libc::kill(self.0.id() as libc::pid_t, number) }, 0);
    }

    /// Continues the run, which must find its folder lost.
    fn loses_its_folder(self, out: &Path) {
        self.signal(libc::SIGCONT);
        let output = self.0.wait_with_output().unwrap();
        let reported = said(&output, 1);
        let words = format!("the folder {}", out.display());
        assert!(
            reported.contains(&words)
                && reported.contains("removed or replaced while the run wrote into it"),
            "{reported}"
        );
    }
}

/// If the folder of a run is removed or moved, the run writes nothing more there, and another run
/// is not disturbed.
#[test]
fn a_folder_that_is_removed_or_moved_is_no_runs() {
    let whole = Folder::new("lost-whole");
    JOB.done(&whole.0, &[]);
    // The folder is removed, and used by another run.
    let out = Folder::new("lost");
    let first = Held::start(&out.0);
    std::fs::remove_dir_all(&out.0).unwrap();
    JOB.done(&out.0, &[]);
    first.loses_its_folder(&out.0);
    same(&whole.0, &out.0);
    // The folder is removed, and used by nobody: it is not created again.
    std::fs::remove_dir_all(&out.0).unwrap();
    let alone = Held::start(&out.0);
    std::fs::remove_dir_all(&out.0).unwrap();
    alone.loses_its_folder(&out.0);
    assert!(!out.0.exists());
    // The folder is moved: the run can be resumed at the new place.
    let moved = Folder::new("lost-moved");
    let third = Held::start(&out.0);
    std::fs::rename(&out.0, &moved.0).unwrap();
    third.loses_its_folder(&out.0);
    assert!(!out.0.exists());
    JOB.done(&moved.0, &["--resume"]);
    same(&whole.0, &moved.0);
}

/// A finished run is looked at, and not owned: also where nobody may write.
#[test]
fn a_finished_run_is_not_owned_by_who_looks_at_it() {
    use std::os::unix::fs::PermissionsExt;
    let out = Folder::new("owner-finished");
    JOB.done(&out.0, &[]);
    let lock = out.0.join(RUN_LOCK);
    std::fs::remove_file(&lock).unwrap();
    let mode = |mode| {
        let mode = std::fs::Permissions::from_mode(mode);
        std::fs::set_permissions(&out.0, mode).unwrap();
    };
    // The administrator may write anywhere: the lock shows whether somebody tried.
    mode(0o555);
    let reported = JOB.run(&out.0, &["--resume"]);
    mode(0o755);
    let reported = said(&reported, 0);
    assert!(
        reported.contains("is finished: nothing to do"),
        "{reported}"
    );
    assert!(!lock.exists());
}

/// A finished run with a damaged state must not be started again: neither to its end nor to a later
/// one.
#[test]
fn a_damaged_state_of_a_finished_run_is_refused_and_nothing_is_replaced() {
    const LATER: [&str; 4] = [SETS[0], SETS[1], SETS[2], "time.end=0.2"];
    for in_place in [false, true] {
        let out = Folder::new("damaged-finished");
        let mut command = JOB.command(&out.0, &[]);
        if in_place {
            command.env(IN_PLACE, "0");
        }
        said(&command.output().unwrap(), 0);
        let path = out.0.join("results.h5");
        let mut bytes = std::fs::read(&path).unwrap();
        // The frame of the state is damaged behind its header; the frame of the end has no state.
        let heads = bytes
            .windows(8)
            .enumerate()
            .filter(|(_, w)| w == b"FRETWORK");
        let mut states = heads.map(|(at, _)| at).filter(|at| bytes[at + 12] == 1);
        let at = states.next_back().expect("a frame with a state");
        bytes[at + 100] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        let later = Job {
            case: JOB.case,
            sets: &LATER,
        };
        let reported = said(&later.run(&out.0, &["--resume"]), 1);
        assert!(
            reported.contains("damaged") && reported.contains("nothing was changed"),
            "{reported}"
        );
        assert!(std::fs::read(&path).unwrap() == bytes);
        assert!(out.0.join("summary.json").exists());
    }
}
