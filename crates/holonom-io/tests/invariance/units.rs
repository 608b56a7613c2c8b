//! Units of the tables of keys, as powers of metre, kilogram and second.

/// Powers of m, kg and s.
pub type Powers = [i32; 3];

const SYMBOLS: &[(&str, Powers)] = &[
    ("kg", [0, 1, 0]),
    ("m", [1, 0, 0]),
    ("s", [0, 0, 1]),
    ("N", [1, 1, -2]),
    ("J", [2, 1, -2]),
    ("rad", [0, 0, 0]),
    ("°", [0, 0, 0]),
    ("any", [0, 0, 0]),
    ("1", [0, 0, 0]),
    ("", [0, 0, 0]),
];

/// The powers in a unit such as `N·m·s/rad` or `kg/m³`.
///
/// # Panics
/// When the unit has a symbol that is not known: it wants a line above.
pub fn powers(unit: &str) -> Powers {
    let mut powers = [0; 3];
    let (mut sign, mut rest) = (1, unit);
    loop {
        let end = rest.find(['·', '/']).unwrap_or(rest.len());
        let raised = ["²", "³", "⁴"].iter().zip(2..).find_map(|(mark, exponent)| Some((rest[..end].strip_suffix(mark)?, exponent)));
        let (symbol, exponent) = raised.unwrap_or((&rest[..end], 1));
        let known = SYMBOLS.iter().find(|(name, _)| *name == symbol).unwrap_or_else(|| panic!("`{symbol}` of {unit} is not known"));
        (0..3).for_each(|k| powers[k] += sign * exponent * known.1[k]);
        let Some(separator) = rest[end..].chars().next() else { return powers };
        sign = if separator == '/' { -1 } else { 1 };
        rest = &rest[end + separator.len_utf8()..];
    }
}

/// The unit of a key that has one for angles and one for displacements, `rad or m`, or one for both.
pub fn of_coordinate(unit: &str, is_angle: bool) -> &str {
    match unit.split_once(" or ") {
        Some((angle, displacement)) => {
            if is_angle {
                angle
            } else {
                displacement
            }
        }
        None => unit,
    }
}

#[test]
fn units_have_their_powers() {
    assert_eq!(powers("N·m·s/rad"), [2, 1, -1]);
    assert_eq!(powers("kg/m³"), [-3, 1, 0]);
    assert_eq!(powers("m⁴"), [4, 0, 0]);
    assert_eq!(powers("1/s"), [0, 0, -1]);
    assert_eq!(powers(of_coordinate("s/rad or s/m", false)), [-1, 0, 1]);
}
