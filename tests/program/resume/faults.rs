//! Runs that cannot be resumed are reported with a message.

use super::common::{Folder, Job, draft, last_frame, said, same};
use fretwork::record::checkpoint::FrameKind;
use std::path::Path;
use std::process::Command;

const SETS: [&str; 4] = [
    "time.end=0.004",
    "output.checkpoint=Steps(8)",
    "output.frames=0",
    "output.figures=false",
];

fn job() -> Job<'static> {
    Job {
        case: "shear_cell_3d",
        sets: &SETS,
    }
}

/// Returns the number of the frame whose head is at a position.
fn number(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at + 16..at + 24].try_into().unwrap())
}

/// Positions of the headers of frames in the bytes of a file; the content is in chunks.
fn frames(bytes: &[u8]) -> Vec<usize> {
    let found = bytes
        .windows(8)
        .enumerate()
        .filter(|(_, w)| w == b"FRETWORK");
    found.map(|(at, _)| at).collect()
}

fn refused(out: &Path, job: Job<'_>, code: i32, words: &[&str]) {
    let before = draft(out);
    let reported = said(&job.run(out, &["--resume"]), code);
    for word in words {
        assert!(reported.contains(word), "`{word}` is not in: {reported}");
    }
    let left = draft(out);
    assert!(left.is_none() || left == before, "a draft was left");
}

#[test]
fn a_finished_run_has_nothing_to_do_and_an_empty_folder_begins() {
    let (one, other) = (Folder::new("fresh"), Folder::new("plain"));
    let reported = job().done(&one.0, &["--resume"]);
    assert!(reported.contains("nothing to resume"), "{reported}");
    job().done(&other.0, &[]);
    same(&one.0, &other.0);
    let before = std::fs::read(one.0.join("results.h5")).unwrap();
    let reported = job().done(&one.0, &["--resume"]);
    assert!(reported.contains("is finished"), "{reported}");
    assert!(std::fs::read(one.0.join("results.h5")).unwrap() == before);
    let json = job().done(&one.0, &["--resume", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(value["steps"], 40);
}

#[test]
fn another_case_is_refused_and_harms_nothing() {
    let out = Folder::new("other");
    job().killed_after(&out.0, 2);
    let before = std::fs::read(out.0.join("results.h5")).unwrap();
    let mut sets = SETS;
    sets[0] = "time.end=0.003";
    let shorter = Job {
        case: "shear_cell_3d",
        sets: &sets,
    };
    refused(
        &out.0,
        shorter,
        2,
        &["another case", "`time.end`", "0.004", "0.003"],
    );
    let another = Job {
        case: "verification/shear_3d",
        sets: &[],
    };
    refused(&out.0, another, 2, &["another case"]);
    assert!(std::fs::read(out.0.join("results.h5")).unwrap() == before);
    job().done(&out.0, &["--resume"]);
}

#[test]
fn another_version_is_refused() {
    let out = Folder::new("version");
    job().killed_after(&out.0, 2);
    let path = out.0.join("results.h5");
    let mut bytes = std::fs::read(&path).unwrap();
    let mut frame = last_frame(&out.0).unwrap();
    let ours = frame.version.clone();
    frame.version = "9.9.9".to_owned();
    assert_eq!(frame.version.len(), ours.len());
    for at in frames(&bytes) {
        if number(&bytes, at) == frame.number {
            // The header has hash and version.
            bytes[at..at + 100].copy_from_slice(&frame.bytes()[..100]);
        }
    }
    std::fs::write(&path, bytes).unwrap();
    refused(&out.0, job(), 2, &["was written by Fretwork 9.9.9", &ours]);
}

#[test]
fn a_file_that_changed_behind_the_case_is_refused() {
    let (out, cases) = (Folder::new("profile"), Folder::new("profile-case"));
    std::fs::create_dir_all(&cases.0).unwrap();
    let from = Path::new(env!("CARGO_MANIFEST_DIR"));
    for name in ["fretting_wear_jump.ron", "fretting_scar_flat.csv"] {
        std::fs::copy(from.join("cases").join(name), cases.0.join(name)).unwrap();
    }
    let materials = cases.0.join("materials");
    std::fs::create_dir_all(&materials).unwrap();
    for entry in std::fs::read_dir(from.join("materials")).unwrap() {
        let entry = entry.unwrap();
        if entry.path().is_file() {
            std::fs::copy(entry.path(), materials.join(entry.file_name())).unwrap();
        }
    }
    let case = cases.0.join("fretting_wear_jump.ron");
    let run = |extra: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        command
            .current_dir(from)
            .arg("run")
            .arg(&case)
            .arg("--out")
            .arg(&out.0);
        command.args([
            "--set",
            "time.end=0.1",
            "--set",
            "output.checkpoint=Steps(50)",
        ]);
        command.args(extra).output().unwrap()
    };
    said(&run(&[]), 0);
    let profile = cases.0.join("fretting_scar_flat.csv");
    let text = std::fs::read_to_string(&profile).unwrap();
    std::fs::write(&profile, text.replacen("-4.00,0", "-4.00,0.001", 1)).unwrap();
    let reported = said(&run(&["--resume"]), 2);
    assert!(reported.contains("builds another scene"), "{reported}");
    std::fs::write(&profile, text).unwrap();
    let steel = materials.join("rail_steel_r260.ron");
    let old = std::fs::read_to_string(&steel).unwrap();
    std::fs::write(&steel, format!("{old}\n// changed\n")).unwrap();
    let reported = said(&run(&["--resume"]), 2);
    assert!(
        reported.contains("material file `rail_steel_r260`"),
        "{reported}"
    );
    std::fs::write(&steel, old).unwrap();
    // Comments of the case do not matter.
    let text = std::fs::read_to_string(&case).unwrap();
    std::fs::write(&case, format!("// a comment\n{text}")).unwrap();
    assert!(said(&run(&["--resume"]), 0).contains("is finished"));
}

#[test]
fn one_damaged_checkpoint_costs_some_steps_two_are_refused() {
    let whole = Folder::new("damage-whole");
    job().done(&whole.0, &[]);
    let out = Folder::new("damage");
    job().killed_after(&out.0, 3);
    let path = out.0.join("results.h5");
    let good = std::fs::read(&path).unwrap();
    let mut found: Vec<(u64, usize)> = frames(&good)
        .into_iter()
        .map(|at| (number(&good, at), at))
        .collect();
    found.sort_unstable();
    assert_eq!(found.len(), 2, "two checkpoints stand in the file");
    let flip = |bytes: &mut Vec<u8>, at: usize| bytes[at + 5000] ^= 0x40;
    let mut bytes = good.clone();
    flip(&mut bytes, found[0].1);
    flip(&mut bytes, found[1].1);
    std::fs::write(&path, &bytes).unwrap();
    refused(
        &out.0,
        job(),
        1,
        &["damaged", "--force in place of --resume"],
    );
    let mut bytes = good;
    flip(&mut bytes, found[1].1);
    std::fs::write(&path, &bytes).unwrap();
    let last = last_frame(&out.0).unwrap();
    assert_eq!((last.number, last.kind), (found[0].0, FrameKind::State));
    job().done(&out.0, &["--resume"]);
    same(&whole.0, &out.0);
}

#[test]
fn a_file_that_is_cut_or_none_is_refused() {
    let out = Folder::new("cut");
    job().killed_after(&out.0, 2);
    let path = out.0.join("results.h5");
    let good = std::fs::read(&path).unwrap();
    for length in [0, 7, 600, good.len() / 50, good.len() / 3] {
        std::fs::write(&path, &good[..length]).unwrap();
        refused(
            &out.0,
            job(),
            1,
            &["results.h5", "--force in place of --resume"],
        );
    }
    std::fs::write(&path, b"not a file of results at all").unwrap();
    refused(&out.0, job(), 1, &["cannot read"]);
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    refused(&out.0, job(), 1, &["it is not a file"]);
}

/// Data beyond the end of a truncated file would be read as zeros: the file is rejected, or the
/// results are bit-identical to those of an uninterrupted run.
#[test]
fn a_file_that_is_cut_anywhere_gives_no_other_numbers() {
    let (out, whole) = (Folder::new("cut-anywhere"), Folder::new("not-cut"));
    job().done(&whole.0, &[]);
    job().killed_after(&out.0, 2);
    let path = out.0.join("results.h5");
    let good = std::fs::read(&path).unwrap();
    let mut refusals = 0;
    for part in 1..20 {
        std::fs::write(&path, &good[..good.len() * part / 20]).unwrap();
        let output = job().run(&out.0, &["--resume"]);
        if output.status.success() {
            same(&whole.0, &out.0);
            std::fs::remove_file(out.0.join("summary.json")).unwrap();
        } else {
            said(&output, 1);
            refusals += 1;
        }
    }
    assert!(refusals >= 10, "{refusals} of 19");
}

#[test]
fn a_folder_that_cannot_be_written_is_told() {
    let reported = said(&job().run(Path::new("/proc/fretwork"), &["--resume"]), 1);
    assert!(
        reported.contains("cannot write") && reported.contains("--out"),
        "{reported}"
    );
    // If files cannot be created beside the results, the results are unchanged.
    let out = Folder::new("readonly");
    job().killed_after(&out.0, 2);
    let before = std::fs::read(out.0.join("results.h5")).unwrap();
    // The file that the killed run was writing may still exist.
    std::fs::remove_file(out.0.join("results.h5.part")).ok();
    std::fs::create_dir(out.0.join("results.h5.part")).unwrap();
    let reported = said(&job().run(&out.0, &["--resume"]), 1);
    assert!(reported.contains("cannot write"), "{reported}");
    assert!(std::fs::read(out.0.join("results.h5")).unwrap() == before);
}

/// Files may not grow beyond a limit, as on a full disk; the run continues when there is space.
#[cfg(unix)]
#[test]
fn a_full_disk_is_told_and_the_run_goes_on_when_there_is_room() {
    let whole = Folder::new("full-whole");
    job().done(&whole.0, &[]);
    let size = std::fs::metadata(whole.0.join("results.h5")).unwrap().len();
    let mut went_on = 0;
    for tenths in [2, 5, 7, 8, 9] {
        let out = Folder::new(&format!("full-{tenths}"));
        let blocks = size * tenths / 10 / 512;
        let inner = job().command(&out.0, &[]);
        let args: Vec<_> = inner.get_args().collect();
        let output = Command::new("sh")
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args([
                "-c",
                &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\""),
            ])
            .arg(inner.get_program())
            .args(args)
            .output()
            .unwrap();
        let reported = said(&output, 1);
        assert!(
            reported.contains("cannot write") && reported.contains("ulimit -f"),
            "{reported}"
        );
        let reported = job().done(&out.0, &["--resume"]);
        went_on += u32::from(reported.contains("resuming the run"));
        same(&whole.0, &out.0);
    }
    assert!(went_on > 0, "no limit let a checkpoint be written");
}
