//! Which arm of a `piecewise` is the first whose guard holds, as one input moves and all others
//! stay.
//!
//! A guard `g <= 0` that is affine in the input `z` holds on one side of its zero. The first that
//! holds at `z` is found by bisection among those that reach further than all before them, so a
//! definition of n arms takes n log n and not n^2 steps.

use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph, evaluate};

/// The guards of a definition at a point.
pub(super) struct Gaps {
    /// The functions `g` of all guards, with their values.
    pub all: Vec<(ExprId, f64)>,
    /// Those that hold.
    holding: Vec<usize>,
}

impl Gaps {
    /// At a point.
    pub fn at(graph: &Graph, gaps: &[ExprId], point: &[f64]) -> Self {
        let values = evaluate(graph, gaps, point, &[]);
        let holding = (0..gaps.len()).filter(|at| values[*at] <= 0.0).collect();
        Gaps { all: gaps.iter().copied().zip(values).collect(), holding }
    }
}

/// The guards along one input.
pub(super) struct Along {
    input: u32,
    /// The first that holds wherever the input is.
    always: Option<usize>,
    /// Those that hold up to a place, each beyond the places of all before it.
    up_to: Vec<(f64, usize)>,
    /// Those that hold from a place on.
    from: Vec<(f64, usize)>,
    /// Those that are not affine, with `g`.
    others: Vec<(usize, ExprId)>,
}

impl Along {
    /// `reading` are the guards that read the input, ascending; all are known at the point.
    pub fn new(
        graph: &mut Graph,
        gaps: &Gaps,
        reading: &[usize],
        input: u32,
        point: &[f64],
    ) -> Self {
        let mut still = gaps.holding.iter().filter(|at| reading.binary_search(at).is_err());
        let always = still.next().copied();
        let (up_to, from, others) = Default::default();
        let mut along = Along { input, always, up_to, from, others };
        for &at in reading {
            let (gap, value) = gaps.all[at];
            let slope = derivative(graph, gap, input);
            match graph.inputs_of(&[slope]).contains(&input) {
                true => along.others.push((at, gap)),
                false => {
                    let slope = evaluate(graph, &[slope], point, &[])[0];
                    along.add(at, value, slope, point[input as usize]);
                }
            }
        }
        along
    }

    /// A guard with its value and its slope at a place.
    fn add(&mut self, at: usize, value: f64, slope: f64, place: f64) {
        let zero = place - value / slope;
        match slope {
            _ if (slope == 0.0 || value.is_infinite()) && value <= 0.0 => {
                self.always = Some(self.always.map_or(at, |first| first.min(at)));
            }
            _ if !zero.is_finite() => {}
            _ if slope > 0.0 && self.up_to.last().is_none_or(|it| zero > it.0) => {
                self.up_to.push((zero, at));
            }
            _ if slope < 0.0 && self.from.last().is_none_or(|it| zero < it.0) => {
                self.from.push((zero, at));
            }
            _ => {}
        }
    }

    /// The first guard that holds at a point, which differs from the first one in the input only.
    pub fn first(&self, graph: &Graph, point: &[f64]) -> Option<usize> {
        let place = point[self.input as usize];
        let up_to = self.up_to.partition_point(|it| it.0 < place);
        let from = self.from.partition_point(|it| it.0 > place);
        let holds = |gap: ExprId| evaluate(graph, &[gap], point, &[])[0] <= 0.0;
        let affine = [self.up_to.get(up_to), self.from.get(from)];
        let affine = affine.into_iter().flatten().map(|it| it.1).chain(self.always).min();
        let mut others = self.others.iter().take_while(|it| affine.is_none_or(|at| it.0 < at));
        others.find(|it| holds(it.1)).map(|it| it.0).or(affine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Guards of two inputs: affine in both directions, bent, and without the input that moves.
    #[test]
    fn the_first_guard_is_that_of_a_walk_through_all() {
        let mut graph = Graph::new();
        let (z, y) = (graph.input(0), graph.input(1));
        let square = graph.square(z);
        let mut gaps = Vec::new();
        for at in 0..40 {
            let offset = graph.number(f64::from((at * 7) % 11) - 5.0);
            let left = [z, y, square][at as usize % 3];
            let gap = graph.sub(left, offset);
            gaps.push(if at % 4 < 2 { gap } else { graph.neg(gap) });
        }
        for start in 0..gaps.len() {
            let gaps = &gaps[start..];
            let point = [0.37, 0.61];
            let reads = |at: &usize| graph.inputs_of(&[gaps[*at]]).contains(&0);
            let reading: Vec<usize> = (0..gaps.len()).filter(reads).collect();
            let known = Gaps::at(&graph, gaps, &point);
            let along = Along::new(&mut graph, &known, &reading, 0, &point);
            for step in -70..70 {
                let point = [f64::from(step) * 0.1 + 0.03, 0.61];
                let values = evaluate(&graph, gaps, &point, &[]);
                let first = values.iter().position(|gap| *gap <= 0.0);
                assert_eq!(along.first(&graph, &point), first, "{start} {point:?}");
            }
        }
    }
}
