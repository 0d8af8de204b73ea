//! How CasADi gets to know a function: its sizes, names and patterns.

use super::blocks::Block;
use std::collections::HashMap;

/// Constant arrays that several functions share.
#[derive(Default)]
pub(super) struct Tables {
    names: HashMap<(&'static str, Vec<usize>), String>,
    text: String,
}

impl Tables {
    /// The name of an array with these numbers.
    pub fn name(&mut self, kind: &'static str, numbers: Vec<usize>) -> String {
        let count = self.names.len();
        let text = &mut self.text;
        let name = self.names.entry((kind, numbers)).or_insert_with_key(|(kind, numbers)| {
            let name = format!("fdcc_{count}");
            *text += &format!("static const {kind} {name}[] = {};\n", list(numbers));
            name
        });
        name.clone()
    }

    pub fn into_text(self) -> String {
        self.text + "\n"
    }
}

/// Numbers in braces, broken into lines.
pub(super) fn list(numbers: &[usize]) -> String {
    const MOST: usize = 90;
    let (mut text, mut column) = (String::from("{"), 0);
    for (at, number) in numbers.iter().enumerate() {
        let entry = format!("{number}{}", if at + 1 < numbers.len() { "," } else { "" });
        if column + entry.len() > MOST {
            text += "\n   ";
            column = 0;
        }
        column += entry.len() + 1;
        text += &format!(" {entry}");
    }
    // C has no arrays without entries.
    if numbers.is_empty() { "{ 0 }".into() } else { text + " }" }
}

/// An input or output of a function that CasADi calls.
pub(super) struct Port {
    pub name: String,
    pub block: Block,
}

/// What CasADi asks about a function; `active` has a word for each input if some are not
/// differentiated by.
pub(super) fn describe(
    name: &str,
    [inputs, outputs]: [&[Port]; 2],
    active: Option<Vec<bool>>,
    work: usize,
    tables: &mut Tables,
) -> String {
    let mut text = String::new();
    for (way, ports) in [("in", inputs), ("out", outputs)] {
        text += &count(name, way, ports.len());
        let names = ports.iter().map(|it| format!("\"{}\"", it.name)).collect();
        text += &choice(&format!("const char *{name}_name_{way}"), names);
        let patterns =
            ports.iter().map(|it| tables.name("casadi_int", it.block.compressed())).collect();
        text += &choice(&format!("const casadi_int *{name}_sparsity_{way}"), patterns);
    }
    if let Some(active) = active {
        let words = active.iter().map(|&it| u8::from(it).to_string()).collect();
        text += &choice(&format!("int {name}_diff_in"), words);
    }
    text + &format!(
        "CASADI_SYMBOL_EXPORT int {name}_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int \
         *sz_iw, casadi_int *sz_w) {{\n    if (sz_arg) *sz_arg = {};\n    if (sz_res) *sz_res = \
         {};\n    if (sz_iw) *sz_iw = 0;\n    if (sz_w) *sz_w = {work};\n    return 0;\n}}\n\n",
        inputs.len(),
        outputs.len()
    )
}

fn count(name: &str, way: &str, count: usize) -> String {
    format!("CASADI_SYMBOL_EXPORT casadi_int {name}_n_{way}(void) {{ return {count}; }}\n")
}

/// A function that returns one of several values, or 0 for any other number.
fn choice(head: &str, values: Vec<String>) -> String {
    let mut text = format!("CASADI_SYMBOL_EXPORT {head}(casadi_int i) {{\n");
    if values.is_empty() {
        text += "    (void)(i);\n";
    } else {
        text += "    switch (i) {\n";
        for (at, value) in values.iter().enumerate() {
            text += &format!("        case {at}: return {value};\n");
        }
        text += "        default: break;\n    }\n";
    }
    text + "    return 0;\n}\n"
}
