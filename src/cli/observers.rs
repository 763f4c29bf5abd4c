//! Observers that a program with this command line adds to those of a case.

use crate::RunView;
use crate::record::{Observers, run_observers};
use crate::scene::LoadedCase;
use std::sync::OnceLock;

/// The observers that a program adds to a run of a case, from the state at its start.
pub type Added = fn(&LoadedCase, &dyn RunView) -> Observers;

static ADDED: OnceLock<Added> = OnceLock::new();

/// Declares what a program of one's own with this command line adds to each run: what that reports
/// is found in studies, fits and trades too, whose runs the program makes.
///
/// # Panics
/// Observers were added before: a program adds all of them in one call.
///
/// ```no_run
/// use fretwork::record::{Observer, Observers};
/// use std::process::ExitCode;
///
/// #[derive(Debug)]
/// struct Mine;
///
/// impl Observer for Mine {
///     fn name(&self) -> String {
///         "mine".to_owned()
///     }
/// }
///
/// fn main() -> ExitCode {
///     fretwork::cli::add_observers(|_, _| {
///         let mut all = Observers::default();
///         all.push(Box::new(Mine));
///         all
///     });
///     fretwork::cli::main()
/// }
/// ```
pub fn add(added: Added) {
    assert!(
        ADDED.set(added).is_ok(),
        "observers were added before; add all of them in one call of `add_observers`"
    );
}

/// What the program adds to a run of a case.
pub(super) fn added(loaded: &LoadedCase, run: &dyn RunView) -> Observers {
    ADDED
        .get()
        .map_or_else(Observers::default, |added| added(loaded, run))
}

/// All who observe a run of a case.
pub(super) fn all(loaded: &LoadedCase, run: &dyn RunView) -> Observers {
    let mut all = run_observers(loaded, run);
    all.append(added(loaded, run));
    all
}
