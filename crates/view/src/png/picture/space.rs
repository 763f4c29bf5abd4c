//! 3D scene of a picture: grains, and first bodies clipped to the region that grains can reach.

use super::{balls, paint};
use crate::png::scene::clip::{Side, clip, sides_of_box};
use crate::{Faces, Paint, SolidScene, Sphere, View};
use fretwork_core::geometry::shape::Carried;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;
use fretwork_observe::placement::{is_first, piece_centre, piece_outline};

type Point = [f64; 3];

/// Extent of a plane beyond the grains, as a fraction of their extent; also the largest distance at
/// which it is shown.
const MARGIN: f64 = 0.06;
const FAR: f64 = 0.5;

/// View direction of 3D pictures: x to the right, z upwards, slightly rotated and from above.
fn view() -> View {
    View::new(0.6, 0.4)
}

/// SolidScene of a picture. `paints` are those of the balls, then of the convex parts.
pub(crate) fn scene<S: Space>(s: &Simulation<S>, paints: &[Paint]) -> SolidScene {
    let shown = |body: u32| !s.state.bodies.removed[body as usize];
    let mut spheres = Vec::with_capacity(s.shapes.balls.len());
    for (k, (ball, (centre, radius))) in s.shapes.balls.iter().zip(balls(s)).enumerate() {
        if shown(ball.body) {
            spheres.push(Sphere {
                centre: s.shapes.periodic.wrapped(centre).padded(),
                radius,
                paint: paint(paints, k),
                first: is_first(s, ball.body),
            });
        }
    }
    let mut faces = Vec::new();
    for (k, piece) in s.shapes.pieces.iter().enumerate() {
        if !shown(piece.body) {
            continue;
        }
        let outline = piece_outline(s, piece);
        let padded = |f: &Vec<S::Vector>| f.iter().map(VectorLike::padded).collect();
        faces.push(Faces {
            polygons: outline.iter().map(padded).collect(),
            paint: paint(paints, s.shapes.balls.len() + k),
            first: is_first(s, piece.body),
        });
    }
    faces.extend(walls(s));
    SolidScene {
        view: view(),
        spheres,
        faces,
    }
}

/// The surfaces of first bodies.
fn walls<S: Space>(s: &Simulation<S>) -> Vec<Faces> {
    let surfaces = s.shapes.surfaces.iter();
    let surfaces: Vec<&Carried<S>> = surfaces
        .filter(|f| !s.state.bodies.removed[f.body as usize])
        .collect();
    let (low, high) = room(s, &surfaces);
    let reach = length(&sub(&high, &low)).max(f64::MIN_POSITIVE);
    // The open sides of planes; the inside of a drum is open, and clips the planes across it.
    let planes: Vec<Option<Side<3>>> = surfaces.iter().map(|f| solid_side(s, f)).collect();
    let walls = surfaces.iter().enumerate().map(|(k, surface)| {
        let polygons: Vec<Vec<Point>> = if surface.shape.bounded() {
            placed(s, surface, surface.shape.outline())
        } else {
            let b = surface.body as usize;
            let from = sub(&s.state.bodies.position[b].padded(), &low);
            let all = 2.0 * (reach + length(&from));
            let mut sides = sides_of_box(&low, &high);
            for (other, plane) in planes.iter().enumerate() {
                sides.extend(plane.iter().filter(|_| other != k).map(|p| Side {
                    normal: p.normal,
                    offset: p.offset + 1e-9 * reach,
                }));
            }
            for (other, drum) in surfaces.iter().enumerate() {
                if other != k && !drum.shape.bounded() && drum.shape.flat().is_none() {
                    sides.extend(inside(&placed(s, drum, drum.shape.faces_within(reach))));
                }
            }
            let faces = placed(s, surface, surface.shape.faces_within(all));
            faces.into_iter().map(|f| clip(f, &sides)).collect()
        };
        Faces {
            polygons: polygons.into_iter().filter(|p| p.len() > 2).collect(),
            paint: Paint::Grey,
            first: true,
        }
    });
    walls.collect()
}

/// Faces of a surface in world coordinates.
fn placed<S: Space>(
    s: &Simulation<S>,
    surface: &Carried<S>,
    faces: Vec<Vec<S::Vector>>,
) -> Vec<Vec<Point>> {
    let b = surface.body as usize;
    let world = |p: &S::Vector| {
        (s.state.bodies.position[b]
            + S::rotate(&s.state.bodies.rotation[b], &(surface.offset + *p)))
        .padded()
    };
    faces
        .iter()
        .map(|f| f.iter().map(world).collect())
        .collect()
}

/// The open side of a plane; `None` for other surfaces.
fn solid_side<S: Space>(s: &Simulation<S>, surface: &Carried<S>) -> Option<Side<3>> {
    let b = surface.body as usize;
    let normal = S::rotate(&s.state.bodies.rotation[b], &surface.shape.flat()?).padded();
    let at = s.state.bodies.position[b] + S::rotate(&s.state.bodies.rotation[b], &surface.offset);
    Some(Side {
        normal: normal.map(|x| -x),
        offset: -dot(&normal, &at.padded()),
    })
}

/// The box to which planes and drums are clipped: around grains and bounded surfaces, extended to
/// nearby planes.
fn room<S: Space>(s: &Simulation<S>, surfaces: &[&Carried<S>]) -> (Point, Point) {
    let mut bound = Bound::default();
    for (centre, radius) in balls(s) {
        bound.take(&s.shapes.periodic.wrapped(centre).padded(), radius);
    }
    for piece in &s.shapes.pieces {
        let centre = s.shapes.periodic.wrapped(piece_centre(s, piece));
        bound.take(&centre.padded(), piece.bound);
    }
    for surface in surfaces {
        let faces = match (surface.shape.bounded(), surface.shape.flat()) {
            (true, _) => surface.shape.outline(),
            (false, None) => surface.shape.faces_within(0.0),
            (false, Some(_)) => continue,
        };
        let all = placed(s, surface, faces);
        all.iter().flatten().for_each(|p| bound.take(p, 0.0));
    }
    if !bound.known() {
        for surface in surfaces {
            let all = placed(s, surface, surface.shape.outline());
            all.iter().flatten().for_each(|p| bound.take(p, 0.0));
        }
    }
    if !bound.known() {
        return ([-1.0; 3], [1.0; 3]);
    }
    let size = length(&sub(&bound.high, &bound.low));
    let (low, high) = (bound.low, bound.high);
    for side in surfaces.iter().filter_map(|f| solid_side(s, f)) {
        let corners =
            (0..8).map(|k| [0, 1, 2].map(|i| if k >> i & 1 == 1 { high[i] } else { low[i] }));
        let above = |p: &Point| -side.outside(p);
        let feet: Vec<Point> = corners
            .filter(|p| (0.0..FAR * size).contains(&above(p)))
            .map(|p| [0, 1, 2].map(|i| p[i] + above(&p) * side.normal[i]))
            .collect();
        feet.iter().for_each(|p| bound.take(p, 0.0));
    }
    for k in 0..3 {
        match s.shapes.periodic.period[k] {
            Some(period) => (bound.low[k], bound.high[k]) = (0.0, period),
            None => {
                bound.low[k] -= MARGIN * size;
                bound.high[k] += MARGIN * size;
            }
        }
    }
    (bound.low, bound.high)
}

struct Bound {
    low: Point,
    high: Point,
}

impl Default for Bound {
    fn default() -> Self {
        Self {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        }
    }
}

impl Bound {
    fn take(&mut self, p: &Point, radius: f64) {
        if p.iter().all(|x| x.is_finite()) {
            for (k, x) in p.iter().enumerate() {
                self.low[k] = self.low[k].min(x - radius);
                self.high[k] = self.high[k].max(x + radius);
            }
        }
    }

    fn known(&self) -> bool {
        (0..3).all(|k| self.low[k] <= self.high[k])
    }
}

/// Inner half-spaces of the faces of a drum.
fn inside(faces: &[Vec<Point>]) -> Vec<Side<3>> {
    let side = |face: &Vec<Point>| {
        let (a, b, c) = (face.first()?, face.get(1)?, face.get(2)?);
        let (p, q) = (sub(b, a), sub(c, b));
        let inwards = [0, 1, 2].map(|i| {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            p[j] * q[l] - p[l] * q[j]
        });
        let size = length(&inwards);
        let normal = inwards.map(|x| -x / size);
        let offset = dot(&normal, a);
        (size > 0.0).then_some(Side { normal, offset })
    };
    faces.iter().filter_map(side).collect()
}

fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub(a: &Point, b: &Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn length(a: &Point) -> f64 {
    dot(a, a).sqrt()
}
