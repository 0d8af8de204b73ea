//! **The table** of units: how many SI units one of them is, and what it measures.
//!
//! Values are held in SI, so a unit is one factor: `1 [km/h] = 1000/3600 [m/s]`. Names are looked
//! up as they stand first and then with a prefix taken off, so `min` is a minute and `mm` a
//! millimetre.

use super::Dimension;
use super::ratio::Ratio;
use fdcc_grammar::ast::Unit;
use fdcc_grammar::{Code, Diagnostic, Fix, Span};
use std::f64::consts::PI;

/// Powers of kg, m, s, A, K, mol, cd.
type Powers = [i8; 7];

const NONE: Powers = [0; 7];
const LENGTH: Powers = [0, 1, 0, 0, 0, 0, 0];
const MASS: Powers = [1, 0, 0, 0, 0, 0, 0];
const TIME: Powers = [0, 0, 1, 0, 0, 0, 0];
const CURRENT: Powers = [0, 0, 0, 1, 0, 0, 0];
const CHARGE: Powers = [0, 0, 1, 1, 0, 0, 0];
const RATE: Powers = [0, 0, -1, 0, 0, 0, 0];
const SPEED: Powers = [0, 1, -1, 0, 0, 0, 0];
const VOLUME: Powers = [0, 3, 0, 0, 0, 0, 0];
const PRESSURE: Powers = [1, -1, -2, 0, 0, 0, 0];
const ENERGY: Powers = [1, 2, -2, 0, 0, 0, 0];
const RESISTANCE: Powers = [1, 2, -3, -2, 0, 0, 0];

/// Name, SI value, whether prefixes such as `k` may stand in front, and what it measures.
const UNITS: &[(&str, f64, bool, Powers)] = &[
    // base units (the gram, so that prefixes work)
    ("m", 1.0, true, LENGTH),
    ("g", 1e-3, true, MASS),
    ("s", 1.0, true, TIME),
    ("A", 1.0, true, CURRENT),
    ("K", 1.0, true, [0, 0, 0, 0, 1, 0, 0]),
    ("mol", 1.0, true, [0, 0, 0, 0, 0, 1, 0]),
    ("cd", 1.0, true, [0, 0, 0, 0, 0, 0, 1]),
    // derived units
    ("rad", 1.0, true, NONE),
    ("sr", 1.0, false, NONE),
    ("Hz", 1.0, true, RATE),
    ("N", 1.0, true, [1, 1, -2, 0, 0, 0, 0]),
    ("Pa", 1.0, true, PRESSURE),
    ("J", 1.0, true, ENERGY),
    ("W", 1.0, true, [1, 2, -3, 0, 0, 0, 0]),
    ("C", 1.0, true, CHARGE),
    ("V", 1.0, true, [1, 2, -3, -1, 0, 0, 0]),
    ("F", 1.0, true, [-1, -2, 4, 2, 0, 0, 0]),
    ("ohm", 1.0, true, RESISTANCE),
    ("Ω", 1.0, true, RESISTANCE),
    ("S", 1.0, true, [-1, -2, 3, 2, 0, 0, 0]),
    ("Wb", 1.0, true, [1, 2, -2, -1, 0, 0, 0]),
    ("T", 1.0, true, [1, 0, -2, -1, 0, 0, 0]),
    ("H", 1.0, true, [1, 2, -2, -2, 0, 0, 0]),
    // time
    ("min", 60.0, false, TIME),
    ("h", 3600.0, false, TIME),
    ("d", 86400.0, false, TIME),
    // angle and turning
    ("deg", PI / 180.0, false, NONE),
    ("rev", 2.0 * PI, false, NONE),
    ("rpm", 2.0 * PI / 60.0, false, RATE),
    // others in daily use
    ("t", 1e3, false, MASS),
    ("L", 1e-3, true, VOLUME),
    ("l", 1e-3, true, VOLUME),
    ("bar", 1e5, true, PRESSURE),
    ("atm", 101_325.0, false, PRESSURE),
    ("eV", 1.602_176_634e-19, true, ENERGY),
    ("Wh", 3600.0, true, ENERGY),
    ("Ah", 3600.0, true, CHARGE),
    ("°", PI / 180.0, false, NONE),
    ("%", 1e-2, false, NONE),
    ("percent", 1e-2, false, NONE),
    ("ft", 0.3048, false, LENGTH),
    ("inch", 0.0254, false, LENGTH),
    ("mi", 1609.344, false, LENGTH),
    ("mph", 0.447_04, false, SPEED),
    ("lb", 0.453_592_37, false, MASS),
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

/// The names of all units, without prefixes but for the kilogram.
pub(crate) fn names() -> Vec<&'static str> {
    std::iter::once("kg").chain(UNITS.iter().map(|row| row.0)).collect()
}

/// One unit name, such as `km`: its SI value and what it measures.
pub(crate) fn named(name: &str) -> Option<(f64, Dimension)> {
    let whole = UNITS.iter().find(|row| row.0 == name).map(|row| (row.1, row.3));
    let found = whole
        .or_else(|| PREFIXES.iter().find_map(|&(prefix, factor)| prefixed(name, prefix, factor)));
    found.map(|(value, powers)| (value, Dimension::of_base(powers)))
}

fn prefixed(name: &str, prefix: &str, factor: f64) -> Option<(f64, Powers)> {
    let rest = name.strip_prefix(prefix)?;
    UNITS.iter().find(|row| row.2 && row.0 == rest).map(|row| (factor * row.1, row.3))
}

/// The SI value of a unit such as `[kg m/s^2]`; unknown names are reported and count as 1.
pub(crate) fn scale(unit: &Unit, diagnostics: &mut Vec<Diagnostic>) -> f64 {
    let mut product = 1.0;
    for (name, power) in &unit.factors {
        match named(&name.name) {
            Some((value, _)) => product *= value.powi(*power),
            None => diagnostics.push(unknown(&name.name, name.span)),
        }
    }
    product
}

/// What a unit measures, if all of its names are known.
pub(crate) fn dimension(unit: &Unit) -> Option<Dimension> {
    unit.factors.iter().try_fold(Dimension::none(), |product, (name, power)| {
        product.combined(&named(&name.name)?.1, Ratio::whole(*power))
    })
}

/// The derived unit that measures just this, such as `N`.
pub(crate) fn derived(dimension: &Dimension) -> Option<&'static str> {
    const NAMES: [&str; 12] = ["N", "Pa", "J", "W", "C", "V", "F", "ohm", "S", "Wb", "T", "H"];
    NAMES.into_iter().find(|name| named(name).is_some_and(|it| it.1 == *dimension))
}

fn unknown(name: &str, span: Span) -> Diagnostic {
    let found = Diagnostic::new(
        Code::UnknownUnit,
        format!("`{name}` is no unit known here"),
        span,
        "not a unit",
    );
    if matches!(name, "degC" | "°C" | "degF" | "°F" | "celsius" | "Celsius") {
        return found.help(
            "a unit here is a factor, and this scale begins elsewhere: write temperatures in \
             kelvin, `293.15 [K]` for 20 °C",
        );
    }
    match crate::syntax::closest(name, UNITS.iter().map(|row| row.0)) {
        Some(near) => found
            .help(format!("did you mean `[{near}]`?"))
            .fix(Fix::likely(format!("change `{name}` to `{near}`")).replace(span, near)),
        None => found.help(
            "SI units with their prefixes, and `deg rpm min h bar L ft mi mph lb`; write \
                   `[kg m/s^2]`",
        ),
    }
}
