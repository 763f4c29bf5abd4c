//! Contacts of a state: lines with fields.

use super::detail::Detail;
use super::range::Ranges;
use super::{Note, push_points, states};
use crate::html::arrays::{Arrays, Kind};
use crate::html::folder::RunFolder;
use serde_json::{Value, json};

const ROOT: &str = "views/contacts";

/// The fields of contacts: name, unit, description.
#[derive(Default)]
pub(super) struct Contacts(Vec<[String; 3]>);

impl Contacts {
    /// Finds the fields.
    pub fn find(run: &RunFolder) -> Self {
        let group = format!("{ROOT}/CellData");
        let field = |name: &str| {
            let (unit, doc) = run.reader.described(&format!("{group}/{name}"));
            [name.to_owned(), unit, doc]
        };
        // Numbers: the components of vectors are fields of their own.
        let numbers = run
            .reader
            .datasets_in(&group)
            .filter(|name| run.reader.width(&format!("{group}/{name}")) == Ok(1));
        Self(numbers.map(field).collect())
    }

    /// The fields for the page.
    pub fn fields(&self, ranges: &Ranges, detail: Detail) -> Value {
        let kept = self
            .0
            .iter()
            .filter(|f| detail.contacts() && detail.keeps(&f[0]));
        let field = |[name, unit, doc]: &[String; 3]| {
            let range = ranges.of("contacts", name)?;
            Some(
                json!({"name": name, "unit": unit, "doc": doc, "all": range.all, "most": range.most}),
            )
        };
        kept.filter_map(field).collect()
    }

    /// Adds the arrays of a state.
    pub fn read(
        &self,
        run: &RunFolder,
        state: usize,
        detail: Detail,
        dimension: usize,
        arrays: &mut Arrays,
        note: &mut Note<'_>,
    ) -> Result<(), String> {
        if !detail.contacts() {
            return Ok(());
        }
        let points = run.reader.values(
            &format!("{ROOT}/Points"),
            states::points(run, "contacts", state)?,
            3,
        )?;
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for pair in points.chunks_exact(6) {
            from.extend_from_slice(&pair[..3]);
            to.extend_from_slice(&pair[3..]);
        }
        push_points(arrays, "contact.a", &from, dimension);
        push_points(arrays, "contact.b", &to, dimension);
        let rows = states::cells(run, "contacts", ("Lines", 1), state)?;
        for [name, ..] in self.0.iter().filter(|f| detail.keeps(&f[0])) {
            let values = run
                .reader
                .values(&format!("{ROOT}/CellData/{name}"), rows, 1)?;
            note("contacts", name, &values);
            let kind = if name.starts_with("body_") {
                Kind::U32
            } else {
                detail.kind()
            };
            arrays.push(format!("contact:{name}"), kind, &values);
        }
        Ok(())
    }
}
