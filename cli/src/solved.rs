//! What came out of a solve: the solution of the library, and its document.

use crate::exit::Exit;
use crate::output::document::Document;
use crate::output::optimality::Optimality;
use crate::output::verified::Verification;
use fdcc::Solution;
use std::sync::Arc;

/// Everything that came out of a solve.
#[derive(Clone)]
pub struct Solved {
    pub solution: Arc<Solution>,
    pub document: Document,
}

impl Solved {
    /// Whether the answer can be used.
    pub fn is_good(&self) -> bool {
        self.solution.is_solved()
    }

    /// Replays the controls on the true system; `asked` is the largest difference that is called
    /// confirmation.
    pub fn replay(&mut self, asked: f64) {
        if !self.solution.phases().is_empty() {
            return self.replay_phases(asked);
        }
        // A model that cannot be simulated is solved all the same.
        let verified = self.solution.verify().ok();
        let document = &mut self.document;
        document.verification = verified.as_ref().map(|it| Verification::new(it, asked));
        let checks = || Optimality::new(&self.solution.optimality(verified.as_ref()));
        document.optimality = document.optimality.take().map(|_| checks());
    }

    fn replay_phases(&mut self, asked: f64) {
        let Ok((verified, links)) = self.solution.verify_phases() else { return };
        let document = &mut self.document;
        let phases = document.phases.0.iter_mut().zip(&verified);
        for ((_, phase), verified) in phases {
            phase.0.verification = Some(Verification::new(verified, asked));
        }
        let own = document.phases.0.iter();
        let own = own.filter_map(|(name, it)| Some((name.as_str(), it.0.verification.as_ref()?)));
        let whole = Verification::of_phases(&own.collect::<Vec<_>>(), &links, asked);
        document.verification = Some(whole);
        let parts = self.solution.phases().iter().zip(&verified);
        let checks: Vec<_> = parts.flat_map(|(it, replay)| it.optimality(Some(replay))).collect();
        document.optimality = document.optimality.take().map(|_| Optimality::new(&checks));
    }

    /// How a command with this solve ends; whether it has to be confirmed, too, is the caller's
    /// choice.
    pub fn exit(&self, confirmed: bool) -> Exit {
        let is_fine = self.is_good() && (!confirmed || self.document.is_confirmed());
        if is_fine { Exit::Fine } else { Exit::NotSolved }
    }
}
