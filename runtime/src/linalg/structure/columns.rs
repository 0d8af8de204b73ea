//! Sparse matrices by columns.

/// A sparse matrix by columns: values of column `j` are `column_starts[j] .. column_starts[j + 1]`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Columns {
    pub(crate) rows: usize,
    pub(crate) column_starts: Vec<usize>,
    pub(crate) row_indices: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl Columns {
    /// Zeros at all `places` (row, column), and the value that each place became: equal places are
    /// one. Places that are `None` have no value.
    pub(crate) fn of_places(
        places: &[Option<(usize, usize)>],
        rows: usize,
        columns: usize,
    ) -> (Self, Vec<Option<u32>>) {
        let mut order: Vec<u32> =
            (0..places.len() as u32).filter(|i| places[*i as usize].is_some()).collect();
        order.sort_unstable_by_key(|i| places[*i as usize].map(|(row, column)| (column, row)));
        let mut targets = vec![None; places.len()];
        let mut result = Columns {
            rows,
            column_starts: vec![0; columns + 1],
            row_indices: Vec::new(),
            values: Vec::new(),
        };
        let mut last = None;
        for i in order {
            let place = places[i as usize];
            if place != last {
                let (row, column) = place.unwrap_or_default();
                result.row_indices.push(row);
                result.column_starts[column + 1] += 1;
                last = place;
            }
            targets[i as usize] = Some(result.row_indices.len() as u32 - 1);
        }
        for column in 0..columns {
            result.column_starts[column + 1] += result.column_starts[column];
        }
        result.values = vec![0.0; result.row_indices.len()];
        (result, targets)
    }

    /// Row, column and index of each value.
    pub(crate) fn places(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        let of = move |column: usize| {
            let values = self.column_starts[column]..self.column_starts[column + 1];
            values.map(move |value| (self.row_indices[value], column, value))
        };
        (0..self.column_starts.len() - 1).flat_map(of)
    }

    /// The sum of entries (row, column, value).
    pub(crate) fn of_entries(entries: &[(usize, usize, f64)], rows: usize, columns: usize) -> Self {
        let places: Vec<_> = entries.iter().map(|(row, column, _)| Some((*row, *column))).collect();
        let (mut result, targets) = Columns::of_places(&places, rows, columns);
        for (target, (_, _, value)) in targets.into_iter().flatten().zip(entries) {
            result.values[target as usize] += value;
        }
        result
    }
}
