//! The table of `docs/reference/units.md`: in which unit a plain number is read at each place.

use fdcc_compiler::analyze;
use fdcc_compiler::graph::{ExprId, evaluate};
use fdcc_compiler::model::Model;
use fdcc_grammar::Severity;

/// Both cells of a row of the table; the left one holds code.
pub fn row(line: &str) -> Option<[&str; 2]> {
    let cells = line.strip_prefix("| `")?.strip_suffix(" |")?;
    let (left, right) = cells.split_once("` | ")?;
    let is_reading = right.starts_with("FDC") || right.starts_with('`');
    is_reading.then_some([left, right])
}

/// What is wrong with a row, if anything is.
pub fn problem(base: &str, [line, reading]: [&str; 2]) -> Option<String> {
    let lines: Vec<&str> = line.split("`, `").collect();
    match reading.strip_prefix('`').and_then(|rest| rest.strip_suffix('`')) {
        None => (!codes(base, &lines).iter().any(|code| code == reading))
            .then(|| format!("{line}: not refused with {reading}: {:?}", codes(base, &lines))),
        Some(meant) => {
            let (read, meant) = (numbers(base, &lines), numbers(base, &[meant]));
            (read.is_none() || !is_same(read.as_ref()?, meant.as_ref()?)).then(|| {
                format!("{line}: {read:?}\n instead of {meant:?}, {:?}", codes(base, &lines))
            })
        }
    }
}

fn text(base: &str, lines: &[&str]) -> String {
    let items = lines.iter().filter(|line| !line.starts_with("--"));
    let item = |line: &&str| match line.starts_with("smooth") || line.starts_with("continue") {
        true => format!("method {{ {line} }}\n"),
        false => format!("{line}\n"),
    };
    // One objective is enough.
    let is_asked = lines.iter().any(|line| line.starts_with("minimize"));
    let base: Vec<&str> =
        base.lines().filter(|line| !(is_asked && line.starts_with("minimize"))).collect();
    format!("{}\n{}", base.join("\n"), items.map(item).collect::<String>())
}

/// The errors of the model with these lines.
fn codes(base: &str, lines: &[&str]) -> Vec<String> {
    let found = analyze(&text(base, lines)).diagnostics;
    let errors = found.iter().filter(|it| it.severity == Severity::Error);
    errors.map(|it| it.code.as_str().to_owned()).collect()
}

/// Every number of the model with these lines, at one point.
fn numbers(base: &str, lines: &[&str]) -> Option<Vec<f64>> {
    let mut model = analyze(&text(base, lines)).model?;
    for line in lines {
        let given =
            line.split_once(' ').and_then(|(option, rest)| Some((option, rest.split_once('=')?)));
        match given {
            Some(("--set", (name, value))) => model.set_param(name, value).ok()?,
            Some(("--method", (key, value))) => model.set_method(key, value).ok()?,
            _ => {}
        }
    }
    let inputs: Vec<f64> = (0..model.symbols.len()).map(|at| 0.37 + 0.11 * at as f64).collect();
    let mut all = evaluate(&model.graph, &roots(&model), &inputs, &[]);
    all.extend(model.method.sigma.iter().chain(&model.method.continuation));
    all.extend(
        model.sweep.iter().flat_map(|it| &it.values).filter_map(|it| it.parse::<f64>().ok()),
    );
    Some(all)
}

fn roots(model: &Model) -> Vec<ExprId> {
    let range = |range: fdcc_compiler::model::Range| [range.lower, range.upper];
    let mut all = model.interval.to_vec();
    all.extend(model.params.iter().flat_map(|it| it.value.into_iter().chain(range(it.range))));
    all.extend(model.frees.iter().flat_map(|it| it.guess.into_iter().chain(range(it.range))));
    for it in &model.states {
        all.extend([it.rate].into_iter().chain(it.start).chain(it.guess).chain(range(it.range)));
    }
    all.extend(model.controls.iter().flat_map(|it| it.guess.into_iter().chain(range(it.range))));
    all.extend(model.surfaces.iter().map(|it| it.psi));
    all.extend(model.jumps.iter().flat_map(|it| it.resets.iter().map(|reset| reset.1)));
    all.extend(
        model
            .path
            .iter()
            .chain(&model.boundary)
            .flat_map(|it| [it.value, it.range.lower, it.range.upper]),
    );
    all.extend(model.objective.iter().map(|it| it.1));
    all.extend(model.widths.iter().map(|it| it.1));
    all.extend(model.report.iter().map(|it| it.value));
    all.extend(model.expectations.iter().flat_map(|it| it.values));
    all.extend(
        model
            .definitions
            .iter()
            .filter(|it| it.arguments.is_empty())
            .flat_map(|it| it.parts.clone()),
    );
    all
}

fn is_same(a: &[f64], b: &[f64]) -> bool {
    let is_close = |(a, b): (&f64, &f64)| a == b || (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    a.len() == b.len() && a.iter().zip(b).all(is_close)
}
