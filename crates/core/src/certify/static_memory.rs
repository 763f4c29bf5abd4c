//! Checks that a law keeps no data in the static memory of its library, where concurrent calls
//! would overwrite it.

use super::CheckResult;
use super::plugin_interface::run_batch;
use super::rig::Rig;
use crate::laws::LawError;
use crate::laws::static_memory::{StaticMemory, UninspectableMemory};

const CHECK: &str = "static memory";

/// Number of contacts per batch in each round. Each round has a larger batch than all before, so
/// that a buffer that grows on demand and is kept changes its address.
const ROUNDS: [&[usize]; 3] = [&[1, 5, 17], &[3, 64], &[2, 300]];

/// Compares the static memory before and after calls with other numbers, parameters and batch
/// sizes. Data that change in the first round only are initialised at first use; data that change
/// in each round are kept between calls.
pub fn static_memory(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let plugin = rig.tested().plugin.clone();
    let memory = match StaticMemory::of(&plugin) {
        Ok(memory) => memory,
        Err(UninspectableMemory::BuiltIn) => {
            return Ok(CheckResult::skip(
                CHECK,
                "the law is part of the program: the library with the same code is tested instead",
            ));
        }
        Err(UninspectableMemory::TooLarge(bytes)) => {
            let text = "bytes of writable static memory in its library, too many to be compared: a law must not keep data between calls; \
                        make tables `const` and work arrays local to the call";
            return Ok(CheckResult::failed(CHECK, bytes as f64, text));
        }
        Err(UninspectableMemory::System) => {
            return Ok(CheckResult::skip(
                CHECK,
                "the static memory of a library cannot be located on this system",
            ));
        }
    };
    let mut seen = Vec::new();
    for (round, sizes) in ROUNDS.iter().enumerate() {
        calls(rig, round, sizes);
        seen.push(memory.read());
    }
    // Validates the parameters like a run.
    plugin.validate(&rig.tested().parameters)?;
    let [Some(first), Some(second), Some(third)] = seen.as_slice() else {
        return Ok(CheckResult::skip(
            CHECK,
            "the static memory of a library cannot be read on this system",
        ));
    };
    let changed = |a: &[u8], b: &[u8]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    let (once, again) = (changed(first, second), changed(second, third));
    let still = once == 0 || again == 0;
    let text = if still {
        "bytes of its library's static memory that change in every call"
    } else {
        "bytes of its library's static memory that change in every call: it keeps data between calls outside its columns, \
         and threads overwrite each other's data; make static arrays, counters and saved variables local to the call, or declare \
         persistent data as an internal variable"
    };
    let number = if still { 0 } else { once.max(again) };
    Ok(CheckResult::judged(CHECK, still, number as f64, text))
}

/// Makes every call of the law with the numbers, parameters and batch sizes of this round. Errors
/// are found by other checks.
fn calls(rig: &Rig, round: usize, sizes: &[usize]) {
    let seed = 1000 * (round as u64 + 1);
    let plugin = &rig.tested().plugin;
    let other = other_parameters(rig, round);
    for n in sizes {
        let walks: Vec<_> = (0..37)
            .map(|k| rig.random_walk(seed + k, 12, 0.3))
            .collect();
        let _ = run_batch(&mut rig.second_bench(), &walks, *n, 0);
        if plugin.validate(&other).is_ok() {
            let _ = run_batch(&mut rig.with_parameters(&other), &walks, *n, 1);
        }
    }
}

/// Returns the parameters, each changed by a few thousandths within its range.
fn other_parameters(rig: &Rig, round: usize) -> Vec<f64> {
    let share = 1e-3 * (round + 1) as f64;
    let tested = rig.tested();
    let fields = &tested.plugin.parameters;
    let values = tested.parameters.iter().zip(fields);
    values
        .map(|(value, field)| {
            let near = [value * (1.0 + share), value * (1.0 - share)];
            let inside = |x: &f64| (field.minimum..=field.maximum).contains(x);
            near.into_iter().find(inside).unwrap_or(*value)
        })
        .collect()
}
