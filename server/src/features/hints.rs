//! What the text does not say, shown in it: units that were found, when a surface is held, how
//! smooth a `piecewise` is.

use crate::client::Failure;
use crate::context::Context;
use fdcc_compiler::symbols::{Definition, Kind};
use fdcc_compiler::{Model, NamedUnit, Order, SurfaceReport, symbol_information};
use lsp_types::{InlayHint, InlayHintKind, InlayHintParams};

/// `textDocument/inlayHint`
pub fn hints(
    context: &Context<'_>,
    params: InlayHintParams,
) -> Result<Option<Vec<InlayHint>>, Failure> {
    let snapshot = context.snapshot();
    let wanted = snapshot.text.span(params.range);
    let mut found: Vec<(u32, String)> = Vec::new();
    found.extend(snapshot.analysis.units.iter().filter_map(unit));
    // Of a text with mistakes nothing more is known; old places are elsewhere by now.
    if let Some(model) = &snapshot.analysis.model {
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
        found.extend(definitions().filter_map(|it| smoothness(it, model, &snapshot.text.text)));
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
fn smoothness(it: &Definition, model: &Model, text: &str) -> Option<(u32, String)> {
    let has_pieces = matches!(it.kind, Kind::Function | Kind::Let)
        && text[it.item.range()].contains("piecewise");
    let found = symbol_information(model, &it.name).filter(|_| has_pieces)?.smoothness?;
    let text = match found.order {
        Order::Always => "smooth".into(),
        order => order.to_string(),
    };
    Some((it.item.end, text))
}
