//! What a solution says of itself, in the words of its model: enough to replay it and to start from
//! it. A solution in memory lends it, and so does a file.
//!
//! All numbers are in SI; one that is not finite counts as missing.

use fdcc_runtime::problem::{ControlShape, Scheme};

/// A solution by name.
///
/// ```
/// use fdcc::{Model, Options, Record};
///
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let solution = Model::from_text("hop", text)?.solve(&Options::default())?;
/// let record: Record = solution.record();
/// let (name, column) = record.states[0];
/// assert!(name == "x" && column.len() == record.time.len());
/// assert!(Model::from_text("hop", text)?.verify(&record)?.confirms(1e-6));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Record<'s> {
    /// The name of the model.
    pub model: &'s str,
    /// The unknowns.
    pub free: Vec<(&'s str, f64)>,
    /// The parameters.
    pub params: Vec<(&'s str, f64)>,
    /// How it was solved.
    pub settings: Settings<'s>,
    /// The grid points.
    pub time: &'s [f64],
    /// A value at each grid point; after a jump where one happens.
    pub states: Vec<(&'s str, &'s [f64])>,
    /// A value for each interval.
    pub controls: Vec<(&'s str, &'s [f64])>,
    /// What defines controls that are not constant on each interval.
    pub nodes: Option<NodesRecord<'s>>,
    /// The jumps, in their order.
    pub jumps: Vec<JumpRecord<'s>>,
    /// Those of the phases, by the names of their models, if there are any: then all signals are
    /// theirs.
    pub phases: Vec<Record<'s>>,
}

impl Record<'_> {
    /// Without parameters and unknowns, also of phases: those of a model hold that it drives.
    #[must_use]
    pub fn without_values(mut self) -> Self {
        for record in self.phases.iter_mut() {
            (record.params, record.free) = Default::default();
        }
        (self.params, self.free) = Default::default();
        self
    }
}

/// The settings of the method that a replay or a start depends on, as far as they are known.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
/// let record = solution.record();
/// assert_eq!(record.settings.intervals, Some(record.time.len() - 1));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Settings<'s> {
    /// The scheme, with its order.
    pub scheme: Option<Scheme>,
    /// The shape of controls on an interval.
    pub controls: Option<ControlShape>,
    /// The number of intervals.
    pub intervals: Option<usize>,
    /// The smoothing width of the first surface.
    pub sigma: Option<f64>,
    /// That of each surface.
    pub sigmas: Vec<(&'s str, f64)>,
    /// Whether these were chosen by a solve that came to its end.
    pub sigma_chosen: bool,
    /// The smoothing kernel.
    pub kernel: Option<&'s str>,
}

/// The values between which a control is linear, or through which it is a polynomial on each
/// interval.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let model = fdcc::Model::from_text("hop", text)?.with_method("scheme", "trapezoid")?;
/// let solution = model.with_method("controls", "linear")?.solve(&fdcc::Options::default())?;
/// let nodes = solution.record().nodes.expect("the control is linear");
/// assert_eq!(nodes.values[0].1.len(), nodes.time.len());
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct NodesRecord<'s> {
    /// When.
    pub time: &'s [f64],
    /// A value of each control at each of these times.
    pub values: Vec<(&'s str, &'s [f64])>,
}

/// A jump of a solution.
///
/// ```
/// let model = fdcc::Model::from_file("../models/bounce.fdc")?.with_method("N", 20)?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let record = solution.record();
/// assert!(record.jumps.iter().all(|it| it.jump == "bounce" && it.before.len() == 3));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct JumpRecord<'s> {
    /// Its name.
    pub jump: &'s str,
    /// When it happens.
    pub time: f64,
    /// All states before it.
    pub before: Vec<(&'s str, f64)>,
}

/// The value of a name.
pub(crate) fn find<T: Copy>(pairs: &[(&str, T)], name: &str) -> Option<T> {
    pairs.iter().find(|(own, _)| *own == name).map(|(_, value)| *value)
}

/// The number of a name, unless it is missing.
pub(crate) fn number(pairs: &[(&str, f64)], name: &str) -> Option<f64> {
    find(pairs, name).filter(|value| value.is_finite())
}

/// All numbers of a column, unless one is missing.
pub(crate) fn whole(column: &[f64]) -> Option<Vec<f64>> {
    column.iter().all(|value| value.is_finite()).then(|| column.to_vec())
}
