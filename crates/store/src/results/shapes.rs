//! Shapes of the grains other than single balls, and of deformable grains without load, in
//! `results.h5`. They are stored once, in the grains' own frames.
//!
//! ```text
//! /shapes/bodies/id, mass, density, length, inertia     one row per grain; inertia has 9 numbers, row by row
//! /shapes/balls/body, radius, offset                    one row per ball of these grains
//! /shapes/pieces/body, rounding, size, offset,          one row per convex part: a polytope with rounded edges,
//!                corners, faces                         with its number of corners and faces
//! /shapes/corners                                       of all parts, relative to their centres, part after part
//! /shapes/faces                                         of all parts: number of corners of a face, then their indices
//! ```
//! Together with a state's positions and orientations in `/views/grains` they define every grain's
//! outline.

use super::reader::Reader;
use super::store::{ResultsError, Store};
use fretwork_core::unit::{INERTIA, MASS};
pub use fretwork_scene::recorded::{ShapedBall, ShapedBody, ShapedPiece};

/// All grains other than single balls and all deformable grains, with their parts, in the order of
/// the grains' view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shaped {
    /// The grains.
    pub bodies: Vec<ShapedBody>,
    /// Balls of these grains.
    pub balls: Vec<ShapedBall>,
    /// Convex parts of these grains.
    pub pieces: Vec<ShapedPiece>,
}

const GROUPS: [&str; 4] = [
    "/shapes",
    "/shapes/bodies",
    "/shapes/balls",
    "/shapes/pieces",
];

impl Shaped {
    /// Writes the shapes for a case of this dimension; nothing if there are none.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn write(&self, store: &mut Store, dimension: usize) -> Result<(), ResultsError> {
        if self.bodies.is_empty() {
            return Ok(());
        }
        for group in GROUPS {
            store.group(group)?;
        }
        self.write_bodies(store, dimension)?;
        self.write_balls(store)?;
        self.write_pieces(store)?;
        self.write_outlines(store)
    }

    fn write_bodies(&self, store: &mut Store, dimension: usize) -> Result<(), ResultsError> {
        let [mass, moment] = [MASS, INERTIA].map(|unit| unit.symbol(dimension));
        let b = &self.bodies;
        let id: Vec<i64> = b.iter().map(|b| b.id as i64).collect();
        store.numbers("/shapes/bodies/id", 1, &id, ("", "identity of the grain"))?;
        let mut column = |name: &str, get: fn(&ShapedBody) -> f64, doc: (&str, &str)| {
            let values: Vec<f64> = b.iter().map(get).collect();
            store.numbers(&format!("/shapes/bodies/{name}"), 1, &values, doc)
        };
        column("mass", |b| b.mass, (mass, "its mass"))?;
        let doc = ("kg/m^3", "density of its material");
        column("density", |b| b.density, doc)?;
        let doc = ("m", "the length that makes its spin a velocity");
        column("length", |b| b.length, doc)?;
        let inertia: Vec<f64> = b.iter().flat_map(|b| b.inertia).collect();
        let doc = "its moments of inertia in its own axes, row by row; in the plane the first";
        store.numbers("/shapes/bodies/inertia", 9, &inertia, (moment, doc))
    }

    fn write_balls(&self, store: &mut Store) -> Result<(), ResultsError> {
        let body: Vec<i64> = self.balls.iter().map(|b| b.body as i64).collect();
        let doc = ("", "identity of the grain that the ball belongs to");
        store.numbers("/shapes/balls/body", 1, &body, doc)?;
        let radius: Vec<f64> = self.balls.iter().map(|b| b.radius).collect();
        let doc = ("m", "radius of the ball");
        store.numbers("/shapes/balls/radius", 1, &radius, doc)?;
        let offset: Vec<f64> = self.balls.iter().flat_map(|b| b.offset).collect();
        let doc = "from the centre of the grain to that of the ball, in axes of the grain";
        store.numbers("/shapes/balls/offset", 3, &offset, ("m", doc))
    }

    fn write_pieces(&self, store: &mut Store) -> Result<(), ResultsError> {
        let p = &self.pieces;
        let whole = |get: fn(&ShapedPiece) -> i64| p.iter().map(get).collect::<Vec<i64>>();
        let of = |get: fn(&ShapedPiece) -> f64| p.iter().map(get).collect::<Vec<f64>>();
        let body = whole(|p| p.body as i64);
        let doc = ("", "identity of the grain that the convex piece belongs to");
        store.numbers("/shapes/pieces/body", 1, &body, doc)?;
        let doc = ("m", "radius of its rounded edges");
        store.numbers("/shapes/pieces/rounding", 1, &of(|p| p.rounding), doc)?;
        let doc = ("m", "radius of the ball (2D: disk) of its volume");
        store.numbers("/shapes/pieces/size", 1, &of(|p| p.size), doc)?;
        let offset: Vec<f64> = p.iter().flat_map(|p| p.offset).collect();
        let doc = "from the centre of the grain to that of the piece, in axes of the grain";
        store.numbers("/shapes/pieces/offset", 3, &offset, ("m", doc))?;
        let corners = whole(|p| p.corners.len() as i64);
        let doc = ("", "number of its corners");
        store.numbers("/shapes/pieces/corners", 1, &corners, doc)?;
        let faces = whole(|p| p.faces.len() as i64);
        let doc = ("", "number of its faces");
        store.numbers("/shapes/pieces/faces", 1, &faces, doc)
    }

    /// Writes the corners and faces of the pieces.
    fn write_outlines(&self, store: &mut Store) -> Result<(), ResultsError> {
        let p = &self.pieces;
        let places = p.iter().flat_map(|p| p.corners.iter().flatten().copied());
        let doc = "corners of all pieces, one piece after another, from the centre of the piece";
        store.numbers(
            "/shapes/corners",
            3,
            &places.collect::<Vec<f64>>(),
            ("m", doc),
        )?;
        let mut listed: Vec<i64> = Vec::new();
        for face in p.iter().flat_map(|p| &p.faces) {
            listed.push(face.len() as i64);
            listed.extend(face.iter().map(|c| i64::from(*c)));
        }
        let doc = "faces of all pieces: the number of corners of a face, then these, counted in their piece from 0";
        store.numbers("/shapes/faces", 1, &listed, ("", doc))
    }

    /// Reads the shapes; `None` if the file has none.
    ///
    /// # Errors
    /// Returns a description of the error if the shapes are invalid.
    pub fn read(reader: &Reader) -> Result<Option<Self>, String> {
        if !reader.has("shapes/bodies/id") {
            return Ok(None);
        }
        let columns = ShapeColumns(reader);
        Ok(Some(Self {
            bodies: columns.bodies()?,
            balls: columns.balls()?,
            pieces: columns.pieces()?,
        }))
    }
}

/// Reads the columns of the shapes. Empty datasets are not written.
struct ShapeColumns<'a>(&'a Reader);

impl ShapeColumns<'_> {
    fn numbers(&self, name: &str, width: usize) -> Result<Vec<f64>, String> {
        match self.0.has(name) {
            true => self.0.numbers(name, (0, self.0.rows(name)?), width),
            false => Ok(Vec::new()),
        }
    }

    /// Reads a column of non-negative integers.
    fn whole(&self, name: &str) -> Result<Vec<u64>, String> {
        if !self.0.has(name) {
            return Ok(Vec::new());
        }
        let values = self.0.whole(name, (0, self.0.rows(name)?))?;
        let bad = |_| format!("`{name}` holds a negative number");
        values
            .into_iter()
            .map(|v| u64::try_from(v).map_err(bad))
            .collect()
    }

    fn bodies(&self) -> Result<Vec<ShapedBody>, String> {
        let id = self.whole("shapes/bodies/id")?;
        let [mass, density, length] = ["mass", "density", "length"]
            .map(|name| self.numbers(&format!("shapes/bodies/{name}"), 1));
        let (mass, density, length) = (mass?, density?, length?);
        let inertia = self.numbers("shapes/bodies/inertia", 9)?;
        check_lengths(
            "shapes/bodies",
            id.len(),
            &[mass.len(), density.len(), length.len(), inertia.len() / 9],
        )?;
        let body = |k: usize| ShapedBody {
            id: id[k],
            mass: mass[k],
            density: density[k],
            length: length[k],
            inertia: std::array::from_fn(|i| inertia[9 * k + i]),
        };
        Ok((0..id.len()).map(body).collect())
    }

    fn balls(&self) -> Result<Vec<ShapedBall>, String> {
        let body = self.whole("shapes/balls/body")?;
        let radius = self.numbers("shapes/balls/radius", 1)?;
        let offset = self.numbers("shapes/balls/offset", 3)?;
        let lengths = [radius.len(), offset.len() / 3];
        check_lengths("shapes/balls", body.len(), &lengths)?;
        let ball = |k: usize| ShapedBall {
            body: body[k],
            radius: radius[k],
            offset: std::array::from_fn(|i| offset[3 * k + i]),
        };
        Ok((0..body.len()).map(ball).collect())
    }

    fn pieces(&self) -> Result<Vec<ShapedPiece>, String> {
        let body = self.whole("shapes/pieces/body")?;
        let rounding = self.numbers("shapes/pieces/rounding", 1)?;
        let size = self.numbers("shapes/pieces/size", 1)?;
        let offset = self.numbers("shapes/pieces/offset", 3)?;
        let corner_counts = self.whole("shapes/pieces/corners")?;
        let face_counts = self.whole("shapes/pieces/faces")?;
        let lengths = [
            rounding.len(),
            size.len(),
            offset.len() / 3,
            corner_counts.len(),
            face_counts.len(),
        ];
        check_lengths("shapes/pieces", body.len(), &lengths)?;
        let places = self.numbers("shapes/corners", 3)?;
        let mut places = places.chunks_exact(3);
        let mut listed = self.whole("shapes/faces")?.into_iter();
        let mut pieces = Vec::new();
        for k in 0..body.len() {
            let mut corners = Vec::new();
            for _ in 0..corner_counts[k] {
                let place = places.next().ok_or("`shapes/corners` is cut short")?;
                corners.push([place[0], place[1], place[2]]);
            }
            let mut faces = Vec::new();
            for _ in 0..face_counts[k] {
                faces.push(next_face(&mut listed)?);
            }
            pieces.push(ShapedPiece {
                body: body[k],
                rounding: rounding[k],
                size: size[k],
                offset: std::array::from_fn(|i| offset[3 * k + i]),
                corners,
                faces,
            });
        }
        Ok(pieces)
    }
}

/// Reads the next face of the list: the number of its corners, then their indices.
fn next_face(listed: &mut impl Iterator<Item = u64>) -> Result<Vec<u32>, String> {
    let mut next = || listed.next().ok_or("`shapes/faces` is cut short");
    let mut face = Vec::new();
    for _ in 0..next()? {
        let corner = u32::try_from(next()?);
        face.push(corner.map_err(|_| "`shapes/faces` holds a number too large")?);
    }
    Ok(face)
}

/// Checks that the columns have the same length.
fn check_lengths(group: &str, rows: usize, lengths: &[usize]) -> Result<(), String> {
    if lengths.iter().all(|n| *n == rows) {
        return Ok(());
    }
    Err(format!("the columns of `{group}` are not of one length"))
}
