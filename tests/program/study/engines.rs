//! Units of work for other engines; tests/engines/run.sh runs them with each engine.

use super::{Folder, json, mu};
use std::process::{Command, Stdio};

/// Two processes with one run make it once.
#[test]
fn a_run_is_made_by_one_of_two_processes() {
    let folder = Folder::new("same");
    folder.study(&mu("0.1"), "");
    let start = || {
        folder
            .command(&["point", "study.ron", "1", "--out", "out"])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    let children = [start(), start()];
    for child in children {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            said.contains("run 1 of 1 (friction 0.1): done in"),
            "{said}"
        );
    }
    assert_eq!(folder.runs().len(), 1);
}

/// The commands of the list, from another folder and with blanks and quotes in paths, make every
/// run once.
#[cfg(unix)]
#[test]
fn a_list_of_commands_makes_every_run() {
    let folder = Folder::new("jobs");
    folder.study(&mu("0.1, 0.2, 0.3"), "seeds: 2");
    let out = "it's out";
    let export = folder.call(&[
        "export",
        "study.ron",
        "--out",
        out,
        "--to",
        "jobs",
        "--chunk",
        "4",
    ]);
    assert!(
        export.status.success(),
        "{}",
        String::from_utf8_lossy(&export.stderr)
    );
    let list = std::fs::read_to_string(folder.0.join(out).join("jobs.txt")).unwrap();
    assert_eq!(list.lines().count(), 2);
    for line in list.lines() {
        let status = Command::new("sh")
            .current_dir("/")
            .args(["-c", line])
            .stderr(Stdio::null())
            .status();
        assert!(status.unwrap().success(), "{line}");
    }
    let study = folder.answer(&["collect", "study.ron", "--out", out, "--json"]);
    assert_eq!(study["runs"]["done"], 6);
    // A folder in which an engine would fill in a word.
    let filled = folder.call(&["export", "study.ron", "--out", "a%{TASK_ID}", "--to", "hq"]);
    let said = String::from_utf8_lossy(&filled.stderr).into_owned();
    assert_eq!(filled.status.code(), Some(2), "{said}");
    assert!(said.contains("has `%{`, which HyperQueue takes"), "{said}");
    std::fs::create_dir(folder.0.join("laws")).unwrap();
    for engine in ["slurm", "hq", "snakemake"] {
        let more = ["--limit", "2m", "--plugin-path", "laws"];
        let words = ["export", "study.ron", "--out", out, "--to", engine];
        let export = folder.call(&[&words[..], &more[..]].concat());
        assert!(export.status.success(), "{engine}");
    }
    let slurm = std::fs::read_to_string(folder.0.join(out).join("array.sbatch")).unwrap();
    assert!(slurm.contains("--limit 120s"), "{slurm}");
    let laws = folder.0.join("laws").display().to_string();
    assert!(slurm.contains(&laws), "{slurm}");
    let snakemake = std::fs::read_to_string(folder.0.join(out).join("Snakefile")).unwrap();
    let inputs = snakemake.lines().find(|l| l.contains("input: \"")).unwrap();
    assert!(
        inputs.contains("study.ron\"") && inputs.contains("heap.ron\""),
        "{snakemake}"
    );
    assert!(
        slurm.contains("#SBATCH --array=1-6\n") && slurm.contains("\"$first-$last\""),
        "{slurm}"
    );
}

#[test]
fn a_number_beyond_the_study_is_refused() {
    let folder = Folder::new("beyond");
    folder.study(&mu("0.1, 0.2"), "");
    for (points, said) in [
        ("3", "has 2 runs"),
        ("0", "no number of a run"),
        ("2-1", "no number of a run"),
    ] {
        let output = folder.call(&["point", "study.ron", points, "--out", "out"]);
        assert_eq!(output.status.code(), Some(2));
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(error.contains(said), "{error}");
    }
    assert!(
        folder
            .call(&["point", "study.ron", "1-2", "--out", "out"])
            .status
            .success()
    );
    assert_eq!(folder.runs().len(), 2);
    assert!(json(&folder.0.join("out/study.json"))["random"] == true);
}

/// The rest of a name behind the end of a line would be a line of the script.
#[cfg(unix)]
#[test]
fn a_name_with_an_end_of_a_line_becomes_no_command() {
    let folder = Folder::new("lines");
    folder.study(&mu("0.1"), "");
    let name = "study\ntouch made\n.ron";
    std::fs::rename(folder.0.join("study.ron"), folder.0.join(name)).unwrap();
    for engine in ["slurm", "hq", "snakemake", "jobs"] {
        let export = folder.call(&["export", name, "--out", "out", "--to", engine]);
        let said = String::from_utf8_lossy(&export.stderr).into_owned();
        assert_eq!(export.status.code(), Some(2), "{said}");
        assert!(said.contains("control character"), "{said}");
        for script in ["array.sbatch", "study.hq.toml", "Snakefile", "jobs.txt"] {
            assert!(!folder.0.join("out").join(script).exists(), "{script}");
        }
    }
    // Quotes and dollars are part of the name in every shell.
    let name = "a'$first-$last'$(touch made).ron";
    std::fs::rename(
        folder.0.join("study\ntouch made\n.ron"),
        folder.0.join(name),
    )
    .unwrap();
    let out = ["--out", "out", "--to", "slurm"];
    let export = folder.call(&[&["export", name][..], &out].concat());
    assert!(export.status.success(), "{export:?}");
    let script = std::fs::read_to_string(folder.0.join("out/array.sbatch")).unwrap();
    let line = script.lines().find(|l| l.starts_with("exec ")).unwrap();
    // The shell splits the line into these words.
    let words = line.replacen("exec ", "printf '%s\\n' ", 1);
    let shell = Command::new("sh")
        .args(["-c", &words])
        .current_dir(&folder.0)
        .output()
        .unwrap();
    let words = String::from_utf8(shell.stdout).unwrap();
    assert!(words.lines().any(|w| w.ends_with(name)), "{words}");
    assert!(!folder.0.join("made").exists());
}
