//! The last digits of an answer.
//!
//! A control that comes to its bound where an arc begins is kept off it by the square root of the
//! barrier parameter, which moves the time of the junction. The parameter of a search is far from
//! that of its tolerance; what is answered in the end is worth a smaller one.

use super::joint::{Joint, is_stationary};
use super::tuning::polish::{MOST_ITERATIONS, TOLERANCE};
use super::{Located, Search};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::solve::solve_chain;

impl Search<'_> {
    /// The same optimum with a smaller barrier parameter; nothing where there is none that is as
    /// accurate.
    pub(super) fn polished(&mut self, located: &Located) -> Option<Located> {
        let Joint { model, chain, outcome } = &*located.joint;
        let before = &outcome.solution;
        let mut sharper = chain.clone();
        for phase in &mut sharper.phases {
            phase.method.tol = TOLERANCE;
            phase.method.max_iter = MOST_ITERATIONS;
        }
        let start = Start::after(before);
        let mut outcome = solve_chain(&sharper, Some(start), &mut |_, _| (self.stop)()).ok()?;
        let own = &mut outcome.solution;
        let is_sharper = own.mu < before.mu && own.kkt_error <= before.kkt_error;
        own.counts.add(&before.counts);
        if !is_sharper || !is_stationary(own) {
            return None;
        }
        let joint = Joint { model: model.clone(), chain: chain.clone(), outcome };
        let whole = self.whole(located);
        let planned = self.planned(&located.structure, &whole);
        let polished = self.located(joint, &planned);
        let mut polished = Located { insertion: located.insertion, ..polished };
        self.compared(&mut polished);
        Some(polished)
    }
}
