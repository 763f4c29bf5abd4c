//! Contacts of a state: lines with fields.

use super::detail::Detail;
use super::range::{FieldInfo, Ranges};
use super::{Note, push_points, states};
use crate::html::arrays::{Arrays, NumberType};
use crate::html::folder::RunFolder;
use serde_json::Value;

const ROOT: &str = "views/contacts";

/// The fields of contacts.
#[derive(Default)]
pub(super) struct Contacts(Vec<FieldInfo>);

impl Contacts {
    /// Finds the fields of contacts.
    pub fn find(run: &RunFolder) -> Self {
        Self(FieldInfo::numbers(run, &format!("{ROOT}/CellData")))
    }

    /// The fields for the page.
    pub fn fields(&self, ranges: &Ranges, detail: Detail) -> Value {
        let kept = self.0.iter();
        let kept = kept.filter(|f| detail.contacts() && detail.keeps(&f.name));
        kept.filter_map(|f| ranges.head("contacts", &f.name, f))
            .collect()
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
        for FieldInfo { name, .. } in self.0.iter().filter(|f| detail.keeps(&f.name)) {
            let values = run
                .reader
                .values(&format!("{ROOT}/CellData/{name}"), rows, 1)?;
            note("contacts", name, &values);
            let kind = if name.starts_with("body_") {
                NumberType::U32
            } else {
                detail.kind()
            };
            arrays.push(format!("contact:{name}"), kind, &values);
        }
        Ok(())
    }
}
