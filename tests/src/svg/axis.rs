//! One axis of a figure: its range, and round numbers along it.

/// A quantity that is drawn.
#[derive(Clone)]
pub struct Axis {
    pub(super) label: String,
    is_logarithmic: bool,
    range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis that has room for all curves.
    pub fn new(label: &str) -> Self {
        Axis { label: label.into(), is_logarithmic: false, range: None }
    }

    /// With decades.
    pub fn logarithmic(self) -> Self {
        Axis { is_logarithmic: true, ..self }
    }

    /// From a number to a number, whatever the curves do.
    pub fn between(self, low: f64, high: f64) -> Self {
        Axis { range: Some([low, high]), ..self }
    }

    /// With room for these values, if no range was asked for.
    pub(super) fn fitted(&self, values: impl Iterator<Item = f64>) -> Axis {
        let drawn = values.map(|value| self.drawn(value)).filter(|value| value.is_finite());
        let (low, high) =
            drawn.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        assert!(low <= high || self.range.is_some(), "an axis needs a finite value");
        let margin = if high > low { 0.03 * (high - low) } else { 0.5 };
        let undrawn = |value: f64| if self.is_logarithmic { 10_f64.powf(value) } else { value };
        let range = self.range.unwrap_or([undrawn(low - margin), undrawn(high + margin)]);
        Axis { range: Some(range), ..self.clone() }
    }

    /// What is proportional to the place of a value; none for what a logarithmic axis cannot show.
    fn drawn(&self, value: f64) -> f64 {
        match self.is_logarithmic {
            true if value > 0.0 => value.log10(),
            true => f64::NAN,
            false => value,
        }
    }

    /// First and last place.
    fn ends(&self) -> [f64; 2] {
        self.range.expect("the axis of a figure is fitted").map(|value| self.drawn(value))
    }

    /// Where a value is: 0 at the beginning, 1 at the end.
    pub(super) fn part(&self, value: f64) -> f64 {
        let [low, high] = self.ends();
        (self.drawn(value) - low) / (high - low)
    }

    /// Round numbers with their labels.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.ends();
        let step = round_step(high - low, self.is_logarithmic);
        let (first, last) =
            ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        let digits = (-step.log10().floor()).max(0.0) as usize;
        let tick = |at: i64| match self.is_logarithmic {
            true => (10_f64.powf(at as f64 * step), format!("1e{}", at as f64 * step)),
            false => (at as f64 * step, format!("{:.digits$}", at as f64 * step)),
        };
        (first..=last).map(tick).collect()
    }
}

/// 1, 2 or 5 times a power of ten, so that there are about six of them; whole decades.
fn round_step(width: f64, is_logarithmic: bool) -> f64 {
    let power = 10_f64.powf((width / 6.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * power)
        .into_iter()
        .find(|step| width / step <= 7.0);
    let step = step.unwrap_or(10.0 * power);
    if is_logarithmic { step.max(1.0) } else { step }
}

#[cfg(test)]
mod tests {
    use super::Axis;

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        let labels = |axis: Axis| axis.ticks().into_iter().map(|tick| tick.1).collect::<Vec<_>>();
        assert_eq!(
            labels(Axis::new("x").between(-1.1, -0.9)),
            ["-1.10", "-1.05", "-1.00", "-0.95", "-0.90"]
        );
        assert_eq!(
            labels(Axis::new("h").logarithmic().between(8e-4, 0.2)),
            ["1e-3", "1e-2", "1e-1"]
        );
    }

    #[test]
    fn a_logarithmic_axis_has_no_place_for_zero() {
        let axis = Axis::new("error").logarithmic().between(0.01, 1.0);
        assert!((axis.part(0.1) - 0.5).abs() < 1e-15 && axis.part(0.0).is_nan());
    }
}
