//! Rungs of a patch: by which theory its tractions are found, and what is known of its error.

use super::bodies::Bodies;
use super::spec::{MotionSpec, PatchFile};
use fretwork_elastic::half_space::CellGrid;
use fretwork_elastic::patch::{LinePatch, Solid, StripCreep, UNLIKE, dundurs};
use fretwork_rolling::{Closed, Fastsim};
use fretwork_scene::InputError;
use serde::{Deserialize, Serialize};

/// How a patch is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Method {
    /// Half-spaces, cell by cell.
    #[default]
    Exact,
    /// Springs in place of half-spaces, the simplified theory.
    Fastsim,
    /// Forces in closed form.
    ClosedForm,
}

impl Method {
    /// All of them, from the cheapest.
    pub const ALL: [Self; 3] = [Self::ClosedForm, Self::Fastsim, Self::Exact];

    /// Returns its name in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "Exact",
            Self::Fastsim => "Fastsim",
            Self::ClosedForm => "ClosedForm",
        }
    }

    /// Returns of what the printed error of a force is.
    pub fn error_of(self) -> &'static str {
        match self {
            Self::Exact => "by the grid",
            Self::Fastsim => "by the simplified theory",
            Self::ClosedForm => "by the closed form",
        }
    }
}

/// Ratios of the axes over which the errors of the cheaper methods are known.
const RATIOS: [f64; 2] = [0.2, 5.0];

/// A patch as its method needs it.
#[derive(Debug)]
pub enum Rung {
    /// Half-spaces.
    Exact,
    /// Springs.
    Fastsim(Fastsim),
    /// An ellipse in closed form.
    Ellipse(Closed),
    /// A line in closed form.
    Line(LinePatch, StripCreep),
}

impl Rung {
    /// Prepares the rung of a file, with the thickness over the shear modulus of its layer (m/Pa).
    ///
    /// # Errors
    /// The file has what the method cannot follow.
    pub fn new(
        file: &PatchFile,
        bodies: &Bodies,
        load: f64,
        layer: f64,
    ) -> Result<Self, InputError> {
        let method = file.spec.method;
        if method == Method::Exact {
            return Ok(Self::Exact);
        }
        let refuse = |why: String| {
            let name = method.name();
            let message = format!("`{name}` {why}; leave out `method`, or write `method: Exact`");
            Err(file.source.error_at("method", message))
        };
        let spec = &file.spec;
        if matches!(spec.motion, MotionSpec::Fretting(_)) {
            return refuse("is a theory of steady rolling, and these bodies fret".into());
        }
        if spec.third_body.is_some() {
            return refuse(
                "has no displacements of the surfaces for the windows of a `third_body`".into(),
            );
        }
        if spec.passages.is_some() {
            return refuse("has the patch of Hertz, and `passages` wear another one".into());
        }
        if spec.distance.is_some() || spec.profiles.is_some() {
            return refuse(
                "has the ellipse of Hertz, and a `distance` or `profiles` have none".into(),
            );
        }
        let solids = bodies.elasticity.map(|b| Solid {
            young: b.young,
            poisson: b.poisson,
        });
        let beta = dundurs(&solids);
        if beta.abs() > UNLIKE {
            return refuse(format!(
                "is a theory of like bodies, and pressure alone makes these slip (Dundurs' constant {beta:.2})"
            ));
        }
        if let Some(length) = bodies.length {
            if method == Method::Fastsim {
                return refuse("has compliances of ellipses, and this is a line contact".into());
            }
            let straight = match &spec.motion {
                MotionSpec::Rolling { across, spin, .. } => {
                    across.0.iter().chain(&spin.0).all(|n| n.value == 0.0)
                }
                MotionSpec::Pulling { spin, .. } => spin.as_ref().is_none_or(|n| n.value == 0.0),
                MotionSpec::Fretting(_) => false,
            };
            if !straight || layer > 0.0 {
                return refuse(
                    "of a line contact is Carter's, along the rolling alone and without a `layer`"
                        .into(),
                );
            }
            let patch = bodies.line(load, length);
            let creep = StripCreep::new(&patch, bodies.distance.curvatures[0]);
            return Ok(Self::Line(patch, creep));
        }
        let hertz = bodies.distance.hertz(load, &bodies.elasticity);
        let rung = match method {
            Method::Fastsim => Fastsim::new(&hertz, load, &solids, layer).map(Self::Fastsim),
            _ => Closed::new(&hertz, load, &solids, layer).map(Self::Ellipse),
        };
        let ratio = hertz.along / hertz.across;
        match rung.filter(|_| (RATIOS[0]..=RATIOS[1]).contains(&ratio)) {
            Some(rung) => Ok(rung),
            None => refuse(format!(
                "has a known error for ratios of the axes from {} to {}, and this patch has {ratio:.3}",
                RATIOS[0], RATIOS[1]
            )),
        }
    }

    /// Returns the pressure of a closed form at a place over the largest one.
    pub fn shape(&self, place: [f64; 2]) -> f64 {
        match self {
            Self::Ellipse(closed) => closed.shape(place),
            Self::Line(patch, _) => {
                let x = place[0] / patch.half_width;
                (1.0 - x * x).max(0.0).sqrt()
            }
            Self::Exact | Self::Fastsim(_) => 0.0,
        }
    }

    /// Returns what the method is and what is known of its error; `None` of the exact one.
    /// `coulomb` is whether friction is that of the pressure alone.
    pub fn about(&self, coulomb: bool) -> Option<String> {
        let other = match coulomb {
            true => "",
            false => {
                ", under Coulomb's law, of which the printed errors are; for this law none is known"
            }
        };
        let compare = "`--trade` compares it with half-spaces";
        match self {
            Self::Exact => None,
            Self::Fastsim(_) => {
                let [plain, spun] = Fastsim::ERROR.map(|x| format!("{:.0} %", 100.0 * x));
                Some(format!(
                    "Fastsim, springs in place of half-spaces and parabolic pressures (J. J. Kalker, Vehicle System Dynamics 11, 1982): forces are off by up to {plain} of that of full slip, with spin {spun}{other}; {compare}"
                ))
            }
            Self::Ellipse(_) => Some(format!(
                "closed form, Kalker's linear theory and the cubic of Vermeulen and Johnson (Z. Y. Shen, J. K. Hedrick, J. A. Elkins, 1983), without moment, fields, wear and temperature; its error is the largest against half-spaces over a range of creepages{other}; {compare}"
            )),
            Self::Line(..) => Some(format!(
                "closed form of F. W. Carter (1926), without fields, wear and temperature: exact for a long line{}",
                match coulomb {
                    true => " under Coulomb's law".to_owned(),
                    false => format!(
                        " under Coulomb's law, of which the printed errors are; for this law none is known; {compare}"
                    ),
                }
            )),
        }
    }

    /// Returns largest pressure (Pa), approach (m) and area (m²) of Hertz; `None` of cells.
    pub fn pressed(&self, grid: &CellGrid) -> Option<[f64; 3]> {
        match self {
            Self::Exact => None,
            Self::Fastsim(Fastsim { patch, .. }) | Self::Ellipse(Closed { patch, .. }) => {
                Some([patch.pressure, patch.approach, patch.area()])
            }
            Self::Line(patch, _) => {
                let area = 2.0 * patch.half_width * grid.extent()[1];
                Some([patch.pressure, f64::NAN, area])
            }
        }
    }
}
