//! The kinds of contacts between rigid bodies, in the order of the iteration. A new kind needs a
//! file in [`row`](super::row) and a line here.

use super::form::ContactForm;
use super::row::{Bonded, Full, Plain, Row, RowKind, Unbonded};
use super::rows::Rows;
use crate::geometry::space::Space;

/// Declares the kinds: an enumeration of their rows, and the macro `of_kind!`, which applies the
/// same code to the rows of any kind.
macro_rules! kinds {
    ($dollar:tt $($(#[$doc:meta])* $name:ident: $law:ty,)+) => {
        /// The rows of one kind.
        #[derive(Debug)]
        pub(super) enum RowsOfKind<S: Space> {
            $($(#[$doc])* $name(Rows<S, $law>),)+
        }

        /// Number of kinds.
        pub(super) const KINDS: usize = [$(stringify!($name)),+].len();

        impl<S: Space> RowsOfKind<S> {
            /// Returns empty rows of each kind.
            pub fn none() -> [Self; KINDS] {
                [$(Self::$name(Rows::default())),+]
            }

            /// Returns the kind of a contact: the first kind that supports it.
            #[inline]
            pub fn kind(contact: &ContactForm<S>) -> usize {
                let serves = [$(<$law as RowKind<S>>::serves(contact)),+];
                serves.iter().position(|serves| *serves).unwrap_or(KINDS - 1)
            }

            /// Bytes of a row of each kind, including the indices of its bodies.
            pub const BYTES: [usize; KINDS] =
                [$(size_of::<Row<S, $law>>() + size_of::<[u32; 2]>()),+];
        }

        macro_rules! of_kind {
            ($dollar of_kind:expr, $dollar rows:ident => $dollar do:expr) => {
                match $dollar of_kind {
                    $($crate::solve::kinds::RowsOfKind::$name($dollar rows) => $dollar do),+
                }
            };
        }
        pub(super) use of_kind;
    };
}

kinds! { $
    /// Contacts of two balls (or a ball and an immovable body), without bond: the fast path.
    Plain: Plain,
    /// Contacts of two balls with springs, bonds, cohesion or tangential restitution.
    Full: Full<S>,
    /// Contacts without bond, with lever arms or between bodies that are free along some axes only.
    Unbonded: Unbonded<S>,
    /// Contacts with lever arms and bonds.
    Bonded: Bonded<S>,
}
