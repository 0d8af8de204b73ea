//! What a surface does to trajectories that meet it, proved over the bounds or said to be unknown.
//!
//! ```text
//! below > 0 > above        held           below, above > 0 (or both < 0)     crossed
//! below < 0 < above        repelling      jump < 0 everywhere                never repelling
//! ```

use super::degenerate::degenerate;
use super::local::Local;
use super::sample;
use super::view::View;
use crate::expressions::graph::{ExprId, evaluate};
use crate::expressions::interval::{Claim, Interval};
use crate::model::Symbol;

/// What is proved about a surface, over all states on it within their bounds.
#[derive(Clone, Debug, PartialEq)]
pub enum Class {
    /// The bounds keep every state away from it.
    Apart,
    /// The rates on both sides have one sign; strictly, if neither can vanish.
    Crossed {
        /// Neither rate is ever 0.
        strictly: bool,
    },
    /// Both sides push onto it, whatever the control.
    Held,
    /// Its gradient vanishes on it, so nothing is decided there.
    Degenerate,
    /// The sides never push away from it; which of held and crossed it is depends on state and
    /// control.
    Attracting,
    /// Both sides push away from it, whatever the control.
    Repelling,
    /// Both sides push away from it for some controls.
    RepellingFor(Choice),
    /// None of these could be proved; whether there are states for which both sides push away.
    Unknown {
        /// There are such states.
        mixed: bool,
    },
}

/// Values for controls and unknowns.
pub type Choice = Vec<(Symbol, f64)>;

/// The class of a surface by itself, if everything about it is known.
pub(crate) fn class(view: &View<'_>, at: usize) -> Option<Class> {
    let mut local = Local::new(view, at)?;
    if degenerate(&mut local).is_some() {
        return Some(Class::Degenerate);
    }
    local.add_rates(view, at).then(|| classify(&mut local))
}

/// What must be proved for each class.
#[derive(Default)]
pub(crate) struct Claims {
    /// Each of them is enough to be crossed strictly.
    pub crossed: Vec<Vec<(ExprId, Claim)>>,
    /// All sides push onto it.
    pub held: Vec<(ExprId, Claim)>,
    /// Crossed, or both rates are 0.
    pub touched: Vec<(ExprId, Claim)>,
    /// No two sides push away from each other.
    pub attracting: Vec<(ExprId, Claim)>,
    /// All sides push away from it.
    pub away: Vec<(ExprId, Claim)>,
}

/// Finds the class of a surface with two sides.
pub(crate) fn classify(local: &mut Local) -> Class {
    use Claim::{Negative, NotNegative, Positive};
    let [below, above] = [local.below, local.above];
    let product = local.graph.mul(below, above);
    let product = local.normal(product);
    let fall = local.graph.neg(local.jump);
    let claims = Claims {
        crossed: [Positive, Negative].map(|sign| vec![(below, sign), (above, sign)]).to_vec(),
        held: vec![(below, Positive), (above, Negative)],
        touched: if below == above { Vec::new() } else { vec![(product, NotNegative)] },
        attracting: vec![(fall, NotNegative)],
        away: vec![(below, Negative), (above, Positive)],
    };
    decide(local, &claims)
}

/// The first class whose claims are proved. What a few points contradict is not even tried to be
/// proved.
pub(crate) fn decide(local: &Local, claims: &Claims) -> Class {
    let points = sample::points(local);
    if points.is_empty() && local.prover().proves(&local.graph, &[(local.psi, Claim::Nowhere)]) {
        return Class::Apart;
    }
    let proves = |claims: &Vec<(ExprId, Claim)>| {
        points.iter().all(|point| is_true(local, claims, point))
            && local.prover().proves(&local.graph, claims)
    };
    if claims.crossed.iter().any(proves) {
        return Class::Crossed { strictly: true };
    }
    if proves(&claims.held) {
        return Class::Held;
    }
    if proves(&claims.touched) {
        return Class::Crossed { strictly: false };
    }
    if proves(&claims.attracting) {
        return Class::Attracting;
    }
    // From here on the surface is accused of something, so there must be a point on it.
    match () {
        _ if points.is_empty() => Class::Unknown { mixed: false },
        _ if proves(&claims.away) => Class::Repelling,
        _ => for_some(local, &claims.away)
            .map_or_else(|| unknown(local, &claims.away, &points), Class::RepellingFor),
    }
}

/// Whether some of the points are pushed away from, by more than rounding.
fn unknown(local: &Local, away: &[(ExprId, Claim)], points: &[Vec<f64>]) -> Class {
    let roots: Vec<ExprId> = away.iter().map(|it| it.0).collect();
    let pushes_away = |point: &Vec<f64>| {
        let values = evaluate(&local.graph, &roots, point, &[]);
        values.iter().zip(away).all(|(value, it)| it.1.is_true(*value) && value.abs() > 1e-6)
    };
    Class::Unknown { mixed: points.iter().any(pushes_away) }
}

/// Whether claims are true at a point, as far as numbers can tell.
fn is_true(local: &Local, claims: &[(ExprId, Claim)], point: &[f64]) -> bool {
    let roots: Vec<ExprId> = claims.iter().map(|it| it.0).collect();
    let values = evaluate(&local.graph, &roots, point, &[]);
    values.iter().zip(claims).all(|(value, claim)| value.is_nan() || claim.1.is_true(*value))
}

/// Values of the controls for which claims hold for all states on the surface.
pub(crate) fn for_some(local: &Local, claims: &[(ExprId, Claim)]) -> Option<Choice> {
    let roots: Vec<ExprId> = claims.iter().map(|it| it.0).collect();
    let free = local.graph.inputs_of(&roots).into_iter();
    let chosen =
        |at: &u32| matches!(local.symbols[*at as usize], Symbol::Control(_) | Symbol::Free(_));
    let inputs: Vec<u32> = free.filter(chosen).collect();
    if inputs.is_empty() {
        return None;
    }
    let mut prover = local.prover();
    let choices =
        candidates(&inputs.iter().map(|&at| local.domain[at as usize]).collect::<Vec<_>>());
    choices.into_iter().find_map(|values| {
        let fixed: Vec<(u32, Interval)> =
            inputs.iter().zip(&values).map(|(&at, &value)| (at, Interval::point(value))).collect();
        let holds = prover.within(&fixed, |prover| prover.proves(&local.graph, claims));
        let named =
            inputs.iter().zip(values).map(|(&at, value)| (local.symbols[at as usize], value));
        holds.then(|| named.collect())
    })
}

/// Ends and middles: all combinations of a few, and those of one kind for many.
fn candidates(domains: &[Interval]) -> Vec<Vec<f64>> {
    let values: Vec<[f64; 3]> = domains
        .iter()
        .map(|it| {
            let end = |end: f64, other: f64| if end.is_finite() { end } else { other };
            [
                end(it.upper, it.lower.max(-1.0) + 2.0),
                end(it.lower, it.upper.min(1.0) - 2.0),
                it.middle(),
            ]
        })
        .collect();
    if values.len() > 3 {
        return (0..3).map(|kind| values.iter().map(|it| it[kind]).collect()).collect();
    }
    let mut all: Vec<Vec<f64>> = vec![Vec::new()];
    for choice in values {
        all = all
            .iter()
            .flat_map(|it| choice.map(|value| [it.as_slice(), &[value]].concat()))
            .collect();
    }
    all
}
