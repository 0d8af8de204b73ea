//! Other ways to the answer where the first one leads to nothing, or to nothing that is certified:
//! another kernel, another scheme.

use super::report::Options;
use super::tuning::search::{FAR_WORSE, OTHER_KERNEL, OTHER_SCHEME};
use super::{Compiled, Solution};
use crate::error::Error;
use fdcc_runtime::nlp::Status;

impl Compiled {
    /// What is certified near the answer with another kernel, where nothing is near that with the
    /// one of our choice: layers of another shape show other arcs and holds.
    pub(super) fn with_other_kernel(
        &self,
        first: Solution,
        options: &Options,
    ) -> Result<Solution, Error> {
        let meaning = self.model.meaning();
        let is_lost = matches!(first.status(), Status::IterationLimit | Status::NumericalFailure);
        let is_missing = is_uncertified(&first);
        let is_ours = !meaning.method.names_kernel && !self.model.names_its_discretisation();
        let is_switched = !meaning.surfaces.is_empty() && (is_lost || is_missing);
        if !is_ours || !is_switched || (options.stop)().is_break() {
            return Ok(first);
        }
        let other = self.model.with_method("kernel", OTHER_KERNEL)?;
        let second = other.compile_as_it_is(None)?.solve_once(options)?;
        let is_taken = second.is_certified() && !is_far_worse(&second, &first);
        Ok(if is_taken { second } else { first })
    }

    /// What a scheme of high order finds where that of our choice finds nothing that is feasible,
    /// or comes to no end: in continuous time there may be what implicit Euler damps, or is late
    /// for. Where nothing is certified near what it found, what is certified near the other.
    pub(super) fn with_other_scheme(
        &self,
        first: Solution,
        options: &Options,
    ) -> Result<Solution, Error> {
        let meaning = self.model.meaning();
        let is_ours = !meaning.method.names_scheme && !self.model.names_its_discretisation();
        let phases = || [meaning].into_iter().chain(meaning.phases.iter().map(|it| &it.model));
        let is_smooth = phases().all(|it| it.surfaces.is_empty());
        let is_lost = match first.status() {
            Status::Infeasible => is_smooth,
            Status::IterationLimit | Status::NumericalFailure => true,
            _ => false,
        };
        let is_missing = options.starts <= 1 && is_uncertified(&first);
        let is_jumping = phases().any(|it| !it.jumps.is_empty());
        if !is_ours || is_jumping || !(is_lost || is_missing) || (options.stop)().is_break() {
            return Ok(first);
        }
        let other = self.model.with_method("scheme", OTHER_SCHEME)?;
        let second = other.compile_as_it_is(None)?.solve_once(options)?;
        let is_taken = match is_missing {
            true => second.is_certified() && !is_far_worse(&second, &first),
            false => second.status().is_solved(),
        };
        Ok(if is_taken { second } else { first })
    }
}

/// Whether something was located that does not pass all checks.
fn is_uncertified(of: &Solution) -> bool {
    of.certificate.as_ref().is_some_and(|it| !it.is_certified())
}

/// Whether one answer is so much worse than another that it is no answer to the same question.
fn is_far_worse(one: &Solution, other: &Solution) -> bool {
    let [own, its] = [one, other].map(|it| it.problem.sense * it.objective());
    other.status().is_solved() && own - its > FAR_WORSE * own.abs().max(its.abs())
}
