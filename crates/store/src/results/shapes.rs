//! Shapes of the grains other than single balls in `results.h5`, stored once in the grains' own frames.
//!
//! ```text
//! /shapes/bodies/id, mass, density, length, inertia     one row per grain; inertia has 9 numbers, row by row
//! /shapes/balls/body, radius, offset                    one row per ball of these grains
//! /shapes/pieces/body, rounding, size, offset,          one row per convex part: a polytope with rounded edges,
//!                corners, faces                         with its number of corners and faces
//! /shapes/corners                                       of all parts, relative to their centres, part after part
//! /shapes/faces                                         of all parts: number of corners of a face, then their indices
//! ```
//! Together with a state's positions and orientations in `/views/grains` they define every grain's outline.

use super::reader::Reader;
use super::store::{ResultsError, Store};
pub use fretwork_scene::recorded::{ShapedBall, ShapedBody, ShapedPiece};

/// All grains other than single balls, with their parts, in the order of the grains' view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shaped {
    /// The grains.
    pub bodies: Vec<ShapedBody>,
    /// Their balls.
    pub balls: Vec<ShapedBall>,
    /// Their convex parts.
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
        let [mass, moment] = match dimension {
            2 => ["kg/m", "kg m"],
            _ => ["kg", "kg m^2"],
        };
        let b = &self.bodies;
        let of = |get: fn(&ShapedBody) -> f64| b.iter().map(get).collect::<Vec<f64>>();
        let id: Vec<i64> = b.iter().map(|b| b.id as i64).collect();
        let inertia: Vec<f64> = b.iter().flat_map(|b| b.inertia).collect();
        store.numbers("/shapes/bodies/id", 1, &id, ("", "identity of the grain"))?;
        store.numbers(
            "/shapes/bodies/mass",
            1,
            &of(|b| b.mass),
            (mass, "its mass"),
        )?;
        store.numbers(
            "/shapes/bodies/density",
            1,
            &of(|b| b.density),
            ("kg/m^3", "density of its material"),
        )?;
        store.numbers(
            "/shapes/bodies/length",
            1,
            &of(|b| b.length),
            ("m", "the length that makes its spin a velocity"),
        )?;
        store.numbers(
            "/shapes/bodies/inertia",
            9,
            &inertia,
            (
                moment,
                "its moments of inertia in its own axes, row by row; in the plane the first",
            ),
        )?;
        let body: Vec<i64> = self.balls.iter().map(|b| b.body as i64).collect();
        let radius: Vec<f64> = self.balls.iter().map(|b| b.radius).collect();
        let offset: Vec<f64> = self.balls.iter().flat_map(|b| b.offset).collect();
        store.numbers(
            "/shapes/balls/body",
            1,
            &body,
            ("", "identity of the grain that the ball belongs to"),
        )?;
        store.numbers(
            "/shapes/balls/radius",
            1,
            &radius,
            ("m", "radius of the ball"),
        )?;
        store.numbers(
            "/shapes/balls/offset",
            3,
            &offset,
            (
                "m",
                "from the centre of the grain to that of the ball, in axes of the grain",
            ),
        )?;
        let p = &self.pieces;
        let whole = |get: fn(&ShapedPiece) -> i64| p.iter().map(get).collect::<Vec<i64>>();
        let of = |get: fn(&ShapedPiece) -> f64| p.iter().map(get).collect::<Vec<f64>>();
        let offset: Vec<f64> = p.iter().flat_map(|p| p.offset).collect();
        let corners = whole(|p| p.corners.len() as i64);
        let faces = whole(|p| p.faces.len() as i64);
        store.numbers(
            "/shapes/pieces/body",
            1,
            &whole(|p| p.body as i64),
            ("", "identity of the grain that the convex piece belongs to"),
        )?;
        store.numbers(
            "/shapes/pieces/rounding",
            1,
            &of(|p| p.rounding),
            ("m", "radius of its rounded edges"),
        )?;
        store.numbers(
            "/shapes/pieces/size",
            1,
            &of(|p| p.size),
            ("m", "radius of the ball (2D: disk) of its volume"),
        )?;
        store.numbers(
            "/shapes/pieces/offset",
            3,
            &offset,
            (
                "m",
                "from the centre of the grain to that of the piece, in axes of the grain",
            ),
        )?;
        store.numbers(
            "/shapes/pieces/corners",
            1,
            &corners,
            ("", "number of its corners"),
        )?;
        store.numbers(
            "/shapes/pieces/faces",
            1,
            &faces,
            ("", "number of its faces"),
        )?;
        let places = p.iter().flat_map(|p| p.corners.iter().flatten().copied());
        store.numbers(
            "/shapes/corners",
            3,
            &places.collect::<Vec<f64>>(),
            (
                "m",
                "corners of all pieces, one piece after another, from the centre of the piece",
            ),
        )?;
        let mut listed: Vec<i64> = Vec::new();
        for face in p.iter().flat_map(|p| &p.faces) {
            listed.push(face.len() as i64);
            listed.extend(face.iter().map(|c| i64::from(*c)));
        }
        store.numbers("/shapes/faces", 1, &listed, ("", "faces of all pieces: the number of corners of a face, then these, counted in their piece from 0"))
    }

    /// Reads the shapes; `None` if the file has none.
    ///
    /// # Errors
    /// A description of what is wrong with them.
    pub(super) fn read(reader: &Reader) -> Result<Option<Self>, String> {
        if !reader.has("shapes/bodies/id") {
            return Ok(None);
        }
        // Empty datasets are not written.
        let numbers = |name: &str, width: usize| -> Result<Vec<f64>, String> {
            match reader.has(name) {
                true => reader.numbers(name, (0, reader.rows(name)?), width),
                false => Ok(Vec::new()),
            }
        };
        let whole = |name: &str| -> Result<Vec<u64>, String> {
            if !reader.has(name) {
                return Ok(Vec::new());
            }
            let values = reader.whole(name, (0, reader.rows(name)?))?;
            let bad = |_| format!("`{name}` holds a negative number");
            values
                .into_iter()
                .map(|v| u64::try_from(v).map_err(bad))
                .collect()
        };
        let mut out = Self::default();
        let id = whole("shapes/bodies/id")?;
        let [mass, density, length] =
            ["mass", "density", "length"].map(|name| numbers(&format!("shapes/bodies/{name}"), 1));
        let (mass, density, length) = (mass?, density?, length?);
        let inertia = numbers("shapes/bodies/inertia", 9)?;
        same(
            "shapes/bodies",
            id.len(),
            &[mass.len(), density.len(), length.len(), inertia.len() / 9],
        )?;
        for k in 0..id.len() {
            out.bodies.push(ShapedBody {
                id: id[k],
                mass: mass[k],
                density: density[k],
                length: length[k],
                inertia: std::array::from_fn(|i| inertia[9 * k + i]),
            });
        }
        let three = |list: &[f64], k: usize| std::array::from_fn(|i| list[3 * k + i]);
        let body = whole("shapes/balls/body")?;
        let radius = numbers("shapes/balls/radius", 1)?;
        let offset = numbers("shapes/balls/offset", 3)?;
        same(
            "shapes/balls",
            body.len(),
            &[radius.len(), offset.len() / 3],
        )?;
        for k in 0..body.len() {
            out.balls.push(ShapedBall {
                body: body[k],
                radius: radius[k],
                offset: three(&offset, k),
            });
        }
        let body = whole("shapes/pieces/body")?;
        let (rounding, size) = (
            numbers("shapes/pieces/rounding", 1)?,
            numbers("shapes/pieces/size", 1)?,
        );
        let offset = numbers("shapes/pieces/offset", 3)?;
        let counts = [
            whole("shapes/pieces/corners")?,
            whole("shapes/pieces/faces")?,
        ];
        let lengths = [
            rounding.len(),
            size.len(),
            offset.len() / 3,
            counts[0].len(),
            counts[1].len(),
        ];
        same("shapes/pieces", body.len(), &lengths)?;
        let places = numbers("shapes/corners", 3)?;
        let listed = whole("shapes/faces")?;
        let mut places = places.chunks_exact(3);
        let mut listed = listed.into_iter();
        for k in 0..body.len() {
            let mut corners = Vec::new();
            for _ in 0..counts[0][k] {
                let place = places.next().ok_or("`shapes/corners` is cut short")?;
                corners.push([place[0], place[1], place[2]]);
            }
            let mut faces = Vec::new();
            for _ in 0..counts[1][k] {
                let mut face = Vec::new();
                let mut next = || listed.next().ok_or("`shapes/faces` is cut short");
                for _ in 0..next()? {
                    let corner = u32::try_from(next()?);
                    face.push(corner.map_err(|_| "`shapes/faces` holds a number too large")?);
                }
                faces.push(face);
            }
            out.pieces.push(ShapedPiece {
                body: body[k],
                rounding: rounding[k],
                size: size[k],
                offset: three(&offset, k),
                corners,
                faces,
            });
        }
        Ok(Some(out))
    }
}

/// Checks that the columns have the same length.
fn same(group: &str, rows: usize, lengths: &[usize]) -> Result<(), String> {
    if lengths.iter().all(|n| *n == rows) {
        return Ok(());
    }
    Err(format!("the columns of `{group}` are not of one length"))
}
