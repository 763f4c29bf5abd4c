//! The laws of contact that come with Fretwork, by kind. Each is written with the crate
//! `fretwork_law`, as the law of any author is, and reaches the program through the same table of
//! functions.

#![forbid(unsafe_code)]

pub mod cohesion;
pub mod contact;
pub mod damage;
pub mod transport;
pub mod wear;

#[cfg(test)]
mod mixed_mode;
mod trapezoid;

use fretwork_law::abi::FwPlugin;

/// The gas constant (J/(mol K)).
const GAS: f64 = 8.314462618;

/// Declares `tables`, the plugin tables of the laws of one kind.
macro_rules! tables {
    ($kind:ident: $($law:path),* $(,)?) => {
        /// The plugin tables of these laws.
        pub fn tables() -> Vec<&'static fretwork_law::abi::FwPlugin> {
            vec![$({
                fretwork_law::plugin_table!($kind $law);
                &TABLE.0
            }),*]
        }
    };
}
use tables;

/// The plugin tables of all laws.
pub fn plugins() -> Vec<&'static FwPlugin> {
    [
        contact::tables(),
        cohesion::tables(),
        damage::tables(),
        wear::tables(),
        transport::tables(),
    ]
    .concat()
}
