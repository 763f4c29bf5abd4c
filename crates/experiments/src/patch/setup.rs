//! A patch from its file: bodies, laws, grid.

use super::bodies::Bodies;
use super::law::PatchLaw;
use super::method::Rung;
use super::profiles::{self, Contact, Profiles};
use super::spec::{MotionSpec, PatchFile, positive};
use crate::Error;
use fretwork_core::laws::{Interface, Kind, LawField, ParameterOrigin, SearchPath};
use fretwork_elastic::half_space::CellGrid;
use fretwork_rolling::patch::{Patch, coarser};
use fretwork_rolling::{Creepage, NormalError, PatchError, Refined, Surfaces, normal};
use fretwork_scene::case::SlotValues;
use fretwork_scene::material::MaterialLibrary;
use fretwork_scene::source::Source;
use fretwork_scene::wear_coefficient::WearCoefficient;
use fretwork_scene::{Case, InputError, interfaces};
use std::collections::BTreeMap;

/// A patch that can be solved.
#[derive(Debug)]
pub struct Setup {
    /// Both bodies.
    pub bodies: Bodies,
    /// Load (N), along the normal of the contact.
    pub load: f64,
    /// Speed of rolling (m/s).
    pub speed: Option<f64>,
    /// Thickness over shear modulus of the layer between the bodies (m/Pa).
    pub layer: f64,
    /// The grid.
    pub grid: CellGrid,
    /// What its method needs.
    pub rung: Rung,
    /// The laws, and those of the members.
    pub laws: Vec<PatchLaw>,
    /// The wear coefficient, where it follows from the hardness of a material.
    pub wear_coefficient: Option<WearCoefficient>,
    /// Texts of the parameter files of laws that were read, by name.
    pub files: Vec<(String, String)>,
}

/// Speed of rolling of laws that do not read it, where the file gives none (m/s).
const ANY_SPEED: f64 = 1.0;
/// Half of the side of the grid over the semi-axis of the patch, at least.
const AROUND: f64 = 1.1;
/// Distance of the middles of the outermost cells from the middle of the patch over its semi-axis,
/// at least, in all grids that are compared.
const OUTSIDE: f64 = 1.005;
/// Growth of a grid at whose border a patch of thin ends has pressure, and most times of it.
const CLEAR: (f64, usize) = (1.1, 8);
/// Cells along a side of the grids on which the size of a patch is found, the growth of the grid
/// from one to the next, and their largest number.
const SEARCH: (usize, f64, usize) = (32, 1.5, 20);

impl Setup {
    /// Makes a patch from its file under a load (N), with laws from a search path.
    ///
    /// # Errors
    /// The file names what does not exist, a number is out of range, or a law cannot act in a
    /// patch.
    pub fn new(file: &PatchFile, load: f64, search: &SearchPath) -> Result<Self, Error> {
        let (spec, source) = (&file.spec, &file.source);
        let mut bodies = Bodies::read(file)?;
        let speed = spec.speed.as_ref();
        let speed = speed
            .map(|s| positive(source, "speed", s, "m/s"))
            .transpose()?;
        let rolls = !matches!(spec.motion, MotionSpec::Fretting(_));
        if speed.is_none() || !rolls {
            bodies.thermal = None;
        }
        let layer = match &spec.layer {
            None => 0.0,
            Some(layer) => {
                let thickness = positive(source, "layer.thickness", &layer.thickness, "m")?;
                let path = "layer.shear_modulus";
                thickness / positive(source, path, &layer.shear_modulus, "Pa")?
            }
        };
        let load = profiles::settle(file, &mut bodies, load)?;
        let own = SlotValues::default();
        let members = std::iter::once(&own).chain(&spec.members);
        let mut out = Self {
            grid: grid(&bodies, load, spec.cells)?,
            rung: Rung::new(file, &bodies, load, layer)?,
            load,
            speed,
            layer,
            laws: Vec::new(),
            wear_coefficient: None,
            files: Vec::new(),
            bodies,
        };
        for (k, member) in members.enumerate() {
            let built = build(file, &out.bodies, member, search).map_err(|e| match k {
                0 => e,
                // Where a value of a member is wrong, the interface has none in the file.
                _ => source.error_at(&format!("members.{}", k - 1), e.message()),
            })?;
            let pair = out.bodies.names.each_ref().map(|name| {
                let places = out.bodies.materials.iter().position(|(m, _)| m == name);
                places.unwrap_or_default() as u16
            });
            let Some(index) = built.table.get(pair[0], pair[1]) else {
                return Err(Error::Input(source.error_at(
                    "interfaces",
                    format!(
                        "no interface is between `{}` and `{}`, the materials of the bodies",
                        out.bodies.names[0], out.bodies.names[1]
                    ),
                )));
            };
            let mut interface = built.interfaces[usize::from(index)].clone();
            if let Some(law) = interface.wear().filter(|_| !rolls)
                && law.plugin.parameters.iter().any(|p| p.name == "speed")
            {
                return Err(Error::Input(source.error_at(
                    &format!("interfaces.{index}"),
                    format!(
                        "the wear law `{}` is over the distance rolled, of which fretting has none: take one over slip, such as archard",
                        law.plugin.name
                    ),
                )));
            }
            take_speed(&mut interface, out.speed);
            let at = format!("interfaces.{index}");
            if k == 0 {
                let mut of_this = built.wear_coefficients.into_iter();
                out.wear_coefficient = of_this.find(|w| w.interface == interface.name);
                out.files = built.files;
            }
            let ends = match spec.members.is_empty() {
                true => ends_of_table(&interface),
                false => Vec::new(),
            };
            for interface in std::iter::once(interface).chain(ends) {
                let law = PatchLaw::new(interface, out.bodies.thermal);
                let law = law.map_err(|why| source.error_at(&at, why))?;
                out.laws.push(if rolls { law } else { law.staying() });
            }
        }
        if rolls {
            let with = "the `speed` of rolling, such as `speed: 100 km/h`";
            out.check_time(file, out.speed, with)?;
        }
        Ok(out)
    }

    /// Refuses laws that may depend on the velocity of slip where the time of a step is not known.
    ///
    /// # Errors
    /// There is such a law; the sentence says what to give.
    pub fn check_time(
        &self,
        file: &PatchFile,
        known: Option<f64>,
        with: &str,
    ) -> Result<(), InputError> {
        let varies = self.laws.iter().find(|l| !l.is_constant());
        let Some(law) = varies.filter(|_| known.is_none()) else {
            return Ok(());
        };
        let interface = law.interface();
        let place = file
            .spec
            .interfaces
            .iter()
            .position(|i| i.name == interface.name);
        let path = format!("interfaces.{}.contact", place.unwrap_or_default());
        let why = format!(
            "friction of the contact law `{}` may depend on the velocity of slip: give {with}",
            interface.contact().plugin.name
        );
        Err(file.source.error_at(&path, why))
    }

    /// Speed of rolling (m/s), with some value where no law reads it.
    pub fn rolling_speed(&self) -> f64 {
        self.speed.unwrap_or(ANY_SPEED)
    }

    /// Returns the contact of two profiles, where they are given.
    pub fn contact(&self) -> Option<Contact> {
        let profiles = self.bodies.profiles.as_ref();
        profiles.map(|p| p.contact(self.load))
    }

    /// Returns what limits the trust in a point with a largest pressure (Pa).
    pub fn notes(&self, pressure: f64) -> Vec<String> {
        let strength = self.bodies.strength(None);
        let mut out: Vec<String> = strength
            .and_then(|s| s.indents(pressure))
            .into_iter()
            .collect();
        out.extend(self.bodies.short_line(self.load));
        out.extend(self.contact().iter().flat_map(Contact::notes));
        out
    }

    /// Returns the spin by the contact angle that adds to that of the motion (1/m).
    pub fn added_spin(&self) -> f64 {
        let profiles = self.bodies.profiles.as_ref();
        profiles.map_or(0.0, Profiles::added_spin)
    }

    /// Solves steady rolling cell by cell, with the error of the grid.
    ///
    /// # Errors
    /// There is no solution.
    pub fn refined(&self, creepage: &Creepage, law: &PatchLaw) -> Result<Refined, PatchError> {
        let speed = self.rolling_speed();
        match &self.rung {
            Rung::Fastsim(springs) => Ok(springs.refined(self.grid, creepage, law, speed)),
            _ => self.with_patch(|patch| patch.refined(self.grid, creepage, law, speed)),
        }
    }

    /// Calls a function with the patch.
    pub fn with_patch<R>(&self, call: impl FnOnce(&Patch<'_>) -> R) -> R {
        let distance = |place| self.bodies.distance.at(place);
        call(&Patch {
            bodies: self.bodies.elasticity,
            layer: self.layer,
            distance: &distance,
            load: self.load,
        })
    }
}

/// Returns an interface with friction at either end of the interval of its table, if it has one.
fn ends_of_table(interface: &Interface) -> Vec<Interface> {
    let law = interface.contact();
    let mut fields = law.plugin.parameters.iter();
    let place = fields
        .position(|f| f.name == "within")
        .filter(|_| !law.table.is_empty());
    let Some(place) = place else {
        return Vec::new();
    };
    let end = |end: f64| {
        let mut other = interface.clone();
        other.parameters_mut(Kind::CONTACT)?[place] = end;
        Some(other)
    };
    [-1.0, 1.0].into_iter().filter_map(end).collect()
}

/// Gives a wear law that asks for the speed of rolling that of the patch, unless the file gives it.
fn take_speed(interface: &mut Interface, speed: Option<f64>) {
    let Some((law, speed)) = interface.wear().zip(speed) else {
        return;
    };
    let asks = |(field, origin): (&LawField, &ParameterOrigin)| {
        field.name == "speed" && *origin == ParameterOrigin::Default
    };
    let mut fields = law.plugin.parameters.iter().zip(&law.origins);
    let place = fields.position(asks);
    if let Some(place) = place
        && let Some(values) = interface.parameters_mut(Kind::WEAR)
    {
        values[place] = speed;
    }
}

/// Builds the interfaces of a file, with the parameters of a member.
fn build(
    file: &PatchFile,
    bodies: &Bodies,
    member: &SlotValues,
    search: &SearchPath,
) -> Result<interfaces::Laws, InputError> {
    let spec = &file.spec;
    let text =
        r#"(name: "", dimension: 3, time: (step: 1, end: 1), materials: {}, interfaces: [])"#;
    let mut case = Case::read(&Source::from_text("patch", text))?;
    (*case.materials).clone_from(&spec.materials);
    case.interfaces.clone_from(&spec.interfaces);
    case.pins.clone_from(&spec.pins);
    let [one, other] = &bodies.names;
    let ours = |between: &(String, String)| {
        (&between.0, &between.1) == (one, other) || (&between.0, &between.1) == (other, one)
    };
    for interface in case.interfaces.iter_mut().filter(|i| ours(&i.between)) {
        for (kind, values) in member.iter() {
            let mut all = interface.parameters.get(kind).cloned().unwrap_or_default();
            all.extend(values.clone());
            interface.parameters.set(kind, all);
        }
    }
    let properties: Vec<BTreeMap<_, _>> = bodies.materials.iter().map(|m| m.1.clone()).collect();
    let library = MaterialLibrary::beside(&file.path);
    interfaces::build(&case, &file.source, &library, &properties, search)
}

/// Returns a grid around the patch; of a line contact one row of cells as long as the line.
///
/// # Errors
/// The size of the patch is not found.
pub(super) fn grid(bodies: &Bodies, load: f64, cells: usize) -> Result<CellGrid, Error> {
    // The error of the grid is from grids of cells twice as large, one of them half a cell of its
    // own aside: the middles of its outermost cells lie outside of the patch too.
    let wide = AROUND.max(OUTSIDE / (1.0 - 4.0 / cells as f64));
    if let Some(length) = bodies.length {
        let half = wide * bodies.line(load, length).half_width;
        return Ok(CellGrid {
            from: [-half, -0.5 * length],
            size: [2.0 * half / cells as f64, length],
            cells: [cells, 1],
        });
    }
    let hertz = bodies.distance.hertz(load, &bodies.elasticity);
    let around = |from: [f64; 2], to: [f64; 2], cells: usize| CellGrid {
        from,
        size: [0, 1].map(|k| (to[k] - from[k]) / cells as f64),
        cells: [cells; 2],
    };
    let centred = |half: [f64; 2], cells| around(half.map(|h| -h), half, cells);
    let half = [wide * hertz.along, wide * hertz.across];
    if bodies.distance.profile.is_none() {
        return Ok(centred(half, cells));
    }
    let (coarse, growth, most) = SEARCH;
    let (mut half, mut last) = (half, None);
    for _ in 0..most {
        let grid = centred(half, coarse);
        let surfaces = Surfaces::new(grid, bodies.elasticity, 0.0);
        let distance: Vec<f64> = (0..grid.len())
            .map(|c| bodies.distance.at(grid.middle(c)))
            .collect();
        match normal(&surfaces, &distance, load, None) {
            Ok(found) => {
                // The patch with a cell around it.
                let (mut from, mut to) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
                for cell in (0..grid.len()).filter(|c| found.pressure[*c] > 0.0) {
                    for (k, x) in grid.middle(cell).into_iter().enumerate() {
                        from[k] = from[k].min(x - 1.6 * grid.size[k]);
                        to[k] = to[k].max(x + 1.6 * grid.size[k]);
                    }
                }
                // As much around it as around a patch of Hertz, see above.
                for k in 0..2 {
                    let more = 0.5 * (to[k] - from[k]) * (wide / AROUND - 1.0);
                    (from[k], to[k]) = (from[k] - more, to[k] + more);
                }
                let filled = (to[0] - from[0]) / grid.extent()[0];
                let wide = (to[1] - from[1]) / grid.extent()[1];
                if filled.min(wide) > 0.4 || last == Some([from, to]) {
                    return clear(bodies, load, around(from, to, cells));
                }
                last = Some([from, to]);
                half = [0, 1].map(|k| 1.2 * to[k].max(-from[k]));
            }
            Err(NormalError::Border) => half = half.map(|h| growth * h),
            Err(other) => return Err(Error::Failed(other.to_string())),
        }
    }
    Err(Error::Failed(
        "the size of the patch was not found: its distance may be flat up to the ends of the table"
            .into(),
    ))
}

/// Returns a grid on which a patch does not reach the border, nor on the ones of larger cells with
/// which it is compared: as given, or larger where ends of the patch are thinner than the cells on
/// which its size was found.
fn clear(bodies: &Bodies, load: f64, mut grid: CellGrid) -> Result<CellGrid, Error> {
    let reaches = |grid: CellGrid| {
        let surfaces = Surfaces::new(grid, bodies.elasticity, 0.0);
        let distance = (0..grid.len()).map(|c| bodies.distance.at(grid.middle(c)));
        let distance: Vec<f64> = distance.collect();
        match normal(&surfaces, &distance, load, None) {
            Err(NormalError::Border) => Ok(true),
            Err(other) => Err(Error::Failed(other.to_string())),
            Ok(_) => Ok(false),
        }
    };
    for _ in 0..CLEAR.1 {
        let [coarse, other] = coarser(&grid);
        if !(reaches(coarse)? || reaches(other)? || reaches(grid)?) {
            return Ok(grid);
        }
        for k in 0..2 {
            let more = (CLEAR.0 - 1.0) * grid.extent()[k];
            grid.from[k] -= 0.5 * more;
            grid.size[k] *= CLEAR.0;
        }
    }
    Ok(grid)
}
