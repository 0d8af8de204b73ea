//! The contract between symbols and the simulator: the true, unsmoothed system in real time.
//!
//! ```text
//! x' = f(t, x, u, p, s),   s in Sgn(psi(t, x, p)) or Dir(psi)
//! x+ = r_j(t, x-, u, p)    where psi is crossed
//! ```
//!
//! A system for sensitivities has the first and second derivatives of all functions by all their
//! inputs, too.
//!
//! The last states are the integrals of the model, which start at 0; so the objective is a function
//! of both ends.

use crate::problem::{Columns, Function, Layout, Origin, Parameter, Surface, Variable};
use std::ops::Range;
use std::sync::Arc;

/// A reset of the state.
#[derive(Clone, Debug)]
pub struct Jump {
    /// Its name.
    pub name: String,
    /// Where it is declared.
    pub origin: Origin,
    /// The surface whose crossing resets.
    pub surface: usize,
    /// Whether the crossing is from above to below.
    pub is_falling: bool,
    /// How often at most.
    pub at_most: Option<f64>,
    /// The surface that is held after the last one.
    pub then_hold: Option<usize>,
    /// The states that it gives a value.
    pub resets: Vec<usize>,
}

/// The vector of a `Dir`: `s = psi/|psi|`, and any `|s| <= 1` where `psi = 0`.
#[derive(Clone, Debug)]
pub struct Ball {
    /// Its name.
    pub name: String,
    /// Its components, as indices into [`System::surfaces`].
    pub surfaces: Range<usize>,
}

/// All numbers between two ends.
pub type Interval = [f64; 2];

/// Where a value and its derivatives are, whatever the inputs are in given intervals.
#[derive(Clone)]
pub struct Enclosure {
    /// The inputs that the value depends on, as positions in `[t | x | u | p | s]`, ascending.
    pub reads: Vec<usize>,
    /// Those of them by which there are derivatives.
    pub by: Vec<usize>,
    /// Whether none of the derivatives depends on any of these.
    pub is_affine: bool,
    /// From an interval for each input to those of the value and of its derivatives, in the order
    /// of `by`. Empty where there is no value.
    #[allow(clippy::type_complexity)]
    pub over: Arc<dyn Fn(&[Interval], &mut [Interval]) + Send + Sync>,
}

/// What must not be missed along a step, one enclosure for each output of its function.
#[derive(Clone)]
pub struct Enclosures {
    /// Of [`System::flow`]; without derivatives.
    pub flow: Vec<Enclosure>,
    /// The outputs of [`System::flow`] that may do something sudden between any points where they
    /// are looked at, ascending: those that are no polynomials of a low degree.
    pub sudden: Vec<usize>,
    /// Of [`System::switching`]; by `t` and `x`.
    pub switching: Vec<Enclosure>,
    /// Of [`System::kinks`]; by `t`, `x` and `u`.
    pub kinks: Vec<Enclosure>,
    /// Of [`System::rates`]; by `s`.
    pub rates: Vec<Enclosure>,
    /// The same; by `t`, `x` and `u`.
    pub accelerations: Vec<Enclosure>,
    /// Of the path conditions of the model, over the inputs of `flow`; by `t`, `x` and `u`.
    pub path: Vec<Enclosure>,
    /// Of the controls of [`System::guess`], over `[tau | p]`; by `tau`.
    pub controls: Vec<Enclosure>,
}

/// A system that can be simulated.
#[derive(Clone)]
pub struct System {
    /// Name of the model.
    pub name: String,
    /// Sizes of `t x u p s`.
    pub layout: Layout,
    /// States, then integrals (hidden).
    pub states: Vec<Variable>,
    /// Controls.
    pub controls: Vec<Variable>,
    /// All of `p`, with values.
    pub parameters: Vec<Parameter>,
    /// Switching surfaces.
    pub surfaces: Vec<Surface>,
    /// Which of them are the components of a `Dir`.
    pub balls: Vec<Ball>,
    /// Resets.
    pub jumps: Vec<Jump>,
    /// First and last time.
    pub interval: [f64; 2],
    /// The state at the first time.
    pub start: Vec<f64>,
    /// `f` over `[t | x | u | p | s]` in real time; differentiated by `x` and `s`.
    pub flow: Arc<dyn Function>,
    /// `psi' = psi_t + psi_x f`, with the inputs of `flow`; differentiated by `x` and `s`.
    pub rates: Arc<dyn Function>,
    /// `psi`, with the inputs of `flow`; differentiated by `t` and `x`.
    pub switching: Arc<dyn Function>,
    /// `r`, with the inputs of `flow`, as many outputs as states for each jump; differentiated by
    /// `t` and `x`.
    pub resets: Arc<dyn Function>,
    /// The objective as written, over `[x(start), x(end) | p]`; no output if there is none.
    pub objective: Arc<dyn Function>,
    /// Guess of states, then controls, over normalised time `[tau | p]`.
    pub guess: Arc<dyn Function>,
    /// Over the inputs of `flow`, what is 0 where `flow` has a kink that is no surface, such as
    /// that of `abs`, then where `switching` has another one; the selectors behind those of the
    /// surfaces say on which side of each the state is. Kinks inside others come first;
    /// differentiated by `t`, `x` and `u`.
    pub kinks: Arc<dyn Function>,
    /// How many of them are kinks of `flow`.
    pub kinks_of_flow: usize,
    /// Over the inputs of `flow`, what is 0 where `flow` has a kink that parameters alone move.
    pub fixed_kinks: Arc<dyn Function>,
    /// Bounds of the functions that are watched along a step.
    pub enclosures: Enclosures,
    /// First and last time over `[p]`.
    pub interval_of: Arc<dyn Function>,
    /// The state at the first time over `[p]`.
    pub start_of: Arc<dyn Function>,
}

impl System {
    /// The inputs that are selectors of surfaces.
    pub fn surface_selectors(&self) -> Range<usize> {
        let first = self.layout.selectors().start;
        first..first + self.surfaces.len()
    }

    /// Ends a point `[t | x | u | s]` with the side of each kink that it is on, below where it is
    /// on the kink itself.
    pub fn choose_sides(&self, point: &mut [f64], parameters: &[f64]) {
        let first = point.len() - self.kinks.outputs();
        // Each pass is right for one more kink inside others.
        for _ in first..point.len() {
            let zeros = value(&*self.kinks, point, parameters);
            let sides = zeros.iter().map(|zero| if *zero > 0.0 { 1.0 } else { -1.0 });
            point[first..].iter_mut().zip(sides).for_each(|(side, now)| *side = now);
        }
    }

    /// The functions of the surfaces at a point `[t | x | u | s]`, whose selectors become the sides
    /// that it is on.
    pub fn switching_at(&self, point: &mut [f64], parameters: &[f64]) -> Vec<f64> {
        let surfaces = self.surfaces.len();
        let first = point.len() - surfaces - self.kinks.outputs();
        // Each pass is right for one more surface whose function has a kink on another one.
        for _ in 0..surfaces {
            self.choose_sides(point, parameters);
            let psi = value(&*self.switching, point, parameters);
            let side = |psi: &f64| if *psi > 0.0 { 1.0 } else { -1.0 };
            let sides: Vec<f64> = psi.iter().map(side).collect();
            let known = &mut point[first..first + surfaces];
            if known == &sides[..] {
                return psi;
            }
            known.copy_from_slice(&sides);
        }
        value(&*self.switching, point, parameters)
    }

    /// The values of all parameters.
    pub fn parameter_values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }

    /// The name of a surface, or of the ball that it is a component of.
    pub fn name_of(&self, surface: usize) -> &str {
        match self.balls.iter().find(|ball| ball.surfaces.contains(&surface)) {
            Some(ball) => &ball.name,
            None => &self.surfaces[surface].name,
        }
    }

    /// A surface alone, or all components of the ball that it is one of.
    pub(crate) fn held_together(&self, surface: usize) -> Range<usize> {
        let ball = self.balls.iter().find(|ball| ball.surfaces.contains(&surface));
        ball.map_or(surface..surface + 1, |ball| ball.surfaces.clone())
    }

    /// The same system with other parameters, its interval and its start computed anew.
    pub fn with_parameters(&self, values: &[f64]) -> Self {
        let mut other = self.clone();
        other
            .parameters
            .iter_mut()
            .zip(values)
            .for_each(|(parameter, value)| parameter.value = *value);
        other.start = value(&*self.start_of, &[], values);
        other.interval.copy_from_slice(&value(&*self.interval_of, &[], values));
        other
    }

    /// Why its time cannot pass: its ends are no numbers, or in the wrong order.
    pub fn wrong_times(&self) -> Option<String> {
        let [first, last] = self.interval;
        let wrong = match (first.is_finite() && last.is_finite(), first <= last) {
            (false, _) => "both must be numbers",
            (true, false) => "it must not run backwards",
            (true, true) => return None,
        };
        Some(format!("time runs from {first} to {last}; {wrong}"))
    }

    /// The guess of states, then controls, at a normalised time.
    pub fn guessed(&self, tau: f64) -> Vec<f64> {
        value(&*self.guess, &[tau], &self.parameter_values())
    }
}

/// All outputs of a function at one point `[t | x | u | s]`.
pub fn value(function: &dyn Function, point: &[f64], parameters: &[f64]) -> Vec<f64> {
    let mut values = Columns::new(function.outputs(), 1);
    function.value(&Columns::of_point(point), parameters, &mut values);
    (0..function.outputs()).map(|at| values.column(at)[0]).collect()
}
