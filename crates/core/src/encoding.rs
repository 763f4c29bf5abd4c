//! Binary serialization of state, and bytes as text. Floats keep their bits, including infinities
//! and NaN.
//!
//! The format is postcard: fields in order without names, so a state can only be read by the
//! program version that wrote it. The enclosing frame records that version.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Error in serializing or deserializing a state.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct EncodingError(String);

impl EncodingError {
    /// Error for bytes of another case: `what` names, in the plural, what differs.
    pub fn other(what: &str) -> Self {
        Self(format!("it holds other {what} than the case has"))
    }
}

/// Formats bytes in hexadecimal.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

/// Serializes a state.
///
/// # Errors
/// The type cannot be serialized by postcard.
pub fn encode<T: Serialize + ?Sized>(state: &T) -> Result<Vec<u8>, EncodingError> {
    postcard::to_stdvec(state).map_err(|e| EncodingError(e.to_string()))
}

/// Deserializes a state, which must use all bytes.
///
/// # Errors
/// The bytes do not represent a `T`.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, EncodingError> {
    let (state, rest) = decode_first(bytes)?;
    if rest.is_empty() {
        return Ok(state);
    }
    Err(EncodingError(format!("{} bytes too many", rest.len())))
}

/// Deserializes a state at the start of the bytes; returns it with the bytes after it.
///
/// # Errors
/// The bytes do not begin with a `T`.
pub fn decode_first<T: DeserializeOwned>(bytes: &[u8]) -> Result<(T, &[u8]), EncodingError> {
    postcard::take_from_bytes(bytes).map_err(|e| EncodingError(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_bits() {
        let odd = f64::from_bits(0x7ff8_0000_dead_beef);
        let numbers = [0.1, -0.0, f64::MIN_POSITIVE / 3.0, f64::INFINITY, odd];
        let back: [f64; 5] = decode(&encode(&numbers).unwrap()).unwrap();
        assert_eq!(back.map(f64::to_bits), numbers.map(f64::to_bits));
    }

    #[test]
    fn what_is_cut_or_too_long_is_refused() {
        let bytes = encode(&vec![1.0f64, 2.0]).unwrap();
        assert!(decode::<Vec<f64>>(&bytes[..bytes.len() - 1]).is_err());
        assert!(decode::<Vec<f64>>(&[&bytes[..], &[0]].concat()).is_err());
        // The declared length is not trusted for the allocation.
        assert!(decode::<Vec<f64>>(&[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f]).is_err());
    }
}
