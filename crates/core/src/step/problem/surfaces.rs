//! Surfaces that move relative to their bodies, such as those of bodies that expand.
//!
//! At a contact the surfaces have the relative velocity u_surface = u_bodies + w. Laws receive
//! u_surface. The solver, which uses velocities of bodies, gets w with the other shifts: s becomes
//! s + w, and the impulse of a bond -(a + B u) becomes -(a + B w + B u). Contacts then do the work
//! sum p.u_bodies on bodies and receive sum p.u_surface; the difference is the work of the motion
//! of the surfaces.

use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::ContactForm;

/// Motion of surfaces relative to their bodies in a step.
#[derive(Debug)]
pub(crate) struct Surfaces<S: Space> {
    /// Velocities of both surfaces of each contact relative to their bodies (m/s), in the order of
    /// the network; empty where none moves.
    pub velocities: Vec<[S::Vector; 2]>,
    /// Work of this motion in the step (J; J/m in 2D).
    pub work: f64,
}

impl<S: Space> Default for Surfaces<S> {
    fn default() -> Self {
        let (velocities, work) = (Vec::new(), 0.0);
        Self { velocities, work }
    }
}

impl<S: Space> Surfaces<S> {
    /// Adds w to the relative velocities of all contacts.
    pub fn add_to(&self, relative: &mut [S::Vector]) {
        for (u, [i, j]) in relative.iter_mut().zip(&self.velocities) {
            *u += *i - *j;
        }
    }

    /// Returns the forms of the contacts in the velocities of the bodies; `None` where these equal
    /// those of the surfaces.
    pub fn forms_of_bodies(
        &self,
        forms: &[ContactForm<S>],
        contacts: &[Contact<S>],
    ) -> Option<Vec<ContactForm<S>>> {
        if self.velocities.is_empty() {
            return None;
        }
        let mut forms = forms.to_vec();
        for ((form, contact), [i, j]) in forms.iter_mut().zip(contacts).zip(&self.velocities) {
            let w = *i - *j;
            let (n, t) = (form.normal.dot(&w), S::tangential(&form.normal, &w));
            form.shift_n += n;
            if let Some(bond) = &mut form.elastic {
                bond.a_n += bond.b_n * n;
            }
            // A velocity along the normal has a tangential part by rounding.
            if !contact.central || t.norm() > 1e-12 * w.norm() {
                form.shift_t += t;
                if let Some(bond) = &mut form.elastic {
                    bond.a_t += t * bond.b_t;
                }
            }
        }
        Some(forms)
    }
}
