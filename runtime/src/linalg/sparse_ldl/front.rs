//! The elimination of some rows of a dense symmetric matrix, with pivots of one and two rows that
//! keep its entries moderate.

/// Rows of a balanced matrix with nothing above this are rounding.
const TINY: f64 = 16.0 * f64::EPSILON;
/// So many columns of `L` are subtracted at a time.
const BATCH: usize = 4;

/// A dense symmetric matrix by columns of its lower triangle. The first rows are eliminated, as far
/// as there are pivots; then their columns hold `L` below the blocks of `D`.
#[derive(Debug, Default)]
pub(super) struct Front {
    /// A pivot is refused if the elimination could enlarge entries by more than one over this.
    pub(super) threshold: f64,
    /// Names of the rows.
    pub(super) rows: Vec<u32>,
    /// `size x size`
    pub(super) values: Vec<f64>,
    /// Size of the block of `D` that begins at an eliminated row; 0 in the second row of a block.
    pub(super) blocks: Vec<u8>,
    pub(super) negative: usize,
    /// A row of `L D`.
    factors: Vec<f64>,
}

/// A pivot that may be taken.
enum Pivot {
    One(usize),
    Two(usize, usize),
}

/// The matrix is singular, or holds what is not a number.
#[derive(Debug)]
pub(super) struct Singular;

type Choice = Result<Option<Pivot>, Singular>;

impl Front {
    pub(super) fn new(threshold: f64) -> Self {
        Front { threshold, ..Front::default() }
    }

    pub(super) fn size(&self) -> usize {
        self.rows.len()
    }

    /// Fills the matrix with zeros.
    pub(super) fn clear(&mut self) {
        let size = self.size();
        self.values.clear();
        self.values.resize(size * size, 0.0);
        self.blocks.clear();
        self.negative = 0;
    }

    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        let size = self.size();
        self.values[row.min(column) * size + row.max(column)] += value;
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row.min(column) * self.size() + row.max(column)]
    }

    /// Eliminates as many of the first `ready` rows as there are pivots for, and orders the rows
    /// accordingly.
    pub(super) fn eliminate(&mut self, ready: usize) -> Result<(), Singular> {
        let (mut k, mut candidate, mut refused) = (0, 0, 0);
        while refused < ready - k {
            candidate = if candidate < ready { candidate } else { k };
            match self.pivot(k, candidate, ready)? {
                Some(pivot) => {
                    k += self.take(k, pivot, ready);
                    (candidate, refused) = (candidate.max(k), 0);
                }
                None => (candidate, refused) = (candidate + 1, refused + 1),
            }
        }
        self.eliminate_rest(k, ready);
        Ok(())
    }

    /// The row `r` as a pivot, by itself or with the row that it depends on most; `None` if neither
    /// is large enough.
    fn pivot(&self, k: usize, r: usize, ready: usize) -> Choice {
        let (partner, largest) = self.largest_off_diagonal(k, r, ready);
        let diagonal = self.at(r, r).abs();
        if diagonal.max(largest) <= TINY {
            return Err(Singular);
        }
        if diagonal > TINY && diagonal >= self.threshold * largest {
            return Ok(Some(Pivot::One(r)));
        }
        Ok(partner.filter(|s| self.is_good_pair(k, r, *s)).map(|s| Pivot::Two(r.min(s), r.max(s))))
    }

    /// The largest entry of row `r` beside its diagonal, and where among the ready rows it is
    /// largest.
    fn largest_off_diagonal(&self, k: usize, r: usize, ready: usize) -> (Option<usize>, f64) {
        let (mut partner, mut largest) = (None, 0.0_f64);
        for s in (k..ready).filter(|s| *s != r) {
            let value = self.at(s, r).abs();
            if value > largest {
                (partner, largest) = (Some(s), value);
            }
        }
        let size = self.size();
        let rest = &self.values[r * size + ready..(r + 1) * size];
        (partner, rest.iter().fold(largest, |most, value| most.max(value.abs())))
    }

    /// Whether the pivot of both rows enlarges no entry too much (Duff & Reid 1996), and its
    /// determinant is no difference of nearly equal numbers.
    fn is_good_pair(&self, k: usize, r: usize, s: usize) -> bool {
        let (a, b, c) = (self.at(r, r), self.at(r, s), self.at(s, s));
        let others = |row: usize| {
            let others = (k..self.size()).filter(|i| *i != r && *i != s);
            others.fold(0.0, |most: f64, i| most.max(self.at(i, row).abs()))
        };
        let (p, q, determinant) = (others(r), others(s), (a * c - b * b).abs());
        let most = determinant / self.threshold;
        determinant >= 0.5 * (a * c).abs().max(b * b)
            && c.abs() * p + b.abs() * q <= most
            && b.abs() * p + a.abs() * q <= most
    }

    /// Eliminates the pivot from the ready columns; returns how many rows it has.
    fn take(&mut self, k: usize, pivot: Pivot, ready: usize) -> usize {
        match pivot {
            Pivot::One(r) => {
                self.exchange(k, r);
                self.eliminate_one(k, ready);
                1
            }
            Pivot::Two(r, s) => {
                self.exchange(k, r);
                self.exchange(k + 1, s);
                self.eliminate_two(k, ready);
                2
            }
        }
    }

    /// Exchanges rows and columns `a <= b`, with their rows of `L`.
    fn exchange(&mut self, a: usize, b: usize) {
        if a == b {
            return;
        }
        let size = self.size();
        self.rows.swap(a, b);
        (0..a).for_each(|j| self.values.swap(j * size + a, j * size + b));
        self.values.swap(a * size + a, b * size + b);
        (a + 1..b).for_each(|i| self.values.swap(a * size + i, i * size + b));
        (b + 1..size).for_each(|i| self.values.swap(a * size + i, b * size + i));
    }

    fn eliminate_one(&mut self, k: usize, ready: usize) {
        let size = self.size();
        let (left, right) = self.values.split_at_mut((k + 1) * size);
        let column = &mut left[k * size + k..];
        let (pivot, column) = (column[0], &mut column[1..]);
        for j in 0..ready - k - 1 {
            let factor = column[j] / pivot;
            let target = &mut right[j * size + k + 1 + j..(j + 1) * size];
            target.iter_mut().zip(&column[j..]).for_each(|(t, w)| *t -= factor * w);
        }
        column.iter_mut().for_each(|value| *value /= pivot);
        self.blocks.push(1);
        self.negative += usize::from(pivot < 0.0);
    }

    fn eliminate_two(&mut self, k: usize, ready: usize) {
        let size = self.size();
        let (a, b, c) = (self.at(k, k), self.at(k + 1, k), self.at(k + 1, k + 1));
        let det = a * c - b * b;
        let (left, right) = self.values.split_at_mut((k + 2) * size);
        let (first, second) = left[k * size..].split_at_mut(size);
        let (first, second) = (&mut first[k + 2..], &mut second[k + 2..]);
        let factors = |p: f64, q: f64| ((c * p - b * q) / det, (a * q - b * p) / det);
        for j in 0..ready - k - 2 {
            let (p, q) = factors(first[j], second[j]);
            let target = &mut right[j * size + k + 2 + j..(j + 1) * size];
            let columns = first[j..].iter().zip(&second[j..]);
            target.iter_mut().zip(columns).for_each(|(t, (v, w))| *t -= p * v + q * w);
        }
        first.iter_mut().zip(second).for_each(|(p, q)| (*p, *q) = factors(*p, *q));
        self.blocks.extend([2, 0]);
        self.negative += if det < 0.0 { 1 } else { 2 * usize::from(a < 0.0) };
    }

    /// Subtracts `L D L'` of the first `pivots` rows from the columns that are not ready.
    fn eliminate_rest(&mut self, pivots: usize, ready: usize) {
        let (size, mut factors) = (self.size(), std::mem::take(&mut self.factors));
        factors.resize(pivots, 0.0);
        for j in ready..size {
            self.times_diagonal(j, &mut factors);
            let (left, right) = self.values.split_at_mut(j * size);
            let left = &*left;
            let columns = move |k: usize| &left[k * size + j..(k + 1) * size];
            subtract(&mut right[j..size], &factors, columns);
        }
        self.factors = factors;
    }

    /// Row `j` of `L D`.
    fn times_diagonal(&self, j: usize, factors: &mut [f64]) {
        for k in 0..factors.len() {
            factors[k] = self.at(j, k) * self.at(k, k);
            match self.blocks[k] {
                2 => factors[k] += self.at(j, k + 1) * self.at(k + 1, k),
                0 => factors[k] += self.at(j, k - 1) * self.at(k, k - 1),
                _ => {}
            }
        }
    }
}

/// Subtracts columns times their factors, several at a time.
fn subtract<'a>(target: &mut [f64], factors: &[f64], columns: impl Fn(usize) -> &'a [f64]) {
    let whole = factors.len() / BATCH * BATCH;
    for k in (0..whole).step_by(BATCH) {
        let f = &factors[k..k + BATCH];
        let batch = columns(k).iter().zip(columns(k + 1)).zip(columns(k + 2)).zip(columns(k + 3));
        for (t, (((p, q), r), s)) in target.iter_mut().zip(batch) {
            *t -= (f[0] * p + f[1] * q) + (f[2] * r + f[3] * s);
        }
    }
    for k in whole..factors.len() {
        target.iter_mut().zip(columns(k)).for_each(|(t, p)| *t -= factors[k] * p);
    }
}
