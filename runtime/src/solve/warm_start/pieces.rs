//! An earlier solution between its grid points: the polynomials of the schemes that it was found
//! with.

use crate::linalg::Stages;
use crate::problem::{Problem, Variable};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::{Interval, Signal};
use crate::transcribe::mesh::Mesh;

/// What was solved as one phase.
#[derive(Clone)]
pub struct Piece {
    /// With the scheme and the grid that it was solved on.
    pub problem: Problem,
    /// First and last time, where the phase that begins with it goes from 0 to 1.
    pub ends: [f64; 2],
    /// All variables of its solution.
    pub variables: Vec<f64>,
}

/// The signals of a problem on the pieces of an earlier solution.
pub(super) struct Curves<'p> {
    pieces: Vec<Curve<'p>>,
}

impl<'p> Curves<'p> {
    pub(super) fn new(problem: &Problem, pieces: &'p [Piece]) -> Self {
        Curves { pieces: pieces.iter().map(|it| Curve::new(problem, it)).collect() }
    }

    /// A signal at a time; nothing where no piece has it.
    pub(super) fn at(&self, signal: Signal, tau: f64) -> Option<f64> {
        let first_after = self.pieces.partition_point(|it| it.piece.ends[0] <= tau);
        self.pieces.get(first_after.saturating_sub(1))?.at(signal, tau)
    }
}

struct Curve<'p> {
    piece: &'p Piece,
    interval: Interval,
    mesh: Mesh,
    stages: Stages,
    /// The number that each state of the problem has here, and each control.
    states: Vec<Option<usize>>,
    controls: Vec<Option<usize>>,
}

impl<'p> Curve<'p> {
    fn new(problem: &Problem, piece: &'p Piece) -> Self {
        let own = &piece.problem;
        let nlp = TranscribedNlp::new(own);
        Curve {
            piece,
            interval: nlp.interval().clone(),
            mesh: nlp.mesh().clone(),
            stages: nlp.chain(),
            states: places(&problem.states, &own.states),
            controls: places(&problem.controls, &own.controls),
        }
    }

    fn at(&self, signal: Signal, tau: f64) -> Option<f64> {
        let own = match signal {
            Signal::State(i) => Signal::State(self.states[i]?),
            Signal::Control(i) => Signal::Control(self.controls[i]?),
        };
        let [begin, end] = self.piece.ends;
        let (k, part) = self.mesh.find(((tau - begin) / (end - begin)).clamp(0.0, 1.0));
        let first = k * self.stages.variable_step();
        let terms = self.interval.signal_at(own, part).into_iter();
        Some(terms.map(|(place, factor)| factor * self.piece.variables[first + place]).sum())
    }
}

/// Where variables of these names are among others.
fn places(names: &[Variable], among: &[Variable]) -> Vec<Option<usize>> {
    names.iter().map(|it| among.iter().position(|other| other.name == it.name)).collect()
}
