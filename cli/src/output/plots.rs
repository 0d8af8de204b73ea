//! The pictures that a model asks for, as JSON: which columns are drawn over which.

use super::named::Named;
use fdcc::{Plot, Segment};
use serde::Serialize;

/// A picture; its name is its key.
#[derive(Clone, Debug, Serialize)]
pub struct Drawn {
    /// The state, control or report on the horizontal axis, or `t`.
    over: String,
    curves: Vec<String>,
    /// Pieces of the lines behind which path conditions are violated.
    #[serde(skip_serializing_if = "Named::is_empty")]
    borders: Named<Vec<Segment>>,
}

/// All pictures of a model.
pub fn drawn(plots: Vec<Plot>) -> Named<Drawn> {
    let drawn = |it: Plot| {
        let borders = it.borders.into_iter().collect();
        (it.name, Drawn { over: it.over, curves: it.curves, borders })
    };
    plots.into_iter().map(drawn).collect()
}
