//! One solve for each row of a grid of values.

use super::cases::Cases;
use super::{Grid, Options, Solution};
use crate::error::Error;
use crate::executor::Executor;
use crate::model::Model;

/// The solutions of a [`Grid`], row by row.
///
/// ```
/// use fdcc::{Executor, Grid, Model, Sweep};
///
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let model = Model::from_text("hop", text)?;
/// let runs: Sweep = model.sweep(&Grid::read(&["N=20,40"], &model)?, &Executor::serial())?;
/// let intervals: Vec<usize> = runs.solutions().map(|it| it.time().len() - 1).collect();
/// assert_eq!(intervals, [20, 40]);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Sweep {
    grid: Grid,
    solutions: Vec<Solution>,
}

impl Sweep {
    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.solutions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.solutions.is_empty()
    }

    /// The names and values of one row.
    pub fn row(&self, index: usize) -> Vec<(&str, &str)> {
        self.grid.row(index)
    }

    /// What came out of each row.
    pub fn solutions(&self) -> impl Iterator<Item = &Solution> {
        self.solutions.iter()
    }
}

impl Model {
    /// Solves once for each row as [`Cases`] do, side by side; which thread solves it makes no
    /// difference.
    ///
    /// # Errors
    ///
    /// Those of the first row that cannot be solved.
    pub fn sweep(&self, grid: &Grid, executor: &Executor) -> Result<Sweep, Error> {
        let cases = Cases::new(self);
        let options = Options { executor: Executor::serial(), ..Options::default() };
        let one = |row: usize| cases.case(&grid.values(row))?.solve(&options);
        let solutions = executor.in_order(grid.rows, one, Result::is_err);
        let solutions = solutions.into_iter().collect::<Result<_, _>>()?;
        Ok(Sweep { grid: grid.clone(), solutions })
    }
}
