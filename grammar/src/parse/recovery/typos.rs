//! Frequent typos, each with the message that helps best.

use super::messages::ErrorContext;
use crate::parse::grammar::Rule;
use crate::parse::lexical::tokens::{Kind, Token};
use crate::parse::lexical::words;
use crate::{Code, Diagnostic, Fix, Span};

/// Characters that other languages have, what stands for them here, and how to say so.
#[rustfmt::skip]
const FOREIGN: &[(&str, Option<&str>, &str)] = &[
    (";", Some(""), "leave it out: an item ends where the next one begins"),
    ("−", Some("-"), "write `-`"),
    ("·", Some("*"), "write `*`"),
    ("×", Some("*"), "write `*`"),
    ("÷", Some("/"), "write `/`"),
    ("≤", Some("<="), "write `<=`"),
    ("≥", Some(">="), "write `>=`"),
    ("²", Some("^2"), "write `^2`"),
    ("³", Some("^3"), "write `^3`"),
    ("√", None, "write `sqrt(...)`"),
    ("∈", Some("in"), "write `in`"),
    ("’", Some("'"), "write `'` for a derivative"),
    ("′", Some("'"), "write `'` for a derivative"),
    ("%", None, "a comment begins with `#`"),
    ("\"", None, "text stands in a pair of quotes on one line, and only after `csv`"),
];

/// A character that the language does not use.
pub(super) fn foreign_character(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let token = context.next().filter(|token| token.kind == Kind::Foreign)?;
    let visible =
        token.text.chars().all(|c| !c.is_whitespace() && c.escape_debug().count() == 1 || c == '"');
    let shown =
        if visible { token.text.to_owned() } else { token.text.escape_unicode().to_string() };
    let message = format!("`{shown}` has no meaning in fdc");
    let known = FOREIGN.iter().find(|(character, ..)| *character == token.text);
    let (instead, help) = known.map_or((None, "remove it"), |(_, instead, help)| (*instead, *help));
    let diagnostic =
        Diagnostic::new(Code::Unfinished, message, token.span(), "no item contains this character")
            .help(help);
    Some(match instead {
        Some(sign) => {
            diagnostic.fix(Fix::certain(help).replace(token.span(), apart(context, sign)))
        }
        None => diagnostic,
    })
}

/// `// text`: a comment of other languages.
pub(super) fn foreign_comment(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let is_pair =
        |a: &Token<'_>, b: &Token<'_>| a.text == "/" && b.text == "/" && a.end() == b.start;
    let (next, after) = (context.next()?, context.tokens.get(context.at + 1));
    let before = context.previous().filter(|before| is_pair(before, next));
    let span = match (before, after) {
        (Some(before), _) => before.span().to(next.span()),
        (None, Some(after)) if is_pair(next, after) => next.span().to(after.span()),
        _ => return None,
    };
    let found =
        Diagnostic::new(Code::Unfinished, "`//` begins no comment", span, "meant as a comment?");
    Some(found.help("a comment begins with `#`").fix(Fix::certain("write `#`").replace(span, "#")))
}

/// A sign, or a word with blanks where its neighbours touch it.
fn apart(context: &ErrorContext<'_, '_>, sign: &str) -> String {
    let is_word = sign.starts_with(char::is_alphabetic);
    let end = context.tokens[context.at].end();
    let before =
        context.previous().is_some_and(|before| before.end() == context.tokens[context.at].start);
    let after = context.tokens.get(context.at + 1).is_some_and(|after| after.start == end);
    let blank = |touches: bool| if is_word && touches { " " } else { "" };
    format!("{}{sign}{}", blank(before), blank(after))
}

/// Items whose word is followed by a name.
const DECLARATIONS: &[&str] = &[
    "model", "param", "const", "let", "fn", "data", "free", "time", "state", "control", "surface",
    "jump", "phase",
];

/// FDC0003: a reserved word where a name or a value should stand.
pub(super) fn reserved_name(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let token = context.next().filter(|token| !token.begins_line)?;
    let word = words::reserved(token.text)?;
    let previous = context.previous()?;
    let declares = is_declared(context.tokens, context.at);
    let parameter = context.expects(&[Rule::name]) && matches!(previous.text, "(" | "," | ".");
    if plays_its_part(context.tokens, context.at) {
        return None;
    }
    if !declares
        && (is_renamed_elsewhere(context.tokens, token)
            || !(parameter || context.expects_operand()))
    {
        return None;
    }
    let noun = match context.form.map(|form| form.noun) {
        Some(noun) if declares => noun,
        _ if parameter && !context.expects_operand() => "a part or an argument",
        _ => "a value",
    };
    let message = format!("`{}` is a reserved word and cannot name {noun}", token.text);
    let label = format!("reserved: it {}", word.role);
    let uses = uses(context.tokens, context.at);
    let others = if uses.len() > 1 {
        format!("\n`fdcc fix` renames all {} uses", uses.len())
    } else {
        String::new()
    };
    let help = format!("rename it, for example `{}`{others}", word.instead);
    let found = Diagnostic::new(Code::ReservedWord, message, token.span(), label).help(help);
    Some(found.fix(rename(context.tokens, &uses, word.instead)))
}

/// The new name at all uses; with `_` behind it where it is taken.
fn rename(tokens: &[Token<'_>], uses: &[usize], instead: &str) -> Fix {
    let mut new = instead.to_owned();
    while tokens.iter().any(|token| token.text == new) {
        new.push('_');
    }
    let fix = Fix::certain(format!("rename it `{new}`"));
    uses.iter().fold(fix, |fix, at| fix.replace(tokens[*at].span(), new.as_str()))
}

/// Whether a reserved word is used as it should be, so that something is missing before it: `time
/// in [0, 1]`.
fn plays_its_part(tokens: &[Token<'_>], at: usize) -> bool {
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text);
    let (before, after) = (at.checked_sub(1).map_or("", text), text(at + 1));
    match text(at) {
        "in" => after == "[" || matches!(before, "(" | "="),
        "otherwise" | "below" | "above" => after == "=>",
        "within" => tokens.get(at + 1).is_some_and(|next| next.kind == Kind::Number),
        "start" if before == "state" => !["=", "[", "(", "in", "start", ""].contains(&after),
        _ => before == "(" && after == ")",
    }
}

/// Whether a token stands where a declaration has its name.
fn is_declared(tokens: &[Token<'_>], at: usize) -> bool {
    let before = |back: usize| at.checked_sub(back).map_or("", |at| tokens[at].text);
    let follows =
        DECLARATIONS.contains(&before(1)) && !tokens[at].begins_line && before(2) != "start";
    follows && !plays_its_part(tokens, at)
}

/// Whether a reserved word is used as a value because it has been declared as a name; the
/// declaration is reported.
pub(super) fn is_renamed_elsewhere(tokens: &[Token<'_>], token: &Token<'_>) -> bool {
    words::reserved(token.text).is_some()
        && (0..tokens.len()).any(|at| tokens[at].text == token.text && is_declared(tokens, at))
}

/// The place of a reserved word, its declaration, and its uses as a value. Columns of data may be
/// called so, and keep their names.
fn uses(tokens: &[Token<'_>], at_name: usize) -> Vec<usize> {
    let word = tokens[at_name].text;
    let is_column = |at: usize| tokens[at].text == word && names_a_column(tokens, at);
    let is_part =
        matches!(tokens[at_name - 1].text, "(" | ",") && !(1..tokens.len()).any(is_column);
    let is_use = |at: usize| {
        let after = tokens.get(at + 1).map_or("", |token| token.text);
        let before = &tokens[at - 1];
        let is_argument = before.text == "(" && after == ")";
        let as_value = match before.kind {
            Kind::Sign if before.text == "." => is_part,
            Kind::Sign => before.text != "'" && !is_column(at),
            Kind::Open => before.text != "{" && !is_argument,
            Kind::Word => {
                !tokens[at].begins_line
                    && matches!(before.text, "minimize" | "maximize" | "path" | "in")
            }
            _ => false,
        };
        as_value || is_declared(tokens, at)
    };
    (1..tokens.len())
        .filter(|at| tokens[*at].text == word && (*at == at_name || is_use(*at)))
        .collect()
}

/// More columns than anybody lists.
const MOST_COLUMNS: usize = 500;

/// Whether a token stands in the list behind `columns`.
fn names_a_column(tokens: &[Token<'_>], at: usize) -> bool {
    let is_listed = |token: &&Token<'_>| {
        matches!(token.kind, Kind::Word | Kind::Number)
            || matches!(token.text, "," | "[" | "]" | "*" | "/" | "^" | "-")
    };
    let mut list = tokens[..at].iter().rev().take(MOST_COLUMNS).take_while(is_listed);
    matches!(tokens[at - 1].text, "columns" | ",") && list.any(|it| it.text == "columns")
}

/// `=` for `==`, `==` for `=`, and comparisons that conditions do not have.
pub(super) fn wrong_sign(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let token = context.next()?;
    let compares = context.expects(&[Rule::relation, Rule::guard_relation]);
    let (message, label, help) = match token.text {
        "=" if compares => {
            ("`=` does not compare", "a condition needs `==` here", "write `==`, `<=` or `>=`")
        }
        "<" if compares => {
            ("a condition includes its limit", "`<` leaves the limit out", "write `<=`")
        }
        ">" if compares => {
            ("a condition includes its limit", "`>` leaves the limit out", "write `>=`")
        }
        "!=" => (
            "`!=` is no condition",
            "a solver cannot keep away from a single point",
            "write `<=` or `>=`",
        ),
        "==" if context.expects(&[Rule::equals, Rule::becomes]) => {
            ("`==` compares, it does not define", "a definition has a single `=`", "write `=`")
        }
        ":=" if context.expects(&[Rule::equals, Rule::becomes]) => {
            ("`:=` belongs into `jump` and `link`", "a definition has a plain `=`", "write `=`")
        }
        "=" if context.expects(&[Rule::assigns]) => {
            ("a new value is assigned with `:=`", "`=` would be an equation", "write `:=`")
        }
        "*" | "**" if context.previous()?.text == "*" || token.text == "**" => {
            ("`**` is not an operator", "meant as a power?", "write `^`, as in `v^2`")
        }
        "&&" | "||" => (
            "conditions are not joined by signs",
            "one condition ends here",
            "write one item for each condition",
        ),
        _ => return None,
    };
    let diagnostic = Diagnostic::new(Code::Unfinished, message, token.span(), label).help(help);
    Some(match right_sign(context, token) {
        Some((span, sign)) => {
            diagnostic.fix(Fix::certain(format!("write `{sign}`")).replace(span, sign))
        }
        None => diagnostic,
    })
}

/// The sign that a wrong one stands for, and where it goes.
fn right_sign(context: &ErrorContext<'_, '_>, token: &Token<'_>) -> Option<(Span, &'static str)> {
    let compares = context.expects(&[Rule::relation, Rule::guard_relation]);
    let before = context.previous().map_or(token.span(), Token::span);
    Some(match token.text {
        "=" if compares => (token.span(), "=="),
        "=" => (token.span(), ":="),
        "==" | ":=" => (token.span(), "="),
        "<" => (token.span(), "<="),
        ">" => (token.span(), ">="),
        "**" => (token.span(), "^"),
        "*" => (before.to(token.span()), "^"),
        _ => return None,
    })
}

/// A word that is nearly one of those that the item goes on with: `smooth sigma = 0.1 kernl tanh`.
pub(super) fn misspelt_word(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let token = context.next().filter(|token| token.kind == Kind::Word)?;
    let inner = words::inner_words(context.word).iter().copied();
    let meant = match token.text {
        "foreach" if context.word == "phase" => "for each",
        word => words::closest(word, inner)?,
    };
    if meant == token.text {
        return None;
    }
    let message = format!("`{}` is not a word of {}", token.text, context.form?.noun);
    let diagnostic = Diagnostic::new(
        Code::Unfinished,
        message,
        token.span(),
        format!("did you mean `{meant}`?"),
    );
    let fix = Fix::certain(format!("write `{meant}`")).replace(token.span(), meant);
    Some(diagnostic.help(format!("change `{}` to `{meant}`", token.text)).fix(fix))
}

/// `x'' = ...`
pub(super) fn second_derivative(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) = (context.previous()?, context.next()?);
    if previous.text != "'" || next.text != "'" {
        return None;
    }
    let message = "a second derivative needs a state of its own";
    let diagnostic = Diagnostic::new(
        Code::Unfinished,
        message,
        next.span(),
        "only first derivatives stand here",
    );
    Some(diagnostic.help("declare a velocity and write two equations, `x' = v` and `v' = ...`"))
}

/// `in (0, 1)`, `in 0 .. 1`, `in [0]`
pub(super) fn wrong_range(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|_| context.expects(&[Rule::interval]))?;
    let message = "a range is written in brackets";
    let diagnostic =
        Diagnostic::new(Code::Unfinished, message, next.span(), "`[` should stand here");
    Some(diagnostic.help("write `in [from, to]`; both ends belong to it"))
}

/// `x' = [v, w]`
pub(super) fn wrong_vector(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|next| next.text == "[" && context.expects_operand())?;
    let inside =
        context.tokens[context.at..context.region.end].split(|token| token.text == "]").next()?;
    if !inside.iter().any(|token| token.text == ",") {
        return None;
    }
    let message = "a vector is written in parentheses";
    let diagnostic =
        Diagnostic::new(Code::Unfinished, message, next.span(), "`(` should stand here");
    Some(diagnostic.help("write `(a, b)`; brackets are for units, ranges and parts"))
}

/// `x' = v * v' in F`: the second of two equations has lost its beginning.
pub(super) fn second_equation(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|next| matches!(next.text, "=" | "in"))?;
    if context.word != "dynamics"
        || !context.before().iter().any(|token| matches!(token.text, "=" | "in"))
    {
        return None;
    }
    let message = "an equation has one `=` or `in`";
    let diagnostic =
        Diagnostic::new(Code::Unfinished, message, next.span(), "this is the second one");
    Some(
        diagnostic
            .help("an equation begins with a state or a factor, as in `x' = v` and `m * v' = F`"),
    )
}

/// `sigma = 0.1, 0.05`
pub(super) fn second_value(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|next| next.text == "," && context.after_operand())?;
    if context.word != "method" {
        return None;
    }
    if begins_setting(context, context.at + 1) {
        let message = "settings stand side by side, without commas";
        let found =
            Diagnostic::new(Code::Unfinished, message, next.span(), "another setting follows");
        return Some(
            found
                .help("leave the comma out")
                .fix(Fix::certain("leave it out").replace(next.span(), "")),
        );
    }
    let diagnostic = Diagnostic::new(
        Code::Unfinished,
        "a setting has one value",
        next.span(),
        "a second value follows",
    );
    Some(diagnostic.help(
        "several widths are gone through one after the other with `continue sigma = 0.1, 0.05`",
    ))
}

/// `N = 100` or `scheme rk4`
fn begins_setting(context: &ErrorContext<'_, '_>, at: usize) -> bool {
    let is_word = context.tokens.get(at).is_some_and(|token| token.kind == Kind::Word);
    let has_value = |token: &Token<'_>| {
        token.text == "=" || matches!(token.kind, Kind::Word | Kind::Number) && !token.begins_line
    };
    is_word && context.tokens.get(at + 1).is_some_and(has_value)
}

/// Items that have one place only: `model` at the head, phases and links outside phases.
pub(super) fn misplaced_item(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let first = context.next().filter(|_| context.at == context.region.start)?;
    let help = match first.text {
        "model" => "write it once, before the first item",
        "phase" | "link" => "close the phase before it with `}`",
        _ => return None,
    };
    let message = format!("`{}` cannot stand here", first.text);
    Some(
        Diagnostic::new(Code::Unfinished, message, first.span(), "this has another place")
            .help(help),
    )
}
