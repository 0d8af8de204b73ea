//! Numbers for people: short, in fixed width where they stand in columns.

/// Six significant digits, without needless zeros or exponents.
pub fn short(value: f64) -> String {
    significant(value, 6)
}

/// At most as many significant digits as asked for.
pub fn significant(value: f64, digits: usize) -> String {
    trim(aligned(value, digits))
}

/// As many significant digits as asked for, zeros included: for columns.
pub fn aligned(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=digits as i32 + 2).contains(&exponent) {
        return format!("{value:.*e}", digits - 1);
    }
    format!("{value:.*}", (digits as i32 - 1 - exponent).max(0) as usize)
}

/// Removes zeros that say nothing.
fn trim(text: String) -> String {
    let (number, exponent) = match text.split_once('e') {
        Some((number, exponent)) => (number.to_string(), format!("e{exponent}")),
        None => (text, String::new()),
    };
    let number = if number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        &number
    };
    format!("{number}{exponent}")
}

/// `1.2e-03`, always as wide as the number of decimals asks; a dash where there is no number.
pub fn scientific(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "-".to_owned();
    }
    let text = format!("{value:.decimals$e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => match exponent.strip_prefix('-') {
            Some(digits) => format!("{mantissa}e-{digits:0>2}"),
            None => format!("{mantissa}e+{exponent:0>2}"),
        },
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_their_value() {
        assert_eq!(short(5.552177), "5.55218");
        assert_eq!(short(0.1), "0.1");
        assert_eq!(short(1000.0), "1000");
        assert_eq!(short(1e-9), "1e-9");
        assert_eq!(short(f64::NAN), "NaN");
        assert_eq!(aligned(5.5, 4), "5.500");
        assert_eq!(scientific(0.00123, 2), "1.23e-03");
        assert_eq!(scientific(12.0, 1), "1.2e+01");
        assert_eq!(scientific(f64::NAN, 1), "-");
    }
}
