//! The plots of a page: which columns of its documents are drawn in which, with which units and
//! limits. A description holds no numbers of curves; it says where they stand.

use super::json::{Json, NULL};
use super::plots;
use super::units::{Unit, of_condition, of_time, of_value, per};
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
}

impl Figure {
    /// What it is asked for by.
    pub fn signal(&self) -> String {
        match self.group {
            COSTATES => format!("costate({})", self.name),
            MULTIPLIERS => format!("multiplier({})", self.name),
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
#[derive(Clone, Debug, Serialize)]
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
}

/// How a column is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// From each point to the next; both sides of a jump.
    Line,
    /// Constant from each time to the next.
    Steps,
    /// A line that the controls lead to on the true system.
    Replay,
}

/// A value that must not be passed, in SI.
#[derive(Debug, PartialEq, Serialize)]
pub struct Limit {
    pub label: &'static str,
    pub value: f64,
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
const PATH: &str = "Path conditions";
pub const REPORTED: &str = "Reported";
pub const COSTATES: &str = "Costates";
const MULTIPLIERS: &str = "Multipliers of path conditions";
pub const HAMILTONIAN: &str = "Hamiltonian";
const WORK: &str = "Each step of the loop";

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
                let figure = figure(&mut figures, group.title, name, || unit(part, group, name));
                figure.curves.push(curve(part, group, name));
                figure.curves.extend(replay(part, group, name));
                for limit in limits(part, group, name) {
                    if !figure.limits.contains(&limit) {
                        figure.limits.push(limit);
                    }
                }
            }
        }
    }
    for part in parts.iter().filter(|part| !part.json.at("hamiltonian").is_absent()) {
        let unit = || per(&of_value(part.document, "objective"), &of_time(part.document));
        let (time, values) = (part.keys(&["time"]), part.keys(&["hamiltonian"]));
        let (label, of, kind) = (label(part), part.of, Kind::Steps);
        let figure = figure(&mut figures, HAMILTONIAN, HAMILTONIAN, unit);
        figure.curves.push(Curve { label, of, kind, time, values, hue: None });
    }
    for part in parts.iter().filter(|part| !part.json.at("plant").is_absent()) {
        for name in ["iterations", "seconds"] {
            let (label, of, kind) = (label(part), part.of, Kind::Steps);
            let (time, values) = (part.keys(&["time"]), part.keys(&[name]));
            let figure = figure(&mut figures, WORK, name, || of_value(&NULL, name));
            figure.curves.push(Curve { label, of, kind, time, values, hue: None });
        }
    }
    figures.extend(plots::over_time(documents, &figures));
    figures
}

/// The plot of a name, which is made where there is none.
fn figure<'f>(
    figures: &'f mut Vec<Figure>,
    group: &'static str,
    name: &str,
    unit: impl FnOnce() -> Unit,
) -> &'f mut Figure {
    let known = figures.iter().position(|it| it.group == group && it.name == name);
    let at = known.unwrap_or_else(|| {
        let (name, unit) = (name.to_owned(), unit());
        figures.push(Figure { group, name, unit, curves: Vec::new(), limits: Vec::new() });
        figures.len() - 1
    });
    &mut figures[at]
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
    Curve { label: label(part), of: part.of, kind, time, values, hue: None }
}

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
        hue: None,
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
    finite.map(|(label, value)| Limit { label, value }).collect()
}
