//! What shows that an answer is an optimum of the true system, as data and in words.

use super::modes::{Span, switching, touches};
use super::named::Named;
use super::number::scientific;
use super::units::Units;
use fdcc::names::mode_name;
use fdcc::true_optimum;
use serde::Serialize;

/// All checks, with what was located.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Whether all checks pass: then the answer is the located one, else the smoothed one.
    pub certified: bool,
    pub checks: Vec<Check>,
    pub switches: Vec<Switch>,
    /// What each control does from when to when: `min`, `max` or `free`.
    pub arcs: Named<Vec<Span>>,
    /// The multipliers of bounds that act at one time, by the names of their conditions.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub impulses: Named<Impulses>,
    /// Whether nothing switches and nothing jumps, so that only the grid stands between.
    #[serde(skip)]
    is_smooth: bool,
}

/// One figure of the true system.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    pub check: &'static str,
    pub figure: f64,
    /// A larger figure fails.
    pub limit: f64,
    pub passes: bool,
}

/// A change of the mode of a surface.
#[derive(Clone, Debug, Serialize)]
pub struct Switch {
    pub surface: String,
    pub time: f64,
    pub from: &'static str,
    pub to: &'static str,
    /// The multiplier of `psi = 0`: what the costates lose there is `kappa dpsi/dx`.
    pub kappa: Option<f64>,
    /// How far from grazing, as in the events of a simulation.
    pub margin: Option<f64>,
}

/// Multipliers of a bound: what the objective changes by with it at each of these times alone.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Impulses {
    time: Vec<f64>,
    values: Vec<f64>,
}

/// By condition, in the order in which these come first.
fn impulses(all: &[true_optimum::Impulse]) -> Named<Impulses> {
    let mut named: Vec<(String, Impulses)> = Vec::new();
    for it in all {
        if named.iter().all(|(name, _)| *name != it.condition) {
            named.push((it.condition.clone(), Impulses::default()));
        }
        let own = named.iter_mut().filter(|(name, _)| *name == it.condition);
        own.for_each(|(_, own)| {
            own.time.push(it.time);
            own.values.push(it.multiplier);
        });
    }
    Named(named)
}

/// What a certificate speaks of.
pub fn system(is_smooth: bool) -> &'static str {
    if is_smooth { "continuous problem" } else { "true system" }
}

impl Certificate {
    pub fn new(it: &true_optimum::Certificate, is_smooth: bool) -> Self {
        let check = |it: &true_optimum::Check| Check {
            check: it.name,
            figure: it.figure,
            limit: it.limit,
            passes: it.passes(),
        };
        let switch = |it: &true_optimum::Switch| Switch {
            surface: it.surface.clone(),
            time: it.time,
            from: mode_name(it.from),
            to: mode_name(it.to),
            kappa: it.kappa,
            margin: it.margin,
        };
        let stretch =
            |it: &true_optimum::Stretch| Span { mode: it.arc.into(), from: it.from, to: it.to };
        let arcs = it.arcs.iter();
        Certificate {
            certified: it.is_certified(),
            checks: it.checks.iter().map(check).collect(),
            switches: it.switches.iter().map(switch).collect(),
            arcs: arcs.map(|(name, of)| (name.clone(), of.iter().map(stretch).collect())).collect(),
            impulses: impulses(&it.impulses),
            is_smooth,
        }
    }

    fn figure(&self, name: &str) -> f64 {
        self.checks.iter().find(|it| it.check == name).map_or(f64::NAN, |it| it.figure)
    }

    /// The first line of a certified answer, which `found` something; without an objective it is no
    /// optimum.
    pub fn headline(&self, found: &str, has_objective: bool, jumps: usize) -> String {
        let located = match self.is_smooth {
            true => String::new(),
            false => format!(" {},", self.located(jumps)),
        };
        let replayed = self.figure("replayed").max(self.figure("conditions"));
        let replayed = scientific(replayed, 1);
        let of = format!("{found} of the {},{located} replayed to {replayed}", self.system());
        if !has_objective {
            return of;
        }
        let stationary = scientific(self.figure("stationary"), 1);
        format!("{of}, stationary to {stationary}, second order ok")
    }

    fn located(&self, jumps: usize) -> String {
        let all: Vec<_> =
            self.switches.iter().map(|it| (&it.surface[..], it.time, it.to)).collect();
        located(&all, jumps)
    }

    fn system(&self) -> &'static str {
        system(self.is_smooth)
    }

    /// Why it is not certified, in a line; nothing if it is.
    pub fn failure(&self) -> Option<String> {
        let failed = self.checks.iter().filter(|it| !it.passes);
        let failed = all_missed(failed.map(|it| (it.check, [it.figure, it.limit])));
        let what = failed.join(", ");
        let system = self.system();
        (!failed.is_empty()).then(|| format!(" true  no certified optimum of the {system}: {what}"))
    }

    /// What may help where it is not certified.
    pub fn advice(&self) -> Option<&'static str> {
        let is_stopped = self.checks.iter().any(|it| it.check == "finished");
        (!self.certified && !is_stopped).then_some(match self.is_smooth {
            true => {
                "       try another guess, or --starts 8; --method N=... asks for the problem on \
                 so many intervals alone"
            }
            false => {
                "       try another N, scheme or guess, or --starts 8; --method sigma=... asks for \
                 the smoothed problem alone"
            }
        })
    }

    /// What each control does that is at a bound anywhere.
    pub fn lines<'c>(&'c self, units: &'c Units) -> impl Iterator<Item = String> + 'c {
        let moves = self.arcs.0.iter().filter(|(_, all)| all.iter().any(|it| it.mode != "free"));
        moves
            .filter(|_| self.certified)
            .map(|(name, all)| format!(" {name:<5} {}", switching(all, units)))
    }
}

/// How many switches and jumps were located: `2 switches and 1 jump located`. Of each switch its
/// surface, the time and the new mode; a surface that is held for no time is touched.
pub fn located(switches: &[(&str, f64, &str)], jumps: usize) -> String {
    let touches = touches(switches);
    let switches = switches.len() - 2 * touches;
    let count = |number: usize, one: &str, many: &str| match number {
        0 => None,
        1 => Some(format!("1 {one}")),
        _ => Some(format!("{number} {many}")),
    };
    let all = [
        count(switches, "switch", "switches"),
        count(touches, "touch", "touches"),
        count(jumps, "jump", "jumps"),
    ];
    let all: Vec<String> = all.into_iter().flatten().collect();
    match all.split_last() {
        None => "no switch to locate".into(),
        Some((last, [])) => format!("{last} located"),
        Some((last, others)) => format!("{} and {last} located", others.join(", ")),
    }
}

/// What checks that fail say, each sentence once.
pub fn all_missed<'c>(failed: impl Iterator<Item = (&'c str, [f64; 2])>) -> Vec<String> {
    let mut all: Vec<String> = failed.map(|(check, figures)| missed(check, figures)).collect();
    all.dedup();
    all
}

/// What a check that fails says: its figure is above its limit.
fn missed(check: &str, [figure, limit]: [f64; 2]) -> String {
    let is_unknown = !figure.is_finite();
    let (figure, limit) = (scientific(figure, 1), scientific(limit, 0));
    match check {
        "located" => "no structure of phases could be solved".into(),
        "finished" => "the search was stopped".into(),
        "without data" => "switches are not located yet where measured data are added up".into(),
        "second order" => "a direction of negative curvature".into(),
        "insertion" if is_unknown => {
            "whether a hold at a switch is better could not be found out".into()
        }
        "insertion" => format!(
            "the objective falls with a hold at a switch by {figure} of its size per time (limit \
             {limit})"
        ),
        "contacts" if is_unknown => {
            "the motion is kept from the surface of a jump, or on it in the end; or it goes along \
             a surface on one side of it, or is pushed onto a kink"
                .into()
        }
        "replayed" | "objective" | "conditions" | "modes" if is_unknown => {
            "the replay does not reach the end".into()
        }
        "contacts" => format!(
            "the multiplier of a limit at its bound has the wrong sign by {figure} (limit {limit})"
        ),
        "holds" => "a surface that repels is held".into(),
        "replayed" => format!("the replay is off by {figure} (limit {limit})"),
        "timing" if is_unknown => "a replay of controls a moment early or late does not end".into(),
        "timing" => format!(
            "controls that come a moment early or late lead elsewhere, by {figure} (limit {limit})"
        ),
        "objective" => {
            format!("the objective of the replay is another one by {figure} (limit {limit})")
        }
        "conditions" => format!("the replay violates a condition by {figure} (limit {limit})"),
        "modes" => format!("the replay is in other modes on {figure} of the time (limit {limit})"),
        "bounds" => {
            format!("a control leaves its bounds by {figure} between nodes (limit {limit})")
        }
        "minimum" | "controls" | "arcs" | "hamiltonian" if is_unknown => {
            format!("a value of the check `{check}` is no number")
        }
        "minimum" => format!(
            "another control makes the Hamiltonian less by {figure} of its size (limit {limit})"
        ),
        "controls" => format!(
            "between their nodes controls lose {figure} of the objective's size (limit {limit})"
        ),
        "arcs" => format!("a bound multiplier has the wrong sign by {figure} (limit {limit})"),
        "hamiltonian" => format!(
            "the Hamiltonian changes inside of a phase by {figure} of its size (limit {limit})"
        ),
        name => format!("{name} {figure} (limit {limit})"),
    }
}
