//! Physical units: how many SI units one of them is.
//!
//! Values are held in SI, so a unit is one factor: `1 [km/h] = 1000/3600 [m/s]`. Names are looked up as they
//! stand first and then with a prefix taken off, so `min` is a minute and `mm` a millimetre.

use fdcc_grammar::ast::Unit;
use fdcc_grammar::{Code, Diagnostic, Fix};
use std::f64::consts::PI;

/// Name, SI value, and whether prefixes such as `k` may stand in front.
const UNITS: &[(&str, f64, bool)] = &[
    // base units (the gram, so that prefixes work)
    ("m", 1.0, true),
    ("g", 1e-3, true),
    ("s", 1.0, true),
    ("A", 1.0, true),
    ("K", 1.0, true),
    ("mol", 1.0, true),
    ("cd", 1.0, true),
    // derived units
    ("rad", 1.0, true),
    ("sr", 1.0, false),
    ("Hz", 1.0, true),
    ("N", 1.0, true),
    ("Pa", 1.0, true),
    ("J", 1.0, true),
    ("W", 1.0, true),
    ("C", 1.0, true),
    ("V", 1.0, true),
    ("F", 1.0, true),
    ("ohm", 1.0, true),
    ("Ω", 1.0, true),
    ("S", 1.0, true),
    ("Wb", 1.0, true),
    ("T", 1.0, true),
    ("H", 1.0, true),
    // time
    ("min", 60.0, false),
    ("h", 3600.0, false),
    ("d", 86400.0, false),
    // angle and turning
    ("deg", PI / 180.0, false),
    ("rev", 2.0 * PI, false),
    ("rpm", 2.0 * PI / 60.0, false),
    // others in daily use
    ("t", 1e3, false),
    ("L", 1e-3, true),
    ("l", 1e-3, true),
    ("bar", 1e5, true),
    ("atm", 101_325.0, false),
    ("eV", 1.602_176_634e-19, true),
    ("percent", 1e-2, false),
    ("ft", 0.3048, false),
    ("inch", 0.0254, false),
    ("mi", 1609.344, false),
    ("mph", 0.447_04, false),
    ("lb", 0.453_592_37, false),
];

/// Prefixes; `da` stands before `d` so that it is not taken for a deci-`a...`.
const PREFIXES: &[(&str, f64)] = &[
    ("da", 1e1),
    ("T", 1e12),
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("h", 1e2),
    ("d", 1e-1),
    ("c", 1e-2),
    ("m", 1e-3),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
];

/// The SI value of one unit name, such as `km`.
pub fn named(name: &str) -> Option<f64> {
    let whole = UNITS.iter().find(|row| row.0 == name).map(|row| row.1);
    whole.or_else(|| PREFIXES.iter().find_map(|&(prefix, factor)| prefixed(name, prefix, factor)))
}

fn prefixed(name: &str, prefix: &str, factor: f64) -> Option<f64> {
    let rest = name.strip_prefix(prefix)?;
    UNITS.iter().find(|row| row.2 && row.0 == rest).map(|row| factor * row.1)
}

/// The SI value of a unit such as `[kg m/s^2]`; unknown names are reported and count as 1.
pub fn scale(unit: &Unit, diagnostics: &mut Vec<Diagnostic>) -> f64 {
    let mut product = 1.0;
    for (name, power) in &unit.factors {
        match named(&name.name) {
            Some(value) => product *= value.powi(*power),
            None => diagnostics.push(unknown(&name.name, name.span)),
        }
    }
    product
}

fn unknown(name: &str, span: fdcc_grammar::Span) -> Diagnostic {
    let found =
        Diagnostic::new(Code::UnknownUnit, format!("`{name}` is no unit known here"), span, "not a unit");
    match crate::resolve::closest(name, UNITS.iter().map(|row| row.0)) {
        Some(near) => found
            .help(format!("did you mean `[{near}]`?"))
            .fix(Fix::likely(format!("change `{name}` to `{near}`")).replace(span, near)),
        None => found
            .help("SI units with their prefixes, and `deg rpm min h bar L ft mi mph lb`; write `[kg m/s^2]`"),
    }
}

/// Reads a number with or without a unit, as on a command line: `0.2`, `200[g]`, `36 [km/h]`.
pub fn parse_quantity(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.split_once('[') {
        Some((number, rest)) => (number, Some(rest.trim_end().strip_suffix(']').ok_or("a `]` is missing")?)),
        None => (text, None),
    };
    let value: f64 = number.trim().parse().map_err(|_| format!("`{}` is not a number", number.trim()))?;
    if !value.is_finite() {
        return Err(format!("`{}` is not a finite number", number.trim()));
    }
    Ok(value * unit.map_or(Ok(1.0), product)?)
}

/// A unit's text without its brackets: names with powers, separated by blanks, `*` or `/`.
fn product(text: &str) -> Result<f64, String> {
    let mut value = 1.0;
    for (position, part) in text.split('/').enumerate() {
        // As in the language, `/` turns over the next factor only.
        for (place, word) in part.split([' ', '*']).filter(|word| !word.is_empty()).enumerate() {
            let factor = power(word)?;
            value *= if position > 0 && place == 0 { factor.recip() } else { factor };
        }
    }
    Ok(value)
}

fn power(word: &str) -> Result<f64, String> {
    let (name, exponent) = word.split_once('^').unwrap_or((word, "1"));
    let exponent: i32 = exponent.parse().map_err(|_| format!("`{exponent}` is not a whole power"))?;
    let base = if name == "1" { Some(1.0) } else { named(name) };
    base.map(|base| base.powi(exponent)).ok_or_else(|| format!("`{name}` is no unit known here"))
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let value = parse_quantity(text).expect(text);
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
