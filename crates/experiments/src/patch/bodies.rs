//! The two bodies of a patch: elasticity and thermal properties of their materials, and their
//! undeformed distance.

use super::spec::{DistanceSpec, PatchFile, positive, value};
use fretwork_elastic::Elasticity;
use fretwork_elastic::patch::{LinePatch, PointPatch, Solid, effective_modulus, line, point};
use fretwork_math::diffusion::Conductor;
use fretwork_observe::quantity::quantity;
use fretwork_rolling::temperature::Thermal;
use fretwork_scene::InputError;
use fretwork_scene::material::{Material, MaterialLibrary, Sourced};
use fretwork_scene::measured::MeasuredTable;
use fretwork_scene::quantity::hardness_in_pascal;
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
    /// Length of a line contact across the motion (m).
    pub length: Option<f64>,
}

/// Undeformed distance of the bodies: x²/(2 R) along the motion, and a table or y²/(2 R) across it.
#[derive(Clone, Debug)]
pub struct Distance {
    /// Relative curvatures along the motion and across it (1/m).
    pub curvatures: [f64; 2],
    /// Places across the motion (m), ascending, and the distance there (m).
    pub profile: Option<(Vec<f64>, Vec<f64>)>,
}

impl Distance {
    /// Returns the distance at a place (m).
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        let [along, across] = self.curvatures;
        let of_profile = self
            .profile
            .as_ref()
            .map(|(places, values)| between(places, values, y));
        0.5 * along * x * x + of_profile.unwrap_or(0.5 * across * y * y)
    }

    /// Whether the distance is known at a place across the motion (m): beyond the ends of its table
    /// it goes on straight.
    pub fn knows(&self, across: f64) -> bool {
        let Some((places, _)) = &self.profile else {
            return true;
        };
        let ends = places.first().zip(places.last());
        ends.is_some_and(|(first, last)| (*first..=*last).contains(&across))
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

/// Returns a table's value at a place, without kinks, in which pressures would be infinite: on a
/// cubic between two rows with the slopes there of parabolas through three rows, and straight on
/// beyond the ends.
fn between(places: &[f64], values: &[f64], at: f64) -> f64 {
    let last = places.len() - 1;
    let chord = |k: usize| (values[k + 1] - values[k]) / (places[k + 1] - places[k]);
    let slope = |k: usize| match k {
        _ if last == 1 => chord(0),
        0 => chord(0) - (places[1] - places[0]) * bend(places, values, 1),
        k if k == last => chord(k - 1) + (places[k] - places[k - 1]) * bend(places, values, k - 1),
        k => chord(k - 1) + (places[k] - places[k - 1]) * bend(places, values, k),
    };
    if at <= places[0] || at >= places[last] {
        let end = if at <= places[0] { 0 } else { last };
        return values[end] + slope(end) * (at - places[end]);
    }
    let next = places.partition_point(|p| *p <= at).clamp(1, last);
    let width = places[next] - places[next - 1];
    let x = (at - places[next - 1]) / width;
    let [from, to] = [next - 1, next].map(|k| width * slope(k));
    let (a, b) = (values[next - 1], values[next]);
    let cubic = 2.0 * (a - b) + from + to;
    let square = 3.0 * (b - a) - 2.0 * from - to;
    a + x * (from + x * (square + x * cubic))
}

/// Half of the second derivative of the parabola through a row and its neighbours.
fn bend(places: &[f64], values: &[f64], k: usize) -> f64 {
    let chord = |k: usize| (values[k + 1] - values[k]) / (places[k + 1] - places[k]);
    (chord(k) - chord(k - 1)) / (places[k + 1] - places[k - 1])
}

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
        let mut curvatures = [0.0; 2];
        for (k, body) in pair.into_iter().enumerate() {
            let material = &files[&body.material];
            let at = format!("bodies.{k}");
            for (axis, (name, radius)) in [("radius", &body.radius), ("across", &body.across)]
                .into_iter()
                .enumerate()
            {
                let Some(radius) = radius else { continue };
                let path = format!("{at}.{name}");
                let radius = value(source, &path, radius, "m")?;
                if radius == 0.0 {
                    return Err(source.error_at(&path, "a radius is not 0; a plane has none"));
                }
                curvatures[axis] += 1.0 / radius;
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
                    "young {young:e} Pa and poisson {poisson} of the material `{}` must be above 0, and from 0 to 0.5",
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
            Some(number) => positive(source, "temperature", number, "K")?,
            None => ROOM,
        };
        let mut bulks = [bulk; 2];
        for (k, body) in pair.into_iter().enumerate() {
            let path = format!("bodies.{k}.temperature");
            if let Some(own) = &body.temperature {
                bulks[k] = positive(source, &path, own, "K")?;
            }
        }
        let profile = spec
            .distance
            .as_ref()
            .map(|d| profile(file, d))
            .transpose()?;
        if let Some((places, values)) = &profile {
            curvatures[1] = typical(places, values);
        }
        let length = length(file, curvatures[1])?;
        for (name, curvature) in [("along", curvatures[0]), ("across", curvatures[1])] {
            if curvature <= 0.0 && (name == "along" || length.is_none()) {
                return Err(source.error_at(
                    "bodies",
                    format!(
                        "the bodies conform {name} the motion: their curvatures 1/R1 + 1/R2 there add to {curvature:.3e} 1/m, which must be above 0 for a patch that ends; a cylinder on a plane has a `length`"
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
            distance: Distance {
                curvatures,
                profile,
            },
            length,
        })
    }

    /// Returns the hardness of both bodies (Pa), where their materials have it.
    pub fn hardness(&self) -> [Option<f64>; 2] {
        self.names.each_ref().map(|name| {
            let material = self.materials.iter().find(|(m, _)| m == name)?;
            let hardness = material.1.get("hardness")?;
            hardness_in_pascal(hardness.value, &hardness.unit)
        })
    }

    /// Returns a note where the largest pressure (Pa) is above the hardness of a body.
    pub fn yields(&self, pressure: f64) -> Option<String> {
        let both = self.hardness().into_iter().zip(&self.names);
        let known = both.filter_map(|(own, name)| Some((own?, name)));
        let (softest, name) = known.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (pressure > softest).then(|| {
            format!(
                "NOT IN RANGE: the largest pressure, {}, is above the hardness of {name}, {}: the bodies yield, and here they are elastic",
                quantity(pressure, "Pa"),
                quantity(softest, "Pa")
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
    match across == 0.0 && file.spec.distance.is_none() {
        true => Ok(Some(length)),
        false => Err(source.error_at(
            "length",
            "a contact along a line of this length is that of bodies straight across the motion: leave out their `across` and the `distance`, or the `length`",
        )),
    }
}

/// Reads the table of a measured distance.
fn profile(file: &PatchFile, spec: &DistanceSpec) -> Result<(Vec<f64>, Vec<f64>), InputError> {
    let source = &file.source;
    if file.spec.bodies.0.across.is_some() || file.spec.bodies.1.across.is_some() {
        return Err(source.error_at(
            "distance",
            "the distance across the motion is measured, so the bodies have no radius `across`",
        ));
    }
    let path = file.beside(&spec.file);
    let table = MeasuredTable::read(&path).map_err(|e| source.named_at("distance.file", e))?;
    let column = |name: &str| -> Result<Vec<f64>, InputError> {
        let column = table.required(name)?;
        let values = table.values(column)?;
        let unit = &table.headings[column].unit;
        let in_metres = |v: f64| fretwork_scene::units::convert(v, unit, "m");
        let values: Result<Vec<f64>, _> = values.into_iter().map(in_metres).collect();
        values.map_err(|e| {
            source.error_at("distance.file", format!("column `{name}`: {}", e.message))
        })
    };
    let (places, values) = (column(&spec.across)?, column(&spec.distance)?);
    let mut rows: Vec<(f64, f64)> = places.into_iter().zip(values).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    if rows.len() < 3 || rows.windows(2).any(|w| w[0].0 == w[1].0) {
        return Err(source.error_at(
            "distance.file",
            "three rows or more are expected, each at another place",
        ));
    }
    Ok(rows.into_iter().unzip())
}

/// Returns a curvature of a profile about its lowest point (1/m), the median of those of parabolas
/// through its rows: the scale of the patch to begin with.
fn typical(places: &[f64], values: &[f64]) -> f64 {
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
