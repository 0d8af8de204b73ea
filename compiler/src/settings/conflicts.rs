//! Settings of the method that do not fit each other, or together ask for too much.

use fdcc_runtime::problem::{ControlShape, Grid, Method, Order, Scheme};

/// Which setting does not fit the others, why, and what to do.
pub(crate) fn misfit(method: &Method) -> Option<(&'static str, String, &'static str)> {
    if let Some([steps, most]) = method.excess() {
        let key = if method.steps > method.intervals() { "steps" } else { "N" };
        let help =
            "a grid that fine resolves nothing more; write smaller numbers for `N` and `steps`";
        return Some((key, too_many(method, steps, most), help));
    }
    let (key, what, help) = mismatch(method)?;
    Some((key, what.into(), help))
}

/// `N = 1000 with steps = 1000000 is 1000000000 steps, and 200000 are the most`
fn too_many(method: &Method, steps: usize, most: usize) -> String {
    match method.steps {
        1 => format!("`N = {steps}` is too large; {most} intervals are the most"),
        each => format!(
            "`N = {}` with `steps = {each}` is {steps} steps in all; {most} are the most",
            method.intervals()
        ),
    }
}

fn mismatch(method: &Method) -> Option<(&'static str, &'static str, &'static str)> {
    if method.grid == Grid::Auto && method.scheme == Scheme::RungeKutta4 {
        return Some((
            "N",
            "`rk4` has steps of one length, which `N = auto` has not",
            "choose another scheme, or a number for N",
        ));
    }
    if method.order == Order::Auto && method.grid != Grid::Auto {
        return Some((
            "scheme",
            "`radau` and `gauss` without a number find their order together with the grid, and \
             this grid is given",
            "write the number of stages, such as `radau3`, or `N = auto`",
        ));
    }
    if method.scheme.allows(method.controls) {
        return None;
    }
    Some(match method.controls {
        ControlShape::Linear => (
            "controls",
            "linear controls need a scheme that sees more than one point of an interval",
            "choose trapezoid, radau2 to radau5 or gauss2 to gauss5",
        ),
        _ => (
            "controls",
            "polynomial controls are given at the nodes of a collocation scheme",
            "choose radau1 to radau5 or gauss1 to gauss5",
        ),
    })
}
