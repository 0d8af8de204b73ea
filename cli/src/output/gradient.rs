//! A gradient as a JSON document.

use super::ending::{Ending, EventEntry, events};
use super::named::Named;
use super::number::{scientific, significant};
use super::units::{Shown, Units};
use crate::command;
use crate::version::VERSION;
use fdcc::{By, Exact, Gradient, Model, Stepped};
use fdcc_grammar::SourceFile;
use fdcc_runtime::problem::Method;
use fdcc_runtime::sensitivity::{Kink, KinkMet, Nondifferentiability, NondifferentiabilityKind};
use fdcc_runtime::simulate::{Simulation, System};
use serde::Serialize;

/// What `fdcc grad --json` prints.
#[derive(Serialize)]
pub struct GradientDocument {
    fdcc: String,
    pub model: String,
    /// The arguments that it was run with; absent where there is no command line.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    command: Vec<String>,
    pub of: String,
    #[serde(flatten)]
    pub ending: Ending,
    pub value: Option<f64>,
    pub gradient: Named<Derivative>,
    pub adjoint: Named<Derivative>,
    pub agreement: Option<f64>,
    /// The largest difference to derivatives along steps of twice the length.
    pub resolution: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub second: Option<Named<Named<f64>>>,
    pub compare: Compare,
    pub differentiable: bool,
    /// Whether it is differentiable, both ways to compute the gradient agree, and the trajectory
    /// stays on no kink.
    pub trusted: bool,
    /// Whether it stays on a kink.
    #[serde(skip)]
    pub has_kink: bool,
    /// Whether shorter steps lead to another gradient.
    #[serde(skip)]
    pub is_unresolved: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub one_sided: Option<Named<Sides>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cause: Option<Reason>,
    pub events: Vec<EventEntry>,
    pub warnings: Vec<String>,
    /// The units of names, not of derivatives.
    #[serde(skip_serializing_if = "Units::is_empty")]
    pub units: Units,
    #[serde(skip_serializing_if = "Named::is_empty")]
    display_units: Named<Shown>,
    #[serde(flatten)]
    trajectory: Option<Trajectory>,
}

/// What is differentiated, for its picture.
#[derive(Serialize)]
struct Trajectory {
    time: Vec<f64>,
    states: Named<Vec<f64>>,
    /// The text of the model.
    source: String,
}

/// A number, or one for each row of a control.
#[derive(Clone, Serialize)]
#[serde(untagged)]
pub enum Derivative {
    Number(f64),
    Rows(Vec<f64>),
}

/// Other gradients of the same.
#[derive(Default, Serialize)]
pub struct Compare {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothed: Option<Other>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discretised: Option<Other>,
}

/// The gradient of what fixed steps compute.
#[derive(Serialize)]
pub struct Other {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    pub scheme: String,
    #[serde(rename = "N")]
    pub n: usize,
    #[serde(flatten)]
    pub gradient: Named<Derivative>,
}

/// The derivatives from both sides; nothing where a side has no trajectory to the end, or where the
/// value jumps there.
#[derive(Clone, Copy, Serialize)]
pub struct Sides {
    pub below: Option<f64>,
    pub above: Option<f64>,
}

/// What may keep a trajectory from having a derivative.
#[derive(Serialize)]
pub struct Reason {
    kind: &'static str,
    surface: String,
    time: f64,
}

impl GradientDocument {
    /// A gradient, or what there is instead of one; with second derivatives if they are wanted.
    pub fn new(of: &str, found: &Gradient, has_second: bool, model: &Model) -> Self {
        match &found.found {
            Ok(exact) => GradientDocument::with(of, found, exact, has_second, model),
            Err(simulation) => {
                GradientDocument::without(of, &found.system, simulation, model.source())
            }
        }
    }

    fn with(of: &str, found: &Gradient, exact: &Exact, has_second: bool, model: &Model) -> Self {
        let Gradient { system, by, .. } = found;
        let (source, method) = (model.source(), &model.meaning().method);
        let gradient = &exact.gradient;
        let units = Units::from(model);
        let mut warnings = doubts(system, exact, &units);
        warnings.extend(exact.found.kink.as_ref().map(|kink| kink_warning(kink, source, &units)));
        let second = has_second.then(|| found.second());
        let second = second.and_then(|found| found.map_err(|why| warnings.push(why)).ok());
        let mut other = |what: &str, found: Result<Stepped, String>| match found {
            Ok(stepped) => {
                warnings.extend(trap(what, &stepped, gradient).filter(|_| exact.is_trusted()));
                Some(Other::new(stepped, by, method))
            }
            Err(why) => {
                warnings.push(format!("there is no {what} gradient to compare with: {why}"));
                None
            }
        };
        let compare = Compare {
            smoothed: found.smoothed().and_then(|found| other("smoothed", found)),
            discretised: found.discretised().and_then(|found| other("discretised", found)),
        };
        let sides = sides(by, exact);
        let is_plain = exact.is_differentiable;
        let first = exact.found.nondifferentiabilities.first().filter(|_| !is_plain);
        GradientDocument {
            value: Some(exact.found.value),
            gradient: named(by, gradient),
            adjoint: named(by, &exact.adjoint),
            agreement: Some(exact.found.agreement),
            resolution: Some(exact.found.resolution),
            second: second.map(|rows| square(by, &rows)),
            compare,
            differentiable: is_plain,
            trusted: exact.is_trusted(),
            has_kink: exact.found.kink.is_some(),
            is_unresolved: !exact.is_resolved(),
            one_sided: (!is_plain && !sides.0.is_empty()).then_some(sides),
            cause: first.map(|found| Reason::new(system, found)),
            warnings,
            ..GradientDocument::without(of, system, &exact.found.simulation, source)
        }
    }

    /// The same with the units of its values.
    pub fn in_units(self, units: Units) -> Self {
        let display_units = units.shown();
        GradientDocument { units, display_units, ..self }
    }

    /// The same with the trajectory.
    pub fn with_trajectory(self, found: &Gradient, source: &SourceFile) -> Self {
        let simulation = match &found.found {
            Ok(exact) => &exact.found.simulation,
            Err(simulation) => simulation,
        };
        let states = found.system.states.iter().zip(&simulation.states);
        let states = states.filter(|(state, _)| !state.hidden);
        let trajectory = Some(Trajectory {
            time: simulation.time.clone(),
            states: states.map(|(it, column)| (it.name.clone(), column.clone())).collect(),
            source: source.text.to_string(),
        });
        GradientDocument { trajectory, ..self }
    }

    /// No gradient: the simulation does not reach the end.
    fn without(of: &str, system: &System, simulation: &Simulation, source: &SourceFile) -> Self {
        GradientDocument {
            fdcc: VERSION.to_string(),
            model: system.name.clone(),
            command: command::given(),
            of: of.to_string(),
            ending: Ending::new(system, simulation, source),
            value: None,
            gradient: Named(Vec::new()),
            adjoint: Named(Vec::new()),
            agreement: None,
            resolution: None,
            second: None,
            compare: Compare::default(),
            differentiable: false,
            trusted: false,
            has_kink: false,
            is_unresolved: false,
            one_sided: None,
            cause: None,
            events: events(system, simulation),
            warnings: Vec::new(),
            units: Units::default(),
            display_units: Named::default(),
            trajectory: None,
        }
    }
}

impl Reason {
    fn new(system: &System, found: &Nondifferentiability) -> Self {
        let surface = system.name_of(found.surface).to_owned();
        Reason { kind: kind_name(found.kind), surface, time: found.time }
    }

    /// `a grazing of \`zero\` at t = 1`
    pub fn words(&self, units: &Units) -> String {
        let Reason { kind, surface, time } = self;
        let time = units.value("time", *time, 9);
        match *kind {
            "grazing" => format!("`{surface}` is grazed at t = {time}"),
            "corner" => format!("`{surface}` meets another surface at t = {time}"),
            "coincident" => {
                format!(
                    "`{surface}` is met at t = {time}, when the controls change, at the start, or \
                     right after a jump there"
                )
            }
            "limit" => format!("`{surface}` is held as hard as it can be from t = {time} on"),
            _ => format!("`{surface}` is met at the end, t = {time}"),
        }
    }
}

fn kind_name(kind: NondifferentiabilityKind) -> &'static str {
    match kind {
        NondifferentiabilityKind::Grazing => "grazing",
        NondifferentiabilityKind::Corner => "corner",
        NondifferentiabilityKind::Coincident => "coincident",
        NondifferentiabilityKind::End => "end",
        NondifferentiabilityKind::Limit => "limit",
    }
}

fn unresolved(by: String) -> String {
    format!(
        "steps of half the length change it by {by}: do not trust this gradient; --max-step and \
         --rtol make steps shorter"
    )
}

/// What else is to be said of an exact gradient.
fn doubts(system: &System, exact: &Exact, units: &Units) -> Vec<String> {
    let mut doubts = Vec::new();
    if !exact.is_resolved() {
        doubts.push(unresolved(scientific(exact.found.resolution, 1)));
    }
    if exact.is_resolved() && !exact.knows_rests() {
        doubts.push(
            "some derivatives are the rest of what was larger by more than 1e12 on the way: their \
             digits are not known"
                .into(),
        );
    }
    if exact.found.resolution.is_nan() || exact.found.agreement.is_nan() {
        doubts.push("a derivative along the way has no value".into());
    } else if !exact.agrees() {
        let agreement = scientific(exact.found.agreement, 1);
        doubts
            .push(format!("forward and adjoint differ by {agreement}: do not trust this gradient"));
    }
    let mut agreed = exact.found.nondifferentiabilities.iter().filter(|_| exact.is_differentiable);
    if let Some(first) = agreed.next() {
        let others = agreed.count();
        let others = if others > 0 { format!(" (and {others} more)") } else { String::new() };
        let first = Reason::new(system, first).words(units);
        doubts.push(format!("{first}{others}; the derivatives from both sides agree"));
    }
    doubts
}

/// What is to be known of a kink that the trajectory stays on.
fn kink_warning(kink: &Kink, source: &SourceFile, units: &Units) -> String {
    let shown = |time: f64| units.value("time", time, 6);
    let line = source.line_column(kink.of.span.0).line;
    let which = format!(
        "a kink of `{}` (line {line}: `abs`, `min`, `max` or a knot of `piecewise`)",
        kink.of.label
    );
    let one_side = "the derivatives are those of one side of it";
    match kink.met {
        KinkMet::ByParameters => {
            format!("the parameters are on {which}: by them there is no derivative")
        }
        KinkMet::Since(time) => {
            format!("from t = {} on the state stays on {which}: {one_side}", shown(time))
        }
        KinkMet::ByJump(time) => {
            format!("the jump at t = {} is on {which}: {one_side}", shown(time))
        }
        KinkMet::BySurface(time) => {
            format!("at t = {} a surface is met on {which}: {one_side}", shown(time))
        }
        KinkMet::ByPile(time) => {
            format!(
                "`{}` (line {line}) is changed by infinitely many jumps until t = {}: what its \
                 limit depends on is not known",
                kink.of.label,
                shown(time)
            )
        }
        KinkMet::AtEnd => format!("the trajectory ends on {which}: {one_side}"),
    }
}

impl Other {
    fn new(stepped: Stepped, by: &[By], method: &Method) -> Self {
        let scheme = method.scheme.name();
        let gradient = named(by, &stepped.gradient);
        Other { sigma: stepped.sigma, scheme, n: method.intervals(), gradient }
    }
}

/// Values in the order of the quantities of all names, under those names.
fn named(by: &[By], values: &[f64]) -> Named<Derivative> {
    let mut rest = values;
    let mut next = |by: &By| {
        let (own, others) = rest.split_at(by.quantities.len());
        rest = others;
        let derivative =
            if by.is_control { Derivative::Rows(own.to_vec()) } else { Derivative::Number(own[0]) };
        (by.name.clone(), derivative)
    };
    by.iter().map(&mut next).collect()
}

/// A difference by this part of the exact gradient is one that misleads an optimiser.
const TRAP: f64 = 0.1;

/// What is to be said where another gradient is far off.
fn trap(what: &str, stepped: &Stepped, exact: &[f64]) -> Option<String> {
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        values.fold(0.0, |most: f64, it| most.max(it.abs()))
    };
    let size = largest(&mut exact.iter().copied());
    let error = largest(&mut stepped.gradient.iter().zip(exact).map(|(own, exact)| own - exact));
    if error > 10.0 * size {
        let [error, size] = [error, size].map(|value| significant(value, 2));
        return Some(format!(
            "the {what} gradient is off by {error}; the largest entry of the exact one is {size}"
        ));
    }
    let percent = significant(100.0 * error / size, 2);
    (error > TRAP * size)
        .then(|| format!("the {what} gradient is off by {percent} % of the exact one"))
}

/// The Hessian under the names of both its directions.
fn square(by: &[By], rows: &[Vec<f64>]) -> Named<Named<f64>> {
    let one = |by: &By| match by.is_control {
        true => (1..=by.quantities.len()).map(|row| format!("{}[{row}]", by.name)).collect(),
        false => vec![by.name.clone()],
    };
    let all: Vec<String> = by.iter().flat_map(one).collect();
    let names = || all.iter().cloned();
    names().zip(rows.iter().map(|row| names().zip(row.iter().copied()).collect())).collect()
}

/// Both one-sided derivatives by each quantity, as far as they are known.
fn sides(by: &[By], exact: &Exact) -> Named<Sides> {
    let sides = exact.sides.iter().map(|&[below, above]| Sides { below, above });
    by.iter().map(|by| by.name.clone()).zip(sides).collect()
}
