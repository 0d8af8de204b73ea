//! The page of a solution: one HTML file that needs nothing else. The text is written here, the
//! plots are drawn in the browser by uPlot (`docs/decisions/0037-the-page-of-a-solution.md`).
//!
//! The page is made from the JSON document of the solve and holds it, with fewer digits.

pub mod arrays;
mod cells;
mod colours;
mod curves;
mod drawing;
mod estimates;
pub mod figures;
mod gradient;
mod headline;
mod impulses;
pub mod json;
mod located;
mod maps;
mod measured;
mod moves;
pub mod notebook;
pub mod pdf;
pub mod plots;
mod runs;
mod sections;
mod sizes;
mod strips;
pub mod svg;
pub mod sweep;
mod tables;
mod tags;
mod units;
mod unsolved;
mod verified;
mod whole;

use drawing::Drawing;
use headline::{Claim, Mark, claims, mark, title};
use json::Json;
use sections::{convergence, pictures, tools};
use tags::escape;

const STYLE: &str =
    concat!(include_str!("assets/uplot/uPlot.min.css"), "\n", include_str!("assets/page.css"));
const LIBRARY: &str = include_str!("assets/uplot/uPlot.iife.min.js");
const LICENSE: &str = include_str!("assets/uplot/LICENSE");
const SCRIPT: &str = concat!(
    include_str!("assets/data.js"),
    include_str!("assets/plot.js"),
    include_str!("assets/strips.js"),
    include_str!("assets/map.js"),
    include_str!("assets/portrait.js"),
    include_str!("assets/convergence.js"),
    include_str!("assets/main.js")
);
/// A canvas has at least this many pixels for each of the page: enough to be printed.
const PIXELS: &str = "Object.defineProperty(window, \"devicePixelRatio\", { value: \
                      Math.max(2, window.devicePixelRatio) });";

/// The page of the JSON text of a document.
pub fn of(document: &str) -> String {
    let document = serde_json::from_str(document).expect("we have just written it");
    page(&[document], &[""])
}

/// The page of several documents with their names.
pub fn page(documents: &[Json], names: &[&str]) -> String {
    let drawing = Drawing::new(documents, names);
    let body = [
        header(documents, names),
        of_each(documents, names, runs::first_tables),
        tools(&drawing, runs::curves(&documents[0])),
        pictures(&drawing),
        convergence(documents, names),
        of_each(documents, names, tables::tables),
        data(documents, &drawing),
    ];
    let model = escape(documents[0].at("model").text());
    let body = body.concat();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <title>{model}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}\
         <script>{PIXELS}</script>\n<!-- uPlot:\n{LICENSE}-->\n<script>{LIBRARY}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n"
    )
}

/// Sections of each document, with its name in their headings where there are several.
fn of_each(documents: &[Json], names: &[&str], sections: fn(&Json) -> String) -> String {
    let of = |(document, name): (&Json, &&str)| match documents.len() {
        1 => sections(document),
        _ => {
            let name = format!(" <span class=\"of\">{}</span></h2>", escape(name));
            sections(document).replace("</h2>", &name)
        }
    };
    documents.iter().zip(names).map(of).collect()
}

fn header(documents: &[Json], names: &[&str]) -> String {
    let params = tables::differing(documents);
    let is_open = documents.len() == 1;
    let verdicts = documents.iter().zip(names);
    let verdicts: String = verdicts.map(|(it, name)| verdict(it, name, &params, is_open)).collect();
    format!("<header class=\"verdicts\">\n{verdicts}</header>\n")
}

/// A headline with its claims, which are unfolded where there is room.
fn verdict(document: &Json, name: &str, params: &[&str], is_open: bool) -> String {
    let name = if name.is_empty() { document.at("model").text() } else { name };
    format!(
        "<div>\n<p class=\"model\">{}</p>\n<h1 class=\"{}\">{}</h1>\n{}<details{}>\n\
         <summary>what is certain, and what is not</summary>\n<ul class=\"claims\">\n{}</ul>\n\
         </details>\n</div>\n",
        escape(name),
        class(mark(document)),
        escape(&title(document)),
        tables::tiles(document, params),
        if is_open { " open=\"\"" } else { "" },
        claims(document).iter().map(sentence).collect::<String>(),
    )
}

fn sentence(Claim { mark, text }: &Claim) -> String {
    let (class, word) = (class(*mark), word(*mark));
    format!("<li><b class=\"{class}\">{word}</b><span>{}</span></li>\n", escape(text))
}

fn class(mark: Mark) -> &'static str {
    match mark {
        Mark::Certain => "certain",
        Mark::Open => "open",
        Mark::Wrong => "wrong",
    }
}

fn word(mark: Mark) -> &'static str {
    match mark {
        Mark::Certain => "✓ holds",
        Mark::Open => "? open",
        Mark::Wrong => "✗ fails",
    }
}

fn data(documents: &[Json], drawing: &Drawing) -> String {
    let script = |id: String, json: String| {
        // A text in the model must not end the element.
        let json = json.replace('<', "\\u003c");
        format!("<script type=\"application/json\" id=\"{id}\">{json}</script>\n")
    };
    let text = |it: &Json| serde_json::to_string(it).expect("keys are texts");
    let solutions = documents.iter().enumerate();
    let solutions: String =
        solutions.map(|(at, it)| script(format!("solution-{at}"), text(it))).collect();
    solutions + &script("page".into(), serde_json::to_string(drawing).expect("keys are texts"))
}
