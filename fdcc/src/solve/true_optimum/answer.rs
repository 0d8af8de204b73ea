//! A located optimum as one trajectory, in the words of the model.

use super::structure::Structure;
use super::{Joint, Located};
use fdcc_compiler::{Mode, Model};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::modes::{self, Span};
use fdcc_runtime::solution::phases::{Jump, located};
use fdcc_runtime::solve::warm_start::Piece;
use fdcc_runtime::solve::{ChainOutcome, Outcome};

/// One trajectory, and where it jumps.
#[derive(Clone)]
pub(crate) struct Whole {
    pub outcome: Outcome,
    /// Whether its modes are those of the true system: then none is too short to be meant.
    pub is_exact: bool,
    /// Each with its number, and the state on both sides.
    pub jumps: Vec<(usize, Jump)>,
    /// The phases that it was solved in; none of what is no located optimum.
    pub phases: Vec<SolvedPhase>,
    /// The other phases of a model with phases, with the structures that they have.
    pub beside: Vec<(Structure, Whole)>,
}

/// A phase with all variables of its solution.
#[derive(Clone)]
pub(crate) struct SolvedPhase {
    problem: Problem,
    ends: [f64; 2],
    variables: Vec<f64>,
}

impl Whole {
    /// The phase that was solved between these times, whose time is normalised.
    pub fn pieces(&self, ends: &[f64]) -> Vec<Piece> {
        let own = self.phases.iter().find(|it| it.ends == ends);
        let piece = |it: &SolvedPhase| Piece {
            problem: it.problem.clone(),
            ends: [0.0, 1.0],
            variables: it.variables.clone(),
        };
        own.map(piece).into_iter().collect()
    }
}

impl Located {
    /// All phases one after the other; `between` is the smoothed problem.
    pub fn whole(&self, between: &Problem) -> Whole {
        let modes = (0..between.surfaces.len()).map(|surface| self.spans(surface)).collect();
        let (outcome, ends) = located(between, &self.chain, &self.outcome, modes);
        let begins = self.structure.phases[1..].iter().zip(ends);
        let jumps = begins.filter_map(|(phase, end)| Some((phase.jump?, end))).collect();
        let (phases, beside) = (self.solved_phases(), Vec::new());
        Whole { outcome, is_exact: true, jumps, phases, beside }
    }

    /// What was solved, with the trajectories of its phases as they are here.
    pub fn in_phases(&self) -> Joint {
        let (model, chain) = (self.joint.model.clone(), self.joint.chain.clone());
        let phases = self.outcome.phases.clone();
        let outcome = ChainOutcome { phases, ..self.joint.outcome.clone() };
        Joint { model, chain, outcome }
    }

    /// Those of one phase of a model with phases, the first of which has this number.
    pub fn in_phase(&self, first: usize) -> Joint {
        let Joint { model, .. } = &*self.joint;
        let phases = model.phases[first..first + self.structure.phases.len()].to_vec();
        Joint {
            model: Model { phases, links: Vec::new(), ..model.clone() },
            chain: self.chain.clone(),
            outcome: self.outcome.clone(),
        }
    }

    fn solved_phases(&self) -> Vec<SolvedPhase> {
        let solved = self.chain.phases.iter().zip(&self.outcome.phases);
        let all = self.structure.times.windows(2).zip(solved);
        let of = |(pair, (problem, outcome)): (&[f64], (&Problem, &Outcome))| SolvedPhase {
            problem: problem.clone(),
            ends: [pair[0], pair[1]],
            variables: outcome.solution.v.clone(),
        };
        all.map(of).collect()
    }

    /// What a surface does from when to when.
    fn spans(&self, surface: usize) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for (phase, pair) in self.structure.phases.iter().zip(self.structure.times.windows(2)) {
            let mode = shown(phase.modes[surface]);
            match spans.last_mut().filter(|it| it.mode == mode) {
                Some(span) => span.to = pair[1],
                None => spans.push(Span { mode, from: pair[0], to: pair[1] }),
            }
        }
        spans
    }
}

/// A mode in the words of a solution.
pub(super) fn shown(mode: Mode) -> modes::Mode {
    match mode {
        Mode::Below => modes::Mode::Below,
        Mode::Held => modes::Mode::Held,
        Mode::Above => modes::Mode::Above,
    }
}
