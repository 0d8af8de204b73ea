//! Ranges of numbers, from one to another in equal steps.

use super::tuning::{DECIMALS, MOST, ROUNDING};

/// The values of `FIRST:STEP:LAST`, as in `0.1:0.2:0.7` or `100:50:300[g]`; a text of another form
/// is the only value.
///
/// # Errors
///
/// Why there are no values, in words.
pub fn values(text: &str) -> Result<Vec<String>, String> {
    let (numbers, unit) = text.split_at(text.find('[').unwrap_or(text.len()));
    let parts: Vec<&str> = numbers.split(':').map(str::trim).collect();
    let [first, step, last] = parts[..] else {
        return match parts.len() {
            1 => Ok(vec![text.to_owned()]),
            _ => Err(format!("`{text}` is not of the form FIRST:STEP:LAST")),
        };
    };
    let [a, by, b] = [number(first)?, number(step)?, number(last)?];
    let steps = ((b - a) / by + ROUNDING).floor();
    if !(0.0..MOST).contains(&steps) {
        return Err(format!("from {first} in steps of {step} nobody gets to {last}"));
    }
    let decimals = decimals(first).max(decimals(step)) as usize;
    let value = |k: usize| format!("{}{unit}", rounded(a + by * k as f64, decimals));
    Ok((0..=steps as usize).map(value).collect())
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|it: &f64| it.is_finite());
    number.ok_or_else(|| format!("`{text}` is no number; a range is FIRST:STEP:LAST"))
}

/// How many digits a number has behind the point: 3 of `0.125`, 4 of `2.5e-3`.
fn decimals(text: &str) -> i32 {
    let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let behind = digits.split_once('.').map_or(0, |(_, behind)| behind.len() as i32);
    (behind - exponent.parse().unwrap_or(0)).clamp(0, DECIMALS)
}

/// As somebody would have written it: 0.3, not 0.30000000000000004.
fn rounded(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::values;

    #[test]
    fn a_range_has_the_numbers_that_one_would_write() {
        let of = |text: &str| values(text).expect(text).join(" ");
        assert_eq!(of("0.1:0.1:0.5"), "0.1 0.2 0.3 0.4 0.5");
        assert_eq!(of("1:-0.25:0.3"), "1 0.75 0.5");
        assert_eq!(of("100:50:200[g]"), "100[g] 150[g] 200[g]");
        assert_eq!(of("0:1e-3:2e-3"), "0 0.001 0.002");
        assert_eq!(of("2:1:2"), "2");
        assert_eq!(of("radau3"), "radau3");
    }

    #[test]
    fn a_range_that_does_not_get_to_its_end_is_refused() {
        for (text, words) in [
            ("0:1", "FIRST:STEP:LAST"),
            ("0:1:2:3", "FIRST:STEP:LAST"),
            ("0:0:1", "nobody gets to 1"),
            ("0:-1:1", "nobody gets to 1"),
            ("0:1e-300:1", "nobody gets to 1"),
            ("a:1:2", "`a` is no number"),
        ] {
            let why = values(text).expect_err(text);
            assert!(why.contains(words), "{text}: {why}");
        }
    }
}
