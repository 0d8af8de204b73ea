//! `integral(e)` outside of all phases: over the time of the phase that `e` reads, and over that of
//! all phases where it reads none.

use crate::expressions::graph::ExprId;
use crate::model::phases::Symbols;
use crate::model::{Place, Symbol};
use crate::resolve::elaborator::Elaborator;
use fdcc_grammar::{Code, Diagnostic};

impl Elaborator<'_> {
    /// The value of an integral; none after a mistake, which has been told.
    pub fn integral_of_phases(&mut self, integrand: ExprId, place: &Place) -> Option<ExprId> {
        let mut read: Vec<usize> = Vec::new();
        let mut is_unnamed = false;
        for input in self.graph.inputs_of(&[integrand]) {
            match self.symbols[input as usize] {
                Symbol::OfPhase { phase, .. } => read.push(phase),
                Symbol::Selector(at) => is_unnamed |= at >= self.surface_of.len(),
                _ => {}
            }
        }
        read.sort_unstable();
        read.dedup();
        if is_unnamed || read.len() > 1 {
            self.diagnostics.push(self.no_integral(&read, place));
            return None;
        }
        if read.is_empty() {
            read = (0..self.phases.len()).collect();
        }
        let terms: Vec<ExprId> =
            read.into_iter().map(|phase| self.integral_in(phase, integrand, place)).collect();
        Some(self.graph.sum(&terms))
    }

    fn integral_in(&mut self, phase: usize, integrand: ExprId, place: &Place) -> ExprId {
        let Elaborator { phases, graph, symbols, .. } = self;
        let meaning = &mut phases[phase].meaning;
        let mut own = Symbols { graph: &mut meaning.graph, symbols: &mut meaning.symbols };
        let integrand = own.take(graph, symbols, &[integrand])[0];
        let integral = meaning.integrated(integrand, place.clone());
        self.import(phase, &[integral])[0]
    }

    fn no_integral(&self, read: &[usize], place: &Place) -> Diagnostic {
        let names: Vec<String> =
            read.iter().map(|phase| format!("`{}`", self.phases[*phase].name.name)).collect();
        match names.len() > 1 {
            true => {
                let message = "an integral over the times of several phases";
                let label = format!("reads {}", names.join(" and "));
                Diagnostic::new(Code::NotAllowedHere, message, place.span, label)
                    .help("each phase has its own time: add up one integral for each of them")
            }
            false => {
                let message = "an unnamed surface outside of all phases";
                Diagnostic::new(Code::NotAllowedHere, message, place.span, "switches in no phase")
                    .help("give what switches a name by a `let` within its phase")
            }
        }
    }
}
