//! The Hamiltonian of a solution: the derivative of the optimum by time.
//!
//! By the length of interval `k`, over that of the time, the [Lagrangian](super::lagrangian)
//! changes by the Hamiltonian of the interval
//!
//! ```text
//!     H_k = sum_j b_j L(node j) - sum_j lambda_j . F(node j)  ~  L + p . f,        p = dJ/dx
//! ```
//!
//! in which nothing is approximated beyond the transcription: the mean of `H_k` is exactly the
//! derivative by the final time.

use super::elsewhere::Elsewhere;
use super::lagrangian::{Lagrangian, add_slopes};
use super::minimum;
use crate::nlp::{Derivatives, Nlp, Solution};
use crate::problem::{Columns, Problem};
use crate::transcribe::TranscribedNlp;

/// Over the whole time, terms that are not larger than this times the tolerance are none.
const NOISE: f64 = 100.0;
/// Terms that are less than this part of noise are those of an objective that is 0.
const NOTHING: f64 = 1e-8;
/// Terms are far larger than noise that is no more than this part of them.
const CLEAR: f64 = 1e-2;
/// An unknown with a larger multiplier is at its bound.
const AT_BOUND: f64 = 1e-4;

/// The Hamiltonian of each interval, and what it has to be.
#[derive(Clone, Debug, Default)]
pub struct Hamiltonian {
    /// One for each interval, of the objective of the model.
    pub values: Vec<f64>,
    /// The mean size of the terms that it is a sum of, or of noise where that is more: what
    /// deviations are to be compared with.
    pub size: f64,
    /// The same where its terms are less than noise, but not nothing: what an optimum of small
    /// numbers is to be judged by.
    pub scale: f64,
    /// Whether it has to be constant: time itself does not matter.
    pub is_constant: bool,
    /// What it has to be at the last time, where that is unknown: minus what the objective and the
    /// conditions at the ends gain by it.
    pub expected: Option<f64>,
    /// One for each control: the part of the time on which it does not minimise the Hamiltonian, by
    /// the sign of the slope or because it is less elsewhere.
    pub violations: Vec<f64>,
    /// What a pause on a surface would gain, per time, where one is possible: above 0 it is no
    /// optimum.
    pub pause: Option<f64>,
    /// Whether all its terms together are no more than the tolerance of the solver: then nothing
    /// can be said of it.
    pub is_noise: bool,
    /// Terms that are not larger than this are none; where all are far larger, it is the most that
    /// noise can be.
    pub noise: f64,
}

impl Hamiltonian {
    /// Of a solution, with the derivatives there, over this time.
    pub(crate) fn new(
        problem: &Problem,
        nlp: &mut TranscribedNlp,
        (solution, derivatives): (&Solution, &Derivatives),
        duration: f64,
    ) -> Self {
        let lagrangian = Lagrangian::new(problem, nlp, solution);
        let ((values, size), expected) = (lagrangian.hamiltonian(duration), lagrangian.expected());
        let noise = noise(problem, nlp, (duration, size));
        let is_noise = size <= noise;
        let scale = if size > NOTHING * noise { size } else { noise };
        let size = size.max(noise);
        let violations = match is_noise {
            true => vec![0.0; problem.layout.u],
            false => {
                let slopes = minimum::gradient(nlp, solution, derivatives);
                minimum::violations(nlp, (&solution.v, &slopes), (duration, size))
            }
        };
        // At the time of a row of measured data costates jump.
        let is_constant = problem.is_autonomous && problem.measurements.is_empty();
        let mut own = Hamiltonian {
            values,
            size,
            scale,
            is_constant,
            expected,
            violations,
            pause: None,
            is_noise,
            noise,
        };
        if own.has_to_be_least(problem, solution) {
            let parts = Elsewhere::new(nlp, solution, (duration, &own)).parts;
            let both = own.violations.iter_mut().zip(parts);
            both.for_each(|(part, elsewhere)| *part = part.max(elsewhere));
        }
        own
    }

    /// Whether values of controls far from their own can say that it is no optimum: not through
    /// thin layers, nor where the optimum of the grid is proved to be global.
    pub(crate) fn has_to_be_least(&self, problem: &Problem, solution: &Solution) -> bool {
        problem.surfaces.is_empty() && !solution.global
    }

    /// The mean difference from what it has to be, over all intervals; nothing where it may be
    /// anything.
    pub fn deviation(&self) -> Option<f64> {
        let target = self.target()?;
        let sum: f64 = self.values.iter().map(|value| (value - target).abs()).sum();
        Some(sum / self.values.len().max(1) as f64)
    }

    /// What it has to be, as far as that is known; nothing where it may be anything.
    pub(crate) fn target(&self) -> Option<f64> {
        let mean = self.values.iter().sum::<f64>() / self.values.len().max(1) as f64;
        (self.is_constant && !self.is_noise).then_some(self.expected.unwrap_or(mean))
    }
}

/// Terms that are not larger than this are none, over this time: the tolerance in units of the
/// objective, which are small where all numbers of a model are. They are at most 1, and take time
/// to find out: they are asked for where terms of this size leave it open what is noise.
fn noise(problem: &Problem, nlp: &mut TranscribedNlp, (duration, size): (f64, f64)) -> f64 {
    let most = NOISE * problem.method.tol / duration.abs();
    let is_clear = most <= CLEAR * size;
    if is_clear { most } else { NOISE * problem.method.tol * nlp.objective_unit() / duration.abs() }
}

impl Lagrangian<'_> {
    /// One for each interval, of the objective of the model; and the mean size of its terms.
    pub(super) fn hamiltonian(&self, duration: f64) -> (Vec<f64>, f64) {
        let (mut sums, mut sizes) = (vec![0.0; self.nlp.chain().intervals], 0.0);
        for node in &self.nlp.interval().nodes {
            let dynamics = &*self.problem.dynamics;
            let mut values = Columns::new(dynamics.outputs(), sums.len());
            dynamics.value(&self.points(dynamics, node), &self.parameters, &mut values);
            for output in 0..dynamics.outputs() {
                let weights = self.weights(node, output);
                for (sum, (weight, value)) in
                    sums.iter_mut().zip(weights.zip(values.column(output)))
                {
                    *sum += weight * value;
                    sizes += (weight * value).abs();
                }
            }
        }
        sums.iter_mut().for_each(|sum| *sum *= self.problem.sense / duration);
        let count = duration.abs() * sums.len() as f64;
        (sums, sizes / count)
    }

    /// Where the last time is an unknown between its bounds, the Lagrangian does not change with
    /// it.
    fn expected(&self) -> Option<f64> {
        let (problem, stages) = (self.problem, self.nlp.chain());
        let unknown = problem.last_time?;
        let variable = stages.globals().start + unknown;
        let multipliers = &self.solution.multipliers;
        let boundary = &*problem.boundary;
        let place = boundary.layout().parameters().start + problem.unknowns[unknown].parameter;
        let (points, rows) = (self.ends(boundary), &multipliers.constraints[stages.coupling()]);
        let mut slopes = vec![0.0; boundary.layout().p];
        add_slopes(boundary, &points, &self.parameters, &mut slopes, |output| {
            vec![output.checked_sub(1).map_or(1.0, |row| rows[row])]
        });
        let at_bound = multipliers.lower[variable].max(multipliers.upper[variable]);
        let gain = slopes[place - boundary.layout().parameters().start];
        (at_bound <= AT_BOUND * (1.0 + gain.abs())).then_some(-problem.sense * gain)
    }
}
