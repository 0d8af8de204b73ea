//! The vector of a `Dir` by itself: what happens where all of its components are 0.
//!
//! ```text
//! psi' = a + B s,   |s| <= 1        a: drift,  B: pull
//! S = (B + B^T)/2                   c_i = -S_ii - sum_(j != i) |S_ij|
//!
//! c_i >= 0           S has no positive eigenvalue (Gershgorin): never repelling
//! c_i > |a|          d . (a + B d) < 0 for every direction d: held
//! |a| > ||B||        0 is not in a + B s: passed through
//! -S_ii - ... > |a|  with -S for S: pushes away in every direction
//! ```
//!
//! Isotropic friction is `B = -c I`; there all of this is exact, and 0 is held if and only if `|a|
//! <= c`: the force that it takes lies in the ball.

use super::class::{Claims, Class, decide};
use super::local::Local;
use super::view::View;
use crate::expressions::graph::ExprId;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::interval::Claim;
use crate::model::{Ball, Symbol};

/// A vector and its rate where it is 0.
pub(crate) struct LocalBall {
    /// Its own graph.
    pub local: Local,
    /// `a`.
    pub drift: Vec<ExprId>,
    /// `B`, row by row.
    pull: Vec<Vec<ExprId>>,
}

impl LocalBall {
    /// Nothing if a rate is unknown, or not affine in the direction.
    pub fn new(view: &View<'_>, ball: &Ball) -> Option<LocalBall> {
        let mut local = Local::empty();
        let rates: Option<Vec<ExprId>> =
            ball.surfaces.clone().map(|at| local.add_surface(view, at)).collect();
        let rates = rates?;
        local.rows(view);
        let selectors: Vec<Option<u32>> =
            ball.surfaces.clone().map(|at| local.input_of(Symbol::Selector(at))).collect();
        let pull: Vec<Vec<ExprId>> = rates
            .iter()
            .map(|&rate| selectors.iter().map(|&it| slope(&mut local, rate, it)).collect())
            .collect();
        let is_own = |input: &u32| selectors.contains(&Some(*input));
        if pull.iter().any(|row| local.graph.inputs_of(row).iter().any(is_own)) {
            return None;
        }
        let zero = local.graph.number(0.0);
        let mut drift = |rate: &ExprId| {
            let rate = selectors.iter().fold(*rate, |rate, &it| local.with(rate, it, zero));
            local.on_surface(rate)
        };
        let drift = rates.iter().map(&mut drift).collect();
        Some(LocalBall { local, drift, pull })
    }

    /// `c`, if the force is the same in every direction.
    pub fn reach(&mut self) -> Option<ExprId> {
        let first = self.pull[0][0];
        let size = self.pull.len();
        let is_alike = |i: usize, j: usize| match i == j {
            true => self.pull[i][j] == first,
            false => self.local.graph.as_number(self.pull[i][j]) == Some(0.0),
        };
        let is_isotropic = (0..size).all(|i| (0..size).all(|j| is_alike(i, j)));
        is_isotropic.then(|| self.local.graph.neg(first))
    }

    /// What is proved about it.
    pub fn classify(&mut self) -> Class {
        let drift = self.drift.clone();
        let drift = self.squares(&drift);
        let onto = self.margins(-1.0);
        let away = self.margins(1.0);
        let most = match self.reach() {
            Some(reach) => self.squares(&[reach]),
            None => self.squares(&self.pull.concat()),
        };
        let beyond = self.difference(drift, most);
        let claims = Claims {
            crossed: vec![vec![(beyond, Claim::Positive)]],
            held: self.outweigh(&onto, drift),
            touched: vec![(beyond, Claim::NotNegative)],
            attracting: onto.iter().map(|&it| (it, Claim::NotNegative)).collect(),
            away: self.outweigh(&away, drift),
        };
        decide(&self.local, &claims)
    }

    /// `sign S_ii - sum |S_ij|` for every row.
    fn margins(&mut self, sign: f64) -> Vec<ExprId> {
        let size = self.pull.len();
        let margin = |i: usize| {
            let graph = &mut self.local.graph;
            let mut terms = vec![graph.scale(sign, self.pull[i][i])];
            for j in (0..size).filter(|&j| j != i) {
                let sum = graph.add(self.pull[i][j], self.pull[j][i]);
                let sum = graph.call(Builtin::Abs, &[sum]);
                terms.push(graph.scale(-0.5, sum));
            }
            let sum = graph.sum(&terms);
            self.local.normal(sum)
        };
        let mut margins: Vec<ExprId> = (0..size).map(margin).collect();
        margins.dedup();
        margins
    }

    /// That every margin is above the length of the drift, whose square is given.
    fn outweigh(&mut self, margins: &[ExprId], drift: ExprId) -> Vec<(ExprId, Claim)> {
        let mut claims = Vec::new();
        for &margin in margins {
            let square = self.squares(&[margin]);
            claims.push((margin, Claim::Positive));
            claims.push((self.difference(square, drift), Claim::Positive));
        }
        claims
    }

    /// The sum of squares, as it stands: an interval sees that it is not negative.
    fn squares(&mut self, values: &[ExprId]) -> ExprId {
        let graph = &mut self.local.graph;
        let squares: Vec<ExprId> = values.iter().map(|&value| graph.square(value)).collect();
        graph.sum(&squares)
    }

    fn difference(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.local.graph.sub(a, b)
    }
}

/// The derivative by a selector, on the surface.
fn slope(local: &mut Local, rate: ExprId, selector: Option<u32>) -> ExprId {
    let slope = match selector {
        Some(input) => derivative(&mut local.graph, rate, input),
        None => local.graph.number(0.0),
    };
    local.on_surface(slope)
}
