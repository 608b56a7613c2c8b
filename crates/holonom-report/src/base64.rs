//! Base64 (RFC 4648) of numbers as little-endian bytes: half the size of decimal text, and NaN and ±∞ survive, which JSON has
//! no spelling for.

use data_encoding::BASE64;

/// For `Float64Array`.
pub fn doubles(values: &[f64]) -> String {
    BASE64.encode(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())
}

/// For `Float32Array`: seven digits are enough for a place on the screen.
pub fn singles(values: &[f32]) -> String {
    BASE64.encode(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_little_endian() {
        assert_eq!(doubles(&[1.0]), "AAAAAAAA8D8=");
        assert_eq!(singles(&[1.0]), "AACAPw==");
        assert_eq!(doubles(&[f64::NEG_INFINITY]), "AAAAAAAA8P8=");
    }
}
