//! One trial of the program: a folder with a case and materials, a call, and its expected output.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Mark before the wrong token; not part of the case.
pub const MARK: char = '‸';

/// A valid 2D case: three grains above a floor, a lid pressed by a table of time.
pub const PLANE: &str = r#"(
    name: "grains between a floor and a lid",
    dimension: 2,
    time: (step: 1e-3, end: 0.002, theta: 0.5),
    gravity: [0.0, -9.81],
    periodic: (x: 0.4),
    materials: {"grain": "stone"},
    interfaces: [
        (
            name: "grains",
            between: ("grain", "grain"),
            parameters_from: "laws",
            contact: "coulomb",
            parameters: (contact: {"mu": 0.3}),
        ),
    ],
    bodies: [
        (name: "floor", material: "grain", shapes: [HalfSpace(normal: [0.0, 1.0])]),
        (
            name: "lid",
            material: "grain",
            shapes: [HalfSpace(normal: [0.0, -1.0])],
            position: [0.0, 0.1],
            mass: 1.0,
            dofs: (x: Displacement(Sine(amplitude: 1e-4, frequency: 20.0)), y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))),
        ),
    ],
    grains: [
        List(material: "grain", grains: [
            (at: [0.05, 0.011], radius: 0.01),
            (at: [0.1, 0.011], radius: 0.01),
            (at: [0.15, 0.011], radius: 0.01),
        ]),
    ],
    friction: (body: "lid", along: 0, normal: 1),
    output: (frames: 0, views: 0, figures: false),
)
"#;

/// A valid case in space: a grain above a rough floor.
pub const SOLID: &str = r#"(
    name: "a grain on a rough floor",
    dimension: 3,
    time: (step: 1e-3, end: 0.002),
    gravity: [0.0, 0.0, -9.81],
    materials: {"grain": "stone"},
    interfaces: [(name: "grains", between: ("grain", "grain"), contact: "coulomb")],
    bodies: [
        (name: "floor", material: "grain", shapes: [HeightField(points: (4, 4), spacing: (0.1, 0.1), rms: 1e-4)]),
    ],
    grains: [List(material: "grain", grains: [(at: [0.15, 0.15, 0.02], radius: 0.01)])],
    output: (frames: 0, views: 0, figures: false),
)
"#;

/// A friction law in C.
const LAW: &str = r#"
#include <stdlib.h>
#include <unistd.h>
#include "fretwork.h"
#ifdef HANGS_WHEN_LOADED
__attribute__((constructor)) static void loaded(void) { for (volatile int on = 1; on;) {} }
#endif
#ifdef EXITS_WHEN_LOADED
__attribute__((constructor)) static void loaded(void) { exit(0); }
#endif
#ifdef CRASHES_WHEN_LOADED
__attribute__((constructor)) static void loaded(void) { *(volatile int *)8 = 1; }
#endif
#ifdef PRINTS_WHEN_LOADED
#include <stdio.h>
__attribute__((constructor)) static void loaded(void) { printf("loaded, without an end of the line"); fflush(stdout); }
#endif
#if defined SPOOFS || defined SPOOFS_AND_EXITS
#include <stdio.h>
#include <unistd.h>
__attribute__((constructor)) static void loaded(void) {
    for (int k = 0; k < 2; k++) printf("\n\001fretwork null\n\001fretwork \"done\"\n");
    fflush(stdout);
#ifdef SPOOFS_AND_EXITS
    _exit(0);
#endif
}
#endif
#if defined ROUNDS_UP || defined FLUSHES_WHEN_LOADED
#include <xmmintrin.h>
#endif
#ifdef FLUSHES_WHEN_LOADED
__attribute__((constructor)) static void loaded(void) { _mm_setcsr(_mm_getcsr() | 0x8040); }
#endif
#ifdef MOVES
__attribute__((constructor)) static void loaded(void) { if (chdir("/") != 0) abort(); }
#endif
#ifdef ENDS_ITS_THREAD
#include <pthread.h>
#endif
#ifdef THROWS
#include <unwind.h>
#endif
#ifdef PRINTS
#include <stdio.h>
#endif
#ifdef LINKS
double helper(void);
#endif
#ifdef SWAPS
#include <stdio.h>
__attribute__((constructor)) static void loaded(void) { rename("next", "libfretwork_contact_own.so"); }
#endif
static int32_t prepare(const fw_batch *b, fw_message *m) {
    (void)m;
#if defined SPOOFS || defined LINKS
    int calls = 0; // what is static is not certified
#else
    static int calls;
#endif
    ++calls;
    (void)calls;
#ifdef LOOPS
    for (volatile int on = calls > 3000; on;) {}
#endif
#ifdef EXITS
    if (calls > 1000) exit(0);
#endif
#ifdef EXITS_AT_ONCE
    if (calls > 1000) _exit(0);
#endif
#ifdef CRASHES
    if (calls > 1000) *(volatile int *)8 = 1;
#endif
#ifdef DIVIDES
    if (calls > 1000) { volatile int none = 0; calls /= none; }
#endif
#ifdef ABORTS
    if (calls > 1000) abort();
#endif
#ifdef ENDS_ITS_THREAD
    if (calls > 1000) pthread_exit(NULL);
#endif
#ifdef THROWS
    // This is the code that a C++ compiler generates for `throw`.
    static struct _Unwind_Exception thrown;
    if (calls > 1000) _Unwind_RaiseException(&thrown);
#endif
#ifdef ROUNDS_UP
    _mm_setcsr(_mm_getcsr() | 0x4000);
#endif
#ifdef PRINTS
    printf("a step\n");
    fflush(stdout);
#endif
#ifdef MOVES
    if (chdir("/") != 0) abort();
#endif
#ifdef FAILS
    static int asked;
    if (++asked > 200) return FW_ERROR;
#endif
#ifdef HANGS
    static int asked;
    for (volatile int on = ++asked > 200; on;) {}
#endif
#ifdef SPILLS
    b->out_friction[b->n] = 1.0;
#endif
    for (size_t k = 0; k < b->n; k++) {
        b->out_friction[k] = b->parameters[0];
#ifdef LINKS
        b->out_friction[k] = helper();
#endif
#ifdef BOUNCES
        b->out_restitution_n[k] = BOUNCES;
#endif
#ifdef DRIVES
        b->out_friction[k] = -0.1;
#endif
#ifdef DRIVES_IF_ROUGH
        if (b->parameters[0] > 0.35) b->out_friction[k] = -0.1;
#endif
    }
    return FW_OK;
}
static const fw_field parameters[] = {{"mu", "", "friction coefficient", 0.3, 0.0, 10.0, 0}};
static const fw_plugin table = {
    .size = sizeof(fw_plugin), .abi_major = FW_ABI_MAJOR, .abi_minor = FW_ABI_MINOR,
    .kind = FW_KIND_CONTACT, .flags = FLAGS, .name = NAME, .version = "1.0",
    .doc = "a test", .reference = "none", .n_parameters = 1, .parameters = parameters,
    .prepare = prepare,
};
const fw_plugin *fretwork_plugin(void) {
#ifdef HANGS_WHEN_ASKED
    for (volatile int on = 1; on;) {}
#endif
    return &table;
}
"#;

const STONE: &str = r#"(doc: "stone", density: (value: 2600.0, unit: "kg/m^3", source: "quartz"))"#;
const LAWS: &str =
    r#"(doc: "laws", contact: {"coulomb": {"mu": (value: 0.4, source: "a guess")}})"#;

/// Returns `case` with its one occurrence of `old` replaced by `new`.
pub fn with(case: &str, old: &str, new: &str) -> String {
    assert_eq!(case.matches(old).count(), 1, "`{old}` in the case");
    case.replace(old, new)
}

/// A separate folder for each trial, removed at its end: `case.ron`, `materials/` beside it.
pub struct Trial {
    folder: PathBuf,
}

impl Trial {
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("fretwork-bad-input-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        std::fs::create_dir_all(folder.join("materials")).unwrap();
        let trial = Self { folder };
        trial.write("materials/stone.ron", STONE);
        trial.write("materials/laws.ron", LAWS);
        trial
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// Writes a text without its mark; returns `path:line:column` of the mark, if there is one.
    pub fn write_marked(&self, name: &str, marked: &str) -> (PathBuf, Option<String>) {
        let path = self.write(name, marked.replace(MARK, ""));
        let place = marked.find(MARK).map(|at| {
            let before = &marked[..at];
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
            format!("{}:{line}:{column}: error: ", path.display())
        });
        (path, place)
    }

    /// Compiles a contact law of this name and these flags into the trial's folder.
    pub fn compile_law(&self, name: &str, flags: &str) {
        self.compile_bad_law(name, flags, "GOOD");
    }

    /// Compiles a law with a defect, named by a word of its text: `LOOPS` without end in prepare,
    /// say, or `SPILLS` beyond a column.
    pub fn compile_bad_law(&self, name: &str, flags: &str, fault: &str) {
        self.compile(name, flags, fault, &[]);
    }

    /// Compiles a law that links to `libhelper.so` of a folder, which it finds relative to itself
    /// by this run path.
    pub fn compile_linked_law(&self, name: &str, folder: &str, run_path: &str) {
        let folder = format!("-L{folder}");
        let run_path = format!("-Wl,-rpath,{run_path}");
        self.compile(name, "0", "LINKS", &[&folder, "-lhelper", &run_path]);
    }

    /// Compiles that library, which gives the friction coefficient.
    pub fn compile_helper(&self, folder: &str, value: &str) -> PathBuf {
        std::fs::create_dir_all(self.path(folder)).unwrap();
        let source = self.write(
            "helper.c",
            format!("double helper(void) {{ return {value}; }}"),
        );
        let library = self.path(&format!("{folder}/libhelper.so"));
        let made = Command::new("cc")
            .args(["-shared", "-fPIC", "-Wl,-soname,libhelper.so", "-o"])
            .args([&library, &source])
            .status();
        assert!(made.unwrap().success());
        library
    }

    fn compile(&self, name: &str, flags: &str, fault: &str, links: &[&str]) {
        use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
        let source = self.write("law.c", LAW);
        let file = name.replace('-', "_");
        let library = self.path(&format!("{DLL_PREFIX}fretwork_contact_{file}{DLL_SUFFIX}"));
        let compiled = Command::new("cc")
            .args(["-std=gnu99", "-Wall", "-Werror", "-shared", "-fPIC", "-I"])
            .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/plugins/abi/include"))
            .args([format!("-DNAME=\"{name}\""), format!("-DFLAGS={flags}")])
            .arg(format!("-D{fault}"))
            .arg("-o")
            .args([&library, &source])
            .args(links)
            .current_dir(&self.folder)
            .status()
            .expect("a C compiler named cc");
        assert!(compiled.success());
    }

    /// Calls the program without variables of the environment; a run replaces an earlier one of the
    /// trial.
    pub fn call(&self, arguments: &[&str]) -> Output {
        let replaces = arguments.first() == Some(&"run") && !arguments.contains(&"--resume");
        let force: &[&str] = if replaces { &["--force"] } else { &[] };
        self.call_as_written(&[arguments, force].concat())
    }

    /// Calls the program without variables of the environment.
    pub fn call_as_written(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(arguments)
            .current_dir(&self.folder)
            .env_remove("FRETWORK_PLUGIN_PATH")
            .env("NO_COLOR", "1")
            .output()
            .unwrap()
    }

    /// Starts the program in the background.
    pub fn start(&self, arguments: &[&str]) -> std::process::Child {
        Command::new(env!("CARGO_BIN_EXE_fretwork"))
            .args(arguments)
            .current_dir(&self.folder)
            .env_remove("FRETWORK_PLUGIN_PATH")
            .stdin(std::process::Stdio::null())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap()
    }

    /// Calls `run` for a case that must be rejected with all of `words`, before anything is
    /// written.
    pub fn refuses(&self, case: &Path, more: &[&str], words: &[&str]) -> String {
        let mut arguments = vec!["run", case.to_str().unwrap()];
        arguments.extend_from_slice(more);
        let said = refusal(&self.call(&arguments), words);
        assert!(!self.path("results").exists(), "nothing may be written");
        said
    }
}

impl Drop for Trial {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.folder).ok();
    }
}

/// Returns standard error of a call that must have ended with exit code 2, without a panic, with
/// `words`.
pub fn refusal(output: &Output, words: &[&str]) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!said.contains("panicked"), "{said}");
    assert_eq!(output.status.code(), Some(2), "{said}");
    for word in words {
        assert!(said.contains(word), "no `{word}` in: {said}");
    }
    said
}

/// Runs a marked case, which must be rejected at the mark, on the first line, with all of `words`.
#[track_caller]
pub fn refused(marked: &str, words: &[&str]) {
    refused_with(marked, &[], words);
}

/// Does as [`refused`] with further arguments.
#[track_caller]
pub fn refused_with(marked: &str, more: &[&str], words: &[&str]) {
    let trial = Trial::new();
    let (case, place) = trial.write_marked("case.ron", marked);
    let said = trial.refuses(&case, more, words);
    let place = place.expect("a mark in the case");
    assert!(said.starts_with(&place), "not at {place}\n{said}");
}
