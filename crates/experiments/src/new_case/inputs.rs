//! What is asked about a test of each geometry.

/// Geometry of a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// A cylinder that frets on a flat.
    CylinderOnFlat,
    /// A ball that frets on a flat.
    SphereOnFlat,
    /// A flat pad that frets on a flat.
    FlatOnFlat,
    /// A pin with a round tip on a disc that turns.
    PinOnDisc,
    /// A wheel that rolls on a rail with a creepage.
    WheelOnRail,
    /// A window of debris between two rough surfaces, under a pressure.
    Window,
}

/// One thing that is asked.
#[derive(Debug)]
pub struct Input {
    /// Key.
    pub key: &'static str,
    /// What it is.
    pub asks: &'static str,
    /// An example.
    pub example: &'static str,
    /// What is taken where nothing is given; empty where it may be left out.
    pub default: Option<&'static str>,
    /// Geometries that have it.
    of: &'static [Geometry],
    /// With debris, without, or both.
    debris: Option<bool>,
}

use Geometry::{CylinderOnFlat, FlatOnFlat, PinOnDisc, SphereOnFlat, WheelOnRail, Window};

const FRETTING: &[Geometry] = &[CylinderOnFlat, SphereOnFlat, FlatOnFlat, Window];
const ALL: &[Geometry] = &Geometry::ALL;

const fn input(
    key: &'static str,
    asks: &'static str,
    example: &'static str,
    default: Option<&'static str>,
    of: &'static [Geometry],
    debris: Option<bool>,
) -> Input {
    Input {
        key,
        asks,
        example,
        default,
        of,
        debris,
    }
}

/// Everything that is asked, in order.
static INPUTS: [Input; 19] = [
    input(
        "material",
        "the materials of the two bodies by name, the moving one first (one name is for both)",
        "wheel_steel_er7,rail_steel_r260",
        None,
        ALL,
        None,
    ),
    input(
        "debris",
        "the material of debris between them, if there is any",
        "magnetite",
        Some(""),
        ALL,
        None,
    ),
    input(
        "debris-size",
        "the diameter of its grains",
        "4um",
        None,
        ALL,
        Some(true),
    ),
    input(
        "layer",
        "the thickness of the layer of debris",
        "40um",
        Some(""),
        ALL,
        Some(true),
    ),
    input(
        "radius",
        "the radius of the cylinder, the ball, the tip of the pin or the wheel",
        "10mm",
        None,
        &[CylinderOnFlat, SphereOnFlat, PinOnDisc, WheelOnRail],
        None,
    ),
    input(
        "rail-radius",
        "the radius of the rail head across the rail",
        "300mm",
        Some("0.3m"),
        &[WheelOnRail],
        None,
    ),
    input(
        "track-radius",
        "the radius of the track on the disc",
        "10mm",
        None,
        &[PinOnDisc],
        Some(false),
    ),
    input(
        "length",
        "the length of the line of contact",
        "10mm",
        None,
        &[CylinderOnFlat],
        Some(false),
    ),
    input(
        "area",
        "the area of the pad",
        "25mm^2",
        None,
        &[FlatOnFlat],
        None,
    ),
    input(
        "load",
        "the load; of a cylinder per length of its line",
        "50N, 200N/mm, 75kN",
        None,
        &[
            CylinderOnFlat,
            SphereOnFlat,
            FlatOnFlat,
            PinOnDisc,
            WheelOnRail,
        ],
        None,
    ),
    input(
        "pressure",
        "the pressure on the window",
        "1.1GPa",
        None,
        &[Window],
        None,
    ),
    input(
        "amplitude",
        "the amplitude of the displacement, half of its range",
        "20um",
        None,
        FRETTING,
        None,
    ),
    input(
        "frequency",
        "the frequency of the strokes",
        "20Hz",
        Some("20Hz"),
        FRETTING,
        None,
    ),
    input(
        "cycles",
        "the number of cycles",
        "3",
        Some("3"),
        FRETTING,
        Some(true),
    ),
    input(
        "speed",
        "the speed of sliding, or of the wheel",
        "0.1m/s",
        None,
        &[PinOnDisc, WheelOnRail],
        None,
    ),
    input(
        "distance",
        "the distance of sliding",
        "10m",
        Some("10m"),
        &[PinOnDisc],
        Some(false),
    ),
    input(
        "creepage",
        "the creepage",
        "0.5%",
        None,
        &[WheelOnRail],
        None,
    ),
    input(
        "friction",
        "the friction coefficient; of debris that of its grains",
        "0.6",
        Some("0.6"),
        ALL,
        None,
    ),
    input(
        "wear",
        "the wear coefficient: Archard's K, or k with a unit; without it nothing wears",
        "1e-4",
        Some(""),
        ALL,
        None,
    ),
];

impl Geometry {
    /// All geometries.
    pub const ALL: [Self; 6] = [
        CylinderOnFlat,
        SphereOnFlat,
        FlatOnFlat,
        PinOnDisc,
        WheelOnRail,
        Window,
    ];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            CylinderOnFlat => "cylinder-on-flat",
            SphereOnFlat => "sphere-on-flat",
            FlatOnFlat => "flat-on-flat",
            PinOnDisc => "pin-on-disc",
            WheelOnRail => "wheel-on-rail",
            Window => "window",
        }
    }

    /// What it is.
    pub fn about(self) -> &'static str {
        match self {
            CylinderOnFlat => "a cylinder that frets on a flat",
            SphereOnFlat => "a ball that frets on a flat",
            FlatOnFlat => "a flat pad that frets on a flat",
            PinOnDisc => "a pin with a round tip on a disc that turns",
            WheelOnRail => "a wheel that rolls on a rail with a creepage",
            Window => "debris between two rough surfaces under a pressure",
        }
    }

    /// Returns the geometry of a name.
    ///
    /// # Errors
    /// Names the geometries.
    pub fn named(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|g| g.name() == name);
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("`{name}` is no geometry; there are {names}")
        })
    }

    /// Returns what is asked about a test with debris or without, in order.
    pub fn inputs(self, debris: bool) -> impl Iterator<Item = &'static Input> {
        INPUTS
            .iter()
            .filter(move |i| i.of.contains(&self) && i.debris.is_none_or(|d| d == debris))
    }

    /// Returns everything that is asked about any test.
    pub fn all_inputs() -> impl Iterator<Item = &'static Input> {
        INPUTS.iter()
    }
}
