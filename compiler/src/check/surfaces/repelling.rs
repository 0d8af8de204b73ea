//! FDC0302: both sides of a surface push away from it, so what leaves it is not determined.

use super::Subject;
use crate::model::Symbol;
use crate::surfaces::words::tidy;
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic, Severity};

impl Subject<'_, '_, '_> {
    /// For every control, or for the values of some that are given.
    pub(super) fn repelling(&mut self, choice: &[(Symbol, f64)]) -> Diagnostic {
        let name = self.name().to_string();
        let message = match choice.len() {
            0 => format!("surface `{name}` pushes solutions away on both sides"),
            _ => format!("surface `{name}` pushes solutions away on both sides for some controls"),
        };
        let (local, jump) = (&self.local, self.local.jump);
        let size = local.prover().range(&local.graph, jump);
        let is_number = tidy(size.lower) == tidy(size.upper);
        let size = if is_number { format!("+{}", number(tidy(size.lower))) } else { String::new() };
        let jump = self.text(jump);
        let jump = match (is_number, jump.parse::<f64>().is_ok()) {
            (true, true) => size,
            (true, false) => format!("{jump} = {size}"),
            (false, _) => jump,
        };
        let label = format!("jump across the surface: grad . (f_above - f_below) = {jump} > 0");
        let span = self.place.map_or(self.declared(), |place| place.term.span);
        let mut found = Diagnostic::new(Code::Repelling, message, span, label);
        found = self.about_controls(found, choice);
        match choice.is_empty() {
            true => found.fixes.extend(self.place.and_then(|place| place.flip())),
            false => found.severity = Severity::Warning,
        }
        found.help(self.repair())
    }

    /// Why no control can change it, or which value brings it about.
    fn about_controls(&mut self, mut found: Diagnostic, choice: &[(Symbol, f64)]) -> Diagnostic {
        let control = match choice.first() {
            Some(&(symbol, _)) => Some(symbol),
            None => self.first_control(),
        };
        let bounds = control.and_then(|symbol| self.control(&self.view.name(symbol)));
        let [below, above] = self.rates_text(choice);
        match (bounds, choice.is_empty()) {
            (Some((_, bounds)), true) => found.label(
                bounds.span,
                format!("no control can change this: rates are in {below} below and {above} above"),
            ),
            (Some((_, bounds)), false) => {
                let values: Vec<String> = choice
                    .iter()
                    .map(|&(symbol, value)| {
                        format!("{} = {}", self.view.name(symbol), number(value))
                    })
                    .collect();
                let at = values.join(", ");
                found.label(
                    bounds.span,
                    format!("for example at {at}: rates are {below} below and {above} above"),
                )
            }
            (None, _) => {
                found.labels[0].text += &format!("; rates are {below} below and {above} above");
                found
            }
        }
    }

    /// The first control that the rates depend on.
    fn first_control(&self) -> Option<Symbol> {
        let inputs = self.local.graph.inputs_of(&[self.local.below, self.local.above]);
        let mut symbols = inputs.into_iter().map(|at| self.local.symbols[at as usize]);
        symbols.find(|symbol| matches!(symbol, Symbol::Control(_)))
    }

    /// The rates on both sides as intervals, or as text where they have no bounds.
    fn rates_text(&mut self, choice: &[(Symbol, f64)]) -> [String; 2] {
        let mut domain = self.local.prover();
        for (symbol, value) in choice {
            if let Some(input) = self.local.input_of(*symbol) {
                domain.domain[input as usize] =
                    crate::expressions::interval::Interval::point(*value);
            }
        }
        [self.local.below, self.local.above].map(|rate| {
            let range = domain.range(&self.local.graph, rate);
            let [lower, upper] = [range.lower, range.upper].map(tidy);
            match range.is_bounded() {
                true if lower == upper => number(lower),
                true => format!("[{}, {}]", number(lower), number(upper)),
                false => self.text(rate),
            }
        })
    }

    fn repair(&self) -> String {
        let name = self.name();
        let friction = match self.place.and_then(|place| place.flipped()) {
            Some(equation) => format!(" For friction the sign is negative: `{equation}`."),
            None => String::new(),
        };
        let psi = if self.written().is_some() { name.to_string() } else { format!("({name})") };
        format!(
            "from `{name} == 0` the state may leave up, leave down or stay: the solution is not \
             unique \
             and no gradient exists.{friction}\n\
             If leaving the surface is intended, start off it and add `path away: {psi} >= eps`."
        )
    }
}
