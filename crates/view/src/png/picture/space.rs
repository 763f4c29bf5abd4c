//! 3D scene of a picture: grains, and first bodies clipped to the region that grains can reach.

use super::{is_first, paint};
use crate::png::scene::clip::{Side, clip, sides_of_box};
use crate::{Faces, Paint, SolidScene, Sphere, View};
use fretwork_core::view::{RunView, SurfaceView};
use nalgebra::Vector3;

type Point = [f64; 3];

/// Extent of a plane beyond the grains, as a fraction of their extent. It is also the largest
/// distance at which a plane is shown.
const MARGIN: f64 = 0.06;
const FAR: f64 = 0.5;

/// View direction of 3D pictures: x to the right, z upwards, slightly rotated and from above.
fn view() -> View {
    View::new(0.6, 0.4)
}

/// Returns the solids of a picture. `paints` has the colours of the balls, then of the convex
/// parts.
pub(crate) fn scene(run: &dyn RunView, paints: &[Paint]) -> SolidScene {
    let bodies = run.bodies();
    let shown = |body: u32| !bodies.removed[body as usize];
    let balls = run.balls();
    let mut spheres = Vec::with_capacity(balls.len());
    for (k, ball) in balls.iter().enumerate() {
        if shown(ball.body) {
            spheres.push(Sphere {
                centre: run.periodic().wrapped(Vector3::from(ball.centre)).into(),
                radius: ball.radius,
                paint: paint(paints, k),
                first: is_first(&bodies, ball.body),
            });
        }
    }
    let mut faces = Vec::new();
    for (k, piece) in run.pieces().into_iter().enumerate() {
        if !shown(piece.body) {
            continue;
        }
        faces.push(Faces {
            polygons: placed_piece(run, k, piece.centre),
            paint: paint(paints, balls.len() + k),
            first: is_first(&bodies, piece.body),
        });
    }
    faces.extend(walls(run));
    SolidScene {
        view: view(),
        spheres,
        faces,
    }
}

/// The surfaces of first bodies.
fn walls(run: &dyn RunView) -> Vec<Faces> {
    let (bodies, surfaces) = (run.bodies(), run.surfaces().into_iter().enumerate());
    let surfaces: Vec<(usize, SurfaceView)> = surfaces
        .filter(|(_, f)| !bodies.removed[f.body as usize])
        .collect();
    let (low, high) = room(run, &surfaces);
    let reach = length(&sub(&high, &low)).max(f64::MIN_POSITIVE);
    // The open sides of planes are kept. The inside of a drum is open, and clips the planes across
    // it.
    let planes: Vec<Option<Side<3>>> = surfaces.iter().map(|f| solid_side(run, &f.1)).collect();
    let faces = |(place, surface): &(usize, SurfaceView), reach: f64| {
        placed(run, surface, &run.surface_faces(*place, reach))
    };
    let walls = surfaces.iter().enumerate().map(|(k, own)| {
        let (place, surface) = own;
        let polygons: Vec<Vec<Point>> = if surface.bounded {
            placed(run, surface, &run.surface_lines(*place))
        } else {
            let from = sub(&bodies.position.at(surface.body as usize), &low);
            let all = 2.0 * (reach + length(&from));
            let mut sides = sides_of_box(&low, &high);
            for (other, plane) in planes.iter().enumerate() {
                sides.extend(plane.iter().filter(|_| other != k).map(|p| Side {
                    normal: p.normal,
                    offset: p.offset + 1e-9 * reach,
                }));
            }
            for (other, drum) in surfaces.iter().enumerate() {
                if other != k && !drum.1.bounded && drum.1.flat.is_none() {
                    sides.extend(inside(&faces(drum, reach)));
                }
            }
            let faces = faces(own, all);
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

/// Returns the faces of a piece in world coordinates, in the periodic cell.
fn placed_piece(run: &dyn RunView, piece: usize, centre: Point) -> Vec<Vec<Point>> {
    let centre = run.periodic().wrapped(Vector3::from(centre));
    let place = |p: &Point| Point::from(Vector3::from(*p) + centre);
    let faces = run.piece_outline(piece);
    faces
        .iter()
        .map(|f| f.iter().map(place).collect())
        .collect()
}

/// Returns the faces of a surface in world coordinates.
fn placed(run: &dyn RunView, surface: &SurfaceView, faces: &[Vec<Point>]) -> Vec<Vec<Point>> {
    faces
        .iter()
        .map(|f| f.iter().map(|p| super::placed(run, surface, p)).collect())
        .collect()
}

/// Returns the open side of a plane; `None` for other surfaces.
fn solid_side(run: &dyn RunView, surface: &SurfaceView) -> Option<Side<3>> {
    let normal = run.turned(surface.body as usize, surface.flat?);
    let at = super::placed(run, surface, &[0.0; 3]);
    Some(Side {
        normal: normal.map(|x| -x),
        offset: -dot(&normal, &at),
    })
}

/// Returns the box to which planes and drums are clipped: it surrounds grains and bounded surfaces,
/// and is extended to nearby planes.
fn room(run: &dyn RunView, surfaces: &[(usize, SurfaceView)]) -> (Point, Point) {
    let mut bound = Bounds::default();
    let wrapped = |p: Point| Point::from(run.periodic().wrapped(Vector3::from(p)));
    for ball in run.balls() {
        bound.take(&wrapped(ball.centre), ball.radius);
    }
    for piece in run.pieces() {
        bound.take(&wrapped(piece.centre), piece.bound);
    }
    for (place, surface) in surfaces {
        let faces = match (surface.bounded, surface.flat) {
            (true, _) => run.surface_lines(*place),
            (false, None) => run.surface_faces(*place, 0.0),
            (false, Some(_)) => continue,
        };
        let all = placed(run, surface, &faces);
        all.iter().flatten().for_each(|p| bound.take(p, 0.0));
    }
    if !bound.known() {
        for (place, surface) in surfaces {
            let all = placed(run, surface, &run.surface_lines(*place));
            all.iter().flatten().for_each(|p| bound.take(p, 0.0));
        }
    }
    if !bound.known() {
        return ([-1.0; 3], [1.0; 3]);
    }
    let size = length(&sub(&bound.high, &bound.low));
    let (low, high) = (bound.low, bound.high);
    for side in surfaces.iter().filter_map(|f| solid_side(run, &f.1)) {
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
        match run.periodic().period[k] {
            Some(period) => (bound.low[k], bound.high[k]) = (0.0, period),
            None => {
                bound.low[k] -= MARGIN * size;
                bound.high[k] += MARGIN * size;
            }
        }
    }
    (bound.low, bound.high)
}

struct Bounds {
    low: Point,
    high: Point,
}

impl Default for Bounds {
    fn default() -> Self {
        Self {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
        }
    }
}

impl Bounds {
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

/// Returns the inner half-spaces of the faces of a drum.
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
