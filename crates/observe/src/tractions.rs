//! Tractions on the surface of a deformable body, and where it sticks and slips: forces of contacts
//! are distributed to the points of the surface by its shape functions, and divided by their
//! tributary areas. The sum of pressure times area is the normal force of all contacts.

use fretwork_core::bodies::TouchingSurface;
use fretwork_core::view::{ContactView, RunView};
use nalgebra::Vector3;
use std::collections::HashMap;

/// Contact status of a point of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactZone {
    /// The point carries no force, or less than a tenth of the share of one contact by its area.
    #[default]
    Open,
    /// Most of the force of the point is of contacts that stick.
    Stick,
    /// At least half of the force of the point is of contacts that slip.
    Slip,
}

impl ContactZone {
    /// Returns the value of the field `status` of contacts: 0 no force, 1 stick, 2 slip.
    pub fn status(self) -> f64 {
        match self {
            Self::Open => 0.0,
            Self::Stick => 1.0,
            Self::Slip => 2.0,
        }
    }
}

/// Share of the force of one contact below which a point counts as open; for a point with a smaller
/// tributary area than that of the touching point in proportion. Where points of two surfaces
/// almost coincide, the adjacent point of the touched surface gets a small share of the force.
const TRACE: f64 = 0.1;

/// Contact surface of a deformable body, with its tractions.
#[derive(Clone, Debug)]
pub struct SurfaceState {
    /// Number of dimensions.
    pub dimension: usize,
    /// Points and facets of the surface.
    pub surface: TouchingSurface<Vector3<f64>>,
    /// Displacement of each point (m).
    pub displacement: Vec<Vector3<f64>>,
    /// Traction on each point, force over area in world axes (Pa).
    pub traction: Vec<Vector3<f64>>,
    /// Part of the traction along the normals of the contacts (Pa), positive in compression.
    pub pressure: Vec<f64>,
    /// Part of the traction along the surface (Pa): in the plane positive along +x, in space its
    /// magnitude.
    pub shear: Vec<f64>,
    /// Vector of that part (Pa).
    pub tangential: Vec<Vector3<f64>>,
    /// Contact status of each point.
    pub zone: Vec<ContactZone>,
}

/// Tractions on a facet: means of its points, with the same total force. Where points have
/// alternately more and fewer facets, pressures of points alternate, and those of facets do not.
#[derive(Clone, Copy, Debug)]
pub struct FacetTraction {
    /// Pressure (Pa).
    pub pressure: f64,
    /// Traction along the surface (Pa).
    pub tangential: Vector3<f64>,
}

impl SurfaceState {
    /// Returns the tractions on a system of a simulation over its last step; `None` where the
    /// system has no contact surface.
    pub fn of(run: &dyn RunView, system: usize) -> Option<Self> {
        let body = run.system(system)?;
        let surface = body.touching_surface()?;
        let count = surface.points.len();
        let place = surface.points.iter().zip(&surface.nodes);
        let displacement = place.map(|(rest, node)| body.node_position(*node) - *rest);
        let displacement = displacement.collect();
        let at: HashMap<u32, usize> = surface.nodes.iter().copied().zip(0..).collect();
        let zero = Vector3::zeros();
        let (mut force, mut tangential) = (vec![zero; count], vec![zero; count]);
        let (mut pressure, mut share) = (vec![0.0; count], vec![0.0; count]);
        let mut slipping = vec![[0.0; 2]; count];
        let mut others = Areas::default();
        for acting in loaded(run, system) {
            let Some(nodes) = run.nodes_of_side(acting.contact.place, acting.side) else {
                continue;
            };
            let touching = match acting.side {
                1 => others.of_point(run, &acting.contact).unwrap_or(0.0),
                _ => 0.0,
            };
            for (node, weight) in nodes.terms() {
                let Some(&k) = at.get(&node) else { continue };
                force[k] += acting.force * weight;
                tangential[k] += acting.along * weight;
                pressure[k] += acting.normal * weight / surface.areas[k];
                share[k] += weight * (touching / surface.areas[k]).max(1.0);
                slipping[k][usize::from(acting.contact.slides)] += acting.force.norm() * weight;
            }
        }
        let over = |v: &Vector3<f64>, k: usize| *v * (1.0 / surface.areas[k]);
        let traction = force.iter().enumerate().map(|(k, f)| over(f, k));
        let along = tangential.iter().enumerate().map(|(k, f)| over(f, k));
        let tangential: Vec<Vector3<f64>> = along.collect();
        let zone = |([sticks, slips], share): (&[f64; 2], &f64)| match () {
            () if *share < TRACE => ContactZone::Open,
            () if slips >= sticks => ContactZone::Slip,
            () => ContactZone::Stick,
        };
        let dimension = run.dimension();
        Some(Self {
            dimension,
            traction: traction.collect(),
            shear: tangential.iter().map(|t| signed(dimension, t)).collect(),
            tangential,
            zone: slipping.iter().zip(&share).map(zone).collect(),
            pressure,
            displacement,
            surface,
        })
    }

    /// Returns the tractions on the facets, in their order.
    pub fn facets(&self) -> Vec<FacetTraction> {
        let mean = |points: &[u32]| {
            let share = 1.0 / points.len() as f64;
            let mut out = FacetTraction {
                pressure: 0.0,
                tangential: Vector3::zeros(),
            };
            for k in points.iter().map(|k| *k as usize) {
                out.pressure += self.pressure[k] * share;
                out.tangential += self.tangential[k] * share;
            }
            out
        };
        let facets = self.surface.facets.chunks_exact(self.dimension);
        facets.map(mean).collect()
    }

    /// Returns the current position of a point (m).
    pub fn place(&self, point: usize) -> Vector3<f64> {
        self.surface.points[point] + self.displacement[point]
    }
}

/// Tributary areas of points of systems, by system and node (m^2; m in the plane), of those that
/// were requested.
#[derive(Default)]
struct Areas(HashMap<u32, HashMap<u32, f64>>);

impl Areas {
    /// Returns the area of the point of a contact; `None` where it is not a point of the surface of
    /// a system.
    fn of_point(&mut self, run: &dyn RunView, contact: &ContactView) -> Option<f64> {
        let carrier = run.bodies().carrier(contact.bodies[0] as usize)?;
        let areas = self.0.entry(carrier.system).or_insert_with(|| {
            let system = run.system(carrier.system as usize);
            let surface = system.and_then(|system| system.touching_surface());
            let by_node = surface.map(|surface| surface.nodes.into_iter().zip(surface.areas));
            by_node.into_iter().flatten().collect()
        });
        let (node, _) = run.nodes_of_side(contact.place, 0)?.terms().next()?;
        areas.get(&node).copied()
    }
}

/// Returns the magnitude of a vector along a surface: in the plane positive along +x.
pub fn signed(dimension: usize, along: &Vector3<f64>) -> f64 {
    match dimension {
        2 if along[0] < 0.0 => -along.norm(),
        _ => along.norm(),
    }
}

/// A contact with a force on a system, over the last step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ActingContact {
    pub contact: ContactView,
    /// Index of the body of the contact that belongs to the system.
    pub side: usize,
    /// Force on the system (N; N/m in 2D).
    pub force: Vector3<f64>,
    /// Part of the force along the normal, positive in compression, and part along the surface.
    pub normal: f64,
    pub along: Vector3<f64>,
}

/// Returns the contacts of a system that carry force.
pub(crate) fn loaded(run: &dyn RunView, system: usize) -> Vec<ActingContact> {
    let bodies = run.bodies();
    let mut out = Vec::new();
    run.visit_contacts(&mut |contact| {
        if contact.impulse == [0.0; 3] {
            return;
        }
        let carrier = |b: u32| {
            let carrier = bodies.carrier(b as usize);
            carrier.is_some_and(|c| c.system as usize == system)
        };
        let [first, second] = contact.bodies.map(carrier);
        let side = match (first, second) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => return,
        };
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let (force, normal) = (Vector3::from(contact.force), Vector3::from(contact.normal));
        out.push(ActingContact {
            contact: *contact,
            side,
            force: force * sign,
            normal: contact.normal_force,
            along: (force - normal * contact.normal_force) * sign,
        });
    });
    out
}
