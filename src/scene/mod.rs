//! Cases and materials: read, checked, and made into a scene that steps.
pub mod source;
