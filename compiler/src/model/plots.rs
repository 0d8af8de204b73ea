//! Pictures of the answer that a model asks for.

use super::numbers::numbers;
use super::{Model, Place, Range, Symbol};
use crate::expressions::graph::{ExprId, evaluate_with};

/// `plot name: curves over something with borders`.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Its name.
    pub place: Place,
    /// The state, control or report on the horizontal axis, or time.
    pub over: String,
    /// Those on the vertical one.
    pub curves: Vec<String>,
    /// Path conditions on what the two axes show.
    pub borders: Vec<Border>,
}

/// A path condition on a plane.
#[derive(Clone, Debug)]
pub struct Border {
    /// The condition.
    pub place: Place,
    /// What is bounded.
    pub value: ExprId,
    /// Its bounds.
    pub range: Range,
    /// The inputs that are the axes of the plane, the horizontal one first.
    pub axes: [u32; 2],
}

/// The plane of a plot, in which a condition holds on one side of a border.
pub struct Plane<'m> {
    model: &'m Model,
    border: &'m Border,
    /// One for each symbol.
    inputs: Vec<f64>,
}

impl<'m> Plane<'m> {
    /// With the values of the unknowns by name; nothing where parameters have no value.
    pub fn new(model: &'m Model, border: &'m Border, unknowns: &[(&str, f64)]) -> Option<Self> {
        let mut inputs = numbers(model).ok()?.inputs().to_vec();
        for (symbol, input) in model.symbols.iter().zip(&mut inputs) {
            if let Symbol::Free(at) = symbol {
                let name = &model.frees[*at].place.name;
                let known = unknowns.iter().find(|it| it.0 == name);
                *input = known.map_or(*input, |it| it.1);
            }
        }
        Some(Plane { model, border, inputs })
    }

    /// How far a point is on the right side, in the unit of the condition: 0 on the border, below 0
    /// where the condition does not hold.
    pub fn room(&self, point: [f64; 2]) -> f64 {
        let Border { value, range, axes, .. } = self.border;
        let input = |at: u32| match axes.iter().position(|it| *it == at) {
            Some(axis) => point[axis],
            None => self.inputs[at as usize],
        };
        let ids = [*value, range.lower, range.upper];
        let values = evaluate_with(&self.model.graph, &ids, input, &[]);
        (values[0] - values[1]).min(values[2] - values[0])
    }
}
