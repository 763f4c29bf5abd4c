//! Contacts of the points of one mesh with the surface of another act on the position that a point
//! faces on average over its facets, see [`crate::geometry::mortar`]. Other contacts act on the
//! nearest position.

use crate::bodies::Nodes;
use crate::contact::Contact;
use crate::geometry::mortar::Star;
use crate::geometry::overlap::{TangentialPoint, signed_size};
use crate::geometry::shape::Surface;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use crate::step::workspace::{MeanPlace, MeanPlaces, Reach};
use std::collections::HashSet;

/// Smallest cosine between the normal of a facet and that of the contact.
const STEEPEST: f64 = 0.2;
/// Largest relative difference of the cell sizes of two grids that count as equal.
const EQUAL: f64 = 1e-9;

/// Returns the coordinates of a position along the contact, relative to its point: in the plane to
/// the right of the normal, in space such that triangles that are anticlockwise seen from the tip
/// of the normal are anticlockwise in these coordinates.
fn along<S: Space>(normal: &S::Vector) -> impl Fn(S::Vector) -> TangentialPoint {
    let [first, second] = S::tangents(normal);
    let sign = if S::D == 2 { -1.0 } else { 1.0 };
    move |from| [sign * from.dot(&first), sign * from.dot(&second)]
}

/// Returns length or area of a facet (m or m^2), given by its first D corners.
fn size<S: Space>([a, b, c]: &[S::Vector; 3]) -> f64 {
    let (u, v) = (*b - *a, *c - *a);
    match S::D {
        2 => u.norm(),
        _ => 0.5 * (u.dot(&u) * v.dot(&v) - u.dot(&v).powi(2)).max(0.0).sqrt(),
    }
}

/// Adds the facets of a surface that a star faces, starting at one of them; `project` gives
/// coordinates along the contact. `None` where one of these facets is steep.
fn add_facets<S: Space>(
    star: &mut Star,
    surface: &dyn Surface<S>,
    near: u32,
    project: impl Fn(&S::Vector) -> TangentialPoint,
) -> Option<()> {
    let vertices = surface.moving_vertices();
    let (mut found, mut seen) = (vec![near], HashSet::from([near]));
    let mut next = 0;
    while next < found.len() {
        let facet = surface.moving_facet(found[next])?;
        let corners = facet.vertices.map(|v| vertices[v as usize]);
        let at = corners.each_ref().map(&project);
        let (ids, at) = (&facet.vertices[..S::D], &at[..S::D]);
        let across = signed_size(at);
        // A facet that is turned away is beyond an edge of the part that the point faces.
        let faces = across > 0.0 && star.is_near(at);
        if faces && star.add_facet(ids, at) && across < STEEPEST * size::<S>(&corners) {
            return None;
        }
        if faces || next == 0 {
            for beside in facet.beside.into_iter().flatten() {
                if seen.insert(beside) {
                    found.push(beside);
                }
            }
        }
        next += 1;
    }
    Some(())
}

/// Returns the nodes on which a contact acts, for [`Simulation::nodes_of_side`].
pub(in crate::step) fn nodes_of_side<S: Space>(
    s: &Simulation<S>,
    contact: &Contact<S>,
    side: usize,
) -> Option<Nodes> {
    let carrier = s.state.bodies.carrier(contact.bodies[side] as usize)?;
    match reach(s, contact) {
        Reach::Mean(mean) if side == 1 => Some(mean.nodes),
        _ => {
            let systems = &s.state.systems;
            Some(systems.contact_nodes(carrier, &contact.arms[side]))
        }
    }
}

/// The vertices below the facets of a point, for [`Simulation::worn_shares`].
pub(in crate::step) fn worn_shares<'a, S: Space>(
    s: &'a Simulation<S>,
    contact: &Contact<S>,
) -> Option<&'a [(u32, f64)]> {
    match s.workspace.means.known(contact)? {
        Reach::Mean(mean) => Some(&mean.shares),
        Reach::Nearest | Reach::Other => None,
    }
}

/// Returns where contacts with surfaces acted, for [`Simulation::acted_on_mean_places`].
pub(in crate::step) fn acted_on_mean_places<S: Space>(
    s: &Simulation<S>,
) -> impl Iterator<Item = (&Contact<S>, bool)> {
    let contacts = s.state.network.contacts.iter();
    contacts.filter_map(|contact| match s.workspace.means.known(contact)? {
        Reach::Mean(_) => Some((contact, true)),
        Reach::Nearest => Some((contact, false)),
        Reach::Other => None,
    })
}

/// Finds the nodes of the antagonist that a point of a mesh faces on average, and their mean
/// position.
fn reach<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> Reach<S> {
    let carriers = contact.bodies.map(|b| s.state.bodies.carrier(b as usize));
    let ([Some(point), Some(carrier)], Some(surface)) = (carriers, contact.key.surface()) else {
        return Reach::Other;
    };
    let surface = &*s.shapes.surfaces[surface].shape;
    let ball = contact.key.ball().map(|ball| &s.shapes.balls[ball]);
    let is_point = ball.is_some_and(|ball| ball.radius == 0.0) && !point.grain;
    if surface.is_closed() || !is_point {
        return Reach::Other;
    }
    let systems = &s.state.systems;
    let facets = systems.facets_at(point);
    if facets.is_empty() || systems.vertex_nodes(carrier, &[(0, 1.0)]).is_none() {
        return match systems.equal_cells([point, carrier], EQUAL) {
            true => Reach::Other,
            false => Reach::Nearest,
        };
    }
    let mean = || {
        let feature = u32::try_from(contact.key.feature).ok()?;
        let b = contact.bodies[1] as usize;
        let (origin, rotation) = (s.state.bodies.position[b], s.state.bodies.rotation[b]);
        let local = |x: &S::Vector| S::unrotate(&rotation, &(*x - origin));
        let at = local(&s.state.bodies.position[contact.bodies[0] as usize]);
        let about: Vec<_> = facets
            .iter()
            .map(|(corners, place)| (corners.each_ref().map(&local), *place))
            .collect();
        let star = |normal: &S::Vector| -> Option<Star> {
            let along = along::<S>(normal);
            let project = |x: &S::Vector| along(*x - at);
            let about = about
                .iter()
                .map(|(corners, place)| (corners.each_ref().map(project), *place));
            let mut star = Star::new(about, S::D)?;
            add_facets(&mut star, surface, surface.facet_of(feature), project)?;
            Some(star)
        };
        // The contact normal of a point beyond the border may have any direction.
        let border = surface.border_normal(feature);
        let beyond = border.and_then(|normal| Some((star(&normal)?.faced_in_part()?, normal)));
        let (faced, normal) = match beyond {
            Some((faced, normal)) => (faced, S::rotate(&rotation, &normal)),
            None => {
                let normal = S::unrotate(&rotation, &contact.normal);
                (star(&normal)?.faced()?, contact.normal)
            }
        };
        let nodes = systems.vertex_nodes(carrier, &faced.weights)?;
        let vertices = surface.moving_vertices();
        let terms = faced.weights.iter();
        let mean = terms.fold(S::Vector::zero(), |sum, (k, w)| {
            sum + vertices[*k as usize] * *w
        });
        Some(MeanPlace {
            nodes,
            place: origin + S::rotate(&rotation, &mean),
            normal,
            shares: faced.shares,
        })
    };
    mean().map_or(Reach::Nearest, |mean| Reach::Mean(Box::new(mean)))
}

/// Finds the mean positions that the points of all contacts face, after bodies have moved.
pub(super) fn find<S: Space>(s: &mut Simulation<S>) {
    s.workspace.means = MeanPlaces::default();
    find_of_new_contacts(s);
}

/// Finds the mean positions for contacts that are new or have another normal; bodies must not have
/// moved since the others were found.
pub(super) fn find_of_new_contacts<S: Space>(s: &mut Simulation<S>) {
    if s.state.systems.is_empty() {
        return;
    }
    let before = std::mem::take(&mut s.workspace.means);
    let mut means = MeanPlaces::default();
    for k in 0..s.state.network.contacts.len() {
        let contact = &s.state.network.contacts[k];
        let reach = match before.known(contact) {
            Some(known) => known.clone(),
            None => reach(s, contact),
        };
        if let Reach::Mean(mean) = &reach {
            s.state.network.turn(k, &mean.normal);
            let contact = &mut s.state.network.contacts[k];
            let [a, b] = contact.bodies.map(|b| s.state.bodies.position[b as usize]);
            contact.gap = (a - mean.place).dot(&contact.normal);
            contact.arms[1] = mean.place - b;
        }
        let contact = &s.state.network.contacts[k];
        means.of.push((contact.key, contact.normal));
        means.found.push(reach);
    }
    s.workspace.means = means;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mortar::FacedVertices;
    use crate::geometry::polyline::Polyline;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    /// Returns the mean position of a point above the foot of a flank of length one, whose normal
    /// has this cosine to that of the contact.
    fn below(cosine: f64) -> Option<FacedVertices> {
        let top = Vector2::new(cosine, (1.0 - cosine * cosine).sqrt());
        let ends = [Vector2::new(-2.0, 0.0), top + Vector2::new(2.0, 0.0)];
        let chain = vec![ends[0], Vector2::zeros(), top, ends[1]];
        let mut surface = Polyline::new(chain.clone(), None).unwrap();
        Surface::<Dim2>::move_vertices(&mut surface, &chain);
        let about = [
            ([[0.0; 2], [-1.0, 0.0], [0.0; 2]], 0),
            ([[1.0, 0.0], [0.0; 2], [0.0; 2]], 1),
        ];
        let mut star = Star::new(about, 2)?;
        let up = Vector2::new(0.0, 1.0);
        let along = along::<Dim2>(&up);
        let at = Vector2::new(0.05, 0.0);
        add_facets(&mut star, &surface, 0, |x| along(*x - at))?;
        star.faced()
    }

    #[test]
    fn a_steep_facet_below_a_point_leaves_it_without_a_mean_place() {
        assert!(below(1.01 * STEEPEST).is_some());
        assert!(below(0.99 * STEEPEST).is_none());
    }
}
