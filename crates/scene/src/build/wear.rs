//! Setup of the surfaces that wear, with checks that a wear law can act on them.

use super::Builder;
use crate::case::{BodySpec, CellTouch, InterfaceSpec, TouchSpec, WearSpec};
use crate::source::{InputError, ValidationError};
use fretwork_core::geometry::worn_mesh::facing;
use fretwork_core::laws::Kind;
use fretwork_core::view::RunSetup;
use nalgebra::Vector3;

/// Wear of a deformable body, from the case.
pub(super) struct DeformableWear {
    /// Path in the case.
    here: String,
    name: String,
    wears: WearSpec,
}

impl DeformableWear {
    /// Lets a surface of the body wear.
    ///
    /// # Errors
    /// The surface is vertical or overhangs somewhere.
    pub(super) fn add_scar(
        &self,
        s: &mut dyn RunSetup,
        surface: usize,
    ) -> Result<(), ValidationError> {
        let dimension = s.dimension();
        if let Some(place) = wall(dimension, &s.surface_lines(surface)) {
            let carried = s.surfaces()[surface];
            let body = s.motion(carried.body as usize).position;
            let origin = Vector3::from(body) + Vector3::from(carried.offset);
            let at = origin + place;
            let at: Vec<String> = (0..dimension).map(|k| format!("{:.4e}", at[k])).collect();
            let message = format!(
                "the part of `{}` that touches is vertical or overhangs at ({}) m, where it cannot recede along {}: let a part touch that has one height at each place, as `Surface(\"top\")` or `Surface(\"bottom\")`, or leave `wears` out",
                self.name,
                at.join(", "),
                if dimension == 2 { "y" } else { "z" }
            );
            return Err(ValidationError::new(self.here.as_str(), message));
        }
        let WearSpec { thickness, every } = self.wears;
        s.add_scar(surface, self.name.clone(), thickness, every);
        Ok(())
    }
}

/// Returns the first position of an outline that does not face the side that most of it faces, up
/// or down.
fn wall(dimension: usize, outline: &[Vec<[f64; 3]>]) -> Option<Vector3<f64>> {
    let facing = |face: &[[f64; 3]]| {
        if dimension == 2 {
            let along = Vector3::from(face[1]) - Vector3::from(face[0]);
            let upright = along[0].abs() <= 1e-9 * along.norm();
            return if upright { 0.0 } else { along[0].signum() };
        }
        let [a, b, c] = [0, 1, 2].map(|k| Vector3::from(face[k]));
        facing(a, b, c)
    };
    let size = if dimension == 2 { 2 } else { 3 };
    let faces = || outline.iter().flat_map(|face| face.windows(size));
    let most = if faces().map(facing).sum::<f64>() < 0.0 {
        -1.0
    } else {
        1.0
    };
    faces().find(|face| facing(face) != most).map(|face| {
        let places = face.iter().map(|at| Vector3::from(*at));
        let sum = places.fold(Vector3::zeros(), |sum, at| sum + at);
        sum * (1.0 / size as f64)
    })
}

impl Builder<'_> {
    /// Adds the scars of a body whose surfaces begin at index `first` of the list.
    pub(super) fn wears(
        &mut self,
        here: &str,
        spec: &BodySpec,
        first: usize,
    ) -> Result<(), InputError> {
        let Some(wears) = &spec.wears else {
            return Ok(());
        };
        let here = format!("{here}.wears");
        self.check_wears(&here, wears)?;
        let mut worn = 0;
        for surface in first..self.assembly.surface_count() {
            let name = match worn {
                0 => spec.name.clone(),
                k => format!("{}_{}", spec.name, k + 1),
            };
            let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
            if !name.chars().all(plain) || self.assembly.worn_names().contains(&name.as_str()) {
                let message = format!(
                    "the name `{name}` of a body that wears names columns and files: it must be unique and made of letters, digits, `-` and `_`"
                );
                return Err(self.fail(here, message));
            }
            let outline = self.assembly.surface_lines(surface);
            let (thickness, every) = (wears.thickness, wears.every);
            let can_wear = self.assembly.add_scar(surface, name, thickness, every);
            let plane = self.dimension() == 2;
            let upright = |w: &[[f64; 3]]| plane && w[0][0] == w[1][0];
            let at = outline
                .iter()
                .find_map(|line| line.windows(2).position(upright));
            if let (Some(k), true) = (at, can_wear) {
                let message = format!(
                    "the profile is vertical between points {k} and {}, where it cannot recede; tilt it, or leave `wears` out",
                    k + 1
                );
                return Err(self.fail(here, message));
            }
            worn += usize::from(can_wear);
        }
        if worn == 0 {
            let which = if self.dimension() == 2 {
                "a Profile, RoughProfile or StandardProfile"
            } else {
                "a HeightField"
            };
            let message = format!(
                "no shape of the body `{}` can wear; give it {which}, or leave `wears` out",
                spec.name
            );
            return Err(self.fail(here, message));
        }
        Ok(())
    }

    fn check_wears(&self, here: &str, wears: &WearSpec) -> Result<(), InputError> {
        if !(wears.thickness.is_finite() && wears.thickness > 0.0) {
            let message = format!("a thickness must be positive, got {}", wears.thickness);
            return Err(self.fail(format!("{here}.thickness"), message));
        }
        if wears.every == 0 {
            return Err(self.fail(format!("{here}.every"), "must be at least 1"));
        }
        Ok(())
    }

    /// Returns the wear of the deformable bodies, in the order of the systems.
    pub(super) fn deformable_wear(&self) -> Result<Vec<Option<DeformableWear>>, InputError> {
        let elastic = self.case.elastic.iter().enumerate();
        let elastic = elastic.map(|(k, e)| {
            let surface = matches!(e.touches, TouchSpec::Surface(_));
            (
                format!("elastic.{k}"),
                &e.name,
                &e.material,
                &e.wears,
                surface,
            )
        });
        let half_spaces = self.case.half_spaces.iter().enumerate();
        let half_spaces = half_spaces.map(|(k, b)| {
            let surface = b.touches == CellTouch::Surface;
            (
                format!("half_spaces.{k}"),
                &b.name,
                &b.material,
                &b.wears,
                surface,
            )
        });
        let mut out = Vec::new();
        for (here, name, material, wears, surface) in elastic.chain(half_spaces) {
            let here = format!("{here}.wears");
            if let Some(wears) = wears {
                self.check_wears(&here, wears)?;
                let law = |i: &InterfaceSpec| {
                    i.law(Kind::WEAR).is_some()
                        && (i.between.0 == *material || i.between.1 == *material)
                };
                let fault = if !surface {
                    Some(format!(
                        "`{name}` touches by its points, which do not recede; let it touch as `Surface`, and the other body by its points"
                    ))
                } else if !self.case.interfaces.iter().any(law) {
                    Some(format!(
                        "no interface of the material `{material}` has a wear law, so that `{name}` cannot wear; give one a `wear` law, or leave `wears` out"
                    ))
                } else if self.assembly.worn_names().contains(&name.as_str()) {
                    Some(format!(
                        "another surface that wears has the name `{name}`; rename one"
                    ))
                } else {
                    None
                };
                if let Some(message) = fault {
                    return Err(self.fail(here, message));
                }
            }
            out.push(wears.as_ref().map(|wears| DeformableWear {
                here,
                name: name.clone(),
                wears: wears.clone(),
            }));
        }
        Ok(out)
    }

    /// Rejects surfaces that wear although no wear law can remove material from them.
    pub(super) fn refuse_idle_wear(&self) -> Result<(), InputError> {
        for (k, body) in self.case.bodies.iter().enumerate() {
            if body.wears.is_none() {
                continue;
            }
            let of = |i: &&InterfaceSpec| {
                i.law(Kind::WEAR).is_some()
                    && (i.between.0 == body.material || i.between.1 == body.material)
            };
            let laws: Vec<&InterfaceSpec> = self.case.interfaces.iter().filter(of).collect();
            let wrong = if laws.is_empty() {
                Some(format!(
                    "no interface of the material `{}` has a wear law, so the body `{}` cannot wear; give one a `wear` law, or leave `wears` out",
                    body.material, body.name
                ))
            } else if laws.iter().all(|i| !self.slips(body, i)) {
                Some(format!(
                    "nothing slips on the body `{}`: it and all bodies that its wear laws pair it with are fixed along it; let one move, or leave `wears` out",
                    body.name
                ))
            } else {
                None
            };
            if let Some(message) = wrong {
                return Err(self.fail(format!("bodies.{k}.wears"), message));
            }
        }
        for (k, law) in self.case.interfaces.iter().enumerate() {
            let by_friction = matches!(law.law(Kind::WEAR), Some("dissipated-energy" | "t-gamma"));
            let contact = law.law(Kind::CONTACT).unwrap_or_default();
            let mu = law.parameter(Kind::CONTACT, "mu");
            let smooth = contact == "frictionless" || mu.is_some_and(|mu| mu.value == 0.0);
            let worn = |m: &String| {
                let mut bodies = self.case.bodies.iter();
                bodies.any(|b| b.wears.is_some() && b.material == *m)
            };
            if by_friction && smooth && (worn(&law.between.0) || worn(&law.between.1)) {
                let message = format!(
                    "the wear law `{}` takes its volume from the work of friction, and the contact law `{}` leaves none; give it friction, or take `archard`",
                    law.law(Kind::WEAR).unwrap_or_default(),
                    contact
                );
                return Err(self.fail(format!("interfaces.{k}.wear"), message));
            }
        }
        Ok(())
    }

    /// Returns whether a body can slide relative to a body with which it has an interface; false if
    /// all are held in all degrees of freedom at all times.
    fn slips(&self, body: &BodySpec, law: &InterfaceSpec) -> bool {
        let other = if law.between.0 == body.material {
            &law.between.1
        } else {
            &law.between.0
        };
        let held = |b: &BodySpec| {
            let drives = crate::phases::drives_of(self.case, b);
            drives
                .iter()
                .all(|d| d.1 == fretwork_core::bodies::Dof::Fixed)
        };
        let grains = self.assembly.radii().len();
        let loose = self.assembly.has_loose_shapes();
        grains > 0
            && (loose
                || !held(body)
                || self
                    .case
                    .bodies
                    .iter()
                    .any(|b| b.material == *other && !held(b)))
    }
}
