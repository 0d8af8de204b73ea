//! What contradicts that an answer is an optimum, whatever its replay says: conditions that every
//! optimum meets.
//!
//! A replay shows that a trajectory is possible. That nothing better is near it, only the
//! multipliers say; and where the gradient through a thin layer is lost, they are wrong though all
//! conditions of the discrete problem are met. The measures and their limits are in
//! `docs/method/costate.md`.

use super::Solution;
use super::tuning::optimality::{OFF, VIOLATED};
use crate::verification::Verification;

/// One condition of an optimum.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)\nmethod { N = 50 }";
/// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
/// let checks = solution.optimality(None);
/// let control = checks.iter().find_map(|check| check.control.as_deref());
/// assert_eq!(control, Some("u"));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Check {
    /// Which one.
    pub condition: Condition,
    /// The control that it is about, if it is about one.
    pub control: Option<String>,
    /// By how much it is missed, in the unit of `size`.
    pub figure: f64,
    /// What that is compared with.
    pub size: f64,
    /// A larger part of the size contradicts.
    pub limit: f64,
}

/// What every optimum meets.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)\nmethod { N = 50 }";
/// use fdcc::optimality::Condition;
///
/// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
/// let checks = solution.optimality(None);
/// assert!(checks.iter().any(|check| check.condition == Condition::Minimum));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// The Hamiltonian is constant over time.
    HamiltonianConstant,
    /// It has the value that a free last time gives it.
    HamiltonianValue,
    /// A pause on a surface does not gain anything.
    Pause,
    /// The control is at the bound that the slope of the Hamiltonian points to, or the slope is 0.
    Minimum,
    /// No direction along the conditions was found in which the objective falls to second order.
    Curvature,
}

impl Check {
    /// Whether it is missed by more than the method may miss it.
    pub fn contradicts(&self) -> bool {
        self.figure.is_nan() || self.figure > self.limit * self.size
    }
}

impl Solution {
    /// The conditions of an optimum that can be checked. The states of a coarse grid account for as
    /// much as the replay differs. Where the optimum of the discrete problem is proved to be
    /// global, what its Hamiltonian misses is the grid alone.
    ///
    /// ```
    /// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
    /// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
    /// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
    /// let replay = solution.verify()?;
    /// assert!(solution.optimality(Some(&replay)).iter().all(|check| !check.contradicts()));
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    pub fn optimality(&self, replay: Option<&Verification>) -> Vec<Check> {
        if !self.phases().is_empty() {
            return self.phases().iter().flat_map(|phase| phase.optimality(replay)).collect();
        }
        let hamiltonian = &self.outcome.trajectory.hamiltonian;
        let is_global = self.outcome.solution.global;
        let gap = replay.and_then(Verification::state_gap).unwrap_or(0.0);
        let check = |condition, figure| {
            let (size, limit) = (hamiltonian.size, OFF.max(gap));
            Check { condition, control: None, figure, size, limit }
        };
        let condition = match hamiltonian.expected {
            Some(_) => Condition::HamiltonianValue,
            None => Condition::HamiltonianConstant,
        };
        let constant = hamiltonian.deviation().filter(|_| !is_global);
        let pause = hamiltonian.pause.filter(|_| !is_global);
        let constant = constant.map(|figure| check(condition, figure));
        let pause = pause.map(|gain| check(Condition::Pause, gain.max(0.0)));
        let names = self.problem.controls.iter().map(|control| control.name.clone());
        let violations = hamiltonian.violations.iter().enumerate();
        let signs = names.zip(violations).map(|(name, (at, figure))| Check {
            condition: Condition::Minimum,
            control: Some(name),
            figure: (figure - self.part_of_ends(at)).max(0.0),
            size: 1.0,
            limit: VIOLATED,
        });
        // Curvature has no size: it was found to be negative, or not.
        let curvature = Check {
            condition: Condition::Curvature,
            control: None,
            figure: f64::from(u8::from(self.outcome.solution.is_saddle)),
            size: 1.0,
            limit: 0.0,
        };
        constant.into_iter().chain(pause).chain(signs).chain([curvature]).collect()
    }

    /// The part of the time that the first and the last interval take, as far as conditions at the
    /// ends or links read a control there: that is worth more than the Hamiltonian says.
    fn part_of_ends(&self, control: usize) -> f64 {
        let own = self.model().meaning().conditions_read(control);
        let linked = self.linked.get(control).copied().unwrap_or_default();
        let time = self.time();
        let count = time.len();
        let lengths = [time[1] - time[0], time[count - 1] - time[count - 2]];
        let part = |at: usize| lengths[at] / (time[count - 1] - time[0]);
        (0..2).filter(|at| own[*at] || linked[*at]).map(part).sum()
    }
}
