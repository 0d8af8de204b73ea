//! FDC0401: bounds that contradict each other, a start outside its bounds, or time that runs
//! backwards.

use crate::check::facts::Facts;
use crate::expressions::graph::{Expr as Node, ExprId};
use crate::model::{Range, State, Symbol};
use crate::resolve::elaborator::Elaborator;
use crate::syntax::{scope, text};
use crate::units;
use fdcc_grammar::ast::{self, Ident, Interval, Item, ItemKind, Start};
use fdcc_grammar::{Code, Diagnostic, Edit, Fix, Label, Span};

/// Relative to the sizes of the bounds, whatever their unit: a start of `0.1 + 0.2` is not above
/// 0.3. A bound of `1e-10` beside one of 1 still counts.
const ROUNDING: f64 = 1e-13;

/// Reports all of them together: they have one cause, a typo, and one repair.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let mut mistakes =
        Mistakes { labels: Vec::new(), repairs: Vec::new(), swap: Fix::certain("swap the bounds") };
    for item in &facts.items {
        look(facts.meaning, item, &mut mistakes);
    }
    rows(facts.meaning, &mut mistakes);
    let mut labels = mistakes.labels.into_iter();
    if let Some(first) = labels.next() {
        let mut diagnostic = Diagnostic::new(
            Code::EmptyBounds,
            "these bounds leave no room",
            first.span,
            first.text,
        );
        diagnostic.labels.extend(labels);
        diagnostic.fixes.extend(Some(mistakes.swap).filter(|swap| !swap.edits.is_empty()));
        found.push(diagnostic.help(mistakes.repairs.join("\n")));
    }
}

/// What has been found so far, as one diagnostic will say it.
struct Mistakes {
    labels: Vec<Label>,
    repairs: Vec<String>,
    swap: Fix,
}

fn look(meaning: &Elaborator<'_>, item: &Item, mistakes: &mut Mistakes) {
    let first =
        crate::syntax::scope::declared(item).and_then(|name| meaning.scope.find(&name.name));
    let Some(index) = first.filter(|&at| std::ptr::eq(meaning.scope.declarations[at].item, item))
    else {
        return;
    };
    if let ItemKind::Time { interval, .. } = &item.kind {
        return backwards(meaning, interval, scale(item), mistakes);
    }
    let Some(index) = meaning.index_of(index) else { return };
    let scale = scale(item);
    match &item.kind {
        ItemKind::Control { name, bounds: Some(bounds), parts, .. } => {
            let ranges =
                meaning.model.controls[index..].iter().take(parts.len().max(1)).map(|it| it.range);
            reversed(meaning, ("control", name, scale), bounds, ranges, mistakes)
        }
        ItemKind::Free { name, bounds: Some(bounds), .. } => reversed(
            meaning,
            ("free", name, scale),
            bounds,
            [meaning.model.frees[index].range],
            mistakes,
        ),
        ItemKind::Param { name, value, bounds: Some(bounds), .. } => {
            let range = meaning.model.params[index].range;
            reversed(meaning, ("param", name, scale), bounds, [range], mistakes);
            if let Some(value) = value {
                let subject = Subject { name: &name.name, verb: "is", span: value.span, scale };
                outside(meaning, subject, meaning.param_values[index], range, mistakes);
            }
        }
        ItemKind::State { name, bounds, start, parts, .. } => {
            let states =
                meaning.model.states.get(index..index + parts.len().max(1)).unwrap_or_default();
            if let Some(bounds) = bounds {
                reversed(
                    meaning,
                    ("state", name, scale),
                    bounds,
                    states.iter().map(|it| it.range),
                    mistakes,
                );
            }
            match start {
                Some(Start::Value(value)) => starts(meaning, states, (value.span, scale), mistakes),
                Some(Start::Free { bounds: Some(bounds), .. }) => {
                    starts_free(meaning, states, (bounds.span, scale), mistakes)
                }
                _ => {}
            }
        }
        _ => {}
    }
}

fn starts(
    meaning: &Elaborator<'_>,
    states: &[State],
    (span, scale): (Span, f64),
    mistakes: &mut Mistakes,
) {
    for state in states {
        let given = state.start.map_or(f64::NAN, |start| meaning.numeric(start));
        let subject = Subject { name: &state.place.name, verb: "starts", span, scale };
        outside(meaning, subject, given, state.range, mistakes);
    }
}

/// `start free in [2, 3]` of a state that is never so large.
fn starts_free(
    meaning: &Elaborator<'_>,
    states: &[State],
    (span, scale): (Span, f64),
    mistakes: &mut Mistakes,
) {
    for state in states {
        let Some([first, last]) = state.start_range.map(|it| numbers(meaning, it)) else {
            continue;
        };
        let [lower, upper] = numbers(meaning, state.range);
        // The end of the start's range that is nearest to the bounds.
        let nearest = if first > upper { first } else { last };
        if side([first, last], [lower, upper]).is_some() {
            let subject = Subject { name: &state.place.name, verb: "starts", span, scale };
            outside(meaning, subject, nearest, state.range, mistakes);
        }
    }
}

/// How many SI units one of the declared unit of an item is.
fn scale(item: &Item) -> f64 {
    units::unit_of(item).map_or(1.0, |unit| units::scale(unit, &mut Vec::new()))
}

/// Without the digits that going to SI and back leaves behind.
fn shown(value: f64) -> String {
    text::number(format!("{value:.13e}").parse().unwrap_or(value))
}

fn numbers(meaning: &Elaborator<'_>, range: Range) -> [f64; 2] {
    [meaning.numeric(range.lower), meaning.numeric(range.upper)]
}

fn reversed(
    meaning: &Elaborator<'_>,
    (word, name, scale): (&str, &Ident, f64),
    bounds: &Interval,
    ranges: impl IntoIterator<Item = Range>,
    mistakes: &mut Mistakes,
) {
    let bad = ranges
        .into_iter()
        .map(|range| numbers(meaning, range))
        .find(|[lower, upper]| lower > upper);
    if let Some([lower, upper]) = bad {
        let text = format!(
            "lower bound {} is above upper bound {}",
            shown(lower / scale),
            shown(upper / scale)
        );
        mistakes.labels.push(Label { span: bounds.span, text });
        let (lower, upper) = (text::expr(&bounds.lower), text::expr(&bounds.upper));
        mistakes.repairs.push(format!("swap them: `{word} {} in [{upper}, {lower}]`", name.name));
        let ends = [(bounds.lower.span, upper), (bounds.upper.span, lower)];
        mistakes.swap.edits.extend(ends.map(|(span, replacement)| Edit { span, replacement }));
    }
}

/// A value with bounds of its own.
struct Subject<'a> {
    name: &'a str,
    verb: &'static str,
    span: Span,
    /// How many SI units one of its unit is.
    scale: f64,
}

enum Side {
    Below,
    Above,
}

/// On which side of bounds all of a range lies, by more than rounding.
fn side([first, last]: [f64; 2], [lower, upper]: [f64; 2]) -> Option<Side> {
    let sizes = [first, last, lower, upper].map(f64::abs).into_iter().filter(|it| it.is_finite());
    let rounding = ROUNDING * sizes.fold(0.0, f64::max);
    match () {
        _ if first - upper > rounding => Some(Side::Above),
        _ if lower - last > rounding => Some(Side::Below),
        _ => None,
    }
}

fn outside(
    meaning: &Elaborator<'_>,
    subject: Subject<'_>,
    given: f64,
    range: Range,
    mistakes: &mut Mistakes,
) {
    let [lower, upper] = numbers(meaning, range);
    let (side, change, limit) = match side([given, given], [lower, upper]) {
        _ if lower > upper => return,
        Some(Side::Below) => ("below its own lower bound", "lower", lower),
        Some(Side::Above) => ("above its own upper bound", "raise", upper),
        None => return,
    };
    let [limit, given] = [limit, given].map(|it| shown(it / subject.scale));
    mistakes
        .labels
        .push(Label { span: subject.span, text: format!("{} {side} {limit}", subject.verb) });
    let other = if subject.verb == "starts" { "start at" } else { "give it" };
    mistakes
        .repairs
        .push(format!("for `{}`, {change} the bound to {given} or {other} {limit}", subject.name));
}

fn backwards(meaning: &Elaborator<'_>, interval: &Interval, scale: f64, mistakes: &mut Mistakes) {
    let [first, last] = meaning.interval.map(|end| meaning.numeric(end));
    if first >= last {
        let text =
            format!("ends at {}, but starts at {}", shown(last / scale), shown(first / scale));
        mistakes.labels.push(Label { span: interval.span, text });
        mistakes.repairs.push("give time a first value below its last".into());
    }
}

/// The unit that a state or a control is declared in, where a value is one.
fn unit_of<'a>(meaning: &Elaborator<'a>, value: ExprId) -> Option<&'a ast::Unit> {
    let Node::Input(input) = meaning.graph.expr(value) else { return None };
    let name = match meaning.symbols[*input as usize] {
        Symbol::State(at) | Symbol::AtStart(at) | Symbol::AtEnd(at) => {
            &meaning.model.states[at].place.name
        }
        Symbol::Control(at) => &meaning.model.controls[at].place.name,
        _ => return None,
    };
    let declared = meaning.scope.find(name.split('.').next().unwrap_or(name))?;
    scope::unit(meaning.scope.declarations[declared].item)
}

/// Conditions between constants that exclude each other.
fn rows(meaning: &Elaborator<'_>, mistakes: &mut Mistakes) {
    for row in meaning
        .model
        .path
        .iter()
        .chain(&meaning.model.boundary)
        .chain(meaning.model.at_times.iter().flat_map(|it| &it.rows))
    {
        let [lower, upper] = numbers(meaning, row.range);
        if lower > upper {
            let unit = unit_of(meaning, row.value);
            let [low, high] = [lower, upper].map(|it| units::in_words(it, unit));
            let text = format!("no number is both above {low} and below {high}");
            mistakes.labels.push(Label { span: row.place.span, text });
            mistakes.repairs.push(format!(
                "for `{}`, the left limit must be below the right one",
                row.place.name
            ));
        }
    }
}
