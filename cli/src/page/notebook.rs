//! A solution as a part of a page of others, such as a notebook: without scripts, which are removed
//! there.

use super::arrays::arrays;
use super::figures::figures;
use super::headline::{claims, mark, title};
use super::json::Json;
use super::tags::escape;
use super::{class, sentence, svg, tables};

/// It applies to nothing else on the page.
const STYLE: &str = ".fdcc{font:15px/1.45 system-ui,sans-serif;max-width:700px}\
.fdcc h3{margin:0}.fdcc ul{list-style:none;margin:.5em 0;padding:0}\
.fdcc b{display:inline-block;width:5em}.fdcc .certain{color:#14713d}.fdcc .open{color:#8a5a00}\
.fdcc .wrong{color:#b3261e}.fdcc dl{display:flex;gap:2em}.fdcc dd{margin:0;font-weight:600}\
.fdcc svg{max-width:100%;height:auto}";

/// That of the JSON text of a document.
pub fn fragment(document: &str) -> String {
    let document: [Json; 1] = [serde_json::from_str(document).expect("we have just written it")];
    let [own] = &document;
    let all = figures(&document);
    let arrays = arrays(&document, &all);
    let shown = svg::usual(&all, &arrays);
    let picture = if shown.is_empty() { String::new() } else { svg::over_time(own, &all, &shown) };
    format!(
        "<div class=\"fdcc\">\n<style>{STYLE}</style>\n<h3 class=\"{}\">{}: {}</h3>\n<ul>\n\
         {}</ul>\n{}{picture}</div>\n",
        class(mark(own)),
        escape(own.at("model").text()),
        escape(&title(own)),
        claims(own).iter().map(sentence).collect::<String>(),
        tables::tiles(own, &[])
    )
}
