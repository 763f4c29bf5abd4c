//! The two bodies of a patch: elasticity and thermal properties of their materials, and their
//! undeformed distance.

use super::columns::column;
use super::profiles::Profiles;
use super::spec::{DistanceSpec, PatchFile, positive, temperature, value};
use crate::amounts::short;
use crate::limits::{BodyStrength, Strength, Traction, not_hertz, radius_in_metres};
use fretwork_elastic::Elasticity;
use fretwork_elastic::patch::{LinePatch, PointPatch, Solid, effective_modulus, line, point};
use fretwork_math::diffusion::Conductor;
use fretwork_observe::quantity::{number, quantity};
use fretwork_rolling::Curve;
use fretwork_rolling::temperature::Thermal;
use fretwork_scene::InputError;
use fretwork_scene::material::{Material, MaterialClass, MaterialLibrary, Sourced};
use fretwork_scene::measured::MeasuredTable;
use std::collections::BTreeMap;

/// Temperature of the bodies by default (K).
const ROOM: f64 = 293.15;

/// Both bodies.
#[derive(Debug)]
pub struct Bodies {
    /// Materials by their names in the file, in its order: name and properties.
    pub materials: Vec<(String, BTreeMap<String, Sourced>)>,
    /// Names of the two materials.
    pub names: [String; 2],
    /// Elasticity of the bodies.
    pub elasticity: [Elasticity; 2],
    /// Thermal properties, where both materials have them.
    pub thermal: Option<Thermal>,
    /// Their distance.
    pub distance: Distance,
    /// Their profiles, where they are given.
    pub profiles: Option<Profiles>,
    /// Length of a line contact across the motion (m).
    pub length: Option<f64>,
    /// What is known of the strength of the bodies.
    pub strengths: [BodyStrength; 2],
    /// Temperatures at which the materials have melted (K), where they are known.
    molten: [Option<f64>; 2],
    /// Curvatures of each body along the motion and across it, by their radii (1/m).
    curvatures: [[f64; 2]; 2],
    /// What is doubtful in the radii of the file.
    doubts: Vec<String>,
}

/// Undeformed distance of the bodies: x²/(2 R) along the motion, and a table or y²/(2 R) across it.
#[derive(Clone, Debug)]
pub struct Distance {
    /// Relative curvatures along the motion and across it (1/m).
    pub curvatures: [f64; 2],
    /// The distance over the place across the motion (m).
    pub profile: Option<Curve>,
    /// The curvature along the motion over that place (1/m), where it changes.
    pub along: Option<Curve>,
}

impl Distance {
    /// Returns the distance at a place (m).
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let along = self.along.as_ref().map(|c| c.at(y));
        let along = along.unwrap_or(self.curvatures[0]);
        let across = self.profile.as_ref().map(|c| c.at(y));
        0.5 * along * x * x + across.unwrap_or(0.5 * self.curvatures[1] * y * y)
    }

    /// Whether the distance is known at a place across the motion (m): beyond the ends of its table
    /// it goes on straight.
    pub fn knows(&self, across: f64) -> bool {
        self.profile.as_ref().is_none_or(|c| c.knows(across))
    }

    /// Returns the patch by Hertz; for a profile, that of a parabola like it.
    pub fn hertz(&self, load: f64, bodies: &[Elasticity; 2]) -> PointPatch {
        point(load, self.curvatures, modulus(bodies))
    }
}

fn modulus(bodies: &[Elasticity; 2]) -> f64 {
    effective_modulus(&bodies.map(|b| Solid {
        young: b.young,
        poisson: b.poisson,
    }))
}

/// Length of a line contact over half of its width below which its ends matter.
const SLENDER: f64 = 10.0;

impl Bodies {
    /// Reads materials and radii of a file.
    ///
    /// # Errors
    /// A material or a property is missing, a number is out of range, or the bodies conform.
    pub fn read(file: &PatchFile) -> Result<Self, InputError> {
        let (spec, source) = (&file.spec, &file.source);
        let library = MaterialLibrary::beside(&file.path);
        let mut materials = Vec::new();
        let mut files = BTreeMap::new();
        for (name, from) in &spec.materials {
            let path = format!("materials.{name}");
            let read = library.read(from).map_err(|e| match e {
                Err(error) => source.named_at(&path, error),
                Ok(missing) => source
                    .error_at(
                        &path,
                        format!("there is no file `{from}.ron` in {}", missing.searched),
                    )
                    .expected(format!("one of {}", missing.available))
                    .did_you_mean(missing.nearest.as_deref()),
            })?;
            let material: Material = read.parse()?;
            material.density().map_err(|fault| read.locate(fault))?;
            materials.push((name.clone(), material.properties.clone()));
            files.insert(name.clone(), material);
        }
        let pair = [&spec.bodies.0, &spec.bodies.1];
        let mut elasticity = Vec::new();
        let mut conductors = Vec::new();
        let mut by_radii = [[0.0; 2]; 2];
        let mut doubts = Vec::new();
        for (k, body) in pair.into_iter().enumerate() {
            let material = &files[&body.material];
            let at = format!("bodies.{k}");
            for (axis, (name, radius)) in [("radius", &body.radius), ("across", &body.across)]
                .into_iter()
                .enumerate()
            {
                let Some(given) = radius else { continue };
                let path = format!("{at}.{name}");
                let radius = value(source, &path, given, "m")?;
                if given.unit.is_none() {
                    doubts.extend(radius_in_metres(radius, &short(radius)));
                }
                if radius == 0.0 {
                    return Err(source.error_at(&path, "a radius is not 0; a plane has none"));
                }
                by_radii[k][axis] = 1.0 / radius;
            }
            let property = |name: &str, unit: &str| {
                let given = material.properties.get(name)?;
                given.in_unit(unit).ok().filter(|x| x.is_finite())
            };
            let needed = |name: &str, unit: &str| {
                property(name, unit).ok_or_else(|| {
                    source.error_at(
                        &format!("{at}.material"),
                        format!("the material `{}` has no `{name}`", body.material),
                    )
                })
            };
            let (young, poisson) = (needed("young", "Pa")?, needed("poisson", "")?);
            let density = material.density().map_err(|fault| source.locate(fault))?;
            if !(young > 0.0 && (0.0..=0.5).contains(&poisson)) {
                let message = format!(
                    "young {} and poisson {} of the material `{}` must be above 0, and from 0 to 0.5",
                    quantity(young, "Pa"),
                    number(poisson, 4),
                    body.material
                );
                return Err(source.error_at(&format!("{at}.material"), message));
            }
            elasticity.push(Elasticity {
                young,
                poisson,
                density,
            });
            let conductivity = property("conductivity", "W/(m K)");
            let capacity = property("heat_capacity", "J/(kg K)");
            conductors.extend(
                conductivity
                    .zip(capacity)
                    .map(|(conductivity, c)| Conductor {
                        conductivity,
                        capacity: c * density,
                    }),
            );
        }
        let bulk = match &spec.temperature {
            Some(number) => temperature(source, "temperature", number)?,
            None => ROOM,
        };
        let mut bulks = [bulk; 2];
        for (k, body) in pair.into_iter().enumerate() {
            let path = format!("bodies.{k}.temperature");
            if let Some(own) = &body.temperature {
                bulks[k] = temperature(source, &path, own)?;
            }
        }
        let mut curvatures = [0, 1].map(|axis| by_radii[0][axis] + by_radii[1][axis]);
        let profile = spec
            .distance
            .as_ref()
            .map(|d| profile(file, d))
            .transpose()?;
        if let Some(profile) = &profile {
            curvatures[1] = typical(profile);
        }
        let mut distance = Distance {
            curvatures,
            profile,
            along: None,
        };
        let profiles = Profiles::read(file)?;
        if let Some(profiles) = &profiles {
            distance = profiles.distance();
        }
        let curvatures = distance.curvatures;
        let length = length(file, curvatures[1])?;
        for (name, curvature) in [("along", curvatures[0]), ("across", curvatures[1])] {
            if curvature <= 0.0 && (name == "along" || length.is_none()) {
                return Err(source.error_at(
                    "bodies",
                    format!(
                        "the bodies conform {name} the motion: their curvatures 1/R1 + 1/R2 there add to {}, which must be above 0 for a patch that ends; a cylinder on a plane has a `length`",
                        quantity(curvature, "1/m")
                    ),
                ));
            }
        }
        Ok(Self {
            materials,
            names: pair.map(|b| b.material.clone()),
            elasticity: [elasticity[0], elasticity[1]],
            thermal: (conductors.len() == 2).then(|| Thermal {
                bodies: [conductors[0], conductors[1]],
                bulk: bulks,
            }),
            distance,
            profiles,
            length,
            strengths: pair.map(|b| BodyStrength::of(&b.material, &files[&b.material].properties)),
            molten: pair.map(|b| {
                let class = files[&b.material].class_or_described(&spec.materials[&b.material]);
                class.and_then(MaterialClass::molten)
            }),
            curvatures: by_radii,
            doubts,
        })
    }

    /// Returns what limits the trust in all points under a load (N): radii in another unit, and a
    /// patch that is not small beside them.
    pub fn limits(&self, load: f64) -> Vec<String> {
        let axes = match self.length {
            Some(length) => [Some(self.line(load, length).half_width), None],
            None => {
                let hertz = self.distance.hertz(load, &self.elasticity);
                [hertz.along, hertz.across].map(Some)
            }
        };
        let bodies = self.names.iter().map(String::as_str).zip(self.curvatures);
        let mut out = self.doubts.clone();
        out.extend(not_hertz(bodies, axes));
        out
    }

    /// Returns the strength of the bodies under a tangential force.
    pub fn strength(&self, traction: Option<Traction>) -> Option<Strength> {
        let [one, other] = &self.strengths;
        Strength::of([one, other], self.length.is_some(), None, traction)
    }

    /// Returns the hardness of both bodies (Pa), where their materials have it.
    pub fn hardness(&self) -> [Option<f64>; 2] {
        self.strengths.each_ref().map(|s| s.hardness)
    }

    /// Returns a note where a temperature of the surfaces (K) is one at which a body has melted.
    pub fn melts(&self, temperature: f64) -> Option<String> {
        let both = self.molten.into_iter().zip(&self.names);
        let known = both.filter_map(|(own, name)| Some((own?, name)));
        let (lowest, name) = known.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (temperature > lowest).then(|| {
            format!(
                "NOT IN RANGE: {} K is above {} K, where {name} has melted: long before, its surface softens, and friction and temperature fall; take a contact law whose friction falls with temperature, or a smaller creepage, load or speed",
                number(temperature, 4),
                number(lowest, 4)
            )
        })
    }

    /// Returns a note where a line contact under a load (N) is short beside its width.
    pub fn short_line(&self, load: f64) -> Option<String> {
        let length = self.length?;
        let half = self.line(load, length).half_width;
        (length < SLENDER * half).then(|| {
            format!(
                "NOT IN RANGE: the line is {} long and {} wide, and ends that bulge are not in plane strain; give radii `across` for a short contact",
                quantity(length, "m"),
                quantity(2.0 * half, "m")
            )
        })
    }

    /// Returns the patch by Hertz of a line contact of a length (m).
    pub fn line(&self, load: f64, length: f64) -> LinePatch {
        let modulus = modulus(&self.elasticity);
        line(load / length, self.distance.curvatures[0], modulus)
    }
}

/// Reads the length of a line contact (m).
fn length(file: &PatchFile, across: f64) -> Result<Option<f64>, InputError> {
    let source = &file.source;
    let Some(length) = &file.spec.length else {
        return Ok(None);
    };
    let length = positive(source, "length", length, "m")?;
    match across == 0.0 && file.spec.distance.is_none() && file.spec.profiles.is_none() {
        true => Ok(Some(length)),
        false => Err(source.error_at(
            "length",
            "a contact along a line of this length is that of bodies straight across the motion: leave out their `across`, `distance` or `profiles`, or the `length`",
        )),
    }
}

/// Reads the table of a measured distance.
fn profile(file: &PatchFile, spec: &DistanceSpec) -> Result<Curve, InputError> {
    let source = &file.source;
    if file.spec.bodies.0.across.is_some() || file.spec.bodies.1.across.is_some() {
        return Err(source.error_at(
            "distance",
            "the distance across the motion is measured, so the bodies have no radius `across`",
        ));
    }
    let path = file.beside(&spec.file);
    let table = MeasuredTable::read(&path).map_err(|e| source.named_at("distance.file", e))?;
    let lengths = |name: &str| column(source, "distance.file", &table, (name, "m"));
    let (places, values) = (lengths(&spec.across)?, lengths(&spec.distance)?);
    let rows: Vec<[f64; 2]> = places.into_iter().zip(values).map(Into::into).collect();
    let curve = Some(rows).filter(|r| r.len() > 2).and_then(Curve::through);
    curve.ok_or_else(|| {
        source.error_at(
            "distance.file",
            "three rows or more are expected, each at another place",
        )
    })
}

/// Returns a curvature of a profile about its lowest point (1/m), the median of those of parabolas
/// through its rows: the scale of the patch to begin with.
fn typical(profile: &Curve) -> f64 {
    let (places, values) = (profile.places(), profile.values());
    let lowest = (0..values.len())
        .min_by(|a, b| values[*a].total_cmp(&values[*b]))
        .unwrap_or(0);
    let rise = |k: usize| {
        let away = places[k] - places[lowest];
        2.0 * (values[k] - values[lowest]) / (away * away)
    };
    let others = (0..values.len()).filter(|k| *k != lowest).map(rise);
    let mut rises: Vec<f64> = others.filter(|r| *r > 0.0).collect();
    rises.sort_by(f64::total_cmp);
    rises.get(rises.len() / 2).copied().unwrap_or(0.0)
}
