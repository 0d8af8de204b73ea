//! When a surface is held, in the words of the model.
//!
//! ```text
//! psi' = mean + s jump/2 = 0 has a solution s in [-1, 1]   if and only if   |mean| <= -jump/2
//! psi' = a - c s = 0         has a solution |s| <= 1       if and only if   |a| <= c
//! ```
//!
//! the first with `jump < 0`, the second for vectors.
//!
//! Both sides are multiplied by the positive denominators and by the number in front of the left
//! one, and a product is taken apart: `abs(s)*v_t^2 <= muN` for the race car.

use super::ball::LocalBall;
use super::local::Local;
use super::view::View;
use super::words::Words;
use crate::expressions::graph::{Expr, ExprId};
use crate::expressions::interval::Claim;
use crate::expressions::polynomial::{Monomial, NormalForms, Polynomial};
use crate::model::Symbol;
use std::collections::BTreeMap;

/// The condition, with names that are made up for it; nothing if it would be too long to read.
pub(crate) fn holding(
    local: &mut Local,
    view: &View<'_>,
    own: &[(String, ExprId)],
) -> Option<String> {
    let [below, above] = local.written;
    let sum = local.graph.add(below, above);
    let mut forms = NormalForms::with_squares();
    let mean = Polynomial::default().plus(0.5, &forms.of(&mut local.graph, sum));
    let jump = local.jump;
    let half = Polynomial::default().plus(-0.5, &forms.of(&mut local.graph, jump));
    let room = [1.0, -1.0].map(|sign| half.clone().plus(sign, &mean).to_expr(&mut local.graph));
    let room = room.map(|it| (local.on_surface(it), Claim::NotNegative));
    if local.prover().proves(&local.graph, &room) {
        return Some("always".into());
    }
    let factor = common_denominator(local, &[&mean, &half]);
    let number = mean.as_term().map_or(1.0, |term| 1.0 / term.1.abs());
    let (mean, half) = (mean.scaled(number, &factor), half.scaled(number, &factor));
    local.in_words(view, own, |local, words| {
        let left = absolute(local, words, &mean);
        let right = words.polynomial(&mut local.graph, &half, 0);
        let text = format!("{left} <= {right}");
        (text.chars().count() <= LONGEST).then_some(text)
    })
}

/// The same for the vector of a `Dir` that acts alike in every direction: `norm(F) <= mu*N`.
pub(crate) fn within_reach(ball: &mut LocalBall, view: &View<'_>) -> Option<String> {
    let reach = ball.reach()?;
    let drift = ball.drift.clone();
    let local = &mut ball.local;
    let mut forms = NormalForms::with_squares();
    let mut forms: Vec<Polynomial> =
        drift.iter().map(|&it| forms.of(&mut local.graph, it)).collect();
    forms.push(local.form(reach));
    let factor = common_denominator(local, &forms.iter().collect::<Vec<_>>());
    let sizes: Vec<f64> =
        forms[..drift.len()].iter().filter_map(|it| Some(it.as_term()?.1.abs())).collect();
    let is_alike = sizes.len() == drift.len() && sizes.iter().all(|size| *size == sizes[0]);
    let number = if is_alike { 1.0 / sizes[0] } else { 1.0 };
    local.in_words(view, &[], |local, words| {
        let scaled = forms.iter().map(|form| form.scaled(number, &factor));
        let mut texts: Vec<String> =
            scaled.map(|it| words.polynomial(&mut local.graph, &it, 0)).collect();
        let reach = texts.pop()?;
        let text = format!("norm({}) <= {reach}", vector(&texts, view));
        (text.chars().count() <= LONGEST).then_some(text)
    })
}

/// `F` for all of its parts, `(F.x, u)` for other numbers.
fn vector(parts: &[String], view: &View<'_>) -> String {
    let name = parts[0].split_once('.').map_or("", |it| it.0);
    let places =
        view.states.iter().map(|it| &it.place).chain(view.controls.iter().map(|it| &it.place));
    let all = places.filter(|place| place.name.split_once('.').is_some_and(|it| it.0 == name));
    match all.map(|place| &place.name).eq(parts) {
        true => name.to_string(),
        false => format!("({})", parts.join(", ")),
    }
}

const LONGEST: usize = 100;

/// The product of all parameters that stand below, and are positive.
fn common_denominator(local: &Local, forms: &[&Polynomial]) -> Monomial {
    let mut powers: BTreeMap<ExprId, i32> = BTreeMap::new();
    for &(atom, power) in forms.iter().flat_map(|form| form.terms.keys()).flatten() {
        if power < 0 && is_not_negative(local, atom) {
            let highest = powers.entry(atom).or_default();
            *highest = (*highest).max(-power);
        }
    }
    powers.into_iter().collect()
}

/// Whether an atom is a quantity that its bounds keep from being negative.
fn is_not_negative(local: &Local, atom: ExprId) -> bool {
    match local.graph.expr(atom) {
        Expr::Input(at) => {
            local.domain[*at as usize].lower >= 0.0 && local.symbols[*at as usize] != Symbol::Time
        }
        _ => local.prover().range(&local.graph, atom).lower >= 0.0,
    }
}

/// `abs(form)`, of a product factor by factor.
fn absolute(local: &mut Local, words: &Words<'_>, form: &Polynomial) -> String {
    let Some((rest, powers)) = words.as_product(&local.graph, form) else {
        let sign = if form.terms.values().all(|factor| *factor < 0.0) { -1.0 } else { 1.0 };
        return format!(
            "abs({})",
            words.polynomial(&mut local.graph, &form.scaled(sign, &Monomial::new()), 0)
        );
    };
    let (monomial, number) = rest.as_term().expect("what remains of a product is a single term");
    let number = Polynomial::number(number.abs());
    let mut factors = Vec::new();
    if number.as_number() != Some(1.0) {
        factors.push(words.polynomial(&mut local.graph, &number, 0));
    }
    let mut below = Vec::new();
    for &(atom, power) in monomial {
        let text = words.atom(&mut local.graph, atom, 0);
        let is_plain = power % 2 == 0 || is_not_negative(local, atom);
        let side = if power > 0 { &mut factors } else { &mut below };
        side.push(raised(&text, power.abs(), is_plain));
    }
    factors.extend(powers.iter().map(|&(name, power)| raised(name, power, power % 2 == 0)));
    let above = if factors.is_empty() { "1".into() } else { factors.join("*") };
    below.iter().fold(above, |text, it| format!("{text}/{it}"))
}

fn raised(text: &str, power: i32, is_plain: bool) -> String {
    let base = if is_plain { text.to_string() } else { format!("abs({text})") };
    if power == 1 { base } else { format!("{base}^{power}") }
}
