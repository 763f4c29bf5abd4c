//! Bodies that controlled bodies squeeze, as debris between first bodies: where friction lets them go, another solution may hold them.

use super::form::{ContactForm, Problem};
use crate::geometry::space::{Space, VectorLike};
use std::collections::BTreeMap;

impl<S: Space> Problem<S> {
    /// Marks the bodies whose motion is imposed or controlled.
    pub fn set_controlled(&mut self, bodies: impl Iterator<Item = u32>) {
        self.controlled.clear();
        self.controlled.extend(bodies);
        self.controlled.sort_unstable();
    }

    pub(super) fn is_controlled(&self, body: &u32) -> bool {
        self.controlled.binary_search(body).is_ok()
    }

    /// Of these contacts those of a body, not a controlled one, which controlled bodies squeeze: by two loaded contacts whose friction cones lie in
    /// each other (Nguyen, "Constructing force-closure grasps", 1988, for two points with friction), so that no other load need press them.
    pub(super) fn of_pinched(
        &self,
        forms: &[ContactForm<S>],
        contacts: impl Iterator<Item = usize>,
    ) -> Vec<usize> {
        // The body that is held, and the direction in which it is pushed.
        let held = |form: &ContactForm<S>| {
            let [a, b] = form.bodies;
            match [&a, &b].map(|b| self.is_controlled(b)) {
                [false, true] => Some((a, form.normal)),
                [true, false] => Some((b, -form.normal)),
                _ => None,
            }
        };
        let mut found: Vec<(usize, u32)> = contacts
            .filter_map(|k| Some((k, held(&forms[k])?.0)))
            .collect();
        if found.is_empty() {
            return Vec::new();
        }
        let mut pushes: BTreeMap<u32, Vec<(S::Vector, f64)>> =
            found.iter().map(|(_, b)| (*b, Vec::new())).collect();
        for (form, place) in forms.iter().zip(&self.places) {
            if let Some((body, push)) = held(form)
                && let Some(pushes) = pushes.get_mut(&body)
                && self.normal(*place) > 0.0
            {
                pushes.push((push, form.friction.atan()));
            }
        }
        let opposed = |pushes: &[(S::Vector, f64)]| {
            pushes.iter().any(|(n, angle)| {
                let against = |(m, other): &(S::Vector, f64)| n.dot(m) < -(angle + other).cos();
                pushes.iter().any(against)
            })
        };
        found.retain(|(_, body)| opposed(&pushes[body]));
        found.into_iter().map(|(k, _)| k).collect()
    }
}
