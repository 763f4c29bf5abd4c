//! 3D scene rendered to pixels: grains, and first bodies as walls that are transparent where grains
//! are behind them.

use super::paint::Coloured;
use super::raster::{Blend, Corner, Raster};
use super::view::View;
use crate::png::canvas::{Canvas, Rgb, WHITE, mix};
use fretwork_observe::picture::Paint;
use std::collections::HashMap;

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Centre (m).
    pub centre: [f64; 3],
    /// Radius (m).
    pub radius: f64,
    /// Colour.
    pub paint: Paint,
    /// Whether it is part of a first body.
    pub first: bool,
}

/// Faces of one object: a grain with corners, or a surface of a first body, closed or open.
#[derive(Clone, Debug)]
pub struct Faces {
    /// Convex polygons (m), counter-clockwise seen from the open side.
    pub polygons: Vec<Vec<[f64; 3]>>,
    /// Colour.
    pub paint: Paint,
    /// Whether it belongs to a first body.
    pub first: bool,
}

/// Content of a 3D picture.
#[derive(Clone, Debug)]
pub struct SolidScene {
    /// Direction of view.
    pub view: View,
    /// Spheres.
    pub spheres: Vec<Sphere>,
    /// Objects with faces.
    pub faces: Vec<Faces>,
}

/// Fields with more pixels than this are drawn at their own resolution, others at twice that.
const LARGEST: usize = 6_000_000;
/// A group of faces is transparent if grains are behind more than this fraction of its pixels.
const SEEN_THROUGH: f64 = 0.01;
/// Cosine of the angle between two faces below which their common edge is drawn.
const CREASE: f64 = 0.9;
/// Colours of first bodies: faces, and edges.
const WALL: Rgb = [226, 230, 236];
const WALL_EDGE: Rgb = [74, 84, 98];
/// Tint of a transparent wall on the objects behind it.
const VEIL: f32 = 0.07;

/// Map from metres to pixels of a field.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PixelMap {
    /// Metres at the left and at the top.
    pub left: f64,
    pub top: f64,
    /// Pixels per metre.
    pub scale: f64,
}

impl PixelMap {
    pub fn point(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let (x, y) = ((x - self.left) * self.scale, (self.top - y) * self.scale);
        [x as f32, y as f32]
    }
}

/// Visible faces of one smooth part of an object.
struct SmoothPart {
    faces: Vec<Vec<Corner>>,
    lights: Vec<f64>,
}

/// Visible parts of an object: groups of faces towards the viewer, faces away from it, and edges.
#[derive(Default)]
struct VisibleParts {
    groups: Vec<SmoothPart>,
    away: Vec<Vec<Corner>>,
    edges: Vec<[Corner; 2]>,
}

impl SolidScene {
    /// Projected corners of everything shown: to the right, upwards (m).
    pub fn extent(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let spheres = self.spheres.iter().flat_map(|s| {
            let [x, y] = self.view.project(s.centre).0;
            let r = s.radius;
            [[x - r, y - r], [x + r, y + r]]
        });
        let corners = self.faces.iter().flat_map(|f| f.polygons.iter().flatten());
        spheres.chain(corners.map(|p| self.view.project(*p).0))
    }

    /// Paints the field; `u` is the scale of the picture.
    pub(crate) fn paint(&self, field: &mut Canvas, place: &PixelMap, u: f32) {
        let (width, height) = (
            field.pixmap.width() as usize,
            field.pixmap.height() as usize,
        );
        let fine = if width * height > LARGEST { 1 } else { 2 };
        let mut raster = Raster::new(width * fine, height * fine, WHITE);
        let scale = place.scale * fine as f64;
        let line = f64::from(u) * fine as f64;
        let [middle, depth] = self.depths();
        let pixel = |p: [f64; 3]| -> Corner {
            let ([x, y], z) = self.view.project(p);
            [
                (x - place.left) * scale,
                (place.top - y) * scale,
                (z - middle) * scale,
            ]
        };
        for s in &self.spheres {
            let at = pixel(s.centre);
            // Grey grains are darker with distance, to show depth.
            let far = 0.5 - (at[2] / scale) / depth;
            let shade = match (s.paint, s.first) {
                (Paint::Grey, true) => 0.75 + 0.25 * far,
                (Paint::Grey, false) => 0.1 + 0.7 * far,
                _ => 0.0,
            };
            let radius = s.radius * scale;
            if at.iter().all(|x| x.is_finite()) && radius > 0.0 && radius.is_finite() {
                raster.sphere(at, radius, s.paint.colour(shade));
            }
        }
        let (walls, grains): (Vec<&Faces>, Vec<&Faces>) = self.faces.iter().partition(|f| f.first);
        for faces in grains {
            let seen = self.seen(faces, &pixel);
            let base = faces.paint.colour(0.25);
            for group in &seen.groups {
                solid(&mut raster, group, base);
            }
            let edge = mix(base, [0, 0, 0], 0.45);
            for [a, b] in seen.edges {
                raster.line(a, b, 1.0 * line, 3.0, edge, 0.9);
            }
        }
        // Walls in front of grains are drawn as veils after all opaque objects.
        let (mut solids, mut veils, mut edges) = (Vec::new(), Vec::new(), Vec::new());
        for faces in walls {
            let seen = self.seen(faces, &pixel);
            for group in seen.groups {
                let counts = group.faces.iter().map(|f| raster.hidden(f));
                let (all, hidden) = counts.fold((0, 0), |(a, h), c| (a + c.0, h + c.1));
                if hidden as f64 > SEEN_THROUGH * all as f64 {
                    veils.extend(group.faces);
                } else {
                    solids.push(group);
                }
            }
            veils.extend(seen.away);
            edges.extend(seen.edges);
        }
        for group in &solids {
            solid(&mut raster, group, WALL);
        }
        let nearness = |f: &Vec<Corner>| f.iter().map(|c| c[2]).sum::<f64>() / f.len() as f64;
        veils.sort_by(|a, b| nearness(a).total_cmp(&nearness(b)));
        for face in &veils {
            raster.polygon(face, WALL_EDGE, Blend::Veil(VEIL));
        }
        for [a, b] in edges {
            raster.line(a, b, 1.8 * line, 12.0, WALL_EDGE, 0.85);
        }
        let (across, _, pixels) = if fine == 2 {
            raster.halved()
        } else {
            raster.pixels()
        };
        field.write(across, &pixels);
    }

    /// Middle and range of the depths of the grains (m).
    fn depths(&self) -> [f64; 2] {
        let spheres = self.spheres.iter().map(|s| s.centre);
        let corners = self.faces.iter().flat_map(|f| f.polygons.iter().flatten());
        let all = spheres
            .chain(corners.copied())
            .map(|p| self.view.project(p).1);
        let (low, high) = all
            .filter(|z| z.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| {
                (l.min(z), h.max(z))
            });
        if low < high {
            [0.5 * (low + high), high - low]
        } else {
            [if low.is_finite() { low } else { 0.0 }, 1.0]
        }
    }

    /// Visible parts of an object.
    fn seen(&self, faces: &Faces, pixel: &impl Fn([f64; 3]) -> Corner) -> VisibleParts {
        let mut seen = VisibleParts::default();
        let normals: Vec<[f64; 3]> = faces.polygons.iter().map(|p| normal(p)).collect();
        let lights: Vec<(f64, f64)> = normals.iter().map(|n| self.light(n)).collect();
        let (edges, parts) = joined(&faces.polygons, &normals);
        let mut place: HashMap<usize, usize> = HashMap::new();
        for (k, polygon) in faces.polygons.iter().enumerate() {
            let corners: Vec<Corner> = polygon.iter().map(|p| pixel(*p)).collect();
            if corners.iter().flatten().any(|x| !x.is_finite()) {
                continue;
            }
            let (towards, light) = lights[k];
            if towards <= 0.0 {
                seen.away.push(corners);
                continue;
            }
            let at = *place.entry(parts[k]).or_insert_with(|| {
                seen.groups.push(SmoothPart {
                    faces: Vec::new(),
                    lights: Vec::new(),
                });
                seen.groups.len() - 1
            });
            seen.groups[at].faces.push(corners);
            seen.groups[at].lights.push(light);
        }
        for edge in edges {
            let outline = match edge.sides {
                (a, Some(b)) => (lights[a].0 > 0.0) != (lights[b].0 > 0.0),
                _ => true,
            };
            let ends = edge.ends.map(pixel);
            let finite = ends.iter().flatten().all(|x| x.is_finite());
            if finite && (edge.crease || outline) {
                seen.edges.push(ends);
            }
        }
        seen
    }

    /// Returns for a normal its component towards the viewer, and its illumination from the upper
    /// left in front of the picture.
    fn light(&self, n: &[f64; 3]) -> (f64, f64) {
        const LIGHT: [f64; 3] = [-0.45, 0.6, 0.661];
        let ([x, y], z) = self.view.project(*n);
        let dot = LIGHT[0] * x + LIGHT[1] * y + LIGHT[2] * z;
        (z, dot.max(0.0))
    }
}

fn solid(raster: &mut Raster, group: &SmoothPart, base: Rgb) {
    for (face, light) in group.faces.iter().zip(&group.lights) {
        let by = 0.7 + 0.36 * light;
        let colour = base.map(|c| (f64::from(c) * by).min(255.0) as u8);
        raster.polygon(face, colour, Blend::Opaque);
    }
}

/// An edge of one face or between two faces.
struct Edge {
    ends: [[f64; 3]; 2],
    sides: (usize, Option<usize>),
    crease: bool,
}

/// Returns the edges of polygons, and the index of the smooth part of each polygon.
fn joined(polygons: &[Vec<[f64; 3]>], normals: &[[f64; 3]]) -> (Vec<Edge>, Vec<usize>) {
    let all = || polygons.iter().flatten().flatten().copied();
    let size = all()
        .filter(|x| x.is_finite())
        .fold(0.0f64, |m, x| m.max(x.abs()));
    let grain = 1e-7 * size.max(f64::MIN_POSITIVE);
    let key = |p: &[f64; 3]| p.map(|x| (x / grain).round() as i64);
    let mut parts: Vec<usize> = (0..polygons.len()).collect();
    let mut edges: Vec<Edge> = Vec::new();
    let mut known: HashMap<[[i64; 3]; 2], usize> = HashMap::new();
    for (k, polygon) in polygons.iter().enumerate() {
        for (i, a) in polygon.iter().enumerate() {
            let b = &polygon[(i + 1) % polygon.len()];
            let (ka, kb) = (key(a), key(b));
            if ka == kb {
                continue;
            }
            let name = if ka < kb { [ka, kb] } else { [kb, ka] };
            let Some(&at) = known.get(&name) else {
                known.insert(name, edges.len());
                edges.push(Edge {
                    ends: [*a, *b],
                    sides: (k, None),
                    crease: true,
                });
                continue;
            };
            let other = edges[at].sides.0;
            let dot: f64 = (0..3).map(|i| normals[k][i] * normals[other][i]).sum();
            edges[at].sides.1 = Some(k);
            edges[at].crease = dot < CREASE;
            if dot >= CREASE {
                let (a, b) = (root(&mut parts, k), root(&mut parts, other));
                parts[a.max(b)] = a.min(b);
            }
        }
    }
    for k in 0..parts.len() {
        parts[k] = root(&mut parts, k);
    }
    (edges, parts)
}

fn root(parts: &mut [usize], mut k: usize) -> usize {
    while parts[k] != k {
        parts[k] = parts[parts[k]];
        k = parts[k];
    }
    k
}

/// Unit normal of a polygon; zero if it has no area.
fn normal(corners: &[[f64; 3]]) -> [f64; 3] {
    let Some(first) = corners.first() else {
        return [0.0; 3];
    };
    let from = |p: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] - first[i]) };
    let mut n = [0.0; 3];
    for k in 1..corners.len().saturating_sub(1) {
        let (p, q) = (from(&corners[k]), from(&corners[k + 1]));
        for (i, n) in n.iter_mut().enumerate() {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            *n += p[j] * q[l] - p[l] * q[j];
        }
    }
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 {
        n.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of two metres about a place.
    fn cube(x: f64, y: f64) -> Vec<Vec<[f64; 3]>> {
        const FACES: [[u32; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let at = |k: u32, bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let corner = |k: u32| [x + at(k, 0), y + at(k, 1), at(k, 2)];
        FACES.map(|f| f.map(corner).to_vec()).to_vec()
    }

    fn scene(view: View, faces: Vec<Faces>, spheres: Vec<Sphere>) -> SolidScene {
        SolidScene {
            view,
            spheres,
            faces,
        }
    }

    /// The field of 100 by 100 pixels over four metres about the origin.
    fn painted(scene: &SolidScene) -> Canvas {
        let mut field = Canvas::new(100, 100).unwrap();
        let place = PixelMap {
            left: -2.0,
            top: 2.0,
            scale: 25.0,
        };
        scene.paint(&mut field, &place, 0.5);
        field
    }

    fn colour(field: &Canvas, x: u32, y: u32) -> [u8; 3] {
        let p = field.pixmap.pixel(x, y).unwrap();
        [p.red(), p.green(), p.blue()]
    }

    #[test]
    fn of_a_cube_three_faces_are_seen_and_twelve_edges_are_creases() {
        let of = |view: View| {
            let cube = Faces {
                polygons: cube(0.0, 0.0),
                paint: Paint::Grey,
                first: false,
            };
            let scene = scene(view, vec![cube], Vec::new());
            let seen = scene.seen(&scene.faces[0], &|p| {
                let ([x, y], z) = scene.view.project(p);
                [x, y, z]
            });
            (seen.groups.len(), seen.away.len(), seen.edges.len())
        };
        assert_eq!(of(View::new(0.6, 0.4)), (3, 3, 12));
        assert_eq!(of(View::new(0.0, 0.0)).0, 1);
    }

    #[test]
    fn a_grain_is_seen_through_a_wall_before_it_and_not_behind_a_grain() {
        let grain = |y: f64| Sphere {
            centre: [0.0, y, 0.0],
            radius: 0.6,
            paint: Paint::Loose,
            first: false,
        };
        let wall = |first: bool| Faces {
            polygons: cube(0.0, 0.0),
            paint: Paint::Grey,
            first,
        };
        let view = View::new(0.0, 0.0);
        let middle = |faces, y| colour(&painted(&scene(view, faces, vec![grain(y)])), 50, 50);
        let alone = middle(Vec::new(), 3.0);
        let blue = |c: [u8; 3]| c[2] > c[0] + 40;
        assert!(blue(alone));
        // The three points are in front of the wall, behind it, and behind a grain with corners.
        assert_eq!(middle(vec![wall(true)], -3.0), alone);
        let veiled = middle(vec![wall(true)], 3.0);
        assert!(blue(veiled) && veiled != alone, "{veiled:?}");
        assert!(!blue(middle(vec![wall(false)], 3.0)));
        // A wall with nothing behind it hides the background.
        let field = painted(&scene(view, vec![wall(true)], vec![grain(-3.0)]));
        assert!(colour(&field, 60, 60) != [255; 3]);
    }

    #[test]
    fn the_edge_between_faces_of_one_plane_is_not_drawn() {
        let square = |x: f64| {
            vec![
                [x, 0.0, 0.0],
                [x + 1.0, 0.0, 0.0],
                [x + 1.0, 0.0, 1.0],
                [x, 0.0, 1.0],
            ]
        };
        let polygons = vec![square(0.0), square(1.0)];
        let normals: Vec<_> = polygons.iter().map(|p| normal(p)).collect();
        assert_eq!(normals[0], [0.0, -1.0, 0.0]);
        let (edges, parts) = joined(&polygons, &normals);
        assert_eq!(edges.iter().filter(|e| e.crease).count(), 6);
        assert_eq!((edges.len(), parts), (7, vec![0, 0]));
    }
}
