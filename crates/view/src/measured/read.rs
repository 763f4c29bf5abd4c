//! Measured curves from tables: which columns are meant, and in which units.

use super::{Kind, MeasuredCurve};
use fretwork_scene::measured::{Heading, MeasuredTable};
use std::path::Path;

/// Names by which columns are known, the first of which is the usual one.
const ROLES: [(Role, &[&str]); 6] = [
    (
        Role::Delta,
        &[
            "delta",
            "δ",
            "displacement",
            "relative displacement",
            "disp",
            "slip",
        ],
    ),
    (
        Role::Force,
        &["Q", "ft", "tangential force", "friction force", "force"],
    ),
    (
        Role::Friction,
        &[
            "mu",
            "µ",
            "μ",
            "friction coefficient",
            "coefficient of friction",
            "cof",
            "q/p",
            "q / p",
        ],
    ),
    (Role::Cycle, &["cycle", "cycles", "cycle number", "n"]),
    (Role::Place, &["x", "position", "position x"]),
    (Role::Depth, &["depth", "wear depth", "scar depth"]),
];

/// Meaning of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Relative displacement.
    Delta,
    /// Tangential force.
    Force,
    /// Friction coefficient, or Q/P.
    Friction,
    /// Number of the cycle.
    Cycle,
    /// Position along a scar.
    Place,
    /// Depth of a scar, positive downwards.
    Depth,
}

impl Role {
    fn usual(self) -> &'static str {
        let own = ROLES.iter().find(|(role, _)| *role == self);
        own.map_or("", |(_, names)| names[0])
    }

    /// Returns the meaning of a name, and the body whose scar it is of: `depth_flat`.
    fn of(name: &str) -> Option<(Self, Option<String>)> {
        let plain = name.trim().replace('_', " ");
        let equal = |known: &str| known.to_lowercase() == plain.to_lowercase();
        let found = ROLES
            .iter()
            .find(|(_, names)| names.iter().any(|n| equal(n)));
        if let Some((role, _)) = found {
            return Some((*role, None));
        }
        let body = name
            .trim()
            .strip_prefix("depth_")
            .filter(|b| !b.is_empty())?;
        Some((Self::Depth, Some(body.to_owned())))
    }

    /// Whether its numbers are pure.
    fn is_pure(self) -> bool {
        matches!(self, Self::Friction | Self::Cycle)
    }
}

/// Columns that are named otherwise, and the depth of a contact that a two-dimensional run is of.
#[derive(Clone, Debug, Default)]
pub struct MeasuredColumns {
    /// For the usual name of a column (`delta`), that in the file with its unit (`Weg (um)`).
    pub named: Vec<(String, String)>,
    /// Length (m) by which forces (N) are divided for a run in two dimensions.
    pub depth: Option<f64>,
}

impl MeasuredColumns {
    /// Parses names as `delta=Weg (um)`.
    ///
    /// # Errors
    /// Returns a sentence.
    pub fn parse(texts: &[String], depth: Option<f64>) -> Result<Self, String> {
        let pair = |text: &String| {
            let both = text.split_once('=').map(|(a, b)| (a.trim(), b.trim()));
            let (name, column) = both
                .filter(|(a, b)| Role::of(a).is_some() && !b.is_empty())
                .ok_or_else(|| {
                    let known: Vec<&str> = ROLES.iter().map(|(role, _)| role.usual()).collect();
                    format!(
                        "columns: `{text}` names no column; write NAME=COLUMN (UNIT), where NAME is one of {}",
                        known.join(", ")
                    )
                })?;
            Ok((name.to_owned(), column.to_owned()))
        };
        Ok(Self {
            named: texts.iter().map(pair).collect::<Result<_, String>>()?,
            depth,
        })
    }
}

/// A column with its meaning.
struct Column {
    role: Role,
    body: Option<String>,
    place: usize,
    unit: String,
}

/// Reads measured curves from files.
///
/// # Errors
/// Returns a sentence on the first file that is no table of a loop, of friction by cycle, or of a
/// scar, or on a column that no file has.
pub fn read_measured(
    files: &[impl AsRef<Path>],
    columns: &MeasuredColumns,
) -> Result<Vec<MeasuredCurve>, String> {
    let tables: Vec<(&Path, MeasuredTable)> = files
        .iter()
        .map(|f| {
            Ok((
                f.as_ref(),
                MeasuredTable::read(f.as_ref()).map_err(|e| e.with_line())?,
            ))
        })
        .collect::<Result<_, String>>()?;
    for (_, column) in &columns.named {
        let name = Heading::parse(column).name;
        if !tables.is_empty()
            && tables
                .iter()
                .all(|(_, table)| table.column(&name).is_none())
        {
            return Err(format!(
                "columns: no measured file has a column `{name}`; {}",
                tables
                    .iter()
                    .map(|(path, table)| has(path, table))
                    .collect::<Vec<_>>()
                    .join("; ")
            ));
        }
    }
    let curve = |(path, table): &(&Path, MeasuredTable)| of_table(path, table, columns);
    tables.iter().map(curve).collect()
}

/// Returns which columns a table has, in words.
fn has(path: &Path, table: &MeasuredTable) -> String {
    let names: Vec<&str> = table.headings.iter().map(|h| h.text.as_str()).collect();
    format!("{} has the columns {}", path.display(), names.join(", "))
}

fn of_table(
    path: &Path,
    table: &MeasuredTable,
    columns: &MeasuredColumns,
) -> Result<MeasuredCurve, String> {
    let mut found: Vec<Column> = Vec::new();
    for (name, column) in &columns.named {
        let asked = Heading::parse(column);
        let Some(place) = table.column(&asked.name) else {
            continue;
        };
        let own = &table.headings[place].unit;
        if let Some((role, body)) = Role::of(name) {
            found.push(Column {
                role,
                body,
                place,
                unit: if asked.unit.is_empty() {
                    own.clone()
                } else {
                    asked.unit
                },
            });
        }
    }
    for (place, heading) in table.headings.iter().enumerate() {
        let known = |c: &Column| c.place == place;
        if let Some((role, body)) = Role::of(&heading.name).filter(|_| !found.iter().any(known)) {
            found.push(Column {
                role,
                body,
                place,
                unit: heading.unit.clone(),
            });
        }
    }
    let column = |role: Role| found.iter().find(|c| c.role == role);
    let pairs = [
        (Role::Delta, Role::Force),
        (Role::Delta, Role::Friction),
        (Role::Cycle, Role::Friction),
        (Role::Place, Role::Depth),
    ];
    let pair = pairs
        .into_iter()
        .find_map(|(x, y)| column(x).zip(column(y)));
    let (x, y) = pair.ok_or_else(|| {
        let needs: Vec<String> = pairs
            .iter()
            .map(|(x, y)| format!("`{}` and `{}`", x.usual(), y.usual()))
            .collect();
        format!(
            "{}, and needs {}: name them so, with units as in `delta (um)`, or say which they are by columns, `delta=COLUMN (um)`",
            has(path, table),
            needs.join(", or ")
        )
    })?;
    for c in [x, y] {
        if c.unit.is_empty() && !c.role.is_pure() {
            let heading = &table.headings[c.place].text;
            return Err(format!(
                "{}: the unit of `{heading}` is not known: write it in the heading, `{heading} (UNIT)`, or by columns, `{}={heading} (UNIT)`",
                path.display(),
                c.role.usual()
            ));
        }
    }
    let values = |c: &Column| table.values(c.place).map_err(|e| e.with_line());
    let kind = match (x.role, y.role) {
        (Role::Delta, Role::Force) => Kind::Loop,
        (Role::Delta, _) => Kind::Ratio,
        (Role::Cycle, _) => Kind::Cycles,
        _ => Kind::Scar(y.body.clone()),
    };
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(MeasuredCurve {
        name: name.to_string_lossy().into_owned(),
        kind,
        points: values(x)?.into_iter().zip(values(y)?).collect(),
        units: [x.unit.clone(), y.unit.clone()],
        depth: columns.depth,
    })
}
