//! The model of heat: given by the case, not changed by steps.

use super::circuit::Circuit;
use super::material::ThermalMaterial;
use super::pieces::Pieces;
use crate::contact::{ContactDissipation, MaterialPair};
use crate::geometry::space::Space;
use fretwork_math::diffusion::{Columns, Edge};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;

/// Share of each kind of dissipated energy that becomes heat at its contact; the rest remains
/// elsewhere (new surfaces, sound, stored plastic work).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct HeatShares {
    /// Share of the friction.
    pub friction: f64,
    /// Share of the impacts.
    pub impact: f64,
    /// Share of the damping of bonds and compliant contacts.
    pub viscous: f64,
    /// Share of the work against cohesion without an opening.
    pub adhesion: f64,
    /// Share of the energy that damage releases: its plastic part. The energy of bonds whose
    /// contact moved out of range is not included.
    pub fracture: f64,
}

impl Default for HeatShares {
    /// Returns shares of 1 for all dissipation except fracture, which creates surfaces.
    fn default() -> Self {
        Self {
            friction: 1.0,
            impact: 1.0,
            viscous: 1.0,
            adhesion: 1.0,
            fracture: 0.0,
        }
    }
}

impl HeatShares {
    /// Returns the heat from the energies dissipated at a contact (J).
    #[inline]
    pub fn heat(&self, dissipated: &ContactDissipation) -> f64 {
        self.friction * dissipated.friction
            + self.impact * dissipated.impact
            + self.viscous * dissipated.viscous
            + self.adhesion * dissipated.adhesion
            + self.fracture * dissipated.fracture
    }
}

/// Split of the heat of a contact between its two sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Partition {
    /// The heat is split in proportion to the effusivities e = sqrt(k rho c), so that two
    /// half-spaces keep one surface temperature.
    #[default]
    Effusivity,
    /// Half of the heat goes to each side.
    Half,
}

/// The nodes of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyNodes {
    /// No nodes: no heat enters the body.
    Insulated,
    /// One node.
    One(u32),
    /// One node for each piece of the surface, starting at this one.
    Pieces(u32, Pieces),
    /// The nodes of a mesh of finite elements, from the first to before the second.
    Mesh(u32, u32),
}

impl BodyNodes {
    /// The nodes.
    pub fn range(&self) -> Range<usize> {
        match self {
            Self::Insulated => 0..0,
            Self::One(node) => *node as usize..*node as usize + 1,
            Self::Mesh(first, end) => *first as usize..*end as usize,
            Self::Pieces(first, pieces) => *first as usize..(*first + pieces.count()) as usize,
        }
    }

    /// Returns the node at a position in the axes of the body (m); `None` for a mesh, where a
    /// position is between several nodes.
    #[inline]
    pub fn at<S: Space>(&self, place: impl FnOnce() -> S::Vector) -> Option<u32> {
        match self {
            Self::Insulated | Self::Mesh(..) => None,
            Self::One(node) => Some(*node),
            Self::Pieces(first, pieces) => Some(first + pieces.piece::<S>(&place())),
        }
    }
}

/// A heat flow from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImposedHeatFlow {
    /// Returns the body whose removal isolates the node; `None` for finite elements, which are not
    /// removed.
    pub body: Option<u32>,
    /// The node.
    pub node: u32,
    /// The flow (W; W/m in 2D).
    pub flow: f64,
}

/// Heat of a scene, as a case gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat {
    /// Properties of the materials, by index.
    pub materials: Vec<ThermalMaterial>,
    /// All pairs of materials, as [`Heat::pairs`] returns them.
    pub pairs: Arc<[MaterialPair]>,
    /// Material of each body.
    pub material: Vec<u16>,
    /// Nodes of each body.
    pub nodes: Vec<BodyNodes>,
    /// Half-spaces between which heat flows tangentially.
    pub columns: Vec<Columns>,
    /// Conductances of finite elements between nodes (W/K; W/(m K) in 2D).
    pub elements: Vec<Edge>,
    /// First bodies that exchange heat, with their nodes: driven ones in their order, then those of
    /// finite elements.
    pub first_bodies: Vec<(String, Range<usize>)>,
    /// Heat flows imposed from outside.
    pub imposed: Vec<ImposedHeatFlow>,
    /// Temperature of bodies without nodes whose contacts have none either (K).
    pub initial: f64,
    /// Shares of dissipation that become heat.
    pub shares: HeatShares,
    /// Split of the heat of a contact between its bodies.
    pub partition: Partition,
    /// Theta of the heat's time scheme, 1/2 to 1.
    pub theta: f64,
    /// Ratio of thermal to mechanical time: in a step of h heat flows for `clock` h, while the
    /// frictional heat does not change.
    pub clock: f64,
    /// Number of steps of the mechanics per step of the heat.
    pub every: u64,
    /// Time from which heat flows and is supplied (s); temperatures are constant before it.
    pub start: f64,
    /// Hardness (Pa), which gives the area on which sliding contacts are warmer than their bodies;
    /// `None` for no flash temperatures.
    pub flash: Option<f64>,
    /// The electric circuit.
    pub circuit: Option<Circuit>,
}

impl Heat {
    /// Returns the properties of the material of a body.
    #[inline]
    pub fn material_of(&self, body: u32) -> &ThermalMaterial {
        &self.materials[usize::from(self.material[body as usize])]
    }

    /// Returns all pairs of materials, by the index of the first and then of the second.
    pub fn pairs(materials: &[ThermalMaterial]) -> Arc<[MaterialPair]> {
        let of = |a: &ThermalMaterial, b: &ThermalMaterial| MaterialPair {
            material: [a.pair_conductivity(b), a.pair_resistivity(b)],
            share: a.conductor().share(&b.conductor()),
        };
        let all = materials.iter();
        all.flat_map(|a| materials.iter().map(move |b| of(a, b)))
            .collect()
    }

    /// Returns the index in [`Self::pairs`] of the materials of two bodies.
    #[inline]
    pub fn pair(&self, bodies: [u32; 2]) -> usize {
        let [a, b] = bodies;
        let of = |body: u32| usize::from(self.material[body as usize]);
        of(a) * self.materials.len() + of(b)
    }

    /// Returns the share of the heat of a contact that its first body takes, by the index of its
    /// materials in [`Self::pairs`].
    #[inline]
    pub fn share(&self, pair: usize) -> f64 {
        match self.partition {
            Partition::Half => 0.5,
            Partition::Effusivity => self.pairs[pair].share,
        }
    }

    /// Returns the rise of temperature (K) of the contact spots of two bodies above that of the
    /// bodies, under a force (N; N/m in 2D) at a sliding speed `v` (m/s) with a friction power (W;
    /// W/m in 2D). The real area is force over hardness; in 3D it is one circle, in 2D one band,
    /// and moves at half of the speed over each of the bodies. The rises that all of the heat would
    /// cause in either body alone combine like resistances in parallel (H. Blok, Proc. Inst. Mech.
    /// Eng. 2 (1937) 222-235).
    pub fn flash_rise<S: Space>(&self, bodies: [u32; 2], force: f64, v: f64, power: f64) -> f64 {
        let Some(hardness) = self.flash else {
            return 0.0;
        };
        if !(force > 0.0 && v > 0.0 && power > 0.0) {
            return 0.0;
        }
        let area = force / hardness;
        // An insulated body takes no heat.
        let taking = bodies
            .iter()
            .filter(|b| self.nodes[**b as usize] != BodyNodes::Insulated);
        let inverse = taking.map(|b| {
            let body = self.material_of(*b).conductor();
            let rise = match S::D {
                2 => body.band(power / area, 0.5 * area, 0.5 * v),
                _ => body.circle(power / area, (area / std::f64::consts::PI).sqrt(), 0.5 * v),
            };
            1.0 / rise
        });
        1.0 / inverse.sum::<f64>()
    }
}
