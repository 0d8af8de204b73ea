//! Units: gradual, inferred, checked.
//!
//! A text without any unit is never bothered. As soon as one is written, every name has a
//! dimension, written or to be found: each sum, comparison and equation is a linear equation
//! between exponents of units, and [`inference::solve`] finds what follows. A number without a unit
//! has none, except where it stands alone against something that has one: in a bound, a start, a
//! guess or a comparison it takes the unit of the other side.

mod dimension;
mod inference;
mod mistakes;
mod names;

use crate::syntax::text::number;
use dimension::Atom;
pub use dimension::Dimension;
use dimension::notation::Notation;
pub use dimension::quantity::{Quantity, parse_quantity};
pub(crate) use dimension::table::{names, scale};
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::{self, Unit};
pub(crate) use inference::readings::Readings;
use inference::requirement::Requirement;
use inference::walk::{Known, Walk};
use mistakes::messages::Speaker;
pub(crate) use mistakes::messages::unit_of;
use mistakes::{Mistake, suspects};
use names::Findings;
pub use names::{NamedUnit, WidthUnit};

/// Whoever has so many mistakes does not read on.
const MOST_MISTAKES: usize = 20;

/// A unit in SI and what it measures: `1 km = 1000 m, a length`.
pub(crate) fn described(name: &str) -> Option<String> {
    let (value, dimension) = dimension::table::named(name)?;
    let notation = Notation::new(&[]);
    let si = format!("1 {name} = {} {}", number(value), notation.unit(&dimension));
    Some(format!("{}, {}", si.trim_end(), notation.noun(&dimension)))
}

/// A number in SI in the unit in which its name is declared, which is told unless it is that of SI.
pub(crate) fn in_words(value: f64, unit: Option<&Unit>) -> String {
    let scaled = unit.map(|unit| (unit, scale(unit, &mut Vec::new()))).filter(|it| it.1 != 1.0);
    let Some((unit, scale)) = scaled else { return number(value) };
    // Without the digits that the change of units leaves behind.
    let shown = format!("{:.12e}", value / scale).parse().map_or(value / scale, |it: f64| it);
    format!("{} {}", number(shown), dimension::notation::written(unit))
}

/// What the text says about units.
#[derive(Default)]
pub(crate) struct Units {
    /// Every mistake once.
    pub diagnostics: Vec<Diagnostic>,
    /// The unit of each name, where it is known.
    pub names: Vec<NamedUnit>,
    /// The unit of each condition, by what the condition is called.
    pub conditions: Vec<NamedUnit>,
    /// What a width of smoothing measures.
    pub width: Option<WidthUnit>,
    /// By what each plain number of the text is multiplied.
    pub readings: Readings,
}

/// Reports every unit of an item that is not known.
pub(crate) fn unknown(item: &ast::Item, diagnostics: &mut Vec<Diagnostic>) {
    let mut written = Vec::new();
    inference::declare::units_in(item, &mut written);
    for unit in written {
        scale(unit, diagnostics);
    }
}

/// Finds the unit of every name, and every place where units do not fit together.
pub(crate) fn infer(tree: &ast::Model) -> Units {
    let mut written: Vec<&Unit> = Vec::new();
    tree.items.iter().for_each(|item| inference::declare::units_in(item, &mut written));
    if written.is_empty() {
        return Units::default();
    }
    let speaker = Speaker { tree, notation: Notation::new(&written) };
    let mut known = Known::default();
    let mut mistakes: Vec<Mistake<'_>> = Vec::new();
    loop {
        let found = suspects::found(tree, &known, Walk::new(tree, known.clone(), false));
        let Walk { inference, solution, .. } = &found.walk;
        if found.mistakes.is_empty() || mistakes.len() >= MOST_MISTAKES {
            let findings = Findings { inference, solution, notation: &speaker.notation };
            let mut diagnostics = told(&speaker, known, &mistakes);
            diagnostics.extend(inference::readings::found(inference, solution, &speaker.notation));
            diagnostics.extend(inference::columns::found(inference, solution));
            let names = findings.names(&tree.items);
            let conditions = findings.conditions(&tree.items, &names);
            let readings = inference.readings.clone();
            let width = findings.width();
            return Units { names, conditions, width, diagnostics, readings };
        }
        for at in found.mistakes {
            let mistake = Mistake::new(&inference.requirements[at], inference, solution);
            known.wrong.insert(mistake.requirement.site);
            mistakes.push(mistake);
        }
        known.suspects.extend(found.suspect);
        mistakes.truncate(MOST_MISTAKES);
    }
}

/// All findings. A last walk asks what the surroundings of each wrong text need.
fn told<'a>(speaker: &Speaker<'a>, known: Known, mistakes: &[Mistake<'a>]) -> Vec<Diagnostic> {
    if mistakes.is_empty() {
        return Vec::new();
    }
    let Walk { inference, solution, .. } = Walk::new(speaker.tree, known, true);
    let wanted = |it: &Requirement<'a>| {
        let freed = inference.freed.get(&it.site);
        let needed = freed.and_then(|&at| solution.settled(&Dimension::atom(Atom::Unknown(at))));
        needed.is_some_and(|needed| needed == it.left.dimension)
    };
    mistakes.iter().map(|it| speaker.diagnostic(it, wanted(&it.requirement))).collect()
}
