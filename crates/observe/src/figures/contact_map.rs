//! Maps of a contact in space: cells of a surface seen along its normal, with colours and arrows.

use crate::chart::{Axis, Chart, Colours, FieldMap, quantity};
use crate::picture::{OPEN_COLOUR, SLIP_COLOUR, STICK_COLOUR};
use crate::tractions::{ContactZone, FacetTraction, SurfaceState};
use nalgebra::Vector3;

/// Returns the maps of the contact of a surface: pressure, stick and slip with the tangential
/// tractions, shear, and their ratio; none where nothing is loaded. Tractions are those of the
/// points of the surface where these have equal tributary areas, otherwise those of its facets.
pub(crate) fn charts(name: &str, state: &SurfaceState, equal: bool) -> Vec<Chart> {
    let touching = |k: &usize| state.zone[*k] != ContactZone::Open;
    let loaded: Vec<usize> = (0..state.zone.len()).filter(touching).collect();
    let Some(axes) = plane(state, &loaded).filter(|_| state.dimension == 3) else {
        return Vec::new();
    };
    let view = View {
        state,
        axes,
        window: window(state, axes, &loaded),
    };
    let (cells, points) = view.points();
    let (shapes, tractions) = match equal {
        true => (cells.clone(), view.at_points(&points)),
        false => view.at_facets(),
    };
    let [x, y] = axes.map(|axis| Axis::new(format!("position {}", ["x", "y", "z"][axis]), "m"));
    let chart = |what: &str, cells: &[Vec<[f64; 2]>], colours: Colours| {
        let mut chart = Chart::new(format!("{what}, {name}"), x.clone(), y.clone());
        let [xmin, xmax, ymin, ymax] = view.window;
        (chart.x_range, chart.y_range) = (Some((xmin, xmax)), Some((ymin, ymax)));
        chart.field = Some(FieldMap {
            cells: cells
                .iter()
                .map(|c| c.iter().copied().map(single).collect())
                .collect(),
            colours,
            arrows: Vec::new(),
            arrow_label: String::new(),
        });
        chart
    };
    let longest = tractions.iter().fold(0.0, |most: f64, t| most.max(t.shear));
    let arrow =
        |(k, along): (usize, [f64; 2])| (single(view.at(k)), single(along.map(|x| x / longest)));
    let drawn = view.around(&loaded, equal).into_iter();
    let mut zones = chart("Stick and slip", &cells, zones(state, &points));
    if let Some(field) = &mut zones.field {
        field.arrows = drawn.filter(|_| longest > 0.0).map(arrow).collect();
        field.arrow_label = format!("shear, longest {}", quantity(longest, "Pa", 3));
    }
    let ratio = |t: &Local| match t.pressure > 0.0 {
        true => t.shear / t.pressure,
        false => f64::NAN,
    };
    let mut out = Vec::new();
    let mut add = |what: &str, (name, unit): (&str, &str), of: &dyn Fn(&Local) -> f64| {
        let value = |t: &Local| if t.loaded { of(t) } else { f64::NAN };
        let values: Vec<f64> = tractions.iter().map(value).collect();
        if values.iter().any(|v| *v > 0.0) {
            let scale = Axis::new(name, unit);
            out.push(chart(what, &shapes, Colours::Values { values, scale }));
        }
    };
    add("Pressure", ("pressure p", "Pa"), &|t| t.pressure);
    add("Shear", ("shear traction q", "Pa"), &|t| t.shear);
    add("Shear over pressure", ("q/p", ""), &ratio);
    // What the contact carries comes first, where it carries anything.
    out.insert(out.len().min(1), zones);
    out
}

/// Converts to single precision, which is enough for figures.
fn single(p: [f64; 2]) -> [f32; 2] {
    p.map(|x| x as f32)
}

/// Returns colours for stick and slip at some points.
fn zones(state: &SurfaceState, points: &[usize]) -> Colours {
    let classes = [
        ("sticks", STICK_COLOUR),
        ("slips", SLIP_COLOUR),
        ("open", OPEN_COLOUR),
    ];
    let class = |k: &usize| match state.zone[*k] {
        ContactZone::Stick => 0,
        ContactZone::Slip => 1,
        ContactZone::Open => 2,
    };
    Colours::Classes {
        classes: classes
            .map(|(name, colour)| (name.to_owned(), colour))
            .to_vec(),
        of: points.iter().map(class).collect(),
    }
}

/// Tractions on a cell of a map.
struct Local {
    loaded: bool,
    pressure: f64,
    /// Size of the traction along the surface (Pa).
    shear: f64,
}

/// Returns the two axes other than the one nearest to the normal of the loaded part.
fn plane(state: &SurfaceState, loaded: &[usize]) -> Option<[usize; 2]> {
    let mut normal = Vector3::zeros();
    for k in loaded {
        normal += (state.traction[*k] - state.tangential[*k]) * state.surface.areas[*k];
    }
    let normal = normal.map(f64::abs);
    let across = (0..3).max_by(|a, b| normal[*a].total_cmp(&normal[*b]));
    match across.filter(|_| !loaded.is_empty())? {
        0 => Some([1, 2]),
        1 => Some([0, 2]),
        _ => Some([0, 1]),
    }
}

impl Local {
    fn new(loaded: bool, pressure: f64, tangential: &Vector3<f64>) -> Self {
        Self {
            loaded,
            pressure,
            shear: tangential.norm(),
        }
    }
}

/// A square around some points with a margin: xmin, xmax, ymin, ymax (m).
fn window(state: &SurfaceState, axes: [usize; 2], loaded: &[usize]) -> [f64; 4] {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut area = 0.0f64;
    for k in loaded {
        let place = state.place(*k);
        for (a, axis) in axes.into_iter().enumerate() {
            (low[a], high[a]) = (low[a].min(place[axis]), high[a].max(place[axis]));
        }
        area = area.max(state.surface.areas[*k]);
    }
    let side = (high[0] - low[0]).max(high[1] - low[1]) + 2.0 * area.sqrt();
    let [x, y] = [0, 1].map(|a| 0.5 * (low[a] + high[a]));
    let half = 0.65 * side;
    [x - half, x + half, y - half, y + half]
}

/// A surface seen along an axis, in a window (m).
struct View<'a> {
    state: &'a SurfaceState,
    axes: [usize; 2],
    window: [f64; 4],
}

/// Corners of polygons (m).
type Shapes = Vec<Vec<[f64; 2]>>;

impl View<'_> {
    fn at(&self, point: usize) -> [f64; 2] {
        let place = self.state.place(point);
        self.axes.map(|axis| place[axis])
    }

    fn shows(&self, corners: &[[f64; 2]]) -> bool {
        let [xmin, xmax, ymin, ymax] = self.window;
        let inside = |[x, y]: &[f64; 2]| *x > xmin && *x < xmax && *y > ymin && *y < ymax;
        corners.iter().any(inside)
    }

    /// Iterates over the facets in the window: index, points, and corners.
    fn facets(&self) -> impl Iterator<Item = (usize, &[u32; 3], [[f64; 2]; 3])> {
        let facets = self.state.surface.facets.as_chunks::<3>().0.iter();
        let all = facets.enumerate();
        all.map(|(f, points)| (f, points, points.map(|k| self.at(k as usize))))
            .filter(|(_, _, corners)| self.shows(corners))
    }

    /// Returns the cells of the points, in pieces of which a point has several, and the point of
    /// each piece.
    fn points(&self) -> (Shapes, Vec<usize>) {
        let (mut cells, mut seen) = (Vec::new(), Vec::new());
        for (_, points, corners) in self.facets() {
            let centre = centre(&corners);
            for (i, k) in points.iter().enumerate() {
                let between = |j: usize| [0, 1].map(|a| 0.5 * (corners[i][a] + corners[j][a]));
                let quad = [
                    corners[i],
                    between((i + 1) % 3),
                    centre,
                    between((i + 2) % 3),
                ];
                cells.push(quad.to_vec());
                seen.push(*k as usize);
            }
        }
        (cells, seen)
    }

    /// Returns the tangential tractions at some points, along both axes (Pa): those of the points,
    /// or means of the facets around them.
    fn around(&self, points: &[usize], own: bool) -> Vec<(usize, [f64; 2])> {
        let state = self.state;
        let mut sums = vec![(Vector3::zeros(), 0.0); state.zone.len()];
        for (facet, traction) in state
            .surface
            .facets
            .chunks_exact(state.dimension)
            .zip(state.facets())
        {
            for k in facet {
                let sum = &mut sums[*k as usize];
                *sum = (sum.0 + traction.tangential, sum.1 + 1.0);
            }
        }
        let mean = |k: &usize| {
            let (sum, count) = sums[*k];
            let traction = if own {
                state.tangential[*k]
            } else {
                sum * (1.0 / count)
            };
            (*k, self.axes.map(|axis| traction[axis]))
        };
        points.iter().map(mean).collect()
    }

    fn at_points(&self, points: &[usize]) -> Vec<Local> {
        let state = self.state;
        let local = |k: &usize| {
            let loaded = state.zone[*k] != ContactZone::Open;
            Local::new(loaded, state.pressure[*k], &state.tangential[*k])
        };
        points.iter().map(local).collect()
    }

    fn at_facets(&self) -> (Shapes, Vec<Local>) {
        let tractions = self.state.facets();
        let facet = |(f, points, corners): (usize, &[u32; 3], [[f64; 2]; 3])| {
            let open = |k: &u32| self.state.zone[*k as usize] == ContactZone::Open;
            let FacetTraction {
                pressure,
                tangential,
            } = &tractions[f];
            let loaded = !points.iter().all(open);
            let local = Local::new(loaded, *pressure, tangential);
            (corners.to_vec(), local)
        };
        self.facets().map(facet).unzip()
    }
}

/// Returns where the cells around the corners of a triangle meet: the centre of its circumcircle,
/// which gives squares on a grid, or the middle of its longest edge where that centre lies outside.
fn centre(corners: &[[f64; 2]; 3]) -> [f64; 2] {
    let squared = |i: usize, j: usize| {
        let [dx, dy] = [0, 1].map(|a| corners[i][a] - corners[j][a]);
        dx * dx + dy * dy
    };
    // The edges are opposite to the corners.
    let edges = [squared(1, 2), squared(2, 0), squared(0, 1)];
    let total: f64 = edges.iter().sum();
    let mut weights = [0, 1, 2].map(|k| (edges[k] * (total - 2.0 * edges[k])).max(0.0));
    if weights.iter().all(|w| *w == 0.0) {
        weights = [1.0; 3];
    }
    let sum: f64 = weights.iter().sum();
    [0, 1].map(|a| (0..3).map(|k| weights[k] * corners[k][a]).sum::<f64>() / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_a_grid_are_squares_and_blunt_triangles_keep_their_cells_inside() {
        assert_eq!(centre(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]]), [1.0, 1.0]);
        let blunt = centre(&[[0.0, 0.0], [4.0, 0.0], [2.0, 0.5]]);
        assert!((blunt[0] - 2.0).abs() < 1e-12 && blunt[1].abs() < 1e-12);
    }
}
