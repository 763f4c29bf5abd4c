//! A campaign: damaged inputs of one kind, each read in a separate thread, with limits on time and
//! memory.

use crate::memory::peak;
use cpu_time::ProcessTime;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Limit on the processor time of an input (s), beyond which it counts as hanging; load on the
/// machine does not matter.
const SECONDS: Duration = Duration::from_secs(10);
/// Limit on the waiting time for an input (s), beyond which it counts as hanging.
const WAITS: Duration = Duration::from_secs(300);
/// Memory that a reader may hold beyond a multiple of its file (bytes).
const BASE: usize = 64 << 20;
/// Bytes a reader may hold for each byte of its file.
const EACH: usize = 1000;

/// Inputs of one kind.
pub struct Campaign {
    /// Name of the kind and of its folder.
    pub kind: &'static str,
    /// Number of inputs, unless `FRETWORK_FUZZ` gives another.
    pub count: u64,
    /// Memory allowed beyond the limit for readers (bytes), for a scene that is built.
    pub scene: usize,
    /// Whether some inputs must be accepted: otherwise nothing behind the parser is tested.
    pub taken: bool,
}

type Read = Arc<dyn Fn(&Path) -> bool + Send + Sync>;
type Answer = (Result<bool, String>, usize, Duration);

fn variable(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(
        text.parse()
            .unwrap_or_else(|_| panic!("{name} must be a whole number")),
    )
}

/// Allows one campaign at a time, since campaigns share the count of bytes.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Starts a thread that reads the files that it receives.
fn worker(read: Read) -> (Sender<PathBuf>, Receiver<Answer>) {
    let (to, files) = channel::<PathBuf>();
    let (answers, from) = channel();
    let work = move || {
        for file in files {
            let start = Instant::now();
            let (result, bytes) = peak(|| catch_unwind(AssertUnwindSafe(|| read(&file))));
            let result = result.map_err(|fault| {
                let text = fault.downcast_ref::<String>().cloned();
                text.or_else(|| fault.downcast_ref::<&str>().map(|t| (*t).to_owned()))
                    .unwrap_or_default()
            });
            if answers.send((result, bytes, start.elapsed())).is_err() {
                return;
            }
        }
    };
    // The stack of a main thread.
    let builder = std::thread::Builder::new().stack_size(8 << 20);
    builder.spawn(work).unwrap();
    (to, from)
}

/// Returns the answer to an input, unless it hangs.
fn awaited(answers: &Receiver<Answer>) -> Option<Answer> {
    let (work, clock) = (ProcessTime::now(), Instant::now());
    loop {
        match answers.recv_timeout(Duration::from_millis(200)) {
            Ok(answer) => return Some(answer),
            Err(RecvTimeoutError::Disconnected) => return None,
            Err(RecvTimeoutError::Timeout) => {
                if work.elapsed() > SECONDS || clock.elapsed() > WAITS {
                    return None;
                }
            }
        }
    }
}

impl Campaign {
    /// Returns an empty folder for the inputs.
    pub fn folder(&self) -> PathBuf {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join("fuzz")
            .join(self.kind);
        std::fs::remove_dir_all(&folder).ok();
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    /// Runs the campaign: `make` returns the name and the bytes of an input, `read` whether it was
    /// accepted.
    ///
    /// An input that fails is stored in the folder as `NUMBER-name`, and `last-name` is the one
    /// that was being read when the process was ended from outside.
    pub fn run(
        &self,
        folder: &Path,
        mut make: impl FnMut(&mut Pcg64) -> (String, Vec<u8>),
        read: impl Fn(&Path) -> bool + Send + Sync + 'static,
    ) {
        let _alone = alone();
        let count = variable("FRETWORK_FUZZ").unwrap_or(self.count);
        let seed = variable("FRETWORK_FUZZ_SEED").unwrap_or(2026);
        let from = variable("FRETWORK_FUZZ_FROM").unwrap_or(0);
        let read: Read = Arc::new(read);
        let (mut to, mut answers) = worker(Arc::clone(&read));
        let (mut taken, mut most, mut longest) = (0u64, (0, 0), (Duration::ZERO, 0));
        let mut faults: Vec<String> = Vec::new();
        let start = Instant::now();
        for k in from..from + count {
            // Each input depends only on its own number, so that it can be made again alone.
            let mut rng = Pcg64::seed_from_u64(seed.wrapping_mul(1_000_003).wrapping_add(k));
            let (name, bytes) = make(&mut rng);
            let file = folder.join(format!("last-{name}"));
            std::fs::write(&file, &bytes).unwrap();
            to.send(file.clone()).unwrap();
            let bound = self.scene + BASE + EACH * bytes.len();
            let fault = match awaited(&answers) {
                Some((result, held, time)) => {
                    most = most.max((held, k));
                    longest = longest.max((time, k));
                    match result {
                        Err(why) => Some(format!("panicked: {why}")),
                        Ok(_) if held > bound => Some(format!(
                            "held {} MiB of {} allowed",
                            held >> 20,
                            bound >> 20
                        )),
                        Ok(good) => {
                            taken += u64::from(good);
                            None
                        }
                    }
                }
                None => {
                    (to, answers) = worker(Arc::clone(&read));
                    Some(format!("no answer within {} s", SECONDS.as_secs()))
                }
            };
            if let Some(fault) = fault {
                let kept = folder.join(format!("{k}-{name}"));
                std::fs::write(&kept, &bytes).unwrap();
                let line = format!(
                    "{} {k} (seed {seed}): {fault}: {}",
                    self.kind,
                    kept.display()
                );
                eprintln!("{line}");
                faults.push(line);
            }
            std::fs::remove_file(&file).ok();
            if faults.len() == 20 {
                break;
            }
        }
        println!(
            "{}: {count} inputs from {from} of seed {seed} in {:.1} s: {taken} taken, {} failed; most held {:.1} MiB ({}), longest {:.2} s ({})",
            self.kind,
            start.elapsed().as_secs_f64(),
            faults.len(),
            most.0 as f64 / f64::from(1 << 20),
            most.1,
            longest.0.as_secs_f64(),
            longest.1,
        );
        assert!(faults.is_empty(), "{}", faults.join("\n"));
        if self.taken && count >= self.count {
            assert!(taken > 0, "none of {count} was taken");
        }
    }
}
