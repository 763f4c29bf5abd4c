//! Published numbers beside ours: runs the studies of `validation/`, draws a figure for each
//! comparison and writes `docs/validation.md` and a page of each in `docs/validation/`.
//!
//! `cargo run --release --example validation -- [NAME...] [--jobs N] [--program FILE] [--no-runs]`,
//! from the root of the project. With names only their studies are run; the pages are always those
//! of all comparisons. Runs are kept in `target/validation` and are not made twice by one program;
//! another program makes them anew. With `--no-runs` the pages are written from the tables that are
//! there.

mod biaxial;
mod cohesive_shear;
mod comparison;
mod page;
mod plane_shear;
mod polygons;
mod published;
mod row;
mod sample;
mod smallest_particle;
mod soft_third_body;
mod table;
mod third_body;
mod wet_spheres;

use comparison::{Comparison, Failure};
use std::path::{Path, PathBuf};
use std::process::Command;

/// In the order of the page.
const ALL: [Comparison; 8] = [
    plane_shear::COMPARISON,
    cohesive_shear::COMPARISON,
    biaxial::COMPARISON,
    third_body::COMPARISON,
    polygons::COMPARISON,
    soft_third_body::COMPARISON,
    wet_spheres::COMPARISON,
    smallest_particle::COMPARISON,
];

struct Options {
    names: Vec<String>,
    jobs: String,
    program: PathBuf,
    runs: bool,
}

fn options() -> Result<Options, Failure> {
    let mut options = Options {
        names: Vec::new(),
        jobs: "1".to_owned(),
        program: PathBuf::from("target/release/fretwork"),
        runs: true,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("`{word}` needs a value"));
        match word.as_str() {
            "--jobs" => options.jobs = value()?,
            "--program" => options.program = PathBuf::from(value()?),
            "--no-runs" => options.runs = false,
            name if ALL.iter().any(|c| c.name == name) => options.names.push(word),
            other => {
                let names = ALL.map(|c| c.name).join(", ");
                return Err(format!("there is no comparison `{other}`; there are {names}").into());
            }
        }
    }
    Ok(options)
}

fn main() -> Result<(), Failure> {
    let options = options()?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let wanted =
        |c: &Comparison| options.names.is_empty() || options.names.iter().any(|n| n == c.name);
    for study in ALL.iter().filter(|c| wanted(c)).flat_map(|c| c.studies) {
        make(root, study, &options)?;
    }
    let mut sections = Vec::new();
    for comparison in &ALL {
        let section = page::Section::of(root, comparison)?;
        section.draw(root)?;
        sections.push(section);
    }
    let pages = root.join("docs/validation");
    std::fs::create_dir_all(&pages)?;
    for section in &sections {
        let path = pages.join(format!("{}.md", section.name()));
        std::fs::write(path, section.page())?;
    }
    let overview = root.join("docs/validation.md");
    std::fs::write(overview, page::overview(&sections))?;
    println!("written to docs/validation.md and docs/validation");
    Ok(())
}

/// Makes the missing runs of a study, and its table.
fn make(root: &Path, study: &str, options: &Options) -> Result<(), Failure> {
    let out = comparison::folder(root, study);
    if !options.runs && out.join("table.csv").exists() {
        return Ok(());
    }
    let task = if options.runs { "run" } else { "collect" };
    if task == "collect" && !out.exists() {
        return Ok(());
    }
    let mut command = Command::new(&options.program);
    command.current_dir(root).args(["study", task]);
    command
        .arg(format!("validation/{study}.ron"))
        .arg("--out")
        .arg(&out);
    if options.runs {
        command.args(["--jobs", &options.jobs]);
    }
    let status = command.status().map_err(|e| {
        format!(
            "{}: {e}; name the program by `--program`",
            options.program.display()
        )
    })?;
    // A study that cannot be collected has no results; the program has printed the reason.
    if !status.success() && options.runs {
        return Err(format!("the study `{study}` ended with {status}").into());
    }
    Ok(())
}
