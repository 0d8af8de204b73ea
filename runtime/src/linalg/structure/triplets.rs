//! Sparse matrices as families of entries that repeat from stage to stage.
//!
//! A family stands for the entries `(row + k row_step, column + k column_step)`, `k = 0 .. count`.
//! A transcribed problem has a few dozen families, whatever the length of its grid. Entries at the
//! same place are added.

/// How many stages of a chain are passed over at a time.
const STRETCH: usize = 128;

/// Entries that repeat with constant steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family {
    /// Row of the first entry.
    pub row: usize,
    /// Column of the first entry.
    pub column: usize,
    /// Rows from one entry to the next.
    pub row_step: usize,
    /// Columns from one entry to the next.
    pub column_step: usize,
    /// Number of entries.
    pub count: usize,
}

impl Family {
    /// A single entry.
    pub fn single(row: usize, column: usize) -> Self {
        Family { row, column, row_step: 0, column_step: 0, count: 1 }
    }
}

/// The structure of a sparse matrix; its values stand in the order of the families.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Triplets {
    /// The families.
    pub families: Vec<Family>,
}

impl Triplets {
    /// Number of values.
    pub fn len(&self) -> usize {
        self.families.iter().map(|family| family.count).sum()
    }

    /// Whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Row and column of every value, in order.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.families.iter().flat_map(|f| {
            (0..f.count).map(|k| (f.row + k * f.row_step, f.column + k * f.column_step))
        })
    }

    /// Row, column and value of each of these values, in order; quickest where the iterator goes
    /// from one to the next itself (`for_each`, `sum`).
    pub(crate) fn with_values<'v>(
        &'v self,
        values: &'v [f64],
    ) -> impl Iterator<Item = (usize, usize, f64)> + 'v {
        let mut rest = values;
        self.families.iter().flat_map(move |f| {
            let (own, others) = rest.split_at(f.count);
            rest = others;
            let numbered = own.iter().enumerate();
            numbered.map(|(k, it)| (f.row + k * f.row_step, f.column + k * f.column_step, *it))
        })
    }

    /// `y += A x`
    pub fn multiply_add(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        self.for_each_stretch(values, |family, values| {
            let (mut row, mut column) = (family.row, family.column);
            for value in values {
                y[row] += value * x[column];
                row += family.row_step;
                column += family.column_step;
            }
        });
    }

    /// `y += A' x`
    pub fn transposed_multiply_add(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        self.for_each_stretch(values, |family, values| {
            let (mut row, mut column) = (family.row, family.column);
            for value in values {
                y[column] += value * x[row];
                row += family.row_step;
                column += family.column_step;
            }
        });
    }

    /// `y += A x` where only the lower triangle of the symmetric `A` is stored.
    pub fn symmetric_multiply_add(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        let x = &x[..y.len()];
        self.for_each_stretch(values, |family, values| {
            let (mut row, mut column) = (family.row, family.column);
            for value in values {
                y[row] += value * x[column];
                if row != column {
                    y[column] += value * x[row];
                }
                row += family.row_step;
                column += family.column_step;
            }
        });
    }

    /// Calls `action` with every family and its values, stretch by stretch of the chain: what
    /// belongs to a stretch stays in the fastest memory while all families pass over it.
    fn for_each_stretch<'v>(&self, values: &'v [f64], mut action: impl FnMut(Family, &'v [f64])) {
        let longest = self.families.iter().map(|family| family.count).max().unwrap_or(0);
        for start in (0..longest).step_by(STRETCH) {
            let mut first = 0;
            for family in &self.families {
                let end = family.count.min(start + STRETCH);
                if start < end {
                    let (row, column) = (
                        family.row + start * family.row_step,
                        family.column + start * family.column_step,
                    );
                    action(Family { row, column, ..*family }, &values[first + start..first + end]);
                }
                first += family.count;
            }
        }
    }
}
