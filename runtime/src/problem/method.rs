//! How a model asks to be solved: the `method` block, with defaults where the model is silent.

use super::{ControlShape, Linear, Scheme, Solver};

/// Intervals of the first grid where the choice is ours.
pub const FIRST_GRID: usize = 50;
/// The same where polynomials on them get as many stages as they need.
const FEWEST_INTERVALS: usize = 10;
/// More intervals need more memory than a computer has to spare: about 5 kB each.
const MOST_INTERVALS: usize = 1_000_000;
/// The same for all steps together where an interval has several: the variables inside it cost
/// more.
const MOST_STEPS: usize = 200_000;

/// Control intervals over normalised time.
#[derive(Clone, Debug, PartialEq)]
pub enum Grid {
    /// So many of one length.
    Uniform(usize),
    /// Between these times, which ascend from 0 to 1.
    Mesh(Vec<f64>),
    /// `N = auto`: refined until the sum of the errors of its steps is below
    /// [`Method::tolerance`].
    Auto,
}

/// The order of the scheme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// That of the scheme.
    Fixed,
    /// `scheme = radau` or `gauss` without a number: stages are added where that is worth more than
    /// dividing intervals.
    Auto,
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
    /// Whether path constraints hold at the nodes of a collocation scheme alone, where they may
    /// determine a control, and not between intervals.
    pub path_at_nodes: bool,
    /// Control intervals.
    pub grid: Grid,
    /// Whether the stages of the scheme are given.
    pub order: Order,
    /// The sum of the relative errors of all steps that a refined grid may have.
    pub tolerance: f64,
    /// How accurate the answer is to be in all, if that is named: what is compared in a certificate
    /// and in a replay, and what `tol` and `tolerance` are where they are not named.
    pub accuracy: Option<f64>,
    /// Whether `tol` is named.
    pub names_tol: bool,
    /// Whether `tolerance` is named.
    pub names_tolerance: bool,
    /// Whether the number of intervals is written: then the problem on these is meant, else that in
    /// continuous time.
    pub names_grid: bool,
    /// Whether the scheme is written.
    pub names_scheme: bool,
    /// Whether the kernel is written.
    pub names_kernel: bool,
    /// Integration steps in each control interval.
    pub steps: usize,
    /// Smoothing width, if the model names one.
    pub sigma: Option<f64>,
    /// Whether `sigma = 0` is written: nothing is smoothed in the end, and `continuation` is on the
    /// way there.
    pub exact: bool,
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

impl Grid {
    /// The normalised times of its points; none where all intervals have one length.
    pub fn times(&self) -> &[f64] {
        match self {
            Grid::Mesh(times) => times,
            Grid::Uniform(_) | Grid::Auto => &[],
        }
    }
}

impl Method {
    /// Whether something is to stay smoothed, with a width that is named.
    pub fn names_width(&self) -> bool {
        !self.exact && (self.sigma.is_some() || !self.continuation.is_empty())
    }

    /// How many control intervals there are; where the grid is to be refined, at first: a
    /// polynomial on each interval says much with few of them.
    pub fn intervals(&self) -> usize {
        match &self.grid {
            Grid::Uniform(intervals) => *intervals,
            Grid::Mesh(times) => times.len() - 1,
            Grid::Auto if self.order == Order::Auto && self.has_polynomials() => FEWEST_INTERVALS,
            Grid::Auto => FIRST_GRID,
        }
    }

    /// How many steps there are in all, and how many there may be, if that is less. Nobody may make
    /// room for them before this is asked.
    pub fn excess(&self) -> Option<[usize; 2]> {
        let most = if self.steps == 1 { MOST_INTERVALS } else { MOST_STEPS };
        let steps = self.intervals().saturating_mul(self.steps);
        (steps > most).then_some([steps, most])
    }

    /// The same of several phases together.
    pub fn excess_of<'m>(phases: impl Iterator<Item = &'m Method> + Clone) -> Option<[usize; 2]> {
        let kinds = [(true, MOST_STEPS), (false, MOST_INTERVALS)];
        kinds.into_iter().find_map(|(has_many, most)| {
            let own = phases.clone().filter(|method| !has_many || method.steps > 1);
            let steps = own.map(|it| it.intervals().saturating_mul(it.steps));
            let steps = steps.fold(0, usize::saturating_add);
            (steps > most).then_some([steps, most])
        })
    }

    /// Gives a scheme whose order is open the stages that are tried first.
    pub fn begin(&mut self) {
        if self.order == Order::Auto {
            let stages = if self.has_polynomials() { 3 } else { 2 };
            self.scheme = self.scheme.with_stages(stages);
        }
    }

    fn has_polynomials(&self) -> bool {
        self.controls == ControlShape::Polynomial
    }
}
