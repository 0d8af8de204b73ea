//! What came out of a solve: the solution of the library, and its document.

use crate::exit::Exit;
use crate::output::document::Document;
use crate::output::optimality::Optimality;
use crate::output::verification::Verification;
use fdcc::Solution;

/// Everything that came out of a solve.
pub struct Solved {
    pub solution: Solution,
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
        self.document.replay(&self.solution, asked);
    }

    /// How a command with this solve ends; whether it has to be confirmed, too, is the caller's
    /// choice.
    pub fn exit(&self, confirmed: bool) -> Exit {
        let is_fine = self.is_good() && (!confirmed || self.document.is_confirmed());
        if is_fine { Exit::Fine } else { Exit::NotSolved }
    }
}

impl Document {
    /// Replays the controls of its solution on the true system; `asked` is the largest difference
    /// that is called confirmation.
    pub fn replay(&mut self, solution: &Solution, asked: f64) {
        if !solution.phases().is_empty() {
            return self.replay_phases(solution, asked);
        }
        // A model that cannot be simulated is solved all the same.
        let verified = solution.verify().ok();
        self.verification = verified.as_ref().map(|it| Verification::new(it, asked));
        let checks = || Optimality::new(&solution.optimality(verified.as_ref()));
        self.optimality = self.optimality.take().map(|_| checks());
    }

    fn replay_phases(&mut self, solution: &Solution, asked: f64) {
        let Ok((verified, links)) = solution.verify_phases() else { return };
        let phases = self.phases.0.iter_mut().zip(&verified);
        for ((_, phase), verified) in phases {
            phase.0.verification = Some(Verification::new(verified, asked));
        }
        let own = self.phases.0.iter();
        let own = own.filter_map(|(name, it)| Some((name.as_str(), it.0.verification.as_ref()?)));
        let whole = Verification::of_phases(&own.collect::<Vec<_>>(), &links, asked);
        self.verification = Some(whole);
        let parts = solution.phases().iter().zip(&verified);
        let checks: Vec<_> = parts.flat_map(|(it, replay)| it.optimality(Some(replay))).collect();
        self.optimality = self.optimality.take().map(|_| Optimality::new(&checks));
    }
}
