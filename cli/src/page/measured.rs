//! What was measured of a signal: points over its curve, and what remains between both.

use super::figures::{CONTROLS, Curve, Figure, Kind, RESIDUALS, STATES, is_drawn_late};
use super::json::Json;
use super::units::{Unit, of_value};

/// The group of measured signals that no other plot shows, such as a formula.
pub const MEASURED: &str = "Measured data";

/// A measured signal of a document.
struct Signal<'j> {
    of: usize,
    /// Its place in the list `residuals`.
    at: usize,
    document: &'j Json,
    json: &'j Json,
}

/// Adds the points of all documents to the plots of what was measured, and a plot of each residual
/// behind those of states, controls and reports.
pub fn add(documents: &[Json], figures: &mut Vec<Figure>) {
    let mut own: Vec<Figure> = Vec::new();
    for (of, document) in documents.iter().enumerate() {
        for (at, json) in document.at("residuals").list().iter().enumerate() {
            let signal = Signal { of, at, document, json };
            if !json.at("measured").is_absent() {
                signal.add_points(figures, &mut own);
            }
            let name = signal.name();
            let residual = figure(&mut own, RESIDUALS, name, || signal.unit_of_residual());
            residual.curves.push(signal.curve(Kind::Stems, "values"));
        }
    }
    // One group after the other: a page has a heading for each.
    own.sort_by_key(|it| it.group == RESIDUALS);
    let place = figures.iter().position(|it| is_drawn_late(it.group)).unwrap_or(figures.len());
    figures.splice(place..place, own);
}

fn figure<'f>(
    figures: &'f mut Vec<Figure>,
    group: &'static str,
    name: &str,
    unit: impl FnOnce() -> Unit,
) -> &'f mut Figure {
    let known = figures.iter().position(|it| it.group == group && it.name == name);
    let at = known.unwrap_or_else(|| {
        figures.push(Figure::new(group, name, unit()));
        figures.len() - 1
    });
    &mut figures[at]
}

impl Signal<'_> {
    fn name(&self) -> &str {
        self.json.at("signal").text()
    }

    /// Whether the standard deviations are those of the model; else the residuals say how large
    /// they are.
    fn is_given(&self) -> bool {
        self.document.at("estimates").at("noise").text() == "given"
    }

    fn unit_of_residual(&self) -> Unit {
        let name = if self.is_given() { "standard deviations" } else { "times root of weight" };
        Unit { name: name.into(), si: 1.0 }
    }

    /// The signal of a fit has a plot if it is a state, a control or a report; a sum of squares
    /// does not say which signal it is about.
    fn add_points(&self, figures: &mut [Figure], own: &mut Vec<Figure>) {
        let groups = [STATES, CONTROLS, super::figures::REPORTED];
        let is_it = |it: &&mut Figure| groups.contains(&it.group) && it.name == self.name();
        let known = figures.iter_mut().find(is_it).filter(|_| self.is_given());
        let unit = || of_value(self.document, self.name());
        let figure = known.unwrap_or_else(|| figure(own, MEASURED, self.name(), unit));
        figure.curves.push(self.curve(Kind::Points, "measured"));
    }

    fn curve(&self, kind: Kind, key: &str) -> Curve {
        let keys = |key: &str| ["residuals", &self.at.to_string(), key].map(str::to_owned).into();
        let has_bars = kind == Kind::Points && !self.json.at("deviation").is_absent();
        // Where the model has no standard deviations those of the residuals are shown.
        let size = self.document.at("estimates").at("deviation").number();
        let size = if self.is_given() { Some(1.0) } else { size };
        Curve {
            label: "measured".into(),
            of: self.of,
            kind,
            time: keys("time"),
            values: keys(key),
            bars: size.filter(|_| has_bars).map(|size| (keys("deviation"), size)),
            ..Curve::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::figures::figures;
    use super::*;

    fn names(noise: &str) -> Vec<(&'static str, usize)> {
        let text = format!(
            r#"{{"time":[0,1],"states":{{"x":[0,1]}},"costates":{{"x":[1,1]}},
                "estimates":{{"noise":"{noise}","deviation":3}},"residuals":[{{"signal":"x",
                "time":[0.5],"values":[-1],"measured":[2],"deviation":[0.1]}}]}}"#
        );
        let document = [serde_json::from_str(&text).expect("it is JSON")];
        let all = figures(&document);
        all.iter().map(|it| (it.group, it.curves.len())).collect()
    }

    #[test]
    fn points_of_a_fit_are_over_the_curve_of_its_signal() {
        assert_eq!(names("given"), [("States", 2), ("Residuals", 1), ("Costates", 1)]);
    }

    /// `sum(k in obs, (2*x(k.t) - k.x)^2)` is about the column `x`, which is another thing.
    #[test]
    fn points_of_a_sum_are_by_themselves() {
        let all = [("States", 1), (MEASURED, 1), ("Residuals", 1), ("Costates", 1)];
        assert_eq!(names("residuals"), all);
    }
}
