//! Laws of unit tests: simple enough that what they give is known in closed form.

use super::interface::{Interface, Loaded};
use super::library::Plugin;
use fretwork_law::{
    CohesionLaw, Conductance, ContactLaw, Friction, Law, Site, Spring, Traction, TransportLaw,
    Variable, abi, parameters,
};
use std::path::Path;

parameters! {
    /// Coulomb friction.
    pub struct Coulomb {
        mu: "" = 0.5, 0.0, 10.0, "friction coefficient";
    }
}

impl Law for Coulomb {
    const NAME: &'static str = "coulomb";
    const DOC: &'static str = "friction";
    const REFERENCE: &'static str = "a test";
}

parameters! {
    /// A linear spring without friction.
    pub struct Elastic {
        k: "N/m" = 8.0, 0.0, 1e30, "stiffness";
    }
}

impl Law for Elastic {
    const NAME: &'static str = "elastic";
    const DOC: &'static str = "a linear spring";
    const REFERENCE: &'static str = "a test";
    const FLAGS: u64 = abi::FLAG_COMPLIANT;
}

impl ContactLaw for Elastic {
    fn friction(&self, _: &Site, _: &[f64]) -> Friction {
        Friction::default()
    }

    fn spring(&self, site: &Site, _: &[f64], _: f64) -> Spring {
        Spring::linear(site, self.k, 0.0, 0.0)
    }
}

impl ContactLaw for Coulomb {
    fn friction(&self, _: &Site, _: &[f64]) -> Friction {
        Friction {
            mu: self.mu,
            ..Friction::default()
        }
    }
}

parameters! {
    /// A bond of one stiffness k over the area against opening, sliding and rotation, in tension
    /// only.
    pub struct Bond {
        k: "Pa/m" = 2.0, 0.0, 1e30, "stiffness";
    }
}

impl Law for Bond {
    const NAME: &'static str = "bond";
    const DOC: &'static str = "a linear bond that resists rotation";
    const REFERENCE: &'static str = "a test";
    const FLAGS: u64 =
        abi::FLAG_OPENING | abi::FLAG_TENSION_ONLY | abi::FLAG_MOMENT | abi::FLAG_FORMS;
}

impl CohesionLaw for Bond {
    const DEGRADATION: f64 = 1.0;

    fn traction(&self, site: &Site, _: &[f64]) -> Traction {
        Traction {
            moment: site.rotation.map(|x| self.k * x),
            stiffness_twist: self.k,
            stiffness_bend: self.k,
            ..Traction::linear(site, self.k, self.k)
        }
    }

    fn energy(&self, site: &Site, _: &[f64]) -> f64 {
        let tension = site.opening[0].max(0.0);
        let [_, t1, t2] = site.opening;
        let squares = [tension, t1, t2].into_iter().chain(site.rotation);
        0.5 * self.k * squares.map(|x| x * x).sum::<f64>()
    }
}

parameters! {
    /// Sticks without a bond: a shear cohesion, and no attraction. It has a variable, which it
    /// leaves as it is.
    pub struct Sticky {
        strength: "Pa" = 3.0, 0.0, 1e30, "shear cohesion";
    }
}

impl Law for Sticky {
    const NAME: &'static str = "sticky";
    const DOC: &'static str = "a shear cohesion";
    const REFERENCE: &'static str = "a test";
    const VARIABLES: &'static [Variable] =
        &[Variable::new(c"nothing", c"", c"kept, and not used").starting_at(7.0)];
}

impl CohesionLaw for Sticky {
    fn traction(&self, _: &Site, _: &[f64]) -> Traction {
        Traction {
            shear_cohesion: self.strength,
            ..Traction::default()
        }
    }
}

parameters! {
    /// Conducts 1 W/K for each second that the contact has had, which it counts itself.
    pub struct Growing {
        per_time: "W/K/s" = 1.0, 0.0, 1e30, "conductance per time";
    }
}

impl Law for Growing {
    const NAME: &'static str = "growing";
    const DOC: &'static str = "a conductance that grows with time";
    const REFERENCE: &'static str = "a test";
    const VARIABLES: &'static [Variable] = &[Variable::new(c"time", c"s", c"time so far")];
}

impl TransportLaw for Growing {
    fn conductance(&self, site: &Site, state: &mut [f64]) -> Conductance {
        state[0] += site.h;
        Conductance {
            thermal: self.per_time * state[0],
            electric: 0.0,
        }
    }
}

parameters! {
    /// Conducts 3 W/K, and remembers nothing.
    pub struct Constant {
        conductance: "W/K" = 3.0, 0.0, 1e30, "conductance";
    }
}

impl Law for Constant {
    const NAME: &'static str = "constant";
    const DOC: &'static str = "a constant conductance";
    const REFERENCE: &'static str = "a test";
}

impl TransportLaw for Constant {
    fn conductance(&self, _: &Site, _: &mut [f64]) -> Conductance {
        Conductance {
            thermal: self.conductance,
            electric: 0.0,
        }
    }
}

/// The law of a table of the wrapper, with the defaults of its parameters.
fn loaded(table: *const abi::FwPlugin) -> Loaded {
    // SAFETY: a static table of the wrapper.
    let plugin = unsafe { Plugin::from_table(table, Path::new("a test"), "", true) };
    Loaded::with_defaults(plugin.unwrap())
}

macro_rules! law {
    ($kind:ident $law:ty) => {{
        fretwork_law::plugin_table!($kind $law);
        loaded(&TABLE.0)
    }};
}

/// The laws of the tests, each with the defaults of its parameters.
pub(crate) fn coulomb() -> Loaded {
    law!(contact Coulomb)
}

/// See [`coulomb`].
pub(crate) fn elastic() -> Loaded {
    law!(contact Elastic)
}

/// See [`coulomb`].
pub(crate) fn bond() -> Loaded {
    law!(cohesion Bond)
}

/// See [`coulomb`].
pub(crate) fn sticky() -> Loaded {
    law!(cohesion Sticky)
}

/// See [`coulomb`].
pub(crate) fn growing() -> Loaded {
    law!(transport Growing)
}

/// See [`coulomb`].
pub(crate) fn constant() -> Loaded {
    law!(transport Constant)
}

/// An interface of friction and other laws.
pub(crate) fn interface(laws: impl IntoIterator<Item = Loaded>) -> Interface {
    let laws = std::iter::once(coulomb()).chain(laws);
    Interface::new("test", laws).unwrap()
}
