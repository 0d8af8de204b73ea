//! How smooth expressions are: a table of claims, and random expressions whose derivatives are
//! followed to where they jump.

use fdcc_compiler::graph::derivative;
use fdcc_compiler::graph::evaluate;
use fdcc_compiler::model::{Model, Symbol};
use fdcc_compiler::{Order, Smoothness, check, smoothness};
use fdcc_grammar::parse;
use fdcc_tests::random::Random;
use fdcc_tests::{blocks, documents};

fn model(functions: &str, expression: &str) -> Model {
    let text = format!(
        "{functions}\nparam k = 2\ntime t in [0, 1]\nstate x start free\nstate y start free\n\
         state p in [0, 4] start 1\nstate q in [1, 4] start 2\n\
         dynamics {{\n  x' = k\n  y' = 1\n  p' = 0\n  q' = 0\n}}\nreport {{ e = {expression} }}\n"
    );
    let parsed = parse(&text);
    assert!(parsed.diagnostics.is_empty(), "{text}\n{:#?}", parsed.diagnostics);
    let checked = check(&parsed.tree);
    checked.model.unwrap_or_else(|| panic!("{text}\n{:#?}", checked.diagnostics))
}

fn of(model: &Model) -> Smoothness {
    let all = smoothness(model).expect("parameters have values");
    all.into_iter().find(|it| it.name == "e").expect("the report has a class")
}

#[test]
fn expressions_have_the_class_of_the_table() {
    let (_, page) =
        documents("tests/tests/smoothness", "md").into_iter().next().expect("the table is there");
    let functions = &blocks(&page)[0].text;
    let mut wrong = Vec::new();
    let mut count = 0;
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let found = of(&model(functions, cells[0].trim_matches('`')));
        let found = [cells[0].to_string(), found.order.to_string(), found.knots.join(", ")];
        if found.each_ref().map(String::as_str) != *cells {
            wrong.push(format!("{found:?}\n  instead of {cells:?}"));
        }
        count += 1;
    }
    assert!(wrong.is_empty() && count >= 40, "{count} rows\n{}", wrong.join("\n"));
}

fn expression(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        let number = format!("({:.1})", random.between(-2.0, 2.0));
        return if random.below(3) == 0 { number } else { "x".into() };
    }
    let a = expression(random, depth - 1);
    let b = expression(random, depth - 1);
    match random.below(9) {
        0 | 1 => format!("({a} + {b})"),
        2 => format!("({a} - {b})"),
        3 => format!("({a})*({b})"),
        4 => format!("abs({a})"),
        5 => format!("max({a}, {b})"),
        6 => format!("min({a}, {b})^2"),
        7 => format!("sin({a})"),
        _ => format!("piecewise {{ {a} <= {b} => {a}  otherwise => {b} }}"),
    }
}

/// The size of the worst jump of a function between two grid points, found by halving towards it.
fn worst_jump(value: &dyn Fn(f64) -> f64) -> f64 {
    let grid: Vec<f64> = (0..=120).map(|at| -3.0 + 6.0 * (f64::from(at) + 0.3) / 121.0).collect();
    let jumps = grid.windows(2).map(|pair| {
        let (mut low, mut high) = (pair[0], pair[1]);
        for _ in 0..36 {
            let middle = 0.5 * (low + high);
            let at = [low, middle, high].map(value);
            if (at[1] - at[0]).abs() > (at[2] - at[1]).abs() { high = middle } else { low = middle }
        }
        (value(high) - value(low)).abs() / (1.0 + value(low).abs())
    });
    jumps.fold(0.0, f64::max)
}

#[test]
fn no_derivative_jumps_that_is_called_continuous() {
    let mut random = Random::new(11);
    let (mut smooth, mut rough) = (0, 0);
    for _ in 0..250 {
        let text = expression(&mut random, 3);
        let model = model("", &text);
        let claimed = of(&model);
        let (mut graph, input) =
            (model.graph.clone(), model.input_of(Symbol::State(0)).expect("x is a state"));
        let mut root = model.report[0].value;
        let times = match claimed.order {
            Order::Jumps => continue,
            Order::Times(times) => times.min(2),
            Order::Always => 2,
        };
        if times == 2 {
            smooth += 1
        } else {
            rough += 1
        }
        for derived in 0..=times {
            let value = |x: f64| {
                let mut point = vec![2.0; model.symbols.len()];
                point[input as usize] = x;
                evaluate(&graph, &[root], &point, &[])[0]
            };
            let jump = worst_jump(&value);
            assert!(
                jump <= 1e-4,
                "derivative {derived} of {text} jumps by {jump}, claimed {claimed:?}"
            );
            root = derivative(&mut graph, root, input);
        }
    }
    assert!(smooth > 30 && rough > 30, "{smooth} and {rough}");
}

/// Rounded expressions, with the width and the gaps of their guards.
const ROUNDED: &[(&str, f64, &str)] = &[
    ("abs(x)", 0.2, "x"),
    ("max(x, x^2)", 0.3, "x - x^2"),
    ("min(2*x, sin(x))", 0.1, "2*x - sin(x)"),
    ("piecewise { x <= 1 => x^2  otherwise => 2*x - 1 }", 0.05, "x - 1"),
    ("piecewise { x <= 0 => 0  x < 1 => 3*x  otherwise => 2 - x }", 0.4, "x, x - 1"),
    ("exp(-abs(x))*max(x - 1, 0)", 0.5, "x, x - 1"),
];

/// The function of `x` and its first two derivatives.
fn derivatives(text: &str) -> Vec<Box<dyn Fn(f64) -> f64>> {
    let model = model("", text);
    let input = model.input_of(Symbol::State(0)).expect("x is a state");
    let mut graph = model.graph.clone();
    let mut roots = vec![model.report[0].value];
    (0..2).for_each(|at| roots.push(derivative(&mut graph, roots[at], input)));
    let value = |root| {
        let (graph, point) = (graph.clone(), vec![2.0; model.symbols.len()]);
        Box::new(move |x: f64| {
            let mut point = point.clone();
            point[input as usize] = x;
            evaluate(&graph, &[root], &point, &[])[0]
        }) as Box<dyn Fn(f64) -> f64>
    };
    roots.into_iter().map(value).collect()
}

#[test]
fn what_is_rounded_has_two_continuous_derivatives() {
    for (text, width, _) in ROUNDED {
        for (times, value) in derivatives(&format!("blend({text}, {width})")).iter().enumerate() {
            let jump = worst_jump(value);
            assert!(jump <= 1e-4, "derivative {times} of {text} jumps by {jump}");
        }
        let sharp = derivatives(text).iter().map(|value| worst_jump(value)).fold(0.0, f64::max);
        assert!(sharp > 0.1, "{text} is smooth already");
    }
}

#[test]
fn beyond_the_width_nothing_is_changed() {
    for (text, width, gaps) in ROUNDED {
        let (rounded, sharp) = (derivatives(&format!("blend({text}, {width})")), derivatives(text));
        let gaps: Vec<_> = gaps.split(", ").map(|gap| derivatives(gap).swap_remove(0)).collect();
        let points = (0..4001).map(|at| -3.0 + 0.0015 * f64::from(at));
        let (near, far): (Vec<f64>, Vec<f64>) =
            points.partition(|x| gaps.iter().any(|gap| gap(*x).abs() < 0.5 * width));
        let differs = |x: &f64| rounded.iter().zip(&sharp).any(|(new, old)| new(*x) != old(*x));
        assert_eq!(far.iter().copied().find(differs), None, "{text}");
        assert!(near.iter().any(differs), "{text} is not rounded at all");
    }
}

/// The smoothstep `6 q^5 - 15 q^4 + 10 q^3` at q = 3/4 is 0.896484375.
#[test]
fn the_rounding_is_the_quintic_smoothstep() {
    let value = &derivatives("blend(abs(x), 0.2)")[0];
    assert!((value(0.05) - 0.05 * (2.0 * 0.896_484_375 - 1.0)).abs() <= 1e-16);
    let value = &derivatives("blend(piecewise { x <= 1 => 5  otherwise => 7 }, 4)")[0];
    assert!((value(2.0) - (5.0 + 2.0 * 0.896_484_375)).abs() <= 1e-14);
}
