//! A half-space as a dynamical system.

use super::{Cells, HOLDER, HalfSpace, MAX_KEPT};
use crate::touching_surface::open_surface;
use fretwork_core::bodies::{
    Compliance, Contactor, ContactorShape, Dof, DynamicalSystem, Holder, Nodes, SystemSize,
    SystemStep, SystemWork, TouchingSurface,
};
use fretwork_core::geometry::shape::Surface;
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use std::sync::Arc;

impl<S: Space> DynamicalSystem<S> for HalfSpace<S> {
    fn name(&self) -> &str {
        &self.fixed.name
    }

    fn freedoms(&self) -> usize {
        self.velocity.len()
    }

    fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    fn set_contact_impulse(&mut self, impulse: &[f64]) {
        let h = self.step.map_or(1.0, |s| s.h);
        for (force, impulse) in self.force.iter_mut().zip(impulse) {
            *force = impulse / h;
        }
    }

    fn set_velocity(&mut self, velocity: &[f64]) {
        self.velocity.copy_from_slice(velocity);
    }

    fn passing(&self) -> S::Vector {
        let rolls = self.fixed.rolling.is_some();
        S::Vector::from_slice(&[if rolls {
            self.velocity[self.rolled()]
        } else {
            0.0
        }])
    }

    fn begin_step(&mut self, step: &SystemStep<S>) {
        self.stored = self.stored_energy();
        self.jump = 0.0;
        for (c, [start, _]) in self.imposed(step) {
            let before = self.velocity[c];
            if c != self.rolled() {
                self.jump += 0.5 * self.fixed.mass * (start.powi(2) - before.powi(2));
            }
            self.velocity[c] = start;
        }
        if self.fixed.rolling.is_some() {
            self.roll(step.h * self.velocity[self.rolled()]);
        }
        self.start[0].copy_from_slice(&self.displacement);
        self.start[1].copy_from_slice(&self.velocity);
        self.force.fill(0.0);
        // The kept compliance depends only on h and theta: phases that change which axes of the
        // holder respond to forces are refused.
        let of = |s: &SystemStep<S>| [s.h, s.theta];
        if self.held() <= MAX_KEPT && self.step.as_ref().map(of) != Some(of(step)) {
            let cells = (0..self.fixed.grid.len() as u32).collect();
            self.kept = Some(Arc::new(Compliance::new(cells)));
        }
        self.step = Some(*step);
    }

    fn advance(&mut self, time: f64) {
        for (q, v) in self.displacement.iter_mut().zip(&self.velocity) {
            *q += v * time;
        }
    }

    fn free_velocity(&self, step: &SystemStep<S>) -> Vec<f64> {
        let SystemStep { time, h, theta, .. } = *step;
        let held = self.held();
        let back = 1.0 / (h * theta);
        let mut end: Vec<f64> = self.displacement[..held]
            .iter()
            .map(|q| -q * back)
            .collect();
        for (axis, dof) in self.axes.iter().enumerate() {
            let mut v = self.start[1][held + axis];
            if self.yields(axis) {
                let force = dof.over(time, h).force(time + theta * h);
                v += h * (force / self.fixed.mass + step.gravity[axis]);
            }
            end.push(v);
        }
        end.push(0.0);
        for (c, [_, last]) in self.imposed(step) {
            end[c] = last;
        }
        end
    }

    fn solve(&self, impulse: &mut [f64]) {
        let Some(SystemStep { h, theta, .. }) = self.step else {
            return;
        };
        let held = self.held();
        let scale = 1.0 / (h * h * theta);
        let moved = self.displacements(&self.fixed.kernel, &impulse[..held]);
        for (v, u) in impulse.iter_mut().zip(&moved) {
            *v = u * scale;
        }
        for axis in 0..S::D {
            let v = &mut impulse[held + axis];
            *v = if self.yields(axis) {
                *v / self.fixed.mass
            } else {
                0.0
            };
        }
        impulse[held + S::D] = 0.0;
    }

    fn work(&self, step: &SystemStep<S>) -> SystemWork {
        let SystemStep { h, theta, .. } = *step;
        let (held, mass) = (self.held(), self.fixed.mass);
        let mut work = SystemWork {
            external: self.jump,
            ..SystemWork::default()
        };
        let done = |before: &[f64]| -> f64 {
            let pairs = self.displacement.iter().zip(before).take(held);
            let forces = self.force.iter().zip(pairs);
            forces
                .map(|(f, (after, before))| f * (after - before))
                .sum()
        };
        let by_contacts = done(&self.start[0]);
        let on_material = match self.fixed.rolling {
            Some(_) => done(&self.passing),
            None => by_contacts,
        };
        work.external += on_material - by_contacts;
        work.scheme += on_material - (self.stored_energy() - self.stored);
        for axis in 0..S::D {
            let c = held + axis;
            let average = self.average(c, theta);
            let change = self.velocity[c] - self.start[1][c];
            work.potential -= h * mass * step.gravity[axis] * average;
            work.scheme += (theta - 0.5) * mass * change * change;
            work.external += h * self.reaction(axis, step) * average;
        }
        // The drive that makes the surface roll balances the contact forces along x.
        let rolled = self.rolled();
        work.external -= h * self.force[rolled] * self.average(rolled, theta);
        work
    }

    fn kinetic_energy(&self) -> f64 {
        let held = self.held();
        let squared = self.velocity[held..held + S::D].iter().map(|v| v * v);
        0.5 * self.fixed.mass * squared.sum::<f64>()
    }

    fn stored_energy(&self) -> f64 {
        let pairs = self.force.iter().zip(&self.displacement).take(self.held());
        0.5 * pairs.map(|(f, u)| f * u).sum::<f64>()
    }

    fn mass(&self) -> f64 {
        self.fixed.mass
    }

    fn length(&self) -> f64 {
        let extent = self.fixed.grid.extent();
        0.5 * extent[..S::D - 1].iter().fold(0.0, |a: f64, b| a.max(*b))
    }

    fn is_driven(&self) -> bool {
        let moves = |dof: &Dof| dof.imposes() && !matches!(dof, Dof::Fixed);
        self.fixed.rolling.is_some() || self.axes.iter().any(moves)
    }

    fn drive_mut(&mut self, part: &str, axis: usize) -> Option<&mut Dof> {
        self.axes.get_mut(axis).filter(|_| part == HOLDER)
    }

    fn node_position(&self, node: u32) -> S::Vector {
        let cell = node as usize;
        let cells = self.fixed.grid.len();
        self.fixed.places[cell] + self.elastic(node) + self.entries(&self.displacement, cells)
    }

    fn node_velocity(&self, node: u32, velocity: &[f64]) -> S::Vector {
        let cells = self.fixed.grid.len();
        let mut out = self.entries(velocity, node as usize) + self.entries(velocity, cells);
        out[0] += velocity[self.rolled()];
        out
    }

    fn add_impulse(&self, node: u32, impulse: &S::Vector, generalised: &mut [f64]) {
        for axis in 0..S::D {
            generalised[node as usize * S::D + axis] += impulse[axis];
            generalised[self.held() + axis] += impulse[axis];
        }
        generalised[self.rolled()] += impulse[0];
    }

    fn contactors(&self) -> Vec<Contactor> {
        if self.fixed.touching == Cells::Surface {
            return vec![self.whole()];
        }
        let area = self.fixed.grid.area(S::D);
        let radius = match S::D {
            2 => 0.5 * area,
            _ => (area / std::f64::consts::PI).sqrt(),
        };
        let point = |cell: u32| Contactor {
            nodes: Nodes::one(cell),
            radius,
            shape: ContactorShape::Point,
            material: self.fixed.surface_material,
        };
        (0..self.fixed.grid.len() as u32).map(point).collect()
    }

    fn contact_nodes(&self, contactor: &Contactor, arm: &S::Vector) -> Nodes {
        if contactor.shape != ContactorShape::Surface {
            return contactor.nodes.clone();
        }
        let origin = self.origin();
        let cells = self.fixed.grid.len();
        let base = self.fixed.places[origin as usize];
        let middle = self.fixed.grid.middle(origin as usize);
        // Finds the unloaded position of the material that is now at the contact, by fixed-point
        // iteration: three rounds are enough since displacements are small compared with cells.
        let mut at = self.node_position(origin) + *arm - self.entries(&self.displacement, cells);
        for (axis, x) in middle.iter().enumerate().take(S::D - 1) {
            at[axis] += x - base[axis];
        }
        let repeats = self.fixed.repeats;
        let mut weights = self.fixed.grid.weights::<S>(&at, repeats);
        for _ in 0..3 {
            let moved = weights
                .iter()
                .fold(S::Vector::zero(), |sum, (cell, weight)| {
                    sum + self.elastic(*cell) * *weight
                });
            weights = self.fixed.grid.weights::<S>(&(at - moved), repeats);
        }
        Nodes::on_facet(&weights).unwrap_or_else(|| contactor.nodes.clone())
    }

    /// Returns the velocity of the cells, without that of the material that rolls through them.
    fn contactor_velocity(&self, contactor: &Contactor, velocity: &[f64]) -> (S::Vector, S::Spin) {
        let terms = contactor.nodes.terms();
        let elastic = terms.fold(S::Vector::zero(), |sum, (cell, weight)| {
            sum + self.entries(velocity, cell as usize) * weight
        });
        let held = self.entries(velocity, self.fixed.grid.len());
        (elastic + held, S::Spin::zero())
    }

    fn expected_velocity(&self, _contactor: &Contactor, free: &[f64]) -> (S::Vector, S::Spin) {
        (self.entries(free, self.fixed.grid.len()), S::Spin::zero())
    }

    fn cell_size(&self) -> Option<[f64; 2]> {
        Some(self.fixed.grid.size)
    }

    fn surface(&self, contactor: &Contactor) -> Option<Box<dyn Surface<S>>> {
        if contactor.shape != ContactorShape::Surface {
            return None;
        }
        let vertices = self.surface_vertices(contactor);
        open_surface(vertices, &self.fixed.facets, self.period()).ok()
    }

    fn surface_vertices(&self, _contactor: &Contactor) -> Vec<S::Vector> {
        let origin = self.node_position(self.origin());
        let cells = self.fixed.grid.len() as u32;
        let vertices = self.fixed.vertices.iter();
        vertices
            .map(|cell| {
                let mut at = self.node_position(cell % cells) - origin;
                at[0] += f64::from(cell / cells) * self.period().unwrap_or(0.0);
                at
            })
            .collect()
    }

    fn compliance(&self, nodes: &[u32]) -> Vec<S::Matrix> {
        let block = self.blocks();
        let pairs = nodes
            .iter()
            .flat_map(|a| nodes.iter().map(move |b| (*a, *b)));
        pairs.map(|(a, b)| block(a, b)).collect()
    }

    fn kept_compliance(&self, touched: &[u32]) -> Option<Arc<Compliance<S>>> {
        let kept = self.kept.as_ref()?;
        let block = self.blocks();
        for b in touched {
            kept.column_or(*b as usize, |axis| {
                let (block, mut unit) = (&block, S::Vector::zero());
                unit[axis] = 1.0;
                move |a| block(a as u32, *b).apply(&unit)
            });
        }
        Some(Arc::clone(kept))
    }

    fn kept_nodes(&self) -> Option<usize> {
        self.kept.as_ref().map(|kept| kept.nodes().len())
    }

    fn holders(&self) -> Vec<Holder> {
        let held = self.held();
        let one = |(part, axis, c): (&str, usize, usize)| {
            let (mut displacement, mut velocity, mut force) = (0.0, 0.0, 0.0);
            if let Some(step) = &self.step {
                velocity = self.average(c, step.theta);
                // The forces of the step result in the displacement at its end.
                displacement = self.start[0][c] + step.h * velocity;
                force = if c == self.rolled() {
                    -self.force[c]
                } else {
                    self.reaction(axis, step)
                };
            }
            Holder {
                part: part.to_owned(),
                axis,
                at: 1.0,
                displacement,
                velocity,
                force,
            }
        };
        let axes = (0..S::D).map(|axis| (HOLDER, axis, held + axis));
        let rolling = self.fixed.rolling.as_ref();
        let rolling = rolling.map(|_| ("rolling", 0, self.rolled()));
        axes.chain(rolling).map(one).collect()
    }

    fn load_at_border(&self) -> Option<f64> {
        let grid = &self.fixed.grid;
        if self.fixed.kernel.is_periodic() {
            return None;
        }
        let forces = (0..grid.len()).map(|c| (c, self.entries(&self.force, c).norm()));
        let on_border = |cell: usize| {
            let place = grid.place(cell);
            (0..S::D - 1).any(|k| place[k] == 0 || place[k] + 1 == grid.cells[k])
        };
        let (mut border, mut most) = (0.0, 0.0f64);
        for (cell, force) in forces {
            most = most.max(force);
            if on_border(cell) {
                border = force.max(border);
            }
        }
        Some(if most > 0.0 { border / most } else { 0.0 })
    }

    fn touching_surface(&self) -> Option<TouchingSurface<S::Vector>> {
        let cells = self.fixed.grid.len() as u32;
        // Facets to the image of the first cell of a periodic surface are left out.
        let mut facets = Vec::new();
        for facet in self.fixed.facets.iter().map(|f| &f[..S::D]) {
            let at = |k: &u32| self.fixed.vertices[*k as usize];
            if facet.iter().all(|k| at(k) < cells) {
                facets.extend(facet.iter().map(at));
            }
        }
        Some(TouchingSurface {
            nodes: (0..cells).collect(),
            points: self.fixed.places.clone(),
            facets,
            areas: vec![self.fixed.grid.area(S::D); cells as usize],
        })
    }

    fn size(&self) -> Option<SystemSize> {
        // A rolling surface has a second table: for material that arrives from behind.
        let tables = 1 + usize::from(self.fixed.rolling.is_some());
        let column = if self.held() <= MAX_KEPT {
            self.held() * S::D * size_of::<f64>()
        } else {
            0
        };
        Some(SystemSize {
            surface: self.fixed.grid.len() * column,
            point: column,
            unknowns: self.held(),
            matrix: tables * self.fixed.kernel.bytes(),
            operations: [0.0, self.fixed.kernel.operations()],
            ..SystemSize::default()
        })
    }

    fn has_equal_points(&self) -> bool {
        true
    }

    fn save(&self) -> Vec<u8> {
        let state = (&self.displacement, &self.velocity, &self.force);
        postcard::to_stdvec(&state).unwrap_or_default()
    }

    fn restore(&mut self, saved: &[u8]) -> bool {
        type State = (Vec<f64>, Vec<f64>, Vec<f64>);
        let read: Result<State, _> = postcard::from_bytes(saved);
        let total = self.velocity.len();
        match read {
            Ok((q, v, f))
                if [&q, &v, &f]
                    .iter()
                    .all(|x| x.len() == total && x.iter().all(|x| x.is_finite())) =>
            {
                self.start = [q.clone(), v.clone()];
                (self.displacement, self.velocity, self.force) = (q, v, f);
                true
            }
            _ => false,
        }
    }

    fn clone_box(&self) -> Box<dyn DynamicalSystem<S>> {
        Box::new(self.clone())
    }
}
