//! Slurm: a job array, each task of which makes a chunk of the runs, and a job that collects when
//! all have ended.

use super::{Export, Written, absolute, quote, shell, shell_with};
use crate::Error;

pub(super) fn write(export: &Export<'_>) -> Result<Written, Error> {
    let logs = absolute(&export.logs()?);
    let tasks = export.tasks().len();
    let (count, chunk) = (export.plan.count(), export.chunk);
    let name = export.name();
    let lines: String = export
        .lines
        .iter()
        .map(|line| format!("#SBATCH {line}\n"))
        .collect();
    let expected = export.task_seconds.map_or(String::new(), |s| {
        format!("# A task takes about {}.\n", crate::duration::seconds(s))
    });
    // No other word of a call contains a control character.
    let words = export.call("point", &["\u{1}"])?;
    let point = shell_with(&words, "\u{1}", "\"$first-$last\"");
    // Slurm replaces patterns that begin with a percent sign.
    let logs = logs.replace('%', "%%");
    let array = format!(
        "#!/bin/sh\n\
         # {count} runs in {tasks} tasks of {chunk}; written by fretwork study export --to slurm.\n\
         {expected}\
         #SBATCH --job-name={name}\n\
         #SBATCH --array=1-{tasks}\n\
         #SBATCH --ntasks=1\n\
         #SBATCH --cpus-per-task={}\n\
         #SBATCH --output=\"{logs}/slurm-%a.log\"\n\
         {lines}\
         first=$(( (SLURM_ARRAY_TASK_ID - 1) * {chunk} + 1 ))\n\
         last=$(( SLURM_ARRAY_TASK_ID * {chunk} ))\n\
         if [ \"$last\" -gt {count} ]; then last={count}; fi\n\
         exec {point}\n",
        export.plan.launcher.threads
    );
    let collect = format!(
        "#!/bin/sh\n\
         #SBATCH --job-name={name}-collect\n\
         #SBATCH --ntasks=1\n\
         #SBATCH --output=\"{logs}/slurm-collect.log\"\n\
         {lines}\
         exec {}\n",
        shell(&export.call("collect", &[])?)
    );
    let array = export.put("array.sbatch", &array)?;
    let collect = export.put("collect.sbatch", &collect)?;
    let submit = format!(
        "#!/bin/sh\n\
         # Submits the runs, and their table for when all have ended, whether well or not.\n\
         set -e\n\
         job=$(sbatch --parsable {})\n\
         echo \"submitted $job\"\n\
         sbatch --dependency=\"afterany:$job\" {}\n",
        quote(&absolute(&array)),
        quote(&absolute(&collect))
    );
    let submit = export.put("submit.sh", &submit)?;
    Ok(Written {
        start: format!("sh {}", quote(&absolute(&submit))),
        files: vec![submit, array, collect],
    })
}
