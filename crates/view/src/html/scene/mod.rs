//! The scene over time for the viewer: grains, contacts, first bodies and meshes of the recorded
//! states. Numbers are quantised, and each state is packed separately, so that the browser unpacks
//! only what it shows.

mod bodies;
mod contacts;
mod detail;
mod grains;
mod meshes;
mod outline;
mod range;
mod states;

use crate::html::arrays::{Arrays, NumberType};
use crate::html::folder::RunFolder;
use bodies::Bodies;
use contacts::Contacts;
use detail::Detail;
use fretwork_scene::Case;
use fretwork_scene::source::Source;
use grains::Grains;
use meshes::Meshes;
use range::Ranges;
use serde_json::{Value, json};
use std::collections::HashSet;

/// The scene of a page.
pub(crate) struct Scene {
    /// Metadata that the viewer needs besides the numbers.
    pub head: Value,
    /// The arrays of the first state, and for each later state the arrays that differ from it.
    pub frames: Vec<String>,
    /// What was omitted or made coarser, in sentences.
    pub said: Vec<String>,
}

/// Readers of the parts of a state.
struct Reading<'a> {
    run: &'a RunFolder,
    dimension: usize,
    grains: Grains,
    contacts: Contacts,
    bodies: Bodies,
    meshes: Meshes,
}

impl Scene {
    /// Reads the states of a run into about `bytes` of the page at most; `None` if no state was
    /// recorded.
    pub fn read(run: &RunFolder, bytes: Option<usize>, gaps: &mut Vec<String>) -> Option<Self> {
        match Self::try_read(run, bytes) {
            Ok(scene) => scene,
            Err(reason) => {
                gaps.push(format!("The states of the scene cannot be read: {reason}."));
                None
            }
        }
    }

    fn try_read(run: &RunFolder, bytes: Option<usize>) -> Result<Option<Self>, String> {
        let times = states::times(run)?;
        if times.is_empty() {
            return Ok(None);
        }
        let meshes = Meshes::find(run)?;
        let mut reading = Reading {
            run,
            dimension: run.dimension(),
            grains: Grains::find(run, meshes.grains())?,
            contacts: Contacts::find(run),
            bodies: Bodies::default(),
            meshes,
        };
        let last = times.len() - 1;
        let (detail, size) = reading.choose_detail(last, bytes)?;
        let mut fits = bytes.map_or(times.len(), |b| (b / size.max(1)).max(1));
        let (mut ranges, mut chosen, mut frames);
        loop {
            ranges = Ranges::default();
            chosen = spread(times.len(), fits);
            frames = reading.frames(&chosen, detail, &mut ranges)?;
            let taken: usize = frames.iter().map(String::len).sum();
            // States differ in size, so states beyond the limit are omitted.
            match bytes.filter(|b| taken > *b && fits > 1) {
                Some(bytes) => fits = (chosen.len() * bytes / taken).clamp(1, chosen.len() - 1),
                None => break,
            }
        }
        let shown: Vec<f64> = chosen.iter().map(|k| times[*k]).collect();
        let mut said = detail.sentences();
        if chosen.len() < times.len() {
            said.insert(
                0,
                format!(
                    "{} of the {} recorded states are shown",
                    chosen.len(),
                    times.len()
                ),
            );
        }
        let head = json!({
            "dimension": reading.dimension,
            "period": period(run),
            "times": shown,
            "states": chosen,
            "recorded": times.len(),
            "grains": {"fields": reading.grains.fields(&ranges)},
            "contacts": {"fields": reading.contacts.fields(&ranges, detail)},
            "meshes": reading.meshes.head(&ranges),
            "bodies": body_names(run),
        });
        Ok(Some(Self { head, frames, said }))
    }
}

impl Reading<'_> {
    /// Returns the packed states of the page.
    fn frames(
        &mut self,
        chosen: &[usize],
        detail: Detail,
        ranges: &mut Ranges,
    ) -> Result<Vec<String>, String> {
        let first = self.state(chosen[0], detail, Some(ranges))?;
        let mut frames = vec![first.packed()];
        for k in &chosen[1..] {
            let state = self.state(*k, detail, Some(ranges))?;
            frames.push(state.without_those_of(&first).packed());
        }
        Ok(frames)
    }

    /// Returns the finest detail at which enough states fit, and the packed size of a state besides
    /// the first one.
    fn choose_detail(
        &mut self,
        last: usize,
        bytes: Option<usize>,
    ) -> Result<(Detail, usize), String> {
        let mut detail = Detail::default();
        loop {
            let first = self.state(0, detail, None)?;
            let middle = self
                .state(last / 2, detail, None)?
                .without_those_of(&first)
                .packed()
                .len();
            let end = self
                .state(last, detail, None)?
                .without_those_of(&first)
                .packed()
                .len();
            let size = (middle + end) / 2;
            let Some(bytes) = bytes else {
                return Ok((detail, size));
            };
            let fits = bytes / size.max(1);
            match detail.coarser(fits.min(last + 1), last + 1, size, bytes) {
                Some(next) => detail = next,
                None => return Ok((detail, size)),
            }
        }
    }

    /// The arrays of a state.
    fn state(
        &mut self,
        state: usize,
        detail: Detail,
        mut ranges: Option<&mut Ranges>,
    ) -> Result<Arrays, String> {
        let mut arrays = Arrays::default();
        let mut note = |group: &str, name: &str, values: &[f64]| {
            if let Some(ranges) = ranges.as_deref_mut() {
                ranges.note(group, name, values);
            }
        };
        let run = self.run;
        self.grains
            .read(run, state, detail, &mut arrays, &mut note)?;
        self.contacts
            .read(run, state, detail, self.dimension, &mut arrays, &mut note)?;
        let surfaces = self
            .meshes
            .read(run, state, self.dimension, &mut arrays, &mut note)?;
        let of_grains = self.grains.shaped();
        let skip = |id: u64, at: [f64; 3]| of_grains.contains(&id) || surfaces.contains(&place(at));
        self.bodies.read(
            run,
            state,
            self.dimension,
            self.grains.places(),
            &skip,
            &mut arrays,
        )?;
        Ok(arrays)
    }
}

/// Callback that receives the values of a field by group and name.
pub(super) type Note<'a> = dyn FnMut(&str, &str, &[f64]) + 'a;

/// Rounds a position to 1e-9 m, so that it can be looked up.
fn place(at: [f64; 3]) -> [i64; 3] {
    at.map(|x| (x * 1e12).round() as i64)
}

/// Set of rounded positions of points.
type Places = HashSet<[i64; 3]>;

/// Selects `most` of `count` states at equal distances, including the first and the last; only the
/// last if `most` is 1.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if most >= count {
        return (0..count).collect();
    }
    if most <= 1 {
        return vec![count - 1];
    }
    (0..most).map(|k| k * (count - 1) / (most - 1)).collect()
}

fn parsed(run: &RunFolder) -> Option<Case> {
    Case::read(&Source::from_text("case", run.case_text.as_str())).ok()
}

/// Length of the period along each axis; null if the axis is not periodic.
fn period(run: &RunFolder) -> Value {
    let period = parsed(run).map(|c| c.periodic).unwrap_or_default();
    json!([period.x, period.y, period.z])
}

/// Names of the first bodies of the case.
fn body_names(run: &RunFolder) -> Value {
    let names = parsed(run).map(|c| c.bodies.into_iter().map(|b| b.name).collect::<Vec<_>>());
    json!(names.unwrap_or_default())
}

/// Adds the coordinates of points as one array per axis; the third only in 3D.
fn push_points(arrays: &mut Arrays, name: &str, points: &[f64], dimension: usize) {
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate().take(dimension) {
        let values: Vec<f64> = points.iter().skip(axis).step_by(3).copied().collect();
        arrays.push(format!("{name}.{letter}"), NumberType::U16, &values);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_spread_from_the_first_to_the_last() {
        assert_eq!(spread(5, 9), [0, 1, 2, 3, 4]);
        assert_eq!(spread(101, 5), [0, 25, 50, 75, 100]);
        assert_eq!(spread(7, 2), [0, 6]);
        assert_eq!(spread(7, 1), [6]);
    }
}
