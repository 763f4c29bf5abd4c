//! The program called by itself, to try in another process what may hang it or end it.
//!
//! Only the program calls itself, never what else uses this library: [`enable`] says that there is one to call.

use super::library::{LawError, Plugin};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::hash::BuildHasher;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, OnceLock, mpsc};
use std::time::Duration;

/// The hidden word by which the program is asked to try libraries.
pub const TRY_LIBRARIES: &str = "__try-libraries";

/// The program to call.
#[derive(Debug)]
struct Helper {
    program: PathBuf,
    /// How long a call of a law may take; none for ever.
    limit: Option<Duration>,
}

static HELPER: OnceLock<Helper> = OnceLock::new();

/// Says that this process is the program, which may call itself.
pub fn enable(limit: Option<Duration>) {
    if let Ok(program) = std::env::current_exe() {
        let _ = HELPER.set(Helper { program, limit });
    }
}

/// Whether there is a program to call.
pub fn enabled() -> bool {
    HELPER.get().is_some()
}

/// How a called process ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// It did all that it was asked.
    Done,
    /// It ended before, in words.
    Early(String),
}

/// What a called process told.
#[derive(Debug)]
pub struct Told {
    /// What it said, piece by piece.
    pub pieces: Vec<Value>,
    /// How it ended.
    pub end: End,
}

/// What is asked: the question, and the token by which the answers are known.
#[derive(Serialize, Deserialize)]
struct Question {
    token: u64,
    question: Value,
}

/// In the called process: the token that it was given.
static TOKEN: OnceLock<u64> = OnceLock::new();

/// What answers begin with, among whatever a law prints. The token is another one at each call, so that nothing printed by a
/// law passes for an answer.
fn mark(token: u64) -> String {
    format!("\u{1}fretwork {token:016x} ")
}

/// A number that cannot be foreseen: the standard library seeds its hash tables by the system's random numbers.
fn new_token() -> u64 {
    std::hash::RandomState::new().hash_one(std::process::id())
}

/// In the called process: says one piece.
pub fn tell(piece: &Value) {
    let mark = mark(TOKEN.get().copied().unwrap_or_default());
    let mut out = std::io::stdout().lock();
    // A law may have left a line unended.
    let _ = writeln!(out, "\n{mark}{piece}");
    let _ = out.flush();
}

/// In the called process: says that all is done.
pub fn tell_done() {
    tell(&json!("done"));
}

/// In the called process: what it was asked.
///
/// # Errors
/// It cannot be read.
pub fn asked() -> Result<Value, String> {
    let mut text = String::new();
    let read = std::io::stdin().read_to_string(&mut text);
    read.map_err(|e| e.to_string())?;
    let asked: Question = serde_json::from_str(&text).map_err(|e| e.to_string())?;
    let _ = TOKEN.set(asked.token);
    Ok(asked.question)
}

/// Calls the program with a hidden word, and hears it out.
///
/// # Errors
/// It cannot be called.
pub fn ask(word: &str, question: &Value) -> Result<Told, String> {
    let helper = HELPER.get().ok_or("there is no program to call")?;
    let limit = helper.limit.map_or(0.0, |l| l.as_secs_f64());
    let cannot = |e: std::io::Error| format!("cannot start {}: {e}", helper.program.display());
    let mut child = Command::new(&helper.program)
        .args([word, "--law-timeout", &limit.to_string()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(cannot)?;
    let token = new_token();
    let (send, heard) = mpsc::channel();
    if let Some(out) = child.stdout.take() {
        std::thread::spawn(move || listen(out, token, &send));
    }
    let said = child
        .stderr
        .take()
        .map(|err| std::thread::spawn(move || last_words(err)));
    if let Some(mut to) = child.stdin.take() {
        // One that ended already does not read it; how it ended is told below.
        let question = json!({ "token": token, "question": question });
        let _ = to.write_all(question.to_string().as_bytes());
    }
    let mut pieces = Vec::new();
    let hung = loop {
        // The called process watches itself; this is for one that cannot. It may start slowly on a busy machine.
        let slack = Duration::from_secs(if pieces.is_empty() { 30 } else { 5 });
        let next = match helper.limit {
            Some(limit) => heard
                .recv_timeout(limit + slack)
                .map_err(|e| e == mpsc::RecvTimeoutError::Timeout),
            None => heard.recv().map_err(|_| false),
        };
        match next {
            Ok(piece) => pieces.push(piece),
            Err(timed_out) => break timed_out,
        }
    };
    let status = end(&mut child, hung);
    let said = match hung {
        // What holds its output open may never end.
        true => String::new(),
        false => said.and_then(|s| s.join().ok()).unwrap_or_default(),
    };
    let done = pieces.pop_if(|p| *p == json!("done")).is_some();
    let end = match status {
        Ok(status) if done && status.success() => End::Done,
        _ if hung => End::Early("it did not answer and was stopped".to_owned()),
        Ok(status) => End::Early(in_words(status, &said)),
        Err(e) => End::Early(e.to_string()),
    };
    Ok(Told { pieces, end })
}

fn end(child: &mut Child, hung: bool) -> std::io::Result<ExitStatus> {
    if hung {
        let _ = child.kill();
    }
    child.wait()
}

fn listen(out: impl Read, token: u64, send: &mpsc::Sender<Value>) {
    let mark = mark(token);
    for line in BufReader::new(out).split(b'\n').map_while(Result::ok) {
        let line = String::from_utf8_lossy(&line);
        let piece = line
            .strip_prefix(mark.as_str())
            .and_then(|t| serde_json::from_str(t).ok());
        if let Some(piece) = piece
            && send.send(piece).is_err()
        {
            return;
        }
    }
}

/// The end of what a process says on standard error.
fn last_words(mut err: impl Read) -> String {
    const MAX_BYTES: usize = 4096;
    let (mut all, mut buffer) = (Vec::new(), [0; 1024]);
    while let Ok(n) = err.read(&mut buffer) {
        if n == 0 {
            break;
        }
        all.extend_from_slice(&buffer[..n]);
        let over = all.len().saturating_sub(MAX_BYTES);
        all.drain(..over);
    }
    String::from_utf8_lossy(&all).trim().to_owned()
}

/// Why a process ended before it was done.
fn in_words(status: ExitStatus, said: &str) -> String {
    // The program's own sentence names the law and the call.
    let sentence = said.lines().rev().find_map(|l| l.strip_prefix("error: "));
    if let Some(sentence) = sentence {
        // What was saved is no concern of who asked.
        return sentence.split("; ").next().unwrap_or(sentence).to_owned();
    }
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        if let Some(signal) = status.signal() {
            return format!("it was ended by signal {signal}");
        }
    }
    match status.code() {
        Some(code) => format!("it ended the process (exit code {code})"),
        None => "it ended the process".to_owned(),
    }
}

/// A library as it was when it was looked at.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
struct Library {
    path: PathBuf,
    sha256: String,
}

/// What was found of libraries: nothing, or why they cannot be opened. The same bytes elsewhere may load others beside them.
static FOUND: Mutex<Option<HashMap<Library, Option<String>>>> = Mutex::new(None);

fn known(library: &Library) -> Option<Option<String>> {
    let found = FOUND.lock().unwrap_or_else(|e| e.into_inner());
    found.as_ref()?.get(library).cloned()
}

fn remember(library: &Library, reason: Option<String>) {
    let mut found = FOUND.lock().unwrap_or_else(|e| e.into_inner());
    let all = found.get_or_insert_default();
    all.insert(library.clone(), reason);
}

/// Whether a library can be opened in another process and comes back.
pub(super) fn survives(path: &Path, sha256: &str) -> Result<(), String> {
    if !enabled() {
        return Ok(());
    }
    let library = Library {
        path: path.to_owned(),
        sha256: sha256.to_owned(),
    };
    if known(&library).is_none() {
        ask_after(std::slice::from_ref(&library));
    }
    match known(&library) {
        Some(None) => Ok(()),
        Some(Some(reason)) => Err(reason),
        None => Err(UNANSWERED.to_owned()),
    }
}

/// Tries several libraries in one process; a library of another SHA-256 than its pin is not opened.
pub(super) fn try_out(libraries: &[(PathBuf, Option<&str>)]) {
    if !enabled() {
        return;
    }
    let mut wanted: Vec<Library> = Vec::new();
    for (path, pin) in libraries {
        let Ok(bytes) = std::fs::read(path) else {
            continue;
        };
        let library = Library {
            path: path.clone(),
            sha256: super::built_in::hex(&Sha256::digest(&bytes)),
        };
        let pinned = pin.is_none_or(|p| p.eq_ignore_ascii_case(&library.sha256));
        if pinned && known(&library).is_none() && !wanted.contains(&library) {
            wanted.push(library);
        }
    }
    while !wanted.is_empty() {
        let done = ask_after(&wanted);
        wanted.drain(..done);
    }
}

const UNANSWERED: &str = "it was tried in a process of its own, which ended without a word on it; build or copy it again";

/// Asks after libraries, and remembers what is told; how many of them it is known of, at least one.
fn ask_after(libraries: &[Library]) -> usize {
    let question = serde_json::to_value(libraries).map_err(|e| e.to_string());
    let told = match question.and_then(|q| ask(TRY_LIBRARIES, &q)) {
        Ok(told) => told,
        Err(reason) => {
            let text = format!(
                "it is tried in a process of its own first, and that cannot be made ({reason})"
            );
            remember(&libraries[0], Some(text));
            return 1;
        }
    };
    for (library, piece) in libraries.iter().zip(&told.pieces) {
        remember(library, piece.as_str().map(str::to_owned));
    }
    let answered = told.pieces.len().min(libraries.len());
    let Some(library) = libraries.get(answered) else {
        return answered;
    };
    let why = match &told.end {
        End::Early(why) => format!(
            "opening it ended a process that tried it: {why}; the file may be damaged or cut short: build or copy it again"
        ),
        // A library of which nothing was said was not opened.
        End::Done => UNANSWERED.to_owned(),
    };
    remember(library, Some(why));
    answered + 1
}

/// In the called process: opens the libraries it is asked after, one by one, each only if it is the one that was looked at.
/// Why one is refused is told where it is opened again: what counts here is that it comes back.
///
/// # Errors
/// The question cannot be read.
pub fn try_libraries() -> Result<(), String> {
    let libraries: Vec<Library> = serde_json::from_value(asked()?).map_err(|e| e.to_string())?;
    for library in libraries {
        tell(
            &match Plugin::open_pinned(&library.path, Some(&library.sha256)) {
                Err(LawError::Pinned { .. }) => json!(CHANGED),
                _ => Value::Null,
            },
        );
    }
    tell_done();
    Ok(())
}

/// What is said of a library that is not the one any more that was looked at.
pub(super) const CHANGED: &str =
    "the file changed while it was being opened; wait until it is written and try again";
