//! Shorter intervals, and graded ones, where a located answer is not as accurate as it should be.

use super::tuning::search::SMOOTHER;
use super::{Located, Search};

impl Search<'_> {
    /// With shorter intervals where the Hamiltonian is not what it should be.
    pub(super) fn refined(&mut self, mut located: Located) -> Located {
        loop {
            let structure = located.structure.finer(self.problem, &located.outcome.phases);
            if structure.phases == located.structure.phases {
                return located;
            }
            let whole = self.whole(&located);
            match self.solve(structure, &whole) {
                Some(finer) => {
                    let (insertion, before) = (located.insertion, located.structure.clone());
                    let finer = self.mended(finer).expect("it is solved");
                    // What its holds are worth is known of the same modes only.
                    located = match finer.structure.has_modes_of(&before) {
                        true => Located { insertion, ..finer },
                        false => self.with_holds(finer),
                    };
                }
                None => return located,
            }
        }
    }

    /// With graded intervals where controls are steep, as long as that helps.
    pub(super) fn followed(&mut self, mut even: Located) -> Located {
        let mut losses = self.compared(&mut even);
        let (mut best, mut located) = (even.clone(), even.clone());
        while let Some(finer) = self.graded(&located, &losses) {
            located = Located { insertion: even.insertion, ..finer };
            losses = self.compared(&mut located);
            let is_as_smooth = self.roughness(&located) <= self.roughness(&best);
            if located.loss < best.loss && is_as_smooth {
                best = located.clone();
                best.others = vec![even.clone()];
            }
        }
        best
    }

    /// On graded and shorter intervals where something is lost; nothing where all are.
    fn graded(&mut self, located: &Located, losses: &[f64]) -> Option<Located> {
        let structure = located.structure.finer(self.problem, &located.outcome.phases);
        let structure = structure.graded(losses);
        let is_new = structure.phases != located.structure.phases;
        if is_new { self.solve(structure, &self.whole(located)) } else { None }
    }

    /// Whether one answer is far more accurate than another, which is not as accurate as it should
    /// be.
    pub(super) fn is_smoother(&self, one: &Located, other: &Located) -> bool {
        self.roughness(one) < SMOOTHER * self.roughness(other)
    }

    /// By how much trajectories are less accurate than they should be; 1 where they just are.
    fn roughness(&self, located: &Located) -> f64 {
        let all = located.structure.roughness(self.problem, &located.outcome.phases);
        all.into_iter().fold(1.0, f64::max)
    }
}
