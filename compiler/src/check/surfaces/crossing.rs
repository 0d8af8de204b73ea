//! FDC0304: a surface that is always crossed, at which nearby solutions drift apart.

use super::Subject;
use crate::expressions::graph::ExprId;
use crate::expressions::interval::Claim;
use crate::model::Symbol;
use crate::surfaces::class::for_some;
use fdcc_grammar::{Code, Diagnostic, Severity, Span};

impl Subject<'_, '_, '_> {
    /// If the jump is positive for some controls. A mere fact where no rate can vanish.
    pub(super) fn expanding(&mut self, strictly: bool) -> Option<Diagnostic> {
        let jump = self.local.jump;
        let mut prover = self.local.prover();
        let always = prover.proves(&self.local.graph, &[(jump, Claim::Positive)]);
        if !always && for_some(&self.local, &[(jump, Claim::Positive)]).is_none() {
            return None;
        }
        let message =
            format!("surface `{}` is crossed, but it is not one-sided Lipschitz", self.name());
        let span = self.place.map_or(self.declared(), |place| place.name);
        let [below, above] = [self.local.below, self.local.above].map(|rate| self.text(rate));
        let label =
            format!("rates {below} and {above} have one sign: the surface is always crossed");
        let mut found = Diagnostic::new(Code::NotContracting, message, span, label);
        let what = self.what_drifts();
        let jump_text = self.text(jump);
        if let (Some((condition, declared)), false) = (self.positive_for(jump), always) {
            let text = format!(
                "for {condition} the jump {jump_text} is positive, so two nearby {what} drift apart"
            );
            found = found.label(declared, text);
        }
        if strictly {
            found.severity = Severity::Advice;
            let help = format!(
                "nothing to change: the solution is unique, and the jump formula (3.6) is used, \
                 not (3.5).\n\
                 Across the surface the distance of two nearby {what} grows by the factor \
                 ({above})/({below})."
            );
            return Some(found.help(help));
        }
        let common = self.common_factor().unwrap_or_else(|| jump_text.clone());
        Some(found.help(format!(
            "the solution is still unique wherever {common} != 0. The jump formula (3.6) is used, \
             not (3.5).\n\
             At {common} == 0 on the surface nothing moves: add `path` or a bound to keep \
             `{common}` away from 0 there."
        )))
    }

    /// The condition on a control that makes the jump positive, and where the control is declared.
    fn positive_for(&mut self, jump: ExprId) -> Option<(String, Span)> {
        let (symbol, condition) = self.sign_of_jump(jump)?;
        let (declared, bounds) = self.control(&self.view.name(symbol))?;
        Some((condition, declared.to(bounds.span)))
    }

    /// The only control of the jump and where it makes it positive.
    fn sign_of_jump(&mut self, jump: ExprId) -> Option<(Symbol, String)> {
        let controls: Vec<u32> = self
            .local
            .graph
            .inputs_of(&[jump])
            .into_iter()
            .filter(|&at| matches!(self.local.symbols[at as usize], Symbol::Control(_)))
            .collect();
        let &[input] = controls.as_slice() else { return None };
        let symbol = self.local.symbols[input as usize];
        let name = self.view.name(symbol);
        let control = self.local.graph.input(input);
        let ratio = self.local.form(jump);
        let by = self.local.form(control);
        let ratio = ratio.divided(&by).and_then(|it| it.as_number());
        let condition = match ratio {
            Some(ratio) if ratio > 0.0 => format!("{name} > 0"),
            Some(_) => format!("{name} < 0"),
            None => format!("{} > 0", self.text(jump)),
        };
        Some((symbol, condition))
    }

    /// What both rates are multiples of.
    fn common_factor(&mut self) -> Option<String> {
        let [below, above] = [self.local.below, self.local.above].map(|rate| self.local.form(rate));
        let ratio = above.divided(&below)?;
        ratio.as_number()?;
        let lead = below.terms.values().next().copied()?;
        let factor = crate::expressions::polynomial::Polynomial::default().plus(1.0 / lead, &below);
        let factor = factor.to_expr(&mut self.local.graph);
        Some(self.text(factor))
    }

    /// What the states of the surface are, in a word.
    fn what_drifts(&self) -> &'static str {
        let is_speed = |name: &str| {
            let whole = name.split('.').next().unwrap_or(name);
            whole == "vel"
                || whole == "velocity"
                || whole == "speed"
                || whole.trim_start_matches('v').chars().all(|it| it.is_numeric() || it == '_')
        };
        let states = &self.local.gradient;
        if states.iter().all(|it| is_speed(&self.view.states[it.0].place.name)) {
            "speeds"
        } else {
            "states"
        }
    }
}
