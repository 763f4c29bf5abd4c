//! Contacts on which an interface's bonds form, estimated from the scene before it runs.

use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::step::Simulation;

/// Statistics of the contacts on which bonds form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondSites {
    /// Number of contacts of the interface at the start; 0 if there are none yet and the estimate is made
    /// from the grains.
    pub contacts: usize,
    /// Median of their reduced radii r1 r2/(r1 + r2) (m).
    pub radius: f64,
    /// Largest ratio of contact area to effective mass along the normal (m^2/kg; in 2D per metre of depth). A
    /// bond stiffness of k (Pa/m) times this ratio is the square of the bond's angular frequency.
    pub normal: f64,
    /// The same ratio along the tangents, where the grains' rotation is included.
    pub shear: f64,
}

impl BondSites {
    /// Bond sites of the interface with index `law`; `None` if it governs no contact and no grain.
    pub fn of<S: Space>(s: &Simulation<S>, law: usize) -> Option<Self> {
        Self::of_contacts(s, law).or_else(|| Self::of_grains(s, law))
    }

    fn of_contacts<S: Space>(s: &Simulation<S>, law: usize) -> Option<Self> {
        let mut out = Self {
            contacts: 0,
            radius: 0.0,
            normal: 0.0,
            shear: 0.0,
        };
        let mut radii = Vec::new();
        let contacts = s.state.network.contacts.iter();
        for c in contacts.filter(|c| usize::from(c.law) == law && c.radius > 0.0) {
            let area = s.laws[law].area.area(S::D, c.radius);
            let (mut normal, mut shear) = (0.0, 0.0);
            for (body, arm) in c.bodies.iter().zip(&c.arms) {
                let body = *body as usize;
                let inverse = &s.state.bodies.inverse_mass[body];
                let along: f64 = (0..S::D).map(|k| inverse[k] * c.normal[k].powi(2)).sum();
                let most = (0..S::D).map(|k| inverse[k]).fold(0.0, f64::max);
                normal += along;
                shear += most + arm.norm().powi(2) * s.state.bodies.inverse_inertia[body];
            }
            radii.push(c.radius);
            out.normal = out.normal.max(area * normal);
            out.shear = out.shear.max(area * shear);
        }
        out.contacts = radii.len();
        out.radius = median(&mut radii)?;
        Some(out)
    }

    /// Estimate from two equal grains of the materials that the interface governs: the median radius, and the
    /// lightest grain for the frequencies.
    fn of_grains<S: Space>(s: &Simulation<S>, law: usize) -> Option<Self> {
        let governs = |material: u16| {
            let others = s.shapes.balls.iter().map(|b| b.material);
            let others = others.chain(s.shapes.pieces.iter().map(|p| p.material));
            let mut others = others.chain(s.shapes.surfaces.iter().map(|x| x.material));
            others.any(|m| s.table.get(material, m).map(usize::from) == Some(law))
        };
        let balls = s
            .shapes
            .balls
            .iter()
            .map(|b| (b.body, b.radius, b.material));
        let pieces = s.shapes.pieces.iter();
        let pieces = pieces.map(|p| (p.body, p.size, p.material));
        let mut known: Vec<(u16, bool)> = Vec::new();
        let (mut radii, mut normal, mut shear) = (Vec::new(), 0.0f64, 0.0f64);
        for (body, radius, material) in balls.chain(pieces) {
            let yes = match known.iter().find(|k| k.0 == material) {
                Some(k) => k.1,
                None => {
                    let yes = governs(material);
                    known.push((material, yes));
                    yes
                }
            };
            if !yes {
                continue;
            }
            let area = s.laws[law].area.area(S::D, 0.5 * radius);
            let body = body as usize;
            let inverse = &s.state.bodies.inverse_mass[body];
            let inverse = (0..S::D).map(|k| inverse[k]).fold(0.0, f64::max);
            let turning = radius * radius * s.state.bodies.inverse_inertia[body];
            radii.push(0.5 * radius);
            normal = normal.max(2.0 * area * inverse);
            shear = shear.max(2.0 * area * (inverse + turning));
        }
        Some(Self {
            contacts: 0,
            radius: median(&mut radii)?,
            normal,
            shear,
        })
    }
}

fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
