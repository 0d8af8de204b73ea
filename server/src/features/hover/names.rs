//! Declared names: the declaration, the unit, and what the compiler makes of it.

use crate::context::Context;
use fdcc::language::{
    Definition, Kind, NamedUnit, Order, Smoothness, SurfaceReport, SymbolInformation,
};
use fdcc_grammar::comments;

/// Longer declarations are cut.
const MOST_LINES: usize = 12;

/// All that is known about a definition, in Markdown.
pub fn told(context: &Context<'_>, definition: usize) -> String {
    let names = context.snapshot().names();
    let it = &names.definitions[definition];
    let full = names.full_name(definition);
    let mut text =
        format!("```fdc\n{}\n```\n{}", declaration(context, it), headline(context, it, &full));
    if let Some(comment) = comment(context, it) {
        text += &format!("\n\n{comment}");
    }
    let (model, phase) = (context.without_mistakes(), names.phase_of(definition));
    let solved = || Some(format!("the last solve: {}", context.said()?.of_surface(&full)?));
    let facts = match it.kind {
        Kind::Surface => {
            let known = model.and_then(|it| it.surface(phase, &full)).map(surface);
            known.unwrap_or_default().into_iter().chain(solved()).collect()
        }
        Kind::Phase => model.and_then(|it| files(&it.files_of(&full))).into_iter().collect(),
        Kind::Argument | Kind::Column | Kind::Row | Kind::Model | Kind::Data => Vec::new(),
        _ => {
            let information = model.and_then(|it| it.information(phase, &full));
            information.map(|it| facts(&it)).unwrap_or_default()
        }
    };
    for fact in facts {
        text += &format!("\n\n{fact}");
    }
    text
}

/// The item as it is written, without what would fill the screen.
fn declaration(context: &Context<'_>, it: &Definition) -> String {
    let span = if it.kind == Kind::Row { it.span } else { it.item };
    let text = &context.snapshot().text.text[span.range()];
    let all = &context.snapshot().names().definitions;
    let rows = all.iter().find(|rows| rows.kind == Kind::Data && rows.span == it.span);
    match it.kind {
        Kind::Phase | Kind::Data if rows.is_some_and(|rows| rows.within.is_some()) => {
            rows.map_or("", |rows| &context.snapshot().text.text[rows.item.range()]).to_owned()
        }
        Kind::Phase => format!("phase {}", it.name),
        Kind::Model => format!("model {}", it.name),
        _ if text.lines().count() > MOST_LINES => {
            text.lines().take(MOST_LINES).map(|line| format!("{line}\n")).collect::<String>()
                + "..."
        }
        _ => text.to_owned(),
    }
}

/// Which phase is that of which file.
fn files(all: &[(&str, &str)]) -> Option<String> {
    let lines = all.iter().take(MOST_LINES).map(|(phase, file)| format!("\n- `{phase}`: `{file}`"));
    let more = match all.len().saturating_sub(MOST_LINES) {
        0 => String::new(),
        more => format!("\n- and {more} more"),
    };
    let count = format!("a phase for each of {} files", all.len());
    (!all.is_empty()).then(|| count + "\n" + &lines.collect::<String>() + &more)
}

/// `state, in m/s (found from the equations)`
fn headline(context: &Context<'_>, it: &Definition, full: &str) -> String {
    let named: Vec<&NamedUnit> =
        context.units().iter().filter(|unit| is_unit_of(unit, full)).collect();
    // Another phase may have the same name with another unit.
    let own: Vec<&NamedUnit> = named.iter().copied().filter(|unit| unit.span == it.span).collect();
    let units = if own.is_empty() { named } else { own };
    let kind = it.kind.word();
    let Some(first) = units.first() else { return kind.into() };
    let same = units.iter().all(|unit| unit.unit == first.unit);
    let shown: Vec<&str> =
        if same { vec![unit_text(first)] } else { units.iter().map(|it| unit_text(it)).collect() };
    let found = if first.written { "" } else { " (found from the equations)" };
    format!("{kind}, {}{found}", shown.join(", "))
}

fn is_unit_of(unit: &NamedUnit, name: &str) -> bool {
    unit.name == name || unit.name.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'))
}

fn unit_text(unit: &NamedUnit) -> &str {
    if unit.unit.is_empty() { "no unit" } else { &unit.unit }
}

/// What its author says about it, on the same line.
fn comment(context: &Context<'_>, it: &Definition) -> Option<String> {
    let text = &context.snapshot().text;
    let line = text.line(it.span.end);
    let own = comments(&text.text).into_iter().find(|comment| text.line(comment.start) == line)?;
    let words = text.text[own.range()].trim_start_matches(['#', '!']).trim();
    (!words.is_empty() && !words.starts_with("fdc:")).then(|| words.to_owned())
}

fn facts(it: &SymbolInformation) -> Vec<String> {
    let mut facts: Vec<String> = it.values.iter().map(|line| format!("`{line}`")).collect();
    facts.extend(it.rates.iter().map(|line| format!("`{line}`")));
    facts.extend(it.smoothness.as_ref().map(smoothness));
    facts.extend(it.derivatives.iter().map(|line| format!("`{line}`")));
    facts
}

/// `C^2 at x == pi`
pub fn smoothness(it: &Smoothness) -> String {
    let place = if it.knots.is_empty() {
        String::new()
    } else {
        format!(" at `{}`", it.knots.join("`, `"))
    };
    match it.order {
        Order::Always => "smooth: it has all derivatives".into(),
        order => format!("{order}{place}"),
    }
}

/// Gradient, jump, class and the condition for being held.
fn surface(report: SurfaceReport) -> Vec<String> {
    let SurfaceReport { gradient, jump, meaning, holding, .. } = report;
    let mut facts = vec![format!("**{meaning}**")];
    if !gradient.is_empty() {
        facts.push(format!("gradient `{}`", gradient.join(", ")));
        facts.push(format!("jump of its rate, above less below: `{jump}`"));
    }
    facts.extend(holding.iter().map(|condition| format!("held while `{condition}`")));
    facts
}
