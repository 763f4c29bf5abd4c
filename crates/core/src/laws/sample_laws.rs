//! Laws for unit tests, simple enough that their outputs are known in closed form.

use super::interface::{Interface, LoadedLaw};
use super::library::Plugin;
use crate::contact::Contact;
use crate::contact::network::{ContactGeometry, Key};
use crate::geometry::space::Dim2;
use fretwork_law::{
    CohesionLaw, Conductance, ContactLaw, Friction, Law, Site, Spring, Traction, TransportLaw,
    Variable, abi, parameters, plugin_table,
};
use nalgebra::Vector2;
use std::path::Path;

/// Loads the law of a table, with the defaults of its parameters.
fn loaded(table: *const abi::FwPlugin) -> LoadedLaw {
    // SAFETY: a static table of the wrapper.
    let plugin = unsafe { Plugin::from_table(table, Path::new("a test"), "", true) };
    LoadedLaw::with_defaults(plugin.unwrap())
}

/// Declares a law: its parameters, further entries of its plugin table, and the function that loads
/// it with the defaults of its parameters.
macro_rules! sample {
    (
        $(#[$doc:meta])*
        $name:ident: $kind:ident $law:ident { $($parameters:tt)* } { $($constants:tt)* }
    ) => {
        parameters! {
            $(#[$doc])*
            pub struct $law { $($parameters)* }
        }

        impl Law for $law {
            const NAME: &'static str = stringify!($name);
            const DOC: &'static str = "a law of the tests";
            const REFERENCE: &'static str = "a test";
            $($constants)*
        }

        $(#[$doc])*
        pub(crate) fn $name() -> LoadedLaw {
            plugin_table!($kind $law);
            loaded(TABLE.table())
        }
    };
}

sample! {
    /// Coulomb friction.
    coulomb: contact Coulomb {
        mu: "" = 0.5, 0.0, 10.0, "friction coefficient";
    } {}
}

impl ContactLaw for Coulomb {
    fn friction(&self, _: &Site, _: &[f64]) -> Friction {
        Friction {
            mu: self.mu,
            ..Friction::default()
        }
    }
}

sample! {
    /// A linear spring without friction.
    elastic: contact LinearSpring {
        k: "N/m" = 8.0, 0.0, 1e30, "stiffness";
    } {
        const FLAGS: u64 = abi::FLAG_COMPLIANT;
    }
}

impl ContactLaw for LinearSpring {
    fn friction(&self, _: &Site, _: &[f64]) -> Friction {
        Friction::default()
    }

    fn spring(&self, site: &Site, _: &[f64], _: f64) -> Spring {
        Spring::linear(site, self.k, 0.0, 0.0)
    }
}

sample! {
    /// Bond of stiffness k over the area against opening, sliding and rotation, in tension only.
    bond: cohesion LinearBond {
        k: "Pa/m" = 2.0, 0.0, 1e30, "stiffness";
    } {
        const FLAGS: u64 =
            abi::FLAG_OPENING | abi::FLAG_TENSION_ONLY | abi::FLAG_MOMENT | abi::FLAG_FORMS;
    }
}

impl CohesionLaw for LinearBond {
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

sample! {
    /// Shear cohesion without a bond and without attraction, with an internal variable that does
    /// not change.
    sticky: cohesion Sticky {
        strength: "Pa" = 3.0, 0.0, 1e30, "shear cohesion";
    } {
        const VARIABLES: &'static [Variable] =
            &[Variable::new(c"nothing", c"", c"kept, and not used").starting_at(7.0)];
    }
}

impl CohesionLaw for Sticky {
    fn traction(&self, _: &Site, _: &[f64]) -> Traction {
        Traction {
            shear_cohesion: self.strength,
            ..Traction::default()
        }
    }
}

sample! {
    /// Conductance of 1 W/K for each second of the contact's age, which the law counts in an
    /// internal variable.
    growing: transport Growing {
        per_time: "W/K/s" = 1.0, 0.0, 1e30, "conductance per time";
    } {
        const VARIABLES: &'static [Variable] = &[Variable::new(c"time", c"s", c"time so far")];
    }
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

sample! {
    /// Conductance of 3 W/K without internal variables.
    constant: transport Constant {
        conductance: "W/K" = 3.0, 0.0, 1e30, "conductance";
    } {}
}

impl TransportLaw for Constant {
    fn conductance(&self, _: &Site, _: &mut [f64]) -> Conductance {
        Conductance {
            thermal: self.conductance,
            electric: 0.0,
        }
    }
}

/// Creates an interface of friction and other laws.
pub(crate) fn interface(laws: impl IntoIterator<Item = LoadedLaw>) -> Interface {
    let laws = std::iter::once(coulomb()).chain(laws);
    Interface::new("test", laws).unwrap()
}

/// Creates a closed contact along y between two bodies, with the first interface and without lever
/// arms.
pub(crate) fn contact(bodies: [u32; 2]) -> Contact<Dim2> {
    let [candidate, antagonist] = bodies;
    let key = Key {
        candidate,
        antagonist,
        feature: 0,
    };
    let geometry = ContactGeometry {
        gap: 0.0,
        normal: Vector2::new(0.0, 1.0),
        arms: [Vector2::zeros(); 2],
        radius: 1.0,
    };
    Contact::new(key, bodies, 0, geometry, 0.0)
}
