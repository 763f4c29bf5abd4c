//! Units of quantities. In 2D extensive quantities are per metre of depth; only this module makes
//! units depend on the dimension.

/// The SI unit of a quantity, in space and in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    space: &'static str,
    plane: &'static str,
}

/// A pure number.
pub const ONE: Unit = Unit::of("1");
/// Unit of texts and flags, which are not numbers.
pub const WORD: Unit = Unit::of("");
/// Lengths.
pub const METRE: Unit = Unit::of("m");
/// Times.
pub const SECOND: Unit = Unit::of("s");
/// Velocities.
pub const SPEED: Unit = Unit::of("m/s");
/// Angles.
pub const RADIAN: Unit = Unit::of("rad");
/// Stresses.
pub const PASCAL: Unit = Unit::of("Pa");
/// Temperatures.
pub const KELVIN: Unit = Unit::of("K");
/// Forces.
pub const FORCE: Unit = Unit::by_depth("N", "N/m");
/// Work, energy, heat.
pub const ENERGY: Unit = Unit::by_depth("J", "J/m");
/// Power, heat flow.
pub const POWER: Unit = Unit::by_depth("W", "W/m");
/// Stiffnesses.
pub const STIFFNESS: Unit = Unit::by_depth("N/m", "N/m per m");
/// Masses.
pub const MASS: Unit = Unit::by_depth("kg", "kg/m");
/// Mass per time.
pub const MASS_FLOW: Unit = Unit::by_depth("kg/s", "kg/(m s)");
/// Volumes.
pub const VOLUME: Unit = Unit::by_depth("m^3", "m^3/m");
/// Areas; lengths in the plane.
pub const AREA: Unit = Unit::by_depth("m^2", "m");
/// Force times path.
pub const LOAD_PATH: Unit = Unit::by_depth("N m", "N");
/// Worn volume per load and sliding path, for coefficients of Archard's law.
pub const WEAR_RATE: Unit = Unit::of("m^3/(N m)");
/// Worn volume per dissipated energy, for slopes of wear against the energy of friction.
pub const WEAR_PER_ENERGY: Unit = Unit::of("m^3/J");
/// Momenta.
pub const MOMENTUM: Unit = Unit::by_depth("N s", "N s/m");
/// Angular momenta.
pub const ANGULAR_MOMENTUM: Unit = Unit::by_depth("N m s", "N s");
/// Electric resistances.
pub const RESISTANCE: Unit = Unit::by_depth("ohm", "ohm m");
/// Electric currents.
pub const CURRENT: Unit = Unit::by_depth("A", "A/m");
/// Heat flow per difference of temperature.
pub const CONDUCTANCE: Unit = Unit::by_depth("W/K", "W/(m K)");
/// Electric conductances.
pub const ELECTRIC_CONDUCTANCE: Unit = Unit::by_depth("S", "S/m");
/// Moments of forces.
pub const MOMENT: Unit = Unit::by_depth("N m", "N m/m");
/// Heat over a difference of temperature.
pub const HEAT_CAPACITY: Unit = Unit::by_depth("J/K", "J/(K m)");
/// Moments of inertia.
pub const INERTIA: Unit = Unit::by_depth("kg m^2", "kg m");

impl From<&'static str> for Unit {
    /// A unit that is the same in every dimension; an empty text for pure numbers.
    fn from(symbol: &'static str) -> Self {
        match symbol {
            "" => ONE,
            _ => Self::of(symbol),
        }
    }
}

impl Unit {
    /// Creates a unit that is the same in every dimension; `1` for pure numbers.
    pub const fn of(symbol: &'static str) -> Self {
        Self::by_depth(symbol, symbol)
    }

    /// A unit in space, and per metre of depth in the plane.
    pub const fn by_depth(space: &'static str, plane: &'static str) -> Self {
        Self { space, plane }
    }

    /// Returns the symbol in a dimension: `1` for pure numbers, empty for texts and flags.
    pub const fn symbol(self, dimension: usize) -> &'static str {
        if dimension == 2 {
            self.plane
        } else {
            self.space
        }
    }

    /// Returns the symbol for the heading of a column, empty for pure numbers.
    pub const fn heading(self, dimension: usize) -> &'static str {
        match self.symbol(dimension).as_bytes() {
            b"1" => "",
            _ => self.symbol(dimension),
        }
    }
}
