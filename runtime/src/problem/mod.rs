//! The contract between symbols and numbers: an optimal control problem as functions, bounds and
//! names.
//!
//! Everything a model means is here; nothing of its text but the [`Origin`] of each row. Whoever
//! fills a [`Problem`] (the compiler, or a test with hand-written functions) is not the runtime's
//! business.
//!
//! Time is normalised in all functions that a transcription evaluates: their input `t` is `tau` in
//! [0, 1], and the real time is `t0(p) + tau * (tf(p) - t0(p))`. So a free final time needs no
//! special treatment: it is a parameter like any other, and its derivatives come out of the
//! functions.

mod by_parameters;
mod chain;
mod choices;
mod measurements;
mod method;
mod often_called;
mod scheme;

pub use by_parameters::{ByParameters, ChainByParameters};
pub use chain::{Chain, End, Link};
pub use choices::{ControlShape, Linear, Solver, Word};
pub use measurements::{Interpolant, Measurements};
pub use method::{FIRST_GRID, Grid, Method, Order};
pub use often_called::often_called;
pub(crate) use scheme::RADAU;
pub use scheme::{MOST_STAGES, Scheme};

use std::ops::Range;
use std::sync::Arc;

/// How many inputs of each kind a function has. Their order is always `z = [t | x | u | p | s]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Times (0 or 1).
    pub t: usize,
    /// States; twice the states (start, then end) for boundary functions.
    pub x: usize,
    /// Controls.
    pub u: usize,
    /// Parameters: the `param`s, the `free` unknowns and the smoothing widths.
    pub p: usize,
    /// Selectors, one per surface; in a simulation, then one for each kink of the right side.
    pub s: usize,
}

impl Layout {
    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.t + self.x + self.u + self.p + self.s
    }
    /// Positions of the states.
    pub fn states(&self) -> Range<usize> {
        self.t..self.t + self.x
    }
    /// Positions of the controls.
    pub fn controls(&self) -> Range<usize> {
        self.t + self.x..self.t + self.x + self.u
    }
    /// Positions of the parameters.
    pub fn parameters(&self) -> Range<usize> {
        let start = self.t + self.x + self.u;
        start..start + self.p
    }
    /// Positions of the selectors.
    pub fn selectors(&self) -> Range<usize> {
        let start = self.t + self.x + self.u + self.p;
        start..start + self.s
    }
    /// Inputs that differ from point to point of a grid: `[t | x | u | s]`, all but the parameters.
    pub fn point_inputs(&self) -> usize {
        self.t + self.x + self.u + self.s
    }
}

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

/// Which entries of a matrix are not zero by structure: (row, column), sorted by row, then column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pattern {
    /// Rows of the matrix.
    pub rows: usize,
    /// Columns of the matrix.
    pub columns: usize,
    /// The entries.
    pub entries: Vec<(u32, u32)>,
}

/// How a function depends on what the optimiser chooses (states, controls, `free` parameters).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Degree {
    /// Constant derivative.
    Affine,
    /// Constant second derivative.
    Quadratic,
    /// Anything else.
    Nonlinear,
}

/// Where in the model something comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// In the model's words, such as `track` or `vel.x'`.
    pub label: Arc<str>,
    /// Byte range in the text of the model.
    pub span: (u32, u32),
}

/// `y = f(z)` with `z = [t | x | u | p | s]`, known sparsity and exact derivatives, over a whole
/// grid per call.
///
/// `points` holds the columns `[t | x | u | s]`; `parameters` is the same at all points. The
/// Jacobian and the Hessian cover the inputs the function was differentiated by; pattern columns
/// are positions in `z`. All tables have as many points as `points`. Nothing is checked but sizes,
/// by `assert!`.
pub trait Function: Send + Sync {
    /// Sizes of the inputs.
    fn layout(&self) -> &Layout;
    /// Number of outputs.
    fn outputs(&self) -> usize;
    /// Entries of dy/dz.
    fn jacobian_pattern(&self) -> &Pattern;
    /// Entries of the lower triangle of the Hessian of `multipliers . y`.
    fn hessian_pattern(&self) -> &Pattern;
    /// How one output depends on the differentiated inputs.
    fn degree(&self, row: usize) -> Degree;
    /// Where one output comes from.
    fn origin(&self, row: usize) -> Origin;
    /// Gets ready to be called often for derivatives up to this order, 0 for values alone.
    fn prepare(&self, order: usize);
    /// The outputs: one column each.
    fn value(&self, points: &Columns, parameters: &[f64], values: &mut Columns);
    /// Outputs and Jacobian: one column per output, one per pattern entry.
    fn jacobian(
        &self,
        points: &Columns,
        parameters: &[f64],
        values: &mut Columns,
        jacobian: &mut Columns,
    );
    /// Outputs, Jacobian and the Hessian of `multipliers . y` (one column of multipliers per
    /// output) in one pass.
    fn derivatives(
        &self,
        points: &Columns,
        parameters: &[f64],
        multipliers: &Columns,
        values: &mut Columns,
        jacobian: &mut Columns,
        hessian: &mut Columns,
    );
}

/// `lower <= value <= upper`; infinite where there is no bound, equal for an equality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower bound or `-inf`.
    pub lower: f64,
    /// Upper bound or `+inf`.
    pub upper: f64,
}

impl Bounds {
    /// No bounds.
    pub const FREE: Bounds = Bounds { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    /// Exactly this value.
    pub fn fixed(value: f64) -> Self {
        Bounds { lower: value, upper: value }
    }
    /// Whether only one value is allowed.
    pub fn is_equality(&self) -> bool {
        self.lower == self.upper
    }
    /// A number inside of them, as far from them as there is room, up to 1.
    pub fn inside(&self) -> f64 {
        match (self.lower.is_finite(), self.upper.is_finite()) {
            (true, true) => 0.5 * (self.lower + self.upper),
            (true, false) => self.lower + 1.0,
            (false, true) => self.upper - 1.0,
            (false, false) => 0.0,
        }
    }
    /// How far `value` is outside; 0 inside, infinite where one of the three is not a number.
    pub fn violation(&self, value: f64) -> f64 {
        if value.is_nan() || self.lower.is_nan() || self.upper.is_nan() {
            f64::INFINITY
        } else {
            (self.lower - value).max(value - self.upper).max(0.0)
        }
    }
}

/// A scalar state or control.
#[derive(Clone, Debug)]
pub struct Variable {
    /// `th`, or `pos.x` for a part.
    pub name: String,
    /// Bounds at all times.
    pub bounds: Bounds,
    /// One of its declared unit in SI, above 0; 1 where the model declares none.
    pub unit: f64,
    /// Where it is declared.
    pub origin: Origin,
    /// A running integral that was made a state; not shown to the user.
    pub hidden: bool,
}

/// One entry of `p`.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name; smoothing widths are called `sigma(SURFACE)`.
    pub name: String,
    /// Its value (for a `free` unknown, its guess).
    pub value: f64,
    /// One of its declared unit in SI, above 0; 1 where the model declares none.
    pub unit: f64,
    /// Where it is declared.
    pub origin: Origin,
}

/// A `free` unknown: an entry of `p` that the optimiser chooses.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Its place in `p`.
    pub parameter: usize,
    /// Its bounds.
    pub bounds: Bounds,
}

/// A switching surface, the zero set of output `i` of the switching functions; in a [`Problem`]
/// also a whole `Dir`, with `|psi|`.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Where it is declared.
    pub origin: Origin,
    /// The entry of `p` that holds its smoothing width.
    pub sigma: usize,
}

/// What a guess knows of the start of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartGuess {
    /// It was given, or follows from conditions.
    Known,
    /// Nothing; the guess is constant.
    Unknown,
    /// Nothing, but where the state ends: the guess is to go there straight.
    BeforeEnd,
}

/// An optimal control problem on one phase.
#[derive(Clone)]
pub struct Problem {
    /// Name of the model.
    pub name: String,
    /// Sizes of `t x u p s`.
    pub layout: Layout,
    /// States.
    pub states: Vec<Variable>,
    /// Controls.
    pub controls: Vec<Variable>,
    /// All of `p`, with values.
    pub parameters: Vec<Parameter>,
    /// Which entries of `p` are unknowns.
    pub unknowns: Vec<Unknown>,
    /// Switching surfaces.
    pub surfaces: Vec<Surface>,
    /// The smoothed right side over normalised time: `(tf - t0) * f(t, x, u, p, s = Sgn_sigma(psi)
    /// or Dir_sigma(psi))`, one output per state; then, if [`Problem::running_cost`], one more:
    /// `(tf - t0) *` the integrand of the objective. Differentiated by `x`, `u` and the unknowns.
    pub dynamics: Arc<dyn Function>,
    /// Whether the last output of `dynamics` is the integrand of the objective.
    pub running_cost: bool,
    /// Path constraints, over normalised time. Differentiated by `x`, `u` and the unknowns.
    pub path: Arc<dyn Function>,
    /// One per output of `path`.
    pub path_bounds: Vec<Bounds>,
    /// Which path constraints need not hold at the last time.
    pub half_open: Vec<usize>,
    /// Inputs `[x(start), x(end) | p]` in the layout `x = 2n`. Output 0 is the Mayer objective, the
    /// others are boundary conditions. Differentiated by both ends and the unknowns.
    pub boundary: Arc<dyn Function>,
    /// One per output of `boundary` but the first.
    pub boundary_bounds: Vec<Bounds>,
    /// `-1` if the model says `maximize`: the functions above are of the minimisation problem.
    pub sense: f64,
    /// Whether there is an objective at all.
    pub has_objective: bool,
    /// States whose start is a number.
    pub start: Vec<Option<f64>>,
    /// What the guess of each state knows of its start; nothing is known of hidden ones, which a
    /// model cannot link.
    pub start_guesses: Vec<StartGuess>,
    /// Inputs `[t | p]`; outputs the guess of all states, then of all controls, at normalised time
    /// `t`.
    pub guess: Arc<dyn Function>,
    /// Inputs `[p]`; outputs `t0, tf`.
    pub interval: Arc<dyn Function>,
    /// `psi`, or `|psi|` of a `Dir`, one output per surface, over normalised time.
    pub switching: Arc<dyn Function>,
    /// Sums over rows of measured data, which are part of the objective or of a state.
    pub measurements: Vec<Measurements>,
    /// Whether neither `dynamics` nor `path` depends on the time but through states and controls,
    /// and nothing is measured at certain times.
    pub is_autonomous: bool,
    /// The unknown that is the last time and appears in no right side, path constraint or first
    /// time.
    pub last_time: Option<usize>,
    /// Names of the outputs of `report`.
    pub report_names: Vec<String>,
    /// What the model reports, over normalised time.
    pub report: Arc<dyn Function>,
    /// How the model asks to be solved.
    pub method: Method,
}
