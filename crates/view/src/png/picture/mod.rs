//! Pictures of the state of a simulation.

mod links;
mod mesh;
mod quantity;
mod space;
mod zones;

use crate::{ColourScale, Disk, Frame, Link, LinkState, Outline, Paint};
use fretwork_core::view::{BallView, BodyColumns, RunView, SurfaceView};
use fretwork_observe::picture::PictureContent;
use fretwork_scene::case::OutputSpec;
use links::{forces, links};
use nalgebra::Vector3;

/// View of the scene for a series of pictures.
#[derive(Clone, Debug)]
pub struct Camera {
    window: [f64; 4],
    fixed: bool,
    width: u32,
    /// Thickness of the layers distinguished by colour (m).
    layers: Option<f64>,
    /// Colour of each ball, if there are layers.
    paints: Vec<Paint>,
}

impl Camera {
    /// A view of the whole scene in its current state, or of the window given in the case.
    pub fn new(run: &dyn RunView, output: &OutputSpec) -> Self {
        let flat = run.dimension() == 2;
        let mut camera = Self {
            window: output.window.unwrap_or_default(),
            fixed: output.window.is_some() && flat,
            width: output.width,
            layers: output.layers,
            paints: Vec::new(),
        };
        camera.follow(run);
        camera.assign_layers(run);
        camera
    }

    /// Colours the grains by the layers in which they are at present.
    pub fn assign_layers(&mut self, run: &dyn RunView) {
        if let Some(thickness) = self.layers {
            self.paints = layers(run, thickness);
        }
    }

    /// Colour of each ball, if there are layers.
    pub fn paints(&self) -> &[Paint] {
        &self.paints
    }

    /// Restores colours that were assigned earlier.
    pub fn paint(&mut self, paints: Vec<Paint>) {
        self.paints = paints;
    }

    /// Adapts the window to the current scene, unless the case gives one.
    pub fn follow(&mut self, run: &dyn RunView) {
        if !self.fixed {
            self.window = Self::whole(run);
        }
    }

    fn whole(run: &dyn RunView) -> [f64; 4] {
        let periodic = run.periodic();
        let mut w = [
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ];
        let mut take = |at: [f64; 2], radius: f64| {
            for k in 0..2 {
                w[2 * k] = w[2 * k].min(at[k] - radius);
                w[2 * k + 1] = w[2 * k + 1].max(at[k] + radius);
            }
        };
        if run.dimension() == 3 {
            let scene = space::scene(run, &[]);
            scene.extent().for_each(|p| take(p, 0.0));
        } else {
            let pieces = run.pieces().into_iter().map(|p| (p.centre, p.bound));
            let balls = run.balls().into_iter().map(|b| (b.centre, b.radius));
            for (centre, radius) in balls.chain(pieces) {
                let c = periodic.wrapped(Vector3::from(centre));
                take([c[0], c[1]], radius);
            }
            let systems = 0..run.system_count();
            let meshes = systems.filter_map(|k| run.system(k)?.deformed_mesh());
            for mesh in meshes {
                mesh.points.iter().for_each(|x| take([x[0], x[1]], 0.0));
            }
        }
        if !w.iter().all(|x| x.is_finite()) {
            w = [-1.0, 1.0, -1.0, 1.0];
        }
        if let (2, Some(period)) = (run.dimension(), periodic.period[0]) {
            (w[0], w[1]) = (0.0, period);
        }
        let (wide, high) = (w[1] - w[0], w[3] - w[2]);
        let margin = 0.04 * wide.max(high);
        if periodic.period[0].is_none() {
            w[0] -= margin;
            w[1] += margin;
        }
        w[2] -= margin;
        w[3] += margin;
        w
    }

    /// Returns a picture that any thread can draw later. `None` if the dimension has no such
    /// picture, and for charts, which are drawn by [`crate::draw_panels`].
    pub fn frame(
        &self,
        run: &dyn RunView,
        shows: &PictureContent,
        title: &str,
        caption: Vec<String>,
    ) -> Option<Frame> {
        let flat = run.dimension() == 2;
        match shows {
            PictureContent::Charts(_) => return None,
            PictureContent::Chains(_) | PictureContent::Stress if !flat => return None,
            _ => {}
        }
        let made: Vec<Paint>;
        let (paints, scale) = match shows {
            PictureContent::Scene if self.paints.is_empty() => {
                let scale;
                (made, scale) = quantity::of(run);
                (&made[..], scale)
            }
            PictureContent::Scene => (&self.paints[..], None),
            PictureContent::Bonds | PictureContent::Chains(_) | PictureContent::Charts(_) => {
                (&[][..], None)
            }
            PictureContent::Paints(paints) => (&paints[..], None),
            PictureContent::Stress => (&[][..], mesh::scale(run, self.window)),
            PictureContent::Values { values, label, top } => {
                made = values.iter().map(|v| Paint::Value(v / top)).collect();
                let scale = ColourScale {
                    label: (*label).to_owned(),
                    unit: String::new(),
                    top: *top,
                    bonds: false,
                };
                (&made[..], Some(scale))
            }
        };
        let scene = (!flat).then(|| space::scene(run, paints));
        let (mut disks, mut links, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
        let mut along = Vec::new();
        if flat {
            disks = self::disks(run, self.window, paints);
            links = self.lines(run, shows);
            bodies = outlines(run, self.window);
            bodies.extend(zones::solids(run, self.window));
            if matches!(shows, PictureContent::Stress) {
                along = zones::lines(run, self.window);
            }
            let shown = scale
                .as_ref()
                .filter(|_| matches!(shows, PictureContent::Stress));
            bodies.extend(mesh::elements(run, self.window, shown));
            if shown.is_none() {
                bodies.extend(mesh::grains(run, self.window, paints));
            }
            bodies.extend(pieces(run, self.window, paints));
            bodies.extend(named_balls(run, self.window));
        }
        Some(Frame {
            title: title.to_owned(),
            caption,
            window: self.window,
            bodies,
            disks,
            links,
            zones: along,
            scale,
            scene,
            width_px: self.width,
        })
    }

    /// The contacts drawn as lines (2D).
    fn lines(&self, run: &dyn RunView, shows: &PictureContent) -> Vec<Link> {
        match shows {
            // A picture of the bond states shows no forces, which would cover it.
            PictureContent::Bonds => {
                let bonds = links(run, self.window).into_iter();
                let bonds = bonds.filter(|l| l.state != LinkState::Plain);
                bonds.map(|l| Link { width: 0.3, ..l }).collect()
            }
            PictureContent::Chains(pairs) => forces(run, self.window, pairs),
            PictureContent::Scene if self.paints.is_empty() => links(run, self.window),
            // Nothing is drawn over the grains, since their colours carry the information.
            _ => Vec::new(),
        }
    }
}

/// Colour of each ball by the layer in which it is.
fn layers(run: &dyn RunView, thickness: f64) -> Vec<Paint> {
    let (grain, up) = (run.grain_flags(), run.dimension() - 1);
    let paint = |ball: BallView| {
        if grain[ball.body as usize] {
            Paint::Layer((ball.centre[up] / thickness).floor() as i64)
        } else {
            Paint::Grey
        }
    };
    run.balls().into_iter().map(paint).collect()
}

/// Whether a body is a first body.
fn is_first(bodies: &BodyColumns<'_>, body: u32) -> bool {
    bodies.driven.iter().any(|d| d.body == body)
}

/// A point of a surface in world coordinates.
fn placed(run: &dyn RunView, surface: &SurfaceView, p: &[f64; 3]) -> [f64; 3] {
    let b = surface.body as usize;
    let arm = Vector3::from(surface.offset) + Vector3::from(*p);
    let turned = run.turned(b, arm.into());
    (Vector3::from(run.bodies().position.at(b)) + Vector3::from(turned)).into()
}

fn pieces(run: &dyn RunView, window: [f64; 4], paints: &[Paint]) -> Vec<Outline> {
    let period = run.periodic().period[0];
    let (bodies, balls, pieces) = (run.bodies(), run.balls().len(), run.pieces());
    let mut out = Vec::with_capacity(pieces.len());
    for (k, piece) in pieces.iter().enumerate() {
        if bodies.removed[piece.body as usize] {
            continue;
        }
        let shade = (!is_first(&bodies, piece.body)).then_some(0.25);
        let corners = run.piece_outline(k).concat();
        let centre = run.periodic().wrapped(Vector3::from(piece.centre));
        let x = centre[0];
        for image in images(x, piece.bound, window, period) {
            let at = |c: &[f64; 3]| [c[0] + centre[0] - x + image, c[1] + centre[1]];
            out.push(Outline {
                points: corners.iter().map(at).collect(),
                shade,
                paint: paint(paints, balls + k),
                ..Outline::default()
            });
        }
    }
    out
}

/// Returns, for each first body made of balls that is large in the window, an outline of its
/// largest ball. The outline is hidden under the disk of the ball and carries the name.
pub fn named_balls(run: &dyn RunView, window: [f64; 4]) -> Vec<Outline> {
    const CORNERS: u32 = 256;
    let least = 0.1 * (window[1] - window[0]).min(window[3] - window[2]);
    let (bodies, balls, surfaces) = (run.bodies(), run.balls(), run.surfaces());
    let mut out = Vec::new();
    for driven in bodies.driven {
        let labelled = surfaces.iter().any(|f| f.body == driven.body);
        if labelled || bodies.removed[driven.body as usize] || driven.name.starts_with("wall_") {
            continue;
        }
        let own = balls.iter().filter(|ball| ball.body == driven.body);
        let largest = own.max_by(|a, b| a.radius.total_cmp(&b.radius));
        let Some(ball) = largest.filter(|ball| ball.radius >= least) else {
            continue;
        };
        let radius = ball.radius;
        let centre = run.periodic().wrapped(Vector3::from(ball.centre));
        let corner = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS);
            [
                centre[0] + radius * angle.cos(),
                centre[1] + radius * angle.sin(),
            ]
        };
        out.push(Outline {
            points: (0..CORNERS).map(corner).collect(),
            label: driven.name.clone(),
            ..Outline::default()
        });
    }
    out
}

/// Returns the periodic images of a point that are visible in the window.
fn images(x: f64, reach: f64, window: [f64; 4], period: Option<f64>) -> Vec<f64> {
    let Some(period) = period else { return vec![x] };
    let x = x - period * (x / period).floor();
    [x - period, x, x + period]
        .into_iter()
        .filter(|x| x + reach > window[0] && x - reach < window[1])
        .collect()
}

fn disks(run: &dyn RunView, window: [f64; 4], paints: &[Paint]) -> Vec<Disk> {
    let period = run.periodic().period[0];
    let (bodies, balls) = (run.bodies(), run.balls());
    let mut out = Vec::with_capacity(balls.len());
    for (k, ball) in balls.iter().enumerate() {
        if bodies.removed[ball.body as usize] {
            continue;
        }
        let (centre, radius) = (ball.centre, ball.radius);
        let angle = run.motion(ball.body as usize).rotation[0];
        let first = is_first(&bodies, ball.body);
        for x in images(centre[0], radius, window, period) {
            out.push(Disk {
                centre: [x, centre[1]],
                radius,
                angle,
                shade: match (first, paints.is_empty()) {
                    (true, _) => 0.9,
                    (false, true) => 0.25,
                    (false, false) => 0.0,
                },
                paint: paint(paints, k),
            });
        }
    }
    out
}

fn paint(paints: &[Paint], ball: usize) -> Paint {
    paints.get(ball).copied().unwrap_or_default()
}

/// Returns the first bodies as closed polygons that extend beyond the window.
fn outlines(run: &dyn RunView, window: [f64; 4]) -> Vec<Outline> {
    let period = run.periodic().period[0];
    let far = 2.0 * ((window[1] - window[0]) + (window[3] - window[2]));
    let mut out = Vec::new();
    let bodies = run.bodies();
    // First bodies that are deformable are drawn as their elements.
    let shown =
        |body: u32| !bodies.removed[body as usize] && bodies.carrier(body as usize).is_none();
    let surfaces = run.surfaces().into_iter().enumerate();
    for (k, surface) in surfaces.filter(|(_, f)| shown(f.body)) {
        let driven = bodies.driven.iter().find(|d| d.body == surface.body);
        let name = driven.map_or(String::new(), |d| d.name.clone());
        for chain in run.surface_lines(k) {
            let world = |p: &[f64; 3]| {
                let x = placed(run, &surface, p);
                [x[0], x[1]]
            };
            let points: Vec<[f64; 2]> = chain.iter().map(world).collect();
            let (Some(first), Some(last)) = (points.first(), points.last()) else {
                continue;
            };
            let name = if name.starts_with("wall_") {
                String::new()
            } else {
                name.clone()
            };
            if points.len() > 3 && first == last {
                out.push(Outline {
                    points: around(&points, far),
                    ..Outline::default()
                });
                continue;
            }
            let spans = period.is_some_and(|p| ((last[0] - first[0]).abs() / p - 1.0).abs() < 1e-6);
            let mut polygon = Vec::new();
            match period.filter(|_| spans) {
                Some(period) => {
                    let shift = period * (first[0].min(last[0]) / period).floor();
                    let copies: &[f64] = if last[0] > first[0] {
                        &[-1.0, 0.0, 1.0]
                    } else {
                        &[1.0, 0.0, -1.0]
                    };
                    for copy in copies {
                        polygon.extend(points.iter().map(|p| [p[0] - shift + copy * period, p[1]]));
                    }
                }
                None => polygon.clone_from(&points),
            }
            // The solid is on the right of the polyline.
            let (a, z) = (polygon[0], polygon[polygon.len() - 1]);
            let (dx, dy) = (z[0] - a[0], z[1] - a[1]);
            let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
            let (nx, ny) = (dy / length * far, -dx / length * far);
            polygon.push([z[0] + nx, z[1] + ny]);
            polygon.push([a[0] + nx, a[1] + ny]);
            out.push(Outline {
                points: polygon,
                label: name,
                ..Outline::default()
            });
        }
    }
    out
}

/// Returns the outside of a closed convex polyline that runs counter-clockwise: a square of size
/// `far` with the polyline cut out, joined by a seam on the right.
fn around(chain: &[[f64; 2]], far: f64) -> Vec<[f64; 2]> {
    let ring = &chain[..chain.len() - 1];
    let right = (0..ring.len()).max_by(|a, b| ring[*a][0].total_cmp(&ring[*b][0]));
    let right = right.unwrap_or(0);
    let [x, y] = ring[right];
    let mut polygon: Vec<[f64; 2]> = (0..=ring.len())
        .map(|k| ring[(right + k) % ring.len()])
        .collect();
    polygon.extend([
        [x + far, y],
        [x + far, y - far],
        [x - far, y - far],
        [x - far, y + far],
        [x + far, y + far],
        [x + far, y],
    ]);
    polygon
}
