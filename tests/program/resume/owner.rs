//! A folder is one run's: another that begins there, or goes on, or a page that is made of it
//! meanwhile, is refused and changes nothing.

use super::common::{Folder, IN_PLACE, Job, files, last_frame, said, same};
use fretwork::record::checkpoint::Kind;
use fretwork_store::folder_lock::{FolderLock, RUN_LOCK};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Long enough to be met.
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
    FolderLock::read(out, RUN_LOCK).is_err()
}

/// What is done in the folder while a run, new or resumed, writes there.
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
        while last_frame(&out.0).is_none_or(|f| f.kind != Kind::State) || !held(&out.0) {
            assert!(begun.elapsed() < Duration::from_secs(300), "no checkpoint");
            std::thread::sleep(Duration::from_millis(2));
        }
        // Held still, so that it does not end meanwhile.
        let stop = |number: i32| {
            // SAFETY: no memory is touched; the child has not been waited for, so the number is its
            // own.
            assert_eq!(unsafe { libc::kill(child.id() as libc::pid_t, number) }, 0);
        };
        stop(libc::SIGSTOP);
        // It may go on for a moment, and end a file.
        let mut status = 0;
        // SAFETY: as above, and the status is written to a place of its own.
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
    // The system releases what a killed run held; the bits are those of a run that nobody met.
    JOB.done(&out.0, &["--resume"]);
    same(&whole.0, &out.0);
    said(&report(&out.0), 0);
}

/// A run that is held still once it has saved a state.
struct Held(std::process::Child);

impl Held {
    fn start(out: &Path) -> Self {
        let mut command = JOB.command(out, &[]);
        command
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::piped());
        let held = Self(command.spawn().unwrap());
        let begun = Instant::now();
        while last_frame(out).is_none_or(|f| f.kind != Kind::State) {
            assert!(begun.elapsed() < Duration::from_secs(300), "no checkpoint");
            std::thread::sleep(Duration::from_millis(2));
        }
        held.signal(libc::SIGSTOP);
        // The signal is on its way; until it has arrived the run may still make a file.
        let mut status = 0;
        // SAFETY: the status is this function's own, and a stopped child is not taken from its
        // owner.
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

    /// Goes on, and must find its folder gone.
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

/// Who removes or moves the folder of a run takes it from the run: it writes nothing more there,
/// and another run is not disturbed.
#[test]
fn a_folder_that_is_removed_or_moved_is_no_runs() {
    let whole = Folder::new("lost-whole");
    JOB.done(&whole.0, &[]);
    // Removed, and taken by another run.
    let out = Folder::new("lost");
    let first = Held::start(&out.0);
    std::fs::remove_dir_all(&out.0).unwrap();
    JOB.done(&out.0, &[]);
    first.loses_its_folder(&out.0);
    same(&whole.0, &out.0);
    // Removed, and taken by nobody: it does not come back.
    std::fs::remove_dir_all(&out.0).unwrap();
    let alone = Held::start(&out.0);
    std::fs::remove_dir_all(&out.0).unwrap();
    alone.loses_its_folder(&out.0);
    assert!(!out.0.exists());
    // Moved: it can be gone on with where it is now.
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

/// A damaged state of a finished run is not a run to be started over: neither at its end nor with a
/// later one.
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
        // The frame of the state, behind its head; that of the end has no state.
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
