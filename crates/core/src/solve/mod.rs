//! The contact problem in its standard local form, and its solvers.
//!
//! For every contact, with u = W p + u_free, p = p_sc + p_el:
//! * p_el = -(a + B u), the single-valued part (bond stiffness and damping over the step);
//! * 0 <= u_n + s_n perpendicular to p_sc,n + h c_n >= 0, with |p_sc,t| <= mu (p_sc,n + h c_n) + h
//!   c_t opposite to the sliding velocity u_t + s_t.
//!
//! Body velocities are updated in place, so that applying an impulse costs O(1) per contact.
pub mod accelerate;
mod body_anderson;
mod build;
pub mod choose;
pub mod chosen;
pub mod colour;
pub mod cone;
mod connected;
mod context;
pub mod error;
pub mod extrapolation;
pub mod form;
mod kinds;
mod loaded;
pub mod local;
mod measure;
mod momentum;
pub mod nlgs;
pub mod nodal;
mod pinched;
mod problem;
pub mod requirements;
mod rocking;
pub mod row;
mod rows;
pub mod schedule;
mod search;
pub mod side;
mod slide;
pub mod standard;
mod sticking;
mod systems;
mod traction;
mod velocities;

pub use choose::solve;
pub use chosen::{Attempt, SolvePath};
pub use context::AutoState;
pub use form::ContactForm;
pub use nlgs::{Report, SolverOptions};
pub use nodal::NodalSystem;
pub use problem::Problem;
pub use requirements::{Features, Operator, refusal};
pub use row::{MomentForm, MomentSolution};
pub use side::Side;
pub use sticking::begins_to_slide;
pub use velocities::Start;
