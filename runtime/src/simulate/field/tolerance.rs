//! How exact a step must be, state by state:
//!
//! ```text
//! rtol |x| + atol + h d,
//! atol: what is asked for, or 1e-12 of the size that the state has had lately
//! ```
//!
//! So it does not matter in which unit a state is written. `d` is by how much its rate is
//! uncertain, because of rounding and because the other
//! states are only as exact as they have to be: no step is short enough to be more exact than that.

use super::Field;
use super::tube::Tube;
use crate::simulate::mode::Mode;
use crate::simulate::result::Options;
use crate::simulate::tuning::tolerance::{KEPT, LEAST, PART, PASSES, REACHED, SMALLEST, SOLVED};

/// The tolerances of all states.
pub(crate) struct Tolerance {
    pub rtol: f64,
    atol: Option<f64>,
    /// How large each has been lately.
    pub sizes: Vec<f64>,
    /// The same since the last jump that reset it.
    fresh: Vec<f64>,
    /// How far each has come away from its start.
    pub ways: Vec<f64>,
    start: Vec<f64>,
    /// How large each counts at least.
    least: Vec<f64>,
    /// The same once no step was short enough, as where a tank runs dry.
    dregs: Vec<f64>,
    /// By how much their rates are uncertain.
    doubts: Vec<f64>,
}

impl Tolerance {
    pub fn new(options: &Options, start: &[f64]) -> Self {
        let sizes: Vec<f64> = start.iter().map(|x| x.abs()).collect();
        let fresh = sizes.clone();
        let (least, doubts) = (vec![LEAST; start.len()], vec![0.0; start.len()]);
        let dregs = vec![0.0; start.len()];
        let (ways, start) = (vec![0.0; start.len()], start.to_vec());
        Tolerance {
            rtol: options.rtol,
            atol: options.atol,
            sizes,
            fresh,
            ways,
            start,
            least,
            dregs,
            doubts,
        }
    }

    /// Notes how large the states are after a step.
    pub fn see(&mut self, x: &[f64]) {
        for sizes in [&mut self.sizes, &mut self.fresh] {
            sizes.iter_mut().zip(x).for_each(|(size, x)| *size = (KEPT * *size).max(x.abs()));
        }
        let begins = self.start.iter();
        let ways = self.ways.iter_mut().zip(begins.zip(x));
        ways.for_each(|(way, (begin, x))| *way = way.max((x - begin).abs()));
    }

    /// What a jump resets is as large as after it: what it was says nothing of the motion behind,
    /// but how exactly the state is on a surface.
    pub fn jump(&mut self, before: &[f64], after: &[f64]) {
        let sizes = self.fresh.iter_mut().zip(before.iter().zip(after));
        sizes.filter(|(_, (x, y))| x != y).for_each(|(size, (_, y))| *size = y.abs());
    }

    /// Of a state that is `before` and `after` a step of length `h`.
    pub fn of(&self, i: usize, [before, after]: [f64; 2], h: f64) -> f64 {
        let size = before.abs().max(after.abs());
        let least = self.least[i].max(self.dregs[i]);
        let atol = self.atol.unwrap_or(PART * size.max(self.fresh[i]).max(least));
        atol + self.rtol * size + h * self.doubts[i]
    }

    /// The least absolute tolerance of a state.
    pub fn least(&self, i: usize) -> f64 {
        PART * self.least[i]
    }

    /// Whether a state that was larger has become so small that it may count too much.
    pub fn may_be_rough(&self, x: &[f64]) -> bool {
        let is_small = |(x, least): (&f64, &f64)| *x != 0.0 && x.abs() < PART / self.rtol * least;
        x.iter().zip(&self.least).any(is_small)
    }

    /// From now on what rounding leaves of the way of a state is nothing, where no step is short
    /// enough otherwise; whether that is new.
    pub fn leave_dregs(&mut self) -> bool {
        let dregs: Vec<f64> = self.ways.iter().map(|way| f64::EPSILON / PART * way).collect();
        let is_new = dregs.iter().zip(&self.dregs).any(|(dregs, known)| *dregs > 2.0 * known);
        self.dregs = dregs;
        is_new && self.atol.is_none()
    }

    /// From now on rates are certain.
    pub fn forget_doubts(&mut self) {
        self.doubts.fill(0.0);
    }

    /// Divides what rates are uncertain by.
    pub fn damp(&mut self, by: impl Fn(usize) -> f64) {
        self.doubts.iter_mut().enumerate().for_each(|(i, doubt)| *doubt /= by(i));
    }

    /// The largest difference of two states near `x` in units of the tolerance.
    pub fn error(&self, x: &[f64], one: &[f64], other: &[f64], h: f64) -> f64 {
        let scaled = |i: usize| (one[i] - other[i]).abs() / self.of(i, [x[i], one[i]], h);
        let all = (0..x.len()).map(scaled);
        all.fold(
            0.0,
            |largest, value| if value > largest || value.is_nan() { value } else { largest },
        )
    }
}

impl Field<'_> {
    /// Finds how large states count at least.
    pub fn find_least_sizes(&mut self, t: f64, x: &[f64]) {
        let [first, last] = self.system.interval;
        let selectors = self.selectors.clone();
        let (rate, by_selector) = self.with_selectors(t, x, &selectors);
        let pushes = by_selector.row_iter().map(|row| row.iter().map(|push| push.abs()).sum());
        let ways = rate.iter().zip(pushes).map(|(f, push): (&f64, f64)| f.abs() + push);
        let ways: Vec<f64> = ways.map(|rate| (last - first) * rate).collect();
        let largest = x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let sizes = self.sizes_at_rest(t, x, &ways, largest);
        for (i, (way, size)) in ways.iter().zip(sizes).enumerate() {
            let least = (LEAST * size).max(SMALLEST * size.min(1.0)).max(f64::MIN_POSITIVE);
            let reached = REACHED * way;
            self.tolerance.least[i] = if reached.is_finite() { reached.max(least) } else { least };
        }
    }

    /// How large states can become that hardly move: as bounds of their rates allow over all the
    /// time, where the other states go on as they begin, or else as large as any other is.
    fn sizes_at_rest(&mut self, t: f64, x: &[f64], ways: &[f64], largest: f64) -> Vec<f64> {
        let last = self.system.interval[1];
        let is_at_rest = |i: &usize| REACHED * ways[*i] < LEAST * largest;
        let (mut ways, at_rest) = (ways.to_vec(), (0..x.len()).filter(is_at_rest));
        let at_rest: Vec<usize> = at_rest.collect();
        let mut tube = Tube::at(self, t, x);
        tube.inputs[0] = [t, last];
        let passes = if at_rest.is_empty() { 0 } else { PASSES };
        for _ in 0..passes {
            let around = x.iter().zip(&ways).map(|(x, way)| [x - way, x + way]);
            tube.inputs[self.system.layout.t..].iter_mut().zip(around).for_each(|(a, b)| *a = b);
            for &i in &at_rest {
                tube.evaluate(&self.system.enclosures.flow[i]);
                let [low, high] = tube.ranges[0];
                ways[i] = ways[i].max((last - t) * low.abs().max(high.abs()));
            }
        }
        let is_known = |i: usize| at_rest.contains(&i) && ways[i] > 0.0 && ways[i] < largest;
        (0..x.len()).map(|i| if is_known(i) { ways[i].max(x[i].abs()) } else { largest }).collect()
    }

    /// Finds by how much rates are uncertain if states may be off by a part of their tolerance, and
    /// by what their own rates make of them in a time `h`.
    pub fn find_doubts(&mut self, t: f64, x: &[f64], h: f64, part: f64) {
        self.tolerance.forget_doubts();
        for _ in 0..PASSES {
            self.widen_doubts(t, x, h, part);
        }
    }

    fn widen_doubts(&mut self, t: f64, x: &[f64], h: f64, part: f64) {
        let layout = self.system.layout;
        let mut tube = Tube::at(self, t, x);
        for i in 0..layout.x {
            let off = part * self.tolerance.of(i, [x[i]; 2], 0.0) + h * self.tolerance.doubts[i];
            tube.inputs[layout.t + i] = [x[i] - off, x[i] + off];
        }
        for (i, mode) in self.modes.iter().enumerate() {
            let s = self.selectors[i];
            let off = if matches!(mode, Mode::Sliding | Mode::Moving) {
                SOLVED * (1.0 + s.abs())
            } else {
                0.0
            };
            tube.inputs[layout.selectors().start + i] = [s - off, s + off];
        }
        for (i, rate) in self.system.enclosures.flow.iter().enumerate() {
            tube.evaluate(rate);
            let width = tube.ranges[0][1] - tube.ranges[0][0];
            let stands_still = self.held.contains(&i);
            self.tolerance.doubts[i] = if width.is_finite() && !stands_still { width } else { 0.0 };
        }
    }
}
