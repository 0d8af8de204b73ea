//! What shows that a located answer is a local optimum of the system that was written: figures of
//! the true system, each with its limit.

use super::tuning::structure::{MOST_HALVINGS, MOST_OF_ALL};
use fdcc_runtime::solution::modes::Mode;
use std::cmp::Ordering;

/// Everything that was checked of a located answer.
///
/// ```
/// let model = fdcc::Model::from_file("../models/block.fdc")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let certificate = solution.certificate.as_ref().expect("the model has a surface");
/// assert!(certificate.is_certified() && (solution.objective() - 65.956825710).abs() < 1e-7);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Certificate {
    /// In the order in which they are told.
    pub checks: Vec<Check>,
    /// Where a surface changes its mode, in the order of time.
    pub switches: Vec<Switch>,
    /// What each control does from when to when.
    pub arcs: Vec<(String, Vec<Stretch>)>,
    /// The multipliers of bounds that act at one time, in the order of time.
    pub impulses: Vec<Impulse>,
}

/// The multiplier of the bound of a state or a path condition at one time, where it is touched, or
/// where an arc at it begins or ends: what the objective of the model changes by with the bound at
/// that time alone, in units of the objective by those of the condition. On an arc the multiplier
/// is one over time (Hartl, Sethi, Vickson, *SIAM Review* 37, 1995, section 4).
///
/// ```
/// // Bryson and Denham, 1963: it touches 1/5 at 1/2, and the least effort is 4 + 12*(1 - 4*l)^2.
/// let text = "time t in [0, 1]\nstate x start 0\nstate v start 1\ncontrol u
/// dynamics { x' = v  v' = u }\npath top: x <= 0.2\nend x == 0\nend v == -1
/// minimize integral(u^2)";
/// let solution = fdcc::Model::from_text("denham", text)?.solve(&fdcc::Options::default())?;
/// let [touch] = &solution.certificate.as_ref().expect("it is looked for").impulses[..] else {
///     panic!("it is touched once")
/// };
/// assert!(touch.condition == "top" && (touch.time - 0.5).abs() < 1e-6);
/// assert!((touch.multiplier + 96.0 * (1.0 - 4.0 * 0.2)).abs() < 1e-4);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Impulse {
    /// The name of the state or the path condition.
    pub condition: String,
    /// When it acts.
    pub time: f64,
    /// How large it is.
    pub multiplier: f64,
}

/// A change of the mode of a surface.
///
/// ```
/// let model = fdcc::Model::from_file("../models/block.fdc")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let certificate = solution.certificate.as_ref().expect("the model has a surface");
/// assert!(certificate.switches.iter().all(|switch| switch.surface == "slip"));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Switch {
    /// The surface.
    pub surface: String,
    /// When it happens.
    pub time: f64,
    /// Before it.
    pub from: Mode,
    /// After it.
    pub to: Mode,
    /// The multiplier of `psi = 0`, in units of the objective by those of `psi`: before the switch
    /// the costates are those behind it and `kappa dpsi/dx` (Bryson & Ho, *Applied Optimal
    /// Control*, 1975, section 3.7). Not of a `Dir`, and not beside a jump.
    pub kappa: Option<f64>,
    /// How far the true system is from grazing, as the `margin` of an event; nothing where its
    /// replay does not switch there.
    pub margin: Option<f64>,
}

/// A control at a bound, or free.
///
/// ```
/// let model = fdcc::Model::from_file("../models/block.fdc")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let certificate = solution.certificate.as_ref().expect("the model has a surface");
/// assert!(certificate.arcs.iter().all(|(control, arcs)| control == "F" && arcs.len() == 1));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stretch {
    /// `min`, `max` or `free`.
    pub arc: &'static str,
    /// When it begins.
    pub from: f64,
    /// When it ends.
    pub to: f64,
}

/// One figure, and what it may be at most.
///
/// ```
/// let model = fdcc::Model::from_file("../models/block.fdc")?;
/// let solution = model.solve(&fdcc::Options::default())?;
/// let certificate = solution.certificate.as_ref().expect("the model has a surface");
/// assert!(certificate.checks.iter().all(|check| check.figure <= check.limit));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Check {
    /// In one word or two.
    pub name: &'static str,
    /// What was measured.
    pub figure: f64,
    /// What it may be.
    pub limit: f64,
}

impl Check {
    /// Whether it is within its limit; what is not a number is not.
    pub fn passes(&self) -> bool {
        self.figure <= self.limit
    }
}

impl Certificate {
    /// Whether all checks pass.
    pub fn is_certified(&self) -> bool {
        !self.checks.is_empty() && self.checks.iter().all(Check::passes)
    }

    /// Whether nothing is wrong but that the replay differs from what was planned.
    pub(crate) fn is_inaccurate(&self) -> bool {
        let mut failing = self.checks.iter().filter(|check| !check.passes()).peekable();
        failing.peek().is_some()
            && failing.all(|it| {
                matches!(it.name, "replayed" | "objective" | "conditions" | "modes" | "bounds")
            })
    }

    /// How often intervals may be halved for that. Where states or conditions alone differ they are
    /// as accurate as their intervals are short; an objective may depend on what no grid sees.
    pub(crate) fn most_halvings(&self) -> u32 {
        let is_simple = |it: &&Check| matches!(it.name, "replayed" | "conditions");
        let mut failing = self.checks.iter().filter(|check| !check.passes());
        if failing.all(|it| is_simple(&it)) { MOST_OF_ALL } else { MOST_HALVINGS }
    }

    /// Where no structure could be solved (`located`), the search was stopped from outside
    /// (`finished`), or there are sums over measured data (`without data`).
    pub(crate) fn nothing_located(name: &'static str) -> Self {
        let check = Check { name, figure: f64::INFINITY, limit: 0.0 };
        Certificate { checks: vec![check], ..Certificate::default() }
    }

    /// With the names of its surfaces and controls as the whole calls those of a phase.
    pub(crate) fn of_phase(mut self, phase: &str) -> Self {
        for name in self.switches.iter_mut().map(|it| &mut it.surface) {
            *name = format!("{phase}.{name}");
        }
        self.arcs.iter_mut().for_each(|(name, _)| *name = format!("{phase}.{name}"));
        for name in self.impulses.iter_mut().map(|it| &mut it.condition) {
            *name = format!("{phase}.{name}");
        }
        self
    }

    /// Without the names of these phases before those of surfaces and controls; what a control does
    /// in one phase after the other is told at once.
    pub(crate) fn of_whole(self, phases: &[String]) -> Self {
        let own = |name: &str| {
            let short = phases.iter().find_map(|it| name.strip_prefix(&**it)?.strip_prefix('.'));
            short.unwrap_or(name).to_owned()
        };
        let mut arcs: Vec<(String, Vec<Stretch>)> = Vec::new();
        for (name, all) in self.arcs {
            let name = own(&name);
            match arcs.iter_mut().find(|it| it.0 == name) {
                Some((_, known)) => known.extend(all),
                None => arcs.push((name, all)),
            }
        }
        let switch = |it: Switch| Switch { surface: own(&it.surface), ..it };
        let switches = self.switches.into_iter().map(switch).collect();
        let impulse = |it: Impulse| Impulse { condition: own(&it.condition), ..it };
        let impulses = self.impulses.into_iter().map(impulse).collect();
        Certificate { checks: self.checks, switches, arcs, impulses }
    }

    /// That of two phases: the worse figure of each check.
    pub(crate) fn with(mut self, other: Self) -> Self {
        for (own, its) in self.checks.iter_mut().zip(other.checks) {
            if its.figure.partial_cmp(&own.figure).is_none_or(Ordering::is_gt) {
                *own = its;
            }
        }
        self.switches.extend(other.switches);
        self.arcs.extend(other.arcs);
        self.impulses.extend(other.impulses);
        self
    }

    /// With a check in place of that of the same name.
    pub(crate) fn put(&mut self, check: Check) {
        match self.checks.iter_mut().find(|it| it.name == check.name) {
            Some(own) => *own = check,
            None => self.checks.push(check),
        }
    }

    /// The one of two with fewer checks that fail.
    pub(crate) fn least(self, other: Self) -> Self {
        let missing = |it: &Self| match it.checks.len() {
            // Nothing was located.
            1 => usize::MAX,
            _ => it.checks.iter().filter(|check| !check.passes()).count(),
        };
        if missing(&other) < missing(&self) { other } else { self }
    }

    /// A figure by its name.
    pub fn figure(&self, name: &str) -> Option<f64> {
        self.checks.iter().find(|check| check.name == name).map(|check| check.figure)
    }
}
