//! What came out of a solve: the solution of the library, and its document.

use crate::exit::Exit;
use crate::output::document::Document;
use crate::output::optimality::Optimality;
use crate::output::verified::Verification;
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
        // A model that cannot be simulated is solved all the same.
        let verified = self.solution.verify().ok();
        let document = &mut self.document;
        document.verification = verified.as_ref().map(|it| Verification::new(it, asked));
        let checks = || Optimality::new(&self.solution.optimality(verified.as_ref()));
        document.optimality = document.optimality.take().map(|_| checks());
    }

    /// How a command with this solve ends; whether it has to be confirmed, too, is the caller's
    /// choice.
    pub fn exit(&self, confirmed: bool) -> Exit {
        let is_fine = self.is_good() && (!confirmed || self.document.is_confirmed());
        if is_fine { Exit::Fine } else { Exit::NotSolved }
    }
}
