//! What the estimates of a fit are worth, as data and in words.

use super::document::Document;
use super::named::Named;
use super::number::short;
use super::plural;
use serde::Serialize;

/// Standard errors, correlations and what the data leave open.
#[derive(Clone, Debug, Serialize)]
pub struct Estimates {
    pub unknowns: Named<Estimate>,
    /// One row and one column for each unknown.
    pub correlations: Named<Named<f64>>,
    /// Unknowns of which only some combination is determined.
    pub undetermined: Vec<Vec<String>>,
    pub rows: usize,
    /// `null` where there are no more rows than what they determine.
    pub degrees_of_freedom: Option<usize>,
    pub sum_of_squares: f64,
    /// The root of the mean square of the residuals, over the degrees of freedom.
    pub deviation: Option<f64>,
    /// `given`, or `residuals` if standard errors go by the size of what remains.
    pub noise: &'static str,
    /// Whether the second-order conditions hold; else nothing has a standard error.
    pub is_minimum: bool,
}

/// One unknown, in SI.
#[derive(Clone, Debug, Serialize)]
pub struct Estimate {
    pub value: f64,
    pub standard_error: Option<f64>,
    pub is_at_bound: bool,
}

/// What remains of a signal.
#[derive(Clone, Debug, Serialize)]
pub struct Residual {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase: Option<String>,
    pub signal: String,
    pub data: String,
    pub time: Vec<f64>,
    /// Signal less measurement, times the root of the weight; `null` where nothing was measured.
    pub values: Vec<Option<f64>>,
    /// What was measured; absent where the sum is not of differences to a signal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Vec<Option<f64>>>,
    /// The difference of which a residual is 1: the standard deviation, where the model gives one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deviation: Option<Vec<Option<f64>>>,
}

impl Document {
    /// The same with what the estimates of a fit are worth.
    pub fn with_estimates(mut self, found: Option<fdcc::Estimates>) -> Self {
        let Some(found) = found else { return self };
        self.residuals = found.residuals.iter().map(Residual::new).collect();
        self.estimates = Some(Estimates::new(&found));
        self
    }
}

impl Estimates {
    fn new(found: &fdcc::Estimates) -> Self {
        let names: Vec<&String> = found.unknowns.iter().map(|it| &it.name).collect();
        let named =
            |row: &Vec<f64>| names.iter().copied().cloned().zip(row.iter().copied()).collect();
        let rows = found.correlations.iter().map(named);
        let unknowns = found.unknowns.iter().map(|it| {
            let (standard_error, is_at_bound) = (it.standard_error, it.is_at_bound);
            (it.name.clone(), Estimate { value: it.value, standard_error, is_at_bound })
        });
        Estimates {
            unknowns: unknowns.collect(),
            correlations: names.iter().copied().cloned().zip(rows).collect(),
            undetermined: found.undetermined.clone(),
            rows: found.rows,
            degrees_of_freedom: found.degrees_of_freedom,
            sum_of_squares: found.sum_of_squares,
            deviation: found.deviation,
            noise: if found.is_known { "given" } else { "residuals" },
            is_minimum: found.is_minimum,
        }
    }

    /// Lines for people.
    pub fn lines(&self, document: &Document) -> Vec<String> {
        let mut lines = vec![self.fit(document)];
        lines.extend(self.unknowns.0.iter().map(|(name, it)| self.estimate(name, it, document)));
        lines.extend(self.undetermined.iter().map(|names| undetermined(names)));
        if !self.is_minimum {
            let why = "a strict minimum could not be shown, so nothing has a standard error";
            lines.push(format!(" est   {why}"));
        }
        lines
    }

    fn fit(&self, document: &Document) -> String {
        let signals = document.residuals.iter().take(MOST_SIGNALS).map(Residual::words);
        let mut words = format!(" fit   {}", signals.collect::<Vec<_>>().join(", "));
        if let more @ 1.. = document.residuals.len().saturating_sub(MOST_SIGNALS) {
            words += &format!(" and {more} more");
        }
        match (self.degrees_of_freedom, self.deviation) {
            (Some(count), Some(deviation)) => {
                let residuals = match self.noise {
                    "given" => format!("{} standard deviations", short(deviation)),
                    _ => in_unit_of_squares(deviation, document),
                };
                let degrees = plural(count, "degree");
                words += &format!("   {degrees} of freedom   residuals {residuals}");
            }
            _ if self.is_minimum => words += "   no more measurements than what they determine",
            _ => {}
        }
        words
    }

    fn estimate(&self, name: &str, it: &Estimate, document: &Document) -> String {
        let value = document.units.value(name, it.value, 6);
        let error = match it.standard_error {
            Some(error) => format!(" +- {}", document.units.value(name, error, 3)),
            None if it.is_at_bound => ", at its bound".into(),
            None => ", without a standard error".into(),
        };
        let others = self.correlations.get(name).into_iter().flat_map(|row| &row.0);
        let others = others.filter(|(other, _)| other != name);
        let strongest = others.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let correlated = strongest.filter(|it| it.1.abs() > TOLD);
        let correlated =
            correlated.map(|(other, by)| format!("   correlation with {other} {}", short(*by)));
        format!(" est   {name} {value}{error}{}", correlated.unwrap_or_default())
    }
}

/// Of more signals, as in experiments of many files, only these are named.
const MOST_SIGNALS: usize = 6;

/// A smaller correlation is not told.
const TOLD: f64 = 0.5;

fn undetermined(names: &[String]) -> String {
    let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match &all[..] {
        [name] => format!(" est   the data do not determine {name}: any value fits as well"),
        all => format!(
            " est   the data do not determine {} by themselves: other values of them together fit \
             as well",
            all.join(", ")
        ),
    }
}

impl Residual {
    fn new(it: &fdcc::Residual) -> Self {
        let of_measured = |all: &[f64]| -> Vec<Option<f64>> {
            let all = all.iter().zip(&it.is_measured);
            all.map(|(value, is_measured)| is_measured.then_some(*value)).collect()
        };
        Residual {
            phase: it.phase.clone(),
            signal: it.name.clone(),
            data: it.data.clone(),
            time: it.time.clone(),
            values: of_measured(&it.values),
            measured: it.measured.as_deref().map(of_measured),
            deviation: it.deviations.as_deref().map(of_measured),
        }
    }

    /// `x of obs, 21 rows`
    fn words(&self) -> String {
        let rows = self.values.iter().flatten().count();
        let phase = self.phase.iter().map(|phase| format!("{phase}.")).collect::<String>();
        format!("{phase}{} in {} of {}", self.signal, plural(rows, "row"), self.data)
    }
}

/// The root of a mean of squares: in `mm` where the objective, their sum, is in `mm^2`.
fn in_unit_of_squares(deviation: f64, document: &Document) -> String {
    let squares = document.units.unit("objective");
    match squares.trim().strip_suffix("^2") {
        Some(unit) if !unit.contains([' ', '/', '*']) => {
            let scale = document.units.scaled("objective", 1.0).sqrt();
            format!("{} {unit}", short(deviation * scale))
        }
        _ => short(deviation),
    }
}
