//! What a model declares: each with its place in the text, and its expressions.

use crate::expressions::graph::ExprId;
use fdcc_grammar::Span;
use fdcc_grammar::ast::Direction;

/// Where something was written, and what to call it.
#[derive(Clone, Debug, Default)]
pub struct Place {
    /// In the model's words.
    pub name: String,
    /// In its text.
    pub span: Span,
}

/// `lower <= . <= upper` over parameters; infinite numbers where there is no bound.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Lower bound.
    pub lower: ExprId,
    /// Upper bound.
    pub upper: ExprId,
}

/// A `param`.
#[derive(Clone, Debug)]
pub struct Param {
    /// Its declaration.
    pub place: Place,
    /// Its value over other parameters; `None` until the command line gives one.
    pub value: Option<ExprId>,
    /// What the command line may give.
    pub range: Range,
}

/// A component of a `signal`.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Its declaration.
    pub place: Place,
    /// The parameters that are its values at points of equal distance, where a controller is given
    /// them; none where it is what the text says.
    pub points: Vec<usize>,
}

/// A `free` unknown.
#[derive(Clone, Debug)]
pub struct Free {
    /// Its declaration.
    pub place: Place,
    /// Its bounds.
    pub range: Range,
    /// Its guess, over parameters and other unknowns.
    pub guess: Option<ExprId>,
}

/// A scalar state.
#[derive(Clone, Debug)]
pub struct State {
    /// Its declaration.
    pub place: Place,
    /// Bounds at all times.
    pub range: Range,
    /// `start EXPR`, over parameters and unknowns.
    pub start: Option<ExprId>,
    /// `start free in [a, b]`.
    pub start_range: Option<Range>,
    /// Its derivative in real time, affine in the selectors.
    pub rate: ExprId,
    /// The equation; named `x'`.
    pub equation: Place,
    /// Its guess over time, parameters and unknowns.
    pub guess: Option<ExprId>,
}

/// A scalar control.
#[derive(Clone, Debug)]
pub struct Control {
    /// Its declaration.
    pub place: Place,
    /// Bounds at all times.
    pub range: Range,
    /// Its guess over time, parameters and unknowns.
    pub guess: Option<ExprId>,
}

/// A switching surface.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its declaration, or the first use of an unnamed one.
    pub place: Place,
    /// The switching function, whose sign decides.
    pub psi: ExprId,
    /// Of a phase, where that may be at the first time by what links say.
    pub begins: Begins,
}

/// The function of a surface at the first time of a phase.
#[derive(Clone, Copy, Debug)]
pub struct Begins {
    /// The least and the largest value.
    pub range: [f64; 2],
    /// As it is guessed, where phases before lead to that.
    pub guess: Option<f64>,
}

impl Default for Begins {
    fn default() -> Self {
        Begins { range: [f64::NEG_INFINITY, f64::INFINITY], guess: None }
    }
}

/// The vector of a `Dir`: the length of `s` is at most 1, and `s = psi/|psi|` off 0.
#[derive(Clone, Debug)]
pub struct Ball {
    /// Its first use, named by the text of the vector.
    pub place: Place,
    /// Its components, as indices into
    /// [`Model::surfaces`](super::Model::surfaces).
    pub surfaces: std::ops::Range<usize>,
}

/// A reset of the state: `x+ = r(t, x-, p)` where a surface is crossed in one direction.
#[derive(Clone, Debug)]
pub struct Jump {
    /// Its declaration.
    pub place: Place,
    /// The surface, as an index into
    /// [`Model::surfaces`](super::Model::surfaces).
    pub surface: usize,
    /// Which crossing resets.
    pub direction: Direction,
    /// How often at most, over parameters.
    pub at_most: Option<ExprId>,
    /// The surface that is held after the last one.
    pub then_hold: Option<usize>,
    /// States, as indices into [`Model::states`](super::Model::states), with their values
    /// after the jump.
    pub resets: Vec<(usize, ExprId)>,
    /// What assigns each of these.
    pub assignments: Vec<Span>,
}

/// A scalar row of a condition: `lower <= value <= upper`.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// The condition.
    pub place: Place,
    /// What is bounded.
    pub value: ExprId,
    /// By what.
    pub range: Range,
}

/// `at TIME: CONDITION`, between the ends of time.
#[derive(Clone, Debug)]
pub struct AtTime {
    /// The time as it was written.
    pub place: Place,
    /// When the rows hold, over parameters and unknowns.
    pub time: ExprId,
    /// What holds then, over the symbols of any time.
    pub rows: Vec<Constraint>,
}

/// An `integral(...)`.
#[derive(Clone, Debug)]
pub struct Integral {
    /// The call; named by its text.
    pub place: Place,
    /// What is integrated over real time.
    pub integrand: ExprId,
    /// Whether something outside of its phase needs its value.
    pub is_linked: bool,
}

/// A line of the `sweep` block.
#[derive(Clone, Debug)]
pub struct Swept {
    /// The name of a parameter or of a setting.
    pub place: Place,
    /// Its values: numbers in SI, words.
    pub values: Vec<String>,
    /// Where the values stand.
    pub values_span: Span,
}

/// A `const`, `let` or `fn`.
#[derive(Clone, Debug)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// The names of its arguments, none but for a function.
    pub arguments: Vec<String>,
    /// Its components; a function over [`Symbol::Argument`](super::Symbol::Argument), none if that
    /// gives no value.
    pub parts: Vec<ExprId>,
}
