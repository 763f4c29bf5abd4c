//! Calls of plugin functions across the C ABI.

use super::error::LawError;
use super::function::Call;
use super::library::Plugin;
use super::{outside, watch};
use fretwork_abi as abi;
use std::ffi::c_char;

/// Size of the buffer for a plugin's message (bytes).
const MESSAGE: usize = 512;

impl Plugin {
    /// Returns the fracture energy (J/m^2) that the law declares for an opening at an angle (rad)
    /// from the normal.
    pub fn fracture_energy(&self, values: &[f64], angle: f64) -> Option<f64> {
        if values.len() != self.parameters.len() {
            return None;
        }
        let function = self.table.fracture_energy?;
        // SAFETY: only the type changes, to one that may unwind.
        let function = unsafe {
            std::mem::transmute::<
                unsafe extern "C" fn(*const f64, f64) -> f64,
                unsafe extern "C-unwind" fn(*const f64, f64) -> f64,
            >(function)
        };
        let disturbed = &self.disturbed.calling;
        let energy = outside::call(self.label, watch::FRACTURE_ENERGY, disturbed, || {
            // SAFETY: the signature is that of the ABI, with one value per parameter.
            unsafe { function(values.as_ptr(), angle) }
        });
        Some(energy).filter(|e| e.is_finite())
    }

    /// Checks parameter values against the schema and with the law's own `validate` function.
    ///
    /// # Errors
    /// Returns a sentence that names the parameter.
    pub fn validate(&self, values: &[f64]) -> Result<(), LawError> {
        let refuse = |reason: String| LawError::Parameters {
            kind: self.kind,
            name: self.name.clone(),
            reason,
        };
        if values.len() != self.parameters.len() {
            return Err(refuse(format!(
                "it takes {} values, got {}",
                self.parameters.len(),
                values.len()
            )));
        }
        for (field, value) in self.parameters.iter().zip(values) {
            if !value.is_finite() || !(field.minimum..=field.maximum).contains(value) {
                return Err(refuse(format!(
                    "`{}` must lie in [{}, {}] {}, got {value}",
                    field.name, field.minimum, field.maximum, field.unit
                )));
            }
        }
        let Some(validate) = self.table.validate else {
            return Ok(());
        };
        let mut buffer = [0 as c_char; MESSAGE];
        let mut message = message_over(&mut buffer);
        // SAFETY: only the type changes, to one that may unwind.
        let validate = unsafe {
            std::mem::transmute::<
                unsafe extern "C" fn(*const f64, *mut abi::FwMessage) -> i32,
                unsafe extern "C-unwind" fn(*const f64, *mut abi::FwMessage) -> i32,
            >(validate)
        };
        let disturbed = &self.disturbed.calling;
        let status = outside::call(self.label, watch::VALIDATE, disturbed, || {
            // SAFETY: the ABI's signature; the buffers outlive the call.
            unsafe { validate(values.as_ptr(), &mut message) }
        });
        if status == abi::STATUS_OK {
            Ok(())
        } else {
            Err(refuse(said(&buffer, status)))
        }
    }

    /// Calls one of the law's functions; does nothing where the law does not define it.
    ///
    /// # Errors
    /// The law's message, with the index of the contact in the batch.
    ///
    /// # Safety
    /// The columns of the batch that the law uses must hold `batch.n` values and outlive the call.
    pub unsafe fn call(&self, call: Call, batch: &abi::FwBatch) -> Result<(), LawError> {
        let function = match call {
            Call::Initialise => self.table.initialise,
            Call::Prepare => self.table.prepare,
            Call::Commit => self.table.commit,
            Call::Energy => self.table.energy,
        };
        let Some(function) = function else {
            return Ok(());
        };
        let mut buffer = [0 as c_char; MESSAGE];
        let mut message = message_over(&mut buffer);
        // SAFETY: only the type changes, to one that may unwind.
        let function = unsafe {
            std::mem::transmute::<
                unsafe extern "C" fn(*const abi::FwBatch, *mut abi::FwMessage) -> i32,
                unsafe extern "C-unwind" fn(*const abi::FwBatch, *mut abi::FwMessage) -> i32,
            >(function)
        };
        let disturbed = &self.disturbed.calling;
        let status = outside::call(self.label, call as usize, disturbed, || {
            // SAFETY: the caller keeps the contract of this function.
            unsafe { function(batch, &mut message) }
        });
        if status == abi::STATUS_OK {
            return Ok(());
        }
        Err(LawError::Failed {
            kind: self.kind,
            name: self.name.clone(),
            call,
            contact: usize::try_from(message.contact).ok(),
            reason: said(&buffer, status),
            smaller_step: status == abi::STATUS_REDUCE_STEP,
        })
    }
}

fn message_over(buffer: &mut [c_char; MESSAGE]) -> abi::FwMessage {
    abi::FwMessage {
        size: size_of::<abi::FwMessage>(),
        text: buffer.as_mut_ptr(),
        capacity: MESSAGE,
        contact: -1,
    }
}

/// Returns the plugin's message, or the meaning of its status code if it left none.
fn said(buffer: &[c_char; MESSAGE], status: i32) -> String {
    let bytes: Vec<u8> = buffer
        .iter()
        .take(MESSAGE - 1)
        .map(|c| *c as u8)
        .take_while(|b| *b != 0)
        .collect();
    let text = String::from_utf8_lossy(&bytes).trim().to_owned();
    if !text.is_empty() {
        return text;
    }
    match status {
        abi::STATUS_ERROR => "it reported an error without a message".into(),
        abi::STATUS_BAD_PARAMETER => "it refused a parameter without a message".into(),
        abi::STATUS_REDUCE_STEP => "it asks for a smaller time step: take a smaller time.step, or let the run choose one (`accuracy: 0.05`, down to \
             accuracy.finest_step)"
            .into(),
        abi::STATUS_PANIC => "it panicked".into(),
        other => format!("it returned the unknown status {other}"),
    }
}
