//! The guess of a chain: that of each phase, where a state of which nothing is known at the start
//! begins where its links put it.

use super::ChainNlp;
use super::links::TranscribedLink;
use super::part::Part;
use crate::problem::{End, StartGuess};
use crate::transcribe::interval::Signal;

impl ChainNlp<'_> {
    /// The guess of the model on the grids.
    pub fn guess(&mut self) -> Vec<f64> {
        let mut v = vec![0.0; self.shape.unknowns[1]];
        for part in &mut self.parts {
            let own = part.nlp.guess();
            let stages = part.shape.variables.clone();
            v[stages.clone()].copy_from_slice(&own[..stages.len()]);
        }
        for (unknown, value) in self.chain.unknowns.iter().zip(&mut v[self.shape.unknowns[0]..]) {
            *value = self.parameters[unknown.parameter];
        }
        for phase in 1..self.parts.len() {
            self.continue_guess(phase, &mut v);
        }
        v
    }

    /// Moves the states of a phase of which nothing is known at the start to where the links from
    /// earlier phases put them.
    fn continue_guess(&mut self, phase: usize, v: &mut [f64]) {
        self.load_links(v);
        let parameters = &self.parameters;
        let is_earlier = |end: &End| end.phase() < phase || *end == End::First(phase);
        let from_earlier = self.links.iter_mut().filter(|it| it.link.ends.iter().all(is_earlier));
        let starts: Vec<(usize, f64)> =
            from_earlier.flat_map(|link| moves(link, parameters)).collect();
        let part = &self.parts[phase];
        for (variable, by) in starts {
            let first = part.shape.variables.start;
            let state = variable.checked_sub(first).filter(|it| *it < part.nlp.problem().layout.x);
            if let Some(state) = state.filter(|_| by.is_finite()) {
                shift(part, state, by, &mut v[part.shape.variables.clone()]);
            }
        }
    }
}

/// By how much each variable has to move that is alone in a condition of a link at the first end of
/// its phase.
fn moves(link: &mut TranscribedLink, parameters: &[f64]) -> Vec<(usize, f64)> {
    let Some(first) = link.link.ends.iter().position(|end| matches!(end, End::First(_))) else {
        return Vec::new();
    };
    link.newton_moves(first, parameters)
}

/// Moves the guess of a state, as a whole or at its start only.
fn shift(part: &Part, state: usize, by: f64, v: &mut [f64]) {
    let (nlp, stages) = (&part.nlp, part.nlp.chain());
    let is_line = match nlp.problem().start_guesses[state] {
        StartGuess::Known => return,
        StartGuess::Unknown => false,
        StartGuess::BeforeEnd => true,
    };
    let slots = nlp.interval().slots.iter().enumerate();
    for (place, slot) in slots.filter(|(_, slot)| slot.signal == Signal::State(state)) {
        let last = stages.intervals + usize::from(place < stages.states);
        for k in 0..last {
            let tau = nlp.mesh().at(k, slot.time);
            let part = if is_line { 1.0 - tau } else { 1.0 };
            v[place + k * stages.variable_step()] += part * by;
        }
    }
}
