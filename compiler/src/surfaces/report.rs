//! What is known about every surface of a model, as text: for `fdcc show` and for editors.

use super::ball::LocalBall;
use super::class::{Class, classify};
use super::degenerate::degenerate;
use super::holding::{holding, within_reach};
use super::local::Local;
use super::view::View;
use crate::model::numbers::Numbers;
use crate::model::{Model, Place, Symbol};
use fdcc_grammar::ast::Direction;

/// One surface in words.
#[derive(Clone, Debug)]
pub struct SurfaceReport {
    /// Its name and where it is declared, or used first.
    pub place: Place,
    /// Its function.
    pub function: String,
    /// Its derivatives by the states it depends on, and by time: `d/dv = 1`.
    pub gradient: Vec<String>,
    /// By how much its rate is larger above than below.
    pub jump: String,
    /// What is proved about it.
    pub class: Class,
    /// What it does to the trajectories that meet it.
    pub meaning: String,
    /// When it is held, if it ever is.
    pub holding: Option<String>,
}

/// All surfaces of a model, with its parameters at these values; the components of a `Dir` are one,
/// its vector.
pub(crate) fn surfaces(model: &Model, numbers: &Numbers) -> Vec<SurfaceReport> {
    let view = View::of_model(model, numbers);
    let switches = model.switches().into_iter();
    let reports = switches.map(|switch| match switch.is_ball {
        true => ball(&view, switch.surfaces.start, model, switch.place),
        false => report(&view, switch.surfaces.start, model),
    });
    reports.collect()
}

/// The vector of a `Dir`, whose first component is the surface `at`.
fn ball(view: &View<'_>, at: usize, model: &Model, place: &Place) -> SurfaceReport {
    let ball = view.balls.iter().find(|ball| ball.surfaces.start == at);
    let mut ball = ball.and_then(|ball| LocalBall::new(view, ball));
    let class = ball.as_mut().map_or(Class::Unknown { mixed: false }, LocalBall::classify);
    let holding = match (&class, ball) {
        (Class::Held, _) => Some("always".into()),
        (Class::Attracting, Some(mut ball)) => within_reach(&mut ball, view),
        _ => None,
    };
    SurfaceReport {
        place: place.clone(),
        function: format!("Dir({})", place.name),
        gradient: Vec::new(),
        jump: String::new(),
        meaning: in_words(&class, view, model).replace("on both sides", "in every direction"),
        class,
        holding,
    }
}

fn report(view: &View<'_>, at: usize, model: &Model) -> SurfaceReport {
    let place = view.surfaces[at].0.clone();
    let mut local = Local::new(view, at).expect("a model without errors knows its surfaces");
    let text = |local: &mut Local, expr| local.text(view, expr).unwrap_or_else(|| "...".into());
    let psi = local.psi;
    let function = text(&mut local, psi);
    let mut gradient: Vec<String> = Vec::new();
    for (state, slope) in local.gradient.clone() {
        gradient.push(format!(
            "d/d{} = {}",
            view.states[state].place.name,
            text(&mut local, slope)
        ));
    }
    if local.graph.as_number(local.in_time) != Some(0.0) {
        let slope = local.in_time;
        gradient.push(format!("d/dt = {}", text(&mut local, slope)));
    }
    let is_degenerate = degenerate(&mut local).is_some();
    local.add_rates(view, at);
    let class = if is_degenerate { Class::Degenerate } else { classify(&mut local) };
    let holding = match class {
        Class::Held => Some("always".into()),
        Class::Attracting => holding(&mut local, view, &[]),
        _ => None,
    };
    let jumps = model.jumps.iter().filter(|jump| jump.surface == at);
    let resets = jumps.map(|jump| {
        let way = if jump.direction == Direction::Falling { "falling" } else { "rising" };
        format!("; {way}, `{}` resets the state", jump.place.name)
    });
    let meaning = std::iter::once(in_words(&class, view, model)).chain(resets).collect();
    let jump = local.jump;
    let jump = text(&mut local, jump);
    SurfaceReport { place, function, gradient, jump, class, meaning, holding }
}

/// The class in words.
fn in_words(class: &Class, view: &View<'_>, model: &Model) -> String {
    let value = |it: &(Symbol, f64)| model.valued(&view.name(it.0), it.1);
    let text = match class {
        Class::Apart => "out of reach: the bounds keep every state away from it",
        Class::Crossed { strictly: true } => "crossed",
        Class::Crossed { strictly: false } => "crossed, or touched where both rates are 0",
        Class::Held => "held, whatever the controls",
        Class::Attracting => "held or crossed, never repelling",
        Class::Degenerate => "degenerate: its gradient vanishes on it",
        Class::Repelling => "repelling: pushes away on both sides",
        Class::RepellingFor(choice) => {
            let values = choice.iter().map(value).collect::<Vec<_>>().join(", ");
            return format!("repelling for some controls: pushes away on both sides at {values}");
        }
        Class::Unknown { mixed: true } => "repelling for some states within their bounds",
        Class::Unknown { mixed: false } => {
            "unknown: nothing is proved for all states within their bounds"
        }
    };
    text.into()
}
