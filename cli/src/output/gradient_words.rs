//! A gradient in words: the verdict, the derivatives beside those that others compute, the events.

use super::gradient::{Derivative, GradientDocument};
use super::named::Named;
use super::number::{scientific, short, significant};
use super::table::with_head;

/// Digits of derivatives and times.
const DIGITS: usize = 9;

impl GradientDocument {
    /// A verdict, the derivatives, the events.
    pub fn words(&self) -> String {
        let Some(value) = self.value else {
            let why = self.ending.why(&self.units).unwrap_or_default();
            return format!(
                " NO GRADIENT of {}: the simulation does not reach the end\n {why}\n",
                self.of
            );
        };
        let head = format!(
            " {} = {}   {}\n",
            self.of,
            self.units.value("objective", value, 12),
            self.verdict()
        );
        let warnings: String =
            self.warnings.iter().map(|warning| format!(" warning: {warning}\n")).collect();
        let parts = [head + &warnings, self.derivatives(), self.second(), self.events()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n")
    }

    fn verdict(&self) -> String {
        let agreement = scientific(self.agreement.unwrap_or(f64::NAN), 1);
        match (self.trusted, self.differentiable) {
            (true, _) => format!("differentiable; forward and adjoint agree to {agreement}"),
            (false, true) if self.has_kink => "NOT TRUSTED: it is on a kink".into(),
            (false, true) if self.agreement.is_none_or(f64::is_nan) => {
                "NOT TRUSTED: a derivative along the way has no value".into()
            }
            (false, true) if self.is_unresolved => {
                "NOT TRUSTED: shorter steps lead to another gradient".into()
            }
            (false, true) => format!("NOT TRUSTED: forward and adjoint differ by {agreement}"),
            (false, false) => {
                let why = self.cause.as_ref().map(|it| it.words(&self.units)).unwrap_or_default();
                format!("NOT DIFFERENTIABLE: {why}")
            }
        }
    }

    fn derivatives(&self) -> String {
        let mut columns = self.own();
        let mut add = |head: String, column: &Named<Derivative>| {
            columns.push((head, self.cells(column, &self.rows())))
        };
        if let Some(other) = &self.compare.smoothed {
            let sigma = other
                .sigma
                .map(|it| format!("sigma {}, ", self.units.width("", it)))
                .unwrap_or_default();
            add(format!("smoothed ({sigma}N {})", other.n), &other.gradient);
        }
        if let Some(other) = &self.compare.discretised {
            add(format!("discretised ({}, N {})", other.scheme, other.n), &other.gradient);
        }
        if !self.units.is_empty() {
            let unit = |(name, _): &(String, Derivative)| self.in_its_unit(name).1;
            columns.push(("unit".into(), self.gradient.0.iter().map(unit).collect()));
        }
        let labels =
            self.gradient.0.iter().zip(self.rows()).map(|((name, it), row)| it.label(name, row));
        let row = |(at, label): (usize, String)| {
            std::iter::once(label)
                .chain(columns.iter().map(|(_, cells)| cells[at].clone()))
                .collect()
        };
        let rows = labels.enumerate().map(row).collect();
        with_head(
            std::iter::once("by").chain(columns.iter().map(|(head, _)| head.as_str())).collect(),
            rows,
        )
    }

    /// Both ways to compute it where there is a derivative, else both sides.
    fn own(&self) -> Vec<(String, Vec<String>)> {
        let rows = self.rows();
        let Some(sides) = &self.one_sided else {
            let both = [("exact", &self.gradient), ("adjoint", &self.adjoint)];
            return both
                .map(|(head, column)| (head.to_string(), self.cells(column, &rows)))
                .to_vec();
        };
        let digits = |name: &str, side: Option<f64>| {
            side.map_or("-".to_string(), |value| {
                significant(value * self.in_its_unit(name).0, DIGITS)
            })
        };
        let below = sides.0.iter().map(|(name, sides)| digits(name, sides.below)).collect();
        let above = sides.0.iter().map(|(name, sides)| digits(name, sides.above)).collect();
        vec![("below".to_string(), below), ("above".to_string(), above)]
    }

    fn cells(&self, column: &Named<Derivative>, rows: &[usize]) -> Vec<String> {
        let cell = |((name, derivative), row): (&(String, Derivative), &usize)| {
            significant(derivative.at(*row) * self.in_its_unit(name).0, DIGITS)
        };
        column.0.iter().zip(rows).map(cell).collect()
    }

    /// How many of its unit one in SI of a derivative by a name is, and that unit. A start is in
    /// the unit of its state.
    fn in_its_unit(&self, name: &str) -> (f64, String) {
        self.units.of_derivative("objective", own(name))
    }

    /// Of each derivative the row that is shown: the one where it is largest.
    fn rows(&self) -> Vec<usize> {
        self.gradient.0.iter().map(|(_, derivative)| derivative.largest()).collect()
    }

    fn second(&self) -> String {
        let Some(second) = &self.second else { return String::new() };
        let names = second.0.iter().map(|(name, _)| name.as_str());
        let head = std::iter::once("by both").chain(names).collect();
        let row = |(name, values): &(String, Named<f64>)| {
            let value = |(by, value): &(String, f64)| {
                significant(
                    value * self.in_its_unit(name).0 / self.units.scaled(own(by), 1.0),
                    DIGITS,
                )
            };
            std::iter::once(name.clone()).chain(values.0.iter().map(value)).collect()
        };
        with_head(head, second.0.iter().map(row).collect())
    }

    fn events(&self) -> String {
        let row = |it: &super::ending::EventEntry| {
            vec![
                it.surface.clone(),
                it.what(),
                self.units.value("time", it.time, DIGITS),
                short(it.margin),
            ]
        };
        with_head(vec!["surface", "event", "at t", "margin"], self.events.iter().map(row).collect())
    }
}

/// The name whose unit counts: of `x(start)` that is `x`, of `u[3]` it is `u`.
pub fn own(name: &str) -> &str {
    let name = name.strip_suffix("(start)").unwrap_or(name);
    let row = name.strip_suffix(']').and_then(|it| it.rsplit_once('['));
    row.filter(|(_, row)| row.bytes().all(|it| it.is_ascii_digit())).map_or(name, |it| it.0)
}

impl Derivative {
    /// The row of a control with the largest derivative.
    fn largest(&self) -> usize {
        match self {
            Derivative::Number(_) => 0,
            Derivative::Rows(rows) => (0..rows.len())
                .max_by(|i, j| rows[*i].abs().total_cmp(&rows[*j].abs()))
                .unwrap_or(0),
        }
    }

    fn at(&self, row: usize) -> f64 {
        match self {
            Derivative::Number(value) => *value,
            Derivative::Rows(rows) => rows.get(row).copied().unwrap_or(f64::NAN),
        }
    }

    /// `mu`, or the place of the largest of many: `u (largest: row 3 of 200)`.
    fn label(&self, name: &str, row: usize) -> String {
        match self {
            Derivative::Number(_) => name.to_string(),
            Derivative::Rows(rows) => {
                format!("{name} (largest: row {} of {})", row + 1, rows.len())
            }
        }
    }
}
