//! Picture of the scene: bodies, grains and interactions.

pub(crate) mod clip;
mod frame;
pub(crate) mod paint;
mod raster;
pub(crate) mod solid;
pub(crate) mod view;
pub(crate) mod zone;

use std::path::Path;

use tiny_skia::PathBuilder;

use crate::png::canvas::{Canvas, DrawError, INK, PAGE, Rgb, SOFT_INK, TEXT, joined, mix};
use crate::png::font::{Anchor, TextStyle, text_width};
use clip::{clip, sides_of_box};
use frame::{centroid, push_bar};
use fretwork_observe::picture::Paint;
use paint::{ColourScale, Coloured, DAMAGED, SOUND};
use solid::{PixelMap, SolidScene};
use zone::ZoneLine;

/// A first body (rail, wheel), or a grain with corners.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Corners of a closed polygon, metres; may extend beyond the window.
    pub points: Vec<[f64; 2]>,
    /// Name written in the body; empty for none.
    pub label: String,
    /// Grey level of a grain, as [`Disk::shade`]; `None` for a first body.
    pub shade: Option<f64>,
    /// Colour of a grain.
    pub paint: Paint,
    /// Whether it is an element of a mesh, drawn without an edge.
    pub element: bool,
}

/// A grain.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk {
    /// Centre, metres.
    pub centre: [f64; 2],
    /// Radius, metres.
    pub radius: f64,
    /// Rotation since the start, radians, shown by a mark.
    pub angle: f64,
    /// Grey level of the grain: 0 light, 1 dark.
    pub shade: f64,
    /// Colour of the grain.
    pub paint: Paint,
}

/// State of an interaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinkState {
    /// Bonded, in red; `damage` in 0..1 turns dark red to orange.
    Intact {
        /// Damage of the bond, 0 sound to 1 about to break.
        damage: f64,
    },
    /// Broken bond, in blue.
    Broken,
    /// Contact that was never bonded, in thin grey.
    Plain,
    /// Contact of a force chain, in purple.
    Chain,
}

/// An interaction between two grains, or a grain and a body.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// One end, metres.
    pub a: [f64; 2],
    /// Other end, metres.
    pub b: [f64; 2],
    /// Colour.
    pub state: LinkState,
    /// Force relative to the typical one: 1 is the typical width, 0 the thinnest; values above 4
    /// are drawn as 4.
    pub width: f64,
}

/// A picture of the scene at one instant.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Heading; empty for none.
    pub title: String,
    /// Texts under the heading (time, cycle, friction), on one line if they fit.
    pub caption: Vec<String>,
    /// xmin, xmax, ymin, ymax, metres. The picture shows all of it at equal scale in both
    /// directions, and more if the picture would be too flat.
    pub window: [f64; 4],
    /// First bodies, and grains with corners.
    pub bodies: Vec<Outline>,
    /// Grains, drawn in order.
    pub disks: Vec<Disk>,
    /// Interactions, drawn over the grains.
    pub links: Vec<Link>,
    /// Sticking and slipping zones, drawn over everything else.
    pub zones: Vec<ZoneLine>,
    /// Colour scale of the values of grains or bonds, if they are coloured by a value.
    pub scale: Option<ColourScale>,
    /// The 3D scene, drawn instead of bodies and disks.
    pub scene: Option<SolidScene>,
    /// Width of the picture in pixels; the height follows from the window.
    pub width_px: u32,
}

pub(crate) const BROKEN: Rgb = [20, 92, 224];
pub(crate) const CHAIN: Rgb = [112, 16, 120];
pub(crate) const PLAIN: Rgb = [128, 133, 140];
const STEEL: Rgb = [142, 150, 160];
const STEEL_EDGE: Rgb = [70, 77, 86];
const GRAIN_EDGE: Rgb = [118, 120, 122];

impl Frame {
    /// Draws the frame to a PNG file.
    pub fn draw(&self, path: &Path) -> Result<(), DrawError> {
        let [xmin, xmax, ymin, ymax] = self.window;
        let finite = self.window.iter().all(|v| v.is_finite());
        if !(finite && xmin < xmax && ymin < ymax) {
            return Err(DrawError::Window(self.window));
        }
        if self.width_px < 200 {
            let (width, height) = (self.width_px, self.width_px);
            return Err(DrawError::Size { width, height });
        }
        let u = self.width_px as f32 / PAGE;
        let side = (24.0 * u).round();
        let field_width = self.width_px as f32 - 2.0 * side;
        let (dx, dy) = (xmax - xmin, ymax - ymin);
        // Limits on the aspect ratio of the field.
        let scale = (f64::from(field_width) / dx).min(1.4 * f64::from(field_width) / dy);
        let field_height = ((dy * scale) as f32).max(0.08 * field_width).round();
        let map = PixelMap {
            left: (xmin + xmax) / 2.0 - f64::from(field_width) / scale / 2.0,
            top: (ymin + ymax) / 2.0 + f64::from(field_height) / scale / 2.0,
            scale,
        };

        let room = self.width_px as f32 - 2.0 * side;
        let lines = joined(&self.caption, "   ·   ", TEXT * u, room);
        let title = if self.title.is_empty() { 0.0 } else { 42.0 * u };
        let top = (title + lines.len() as f32 * 38.0 * u + 24.0 * u).round();
        // Below the field are the colour bar and the scale bar, then the legend of the links.
        let bar = if self.scale.is_some() { 96.0 * u } else { 0.0 };
        let marked = !(self.links.is_empty() && self.zones.is_empty());
        let line = if self.scale.is_none() || marked {
            62.0 * u
        } else {
            0.0
        };
        let height = top + field_height + bar + line + 12.0 * u;
        let mut page = Canvas::new(self.width_px, height.round() as u32)?;
        let mut field = Canvas::new(field_width as u32, field_height as u32)?;

        if let Some(scene) = &self.scene {
            scene.paint(&mut field, &map, u);
        }
        self.draw_bodies(&mut field, &map, u);
        self.draw_disks(&mut field, &map, u);
        self.draw_links(&mut field, &map, u);
        self.draw_labels(&mut field, &map, u);
        zone::draw(&mut field, &self.zones, |p| map.point(p), u);
        page.paste(&field, side as usize, top as usize);
        let edge = [side, top, field_width, field_height];
        page.frame(edge, 1.5 * u, STEEL_EDGE);

        let size = 32.0 * u * (room / text_width(&self.title, 32.0 * u)).min(1.0);
        page.text(
            &self.title,
            [side, 44.0 * u],
            &TextStyle::new(size, INK).bold(),
        );
        for (i, line) in lines.iter().enumerate() {
            let y = title + (38.0 * (i as f32 + 1.0) - 1.0) * u;
            page.text(line, [side, y], &TextStyle::new(TEXT * u, SOFT_INK));
        }
        let under = top + field_height;
        if let Some(scale) = &self.scale {
            paint::colour_bar(&mut page, scale, [side, under + 40.0 * u], 360.0, u)?;
        }
        let closest_point = under + bar + 38.0 * u;
        let end = frame::legend(&mut page, &self.links, [side, closest_point], u);
        zone::legend(&mut page, &self.zones, [end, closest_point], u);
        let right = side + field_width;
        let row = if self.scale.is_some() {
            under + 40.0 * u
        } else {
            closest_point
        };
        frame::scale_bar(&mut page, [right, row], scale, u);
        page.save(path, "")
    }

    fn draw_bodies(&self, field: &mut Canvas, map: &PixelMap, u: f32) {
        for body in &self.bodies {
            let polygon = visible(&body.points, field, map);
            let (fill, edge, width) = match body.shade {
                Some(shade) => (body.paint.colour(shade), GRAIN_EDGE, 1.3 * u),
                None => (STEEL, STEEL_EDGE, 2.0 * u),
            };
            if body.element {
                // The outline is one pixel wide, so that no seam shows between neighbours.
                field.polygon(&polygon, fill);
                field.stroke(&polygon, true, 1.0, fill, None);
                continue;
            }
            field.polygon(&polygon, fill);
            field.stroke(&polygon, true, width, edge, None);
        }
    }

    fn draw_disks(&self, field: &mut Canvas, map: &PixelMap, u: f32) {
        let mut ticks = PathBuilder::new();
        let edge = GRAIN_EDGE.map(f32::from);
        for (disk, at, radius) in self.seen(field, map) {
            let grain = disk.paint.colour(disk.shade).map(f32::from);
            let inner = radius - (1.3 * u).min(0.3 * radius);
            field.disk(at, radius, |_, distance| {
                let t = (distance - inner + 0.5).clamp(0.0, 1.0);
                // `map` is not used, since it is not inlined.
                let mixed = |i: usize| grain[i] + t * (edge[i] - grain[i]);
                [mixed(0), mixed(1), mixed(2)]
            });
            if radius > 6.0 * u {
                let (sin, cos) = (disk.angle.sin() as f32, disk.angle.cos() as f32);
                let along = |t: f32| [at[0] + t * radius * cos, at[1] - t * radius * sin];
                let width = (0.08 * radius).clamp(u, 3.0 * u);
                push_bar(&mut ticks, along(0.5), along(0.95), width);
            }
        }
        if let Some(path) = ticks.finish() {
            field.fill_path(&path, STEEL_EDGE);
        }
    }

    /// Unit of line width: proportional to the grains, so that links neither cover small grains nor
    /// vanish between large ones.
    fn line_unit(&self, field: &Canvas, map: &PixelMap, u: f32) -> f32 {
        let (sum, count) = self
            .seen(field, map)
            .iter()
            .fold((0.0, 0.0), |(sum, n), (_, _, r)| (sum + r, n + 1.0));
        if count > 0.0 {
            (0.12 * sum / count).clamp(0.62 * u, 1.4 * u)
        } else {
            u
        }
    }

    /// Returns the grains that overlap the field, with centre and radius in pixels.
    fn seen(&self, field: &Canvas, map: &PixelMap) -> Vec<(&Disk, [f32; 2], f32)> {
        let disks = self.disks.iter();
        disks
            .filter_map(|disk| pixels(disk, field, map).map(|(at, r)| (disk, at, r)))
            .collect()
    }

    /// Links of one colour are filled together, plain ones at the bottom.
    fn draw_links(&self, field: &mut Canvas, map: &PixelMap, u: f32) {
        const LEVELS: usize = 8;
        let unit = self.line_unit(field, map, u);
        let mut paths: [_; LEVELS + 3] = std::array::from_fn(|_| PathBuilder::new());
        let (right, bottom) = (field.pixmap.width() as f32, field.pixmap.height() as f32);
        for link in &self.links {
            let (a, b) = (map.point(link.a), map.point(link.b));
            let out = |i: usize, end: f32| a[i].max(b[i]) < -9.0 || a[i].min(b[i]) > end + 9.0;
            let width = (unit * (1.3 + 1.2 * link.width.clamp(0.0, 4.0) as f32)).max(0.9);
            if out(0, right) || out(1, bottom) || !width.is_finite() {
                continue;
            }
            let (rank, width) = match link.state {
                LinkState::Plain => (0, 0.6 * width),
                LinkState::Broken => (1, width),
                LinkState::Intact { damage } => {
                    let level = (damage.clamp(0.0, 1.0) * (LEVELS - 1) as f64).round();
                    (2 + level as usize, width)
                }
                LinkState::Chain => (LEVELS + 2, width),
            };
            push_bar(&mut paths[rank], a, b, width);
        }
        for (rank, path) in paths.into_iter().enumerate() {
            let colour = match rank {
                0 => PLAIN,
                1 => BROKEN,
                rank if rank == LEVELS + 2 => CHAIN,
                _ => mix(SOUND, DAMAGED, (rank - 2) as f64 / (LEVELS - 1) as f64),
            };
            if let Some(path) = path.finish() {
                field.fill_path(&path, colour);
            }
        }
    }

    fn draw_labels(&self, field: &mut Canvas, map: &PixelMap, u: f32) {
        let name = TextStyle::new(TEXT * u, INK)
            .anchored(Anchor::Middle)
            .bold();
        for body in self.bodies.iter().filter(|b| !b.label.is_empty()) {
            if let Some([x, y]) = centroid(&visible(&body.points, field, map)) {
                field.text(&body.label, [x, y + 9.0 * u], &name.halo(STEEL));
            }
        }
    }
}

/// Returns centre and radius of a disk in pixels, if it overlaps the field.
fn pixels(disk: &Disk, field: &Canvas, map: &PixelMap) -> Option<([f32; 2], f32)> {
    let at = map.point(disk.centre);
    let r = (disk.radius * map.scale) as f32;
    let (width, height) = (field.pixmap.width() as f32, field.pixmap.height() as f32);
    let near = |v: f32, length: f32| v > -r && v < length + r;
    (r > 0.0 && near(at[0], width) && near(at[1], height)).then_some((at, r))
}

/// Returns a body clipped to the field and a margin, in pixels. Without clipping, a wheel of 0.5 m
/// around a field of 0.1 mm exceeds single precision.
fn visible(points: &[[f64; 2]], field: &Canvas, map: &PixelMap) -> Vec<[f32; 2]> {
    let margin = 8.0 / map.scale;
    let (width, height) = (
        f64::from(field.pixmap.width()),
        f64::from(field.pixmap.height()),
    );
    let low = [map.left - margin, map.top - height / map.scale - margin];
    let high = [map.left + width / map.scale + margin, map.top + margin];
    let kept = clip(points.to_vec(), &sides_of_box(&low, &high));
    kept.into_iter().map(|p| map.point(p)).collect()
}

#[cfg(test)]
mod tests {
    use super::solid::{Faces, Sphere};
    use super::view::View;
    use super::*;
    use crate::png::canvas::png_size;

    const UM: f64 = 1e-6;

    fn frame(bodies: &[Outline], disks: &[Disk], links: &[Link]) -> Frame {
        Frame {
            title: "Field".to_owned(),
            caption: vec!["t = 1 ms".to_owned()],
            window: [0.0, 100.0 * UM, -10.0 * UM, 30.0 * UM],
            bodies: bodies.to_vec(),
            disks: disks.to_vec(),
            links: links.to_vec(),
            zones: Vec::new(),
            scale: None,
            scene: None,
            width_px: 400,
        }
    }

    fn drawn(frame: &Frame, name: &str) -> tiny_skia::Pixmap {
        let name = format!("fretwork-frame-{}-{name}.png", std::process::id());
        let path = std::env::temp_dir().join(name);
        frame.draw(&path).unwrap();
        let pixmap = tiny_skia::Pixmap::load_png(&path).unwrap();
        assert_eq!(png_size(&path), (pixmap.width(), pixmap.height()));
        assert_eq!(pixmap.width(), frame.width_px);
        std::fs::remove_file(path).unwrap();
        pixmap
    }

    #[test]
    fn intact_is_red_and_broken_is_blue() {
        let disks = [15.0, 85.0].map(|x| Disk {
            centre: [x * UM, 10.0 * UM],
            radius: 5.0 * UM,
            ..Disk::default()
        });
        let of = |state| {
            let (a, b) = (disks[0].centre, disks[1].centre);
            let links = [Link {
                a,
                b,
                state,
                width: 4.0,
            }];
            let picture = drawn(
                &frame(&[], &disks, &links),
                &format!("{state:?}").replace(' ', ""),
            );
            // The middle of the field, between title and legend.
            let (side, middle) = (7, picture.width() / 2);
            let scale = f64::from(picture.width() - 2 * side) / (100.0 * UM);
            let below = (20.0 * UM * scale) as u32 + (74.0 * 400.0 / 1400.0) as u32;
            let row = picture.height() - below;
            let columns = (row - 3..=row + 3).map(|y| picture.pixel(middle, y).unwrap());
            let darkest =
                columns.min_by_key(|p| p.red() as u32 + p.green() as u32 + p.blue() as u32);
            let p = darkest.unwrap();
            (p.red(), p.green(), p.blue())
        };
        let (r, g, b) = of(LinkState::Intact { damage: 0.3 });
        assert!(r > 140 && g < 110 && b < 110, "{r} {g} {b}");
        let (r, g, b) = of(LinkState::Broken);
        assert!(b > 200 && r < 110 && g < 160, "{r} {g} {b}");
    }

    #[test]
    fn nothing_to_show_is_a_picture_still() {
        drawn(&frame(&[], &[], &[]), "nothing");
        let hollow = [Outline::default()];
        let bad = [Disk {
            centre: [f64::NAN, 0.0],
            radius: 1.0,
            ..Disk::default()
        }];
        let mut odd = frame(&hollow, &bad, &[]);
        drawn(&odd, "odd");
        let faces = |polygons| Faces {
            polygons,
            paint: Paint::Grey,
            first: true,
        };
        let corner = [f64::NAN, 0.0, 1.0];
        let scene = SolidScene {
            view: View::new(0.6, 0.4),
            spheres: vec![Sphere {
                centre: corner,
                radius: 1.0,
                paint: Paint::Grey,
                first: false,
            }],
            faces: vec![faces(vec![Vec::new()]), faces(vec![vec![corner; 3]])],
        };
        odd.scene = Some(scene);
        drawn(&odd, "space");
        odd.window = [0.0, 1e-6, 0.0, 1.0];
        let tall = drawn(&odd, "tall");
        assert!(tall.height() < 2 * tall.width());
    }

    #[test]
    fn errors_name_what_to_change() {
        let mut wrong = frame(&[], &[], &[]);
        let error = wrong.draw(Path::new("no-such-folder/f.png")).unwrap_err();
        assert!(
            error.to_string().contains("no-such-folder/f.png"),
            "{error}"
        );
        wrong.window = [1.0, 0.0, 0.0, 1.0];
        let error = wrong.draw(Path::new("f.png")).unwrap_err();
        assert!(error.to_string().contains("xmin < xmax"), "{error}");
    }
}
