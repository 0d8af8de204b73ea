//! One-step rules for inclusions, and the grid that they run over.
//!
//! ```text
//! x+ = x + h [b0 f(t, x, s0) + b f(t + c h, z, s)],    z = (1 - w) x + w x+
//! s0 in Sgn(psi(t, x)),   s in Sgn(psi(t + c h, z))
//! ```
//!
//! The schemes of transcription are of this form, and so is the theta scheme: `b0 = 0`, `b = 1`, `c
//! = w = theta`.

use crate::problem::Method;
use crate::simulate::System;
use crate::transcribe::tableau::{Node, nodes};

/// Equal steps and what is done in each.
#[derive(Clone, Debug)]
pub struct Grid {
    /// `b0`; none if no part is explicit.
    pub(super) explicit: Option<f64>,
    /// `b`, `c` and `w`; none if every part is explicit.
    pub(super) implicit: Option<Node>,
    intervals: usize,
    steps: usize,
}

impl Grid {
    /// The grid and the scheme of a method.
    pub fn new(system: &System, method: &Method) -> Self {
        Grid::with_nodes(nodes(method, system.layout.x), method.intervals(), method.steps)
    }

    /// `x+ = x + h f(t + theta h, (1 - theta) x + theta x+)`: 0 is explicit Euler, 1/2 the midpoint
    /// rule, 1 implicit Euler.
    pub fn theta(system: &System, theta: f64, intervals: usize) -> Self {
        let node = Node { weight: 1.0, time: theta, blend: vec![theta; system.layout.x] };
        Grid::with_nodes(vec![node], intervals, 1)
    }

    fn with_nodes(nodes: Vec<Node>, intervals: usize, steps: usize) -> Self {
        let is_explicit = |node: &Node| node.time == 0.0 && node.blend.iter().all(|w| *w == 0.0);
        let (explicit, mut implicit): (Vec<Node>, Vec<Node>) =
            nodes.into_iter().partition(is_explicit);
        assert!(implicit.len() <= 1, "a step solves one complementarity problem");
        let explicit = explicit.iter().map(|node| node.weight).reduce(|sum, weight| sum + weight);
        Grid { explicit, implicit: implicit.pop(), intervals, steps }
    }

    /// Number of steps.
    pub(super) fn count(&self) -> usize {
        self.intervals * self.steps
    }

    /// The middle of the control interval that a step belongs to, in normalised time.
    pub(super) fn middle(&self, step: usize) -> f64 {
        ((step / self.steps) as f64 + 0.5) / self.intervals as f64
    }

    /// Normalised time a part of a step after its beginning.
    pub(super) fn tau(&self, step: usize, part: f64) -> f64 {
        (step as f64 + part) / self.count() as f64
    }
}
