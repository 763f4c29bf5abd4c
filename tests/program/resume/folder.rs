//! Content of a folder besides a state: settings that change no number, files of older runs,
//! summaries of other runs.

use super::common::{Folder, Job, draft, files, said, same};

const SETS: [&str; 4] = [
    "time.end=0.004",
    "output.checkpoint=Steps(8)",
    "output.frames=0",
    "output.figures=false",
];

fn stopped_job() -> Job<'static> {
    job(&SETS)
}

fn job(sets: &'static [&'static str]) -> Job<'static> {
    Job {
        case: "shear_cell_3d",
        sets,
    }
}

#[test]
fn checkpoints_and_figures_may_be_others_when_a_run_goes_on() {
    const OTHER: [&str; 4] = [
        "time.end=0.004",
        "output.checkpoint=Never",
        "output.frames=0",
        "output.figures=true",
    ];
    let (out, whole) = (Folder::new("free"), Folder::new("free-whole"));
    job(&SETS).killed_after(&out.0, 2);
    let reported = job(&OTHER).done(&out.0, &["--resume"]);
    assert!(reported.contains("resuming the run"), "{reported}");
    job(&OTHER).done(&whole.0, &[]);
    assert!(out.0.join("energy.png").exists());
    same(&whole.0, &out.0);
}

#[test]
fn files_of_an_older_run_go_and_those_of_others_stay() {
    const MANY: [&str; 5] = [
        "time.end=0.004",
        "output.frames=4",
        "output.fclib=10",
        "output.figures=true",
        "output.width=200",
    ];
    const FEW: [&str; 4] = [
        "time.end=0.003",
        "output.frames=1",
        "output.figures=false",
        "output.width=200",
    ];
    let (out, fresh) = (Folder::new("older"), Folder::new("older-fresh"));
    job(&MANY).done(&out.0, &[]);
    let before = files(&out.0);
    for name in [
        "frames/frame_00000040.png",
        "fclib/step-00000040.hdf5",
        "energy.png",
    ] {
        assert!(before.iter().any(|f| f == name), "{name}: {before:?}");
    }
    let own = [
        "frames/frame_1.png",
        "frames/notes_00000040.png",
        "fclib/mine.hdf5",
        "my_energy.png",
    ];
    for name in own {
        std::fs::write(out.0.join(name), "mine").unwrap();
    }
    // A run that cannot begin removes nothing.
    let refused = Job {
        case: "shear_cell_3d",
        sets: &["time.end=-1.0"],
    };
    assert!(!refused.run(&out.0, &[]).status.success());
    assert!(before.iter().all(|f| out.0.join(f).exists()));
    // One that would replace results of other inputs, too, unless it is told to.
    let reported = said(&job(&FEW).run(&out.0, &[]), 2);
    assert!(reported.contains("`time.end` was 0.004"), "{reported}");
    assert!(before.iter().all(|f| out.0.join(f).exists()));
    job(&FEW).done(&out.0, &["--force"]);
    job(&FEW).done(&fresh.0, &[]);
    let mut expected = files(&fresh.0);
    expected.extend(own.map(str::to_owned));
    expected.sort();
    assert_eq!(files(&out.0), expected);
    for name in own {
        assert_eq!(std::fs::read(out.0.join(name)).unwrap(), b"mine");
        std::fs::remove_file(out.0.join(name)).unwrap();
    }
    same(&fresh.0, &out.0);
}

#[test]
fn a_summary_of_another_run_ends_none() {
    const OTHER: [&str; 3] = ["time.end=0.002", "output.frames=0", "output.figures=false"];
    let whole = Folder::new("summary-whole");
    job(&SETS).done(&whole.0, &[]);
    let other = Folder::new("summary-other");
    job(&OTHER).done(&other.0, &[]);
    let out = Folder::new("summary");
    // The summary is that of another case, or of another run of the same case: the file shows that
    // the run is not at its end.
    for from in [&other, &whole] {
        std::fs::remove_dir_all(&out.0).ok();
        job(&SETS).killed_after(&out.0, 2);
        std::fs::copy(from.0.join("summary.json"), out.0.join("summary.json")).unwrap();
        let reported = job(&SETS).done(&out.0, &["--resume"]);
        assert!(reported.contains("resuming the run"), "{reported}");
        same(&whole.0, &out.0);
    }
    // The run is at its end, but the folder has the summary of another case.
    std::fs::copy(other.0.join("summary.json"), out.0.join("summary.json")).unwrap();
    let reported = job(&SETS).done(&out.0, &["--resume"]);
    assert!(reported.contains("resuming the run"), "{reported}");
    same(&whole.0, &out.0);
    let reported = job(&SETS).done(&out.0, &["--resume"]);
    assert!(reported.contains("is finished"), "{reported}");
}

/// The total length of a run determines the spacing of states and pictures: without them an
/// extended run equals one that was longer from its start.
#[test]
fn a_run_goes_on_beyond_its_end() {
    const SHORT: [&str; 4] = [
        "time.end=0.04",
        "output.checkpoint=Steps(40)",
        "output.frames=0",
        "output.views=0",
    ];
    const LONG: [&str; 4] = [
        "time.end=0.06",
        "output.checkpoint=Steps(40)",
        "output.frames=0",
        "output.views=0",
    ];
    let job = |sets: &'static [&'static str]| Job {
        case: "plane_shear",
        sets,
    };
    let long = Folder::new("long");
    job(&LONG).done(&long.0, &[]);
    // The run was killed, or is at its end.
    for killed in [true, false] {
        let out = Folder::new(if killed { "longer-killed" } else { "longer" });
        if killed {
            job(&SHORT).killed_after(&out.0, 2);
        } else {
            job(&SHORT).done(&out.0, &[]);
        }
        let reported = job(&LONG).done(&out.0, &["--resume"]);
        assert!(reported.contains("resuming the run"), "{reported}");
        same(&long.0, &out.0);
        // An extended run cannot return to an earlier end.
        let reported = said(&job(&SHORT).run(&out.0, &["--resume"]), 2);
        assert!(
            reported.contains("`time.end` was 0.06 in the original run"),
            "{reported}"
        );
    }
}

/// A run without states has nothing to continue from, and is kept.
#[test]
fn a_run_without_states_is_not_replaced_by_a_longer_one() {
    const SHORT: [&str; 3] = [
        "time.end=0.004",
        "output.checkpoint=Never",
        "output.figures=false",
    ];
    const LONG: [&str; 3] = [
        "time.end=0.006",
        "output.checkpoint=Never",
        "output.figures=false",
    ];
    let (out, before) = (Folder::new("short"), Folder::new("short-before"));
    job(&SHORT).done(&out.0, &[]);
    job(&SHORT).done(&before.0, &[]);
    let reported = said(&job(&LONG).run(&out.0, &["--resume"]), 1);
    assert!(
        reported.contains("`output.checkpoint: Never`"),
        "{reported}"
    );
    same(&before.0, &out.0);
}

/// A run of any length keeps a state before its end, so that it can be longer than it was.
#[test]
fn a_short_run_goes_on_beyond_its_end() {
    const SETS: [&str; 2] = ["output.frames=0", "output.views=0"];
    let with = |end: &'static str| [&SETS[..], &[end]].concat();
    let (first, later) = (with("time.end=0.004"), with("time.end=0.006"));
    let job = |sets| Job {
        case: "plane_shear",
        sets,
    };
    let (out, long) = (Folder::new("brief"), Folder::new("brief-long"));
    job(&first).done(&out.0, &[]);
    job(&later).done(&long.0, &[]);
    let reported = job(&later).done(&out.0, &["--resume"]);
    assert!(reported.contains("resuming the run"), "{reported}");
    same(&long.0, &out.0);
}

/// Only the same finished run is replaced unasked; the refusal names commands that work.
#[test]
fn results_of_another_run_are_kept() {
    const SETS: [&str; 3] = ["output.frames=0", "output.figures=false", "time.end=0.002"];
    const OTHER: [&str; 3] = ["output.frames=0", "output.figures=false", "seed=7"];
    const LONGER: [&str; 3] = ["output.frames=0", "output.figures=false", "time.end=0.003"];
    let job = |sets: &'static [&'static str]| Job {
        case: "plane_shear",
        sets,
    };
    let out = Folder::new("kept");
    let kept = |reported: &str, words: &[&str]| {
        for word in ["nothing was changed", "--out", "-2", "--force"] {
            assert!(reported.contains(word), "{word}: {reported}");
        }
        for word in words {
            assert!(reported.contains(word), "{word}: {reported}");
        }
    };
    job(&SETS).done(&out.0, &[]);
    let before = std::fs::read(out.0.join("results.h5")).unwrap();
    kept(
        &said(&job(&OTHER).run(&out.0, &[]), 2),
        &[
            "a run of other inputs",
            "`seed` was 19 in the original run and is 7 now",
        ],
    );
    kept(
        &said(&job(&LONGER).run(&out.0, &[]), 2),
        &["up to an earlier `time.end`, 0.002 s", "--resume"],
    );
    assert!(std::fs::read(out.0.join("results.h5")).unwrap() == before);
    // The same run again gives the same results.
    job(&SETS).done(&out.0, &[]);
    job(&LONGER).done(&out.0, &["--force"]);
    kept(
        &said(&job(&SETS).run(&out.0, &[]), 2),
        &["`time.end` was 0.003"],
    );
    // A run that was stopped is not begun again, but continued.
    let out = Folder::new("kept-stopped");
    let long = stopped_job();
    long.killed_after(&out.0, 2);
    kept(
        &said(&long.run(&out.0, &[]), 2),
        &["this run, which is not at its end", "--resume"],
    );
    long.done(&out.0, &["--resume"]);
    // What cannot be read is not replaced either.
    std::fs::write(out.0.join("results.h5"), "no results").unwrap();
    kept(&said(&long.run(&out.0, &[]), 2), &["cannot be read"]);
    long.done(&out.0, &["--force"]);
}

#[test]
fn states_keep_their_spacing_beyond_the_end() {
    const SHORT: [&str; 4] = [
        "time.end=0.04",
        "output.checkpoint=Steps(40)",
        "output.frames=0",
        "output.views=4",
    ];
    const LONG: [&str; 4] = [
        "time.end=0.06",
        "output.checkpoint=Steps(40)",
        "output.frames=0",
        "output.views=6",
    ];
    const LATER: [&str; 4] = [
        "time.end=0.06",
        "output.checkpoint=Steps(40)",
        "output.frames=0",
        "output.views=4",
    ];
    let job = |sets: &'static [&'static str]| Job {
        case: "plane_shear",
        sets,
    };
    let times = |out: &Folder| {
        let file = hdf5::H5File::open(out.0.join("results.h5")).unwrap();
        let names = file.dataset_names();
        let name = names.iter().find(|n| n.ends_with("Steps/Values")).unwrap();
        file.dataset(name).unwrap().read_raw::<f64>().unwrap()
    };
    let (out, long) = (Folder::new("spacing"), Folder::new("spacing-long"));
    job(&SHORT).done(&out.0, &[]);
    job(&LATER).done(&out.0, &["--resume"]);
    job(&LONG).done(&long.0, &[]);
    assert_eq!(times(&out), times(&long));
    assert_eq!(times(&out).len(), 7);
}

#[test]
fn what_hangs_on_the_end_is_refused_a_later_one() {
    const LATER: [&str; 4] = [
        "time.end=0.005",
        "output.checkpoint=Steps(8)",
        "output.frames=0",
        "output.figures=false",
    ];
    let out = Folder::new("later");
    job(&SETS).killed_after(&out.0, 2);
    let before = std::fs::read(out.0.join("results.h5")).unwrap();
    let drafted = draft(&out.0);
    let reported = said(&job(&LATER).run(&out.0, &["--resume"]), 2);
    for word in [
        "beyond its `time.end`",
        "second half of the whole run",
        "--force in place of --resume",
    ] {
        assert!(reported.contains(word), "{reported}");
    }
    // Without the option it is not offered either.
    let reported = said(&job(&LATER).run(&out.0, &[]), 2);
    assert!(
        reported.contains("cannot go on from there: a friction test without a period"),
        "{reported}"
    );
    assert!(!reported.contains("--resume"), "{reported}");
    assert!(std::fs::read(out.0.join("results.h5")).unwrap() == before);
    let left = draft(&out.0);
    assert!(left.is_none() || left == drafted, "a draft was left");
    job(&SETS).done(&out.0, &["--resume"]);
}

/// Two runs of one case differ only in the values that the documentation excepts.
#[test]
fn two_runs_differ_in_what_the_clock_gives_alone() {
    let docs = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/checkpoints.md"));
    let docs = docs.unwrap();
    let paragraph = docs
        .split("\n\n")
        .find(|p| p.contains("are equal, except for"))
        .unwrap();
    let excepted = paragraph.split("are equal, except for").nth(1).unwrap();
    let excepted = excepted.split('.').next().unwrap();
    let named: Vec<&str> = excepted.split('`').skip(1).step_by(2).collect();
    let listed: Vec<&str> = fretwork::record::summary::NOT_REPRODUCIBLE
        .iter()
        .filter_map(|pointer| pointer.rsplit('/').next())
        .collect();
    assert_eq!(named, listed);
    let (one, other) = (Folder::new("clock-1"), Folder::new("clock-2"));
    job(&SETS).done(&one.0, &[]);
    job(&SETS).done(&other.0, &["--threads", "2"]);
    same(&one.0, &other.0);
}

/// A process that is ended while it makes the report leaves a complete run: the next command makes
/// the page.
#[test]
fn a_finished_run_without_its_report_gets_it() {
    let (out, whole) = (Folder::new("no-page"), Folder::new("no-page-whole"));
    job(&SETS).done(&whole.0, &[]);
    job(&SETS).done(&out.0, &["--no-report"]);
    assert!(!out.0.join("report.html").exists());
    std::fs::write(out.0.join("report.html.part"), "half a page").unwrap();
    let reported = job(&SETS).done(&out.0, &["--resume"]);
    assert!(
        reported.contains("nothing to do") && reported.contains("report in"),
        "{reported}"
    );
    same(&whole.0, &out.0);
}
