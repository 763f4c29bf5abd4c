//! Reasons why a half-space cannot be created.

use crate::material::ElasticityError;

/// Reason why a half-space cannot be created.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HalfSpaceError {
    /// The material is invalid.
    #[error(transparent)]
    Material(#[from] ElasticityError),
    /// A cell without a size.
    #[error("the size of a cell must be positive and finite, got {0} m")]
    Size(f64),
    /// There are too few cells.
    #[error(
        "a half-space needs at least two cells along {0}, got {1}: make cells smaller or the extent larger"
    )]
    Few(&'static str, usize),
    /// There are too many cells.
    #[error("a half-space can have {0} cells at most: make them larger or the extent smaller")]
    Many(usize),
    /// The compliance at this depth is not positive.
    #[error(
        "`depth`, where the displacement is zero, must be positive and in two dimensions not less than the extent of the cells, {1} m; got {0} m"
    )]
    Depth(f64, f64),
    /// The mass is negative or not finite.
    #[error("the mass of a half-space must not be negative, got {0} kg")]
    Mass(f64),
    /// The half-space moves under forces, but has no mass.
    #[error(
        "a half-space that is free or under a force along {0} needs a `mass`, that of what moves with it"
    )]
    NoMass(&'static str),
    /// A drive imposes motion at one time and a force at another.
    #[error(
        "the drive along {0} imposes motion at one time and a force at another; a half-space cannot change that within a run"
    )]
    Changes(&'static str),
    /// A profile without a height.
    #[error("the height of the profile at x = {0} m is not finite")]
    Height(f64),
    /// The cells form no surface.
    #[error("its cells form no surface: {0}")]
    NoSurface(String),
}
