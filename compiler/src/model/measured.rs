//! Sums over rows of measured data in numbers: at which time each row is.

use super::numbers::Numbers;
use super::{Model, Place, Symbol};
use crate::data::Table;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::syntax::text;
use fdcc_grammar::{Code, Diagnostic, Severity};

/// A `sum` whose term reads the trajectory at the time of each row.
#[derive(Clone, Debug)]
pub struct Sum {
    /// The call; named by its text.
    pub place: Place,
    /// One of [`Model::tables`].
    pub table: usize,
    /// The time of a row, over its columns and parameters.
    pub time: ExprId,
    /// What is added up, over states, controls and time at the time of a row, its columns,
    /// parameters and unknowns.
    pub term: ExprId,
    /// Whether it is that of a signal of a `fit`, whose standard deviations are known.
    pub is_fit: bool,
    /// Whether rows before the time of the model and rows behind it belong to other phases.
    pub is_shared: [bool; 2],
}

/// So much beyond an end is rounding, of the times that are looked at.
const ROUNDING: f64 = 1e-9;

/// An expression over the columns of a table, in each of its rows; `inputs` are the other symbols.
pub(crate) fn by_row(
    graph: &Graph,
    symbols: &[Symbol],
    (at, table): (usize, &Table),
    expr: ExprId,
    mut inputs: Vec<f64>,
) -> Vec<f64> {
    let columns: Vec<(usize, &[f64])> = (symbols.iter().enumerate())
        .filter_map(|(input, symbol)| match symbol {
            Symbol::Column(own, column) if *own == at => {
                Some((input, table.columns[*column].as_slice()))
            }
            _ => None,
        })
        .collect();
    let value = |row: usize| {
        columns.iter().for_each(|(input, column)| inputs[*input] = column[row]);
        evaluate(graph, &[expr], &inputs, &[])[0]
    };
    (0..table.rows()).map(value).collect()
}

impl Model {
    /// The real time of each row of a sum.
    pub(crate) fn row_times(&self, numbers: &Numbers, sum: &Sum) -> Vec<f64> {
        let table = (sum.table, &self.tables[sum.table]);
        by_row(&self.graph, &self.symbols, table, sum.time, numbers.inputs().to_vec())
    }

    /// Whether the objective is one of measured data.
    pub fn objective_reads_sums(&self) -> bool {
        let objective = self.objective.iter().map(|it| it.1);
        let read = objective.flat_map(|it| self.graph.inputs_of(&[it]));
        read.map(|at| self.symbols[at as usize]).any(|it| matches!(it, Symbol::Sum(_)))
    }

    /// Whether each sum over rows is a term of the objective, with a factor that is given, and of
    /// nothing else: then each phase of the model has its own part of it.
    pub fn are_sums_terms(&self) -> bool {
        let mut graph = self.graph.clone();
        let is_sum = |at: &u32| matches!(self.symbols[*at as usize], Symbol::Sum(_));
        let is_param = |at: u32| matches!(self.symbols[at as usize], Symbol::Param(_));
        let rows: Vec<ExprId> = self.boundary.iter().map(|row| row.value).collect();
        let mut is_given = |input: u32, value: ExprId| {
            let factor = derivative(&mut graph, value, input);
            graph.inputs_of(&[factor]).into_iter().all(is_param)
        };
        let read = |value: &[ExprId]| self.graph.inputs_of(value).into_iter().filter(is_sum);
        let objective = self.objective.iter().map(|it| it.1);
        read(&rows).next().is_none()
            && objective.into_iter().all(|it| read(&[it]).all(|input| is_given(input, it)))
    }

    /// Whether the optimiser chooses the first or the last time.
    pub(crate) fn has_free_ends(&self) -> bool {
        let inputs = self.graph.inputs_of(&self.interval);
        inputs.iter().any(|input| matches!(self.symbols[*input as usize], Symbol::Free(_)))
    }

    /// Rows at whose times there is no trajectory, and rows that go back in time.
    pub(crate) fn misplaced_rows(&self, numbers: &Numbers) -> Vec<Diagnostic> {
        let mut found = Vec::new();
        for sum in &self.sums {
            let (table, times) = (&self.tables[sum.table], self.row_times(numbers, sum));
            found.extend(self.back_in_time(sum, table, &times));
            if !self.has_free_ends() {
                let ends = self.interval.map(|end| numbers.value(self, end));
                found.extend(self.beyond(sum, table, &times, ends));
            }
        }
        found
    }

    fn back_in_time(&self, sum: &Sum, table: &Table, times: &[f64]) -> Option<Diagnostic> {
        let shown = |time| self.time_in_words(time);
        let row = times.windows(2).position(|pair| pair[1] < pair[0])? + 1;
        let message = format!("{} goes back in time", table.row_in_words(row));
        let label = format!("at {}, after a row at {}", shown(times[row]), shown(times[row - 1]));
        let found = Diagnostic::new(Code::RowOrder, message, sum.place.span, label);
        let found = found.label(table.place, "in this file");
        Some(Diagnostic { severity: Severity::Warning, ..found }.help(
            "rows in another order give the same sum; if a number is wrong, correct it in the file",
        ))
    }

    fn beyond(
        &self,
        sum: &Sum,
        table: &Table,
        times: &[f64],
        [first, last]: [f64; 2],
    ) -> Option<Diagnostic> {
        let shown = |time| self.time_in_words(time);
        let room = ROUNDING * (last - first).abs();
        let [before, behind] = sum.is_shared;
        let is_within =
            |time: f64| (before || time >= first - room) && (behind || time <= last + room);
        let is_outside = |time: &&f64| !is_within(**time);
        let row = times.iter().position(|time| !is_within(*time))?;
        let count = times.iter().filter(is_outside).count();
        let message = format!("{} is beyond the time of the model", table.row_in_words(row));
        let [first, last] = [first, last].map(&shown);
        let label = match count {
            1 => format!("a row at {}; time goes from {first} to {last}", shown(times[row])),
            _ => format!(
                "{count} rows, the first at {}; time goes from {first} to {last}",
                shown(times[row])
            ),
        };
        let found = Diagnostic::new(Code::RowBeyondTime, message, sum.place.span, label);
        Some(
            found.label(table.place, "in this file").help(
                "let `time` cover all rows, or leave out those that do not belong to this run",
            ),
        )
    }

    /// A time as the text writes times, rounded for people.
    pub(crate) fn time_in_words(&self, time: f64) -> String {
        let unit = self.units.iter().find(|it| it.is_time).filter(|it| it.scale != 1.0);
        let rounded = |value: f64| text::number((value * 1e9).round() / 1e9);
        match unit {
            Some(it) => format!("{} {}", rounded(time / it.scale), it.unit),
            None => rounded(time),
        }
    }
}
