//! `fretwork material`: list, show, check.

use super::Failure;
use super::output::{answer, answer_json, report};
use crate::scene::material::{
    InterfaceParameters, Material, MaterialClass, MaterialLibrary, Sheet, SheetNumber, doubts,
};
use crate::scene::source::ValidationError;
use clap::Subcommand;
use fretwork_observe::quantity::{number, quantity};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

pub const EXAMPLES: &str = "Examples:
  fretwork material list steel
  fretwork material show Ti-6Al-4V
  fretwork material check my_steel.ron

Files in a folder `materials` here or above precede those of the program; docs/materials.md lists
the latter.";

#[derive(Subcommand, Debug)]
pub enum MaterialCommand {
    /// The materials that cases and commands find by their names
    List {
        /// Words that name, other names, class or description have
        words: Vec<String>,
        /// Print JSON, in SI units
        #[arg(long)]
        json: bool,
    },
    /// Every number of a material with unit, range and source, and what follows from them
    Show {
        /// Name of a material (Ti-6Al-4V, rail_steel_r260), or a file of one
        name: String,
        /// Print JSON, in SI units
        #[arg(long)]
        json: bool,
    },
    /// Read the file of an own material: errors, and numbers that no solid of its class has
    Check {
        /// The file (RON)
        file: PathBuf,
    },
}

pub fn material(command: &MaterialCommand) -> Result<(), Failure> {
    match command {
        MaterialCommand::List { words, json } => list(words, *json),
        MaterialCommand::Show { name, json } => show(name, *json),
        MaterialCommand::Check { file } => check(file),
    }
}

/// The library of a case here.
fn library() -> MaterialLibrary {
    MaterialLibrary::beside(Path::new("case.ron"))
}

fn list(words: &[String], json: bool) -> Result<(), Failure> {
    let mut sheets = Vec::new();
    for listed in library().list() {
        match Sheet::listed(&listed) {
            Ok(sheet) if words.iter().all(|word| has(&sheet, word)) => sheets.push(sheet),
            Ok(_) => {}
            Err(error) => report(&format!(
                "{} is left out: {}",
                listed.name,
                error.in_short()
            )),
        }
    }
    if sheets.is_empty() {
        return Err(Failure::Usage(format!(
            "no material has `{}`; `fretwork material list` shows all",
            words.join(" ")
        )));
    }
    let place = |sheet: &Sheet| {
        let of = |class: &MaterialClass| Some(class.name()) == sheet.class.as_deref();
        MaterialClass::ALL.iter().position(of).unwrap_or(usize::MAX)
    };
    sheets.sort_by(|a, b| (place(a), &a.name).cmp(&(place(b), &b.name)));
    if json {
        return print_json(&sheets);
    }
    let head = [
        "material",
        "class",
        "E (GPa)",
        "H (GPa)",
        "kg/m^3",
        "what it is",
    ];
    let mut rows = vec![head.map(str::to_owned)];
    for sheet in &sheets {
        let in_pascal = |name: &str| sheet.properties.get(name).filter(|n| n.unit == "Pa");
        let giga = |name: &str| in_pascal(name).map_or("-".into(), |n| digits(n.value / 1e9));
        rows.push([
            sheet.name.clone(),
            sheet.class.clone().unwrap_or_else(|| "-".to_owned()),
            giga("young"),
            giga("hardness"),
            digits(sheet.density.value),
            sheet.doc.clone(),
        ]);
    }
    answer(&table(&rows, [false, false, true, true, true, false]))
}

/// Whether a material has a word, whatever its case.
fn has(sheet: &Sheet, word: &str) -> bool {
    let class = sheet.class.iter();
    let mut texts = [&sheet.name, &sheet.doc]
        .into_iter()
        .chain(class)
        .chain(&sheet.also);
    texts.any(|text| text.to_lowercase().contains(&word.to_lowercase()))
}

fn show(name: &str, json: bool) -> Result<(), Failure> {
    let sheet = Sheet::find(&library(), name)?;
    if json {
        return print_json(&sheet);
    }
    answer(&describe(&sheet))
}

fn print_json(of: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(of);
    answer_json(&text.map_err(|e| Failure::Failed(e.to_string()))?)
}

/// All of a sheet as text.
fn describe(sheet: &Sheet) -> String {
    let mut out = format!("{}: {}\n", sheet.name, sheet.doc);
    let mut line = |name: &str, text: &str| {
        if !text.is_empty() {
            let _ = writeln!(out, "  {name:<10} {text}");
        }
    };
    line("class", sheet.class.as_deref().unwrap_or_default());
    line("also", &sheet.also.join(", "));
    let file = sheet.file.as_deref().map(from_here);
    line("file", file.as_deref().unwrap_or("built in"));
    line("laws", &sheet.laws.join(", "));

    let density = std::iter::once(("density", &sheet.density));
    let properties = sheet.properties.iter().map(|(name, n)| (name.as_str(), n));
    let numbers: Vec<(&str, &SheetNumber)> = density.chain(properties).collect();
    let head = ["property", "value", "range", "given as"];
    let mut rows = vec![head.map(str::to_owned)];
    for (name, number) in &numbers {
        let range = number.range.map_or_else(String::new, |[low, high]| {
            format!(
                "{} to {}",
                in_unit(low, &number.unit),
                in_unit(high, &number.unit)
            )
        });
        let value = in_unit(number.value, &number.unit);
        let given = match given_otherwise(number) {
            true => number.given.as_str(),
            false => "",
        };
        rows.push([(*name).to_owned(), value, range, given.to_owned()]);
    }
    let _ = writeln!(out, "\n{}", table(&rows, [false; 4]));

    if !sheet.derived.is_empty() {
        let head = ["derived", "value", "from"];
        let mut rows = vec![head.map(str::to_owned)];
        for derived in &sheet.derived {
            let value = in_unit(derived.value, derived.unit);
            rows.push([derived.name, &value, derived.formula].map(str::to_owned));
        }
        let _ = writeln!(out, "\n{}", table(&rows, [false; 3]));
    }

    out.push_str("\nsources\n");
    let mut sources: Vec<(&str, Vec<&str>)> = Vec::new();
    for (name, number) in numbers {
        match sources.iter_mut().find(|s| s.0 == number.source) {
            Some(source) => source.1.push(name),
            None => sources.push((number.source.as_str(), vec![name])),
        }
    }
    for (source, names) in sources {
        let _ = writeln!(out, "  {}\n    {source}", names.join(", "));
    }
    out.trim_end().to_owned()
}

/// Whether the file has a scale of hardness, which the value in pascal does not show.
fn given_otherwise(number: &SheetNumber) -> bool {
    let unit = number.given.split_once(' ').map_or("", |parts| parts.1);
    unit.starts_with('H') && unit != number.unit
}

/// A value as it is shown.
fn in_unit(value: f64, unit: &str) -> String {
    match unit {
        "Pa" => quantity(value, unit),
        _ => format!("{} {unit}", digits(value)).trim_end().to_owned(),
    }
}

/// A number with four digits, without trailing zeros.
fn digits(x: f64) -> String {
    let text = number(x, 4);
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, ""));
    let short = match mantissa.contains('.') {
        true => mantissa.trim_end_matches('0').trim_end_matches('.'),
        false => mantissa,
    };
    match power {
        "" => short.to_owned(),
        power => format!("{short}e{power}"),
    }
}

/// Aligned columns, of which some are numbers.
fn table<const N: usize>(rows: &[[String; N]], right: [bool; N]) -> String {
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max();
    let widths: [usize; N] = std::array::from_fn(|k| width(k).unwrap_or(0));
    let mut out = String::new();
    for row in rows {
        let mut line = String::new();
        for (k, cell) in row.iter().enumerate() {
            let _ = match right[k] {
                true => write!(line, "{cell:>0$}  ", widths[k]),
                false => write!(line, "{cell:<0$}  ", widths[k]),
            };
        }
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out.trim_end().to_owned()
}

fn check(file: &Path) -> Result<(), Failure> {
    let source = MaterialLibrary::read_file(file)?;
    let has = |name: &str| {
        let path = [name.to_owned()];
        source.tree().find(source.text(), &path).is_ok()
    };
    if !has("density") && !has("properties") {
        // Errors of a file that is neither are those of a material.
        if let Ok(laws) = source.parse::<InterfaceParameters>() {
            laws.units().map_err(|fault| source.locate(fault))?;
            return answer(&format!(
                "{}: parameters of laws, which can be read; they are no material, which has a \
                 density",
                file.display()
            ));
        }
    }
    let material: Material = source.parse()?;
    material.density().map_err(|fault| source.locate(fault))?;
    if let Some(laws) = &material.laws {
        let within = |fault: ValidationError| source.locate(fault.under("laws"));
        laws.units().map_err(within)?;
    }
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let found = doubts(&material, &name);
    if found.is_empty() {
        let class = material.class.map_or("a solid", MaterialClass::name);
        return answer(&format!(
            "{}: {} numbers, each with a source, and plausible for {class}",
            file.display(),
            1 + material.properties.len()
        ));
    }
    let count = found.len();
    let located = found.into_iter().map(|doubt| source.locate(doubt));
    let lines: Vec<String> = located.map(|doubt| doubt.as_doubt()).collect();
    report(&lines.join("\n"));
    let plural = if count == 1 { "" } else { "s" };
    Err(Failure::Failed(format!(
        "{count} doubt{plural} about {}, which can be used as it is",
        file.display()
    )))
}

/// A path as seen from the working folder.
fn from_here(path: &str) -> String {
    let here = std::env::current_dir().unwrap_or_default();
    let inside = Path::new(path).strip_prefix(here).ok();
    inside.map_or_else(|| path.to_owned(), |inside| inside.display().to_string())
}
