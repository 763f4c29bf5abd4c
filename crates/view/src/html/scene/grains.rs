//! Grains of a state: balls and convex parts with their shapes, positions, orientations and fields.

use super::detail::Detail;
use super::outline::{flat, solid};
use super::range::{FieldInfo, Ranges};
use super::{Note, push_points, states};
use crate::html::arrays::{Arrays, NumberType};
use crate::html::folder::RunFolder;
use fretwork_store::results::shapes::Shaped;
use fretwork_store::results::shapes::ShapedPiece;
use serde_json::Value;
use std::collections::{HashMap, HashSet};

const ROOT: &str = "views/grains/PointData";
/// Fields that define the geometry, and are not offered as colours.
const OF_GEOMETRY: [&str; 7] = [
    "angle",
    "orientation_w",
    "orientation_x",
    "orientation_y",
    "orientation_z",
    "removed",
    // Older files use this name.
    "gone",
];

/// Fields that the page derives from the components of the velocity.
const SPEED: &str = "speed";

/// The grains of a run.
#[derive(Default)]
pub(super) struct Grains {
    dimension: usize,
    fields: Vec<FieldInfo>,
    /// Indices of the convex parts of a body in the list of outlines, in the order of the view.
    parts: HashMap<u64, Vec<usize>>,
    pieces: Vec<ShapedPiece>,
    /// Identities of grains that other views show, as meshes.
    meshed: HashSet<u64>,
    shaped: HashSet<u64>,
    turns: Vec<&'static str>,
    /// Centres of the grains of the state that was read last.
    places: Vec<[f64; 3]>,
}

impl Grains {
    /// Reads what all states have in common.
    pub fn find(run: &RunFolder, meshed: HashSet<u64>) -> Result<Self, String> {
        let reader = &run.reader;
        let dimension = run.dimension();
        let shaped = Shaped::read(reader)?.unwrap_or_default();
        let mut parts: HashMap<u64, Vec<usize>> = HashMap::new();
        for (k, piece) in shaped.pieces.iter().enumerate() {
            parts.entry(piece.body).or_default().push(k);
        }
        let turns: &[&str] = if dimension == 2 {
            &OF_GEOMETRY[..1]
        } else {
            &OF_GEOMETRY[1..5]
        };
        let has = |name: &&&str| reader.has(&format!("{ROOT}/{name}"));
        Ok(Self {
            dimension,
            fields: FieldInfo::numbers(run, ROOT),
            parts,
            shaped: shaped.bodies.iter().map(|b| b.id).collect(),
            pieces: shaped.pieces,
            meshed,
            turns: turns.iter().filter(has).copied().collect(),
            places: Vec::new(),
        })
    }

    /// Identities of the grains whose shapes are known.
    pub fn shaped(&self) -> &HashSet<u64> {
        &self.shaped
    }

    /// Centres of the grains of the state that was read last.
    pub fn places(&self) -> &[[f64; 3]] {
        &self.places
    }

    /// The fields for the page.
    pub fn fields(&self, ranges: &Ranges) -> Value {
        let shown = self
            .fields
            .iter()
            .filter(|f| !OF_GEOMETRY.contains(&f.name.as_str()));
        let speed = self.velocity().next().and_then(|of| {
            let speed = FieldInfo {
                doc: "size of the velocity".to_owned(),
                unit: of.unit.clone(),
                name: SPEED.to_owned(),
            };
            let mut head = ranges.head("grains", SPEED, &speed)?;
            head["of"] = self.velocity().map(|f| f.name.as_str()).collect();
            Some(head)
        });
        let own = shown.filter_map(|f| ranges.head("grains", &f.name, f));
        speed.into_iter().chain(own).collect()
    }

    /// Adds the arrays of a state.
    pub fn read(
        &mut self,
        run: &RunFolder,
        state: usize,
        detail: Detail,
        arrays: &mut Arrays,
        note: &mut Note<'_>,
    ) -> Result<(), String> {
        let rows = states::points(run, "grains", state)?;
        let points = run.reader.values("views/grains/Points", rows, 3)?;
        let column = |name: &str| run.reader.values(&format!("{ROOT}/{name}"), rows, 1);
        let mut names = ["removed", "gone"].into_iter();
        let name = names.find(|name| run.reader.has(&format!("{ROOT}/{name}")));
        let removed = name.map_or_else(|| Ok(vec![0.0; rows.1]), column)?;
        let kept: Vec<usize> = (0..rows.1)
            .filter(|k| removed[*k] == 0.0 && k.is_multiple_of(detail.every))
            .collect();
        let pick = |values: &[f64]| kept.iter().map(|k| values[*k]).collect::<Vec<f64>>();
        let at = |k: &usize| [points[3 * k], points[3 * k + 1], points[3 * k + 2]];
        self.places = kept.iter().map(at).collect();
        let flat_points: Vec<f64> = self.places.iter().flatten().copied().collect();
        push_points(arrays, "grain", &flat_points, self.dimension);
        for (k, name) in self.turns.iter().enumerate() {
            arrays.push(
                format!("grain.turn{k}"),
                NumberType::U16,
                &pick(&column(name)?),
            );
        }
        let shape = self.shape_of_rows(&column("id")?, &column("corners")?);
        arrays.push("grain.shape", NumberType::U32, &pick(&shape));
        for field in &self.fields {
            if OF_GEOMETRY.contains(&field.name.as_str()) {
                continue;
            }
            let values = pick(&column(&field.name)?);
            note("grains", &field.name, &values);
            let kind = match field.name.as_str() {
                "id" => NumberType::U32,
                "radius" => NumberType::U16,
                _ => detail.kind(),
            };
            arrays.push(format!("grain:{}", field.name), kind, &values);
        }
        note("grains", SPEED, &pick(&self.speeds(run, rows)?));
        self.push_outlines(arrays);
        Ok(())
    }

    /// Names of the components of the velocity.
    fn velocity(&self) -> impl Iterator<Item = &FieldInfo> {
        self.fields
            .iter()
            .filter(|f| f.name.starts_with("velocity_"))
    }

    fn speeds(&self, run: &RunFolder, rows: states::Rows) -> Result<Vec<f64>, String> {
        let mut squares = vec![0.0; rows.1];
        for field in self.velocity() {
            let values = run
                .reader
                .values(&format!("{ROOT}/{}", field.name), rows, 1)?;
            squares
                .iter_mut()
                .zip(values)
                .for_each(|(sum, v)| *sum += v * v);
        }
        Ok(squares.into_iter().map(f64::sqrt).collect())
    }

    /// For each row: 0 for a ball, 1 for a grain that is not drawn here, otherwise the index of its
    /// outline plus 2.
    fn shape_of_rows(&self, id: &[f64], corners: &[f64]) -> Vec<f64> {
        let mut seen: HashMap<u64, usize> = HashMap::new();
        let row = |(id, corners): (&f64, &f64)| {
            let id = *id as u64;
            if self.meshed.contains(&id) {
                return 1.0;
            }
            if *corners == 0.0 {
                return 0.0;
            }
            let next = seen.entry(id).or_default();
            *next += 1;
            let part = self.parts.get(&id).and_then(|p| p.get(*next - 1));
            part.map_or(1.0, |k| (k + 2) as f64)
        };
        id.iter().zip(corners).map(row).collect()
    }

    /// Returns the outlines of the convex parts about their centres: polygons in 2D, triangles in
    /// 3D.
    fn push_outlines(&self, arrays: &mut Arrays) {
        if self.pieces.is_empty() {
            return;
        }
        let (mut points, mut starts) = (Vec::new(), vec![0.0]);
        for piece in &self.pieces {
            let corners = if self.dimension == 2 {
                flat(piece)
            } else {
                solid(piece)
            };
            points.extend(corners.into_iter().flatten());
            starts.push((points.len() / 3) as f64);
        }
        arrays.push("outline.start", NumberType::U32, &starts);
        push_points(arrays, "outline", &points, self.dimension);
    }
}
