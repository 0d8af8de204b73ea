//! Tables of numbers, as compiled functions read and write them.

/// A table with one column per quantity and one row per grid point, stored column by column.
///
/// Columns are `stride` apart; `stride` is even and at least `count`, so that machine code may
/// always read and write pairs of points. Rows from `count` to `stride` are padding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    data: Vec<f64>,
    count: usize,
    columns: usize,
    stride: usize,
}

impl Columns {
    /// All zeros: `columns` quantities at `count` points.
    pub fn new(columns: usize, count: usize) -> Self {
        let stride = Self::stride_for(count);
        Columns { data: vec![0.0; columns * stride], count, columns, stride }
    }

    /// One point: a column for each of its numbers.
    pub fn of_point(point: &[f64]) -> Self {
        let mut columns = Columns::new(point.len(), 1);
        point.iter().enumerate().for_each(|(at, value)| columns.column_mut(at)[0] = *value);
        columns
    }

    /// Even, and not a multiple of a page, or all columns would compete for the same cache lines.
    fn stride_for(count: usize) -> usize {
        let even = count.next_multiple_of(2);
        if even.is_multiple_of(256) { even + 8 } else { even }
    }

    /// Number of points.
    pub fn count(&self) -> usize {
        self.count
    }
    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }
    /// Distance between the starts of neighbouring columns, in numbers.
    pub fn stride(&self) -> usize {
        self.stride
    }
    /// One column, without padding.
    pub fn column(&self, column: usize) -> &[f64] {
        &self.data[column * self.stride..][..self.count]
    }
    /// One column, without padding.
    pub fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.data[column * self.stride..][..self.count]
    }
    /// The same quantities at some of the points.
    pub fn selected(&self, points: &[usize]) -> Columns {
        let mut selected = Columns::new(self.columns, points.len());
        for column in 0..self.columns {
            let own = self.column(column);
            let values = points.iter().map(|point| own[*point]);
            selected.column_mut(column).iter_mut().zip(values).for_each(|(to, from)| *to = from);
        }
        selected
    }
    /// All numbers with padding: entry (column, point) is at `column * stride + point`.
    pub fn as_slice(&self) -> &[f64] {
        &self.data
    }
    /// All numbers with padding.
    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.data
    }
}
