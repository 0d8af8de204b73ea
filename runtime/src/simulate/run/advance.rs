//! One step forward: its length, the method that takes it, and where in it the mode ends.

use super::Run;
use crate::problem::Origin;
use crate::simulate::field::surface_rates;
use crate::simulate::location;
use crate::simulate::location::hidden::first_hidden;
use crate::simulate::location::{Condition, First};
use crate::simulate::modes::ball::{blocks, is_unique};
use crate::simulate::result::{Integrator, Method, Status};
use crate::simulate::steps::Step;
use crate::simulate::tape::Cause;
use crate::simulate::tuning::advance::{
    BEFORE_HIDDEN, BORDER, BORDER_POWER, BORDER_RTOL, CHANGE, EXPLICIT_ORDER, LEAST_ERROR,
    LEAST_PART, MOST_BENDS, MOST_GROWTH, MOST_LONGER, MOST_NUMBERS, MOST_SHRINKING, NO_RATE,
    NO_REST, NO_SIZE, NOT_STIFF, NOT_STIFF_AFTER, SAFETY, SAME_TIME, SHARE, SMALL_BORDER,
    STIFF_AFTER, STIFF_ORDER, STUCK,
};

/// What a step leaves for the next.
pub(crate) struct Pace {
    /// The length to be tried.
    pub h: f64,
    /// Whether the next step continues the last one in the same mode.
    pub is_continued: bool,
    /// Which method takes the next step.
    method: Method,
    /// How many steps of the explicit method in a row were as long as its stability allows, and how
    /// many not since.
    at_border: usize,
    off_border: usize,
    /// How many kinks in a row were met at one time.
    kinks: usize,
    /// The last step.
    step: Step,
}

impl Pace {
    pub fn new(states: usize, method: Method) -> Self {
        let step = Step::new(states);
        Pace { h: 0.0, is_continued: false, method, at_border: 0, off_border: 0, kinks: 0, step }
    }

    /// Chooses the method of the next step by what the last one says of stiffness.
    fn choose(&mut self, step: &Step, rtol: f64) {
        let stiffness = step.stiffness();
        let is_at_border = stiffness
            > (SMALL_BORDER * (rtol / BORDER_RTOL).powf(BORDER_POWER)).clamp(SMALL_BORDER, BORDER);
        self.at_border += usize::from(is_at_border);
        self.off_border = if is_at_border { 0 } else { self.off_border + 1 };
        match self.method {
            Method::Explicit if self.off_border >= NOT_STIFF_AFTER => self.at_border = 0,
            Method::Explicit if self.at_border >= STIFF_AFTER => self.method = Method::Stiff,
            Method::Stiff if stiffness < NOT_STIFF => {
                (self.method, self.at_border) = (Method::Explicit, 0)
            }
            Method::Explicit | Method::Stiff => {}
        }
    }
}

/// How much shorter or longer a step with some error should be.
fn factor(step: &Step) -> f64 {
    let order = match step.method {
        Method::Explicit => EXPLICIT_ORDER,
        Method::Stiff => STIFF_ORDER,
    };
    if step.error.is_finite() {
        (SAFETY * step.error.max(LEAST_ERROR).powf(-1.0 / order)).clamp(MOST_SHRINKING, MOST_GROWTH)
    } else {
        MOST_SHRINKING
    }
}

impl Run<'_> {
    /// A first length: E. Hairer, S. P. Norsett, G. Wanner: Solving Ordinary Differential Equations
    /// I, 2nd ed., II.4.
    pub fn first_length(&mut self) -> f64 {
        let span = self.field.system.interval[1] - self.t;
        let x = self.x.clone();
        let rate = self.field.rate(self.t, &x);
        // How long what is 0 stays small, only a step tells.
        let moving: Vec<usize> = (0..x.len()).filter(|i| x[*i] != 0.0).collect();
        let scales: Vec<f64> =
            moving.iter().map(|&i| self.field.tolerance.of(i, [x[i]; 2], 0.0)).collect();
        let size = |values: &[f64]| {
            let scaled = moving.iter().zip(&scales).map(|(&i, scale)| (values[i] / scale).abs());
            scaled.fold(0.0, f64::max)
        };
        let (at, slope) = (size(&x), size(&rate));
        let short = if at < NO_SIZE || slope < NO_SIZE {
            LEAST_PART * span
        } else {
            (CHANGE * at / slope).min(span)
        };
        let next: Vec<f64> = x.iter().zip(&rate).map(|(x, rate)| x + short * rate).collect();
        let after = self.field.rate(self.t + short, &next);
        let change: Vec<f64> =
            after.iter().zip(&rate).map(|(after, rate)| (after - rate) / short).collect();
        let bend = slope.max(size(&change));
        let long = if bend > NO_RATE { (CHANGE / bend).powf(BORDER_POWER) } else { span };
        let length = long.min(MOST_LONGER * short).min(span);
        if length > 0.0 { length } else { LEAST_PART * span }
    }

    /// One accepted step towards `stop`, or up to the first event in it.
    pub fn advance(&mut self, stop: f64) -> Result<(), Status> {
        let mut step = std::mem::take(&mut self.pace.step);
        let result = self.advance_by(&mut step, stop);
        self.pace.step = step;
        result
    }

    fn advance_by(&mut self, step: &mut Step, stop: f64) -> Result<(), Status> {
        self.options.watch.ask()?;
        if self.record.size() > MOST_NUMBERS {
            return Err(Status::StepLimit);
        }
        let rest = stop - self.t;
        let arrival = self.field.next_arrival(self.t, &self.x);
        if let Some(arrival) = arrival.as_ref().filter(|it| it.is_near && it.time <= rest) {
            return self.arrive(arrival);
        }
        self.accepted(step, rest, arrival.map_or(f64::INFINITY, |it| it.longest))?;
        self.counts.steps += 1;
        self.counts.stiff += usize::from(step.method == Method::Stiff);
        if self.options.integrator == Integrator::Automatic && self.field.moving().is_empty() {
            self.pace.choose(step, self.options.rtol);
        }
        let found = self.first_event(step)?;
        self.pass_by(step, found.as_ref().map_or(1.0, |it| it.h / step.h))?;
        if let Some(found) = found {
            self.go(step, [step.t + found.h, found.h], &found.state);
            if let Condition::Reaches(surface) = found.condition
                && found.is_jump
            {
                self.record.point(self.t, &self.x);
                return Err(Status::Discontinuous { surface });
            }
            return self.stop(found.condition.into(), |run| run.handle(found.condition));
        }
        if let Some(theta) = self.attraction_ends(step) {
            step.attempt(&mut self.field, theta * step.h);
            self.go(step, [step.t + step.h, step.h], &step.end);
            self.record.point(self.t, &self.x);
            return self.stop(Cause::Repels, |run| {
                let surfaces = run.surfaces_here();
                run.settle(surfaces)
            });
        }
        let time = if step.h >= rest { stop } else { step.t + step.h };
        self.go(step, [time, step.h], &step.end);
        self.record.point(self.t, &self.x);
        self.pace.is_continued = true;
        Ok(())
    }

    /// The first event in a step, which becomes shorter where it is not known beyond.
    /// Kinks that follow each other without any way between them are not looked for after a while.
    fn first_event(&mut self, step: &mut Step) -> Result<Option<location::Found>, Status> {
        self.field.is_blind = self.pace.kinks > MOST_BENDS;
        let found = loop {
            match location::first(&mut self.field, step) {
                First::None => break None,
                First::At(found) => break Some(found),
                First::NotBefore(theta) => step.attempt(&mut self.field, theta * step.h),
                First::Unresolved => return Err(Status::StepLimit),
            }
        };
        let is_bend = |it: &location::Found| matches!(it.condition, Condition::CrossesKink(_));
        let is_there = |it: &location::Found| it.h <= SAME_TIME * step.t.abs();
        let is_idle = found.as_ref().is_some_and(|it| is_bend(it) && is_there(it));
        self.pace.kinks = if is_idle { self.pace.kinks + 1 } else { 0 };
        Ok(found)
    }

    /// Goes to the state at a time, `h` after the beginning of a step.
    pub fn go(&mut self, step: &Step, [time, h]: [f64; 2], end: &[f64]) {
        let field = &mut self.field;
        self.record.inside(time, &mut |wanted| step.exactly_at(field, (wanted - step.t).max(0.0)));
        if h > 0.0 {
            self.extremes.follow(&self.field, step, h / step.h);
            self.note_between(step, h / step.h);
        }
        self.t = time;
        self.x.copy_from_slice(end);
        self.field.project(self.t, &mut self.x);
        self.field.tolerance.see(&self.x);
        if h > 0.0 {
            self.tape.step(&mut self.field, step, h, &self.x);
        }
    }

    /// Takes a step whose error is small enough and that hides nothing, to the stop at most and no
    /// longer than a fall allows; chooses the length of the next.
    fn accepted(&mut self, step: &mut Step, rest: f64, longest: f64) -> Result<(), Status> {
        let wanted = self.pace.h;
        // Two steps of equal length are better than a long and a very short one.
        let mut h = if wanted >= rest * (1.0 - NO_REST) { rest } else { wanted.min(0.5 * rest) };
        h = h.min(longest);
        h = h.min(self.options.longest_from(self.t));
        let mut is_short = h < wanted;
        // Near 0 the direction of a ball is stiff in a way of its own.
        let method =
            if self.field.moving().is_empty() { self.pace.method } else { Method::Explicit };
        if self.field.tolerance.may_be_rough(&self.x) {
            self.field.find_least_sizes(self.t, &self.x);
        }
        step.begin(&mut self.field, self.t, &self.x, method, self.pace.is_continued);
        let selectors = self.field.selectors.clone();
        // What was uncertain in a short step says nothing about a long one.
        self.field.tolerance.forget_doubts();
        loop {
            if self.counts.steps + self.counts.rejected >= self.options.max_steps {
                return Err(Status::StepLimit);
            }
            step.attempt(&mut self.field, h);
            if step.error > 1.0 {
                // With the present length: what a longer step made of uncertain rates is too much.
                self.doubt(step);
            }
            let mut next = h * factor(step);
            if step.error <= 1.0 {
                let Some(theta) = first_hidden(&mut self.field, step) else {
                    // A step that a stop made short says nothing against long ones.
                    self.pace.h = if is_short { next.max(wanted) } else { next };
                    return Ok(());
                };
                next = h * theta.clamp(BEFORE_HIDDEN[0], BEFORE_HIDDEN[1]);
            }
            self.field.selectors.copy_from_slice(&selectors);
            self.counts.rejected += 1;
            (h, is_short) = (next, false);
            if h <= SAME_TIME * self.t.abs().max(h * STUCK).max(f64::MIN_POSITIVE) {
                if !self.field.tolerance.leave_dregs() {
                    return Err(self.stuck());
                }
                h = wanted;
            }
        }
    }

    /// Asks whether an error is more than what the rates are uncertain by.
    fn doubt(&mut self, step: &mut Step) {
        if step.method == Method::Explicit {
            self.field.find_doubts(step.t, &step.start, step.h, SHARE);
        } else {
            // An implicit step damps what the rates of a fast state are off by, and passes on none
            // of it.
            self.field.find_doubts(step.t, &step.start, 0.0, 0.0);
            self.field.tolerance.damp(|i| 1.0 + step.h * step.newton.own_slope(i));
        }
        step.measure(&self.field.tolerance);
    }

    /// Why steps become too short: the sliding ends to be unique, or something grows beyond all
    /// bounds.
    fn stuck(&mut self) -> Status {
        let surfaces = self.surfaces_here();
        if let Err(status) = self.settle(surfaces).and_then(|()| self.finite_here()) {
            return status;
        }
        let rate = self.field.rate(self.t, &self.x);
        let growth = |i: &usize| (rate[*i] / (1.0 + self.x[*i].abs())).abs();
        let worst = (0..self.x.len()).max_by(|i, j| growth(i).total_cmp(&growth(j)));
        Status::NotFinite(
            worst.map_or_else(Origin::default, |row| self.field.system.flow.origin(row)),
        )
    }

    /// Where in a step the surfaces that the state slides on cease to attract, to rounding.
    fn attraction_ends(&mut self, step: &Step) -> Option<f64> {
        let is_sliding = !self.field.sliding().is_empty();
        if !is_sliding || self.attracts(step, 1.0) || !self.attracts(step, 0.0) {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > 2.0 * f64::EPSILON {
            let middle = 0.5 * (low + high);
            if self.attracts(step, middle) { low = middle } else { high = middle }
        }
        Some(high)
    }

    fn attracts(&mut self, step: &Step, theta: f64) -> bool {
        let (t, x) = (step.t + theta * step.h, step.at(theta));
        let sliding = self.field.sliding();
        let normals = self.field.normals(t, &x);
        self.field.follow_directions(t, &x);
        let selectors = self.field.selectors.clone();
        let (rate, by_selector) = self.field.with_selectors(t, &x, &selectors);
        let b = surface_rates(&normals, &rate, &by_selector, &sliding).1;
        is_unique(&b, &blocks(&self.field.system.balls, &sliding))
    }
}
