//! The tape while it is made.

use crate::simulate::field::Field;
use crate::simulate::location::touch::touches;
use crate::simulate::result::Event;
use crate::simulate::steps::{Step, departure, radau};
use crate::simulate::tape::{Cause, Change, Instant, Piece, Regime, Rule, Tape};

impl Rule {
    /// The nodes of an implicit rule.
    fn implicit_nodes(self) -> &'static [f64] {
        match self {
            Rule::Explicit | Rule::Straight => &[],
            Rule::Radau => radau::C,
            Rule::Collocation => departure::FINE,
        }
    }
}

/// A tape on its way; without a tape nothing is noted.
pub(crate) struct Writer {
    tape: Option<Tape>,
    stop: Option<(Cause, Instant)>,
    changes: Vec<Change>,
}

impl Writer {
    pub fn new(is_wanted: bool) -> Self {
        Writer { tape: is_wanted.then(Tape::default), stop: None, changes: Vec::new() }
    }

    pub fn finish(self) -> Option<Tape> {
        self.tape
    }

    /// The place of the regime of a field; a new one only where something has changed.
    fn regime(&mut self, field: &Field) -> usize {
        let Some(tape) = &mut self.tape else { return 0 };
        let now = || (&field.modes, &field.held, field.segment);
        let is_last = |last: &Regime| (&last.modes, &last.held, last.segment) == now();
        if !tape.regimes.last().is_some_and(is_last) {
            let (modes, held, segment) = now();
            tape.regimes.push(Regime { modes: modes.clone(), held: held.clone(), segment });
        }
        tape.regimes.len() - 1
    }

    fn instant(&mut self, field: &mut Field, time: f64, state: &[f64]) -> Instant {
        let regime = self.regime(field);
        Instant { time, state: state.to_vec(), selectors: field.selectors_at(time, state), regime }
    }

    fn push(&mut self, piece: Piece) {
        if let Some(tape) = &mut self.tape {
            tape.pieces.push(piece);
        }
    }

    /// A step, or its beginning of length `h`.
    pub fn step(&mut self, field: &mut Field, step: &Step, h: f64, end: &[f64]) {
        if self.tape.is_some() {
            let start = self.instant(field, step.t, &step.start);
            let at = |c: &f64| step.at(c * h / step.h);
            let stages = step.rule.implicit_nodes().iter().map(at).collect();
            let touches = touches(field, step, h / step.h);
            let end = end.to_vec();
            self.push(Piece::Step { start, h, end, rule: step.rule, stages, touches });
        }
    }

    /// A stop begins.
    pub fn open(&mut self, cause: Cause, field: &mut Field, time: f64, state: &[f64]) {
        if self.tape.is_some() {
            self.stop = Some((cause, self.instant(field, time, state)));
        }
    }

    /// Something happens at the stop.
    pub fn change(&mut self, field: &mut Field, event: &Event) {
        if self.tape.is_some() {
            let after = self.instant(field, event.time, &event.after);
            let Event { surface, kind, margin, .. } = *event;
            self.changes.push(Change { surface, kind, margin, after });
        }
    }

    /// The stop ends.
    pub fn close(&mut self, field: &mut Field, time: f64, state: &[f64]) {
        if let Some((cause, before)) = self.stop.take() {
            let after = self.instant(field, time, state);
            let changes = std::mem::take(&mut self.changes);
            self.push(Piece::Event { cause, before, after, changes });
        }
    }
}
