//! Output of steps as FCLIB problems.

use super::{Recorder, RunError, unwritable};
use crate::record::fclib;
use crate::record::quantity::unit::MOMENTUM;
use crate::step::StepReport;

impl Recorder<'_> {
    /// Writes the contact problem of a step as an FCLIB file.
    pub(super) fn write_problem(&mut self, step: u64, report: &StepReport) -> Result<(), RunError> {
        self.lock.check_still_owned()?;
        let problem = self.simulation.local_problem();
        let Some(mut problem) = problem.filter(|p| p.check().is_ok()) else {
            self.problems.1 += 1;
            return Ok(());
        };
        // The FCLIB error adds impulses to velocities. They are scaled to similar size, so that
        // neither hides the other.
        let scale = problem.normalise();
        let folder = self.out.join("fclib");
        let path = folder.join(format!("step-{step:08}.hdf5"));
        std::fs::create_dir_all(&folder).map_err(|e| unwritable(&folder, &e))?;
        let (case, s) = (&self.loaded.case, &self.simulation);
        let title = format!("{}, step {step}", case.name);
        let impulse = MOMENTUM.symbol(s.dimension());
        let description = format!(
            "u: velocities of the candidate of a contact relative to its antagonist, (n, t) or (n, t1, t2), n \
             towards the candidate (m/s); u_n includes the step's shift (an open gap over h, the correction \
             of a penetration, restitution). r: impulses of the step times {scale:e}, so that the mean \
             normal diagonal of W is 1; r/{scale:e} is in {impulse}. Step {:e} s, theta {}, time {:e} s; solved \
             in the run by {} to an error of {:.1e}, {}.",
            s.options().scheme.h,
            s.options().scheme.theta,
            s.time(),
            report.solver.used.name(),
            report.solver.error,
            s.options().solver.norm.formula(),
        );
        fclib::write_local(&path, &problem, &title, &description)
            .map_err(|e| unwritable(&path, &e))?;
        self.problems.0 += 1;
        Ok(())
    }
}
