//! What the parser understands and what it says about the rest. The cases are documents in
//! `tests/syntax/`.

use fdcc_grammar::ast::*;
use fdcc_grammar::{Code, Diagnostic, Parse, SourceFile, parse};
use fdcc_tests::{blocks, documents, repository, unclaimed};

#[test]
fn documents_claim_every_diagnostic() {
    for (name, document) in documents("tests/tests/syntax", "md") {
        for block in blocks(&document).iter().filter(|block| block.tag == "fdc") {
            let problems = unclaimed(&block.text, &parse(&block.text).diagnostics);
            assert!(
                problems.is_empty(),
                "{name}.md:{} {}\n{}",
                block.line,
                block.heading,
                problems.join("\n")
            );
        }
    }
}

#[test]
fn models_parse_without_a_word() {
    for (name, text) in documents("models", "fdc") {
        let parse = parse(&text);
        assert!(parse.diagnostics.is_empty(), "{name}: {:#?}", parse.diagnostics);
        assert_eq!(parse.tree.name.expect("every model has a name").name, name);
    }
}

#[test]
fn line_ends_tabs_and_byte_order_marks_change_nothing() {
    for (name, text) in documents("models", "fdc") {
        let counts = |text: &str| {
            let Parse { tree, diagnostics, .. } = parse(text);
            (tree.docs, tree.items.len(), diagnostics)
        };
        let expected = counts(&text);
        for variant in
            [text.replace('\n', "\r\n"), text.replace("  ", "\t"), format!("\u{FEFF}{text}")]
        {
            assert_eq!(counts(&variant), expected, "{name}");
        }
    }
}

/// The same mistakes are found at the same lines and columns, counted in characters, however the
/// lines end.
#[test]
fn columns_count_characters() {
    let text = "param μ_θ = 1 2\n\tstate größe start\n  end ψ == (α + β γ)\r\nparam ok = 1\n";
    let places = |text: &str| {
        let source = SourceFile::new("model.fdc", text);
        let place = |found: &Diagnostic| source.line_column(found.span().start);
        let places = parse(text)
            .diagnostics
            .iter()
            .map(|found| (place(found).line, place(found).column))
            .collect();
        let places: Vec<(usize, usize)> = places;
        places
    };
    let expected = [(1, 13), (2, 14), (3, 17)];
    for variant in [
        text.to_owned(),
        text.replace("\r\n", "\n"),
        text.replace("\r\n", "\n").replace('\n', "\r\n"),
        format!("\u{FEFF}{text}"),
    ] {
        assert_eq!(places(&variant), expected, "{variant:?}");
    }
}

/// The cases of group 00 in the table of messages: message, severity, places, texts and help.
#[test]
fn messages_are_those_of_the_table() {
    let path = repository().join("tests/reference/diagnostics.json");
    let table = std::fs::read_to_string(path).expect("the table is there");
    let cases: serde_json::Value = serde_json::from_str(&table).expect("the table is JSON");
    let cases = cases.as_array().expect("the table is a list");
    let syntax: Vec<_> =
        cases.iter().filter(|case| text(case, "code").starts_with("FDC00")).collect();
    assert!(!syntax.is_empty());
    for case in syntax {
        let source = text(case, "src");
        let diagnostics = parse(source).diagnostics;
        let [found] = &diagnostics[..] else {
            panic!("one diagnostic is expected: {diagnostics:#?}")
        };
        assert_eq!(found.code.as_str(), text(case, "code"));
        assert_eq!(found.message, text(case, "msg"));
        assert_eq!(format!("{:?}", found.severity).to_lowercase(), text(case, "sev"));
        assert_eq!(found.help.as_deref(), Some(text(case, "help")));
        assert_eq!(labels(source, found), expected_labels(case));
    }
}

fn text<'v>(value: &'v serde_json::Value, key: &str) -> &'v str {
    value[key].as_str().expect("the table has text here")
}

fn labels(source: &str, diagnostic: &Diagnostic) -> Vec<(String, String)> {
    let source = SourceFile::new("model.fdc", source);
    diagnostic
        .labels
        .iter()
        .map(|label| (source.slice(label.span).to_owned(), label.text.clone()))
        .collect()
}

fn expected_labels(case: &serde_json::Value) -> Vec<(String, String)> {
    let labels = case["labels"].as_array().expect("a case has labels");
    let part = |label: &serde_json::Value, at: usize| {
        label[at].as_str().expect("a label has two texts").to_owned()
    };
    labels.iter().map(|label| (part(label, 0), part(label, 1))).collect()
}

#[test]
fn a_broken_piece_costs_only_itself() {
    let text = "param a = 1\nparam b =\nstate x start\nstat y start 0\ndynamics {\n  x' = a b\n  \
                y' = 1\n}\nend x == 1\n";
    let Parse { tree, diagnostics, .. } = parse(text);
    let codes: Vec<Code> = diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
    assert_eq!(
        codes,
        [Code::Unfinished, Code::Unfinished, Code::UnknownItem, Code::MissingOperator]
    );
    let kinds: Vec<String> = tree.items.iter().map(|item| format!("{:?}", item.kind)).collect();
    assert_eq!(kinds.len(), 3, "{kinds:?}");
    assert!(
        kinds[1].contains("\"y\"") && !kinds[1].contains("\"x\""),
        "the good equation stays: {}",
        kinds[1]
    );
}

/// The tree of an expression with all its parentheses.
fn written_out(expr: &Expr) -> String {
    let list = |items: &[Expr]| items.iter().map(written_out).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        ExprKind::Number(value) => value.to_string(),
        ExprKind::Quantity(value, unit) => {
            let factors = unit.factors.iter().map(|(name, power)| format!("{}^{power}", name.name));
            format!("{value}[{}]", factors.collect::<Vec<_>>().join(" "))
        }
        ExprKind::Name(name) => name.clone(),
        ExprKind::Negate(inner) => format!("(-{})", written_out(inner)),
        ExprKind::Binary(operator, left, right) => {
            format!("({} {operator:?} {})", written_out(left), written_out(right))
        }
        ExprKind::Call(function, arguments) => {
            let arguments = arguments.iter().map(|argument| match argument {
                Argument::Expr(expr) => written_out(expr),
                Argument::End(_) => "END".to_owned(),
                Argument::Start(_) => "START".to_owned(),
                Argument::Iteration(name, data) => format!("{} IN {}", name.name, data.name),
            });
            format!("{}({})", written_out(function), arguments.collect::<Vec<_>>().join(", "))
        }
        ExprKind::Part(base, part) => format!("{}.{}", written_out(base), part.name),
        ExprKind::Index(base, index) => format!("{}[{index}]", written_out(base)),
        ExprKind::Prime(base) => format!("{}'", written_out(base)),
        ExprKind::Tuple(items) => format!("<{}>", list(items)),
        ExprKind::Piecewise { arms, otherwise } => {
            let arm = |arm: &Arm| {
                let [left, right, value] = [&arm.left, &arm.right, &arm.value].map(written_out);
                format!("{left} {:?} {right}: {value}; ", arm.relation)
            };
            format!("{{{}{}}}", arms.iter().map(arm).collect::<String>(), written_out(otherwise))
        }
        ExprKind::Match { surface, below, above, .. } => {
            format!("{}?{}:{}", surface.name, written_out(below), written_out(above))
        }
    }
}

#[test]
fn operators_bind_as_on_paper() {
    let cases = [
        ("1 + 2 * 3", "(1 Add (2 Multiply 3))"),
        ("a - b + c", "((a Subtract b) Add c)"),
        ("a / b * c", "((a Divide b) Multiply c)"),
        ("a*b/c^2", "((a Multiply b) Divide (c Power 2))"),
        ("-x^2", "(-(x Power 2))"),
        ("2^3^2", "(2 Power (3 Power 2))"),
        ("2^-x^2", "(2 Power (-(x Power 2)))"),
        ("-a * b", "((-a) Multiply b)"),
        ("a * -b", "(a Multiply (-b))"),
        ("a - -b", "(a Subtract (-b))"),
        ("(a - b) - (c - d)", "((a Subtract b) Subtract (c Subtract d))"),
        (".5 + 1e-3 + 2.", "((0.5 Add 0.001) Add 2)"),
        ("9.81 [m/s^2] * 2", "(9.81[m^1 s^-2] Multiply 2)"),
        ("1 [kg m^2/s/K]", "1[kg^1 m^2 s^-1 K^-1]"),
        ("1 [1/s] + 2 [N*m]", "(1[s^-1] Add 2[N^1 m^1])"),
        ("pos[1] + pos.x'", "(pos[1] Add pos.x')"),
        ("coast.h(end) - x(start)", "(coast.h(END) Subtract x(START))"),
        ("sum(k in obs, (x(k.t) - k.x)^2)", "sum(k IN obs, ((x(k.t) Subtract k.x) Power 2))"),
        ("(a, b, (c, d))", "<a, b, <c, d>>"),
        (
            "piecewise { x < 1 => a  y >= b => c  otherwise => d }",
            "{x LessEqual 1: a; y GreaterEqual b: c; d}",
        ),
        ("2 * match s { below => u, above => -u }", "(2 Multiply s?u:(-u))"),
    ];
    for (text, expected) in cases {
        let model = format!("minimize {text}");
        let Parse { tree, diagnostics, .. } = parse(&model);
        assert!(diagnostics.is_empty(), "{text}: {diagnostics:#?}");
        let [Item { kind: ItemKind::Objective { value, .. }, .. }] = &tree.items[..] else {
            panic!("{text}: {tree:#?}")
        };
        assert_eq!(written_out(value), expected, "{text}");
        assert_eq!(&model[value.span.range()], text, "the span is the expression");
    }
}

#[test]
fn method_blocks_fall_into_settings() {
    let text = "method { smooth sigma = 0.02 [m/s] kernel tanh  grid N = auto steps 2 scheme euler \
                lagged (th, v)  \
                continue sigma = .1, .05  solver = convex  scheme = midpoint }";
    let tree = parse(text).tree;
    let ItemKind::Method { settings } = &tree.items[0].kind else {
        panic!("a method block: {tree:#?}")
    };
    let shown = settings.iter().map(|setting| {
        let value = match &setting.value {
            SettingValue::Expr(value) => written_out(value),
            SettingValue::List(values) => {
                values.iter().map(written_out).collect::<Vec<_>>().join(" ")
            }
            SettingValue::Scheme { name, lagged } => {
                lagged.iter().fold(name.name.clone(), |text, state| text + " " + &state.name)
            }
        };
        format!("{}={value}", setting.key.name)
    });
    let expected = [
        "sigma=0.02[m^1 s^-1]",
        "kernel=tanh",
        "N=auto",
        "steps=2",
        "scheme=euler th v",
        "continue=0.1 0.05",
        "solver=convex",
        "scheme=midpoint",
    ];
    assert_eq!(shown.collect::<Vec<_>>(), expected);
}

#[test]
fn spans_end_with_the_last_token() {
    let text = "state v [m/s]   # a comment\n\ndynamics {\n  m * v' in F   # another\n}\nstate w \
                start free\nend w == 1   \n\n";
    let ends = parse(text).tree.items.into_iter().map(|item| text[item.span.range()].to_owned());
    let expected = [
        "state v [m/s]",
        "dynamics {\n  m * v' in F   # another\n}",
        "state w start free",
        "end w == 1",
    ];
    assert_eq!(ends.collect::<Vec<_>>(), expected);
}

#[test]
fn a_range_behind_the_start_is_told_where_it_goes() {
    for (text, word) in
        [("state v start 0 in [0, 8]", "start"), ("free T guess 1 in [0, 8]", "guess")]
    {
        let found = parse(text).diagnostics;
        let help = found[0].help.as_deref().unwrap_or_default();
        assert_eq!(help, format!("`in` and its range stand before `{word}`"), "{text}");
    }
}
