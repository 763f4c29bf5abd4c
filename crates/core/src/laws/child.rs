//! Runs the program as its own child process, to try operations that may hang or terminate the
//! process.
//!
//! Only the command-line program starts children, after [`enable`]; other users of the library are
//! not affected.

use crate::program;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::hash::BuildHasher;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ExitStatus, Stdio};
use std::sync::{OnceLock, mpsc};
use std::time::Duration;

/// Whether the program may be run as a child, and how.
#[derive(Debug)]
struct Helper {
    /// Time limit of a law call; `None` for no limit.
    limit: Option<Duration>,
}

static HELPER: OnceLock<Helper> = OnceLock::new();

/// Declares that the [program](crate::program) of this process has the command line, so that it may
/// be run as a child.
pub fn enable(limit: Option<Duration>) {
    if program::command().is_ok() {
        let _ = HELPER.set(Helper { limit });
    }
}

/// Returns whether there is a program to run.
pub fn enabled() -> bool {
    HELPER.get().is_some()
}

/// How a child process ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum End {
    /// The process completed the whole request.
    Done,
    /// The process ended early, for this reason.
    Early(String),
    /// The process ended early because the system refused it memory, which is no failure of the
    /// tried operation; the sentence says so.
    NoMemory(String),
}

/// Output of a child process.
#[derive(Debug)]
pub struct ChildOutput {
    /// Messages of the child in order.
    pub messages: Vec<Value>,
    /// How the child process ended.
    pub end: End,
}

/// A request, and the token that marks its answers.
#[derive(Serialize, Deserialize)]
struct Question {
    token: u64,
    question: Value,
}

/// Token of the request, in the child process.
static TOKEN: OnceLock<u64> = OnceLock::new();

/// Returns the prefix of answer lines, which separates them from anything a law prints. The token
/// is different in each call, so that a law cannot forge an answer.
fn mark(token: u64) -> String {
    format!("\u{1}fretwork {token:016x} ")
}

/// Returns an unpredictable number: the standard library seeds its hash tables from the system's
/// random source.
fn new_token() -> u64 {
    std::hash::RandomState::new().hash_one(std::process::id())
}

/// Sends one message from the child process.
pub fn send_message(message: &Value) {
    let mark = mark(TOKEN.get().copied().unwrap_or_default());
    let mut out = std::io::stdout().lock();
    // A law may have printed an incomplete line.
    let _ = writeln!(out, "\n{mark}{message}");
    let _ = out.flush();
}

/// Reports, from the child process, that the request is complete.
pub fn send_done() {
    send_message(&json!("done"));
}

/// Reads the request, in the child process.
///
/// # Errors
/// The request cannot be read.
pub fn read_request() -> Result<Value, String> {
    let mut text = String::new();
    let read = std::io::stdin().read_to_string(&mut text);
    read.map_err(|e| e.to_string())?;
    let request: Question = serde_json::from_str(&text).map_err(|e| e.to_string())?;
    let _ = TOKEN.set(request.token);
    Ok(request.question)
}

/// Runs the program with a hidden subcommand and collects its output.
///
/// # Errors
/// The program cannot be started.
pub fn run_request(word: &str, question: &Value) -> Result<ChildOutput, String> {
    let helper = HELPER.get().ok_or("there is no program to call")?;
    let limit = helper.limit.map_or(0.0, |l| l.as_secs_f64());
    let mut command = program::command().map_err(|e| format!("cannot start the program: {e}"))?;
    let name = command.get_program().to_owned();
    let cannot = |e: std::io::Error| format!("cannot start {}: {e}", name.display());
    let mut child = command
        .args([word, "--law-timeout", &limit.to_string()])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(cannot)?;
    let token = new_token();
    let (send, heard) = mpsc::channel();
    let no_thread = |e: std::io::Error| format!("cannot start a thread: {e}");
    if let Some(out) = child.stdout.take() {
        let read = move || read_messages(out, token, &send);
        std::thread::Builder::new().spawn(read).map_err(no_thread)?;
    }
    let said = match child.stderr.take() {
        Some(err) => {
            let read = move || read_error_output(err);
            Some(std::thread::Builder::new().spawn(read).map_err(no_thread)?)
        }
        None => None,
    };
    if let Some(mut to) = child.stdin.take() {
        // A process that has already ended does not read its request; the way it ended is reported
        // below.
        let question = json!({ "token": token, "question": question });
        let _ = to.write_all(question.to_string().as_bytes());
    }
    let mut messages = Vec::new();
    let hung = loop {
        // The child enforces its own time limit; this longer one covers a child that cannot.
        // Starting may be slow on a busy machine.
        let slack = Duration::from_secs(if messages.is_empty() { 30 } else { 5 });
        let next = match helper.limit {
            Some(limit) => heard
                .recv_timeout(limit + slack)
                .map_err(|e| e == mpsc::RecvTimeoutError::Timeout),
            None => heard.recv().map_err(|_| false),
        };
        match next {
            Ok(piece) => messages.push(piece),
            Err(timed_out) => break timed_out,
        }
    };
    let status = end(&mut child, hung);
    let said = match hung {
        // A process that holds the output open may never end.
        true => String::new(),
        false => said.and_then(|s| s.join().ok()).unwrap_or_default(),
    };
    let done = messages.pop_if(|p| *p == json!("done")).is_some();
    let end = match status {
        Ok(status) if done && status.success() => End::Done,
        _ if hung => End::Early("it did not answer and was stopped".to_owned()),
        Ok(status) => match no_memory(&said) {
            Some(why) => End::NoMemory(why),
            None => End::Early(describe_exit(status, &said)),
        },
        Err(e) => End::Early(e.to_string()),
    };
    Ok(ChildOutput { messages, end })
}

fn end(child: &mut Child, hung: bool) -> std::io::Result<ExitStatus> {
    if hung {
        let _ = child.kill();
    }
    child.wait()
}

fn read_messages(out: impl Read, token: u64, send: &mpsc::Sender<Value>) {
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

/// Returns the end of a process's standard error.
fn read_error_output(mut err: impl Read) -> String {
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

/// First words of the program's message that memory ran out.
pub const NO_MEMORY: &str = "memory ran out";

/// Returns the message of a process that had no memory: the program's own, or that of the standard
/// library.
fn no_memory(said: &str) -> Option<String> {
    let sentence = said.lines().find_map(|l| {
        let own = l.strip_prefix("error: ").unwrap_or(l);
        let ours = own.starts_with(NO_MEMORY);
        // A law may have its own allocator, which reports through the standard library.
        let of_library = own.starts_with("memory allocation of ") && own.ends_with(" failed");
        match (ours, of_library) {
            (true, _) => Some(own.to_owned()),
            (_, true) => Some(format!("{NO_MEMORY}: {own}")),
            _ => None,
        }
    })?;
    // The parent does not report what the child saved.
    let rest = sentence.split_once("; nothing was being recorded");
    Some(rest.map_or(sentence.clone(), |(sentence, _)| sentence.to_owned()))
}

/// Describes why a process ended early.
fn describe_exit(status: ExitStatus, said: &str) -> String {
    // The program's own message names the law and the call.
    let sentence = said.lines().rev().find_map(|l| l.strip_prefix("error: "));
    if let Some(sentence) = sentence {
        // The parent does not report what the child saved.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The end of a message is read: all of a short one, the last 4096 bytes of a long one.
    #[test]
    fn the_end_of_an_error_is_read() {
        assert_eq!(read_error_output(&b" it failed\n"[..]), "it failed");
        let long: String = (0..3000).map(|k| format!("{k:04}")).collect();
        assert_eq!(
            read_error_output(long.as_bytes()),
            long[long.len() - 4096..]
        );
    }
}
