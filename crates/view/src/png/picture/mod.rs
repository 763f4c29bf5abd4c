//! Pictures of the state of a simulation.

mod links;
mod mesh;
mod quantity;
mod space;
mod zones;

pub use fretwork_observe::placement::{ends, piece_centre, piece_outline};

use crate::{ColourScale, Disk, Frame, Link, LinkState, Outline, Paint};
use fretwork_core::geometry::shape::Ball;
use fretwork_core::geometry::space::Space;
use fretwork_core::step::{InDimension, Simulation};
use fretwork_observe::picture::Shows;
use fretwork_observe::placement::is_first;
use fretwork_scene::case::OutputSpec;
use links::{forces, links};

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

/// Evaluates an expression with a simulation in its dimension.
macro_rules! in_dimension {
    ($simulation:expr, |$s:ident| $body:expr) => {
        match $simulation {
            InDimension::Dim2($s) => $body,
            InDimension::Dim3($s) => $body,
        }
    };
}

impl Camera {
    /// A view of the whole scene in its current state, or of the window given in the case.
    pub fn new(simulation: InDimension<'_>, output: &OutputSpec) -> Self {
        let flat = matches!(simulation, InDimension::Dim2(_));
        let mut camera = Self {
            window: output.window.unwrap_or_default(),
            fixed: output.window.is_some() && flat,
            width: output.width,
            layers: output.layers,
            paints: Vec::new(),
        };
        camera.follow(simulation);
        camera.assign_layers(simulation);
        camera
    }

    /// Colours the grains by the layers in which they are now.
    pub fn assign_layers(&mut self, simulation: InDimension<'_>) {
        if let Some(thickness) = self.layers {
            self.paints = in_dimension!(simulation, |s| layers(s, thickness));
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
    pub fn follow(&mut self, simulation: InDimension<'_>) {
        if !self.fixed {
            self.window = in_dimension!(simulation, |s| Self::whole(s));
        }
    }

    fn whole<S: Space>(simulation: &Simulation<S>) -> [f64; 4] {
        let periodic = &simulation.shapes.periodic;
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
        if S::D == 3 {
            let scene = space::scene(simulation, &[]);
            scene.extent().for_each(|p| take(p, 0.0));
        } else {
            let pieces = &simulation.shapes.pieces;
            let pieces = pieces
                .iter()
                .map(|p| (piece_centre(simulation, p), p.bound));
            for (centre, radius) in balls(simulation).chain(pieces) {
                let c = periodic.wrapped(centre);
                take([c[0], c[1]], radius);
            }
            let systems = &simulation.state.systems;
            let meshes = (0..systems.len()).filter_map(|k| systems.get(k)?.deformed_mesh());
            for mesh in meshes {
                mesh.points.iter().for_each(|x| take([x[0], x[1]], 0.0));
            }
        }
        if !w.iter().all(|x| x.is_finite()) {
            w = [-1.0, 1.0, -1.0, 1.0];
        }
        if let (2, Some(period)) = (S::D, periodic.period[0]) {
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

    /// A picture, to be drawn later, by any thread; `None` where the dimension has no such picture,
    /// and for charts, which are drawn by [`crate::draw_panels`].
    pub fn frame(
        &self,
        simulation: InDimension<'_>,
        shows: &Shows,
        title: &str,
        caption: Vec<String>,
    ) -> Option<Frame> {
        let flat = matches!(simulation, InDimension::Dim2(_));
        match shows {
            Shows::Charts(_) => return None,
            Shows::Chains(_) | Shows::Stress if !flat => return None,
            _ => {}
        }
        Some(in_dimension!(simulation, |s| self.frame_in(s, shows, title, caption)))
    }

    fn frame_in<S: Space>(
        &self,
        simulation: &Simulation<S>,
        shows: &Shows,
        title: &str,
        caption: Vec<String>,
    ) -> Frame {
        let made: Vec<Paint>;
        let (paints, scale) = match shows {
            Shows::Scene if self.paints.is_empty() => {
                let scale;
                (made, scale) = quantity::of(simulation);
                (&made[..], scale)
            }
            Shows::Scene => (&self.paints[..], None),
            Shows::Bonds | Shows::Chains(_) | Shows::Charts(_) => (&[][..], None),
            Shows::Paints(paints) => (&paints[..], None),
            Shows::Stress => (&[][..], mesh::scale(simulation, self.window)),
            Shows::Values { values, label, top } => {
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
        let flat = S::D == 2;
        let scene = (!flat).then(|| space::scene(simulation, paints));
        let (mut disks, mut links, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
        let mut along = Vec::new();
        if flat {
            disks = self::disks(simulation, self.window, paints);
            links = self.lines(simulation, shows);
            bodies = outlines(simulation, self.window);
            bodies.extend(zones::solids(simulation, self.window));
            if matches!(shows, Shows::Stress) {
                along = zones::lines(simulation, self.window);
            }
            let shown = scale.as_ref().filter(|_| matches!(shows, Shows::Stress));
            bodies.extend(mesh::elements(simulation, self.window, shown));
            if shown.is_none() {
                bodies.extend(mesh::grains(simulation, self.window, paints));
            }
            bodies.extend(pieces(simulation, self.window, paints));
            bodies.extend(named_balls(simulation, self.window));
        }
        Frame {
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
        }
    }

    /// The contacts drawn as lines (2D).
    fn lines<S: Space>(&self, simulation: &Simulation<S>, shows: &Shows) -> Vec<Link> {
        match shows {
            // A map of the bond states only: forces would cover it.
            Shows::Bonds => {
                let bonds = links(simulation, self.window).into_iter();
                let bonds = bonds.filter(|l| l.state != LinkState::Plain);
                bonds.map(|l| Link { width: 0.3, ..l }).collect()
            }
            Shows::Chains(pairs) => forces(simulation, self.window, pairs),
            Shows::Scene if self.paints.is_empty() => links(simulation, self.window),
            // The colours of grains carry the information: nothing is drawn over them.
            _ => Vec::new(),
        }
    }
}

/// Colour of each ball by the layer in which it is.
fn layers<S: Space>(s: &Simulation<S>, thickness: f64) -> Vec<Paint> {
    let grain = s.state.bodies.grain_flags();
    let paint = |(ball, (centre, _)): (&Ball<S>, (S::Vector, f64))| {
        if grain[ball.body as usize] {
            Paint::Layer((centre[S::D - 1] / thickness).floor() as i64)
        } else {
            Paint::Grey
        }
    };
    s.shapes.balls.iter().zip(balls(s)).map(paint).collect()
}

fn balls<S: Space>(s: &Simulation<S>) -> impl Iterator<Item = (S::Vector, f64)> + '_ {
    s.shapes.balls.iter().map(|b| {
        (
            fretwork_core::contact::detect::centre(b, &s.state.bodies),
            b.radius,
        )
    })
}

fn pieces<S: Space>(s: &Simulation<S>, window: [f64; 4], paints: &[Paint]) -> Vec<Outline> {
    let period = s.shapes.periodic.period[0];
    let mut out = Vec::with_capacity(s.shapes.pieces.len());
    for (k, piece) in s.shapes.pieces.iter().enumerate() {
        if s.state.bodies.removed[piece.body as usize] {
            continue;
        }
        let shade = (!is_first(s, piece.body)).then_some(0.25);
        let corners = piece_outline(s, piece).concat();
        let x = s.shapes.periodic.wrapped(piece_centre(s, piece))[0];
        for image in images(x, piece.bound, window, period) {
            out.push(Outline {
                points: corners.iter().map(|c| [c[0] - x + image, c[1]]).collect(),
                shade,
                paint: paint(paints, s.shapes.balls.len() + k),
                ..Outline::default()
            });
        }
    }
    out
}

/// For each first body made of balls that is large in the window, an outline of its largest ball,
/// which is hidden under its disk and carries the name.
pub fn named_balls<S: Space>(s: &Simulation<S>, window: [f64; 4]) -> Vec<Outline> {
    const CORNERS: u32 = 256;
    let least = 0.1 * (window[1] - window[0]).min(window[3] - window[2]);
    let mut out = Vec::new();
    for driven in &s.state.bodies.driven {
        let surfaces = s.shapes.surfaces.iter().map(|f| f.body);
        let labelled = surfaces.into_iter().any(|body| body == driven.body);
        if labelled
            || s.state.bodies.removed[driven.body as usize]
            || driven.name.starts_with("wall_")
        {
            continue;
        }
        let own = s.shapes.balls.iter().zip(balls(s));
        let own = own.filter(|(ball, _)| ball.body == driven.body);
        let largest = own.max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let Some((_, (centre, radius))) = largest.filter(|(_, (_, r))| *r >= least) else {
            continue;
        };
        let centre = s.shapes.periodic.wrapped(centre);
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

/// The periodic images of a point that are visible in the window.
fn images(x: f64, reach: f64, window: [f64; 4], period: Option<f64>) -> Vec<f64> {
    let Some(period) = period else { return vec![x] };
    let x = x - period * (x / period).floor();
    [x - period, x, x + period]
        .into_iter()
        .filter(|x| x + reach > window[0] && x - reach < window[1])
        .collect()
}

fn disks<S: Space>(s: &Simulation<S>, window: [f64; 4], paints: &[Paint]) -> Vec<Disk> {
    let period = s.shapes.periodic.period[0];
    let mut out = Vec::with_capacity(s.shapes.balls.len());
    for (k, (ball, (centre, radius))) in s.shapes.balls.iter().zip(balls(s)).enumerate() {
        if s.state.bodies.removed[ball.body as usize] {
            continue;
        }
        let angle = S::rotation_numbers(&s.state.bodies.rotation[ball.body as usize])[0];
        let first = is_first(s, ball.body);
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

/// First bodies as closed polygons that extend beyond the window.
fn outlines<S: Space>(s: &Simulation<S>, window: [f64; 4]) -> Vec<Outline> {
    let period = s.shapes.periodic.period[0];
    let far = 2.0 * ((window[1] - window[0]) + (window[3] - window[2]));
    let mut out = Vec::new();
    // Those of deformable bodies are drawn as their elements.
    let shown = |body: u32| {
        !s.state.bodies.removed[body as usize] && s.state.bodies.carrier(body as usize).is_none()
    };
    for surface in s.shapes.surfaces.iter().filter(|f| shown(f.body)) {
        let b = surface.body as usize;
        let (position, rotation) = (s.state.bodies.position[b], s.state.bodies.rotation[b]);
        let name = s
            .state
            .bodies
            .driven
            .iter()
            .find(|d| d.body == surface.body)
            .map_or(String::new(), |d| d.name.clone());
        for chain in surface.shape.outline() {
            let world = |p: &S::Vector| {
                let x = position + S::rotate(&rotation, &(surface.offset + *p));
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

/// The outside of a closed convex polyline that runs counter-clockwise: a square of size `far` with
/// the polyline cut out, joined by a seam on the right.
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
