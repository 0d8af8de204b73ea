//! How a model asks to be solved: the `method` block, with defaults where the model is silent.

use super::Scheme;

/// Intervals of the first grid where the choice is ours.
pub const FIRST_GRID: usize = 50;
/// More intervals need more memory than a computer has to spare: about 5 kB each.
const MOST_INTERVALS: usize = 1_000_000;
/// The same for all steps together where an interval has several: the variables inside it cost
/// more.
const MOST_STEPS: usize = 200_000;
/// What a control is on an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlShape {
    /// One value.
    Constant,
    /// Linear, and continuous from interval to interval.
    Linear,
    /// A polynomial through its values at the nodes of a collocation scheme.
    Polynomial,
}

/// Which solver treats the transcribed problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// Convex problems to the conic solver, all others to the interior point method.
    Automatic,
    /// The interior point method, always.
    InteriorPoint,
    /// The conic solver; refuses what is not convex.
    Convex,
}

/// Which factorisation the interior point method uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linear {
    /// Stage-wise Riccati recursion where the structure allows, else sparse LDL.
    Automatic,
    /// Stage-wise Riccati recursion.
    Riccati,
    /// Sparse LDL.
    SparseLdl,
}

/// The `method` block, with defaults where the model is silent.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// Transcription.
    pub scheme: Scheme,
    /// States (indices) that an implicit Euler step takes at the old time.
    pub lagged: Vec<usize>,
    /// What a control is on an interval; constant where the scheme does not allow this shape.
    pub controls: ControlShape,
    /// Control intervals.
    pub intervals: usize,
    /// Normalised times of the grid, from 0 to 1; none if all intervals have one length.
    pub mesh: Vec<f64>,
    /// `N = auto`: the grid is refined until the sum of the errors of its steps is below
    /// `tolerance`.
    pub is_refined: bool,
    /// `scheme = radau` or `gauss` without a number: stages are added where that is worth more than
    /// dividing intervals.
    pub is_raised: bool,
    /// The sum of the relative errors of all steps that a refined grid may have.
    pub tolerance: f64,
    /// Integration steps in each control interval.
    pub steps: usize,
    /// Smoothing width, if the model names one.
    pub sigma: Option<f64>,
    /// Widths to pass through before `sigma`, decreasing; the last is the target if `sigma` is
    /// absent.
    pub continuation: Vec<f64>,
    /// The name of the smoothing kernel.
    pub kernel: String,
    /// Solver.
    pub solver: Solver,
    /// Factorisation.
    pub linear: Linear,
    /// Tolerance on the scaled optimality error.
    pub tol: f64,
    /// Iteration limit.
    pub max_iter: usize,
    /// Seed of everything random.
    pub seed: u64,
}

impl Method {
    /// How many steps there are in all, and how many there may be, if that is less. Nobody may make
    /// room for them before this is asked.
    pub fn excess(&self) -> Option<[usize; 2]> {
        let most = if self.steps == 1 { MOST_INTERVALS } else { MOST_STEPS };
        let steps = self.intervals.saturating_mul(self.steps);
        (steps > most).then_some([steps, most])
    }

    /// Puts the method to the first of the grids that are tried, as far as the choice is ours: a
    /// polynomial on each interval says much with few of them.
    pub fn begin(&mut self) {
        let is_polynomial = self.controls == ControlShape::Polynomial;
        if self.is_raised {
            self.scheme = self.scheme.with_stages(if is_polynomial { 3 } else { 2 });
        }
        if self.is_refined {
            self.intervals = if self.is_raised && is_polynomial { 10 } else { FIRST_GRID };
        }
    }
}
