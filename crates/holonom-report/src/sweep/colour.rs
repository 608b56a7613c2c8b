//! Colours of a map: a scale whose brightness rises evenly, so that it also reads in grey and with any colour vision.

/// Corners of the scale "viridis" (Smith and van der Walt), red, green and blue.
const SCALE: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// The colour at a share (0 … 1) of the scale.
pub fn colour(share: f64) -> String {
    let along = share.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let k = (along as usize).min(SCALE.len() - 2);
    let mix = |c: usize| (SCALE[k][c] + (along - k as f64) * (SCALE[k + 1][c] - SCALE[k][c])).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_goes_from_dark_to_bright() {
        assert_eq!([colour(0.0), colour(0.5), colour(1.0), colour(7.0)], ["#440154", "#21908d", "#fde725", "#fde725"]);
        let bright = |share: f64| {
            let part = |at: usize| f64::from(u8::from_str_radix(&colour(share)[at..at + 2], 16).unwrap());
            0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
        };
        assert!((1..=40).all(|k| bright(f64::from(k) / 40.0) > bright(f64::from(k - 1) / 40.0)));
    }
}
