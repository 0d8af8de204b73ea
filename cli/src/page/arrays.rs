//! The components of an array, such as the temperatures `T1` to `T50` along a rod: they are drawn
//! together, as colours over time and index, and not in fifty plots.

use super::colours::COLOURS;
use super::curves::{Piece, pieces};
use super::figures::{CONTROLS, COSTATES, Figure, MULTIPLIERS, PATH, REPORTED, STATES};
use super::json::Json;
use super::tags::escape;
use super::units::Unit;
use crate::output::number::significant;
use serde::Serialize;

/// So few components are drawn one by one.
const FEWEST: usize = 8;

/// Signals over time whose names count on, in one of the documents.
#[derive(Debug, Serialize)]
pub struct Array {
    #[serde(skip)]
    pub group: &'static str,
    /// What their names have before the number.
    pub name: String,
    pub unit: Unit,
    /// Which of the documents.
    pub of: usize,
    /// The number of the first of them.
    pub first: usize,
    /// Their places among the figures.
    pub figures: Vec<usize>,
    /// Their lowest and their highest value, in their unit.
    pub range: [f64; 2],
}

impl Array {
    /// What it is asked for by: as one of its components is, without the number.
    pub fn signal(&self) -> String {
        Figure::new(self.group, &self.name, self.unit.clone()).signal()
    }

    /// The curves of its components, each in pieces, in the units in which they are shown.
    pub fn rows(&self, documents: &[Json], figures: &[Figure]) -> Vec<Vec<Piece>> {
        let row = |at: &usize| {
            let figure = &figures[*at];
            let own = figure.curves.iter().filter(|it| it.of == self.of && it.kind.is_plan());
            own.flat_map(|it| pieces(&documents[self.of], figure, it)).collect()
        };
        self.figures.iter().map(row).collect()
    }

    /// Which colours stand for which values, as a part of a caption.
    pub fn scale(&self) -> String {
        let stops: Vec<String> =
            COLOURS.iter().map(|[red, green, blue]| format!("rgb({red} {green} {blue})")).collect();
        let [low, high] = self.range.map(|it| significant(it, 5));
        format!(
            "<span class=\"scale\">{low} <i style=\"background:linear-gradient(to right,{})\"></i> \
             {high} {}</span>",
            stops.join(","),
            escape(&self.unit.name)
        )
    }
}

/// All arrays of documents, in the order of their figures. Those of the same name have one scale,
/// so that they can be compared.
pub fn arrays(documents: &[Json], figures: &[Figure]) -> Vec<Array> {
    let mut all = Vec::new();
    for own in runs(figures) {
        let first = &figures[own[0]];
        let Some((name, number)) = numbered(&first.name) else { continue };
        if own.len() < FEWEST || !OVER_TIME.contains(&first.group) {
            continue;
        }
        let array = |of: usize| Array {
            group: first.group,
            name: name.to_owned(),
            unit: first.unit.clone(),
            of,
            first: number,
            figures: own.clone(),
            range: NOTHING,
        };
        let known = (0..documents.len()).map(|of| array(of).measured(documents, figures));
        let known: Vec<Array> = known.filter(|it| it.range[0] <= it.range[1]).collect();
        let range = known.iter().fold(NOTHING, |all, it| joined(all, it.range));
        all.extend(known.into_iter().map(|it| Array { range, ..it }));
    }
    all
}

/// Places of figures of one group and one unit, each of which has the number after the one before.
fn runs(figures: &[Figure]) -> Vec<Vec<usize>> {
    let goes_on = |a: &Figure, b: &Figure| {
        let names = numbered(&a.name).zip(numbered(&b.name));
        let is_next = names.is_some_and(|(a, b)| a.0 == b.0 && a.1 + 1 == b.1);
        a.group == b.group && a.unit == b.unit && is_next
    };
    let mut place = 0;
    let run = |own: &[Figure]| {
        place += own.len();
        (place - own.len()..place).collect()
    };
    figures.chunk_by(|a, b| goes_on(a, b)).map(run).collect()
}

/// No values.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn joined(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The groups of plots that have arrays.
const OVER_TIME: [&str; 6] = [STATES, CONTROLS, PATH, REPORTED, COSTATES, MULTIPLIERS];

impl Array {
    /// With the range of its values.
    fn measured(self, documents: &[Json], figures: &[Figure]) -> Array {
        let rows = self.rows(documents, figures);
        let values = rows.iter().flatten().flatten().map(|it| it.1);
        let range = values.fold(NOTHING, |all, it| joined(all, [it, it]));
        Array { range, ..self }
    }
}

/// What stands before the number at the end of a name, and the number: of `T7`, `T[7]`, `T_7` and
/// `T.x7`.
fn numbered(name: &str) -> Option<(&str, usize)> {
    let inner = name.strip_suffix(']').unwrap_or(name);
    let stem = inner.trim_end_matches(|it: char| it.is_ascii_digit());
    let number = inner[stem.len()..].parse().ok()?;
    let stem = if inner.len() < name.len() { stem.strip_suffix('[')? } else { stem };
    let stem = stem.trim_end_matches(['_', '.']);
    (!stem.is_empty()).then_some((stem, number))
}

/// The value of a row at a time; nothing in a gap.
pub fn value_at(row: &[Piece], time: f64) -> Option<f64> {
    let is_within = |it: &&Piece| it[0].0 <= time && time <= it[it.len() - 1].0;
    let piece = row.iter().find(is_within)?;
    let next = piece.partition_point(|it| it.0 <= time).clamp(1, piece.len().max(2) - 1);
    let (a, b) = (piece[next - 1], piece.get(next).copied().unwrap_or(piece[next - 1]));
    let part = if b.0 > a.0 { (time - a.0) / (b.0 - a.0) } else { 0.0 };
    Some(a.1 + (b.1 - a.1) * part)
}

#[cfg(test)]
mod tests {
    use super::super::figures::figures;
    use super::*;

    fn document(names: &[String]) -> [Json; 1] {
        let column = |(at, name): (usize, &String)| format!("\"{name}\":[{at},{}]", at + 10);
        let states: Vec<String> = names.iter().enumerate().map(column).collect();
        let text = format!("{{\"time\":[0,2],\"states\":{{{}}}}}", states.join(","));
        [serde_json::from_str(&text).expect("it is JSON")]
    }

    fn found(names: &[String]) -> Vec<(String, usize, usize)> {
        let documents = document(names);
        let all = arrays(&documents, &figures(&documents));
        all.into_iter().map(|it| (it.name, it.first, it.figures.len())).collect()
    }

    #[test]
    fn names_that_count_on_are_an_array() {
        for [before, after] in [["T", ""], ["T[", "]"], ["T_", ""]] {
            let names: Vec<String> = (3..11).map(|it| format!("{before}{it}{after}")).collect();
            assert_eq!(found(&names), [("T".into(), 3, 8)], "{before}");
            assert_eq!(found(&names[1..]), [], "few are drawn one by one");
        }
        let mut names: Vec<String> = (0..9).map(|it| format!("T.x{it}")).collect();
        assert_eq!(found(&names), [("T.x".into(), 0, 9)]);
        names.remove(4);
        assert_eq!(found(&names), [], "one is missing");
    }

    #[test]
    fn arrays_of_two_documents_share_a_scale() {
        let names: Vec<String> = (1..9).map(|it| format!("T{it}")).collect();
        let [own] = document(&names);
        let text = serde_json::to_string(&own).expect("text").replace("17", "70");
        let documents = [own, serde_json::from_str(&text).expect("JSON")];
        let all = arrays(&documents, &figures(&documents));
        let found: Vec<_> = all.iter().map(|it| (it.of, it.range)).collect();
        assert_eq!(found, [(0, [0.0, 70.0]), (1, [0.0, 70.0])]);
    }

    #[test]
    fn rows_have_their_values_between_nodes_and_none_outside() {
        let names: Vec<String> = (1..9).map(|it| format!("T{it}")).collect();
        let documents = document(&names);
        let figures = figures(&documents);
        let all = arrays(&documents, &figures);
        assert_eq!(all[0].range, [0.0, 17.0]);
        let rows = all[0].rows(&documents, &figures);
        let at = |time: f64| value_at(&rows[2], time);
        assert_eq!([at(0.0), at(0.5), at(2.0)], [Some(2.0), Some(4.5), Some(12.0)]);
        assert_eq!([at(-0.1), at(2.1)], [None, None]);
        let jump = [vec![(0.0, 1.0), (1.0, 1.0), (1.0, 5.0), (2.0, 5.0)]];
        assert_eq!([0.9, 1.1].map(|it| value_at(&jump, it)), [Some(1.0), Some(5.0)]);
        assert_eq!(value_at(&[vec![(1.0, 3.0)]], 1.0), Some(3.0), "a point alone");
    }
}
