//! A requirement that does not hold, with the dimensions of its sides as they were found.

pub(super) mod messages;
mod repairs;
pub(super) mod suspects;

use super::dimension::ratio::Ratio;
use super::dimension::{Atom, Dimension};
use super::inference::Inference;
use super::inference::requirement::{Requirement, Side};
use super::inference::solve::Solution;
use fdcc_grammar::ast::{Ident, Item};

/// A name that was given as a plain number and stands in a side.
#[derive(Clone, Copy)]
pub(crate) struct Culprit<'a> {
    /// The name.
    pub name: &'a Ident,
    /// Its declaration.
    pub item: &'a Item,
    /// Its power.
    pub power: Ratio,
}

/// A requirement that does not hold.
pub(crate) struct Mistake<'a> {
    /// With what its sides turned out to measure; where that is not known, with the unknown left
    /// out.
    pub requirement: Requirement<'a>,
    /// The plain numbers in the left and in the right side.
    pub culprits: [Vec<Culprit<'a>>; 2],
}

impl<'a> Mistake<'a> {
    pub fn new(
        requirement: &Requirement<'a>,
        inference: &Inference<'a>,
        solution: &Solution,
    ) -> Self {
        let sides = [&requirement.left, &requirement.right];
        let culprits = sides.map(|side| culprits(&side.dimension, inference, solution));
        let [left, right] = sides.map(|side| found(&without_stretch(side, inference), solution));
        Mistake { requirement: Requirement { left, right, ..requirement.clone() }, culprits }
    }
}

/// The side without what stretches a guessed curve.
fn without_stretch<'a>(side: &Side<'a>, inference: &Inference<'a>) -> Side<'a> {
    let is_stretch = |atom: Atom| match atom {
        Atom::Number(at) => inference.numbers[at as usize].declared.is_none(),
        _ => false,
    };
    let stretch = side.dimension.factors().iter().map(|it| it.0).find(|&atom| is_stretch(atom));
    let rest = stretch.and_then(|atom| side.dimension.substituted(atom, &Dimension::none()));
    Side { dimension: rest.unwrap_or_else(|| side.dimension.clone()), ..side.clone() }
}

fn found<'a>(side: &Side<'a>, solution: &Solution) -> Side<'a> {
    let dimension = solution.settled(&side.dimension).unwrap_or_default();
    let mut open = dimension.factors().iter().filter(|it| !matches!(it.0, Atom::Base(_)));
    let known = open.try_fold(dimension.clone(), |known, &(atom, _)| {
        known.substituted(atom, &Dimension::none())
    });
    Side { dimension: known.unwrap_or_default(), ..side.clone() }
}

fn culprits<'a>(
    side: &Dimension,
    inference: &Inference<'a>,
    solution: &Solution,
) -> Vec<Culprit<'a>> {
    let form = solution.reduced(side).unwrap_or_default();
    let culprit = |&(atom, power): &(Atom, Ratio)| match atom {
        Atom::Number(at) if solution.is_plain(at) => inference.numbers[at as usize]
            .declared
            .map(|(name, item)| Culprit { name, item, power }),
        _ => None,
    };
    form.factors().iter().filter_map(culprit).collect()
}
