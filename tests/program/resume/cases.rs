//! Cases that are killed, and resumed with one thread and with two: all files equal those of an
//! uninterrupted run.

use super::common::{Folder, Job, same};

/// The run is killed as soon as each of these numbers of states was saved; the result of each kill
/// is resumed twice.
fn resumes(name: &str, job: Job<'_>, states: &[u64]) {
    let whole = Folder::new(&format!("{name}-whole"));
    job.done(&whole.0, &[]);
    for states in states {
        let stopped = Folder::new(&format!("{name}-{states}-2"));
        job.killed_after(&stopped.0, *states);
        let copy = stopped.copied(&format!("{name}-{states}-1"));
        for (threads, folder) in [("1", &copy), ("2", &stopped)] {
            let reported = job.done(&folder.0, &["--resume", "--threads", threads]);
            assert!(reported.contains("resuming the run"), "{reported}");
            same(&whole.0, &folder.0);
            let again = job.done(&folder.0, &["--resume"]);
            assert!(again.contains("is finished"), "{again}");
        }
    }
}

/// The case has bonds of two kinds with damage and wear, a friction test, and profiles of the third
/// body.
#[test]
fn fretting_with_damage_in_the_plane() {
    let sets = [
        "grains.0.count=700",
        "time.step=1e-4",
        "solver.tolerance=1e-3",
        "time.end=0.056",
        "output.checkpoint=Steps(70)",
        "uncertainty.repeats=6",
        "uncertainty.steps=2",
        "output.frames=3",
        "output.figures=false",
    ];
    let job = Job {
        case: "wheel_rail_rigid",
        sets: &sets,
    };
    resumes("fretting", job, &[7]);
}

/// The run chooses its step and tolerance.
#[test]
fn a_scar_with_an_accuracy() {
    let sets = [
        "time.step=1e-3",
        "solver.tolerance=1e-4",
        "accuracy=0.003",
        "output.checkpoint=Steps(60)",
        "output.frames=2",
        "output.figures=false",
    ];
    let job = Job {
        case: "fretting_scar",
        sets: &sets,
    };
    resumes("accuracy", job, &[2, 9]);
}

/// The steps have grown: a checkpoint is between two of them.
#[test]
fn disks_at_rest_in_steps_that_grow() {
    let sets = [
        "time.end=0.04",
        "solver.tolerance=1e-3",
        "accuracy=(share: 0.2, effort: 1.0)",
        "output.checkpoint=Steps(25)",
        "output.frames=2",
        "output.figures=false",
    ];
    let job = Job {
        case: "benchmarks/disks_box_5000",
        sets: &sets,
    };
    resumes("growth", job, &[1, 2]);
}

/// The case has a height field, wear, removal of overlaps, and steps written as problems.
#[test]
fn shear_in_space() {
    let sets = [
        "time.end=0.012",
        "output.checkpoint=Steps(20)",
        "output.frames=2",
        "output.fclib=30",
    ];
    let job = Job {
        case: "shear_cell_3d",
        sets: &sets,
    };
    resumes("space", job, &[3]);
}

/// The case has phases one of which ends at rest, colours and strains that begin with the second
/// phase, and means of profiles.
#[test]
fn phases_and_measures() {
    let sets = [
        "grains.0.count=120",
        "time.end=0.8",
        "phases.0.until=AtRest(share: 1e-3, held: 0.03, at_most: 0.3)",
        "measures.0.start=0.4",
        "measures.1.start=0.4",
        // The number of places is the default one.
        "uncertainty.steps=1",
        "output.layers=Some(0.01)",
        "output.shear=Some(1.0)",
        "output.checkpoint=Steps(100)",
        "output.frames=4",
    ];
    let job = Job {
        case: "rotating_drum_2d",
        sets: &sets,
    };
    // The kills are before and after the start of the second phase.
    resumes("phases", job, &[3, 11]);
}

/// The circuit of a third body: bonds that break, debris, grains that are ejected, lost and
/// removed.
#[test]
fn the_circuit() {
    let sets = [
        "grains.0.count=300",
        "time.step=2e-5",
        "time.end=0.07",
        "output.checkpoint=Steps(150)",
        "uncertainty.repeats=5",
        "uncertainty.steps=2",
        "output.frames=2",
        "output.fclib=30",
    ];
    let job = Job {
        case: "third_body_steady",
        sets: &sets,
    };
    // The kill is after the slider began to tear off grains at 0.05 s.
    resumes("circuit", job, &[20]);
}

/// The case has a profile that wears, and jumps over cycles.
#[test]
fn scars_and_jumps() {
    // A row of the statistics is begun before some checkpoints and ends after.
    let sets = [
        "output.checkpoint=Steps(300)",
        "uncertainty.repeats=8",
        "output.frames=2",
        "output.every=40",
    ];
    let job = Job {
        case: "fretting_wear_jump",
        sets: &sets,
    };
    resumes("jumps", job, &[5]);
    let sets = [
        "time.step=5e-5",
        "time.end=0.2",
        "output.checkpoint=Steps(300)",
    ];
    let job = Job {
        case: "punch_scar",
        sets: &sets,
    };
    resumes("scar", job, &[4]);
}

/// The case has walls with a servo, stages, a shear band, and the reference state of a biaxial
/// test.
#[test]
fn a_biaxial_test() {
    let sets = [
        "grains.0.count=200",
        "grains.0.radius=(9e-3, 18e-3)",
        "time.end=0.5",
        "output.checkpoint=Steps(200)",
        "output.frames=1",
    ];
    let job = Job {
        case: "biaxial",
        sets: &sets,
    };
    resumes("biaxial", job, &[3]);
}

/// Deformable bodies: displacements, velocities, and the factor, which is formed again.
#[test]
fn deformable_bodies() {
    let sets = [
        "time.end=0.012",
        "output.checkpoint=Steps(4)",
        "output.frames=2",
        "output.views=10",
        "output.figures=false",
    ];
    let job = Job {
        case: "cylinder_on_flat_fretting",
        sets: &sets,
    };
    resumes("deformable", job, &[3]);
    let phases = r#"phases=[
        (name: "press", until: AtRest(energy: Some(1e9), held: 1e-3)),
        (name: "rub", drives: {"cylinder.top": (x: Displacement(Sine(amplitude: 2e-6, frequency: 20.0)))}),
    ]"#;
    let held = ["elastic.cylinder.supports.0.x=Fixed", phases];
    let job = Job {
        case: "cylinder_on_flat_fretting",
        sets: &[&sets[..], &held].concat(),
    };
    resumes("deformable-phases", job, &[3]);
}

/// Half-spaces: one that wears under a friction test, and two that roll, in which a step begins
/// with the forces of the previous one.
#[test]
fn half_spaces() {
    let sets = [
        "time.end=0.03",
        "output.checkpoint=Steps(20)",
        "output.frames=2",
        "output.figures=false",
    ];
    let job = Job {
        case: "fretting_wear_elastic",
        sets: &sets,
    };
    resumes("half-spaces-wear", job, &[3]);
    let sets = [
        "time.end=0.03",
        "output.checkpoint=Steps(100)",
        "output.figures=false",
    ];
    let job = Job {
        case: "carter_rolling",
        sets: &sets,
    };
    resumes("half-spaces-roll", job, &[4]);
}
