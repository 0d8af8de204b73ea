//! Checks before a solve: the model is evaluated with its numbers at some times along the guess.
//!
//! A guess is no solution, so a finding gives its numbers and is never an error.

mod layer;
mod outside;
mod room;
mod scales;
mod step;
mod sweep;

use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::model::guess::over_time;
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Model, Symbol};
use crate::syntax::{scope, text};
use crate::units;
use fdcc_grammar::ast::{self, Expr, ExprKind, Item, ItemKind, Setting, SettingValue, Unit};
use fdcc_grammar::{Diagnostic, Span};

/// Times at which the guess is looked at.
const TIMES: usize = 33;

/// A model, its numbers and its guess.
struct Preflight<'m> {
    model: &'m Model,
    tree: &'m ast::Model,
    numbers: Numbers,
    /// The model's graph, which grows by derivatives.
    graph: Graph,
    /// For each time, the value of every symbol; NaN for what is no signal.
    points: Vec<Vec<f64>>,
    /// From the first time to the last.
    duration: f64,
}

/// The last width of the smoothing, where the model names one.
struct Sigma {
    /// In SI.
    width: f64,
    /// The SI value of the unit it is written in.
    scale: f64,
    /// The unit as it is written, with a blank before it.
    unit: String,
    /// Where it stands.
    span: Span,
}

impl Sigma {
    /// A width in the unit in which this one is written.
    fn text(&self, width: f64) -> String {
        format!("{}{}", text::number(layer::short(width / self.scale)), self.unit)
    }
}

/// All findings about a model without errors.
pub(crate) fn check(model: &Model, tree: &ast::Model) -> Vec<Diagnostic> {
    let Some(mut preflight) = Preflight::new(model, tree) else { return Vec::new() };
    let mut found = Vec::new();
    outside::check(&preflight, &mut found);
    scales::check(&preflight, &mut found);
    room::check(&preflight, &mut found);
    step::check(&mut preflight, &mut found);
    sweep::check(&mut preflight, &mut found);
    found
}

impl<'m> Preflight<'m> {
    /// Nothing can be said of several phases, nor without the values of all parameters.
    fn new(model: &'m Model, tree: &'m ast::Model) -> Option<Self> {
        if model.states.is_empty()
            || tree.items.iter().any(|item| matches!(item.kind, ItemKind::Phase { .. }))
        {
            return None;
        }
        let numbers = numbers(model).ok()?;
        let [first, last] = model.interval.map(|end| numbers.value(model, end));
        let duration = last - first;
        let graph = model.graph.clone();
        let mut preflight = Preflight { model, tree, numbers, graph, points: Vec::new(), duration };
        if duration.is_finite() && duration > 0.0 {
            preflight.points = preflight.along_the_guess(first);
        }
        Some(preflight)
    }

    fn along_the_guess(&mut self, first: f64) -> Vec<Vec<f64>> {
        let (roots, symbols) = over_time(self.model, &mut self.graph, first, self.duration);
        let known = |symbol: &Symbol| match symbol {
            Symbol::Param(_) | Symbol::Free(_) => self.numbers.of(*symbol),
            Symbol::Selector(_) => 0.0,
            _ => f64::NAN,
        };
        let known: Vec<f64> = self.model.symbols.iter().map(known).collect();
        let time = self.model.input_of(Symbol::Time);
        let at = |step: usize| {
            let mut inputs = known.clone();
            if let Some(time) = time {
                inputs[time as usize] = first + self.duration * step as f64 / (TIMES - 1) as f64;
            }
            let values = evaluate(&self.graph, &roots, &inputs, &[]);
            symbols.iter().zip(values).for_each(|(input, value)| inputs[*input as usize] = value);
            inputs
        };
        (0..TIMES).map(at).collect()
    }

    /// The values of an expression along the guess.
    fn along(&self, value: ExprId) -> Vec<f64> {
        self.points.iter().map(|inputs| evaluate(&self.graph, &[value], inputs, &[])[0]).collect()
    }

    /// The settings as they are written.
    fn setting(&self, key: &str) -> Option<&'m Setting> {
        let settings = self.tree.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Method { settings } => Some(settings),
            _ => None,
        });
        settings.flatten().find(|setting| setting.key.name == key)
    }

    /// The width that the run ends with.
    fn sigma(&self) -> Option<Sigma> {
        let (model, method) = (self.model, &self.model.method);
        let (setting, width) = match self.setting("sigma") {
            Some(setting) => (setting, method.sigma?),
            None => (self.setting("continue")?, *method.continuation.last()?),
        };
        let unit = match &setting.value {
            SettingValue::Expr(Expr { kind: ExprKind::Quantity(_, unit), .. }) => Some(unit),
            SettingValue::List(values) => match values.last().map(|it| &it.kind) {
                Some(ExprKind::Quantity(_, unit)) => Some(unit),
                _ => setting.unit.as_ref(),
            },
            _ => setting.unit.as_ref(),
        };
        // A plain number is in the unit of what is smoothed.
        let own = model.width_unit.as_ref().map_or(1.0, |it| it.unit.scale);
        let scale = unit.map_or(own, |unit| units::scale(unit, &mut Vec::new()));
        let unit = unit.map_or(String::new(), |unit| format!(" {}", text::unit(unit)));
        Some(Sigma { width, scale, unit, span: span(setting) })
    }

    /// The declaration of a name; `pos.x` is declared by `pos`.
    fn declaration(&self, name: &str) -> Option<&'m Item> {
        let name = name.split(['.', '[']).next()?;
        let declares = |item: &&Item| scope::declared(item).is_some_and(|own| own.name == name);
        self.tree.items.iter().find(declares)
    }

    /// The unit of a declared name.
    fn unit(&self, name: &str) -> Option<&'m Unit> {
        scope::unit(self.declaration(name)?)
    }
}

/// A setting from its key to its unit.
fn span(setting: &Setting) -> Span {
    let value = match &setting.value {
        SettingValue::Expr(value) => value.span,
        SettingValue::List(values) => {
            values.iter().map(|value| value.span).fold(setting.key.span, Span::to)
        }
        SettingValue::Scheme { name, lagged } => lagged.last().unwrap_or(name).span,
    };
    let end = setting.unit.as_ref().map_or(value, |unit| unit.span);
    setting.key.span.to(value).to(end)
}
