//! The pictures of a page: an empty place for each, with its caption.

use super::arrays::Array;
use super::drawing::Drawing;
use super::figures::{COSTATES, Figure, HAMILTONIAN, Kind, RESIDUALS, STATES};
use super::json::Json;
use super::plots::PLOTS;
use super::tags::{escape, section};

/// What stays in sight while reading: which line is which (`curves` of the only document), the time
/// at the cursor.
pub fn tools(drawing: &Drawing, curves: &str) -> String {
    let key = |(at, name): (usize, &String)| {
        let name = if name.is_empty() { curves } else { name };
        format!("<span class=\"key key-{at}\">{}</span>\n", escape(name))
    };
    let mut keys: String = drawing.names.iter().enumerate().map(key).collect();
    let has =
        |kind: Kind| drawing.figures.iter().any(|it| it.curves.iter().any(|it| it.kind == kind));
    if has(Kind::Replay) {
        keys += "<span class=\"key key-replay\">replay on the true system</span>\n";
    }
    if has(Kind::Points) {
        keys += "<span class=\"key key-points\">measured</span>\n";
    }
    format!(
        "<div class=\"tools\">\n{keys}<span>drag to zoom all plots</span>\n\
         <button type=\"button\" id=\"whole\">whole time</button>\n\
         <span class=\"at\" id=\"at\"></span>\n</div>\n\
         <noscript><p>The plots need JavaScript; the numbers are in the files beside this \
         page.</p></noscript>\n"
    )
}

/// The strips, the plots over time, and one signal over another.
pub fn pictures(drawing: &Drawing) -> String {
    let rows = drawing.strips.iter().enumerate().filter(|(_, strips)| !strips.is_empty());
    let rows: String = rows.map(|(at, _)| strip_figure(drawing, at)).collect();
    let mut sections = String::new();
    if !rows.is_empty() {
        sections += &section("What holds when", &format!("<div class=\"plots\">\n{rows}</div>\n"));
    }
    sections += &asked(drawing);
    for group in drawing.figures.chunk_by(|a, b| a.group == b.group) {
        let first = drawing.figures.iter().position(|it| it.group == group[0].group);
        let first = first.expect("it is one of them");
        if group[0].group == PLOTS {
            continue;
        }
        let figures = group.iter().enumerate().map(|(at, figure)| {
            let place = first + at;
            let mut arrays = drawing.arrays.iter().filter(|it| it.figures.contains(&place));
            match arrays.next() {
                None => time_figure(figure, place),
                Some(array) if array.figures[0] == place => maps(drawing, &array.figures),
                Some(_) => String::new(),
            }
        });
        let figures = format!("<div class=\"plots\">\n{}</div>\n", figures.collect::<String>());
        sections += &section(heading(group[0].group), &figures);
        if group[0].group == STATES {
            sections += &portrait(drawing);
        }
    }
    sections
}

/// The pictures that the model asks for.
fn asked(drawing: &Drawing) -> String {
    let over_time = drawing.figures.iter().enumerate().filter(|it| it.1.group == PLOTS);
    let over_time = over_time.map(|(at, figure)| time_figure(figure, at));
    let wide = if drawing.portraits.len() == 1 { " class=\"wide\"" } else { "" };
    let portraits = drawing.portraits.iter().enumerate().map(|(at, it)| {
        format!(
            "<figure{wide}><figcaption>{} <button type=\"button\" class=\"play\">play</button>\
             <span class=\"legend\"></span></figcaption>\n\
             <div class=\"plot\" data-asked=\"{at}\"></div></figure>\n",
            escape(&it.name)
        )
    });
    let all: String = portraits.chain(over_time).collect();
    match all.is_empty() {
        true => all,
        false => section(PLOTS, &format!("<div class=\"plots\">\n{all}</div>\n")),
    }
}

fn heading(group: &str) -> &str {
    match group {
        COSTATES => "Costates: what the objective changes by with a state",
        RESIDUALS => "Residuals: the model less what was measured",
        HAMILTONIAN => "Hamiltonian: running cost, and costates times right side",
        other => other,
    }
}

fn strip_figure(drawing: &Drawing, at: usize) -> String {
    let name = escape(&drawing.names[at]);
    format!(
        "<figure class=\"wide\"><figcaption>{name}<output></output></figcaption>\n\
         <div class=\"plot\" data-strips=\"{at}\"></div></figure>\n"
    )
}

fn time_figure(figure: &Figure, at: usize) -> String {
    let unit = &figure.unit.name;
    let unit = if unit.is_empty() { String::new() } else { format!("[{}]", escape(unit)) };
    format!(
        "<figure><figcaption>{} <span class=\"unit\">{unit}</span>\
         <span class=\"legend\">{}</span><output></output></figcaption>\n\
         <div class=\"plot\" data-figure=\"{at}\"></div></figure>\n",
        escape(&figure.name),
        legend(figure)
    )
}

/// An array as a map of colours, one for each document, and below it a plot of each component.
fn maps(drawing: &Drawing, components: &[usize]) -> String {
    let own = drawing.arrays.iter().enumerate().filter(|it| it.1.figures == components);
    let map = |(at, array): (usize, &Array)| {
        let of = &drawing.names[array.of];
        let of = if drawing.names.len() == 1 { "" } else { of };
        format!(
            "<figure class=\"wide\"><figcaption>{} <span class=\"unit\">{}</span>{}\
             <output></output></figcaption>\n<div class=\"plot\" data-map=\"{at}\"></div>\
             </figure>\n",
            escape(&array.name),
            escape(of),
            array.scale()
        )
    };
    let each = |at: &usize| {
        let figure = time_figure(&drawing.figures[*at], *at);
        figure.replace("class=\"plot\" data-figure", "data-later")
    };
    format!(
        "{}<details class=\"each\"><summary>each of the {}</summary>\n<div class=\"plots\">\n{}\
         </div></details>\n",
        own.map(map).collect::<String>(),
        components.len(),
        components.iter().map(each).collect::<String>()
    )
}

/// Which colour is which signal.
fn legend(figure: &Figure) -> String {
    let mut named: Vec<(usize, &str)> =
        figure.curves.iter().filter_map(|it| Some((it.hue?, &it.label[..]))).collect();
    named.dedup();
    let key = |(hue, label): (usize, &str)| {
        format!("<span class=\"key key-{}\">{}</span>", hue % HUES, escape(label))
    };
    named.into_iter().map(key).collect()
}

/// How many colours there are.
const HUES: usize = 8;

/// One signal over another, where there are two.
fn portrait(drawing: &Drawing) -> String {
    let states = || drawing.figures.iter().filter(|it| it.group == STATES);
    let has_two = |of: usize| {
        let own = states().filter(|it| it.curves.iter().any(|curve| curve.of == of));
        own.count() >= 2
    };
    if !(0..drawing.names.len()).any(has_two) {
        return String::new();
    }
    let choice = |id: &str| format!("<select id=\"{id}\"></select>");
    section(
        "One over another",
        &format!(
            "<p class=\"choice\"><label>draw {}</label> <label>over {}</label> <label><input \
             type=\"checkbox\" id=\"to-scale\"/> to scale</label></p>\n<figure><div class=\"plot\" \
             data-portrait=\"\"></div></figure>\n",
            choice("of"),
            choice("over")
        ),
    )
}

/// How each of the solves went.
pub fn convergence(documents: &[Json], names: &[&str]) -> String {
    let has_any = |it: &(usize, &Json)| !it.1.at("convergence").is_absent();
    let figure = |(at, _): (usize, &Json)| {
        format!(
            "<figure class=\"wide\"><figcaption>{} <span class=\"legend\"></span>\
             <output></output></figcaption>\n<div class=\"plot\" data-convergence=\"{at}\"></div>\
             </figure>\n",
            escape(names[at])
        )
    };
    let figures: String = documents.iter().enumerate().filter(has_any).map(figure).collect();
    match figures.is_empty() {
        true => figures,
        false => section("Convergence", &format!("<div class=\"plots\">\n{figures}</div>\n")),
    }
}
