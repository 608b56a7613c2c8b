//! Base64 (RFC 4648) of numbers as little-endian bytes: half the size of decimal text, and NaN and ±∞ survive, which JSON has
//! no spelling for.

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// For `Float64Array`.
pub fn doubles(values: &[f64]) -> String {
    encode(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())
}

/// For `Float32Array`: seven digits are enough for a place on the screen.
pub fn singles(values: &[f32]) -> String {
    encode(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())
}

fn encode(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let bits = chunk.iter().enumerate().fold(0u32, |bits, (i, &byte)| bits | u32::from(byte) << (16 - 8 * i));
        for place in 0..4 {
            // n bytes make n + 1 characters; the rest is padding.
            text.push(if place <= chunk.len() { ALPHABET[(bits >> (18 - 6 * place)) as usize & 63] as char } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_vectors_of_rfc_4648() {
        for (plain, coded) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg=="), ("foobar", "Zm9vYmFy")] {
            assert_eq!(encode(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn numbers_are_little_endian() {
        assert_eq!(doubles(&[1.0]), "AAAAAAAA8D8=");
        assert_eq!(singles(&[1.0]), "AACAPw==");
        assert_eq!(doubles(&[f64::NEG_INFINITY]), "AAAAAAAA8P8=");
    }
}
