//! Whether the jump of the right side is parallel to the gradient, and in which coordinates or
//! metric it is.
//!
//! ```text
//! M (f_above - f_below) = -c grad psi^T with c >= 0        Lemma 3.1, in the inner product of M
//! ```
//!
//! For a diagonal `M` the weights are `-g_i/j_i`. Where the gradient has other parts only because
//! the surface turns with other states, a frame that turns with it mends it: `psi` itself is one of
//! its velocities, the other is across.

use super::local::Local;
use super::view::View;
use crate::expressions::graph::ExprId;
use crate::expressions::polynomial::{Monomial, Polynomial};
use crate::model::Symbol;
use std::collections::{BTreeMap, BTreeSet};

/// In what the surface is one-sided Lipschitz.
pub(crate) enum Coordinates {
    /// In the states as they are, or in the metric that the model declares.
    Own,
    /// In a diagonal metric: states and weights.
    Metric(Vec<(usize, ExprId)>),
    /// With its own function as a coordinate in place of the only state that is acted on.
    Replaced(usize),
    /// In a frame that turns with the surface: the two velocities of the frame are `psi` and this
    /// one.
    Frame { across: ExprId },
    /// In none that was found.
    Unknown,
}

/// The jump of the right side against the gradient, both on the surface; states where one of them
/// is not 0.
pub(crate) struct Parts {
    /// State, gradient, jump.
    pub rows: Vec<(usize, Polynomial, Polynomial)>,
}

impl Parts {
    /// Of a surface whose sides are known.
    pub fn new(local: &mut Local) -> Self {
        let gradient: BTreeMap<usize, ExprId> = local.gradient.iter().copied().collect();
        let sides: BTreeMap<usize, [ExprId; 2]> = local.sides.iter().copied().collect();
        let states: BTreeSet<usize> = gradient.keys().chain(sides.keys()).copied().collect();
        let mut rows = Vec::new();
        for state in states {
            let slope = gradient.get(&state).copied();
            let slope = slope.map(|slope| local.on_surface(slope));
            let slope = slope.map_or(Polynomial::default(), |slope| local.form(slope));
            let jump = sides.get(&state).map(|ends| {
                let [below, above] = ends.map(|end| local.form(end));
                above.plus(-1.0, &below)
            });
            rows.push((state, slope, jump.unwrap_or_default()));
        }
        Parts { rows }
    }

    /// The states whose rates jump.
    pub fn moved(&self) -> Vec<usize> {
        self.rows.iter().filter(|row| !row.2.is_zero()).map(|row| row.0).collect()
    }

    /// The states that the gradient has, but the jump has not.
    pub fn turning(&self) -> Vec<usize> {
        self.rows
            .iter()
            .filter(|row| row.2.is_zero() && !row.1.is_zero())
            .map(|row| row.0)
            .collect()
    }
}

/// Finds out.
pub(crate) fn coordinates(local: &mut Local, view: &View<'_>, parts: &Parts) -> Coordinates {
    let all: Vec<&(usize, Polynomial, Polynomial)> = parts.rows.iter().collect();
    let weights: Vec<Polynomial> =
        parts.rows.iter().map(|row| weight(local, view, row.0)).collect();
    if is_parallel(local, &all, &weights) {
        return Coordinates::Own;
    }
    metric(local, parts)
        .map(Coordinates::Metric)
        .or_else(|| replaced(parts).map(Coordinates::Replaced))
        .or_else(|| frame(local, view, parts).map(|across| Coordinates::Frame { across }))
        .unwrap_or(Coordinates::Unknown)
}

/// The weight of a state in the metric of the model.
fn weight(local: &mut Local, view: &View<'_>, state: usize) -> Polynomial {
    let declared = view.metric.iter().find(|it| it.0 == state).map(|it| it.1);
    match declared {
        Some(weight) => {
            let weight = local.import(view, weight);
            local.form(weight)
        }
        None => Polynomial::number(1.0),
    }
}

/// Whether `w_i j_i g_k = w_k j_k g_i` for all pairs.
fn is_parallel(
    local: &mut Local,
    rows: &[&(usize, Polynomial, Polynomial)],
    weights: &[Polynomial],
) -> bool {
    let mut is_zero = |i: usize, k: usize| -> Option<bool> {
        let left = weights[i].times(&rows[i].2)?.times(&rows[k].1)?;
        let right = weights[k].times(&rows[k].2)?.times(&rows[i].1)?;
        let difference = left.plus(-1.0, &right).to_expr(&mut local.graph);
        let difference = local.on_surface(difference);
        Some(local.form(difference).is_zero())
    };
    (1..rows.len()).all(|k| (0..k).all(|i| is_zero(i, k) == Some(true)))
}

/// Weights `-g_i/j_i` without what they have in common, if all of them are constant and positive.
fn metric(local: &mut Local, parts: &Parts) -> Option<Vec<(usize, ExprId)>> {
    let weights: Vec<(Monomial, f64)> =
        parts.rows.iter().map(|row| ratio(&row.1, &row.2)).collect::<Option<_>>()?;
    let atoms: BTreeSet<ExprId> =
        weights.iter().flat_map(|it| &it.0).map(|power| power.0).collect();
    let is_constant = |atom: &ExprId| {
        local
            .graph
            .inputs_of(&[*atom])
            .iter()
            .all(|&at| matches!(local.symbols[at as usize], Symbol::Param(_)))
            && local.prover().range(&local.graph, *atom).is_positive()
    };
    let power = |monomial: &Monomial, atom: ExprId| {
        monomial.iter().find(|it| it.0 == atom).map_or(0, |it| it.1)
    };
    let common = |atom: &ExprId| {
        let least = weights.iter().map(|it| power(&it.0, *atom)).min().unwrap_or(0);
        (*atom, -least)
    };
    let lifted: Monomial = atoms.iter().map(common).filter(|power| power.1 != 0).collect();
    let first = weights.first()?.1;
    let scaled: Vec<Polynomial> = weights
        .iter()
        .map(|(monomial, factor)| {
            Polynomial::product(monomial.clone()).scaled(factor / first, &lifted)
        })
        .collect();
    let left: BTreeSet<ExprId> =
        scaled.iter().flat_map(|it| it.terms.keys()).flatten().map(|it| it.0).collect();
    let fits = weights.iter().all(|it| it.1 > 0.0) && left.iter().all(is_constant);
    let named = |(row, form): (&(usize, Polynomial, Polynomial), Polynomial)| {
        (row.0, form.to_expr(&mut local.graph))
    };
    fits.then(|| parts.rows.iter().zip(scaled).map(named).collect())
}

/// `-gradient/jump`, if it is a single term.
fn ratio(gradient: &Polynomial, jump: &Polynomial) -> Option<(Monomial, f64)> {
    let ((above, size), (below, by)) = (gradient.as_term()?, jump.as_term()?);
    let inverse: Monomial = below.iter().map(|&(atom, power)| (atom, -power)).collect();
    let quotient = Polynomial::product(above.clone()).scaled(-size / by, &inverse);
    let (monomial, factor) = quotient.as_term()?;
    Some((monomial.clone(), factor))
}

/// The only state that is acted on, if the function moves with it everywhere.
fn replaced(parts: &Parts) -> Option<usize> {
    let mut moved = parts.rows.iter().filter(|row| !row.2.is_zero());
    let (state, slope, _) = moved.next()?;
    let is_alone = moved.next().is_none();
    (is_alone && slope.as_number().is_some_and(|slope| slope != 0.0)).then_some(*state)
}

/// The other velocity of a frame: the jump is parallel to the gradient in two components of one
/// vector, where the gradient is of length 1 and does not depend on that vector.
fn frame(local: &mut Local, view: &View<'_>, parts: &Parts) -> Option<ExprId> {
    let moved: Vec<&(usize, Polynomial, Polynomial)> =
        parts.rows.iter().filter(|row| !row.2.is_zero()).collect();
    let [first, second] = moved.as_slice() else { return None };
    let ones = [Polynomial::number(1.0), Polynomial::number(1.0)];
    if parts.turning().is_empty()
        || vector(view, first.0) != vector(view, second.0)
        || !is_parallel(local, &moved, &ones)
    {
        return None;
    }
    let squares = [first, second].map(|row| row.1.times(&row.1));
    let [Some(one), Some(other)] = squares else { return None };
    let length = one.plus(1.0, &other).to_expr(&mut local.graph);
    let inputs = [first.0, second.0].map(|state| local.input_of(Symbol::State(state)));
    let [Some(x), Some(y)] = inputs else { return None };
    let slopes = [&first.1, &second.1].map(|form| form.to_expr(&mut local.graph));
    let turns_with_them = local.graph.inputs_of(&slopes).iter().any(|input| [x, y].contains(input));
    if turns_with_them || local.form(length).as_number() != Some(1.0) {
        return None;
    }
    // n = (n_x, n_y), t = (n_y, -n_x): v_t = n_y x - n_x y
    let [x, y] = [x, y].map(|input| local.graph.input(input));
    let (left, right) = (local.graph.mul(slopes[1], x), local.graph.mul(slopes[0], y));
    Some(local.graph.sub(left, right))
}

/// The name of the vector that a state is a component of.
pub(crate) fn vector<'v>(view: &'v View<'_>, state: usize) -> &'v str {
    let name = &view.states[state].place.name;
    name.split('.').next().unwrap_or(name)
}
