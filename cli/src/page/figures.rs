//! The plots of a page: which columns of its documents are drawn in which, with which units and
//! limits. A description holds no numbers of curves; it says where they stand.

use super::json::{Json, NULL};
use super::units::{Unit, of_condition, of_time, of_value, per};
use super::{impulses, measured, plots, sizes};
use serde::Serialize;

/// A plot over time.
#[derive(Debug, Serialize)]
pub struct Figure {
    /// What it is one of, such as `States`.
    pub group: &'static str,
    pub name: String,
    pub unit: Unit,
    pub curves: Vec<Curve>,
    pub limits: Vec<Limit>,
    /// What moves by no more than this, in SI, is constant.
    pub rounding: f64,
    /// What it measures in SI: what measures something else has an axis of its own.
    #[serde(skip)]
    measures: String,
}

impl Figure {
    /// Without any curve.
    pub fn new(group: &'static str, name: &str, unit: Unit) -> Self {
        let (name, measures) = (name.to_owned(), String::new());
        let (curves, limits) = (Vec::new(), Vec::new());
        Figure { group, name, unit, curves, limits, rounding: 0.0, measures }
    }

    /// What it is asked for by.
    pub fn signal(&self) -> String {
        match self.group {
            COSTATES => format!("costate({})", self.name),
            MULTIPLIERS => format!("multiplier({})", self.name),
            RESIDUALS => format!("residual({})", self.name),
            IMPULSES => format!("impulse({})", self.name),
            HAMILTONIAN => "hamiltonian".into(),
            _ => self.name.clone(),
        }
    }

    /// Whether it is drawn where nobody says what to draw: a state or a control.
    pub fn is_usual(&self) -> bool {
        [STATES, CONTROLS].contains(&self.group)
    }
}

/// A column of a document over another one.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Curve {
    pub label: String,
    /// Which of the documents.
    pub of: usize,
    pub kind: Kind,
    /// The keys that lead to the times.
    pub time: Vec<String>,
    /// The keys that lead to the values.
    pub values: Vec<String>,
    /// Its colour, where several signals are in one plot.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hue: Option<usize>,
    /// The keys that lead to the half lengths of error bars, and what they are multiplied by.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bars: Option<(Vec<String>, f64)>,
    /// The keys that lead to times and values between those of the grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub between: Option<[Vec<String>; 2]>,
    /// Whether its last value is that behind a jump: the next phase begins with it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub ends_in_jump: bool,
}

/// How a column is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    #[default]
    /// From each point to the next; both sides of a jump.
    Line,
    /// Constant from each time to the next.
    Steps,
    /// A line that the controls lead to on the true system.
    Replay,
    /// Measurements, each with its error bar.
    Points,
    /// What remains of measurements: each a line from 0.
    Stems,
}

impl Kind {
    /// Whether it is of measurements, between which nothing is known.
    pub fn is_measured(self) -> bool {
        matches!(self, Kind::Points | Kind::Stems)
    }

    /// Whether it is of what a document is about: no replay and no measurement.
    pub fn is_plan(self) -> bool {
        matches!(self, Kind::Line | Kind::Steps)
    }
}

/// A value that must not be passed, in SI.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limit {
    pub label: &'static str,
    pub value: f64,
    /// The time of the phases that have it; all of the time where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
}

/// What a group of plots shows: the key of its signals, and how they are drawn.
struct Group {
    title: &'static str,
    key: &'static str,
    kind: Kind,
}

const GROUPS: &[Group] = &[
    Group { title: STATES, key: "states", kind: Kind::Line },
    Group { title: CONTROLS, key: "controls", kind: Kind::Steps },
    Group { title: PATH, key: "path", kind: Kind::Line },
    Group { title: REPORTED, key: "report", kind: Kind::Line },
    Group { title: COSTATES, key: "costates", kind: Kind::Line },
    Group { title: MULTIPLIERS, key: "path_multipliers", kind: Kind::Steps },
];
pub const STATES: &str = "States";
pub const CONTROLS: &str = "Controls";
pub const PATH: &str = "Path conditions";
pub const REPORTED: &str = "Reported";
pub const COSTATES: &str = "Costates";
pub const MULTIPLIERS: &str = "Multipliers of path conditions";
pub const IMPULSES: &str = "Multipliers of bounds at one time";
pub const HAMILTONIAN: &str = "Hamiltonian";
pub const RESIDUALS: &str = "Residuals";
const WORK: &str = "Each step of the loop";

/// Whether a group stands behind what was measured.
pub fn is_drawn_late(group: &str) -> bool {
    [COSTATES, MULTIPLIERS, IMPULSES, HAMILTONIAN, WORK].contains(&group)
}

/// A document, or a phase of one: what has signals over a time of its own.
pub struct Part<'j> {
    pub of: usize,
    pub document: &'j Json,
    pub keys: Vec<String>,
    pub json: &'j Json,
}

impl Part<'_> {
    fn keys(&self, more: &[&str]) -> Vec<String> {
        self.keys.iter().cloned().chain(more.iter().map(|it| (*it).to_owned())).collect()
    }
}

/// The parts of documents, in their order.
pub fn parts(documents: &[Json]) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    for (of, document) in documents.iter().enumerate() {
        let phases = document.at("phases").pairs();
        if phases.is_empty() {
            parts.push(Part { of, document, keys: Vec::new(), json: document });
        }
        parts.extend(phases.iter().map(|(name, json)| {
            let keys = vec!["phases".to_owned(), name.clone()];
            Part { of, document, keys, json }
        }));
    }
    parts
}

/// All plots over time, group by group.
pub fn figures(documents: &[Json]) -> Vec<Figure> {
    let parts = parts(documents);
    let mut figures: Vec<Figure> = Vec::new();
    for group in GROUPS {
        for part in &parts {
            for (name, _) in part.json.at(group.key).pairs() {
                add(&mut figures, part, group, name);
            }
        }
    }
    impulses::add(documents, &mut figures);
    for part in parts.iter().filter(|part| !part.json.at("hamiltonian").is_absent()) {
        let unit = per(&of_value(part.document, "objective"), &of_time(part.document));
        let measures = si(part, "objective");
        let figure = figure(&mut figures, HAMILTONIAN, HAMILTONIAN, measures, || unit);
        figure.curves.push(steps(part, "hamiltonian"));
    }
    for part in parts.iter().filter(|part| !part.json.at("plant").is_absent()) {
        for name in ["iterations", "seconds"] {
            let unit = || of_value(&NULL, name);
            let figure = figure(&mut figures, WORK, name, String::new(), unit);
            figure.curves.push(steps(part, name));
        }
    }
    measured::add(documents, &mut figures);
    figures.extend(plots::over_time(documents, &figures));
    figures
}

/// Adds a signal of a part to the plot of its name.
fn add(figures: &mut Vec<Figure>, part: &Part, group: &Group, name: &str) {
    let measures = measures(part, group, name);
    let figure = figure(figures, group.title, name, measures, || unit(part, group, name));
    figure.curves.push(curve(part, group, name));
    figure.curves.extend(replay(part, group, name));
    let limits = limits(part, group, name);
    let rounding = match group.title {
        COSTATES => sizes::of_costate(part.document, part.json, name),
        _ => sizes::of_signal(&limits, figure.unit.si),
    };
    figure.rounding = figure.rounding.max(rounding);
    limits.into_iter().for_each(|limit| figure.limit(limit));
}

impl Figure {
    /// Adds a limit, or lengthens the one of the phase before.
    fn limit(&mut self, limit: Limit) {
        let is_alike = |it: &&mut Limit| {
            let is_same = it.label == limit.label && it.value == limit.value;
            is_same && (it.from.is_none() || it.from <= limit.from && limit.from <= it.to)
        };
        match self.limits.iter_mut().find(is_alike) {
            Some(known) => known.to = if known.to < limit.to { limit.to } else { known.to },
            None => self.limits.push(limit),
        }
    }
}

/// The plot of a name, which is made where there is none.
fn figure<'f>(
    figures: &'f mut Vec<Figure>,
    group: &'static str,
    name: &str,
    measures: String,
    unit: impl FnOnce() -> Unit,
) -> &'f mut Figure {
    let is_it = |it: &Figure| it.group == group && it.name == name && it.measures == measures;
    let known = figures.iter().position(is_it);
    let at = known.unwrap_or_else(|| {
        figures.push(Figure { measures, ..Figure::new(group, name, unit()) });
        figures.len() - 1
    });
    &mut figures[at]
}

/// What a signal measures, in SI: two solutions may have the same name for different things.
fn measures(part: &Part, group: &Group, name: &str) -> String {
    match group.title {
        COSTATES | MULTIPLIERS => format!("{} per {}", si(part, "objective"), si(part, name)),
        _ => si(part, name),
    }
}

fn si(part: &Part, name: &str) -> String {
    part.document.at("units").at(name).text().to_owned()
}

/// A column with a value for each interval.
fn steps(part: &Part, key: &str) -> Curve {
    let (time, values) = (part.keys(&["time"]), part.keys(&[key]));
    Curve { label: label(part), of: part.of, kind: Kind::Steps, time, values, ..Curve::default() }
}

fn label(part: &Part) -> String {
    part.keys.last().map_or("plan".to_owned(), |phase| format!("plan, {phase}"))
}

/// Controls that are not constant on each interval are drawn through the values that define them.
fn curve(part: &Part, group: &Group, name: &str) -> Curve {
    let has_nodes = group.key == "controls" && !part.json.at("control_nodes").is_absent();
    let (kind, time, values) = if has_nodes {
        let time = part.keys(&["control_nodes", "time"]);
        (Kind::Line, time, part.keys(&["control_nodes", "values", name]))
    } else if group.key == "path" {
        (group.kind, part.keys(&["time"]), part.keys(&["path", name, "values"]))
    } else {
        (group.kind, part.keys(&["time"]), part.keys(&[group.key, name]))
    };
    let ends_in_jump = group.key == "costates" && ends_in_jump(part, name);
    let replay = replay(part, group, name).filter(|_| follows_replay(part));
    let between = replay.map(|it| [it.time, it.values]);
    let (label, of) = (label(part), part.of);
    Curve { label, of, kind, time, values, between, ends_in_jump, ..Curve::default() }
}

/// Whether a solution is what its replay does, so that this is known between the few points of a
/// grid of high order: it is certified, and both are the same to more digits than are seen.
fn follows_replay(part: &Part) -> bool {
    let is_certified = part.document.at("certificate").at("certified").is_true();
    let gap = part.json.at("verification").at("state_gap").number();
    is_certified && gap.is_some_and(|gap| gap < SEEN)
}

/// Of how far a state moves.
const SEEN: f64 = 1e-5;

/// Whether the last step of a costate in a phase is a jump: the grid has the costate behind a
/// condition that is active until the phase ends, with which the next phase begins.
fn ends_in_jump(part: &Part, name: &str) -> bool {
    let values = part.json.at("costates").at(name).column();
    let [.., a, b, c] = values[..] else { return false };
    let is_link = !part.keys.is_empty();
    let [low, high] = [f64::min, f64::max].map(|of| values.iter().copied().fold(c, of));
    is_link && (c - b).abs() > JUMP * (b - a).abs() && (c - b).abs() > 0.01 * (high - low)
}

/// A step that is so many times the one before is a jump.
const JUMP: f64 = 8.0;

/// What a state does in the replay, if there was one.
fn replay(part: &Part, group: &Group, name: &str) -> Option<Curve> {
    let replay = part.json.at("verification").at("replay");
    let is_there = group.key == "states" && !replay.at("states").at(name).is_absent();
    let keys = |more: &[&str]| part.keys(&[&["verification", "replay"], more].concat());
    is_there.then(|| Curve {
        label: "replay".into(),
        of: part.of,
        kind: Kind::Replay,
        time: keys(&["time"]),
        values: keys(&["states", name]),
        ..Curve::default()
    })
}

fn unit(part: &Part, group: &Group, name: &str) -> Unit {
    let own = of_value(part.document, name);
    let objective = || of_value(part.document, "objective");
    match group.title {
        PATH => of_condition(part.document, name),
        COSTATES => per(&objective(), &own),
        MULTIPLIERS => per(&per(&objective(), &own), &of_time(part.document)),
        _ => own,
    }
}

fn limits(part: &Part, group: &Group, name: &str) -> Vec<Limit> {
    let bounds = match group.key {
        "states" | "controls" => part.json.at("bounds").at(name),
        "path" => part.json.at("path").at(name).at("bounds"),
        _ => return Vec::new(),
    };
    let all = ["min", "max"].into_iter().zip(bounds.column());
    let finite = all.filter(|(_, value)| value.is_finite());
    let time = part.json.at("time").column();
    let of_phase = |at: Option<&f64>| at.copied().filter(|_| !part.keys.is_empty());
    let [from, to] = [time.first(), time.last()].map(of_phase);
    finite.map(|(label, value)| Limit { label, value, from, to }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Vec<Figure> {
        figures(&[serde_json::from_str(text).expect("it is JSON")])
    }

    #[test]
    fn limits_of_phases_hold_in_them_and_go_on_where_they_are_the_same() {
        let all = of(r#"{"phases":{
            "a":{"time":[0,1],"controls":{"u":[9]},"bounds":{"u":[0,10]}},
            "b":{"time":[1,3],"controls":{"u":[1]},"bounds":{"u":[0,2]}}}}"#);
        let limits: Vec<_> = all[0].limits.iter().map(|it| (it.value, it.from, it.to)).collect();
        let [first, middle, last] = [Some(0.0), Some(1.0), Some(3.0)];
        assert_eq!(limits, [(0.0, first, last), (10.0, first, middle), (2.0, middle, last)]);
    }

    #[test]
    fn a_costate_that_jumps_at_the_end_of_a_phase_is_told_from_one_that_does_not() {
        let all = of(r#"{"phases":{"a":{"time":[0,1,2,3],
            "costates":{"x":[1,2,3,-50],"y":[1,2,3,4],"z":[5,5,5,5]}}}}"#);
        let jumps: Vec<bool> = all.iter().map(|it| it.curves[0].ends_in_jump).collect();
        assert_eq!(jumps, [true, false, false]);
    }

    /// `x` is a length in one document and a plain number in the other.
    #[test]
    fn what_measures_something_else_has_an_axis_of_its_own() {
        let document = |units: &str| {
            let text = format!(
                r#"{{"time":[0,1],"states":{{"x":[0,1]}},"costates":{{"x":[1,1]}},
                    "units":{units}}}"#
            );
            serde_json::from_str(&text).expect("it is JSON")
        };
        let count = |a: &str, b: &str| figures(&[document(a), document(b)]).len();
        assert_eq!(count(r#"{"x":"m"}"#, r#"{"x":"m"}"#), 2);
        assert_eq!(count(r#"{"x":"m"}"#, "{}"), 4);
        assert_eq!(count(r#"{"x":"m","objective":"J"}"#, r#"{"x":"m"}"#), 3);
    }
}
