//! The kinds of contacts between rigid bodies, in the order of the iteration. A new kind is a file
//! in [`row`](super::row) and a line here.

use super::form::ContactForm;
use super::row::{Bonded, Full, Plain, Row, RowKind, Unbonded};
use super::rows::Rows;
use crate::geometry::space::Space;

/// Declares the kinds: their rows as an enumeration, and `of_kind!`, which does the same with the
/// rows of any kind.
macro_rules! kinds {
    ($dollar:tt $($(#[$doc:meta])* $name:ident: $law:ty,)+) => {
        /// The rows of one kind.
        #[derive(Debug)]
        pub(super) enum RowsOfKind<S: Space> {
            $($(#[$doc])* $name(Rows<S, $law>),)+
        }

        /// How many kinds there are.
        pub(super) const KINDS: usize = [$(stringify!($name)),+].len();

        impl<S: Space> RowsOfKind<S> {
            /// No rows, of each kind.
            pub fn none() -> [Self; KINDS] {
                [$(Self::$name(Rows::default())),+]
            }

            /// The kind of a contact: the first that it can be of.
            #[inline]
            pub fn kind(contact: &ContactForm<S>) -> usize {
                let serves = [$(<$law as RowKind<S>>::serves(contact)),+];
                serves.iter().position(|serves| *serves).unwrap_or(KINDS - 1)
            }

            /// Bytes of a row of each kind, with the indices of its bodies.
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
    /// Contacts with lever arms, or of bodies that are free along some axes only, without bond.
    Unbonded: Unbonded<S>,
    /// Contacts with lever arms and bonds.
    Bonded: Bonded<S>,
}
