//! Bodies squeezed by controlled bodies, such as debris between first bodies: where friction
//! releases them, another solution may hold them.

use super::form::ContactForm;

use super::kinds::of_kind;
use super::problem::Problem;
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

    /// Returns the contacts of controlled bodies with bodies that touch two or more controlled
    /// ones, in order; none where systems act. Rows are read instead of forms, since they take less
    /// memory.
    pub(super) fn of_several_controlled(&self) -> Vec<usize> {
        if self.controlled.is_empty() || !self.systems.is_empty() {
            return Vec::new();
        }
        let mut controlled = vec![false; self.masses.len()];
        for body in &self.controlled {
            controlled[*body as usize] = true;
        }
        let (mut counts, mut found) = (vec![0u32; self.masses.len()], Vec::new());
        self.each_body_pair(&mut |[a, b], contact| {
            if controlled[a as usize] != controlled[b as usize] {
                let body = if controlled[a as usize] { b } else { a } as usize;
                counts[body] += 1;
                found.push((contact as usize, body));
            }
        });
        found.retain(|(_, body)| counts[*body] > 1);
        let mut found: Vec<usize> = found.into_iter().map(|(contact, _)| contact).collect();
        found.sort_unstable();
        found
    }

    /// Passes the bodies of each contact between rigid bodies, and its index as pushed, to a
    /// function.
    fn each_body_pair(&self, give: &mut impl FnMut([u32; 2], u32)) {
        for (rows, pushed) in self.rows.iter().zip(&self.of_kind) {
            of_kind!(rows, rows => for (pair, k) in rows.pairs().iter().zip(rows.sequence()) {
                give(*pair, pushed[*k as usize]);
            });
        }
    }

    /// Returns those of the given contacts whose body, not a controlled one, is squeezed by
    /// controlled bodies: by two loaded contacts of `of_several` ([`Self::of_several_controlled`])
    /// whose friction cones contain the line between the contact points, so that no other load is
    /// needed (Nguyen, "Constructing force-closure grasps", Int. J. Robotics Research 7, 1988).
    pub(super) fn of_pinched(
        &self,
        forms: &[ContactForm<S>],
        of_several: &[usize],
        contacts: impl Iterator<Item = usize>,
    ) -> Vec<usize> {
        // Returns the held body, and the direction in which it is pushed.
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
        for (form, place) in of_several.iter().map(|k| (&forms[*k], &self.places[*k])) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    /// A grain between two bodies that push it along these directions (degrees), with this
    /// friction; both loads are 1 N s.
    fn between(directions: [f64; 2], friction: f64, controlled: &[u32]) -> Vec<usize> {
        let mut problem = Problem::of_unit_bodies(3);
        let form = |k: usize| {
            let (y, x) = directions[k].to_radians().sin_cos();
            // The grain is the candidate of the first contact, and the antagonist of the second.
            let (push, by) = (Vector2::new(x, y), k as u32 + 1);
            let (bodies, normal) = if k == 0 {
                ([0, by], push)
            } else {
                ([by, 0], -push)
            };
            ContactForm {
                bodies,
                normal,
                arms: [-normal, normal],
                friction,
                impulse: normal,
                ..ContactForm::default()
            }
        };
        let forms = [form(0), form(1)];
        problem.push_all(&forms, false);
        problem.set_controlled(controlled.iter().copied());
        let several = problem.of_several_controlled();
        problem.of_pinched(&forms, &several, 0..2)
    }

    /// Two opposite controlled bodies squeeze; two at an angle only where the friction angles are
    /// large enough. There is no squeezing where one of them is free, nor where all three bodies
    /// are controlled.
    #[test]
    fn what_is_in_both_friction_cones_is_squeezed() {
        assert_eq!(between([0.0, 180.0], 0.1, &[2, 1]), [0, 1]);
        assert_eq!(between([0.0, 90.0], 0.4, &[1, 2]), [0; 0]);
        assert_eq!(between([0.0, 90.0], 1.01, &[1, 2]), [0, 1]);
        assert_eq!(between([0.0, 150.0], 0.3, &[1, 2]), [0, 1]);
        assert_eq!(between([0.0, 150.0], 0.2, &[1, 2]), [0; 0]);
        assert_eq!(between([0.0, 180.0], 0.1, &[1]), [0; 0]);
        assert_eq!(between([0.0, 180.0], 0.1, &[0, 1, 2]), [0; 0]);
    }
}
