//! The functions that CasADi calls: `f`, its Jacobian `jac_f`, `adj1_f` (the Jacobian transposed
//! times multipliers) and the Jacobian of that, `jac_adj1_f`, which has the Hessian.

use super::blocks::{self, Block};
use super::interface::{Port, Tables, describe};
use super::kernel::literal;
use super::{Argument, Exported, Given, Part};

const HEAD: &str =
    "(const double **arg, double **res, casadi_int *iw, casadi_real *w, int mem) {\n";
const FOOT: &str =
    "    (void)(arg);\n    (void)(res);\n    (void)(iw);\n    (void)(mem);\n    return 0;\n}\n";

/// The values.
pub(super) fn value(function: &Exported, tables: &mut Tables) -> String {
    let (mut body, work) = begin(function, &["y"]);
    body += &format!("    {}_value(z, p, y);\n", function.name);
    for (at, part) in function.results.iter().enumerate() {
        let Part { rows, .. } = part;
        body += &format!("    fdcc_write(res[{at}], y + {}, {});\n", rows.start, rows.len());
    }
    let active = function.arguments.iter().map(|it| it.is_active).collect();
    let ports = [&inputs(function)[..], &outputs(function)];
    whole(&function.name, &body) + &describe(&function.name, ports, Some(active), work, tables)
}

/// A block for each output and input.
pub(super) fn jacobian(function: &Exported, tables: &mut Tables) -> String {
    let name = format!("jac_{}", function.name);
    let (mut body, work) = begin(function, &["y", "j"]);
    body += &format!("    {}_jacobian(z, p, y, j);\n", function.name);
    let mut ports = Vec::new();
    for part in &function.results {
        for by in &function.arguments {
            let block = blocks::jacobian(function, part, by);
            body += &pick(ports.len(), "j", &block, tables);
            ports.push(Port { name: format!("jac_{}_{}", part.name, by.name), block });
        }
    }
    let inputs = joined([inputs(function), nominal(function)]);
    whole(&name, &body) + &describe(&name, [&inputs, &ports], None, work, tables)
}

/// What multipliers of the outputs give at the inputs.
pub(super) fn adjoint(function: &Exported, tables: &mut Tables) -> String {
    let name = format!("adj1_{}", function.name);
    let (mut body, work) = begin(function, &["l", "y", "j"]);
    body += &multipliers(function);
    body += &format!("    {}_jacobian(z, p, y, j);\n", function.name);
    let all = Part { name: String::new(), rows: 0..function.outputs(), labels: Vec::new() };
    for (at, by) in function.arguments.iter().enumerate().filter(|(_, by)| by.is_active) {
        let block = blocks::jacobian(function, &all, by);
        let [rows, columns] = block.places().map(|it| tables.name("int", it));
        let which = tables.name("int", block.which());
        let (size, count) = (by.size(), block.len());
        body += &format!(
            "    fdcc_adjoint(res[{at}], {size}, l, j, {which}, {rows}, {columns}, {count});\n"
        );
    }
    let ports = [&seeded(function)[..], &adjoints(function)];
    whole(&name, &body) + &describe(&name, ports, None, work, tables)
}

/// The derivatives of what [`adjoint`] gives, by the inputs and by the multipliers.
pub(super) fn hessian(function: &Exported, tables: &mut Tables) -> String {
    let name = format!("jac_adj1_{}", function.name);
    let (mut body, work) = begin(function, &["l", "y", "j", "h"]);
    body += &multipliers(function);
    body += &format!("    {}_hessian(z, p, l, y, j, h);\n", function.name);
    let mut ports = Vec::new();
    for first in &function.arguments {
        let mut push = |other: String, table: &str, block: Block| {
            body += &pick(ports.len(), table, &block, tables);
            ports.push(Port { name: format!("jac_adj_{}_{other}", first.name), block });
        };
        for second in &function.arguments {
            push(second.name.clone(), "h", blocks::hessian(function, first, second));
        }
        for part in &function.results {
            push(format!("out_{}", part.name), "", Block::empty(first.size(), part.rows.len()));
        }
        for part in &function.results {
            let block = blocks::jacobian(function, part, first).transposed();
            push(format!("adj_{}", part.name), "j", block);
        }
    }
    let nominal = adjoints(function).into_iter().map(|port| Port {
        name: format!("out_{}", port.name),
        block: Block::empty(port.block.rows(), 1),
    });
    let inputs = joined([seeded(function), nominal.collect()]);
    whole(&name, &body) + &describe(&name, [&inputs, &ports], None, work, tables)
}

/// Numbers that are given.
pub(super) fn given(given: &Given, tables: &mut Tables) -> String {
    let mut body = String::new();
    let mut ports = Vec::new();
    for (at, (name, numbers)) in given.results.iter().enumerate() {
        let written: Vec<String> = numbers.iter().map(|it| literal(*it)).collect();
        for (entry, number) in written.iter().enumerate() {
            body += &format!("    if (res[{at}]) res[{at}][{entry}] = {number};\n");
        }
        ports.push(Port { name: name.clone(), block: Block::column(numbers.len()) });
    }
    body += "    (void)(w);\n";
    whole(&given.name, &body) + &describe(&given.name, [&[], &ports], None, 0, tables)
}

fn whole(name: &str, body: &str) -> String {
    format!("CASADI_SYMBOL_EXPORT int {name}{HEAD}{body}{FOOT}")
}

/// Tables in the memory that is given, then the inputs into `z` and `p`; and how long it has to be.
fn begin(function: &Exported, tables: &[&str]) -> (String, usize) {
    let layout = function.layout();
    let (mut text, mut work) = (String::new(), 0);
    for table in ["z", "p"].iter().chain(tables) {
        text += &format!("    double *{table} = w + {work};\n");
        work += match *table {
            "z" => layout.point_inputs(),
            "p" => layout.p,
            "j" => function.jacobian().entries.len(),
            "h" => function.hessian().entries.len(),
            _ => function.outputs(),
        };
    }
    for (at, argument) in function.arguments.iter().enumerate() {
        text += &read(function, at, argument);
    }
    (text, work)
}

/// Copies an input to where the kernel reads it.
fn read(function: &Exported, at: usize, argument: &Argument) -> String {
    let parameters = function.layout().parameters();
    let (mut text, mut offset) = (String::new(), 0);
    for range in argument.positions.iter().filter(|it| !it.is_empty()) {
        let place = match range.start {
            first if first < parameters.start => format!("z + {first}"),
            first if first < parameters.end => format!("p + {}", first - parameters.start),
            first => format!("z + {}", first - parameters.len()),
        };
        text += &format!("    fdcc_read({place}, arg[{at}], {offset}, {});\n", range.len());
        offset += range.len();
    }
    text
}

/// The multipliers stand behind the inputs and the outputs.
fn multipliers(function: &Exported) -> String {
    let first = function.arguments.len() + function.results.len();
    let read = |(at, part): (usize, &Part)| {
        let (rows, at) = (&part.rows, first + at);
        format!("    fdcc_read(l + {}, arg[{at}], 0, {});\n", rows.start, rows.len())
    };
    function.results.iter().enumerate().map(read).collect()
}

fn pick(at: usize, table: &str, block: &Block, tables: &mut Tables) -> String {
    if block.is_empty() {
        return String::new();
    }
    let which = tables.name("int", block.which());
    format!("    fdcc_pick(res[{at}], {table}, {which}, {});\n", block.len())
}

fn inputs(function: &Exported) -> Vec<Port> {
    let port = |it: &Argument| Port { name: it.name.clone(), block: Block::column(it.size()) };
    function.arguments.iter().map(port).collect()
}

fn outputs(function: &Exported) -> Vec<Port> {
    let port = |it: &Part| Port { name: it.name.clone(), block: Block::column(it.rows.len()) };
    function.results.iter().map(port).collect()
}

/// The outputs as inputs that are not read.
fn nominal(function: &Exported) -> Vec<Port> {
    let port = |it: &Part| Port {
        name: format!("out_{}", it.name),
        block: Block::empty(it.rows.len(), 1),
    };
    function.results.iter().map(port).collect()
}

/// Inputs, outputs, multipliers.
fn seeded(function: &Exported) -> Vec<Port> {
    let seed =
        |it: &Part| Port { name: format!("adj_{}", it.name), block: Block::column(it.rows.len()) };
    let seeds = function.results.iter().map(seed).collect();
    joined([inputs(function), nominal(function), seeds])
}

fn adjoints(function: &Exported) -> Vec<Port> {
    let port = |it: &Argument| Port {
        name: format!("adj_{}", it.name),
        block: match it.is_active {
            true => Block::column(it.size()),
            false => Block::empty(it.size(), 1),
        },
    };
    function.arguments.iter().map(port).collect()
}

/// Lists one after the other.
fn joined<const LISTS: usize>(lists: [Vec<Port>; LISTS]) -> Vec<Port> {
    lists.into_iter().flatten().collect()
}
