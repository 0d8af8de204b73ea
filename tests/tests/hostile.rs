//! Texts that nobody writes: a clear answer, at once, and no stack overflow.

use std::time::{Duration, Instant};

use fdcc_grammar::ast::{Expr, ExprKind, ItemKind};
use fdcc_grammar::{Code, Parse, ParseCache, parse, parse_with};
use proptest::prelude::*;

/// Generous: the tests share the machine.
const LIMIT: Duration = Duration::from_secs(5);

/// A name, a text, and the code of its first diagnostic, if it has any.
fn texts() -> Vec<(&'static str, String, Option<Code>)> {
    let objective = |expression: String| format!("minimize {expression}\n");
    let nested = |open: &str, depth: usize, close: &str| {
        objective(open.repeat(depth) + "x" + &close.repeat(depth))
    };
    vec![
        ("nothing", String::new(), Some(Code::EmptyModel)),
        ("only comments", "#! doc\n# comment".into(), Some(Code::EmptyModel)),
        ("zeros", "param a = 1\0".into(), Some(Code::NotText)),
        ("an escape sequence", "param a = 1\u{1b}[31m".into(), Some(Code::NotText)),
        ("five megabytes", "param a = 1\n".repeat(420_000), Some(Code::TooLarge)),
        ("a megabyte of items", "param a = 1 [kg]\n".repeat(60_000), None),
        ("100 parentheses", nested("(", 99, ")"), None),
        ("10000 parentheses", nested("(", 10_000, ")"), Some(Code::TooDeep)),
        ("nested calls", nested("f(1, ", 99, ")"), None),
        ("nested blends", nested("blend(", 99, ", 1)"), None),
        ("nested blends of functions", nested("blend(f, 1)(", 99, ")"), None),
        ("unclosed blends", objective("blend(".repeat(99)), Some(Code::Unclosed)),
        ("nested tuples", nested("(1, ", 99, ")"), None),
        ("nested guards", nested("piecewise { ", 99, " <= 1 => 1 otherwise => 1 }"), None),
        ("nested arms", nested("piecewise { x <= 1 => ", 99, " otherwise => 1 }"), None),
        ("unclosed parentheses", objective("(".repeat(100_000)), Some(Code::TooDeep)),
        ("unclosed everything", "dynamics { x' = f([(\n".repeat(5_000), Some(Code::Unclosed)),
        ("nested phases", "phase a {\n".repeat(50_000), Some(Code::Unclosed)),
        ("nested phases on one line", "phase a { ".repeat(20_000), Some(Code::TooDeep)),
        (
            "a string without end",
            format!("data a = csv(\"{}", "a".repeat(1_000_000)),
            Some(Code::TooLarge),
        ),
        ("40000 minus signs", objective("-".repeat(40_000) + "x"), Some(Code::TooDeep)),
        ("100000 minus signs", objective("-".repeat(100_000) + "x"), Some(Code::TooLarge)),
        (
            "minus signs and parentheses",
            nested(&("-".repeat(50) + "("), 90, ")"),
            Some(Code::TooDeep),
        ),
        ("a thousand terms", objective("x - ".repeat(1_000) + "x"), None),
        ("ten thousand factors", objective("x / ".repeat(10_000) + "x"), None),
        ("a megabyte of terms", objective("1+".repeat(500_000) + "1"), Some(Code::TooLarge)),
        ("20000 powers", objective("a^".repeat(20_000) + "a"), Some(Code::TooDeep)),
        ("20000 primes", objective("a".to_owned() + &"'".repeat(20_000)), Some(Code::TooDeep)),
        ("20000 parts", objective("a".to_owned() + &".x".repeat(20_000)), Some(Code::TooDeep)),
        ("a long name", format!("param {} = 1", "a".repeat(1_000_000)), Some(Code::TooLarge)),
        ("a megabyte of signs", "@".repeat(1_000_000), Some(Code::TooLarge)),
        ("a megabyte of closers", ") } ] ".repeat(160_000), Some(Code::Unclosed)),
        ("a megabyte of names", "x y\n".repeat(250_000), Some(Code::UnknownItem)),
        ("a megabyte of item words", "param\n".repeat(160_000), Some(Code::Unfinished)),
        (
            "a megabyte of wrong equations",
            format!("dynamics {{\n{}}}", "x' = 2 3\n".repeat(4_000)),
            Some(Code::MissingOperator),
        ),
    ]
}

#[test]
fn hostile_texts_get_one_clear_answer_at_once() {
    for (name, text, expected) in texts() {
        let begin = Instant::now();
        let Parse { diagnostics, .. } = parse(&text);
        assert!(begin.elapsed() < LIMIT, "{name} takes {:?}", begin.elapsed());
        assert_eq!(diagnostics.first().map(|diagnostic| diagnostic.code), expected, "{name}");
    }
}

#[test]
fn models_typed_character_by_character_are_read_as_if_they_were_new() {
    for (name, model) in fdcc_tests::documents("models", "fdc") {
        // The first item can be read and has a mistake all the same.
        let text = format!("path 1 <= x >= 0\n{model}");
        let mut memory = ParseCache::default();
        for end in (0..=text.len()).filter(|end| text.is_char_boundary(*end)) {
            let typed = &text[..end];
            assert!(parse_with(&mut memory, typed) == parse(typed), "{name}, up to byte {end}");
        }
    }
}

/// The value of a long chain, with every `x` replaced by the next of these numbers.
fn value(expr: &Expr, next: &mut impl Iterator<Item = f64>) -> f64 {
    use fdcc_grammar::ast::BinaryOperator::*;
    let ExprKind::Binary(operator, left, right) = &expr.kind else {
        return next.next().expect("enough numbers");
    };
    let (left, right) = (value(left, next), value(right, next));
    match operator {
        Add => left + right,
        Subtract => left - right,
        Multiply => left * right,
        Divide => left / right,
        Power => left.powf(right),
    }
}

#[test]
fn balancing_long_chains_keeps_their_value() {
    // Powers of two and small whole numbers are exact in any order.
    let operators =
        |[a, b]: [&'static str; 2]| (0..500).map(move |at| if at * at % 7 < 3 { a } else { b });
    for (signs, start, numbers) in
        [(["+", "-"], 0.0, [3.0, 5.0, 11.0]), (["*", "/"], 1.0, [2.0, 4.0, 0.5])]
    {
        let text: String = operators(signs).map(|sign| format!(" {sign} x")).collect();
        let parse = parse(&format!("minimize x{text}"));
        let ItemKind::Objective { value: tree, .. } = &parse.tree.items[0].kind else {
            panic!("an objective")
        };
        let all = || numbers.iter().copied().cycle();
        let one_by_one =
            operators(signs).zip(all().skip(1)).fold(all().next(), |sum, (sign, x)| {
                let sum = sum.unwrap_or(start);
                Some(match sign {
                    "+" => sum + x,
                    "-" => sum - x,
                    "*" => sum * x,
                    _ => sum / x,
                })
            });
        assert_eq!(Some(value(tree, &mut all())), one_by_one);
    }
}

#[test]
fn a_name_that_is_too_long_is_told_once_and_a_number_as_a_number() {
    let [name, digits] = ["a", "9"].map(|it| it.repeat(20_000));
    let named = format!(
        "param {name} = 1\nstate x start {name}\ndynamics {{ x' = {name} * x + {name} }}\n"
    );
    let found = parse(&named).diagnostics;
    assert_eq!(found.len(), 1, "{found:?}");
    let numbered = format!("param a = {digits}\nstate x start {digits}\n");
    let found = parse(&numbered).diagnostics;
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].message, "a number of more than 255 digits");
}

/// Twice as much of what cannot be read takes twice the time: a hundred times what is read at once
/// here is read at once, too.
#[test]
fn long_texts_of_the_same_are_read_in_proportion() {
    let texts = [
        "dynamics\n".to_owned() + &"x y\n".repeat(200_000),
        "param a = 1 [".to_owned() + &"m ".repeat(400_000),
        "state x ".to_owned() + &"start ) ".repeat(200_000),
        "phase a { ".repeat(200_000),
        "phase a {\n".repeat(200_000) + &"}\n".repeat(200_000),
    ];
    for text in texts {
        let begin = Instant::now();
        assert!(!parse(&text).diagnostics.is_empty());
        assert!(begin.elapsed() < LIMIT, "{}... takes {:?}", &text[..30], begin.elapsed());
    }
}

fn token() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "param",
        "let",
        "fn",
        "state",
        "control",
        "surface",
        "dynamics",
        "jump",
        "start",
        "end",
        "path",
        "minimize",
        "guess",
        "phase",
        "link",
        "method",
        "expect",
        "free",
        "in",
        "match",
        "piecewise",
        "otherwise",
        "below",
        "above",
        "smooth",
        "grid",
        "continue",
        "sigma",
        "x",
        "v",
        "μ",
        "stat",
        "1",
        ".5",
        "2e3",
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        "'",
        "=",
        "==",
        "<=",
        ":=",
        "=>",
        "->",
        "+",
        "-",
        "*",
        "/",
        "^",
        ",",
        ".",
        ":",
        "\"a\"",
        "\"",
        ";",
        "²",
        "# c\n",
        "\n",
        "\n",
        "\r\n",
        "\t",
        "é",
    ])
}

proptest! {
    #[test]
    fn no_soup_of_tokens_is_too_much(soup in prop::collection::vec(token(), 0..200)) {
        let text = soup.join(" ");
        for diagnostic in parse(&text).diagnostics {
            for label in diagnostic.labels {
                prop_assert!(text.get(label.span.range()).is_some(), "a label lies in the text");
            }
        }
    }

    #[test]
    fn no_text_is_too_much(text in "\\PC*") {
        parse(&text);
    }
}
