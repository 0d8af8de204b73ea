//! A number with or without a unit, as on a command line: `0.2`, `200[g]`, `36 [km/h]`.

use super::Dimension;
use super::ratio::Ratio;
use super::table::named;

/// A value in SI.
#[derive(Clone, PartialEq, Debug)]
pub struct Quantity {
    /// In SI.
    pub value: f64,
    /// What its unit measures, if it has one.
    pub dimension: Option<Dimension>,
}

/// Reads a number and its unit.
pub fn parse_quantity(text: &str) -> Result<Quantity, String> {
    let (number, unit) = match text.split_once('[') {
        Some((number, rest)) => {
            (number, Some(rest.trim_end().strip_suffix(']').ok_or("a `]` is missing")?))
        }
        None => (text, None),
    };
    let value: f64 =
        number.trim().parse().map_err(|_| format!("`{}` is not a number", number.trim()))?;
    if !value.is_finite() {
        return Err(format!("`{}` is not a finite number", number.trim()));
    }
    match unit.map(product).transpose()? {
        Some((scale, dimension)) => {
            Ok(Quantity { value: value * scale, dimension: Some(dimension) })
        }
        None => Ok(Quantity { value, dimension: None }),
    }
}

/// A unit's text without its brackets: names with powers, separated by blanks, `*` or `/`.
fn product(text: &str) -> Result<(f64, Dimension), String> {
    let mut all = (1.0, Dimension::none());
    for (position, part) in text.split('/').enumerate() {
        // As in the language, `/` turns over the next factor only.
        for (place, word) in part.split([' ', '*']).filter(|word| !word.is_empty()).enumerate() {
            let sign = if position > 0 && place == 0 { -1 } else { 1 };
            let (scale, dimension, exponent) = power(word)?;
            all.0 *= scale.powi(sign * exponent);
            let combined = all.1.combined(&dimension, Ratio::whole(sign * exponent));
            all.1 = combined.ok_or_else(|| format!("`{word}` is too large a power"))?;
        }
    }
    Ok(all)
}

fn power(word: &str) -> Result<(f64, Dimension, i32), String> {
    let (name, exponent) = word.split_once('^').unwrap_or((word, "1"));
    let exponent: i32 =
        exponent.parse().map_err(|_| format!("`{exponent}` is not a whole power"))?;
    let base = if name == "1" { Some((1.0, Dimension::none())) } else { named(name) };
    let (scale, dimension) = base.ok_or_else(|| format!("`{name}` is no unit known here"))?;
    Ok((scale, dimension, exponent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn quantities_come_out_in_si() {
        let cases = [
            ("0.2", 0.2),
            ("200[g]", 0.2),
            ("36 [km/h]", 10.0),
            ("180 [deg]", PI),
            ("60 [rpm]", 2.0 * PI),
            ("2 [min]", 120.0),
            ("3 [mm]", 0.003),
            ("1 [kg m/s^2]", 1.0),
            ("-1.5e2 [m s^-1]", -150.0),
            ("1 [1/min]", 1.0 / 60.0),
        ];
        for (text, expected) in cases {
            let value = parse_quantity(text).expect(text).value;
            assert!((value - expected).abs() <= 1e-15 * expected.abs(), "{text}: {value}");
        }
    }

    #[test]
    fn bad_quantities_are_refused() {
        for text in ["", "x", "1 [", "1 [furlong]", "1 [m^x]", "inf"] {
            assert!(parse_quantity(text).is_err(), "{text}");
        }
    }
}
