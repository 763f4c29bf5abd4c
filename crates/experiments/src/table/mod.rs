//! Tables: columns of numbers or texts, a row for each run, setting or point.

pub mod cells;
pub mod csv;
#[cfg(feature = "parquet")]
pub mod parquet;

/// A value of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// No value: not run, or the run has no such value.
    Unknown,
}

/// Type of the cells of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnType {
    /// Numbers.
    Real,
    /// Whole numbers.
    Whole,
    /// Texts.
    Text,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// SI unit, `1` for pure numbers; empty for texts and where it is unknown.
    pub unit: String,
    /// Type of the cells.
    pub kind: ColumnType,
    /// One cell for each row.
    pub cells: Vec<Cell>,
}

impl Column {
    /// Creates a column of numbers of a unit, which is `1` for pure numbers and empty where it is
    /// unknown; `None` is an unknown value.
    pub fn real(
        name: impl Into<String>,
        unit: impl Into<String>,
        values: impl IntoIterator<Item = Option<f64>>,
    ) -> Self {
        let cell = |x: Option<f64>| x.map_or(Cell::Unknown, Cell::Number);
        Self {
            name: name.into(),
            unit: unit.into(),
            kind: ColumnType::Real,
            cells: values.into_iter().map(cell).collect(),
        }
    }

    /// Creates a column of whole numbers without unit; `None` is unknown.
    pub fn whole(name: impl Into<String>, values: impl IntoIterator<Item = Option<f64>>) -> Self {
        Self {
            kind: ColumnType::Whole,
            ..Self::real(name, "1", values)
        }
    }

    /// Creates a column of texts; an empty text is unknown.
    pub fn text(name: impl Into<String>, texts: impl IntoIterator<Item = String>) -> Self {
        let cell = |text: String| match text.is_empty() {
            true => Cell::Unknown,
            false => Cell::Text(text),
        };
        Self {
            name: name.into(),
            unit: String::new(),
            kind: ColumnType::Text,
            cells: texts.into_iter().map(cell).collect(),
        }
    }

    /// Returns the text of a row; empty for other types.
    pub fn text_of(&self, row: usize) -> &str {
        match self.cells.get(row) {
            Some(Cell::Text(text)) => text,
            _ => "",
        }
    }
}

/// Columns of the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Columns of the table.
    pub columns: Vec<Column>,
}

impl Table {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.cells.len())
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name)
    }

    /// Returns the text of a row in the column of a name; empty if there is none.
    pub fn text(&self, name: &str, row: usize) -> &str {
        self.column(name).map_or("", |c| c.text_of(row))
    }
}
