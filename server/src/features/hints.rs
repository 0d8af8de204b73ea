//! What the text does not say, shown in it: units that were found, when a surface is held, how
//! smooth a `piecewise` is; and what the last solve of it said.

use crate::client::Failure;
use crate::context::Context;
use crate::snapshot::Snapshot;
use fdcc::language::{Definition, Kind, NamedUnit, Order, SurfaceReport};
use lsp_types::{InlayHint, InlayHintKind, InlayHintParams};

/// `textDocument/inlayHint`
pub fn hints(
    context: &Context<'_>,
    params: InlayHintParams,
) -> Result<Option<Vec<InlayHint>>, Failure> {
    let snapshot = context.snapshot();
    let wanted = snapshot.text.span(params.range);
    let mut found: Vec<(u32, String)> = Vec::new();
    found.extend(snapshot.units().iter().filter_map(unit));
    // Of a text with mistakes nothing more is known; old places are elsewhere by now.
    if snapshot.has_meaning() {
        let definitions = || {
            snapshot
                .names()
                .definitions
                .iter()
                .filter(|it| it.item.end >= wanted.start && it.item.start <= wanted.end)
        };
        let surfaces = || snapshot.surfaces();
        found.extend(
            definitions()
                .filter(|it| it.kind == Kind::Surface)
                .filter_map(|it| held(it, surfaces())),
        );
        found.extend(definitions().filter_map(|it| smoothness(it, snapshot)));
        if let Some(said) = context.said() {
            let objective = snapshot.objective().map(|it| it.end);
            found.extend(objective.zip(said.answer()));
            let surfaces = definitions().filter(|it| it.kind == Kind::Surface);
            found.extend(
                surfaces
                    .filter_map(|it| Some((it.item.end, said.of_surface(&it.name)?.to_owned()))),
            );
        }
    }
    found.retain(|it| wanted.start <= it.0 && it.0 <= wanted.end);
    found.sort();
    Ok(Some(found.into_iter().map(|(at, text)| hint(context, at, text)).collect()))
}

fn hint(context: &Context<'_>, at: u32, text: String) -> InlayHint {
    let position = context.snapshot().text.position(at);
    InlayHint {
        padding_left: Some(true),
        kind: Some(InlayHintKind::Type),
        ..InlayHint::new(position, text.into(), None, None, None, None, None, None)
    }
}

/// Behind a name whose unit follows from the equations. Parts of a vector would all stand at one
/// place.
fn unit(it: &NamedUnit) -> Option<(u32, String)> {
    let is_shown =
        !it.written && !it.unit.is_empty() && it.name != "objective" && !it.name.contains('.');
    is_shown.then(|| (it.span.end, format!("[{}]", it.unit)))
}

/// Behind a surface: what becomes of it.
fn held(it: &Definition, surfaces: &[SurfaceReport]) -> Option<(u32, String)> {
    let report = surfaces.iter().find(|report| report.place.span == it.span)?;
    let text = match &report.holding {
        Some(condition) if condition == "always" => "always held".into(),
        Some(condition) => format!("held while {condition}"),
        None => report.meaning.split([',', ':', ';']).next().unwrap_or_default().to_owned(),
    };
    Some((it.item.end, text))
}

/// Behind a definition in pieces: `C^2`.
fn smoothness(it: &Definition, snapshot: &Snapshot) -> Option<(u32, String)> {
    let has_pieces = matches!(it.kind, Kind::Function | Kind::Let)
        && snapshot.text.text[it.item.range()].contains("piecewise");
    let found = snapshot.information(None, &it.name).filter(|_| has_pieces)?.smoothness?;
    let text = match found.order {
        Order::Always => "smooth".into(),
        order => order.to_string(),
    };
    Some((it.item.end, text))
}
