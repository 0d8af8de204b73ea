//! FDC0402: a duration that the optimiser may choose must stay above 0.
//!
//! Where both ends are chosen, or those of a phase, that is a condition of the problem, and only
//! the guess has to meet it.
//!
//! With `D = tf - t0` affine in the unknowns, its least value over their bounds is
//! `D(0) + sum_i min(c_i lower_i, c_i upper_i)`. Where all `c_i` are above 0 the unknowns that may
//! be too small are told, otherwise the difference of both times.

use crate::check::facts::Facts;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::evaluate;
use crate::model::{Place, Symbol};
use crate::syntax::{text, walk};
use crate::units;
use fdcc_grammar::ast::{Expr, Ident, Interval, ItemKind, Sense, Unit};
use fdcc_grammar::{Code, Diagnostic, Fix};

/// Reports unknowns that may make the duration 0 or negative.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let meaning = &mut *facts.meaning;
    let is_free = |input: &u32| matches!(meaning.symbols[*input as usize], Symbol::Free(_));
    if !meaning.graph.inputs_of(&meaning.interval).iter().any(is_free) {
        return;
    }
    let duration = meaning.graph.sub(meaning.interval[1], meaning.interval[0]);
    let mut unknowns = Vec::new();
    let mut inputs: Vec<f64> = vec![0.0; meaning.symbols.len()];
    let mut guessed = inputs.clone();
    for at in 0..meaning.symbols.len() {
        match meaning.symbols[at] {
            Symbol::Param(index) => {
                inputs[at] = meaning.param_values[index];
                guessed[at] = inputs[at];
            }
            Symbol::Free(index) => unknowns.push((at as u32, index)),
            _ => {}
        }
    }
    let mut least = evaluate(&meaning.graph, &[duration], &inputs, &[])[0];
    let mut involved = Vec::new();
    for (input, index) in unknowns {
        let slope = derivative(&mut meaning.graph, duration, input);
        let slope = meaning.numeric(slope);
        let range = meaning.model.frees[index].range;
        let ends = [range.lower, range.upper].map(|end| meaning.numeric(end));
        let guess = meaning.model.frees[index].guess.map(|it| meaning.numeric(it));
        guessed[input as usize] = guess.unwrap_or(0.5 * (ends[0] + ends[1]));
        if slope != 0.0 {
            least += (slope * ends[0]).min(slope * ends[1]);
            involved.push((index, slope, ends));
        }
    }
    if least > 0.0 || least.is_nan() {
        return;
    }
    let at_guess = evaluate(&meaning.graph, &[duration], &guessed, &[])[0];
    let is_difference = involved.iter().any(|it| it.1 < 0.0);
    let is_condition = facts.phase.is_some() || is_difference && involved.len() > 1;
    if is_condition && at_guess > 0.0 {
        return;
    }
    if (is_condition || is_difference)
        && let Some(interval) = interval(facts)
    {
        let names = involved.iter().map(|it| &facts.meaning.model.frees[it.0].place);
        found.push(difference(interval, &names.collect::<Vec<_>>(), at_guess.min(least)));
        return;
    }
    for (index, slope, ends) in involved {
        // The end of its range that shortens the time is to blame.
        let worst = if slope > 0.0 { ends[0] } else { -ends[1] };
        if worst <= 0.0 {
            found.push(unbounded(facts, index, worst));
        }
    }
}

/// The first and the last time, as they are written.
fn interval<'a>(facts: &Facts<'a, '_>) -> Option<&'a Interval> {
    facts.items.iter().find_map(|item| match &item.kind {
        ItemKind::Time { interval, .. } => Some(interval),
        _ => None,
    })
}

/// No unknown is to blame where one is subtracted from the other.
fn difference(interval: &Interval, frees: &[&Place], least: f64) -> Diagnostic {
    let [first, last] = [&interval.lower, &interval.upper].map(text::expr);
    let what = if least == 0.0 { "0" } else { "0 or negative" };
    let message = format!("the duration from `{first}` to `{last}` may become {what}");
    let label = match least.is_finite() {
        true => format!("{} where the bounds make it shortest", text::number(least)),
        false => "no bounds keep it above 0".into(),
    };
    let found = Diagnostic::new(Code::NoDuration, message, interval.span, label);
    let found = frees.iter().fold(found, |found, it| found.label(it.span, "chosen in its bounds"));
    found.help(match frees {
        [one] => format!("give `{}` bounds that keep the last time after the first", one.name),
        _ => format!(
            "give both a `guess` with which `{last}` is after `{first}`; or declare a duration \
             above 0, such as `free D in [0.1, 10]`, and write the time over \
             `[{first}, {first} + D]`"
        ),
    })
}

fn unbounded(facts: &Facts<'_, '_>, index: usize, worst: f64) -> Diagnostic {
    let free = &facts.meaning.model.frees[index];
    let name = &free.place.name;
    let (message, label) = match worst {
        0.0 => (format!("free time `{name}` may become 0"), "may become 0"),
        _ if worst.is_finite() => {
            (format!("free time `{name}` may become negative"), "may become 0 or negative")
        }
        _ => (format!("free time `{name}` has no lower bound"), "may become 0 or negative"),
    };
    let mut found = Diagnostic::new(Code::NoDuration, message, free.place.span, label);
    if let Some(span) = objective(facts).and_then(|value| walk::mention(value, name)) {
        found = found.label(span, "and the objective pulls it down");
    }
    let Some(declared) = Declared::find(facts, index) else { return found };
    let repaired = declared.repaired(facts);
    found.fixes.push(declared.fix(facts, &repaired));
    found.help(format!("give it a range that excludes 0, for example `{repaired}`"))
}

/// What is minimised.
fn objective<'a>(facts: &Facts<'a, '_>) -> Option<&'a Expr> {
    facts.tree.items.iter().find_map(|item| match &item.kind {
        ItemKind::Objective { sense: Sense::Minimize, value, .. } => Some(value),
        _ => None,
    })
}

/// The declaration of an unknown.
struct Declared<'a> {
    free: usize,
    name: &'a Ident,
    bounds: Option<&'a Interval>,
    unit: Option<&'a Unit>,
}

impl<'a> Declared<'a> {
    fn find(facts: &Facts<'a, '_>, free: usize) -> Option<Self> {
        let wanted = &facts.meaning.model.frees[free].place.name;
        let declared = facts.tree.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Free { name, bounds, unit, .. } => {
                Some(Declared { free, name, bounds: bounds.as_ref(), unit: unit.as_ref() })
            }
            _ => None,
        });
        declared.into_iter().find(|it| it.name.name == *wanted)
    }

    /// `free T in [0.1, 60] [s] guess 6`, as its author would write it.
    fn repaired(&self, facts: &Facts<'_, '_>) -> String {
        let unit = self.unit.map_or(String::new(), |unit| format!(" {}", text::unit(unit)));
        let text = format!(
            "free {} in [{}, {}]{unit}",
            self.name.name,
            self.least(facts),
            text::number(self.longest(facts))
        );
        self.guess(facts)
            .map_or(text.clone(), |guess| format!("{text} guess {}", text::number(guess)))
    }

    /// The range where there is none, or the lower bound that is not above 0.
    fn fix(&self, facts: &Facts<'_, '_>, repaired: &str) -> Fix {
        let fix = Fix::likely(format!("write `{repaired}`"));
        let (least, longest) = (self.least(facts), text::number(self.longest(facts)));
        match self.bounds {
            None => fix.insert(self.name.span.end, format!(" in [{least}, {longest}]")),
            Some(bounds) => fix.replace(bounds.lower.span, least),
        }
    }

    /// A tenth, unless that is too long.
    fn least(&self, facts: &Facts<'_, '_>) -> String {
        text::number(0.1_f64.min(self.longest(facts) / 100.0))
    }

    /// The upper bound; or ten times the guess, which should be long enough.
    fn longest(&self, facts: &Facts<'_, '_>) -> f64 {
        let upper = self
            .in_its_unit(facts.meaning.numeric(facts.meaning.model.frees[self.free].range.upper));
        if upper.is_finite() {
            upper
        } else {
            self.guess(facts).map_or(100.0, |guess| 10.0 * guess)
        }
    }

    fn guess(&self, facts: &Facts<'_, '_>) -> Option<f64> {
        let guess = facts.meaning.model.frees[self.free].guess?;
        Some(self.in_its_unit(facts.meaning.numeric(guess))).filter(|guess| *guess > 0.0)
    }

    fn in_its_unit(&self, value: f64) -> f64 {
        self.unit.map_or(value, |unit| value / units::scale(unit, &mut Vec::new()))
    }
}
