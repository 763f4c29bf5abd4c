//! Classes of materials, and between which values their properties lie.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A class of materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum MaterialClass {
    /// Carbon, alloyed, stainless and tool steels.
    Steel,
    /// Grey and ductile iron.
    CastIron,
    /// Aluminium and its alloys.
    Aluminium,
    /// Copper, bronze and brass.
    Copper,
    /// Titanium and its alloys.
    Titanium,
    /// Nickel and its alloys.
    Nickel,
    /// Cemented carbides.
    Carbide,
    /// Technical ceramics.
    Ceramic,
    /// Glasses.
    Glass,
    /// Graphite and carbon layers.
    Carbon,
    /// Polymers below their melting point that are no rubbers.
    Polymer,
    /// Rubbers.
    Rubber,
    /// Minerals, oxides of debris, rocks and soils.
    Mineral,
}

/// Smallest and largest plausible value, in SI units, of the density and of properties by their
/// names.
pub type Bounds = [(&'static str, (f64, f64)); 9];

impl MaterialClass {
    /// All classes, in the order in which they are listed.
    pub const ALL: [Self; 13] = [
        Self::Steel,
        Self::CastIron,
        Self::Aluminium,
        Self::Copper,
        Self::Titanium,
        Self::Nickel,
        Self::Carbide,
        Self::Ceramic,
        Self::Glass,
        Self::Carbon,
        Self::Polymer,
        Self::Rubber,
        Self::Mineral,
    ];

    /// Returns its name in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Steel => "steel",
            Self::CastIron => "cast iron",
            Self::Aluminium => "aluminium",
            Self::Copper => "copper",
            Self::Titanium => "titanium",
            Self::Nickel => "nickel",
            Self::Carbide => "cemented carbide",
            Self::Ceramic => "ceramic",
            Self::Glass => "glass",
            Self::Carbon => "carbon",
            Self::Polymer => "polymer",
            Self::Rubber => "rubber",
            Self::Mineral => "mineral",
        }
    }

    /// Whether electrons conduct its heat, so that the law of Wiedemann and Franz holds for it. In
    /// cast iron graphite conducts more than they do.
    pub fn is_metal(self) -> bool {
        use MaterialClass::{Aluminium, Copper, Nickel, Steel, Titanium};
        matches!(self, Steel | Aluminium | Copper | Titanium | Nickel)
    }

    /// Returns the temperature (K) at which all of its materials have melted, where it is known:
    /// the melting point of the pure metal, which alloying lowers (CRC Handbook of Chemistry and
    /// Physics).
    pub fn molten(self) -> Option<f64> {
        match self {
            Self::Steel | Self::CastIron => Some(1811.0),
            Self::Aluminium => Some(933.5),
            _ => None,
        }
    }

    /// Returns the class that a description names: the file of a material need not give one.
    pub fn of_description(words: &str) -> Option<Self> {
        const WORDS: [(&str, MaterialClass); 24] = [
            ("steel", MaterialClass::Steel),
            ("cast iron", MaterialClass::CastIron),
            ("cast_iron", MaterialClass::CastIron),
            ("alumina", MaterialClass::Ceramic),
            ("alumini", MaterialClass::Aluminium),
            ("aluminum", MaterialClass::Aluminium),
            ("bronze", MaterialClass::Copper),
            ("brass", MaterialClass::Copper),
            ("copper", MaterialClass::Copper),
            ("titanium", MaterialClass::Titanium),
            ("nickel", MaterialClass::Nickel),
            ("inconel", MaterialClass::Nickel),
            ("cemented carbide", MaterialClass::Carbide),
            ("tungsten carbide", MaterialClass::Carbide),
            ("ceramic", MaterialClass::Ceramic),
            ("zirconia", MaterialClass::Ceramic),
            ("silicon nitride", MaterialClass::Ceramic),
            ("silicon carbide", MaterialClass::Ceramic),
            ("glass", MaterialClass::Glass),
            ("graphite", MaterialClass::Carbon),
            ("diamond-like", MaterialClass::Carbon),
            ("rubber", MaterialClass::Rubber),
            ("elastomer", MaterialClass::Rubber),
            ("poly", MaterialClass::Polymer),
        ];
        let words = words.to_lowercase();
        // The words of an oxide name its metal too.
        if words.contains("oxide") {
            return None;
        }
        let first = WORDS
            .iter()
            .filter_map(|(word, class)| words.find(word).map(|at| (at, *class)));
        first.min_by_key(|found| found.0).map(|found| found.1)
    }

    /// Returns the plausible values: those of the property charts of M. F. Ashby, Materials
    /// Selection in Mechanical Design (appendix on data of engineering materials), widened so that
    /// no material in use is doubted.
    pub fn bounds(self) -> Bounds {
        match self {
            Self::Steel => bounds(
                [
                    (7400.0, 8900.0),
                    (165e9, 235e9),
                    (0.24, 0.35),
                    (0.8e9, 11e9),
                ],
                (100e6, 4e9),
                [(10.0, 85.0), (380.0, 620.0), (8e-6, 2.1e-5), (9e-8, 1.3e-6)],
            ),
            Self::CastIron => bounds(
                [(6700.0, 7900.0), (60e9, 195e9), (0.2, 0.33), (0.9e9, 8e9)],
                (60e6, 1.3e9),
                [(10.0, 70.0), (380.0, 620.0), (8e-6, 2.1e-5), (2e-7, 1.6e-6)],
            ),
            Self::Aluminium => bounds(
                [(2400.0, 3100.0), (60e9, 95e9), (0.3, 0.37), (0.1e9, 2.3e9)],
                (8e6, 800e6),
                [
                    (70.0, 245.0),
                    (780.0, 1050.0),
                    (1.6e-5, 2.7e-5),
                    (2.5e-8, 1.2e-7),
                ],
            ),
            Self::Copper => bounds(
                [(7200.0, 9100.0), (80e9, 160e9), (0.29, 0.38), (0.3e9, 5e9)],
                (25e6, 1.5e9),
                [
                    (12.0, 410.0),
                    (330.0, 460.0),
                    (1.5e-5, 2.3e-5),
                    (1.6e-8, 5e-7),
                ],
            ),
            Self::Titanium => bounds(
                [(4200.0, 5400.0), (55e9, 130e9), (0.27, 0.39), (0.7e9, 6e9)],
                (120e6, 1.8e9),
                [
                    (4.0, 26.0),
                    (450.0, 640.0),
                    (7e-6, 1.2e-5),
                    (3.5e-7, 2.1e-6),
                ],
            ),
            Self::Nickel => bounds(
                [(7600.0, 9400.0), (140e9, 250e9), (0.24, 0.37), (0.6e9, 9e9)],
                (60e6, 2.5e9),
                [(7.0, 95.0), (350.0, 600.0), (9e-6, 1.9e-5), (6e-8, 1.7e-6)],
            ),
            Self::Carbide => bounds(
                [(4800.0, 16000.0), (330e9, 730e9), (0.17, 0.29), (6e9, 32e9)],
                (500e6, 8e9),
                [(8.0, 150.0), (130.0, 650.0), (3e-6, 1e-5), (1e-7, 2e-6)],
            ),
            Self::Ceramic => bounds(
                [(1900.0, 6600.0), (40e9, 720e9), (0.08, 0.36), (2e9, 8e10)],
                (50e6, 2e10),
                [(0.3, 500.0), (280.0, 1400.0), (3e-7, 1.6e-5), (1e-7, 1e20)],
            ),
            Self::Glass => bounds(
                [
                    (2000.0, 6500.0),
                    (40e9, 120e9),
                    (0.12, 0.32),
                    (1.5e9, 1.1e10),
                ],
                (50e6, 1e10),
                [(0.4, 3.0), (300.0, 1100.0), (1e-8, 1.5e-5), (1e3, 1e20)],
            ),
            Self::Carbon => bounds(
                [(1000.0, 3600.0), (2e9, 1.3e12), (0.02, 0.4), (1e7, 1.2e11)],
                (1e6, 1e11),
                [(0.1, 2500.0), (400.0, 1100.0), (-3e-6, 4e-5), (1e-8, 1e16)],
            ),
            Self::Polymer => bounds(
                [(750.0, 2600.0), (3e7, 4e10), (0.28, 0.499), (5e6, 1.5e9)],
                (2e6, 500e6),
                [(0.05, 5.0), (600.0, 3000.0), (5e-6, 4e-4), (1e-3, 1e20)],
            ),
            Self::Rubber => bounds(
                [(700.0, 2500.0), (5e4, 1e9), (0.37, 0.5), (1e4, 1e8)],
                (1e4, 1e8),
                [(0.05, 2.0), (600.0, 3000.0), (3e-5, 5e-4), (1e-3, 1e20)],
            ),
            Self::Mineral => bounds(
                [(1100.0, 8500.0), (5e8, 6e11), (0.02, 0.46), (5e7, 4e10)],
                (1e5, 2e10),
                [(0.1, 60.0), (250.0, 1600.0), (-1e-5, 7e-5), (1e-8, 1e20)],
            ),
        }
    }
}

/// Plausible values of a solid of any class, from foams and gels to diamond and osmium.
pub fn any_solid() -> Bounds {
    bounds(
        [(5.0, 23_000.0), (1e3, 1.3e12), (0.0, 0.5), (1e3, 1.5e11)],
        (1e2, 1e11),
        [
            (0.005, 3500.0),
            (100.0, 5000.0),
            (-3e-5, 1e-3),
            (1e-9, 1e22),
        ],
    )
}

type Pair = (f64, f64);

fn bounds(
    [density, young, poisson, hardness]: [Pair; 4],
    strength: Pair,
    [conductivity, heat_capacity, expansion, resistivity]: [Pair; 4],
) -> Bounds {
    [
        ("density", density),
        ("young", young),
        ("poisson", poisson),
        ("hardness", hardness),
        ("yield_stress", strength),
        ("conductivity", conductivity),
        ("heat_capacity", heat_capacity),
        ("expansion", expansion),
        ("resistivity", resistivity),
    ]
}
