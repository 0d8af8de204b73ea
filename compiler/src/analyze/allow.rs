//! `# fdc: allow FDC0404`: a comment that silences a warning or an advice on its line, or on the
//! next one.
//!
//! An error cannot be allowed. A comment that silences nothing is reported, FDC0010, once the text
//! has no errors: before, nobody knows what there would be to silence.

use fdcc_grammar::{Code, Diagnostic, Fix, Severity, Span, comments};

/// A code that a comment names.
struct Allowed<'t> {
    word: &'t str,
    span: Span,
    /// The bytes of the line it is about.
    line: Span,
    /// What is taken out with the code: the whole comment if it names no other.
    leftover: Span,
}

/// The findings that the text does not allow, and what is wrong with its comments.
pub(crate) fn apply(text: &str, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    if !text.contains("fdc:") {
        return found;
    }
    let mut line = Span::new(0, 0);
    let mut allowed: Vec<Allowed<'_>> = Vec::new();
    for comment in comments(text) {
        // What stands between a comment and its line are comments that are about the same line.
        if comment.end > line.start {
            line = line_of(text, comment);
        }
        allowed.extend(read(text, comment, line));
    }
    let has_error = found.iter().any(|it| it.severity == Severity::Error);
    let (silenced, mut left): (Vec<_>, Vec<_>) = found.into_iter().partition(|it| {
        it.severity != Severity::Error && allowed.iter().any(|one| one.is_about(it))
    });
    let used = |one: &&Allowed<'_>| silenced.iter().any(|it| one.is_about(it));
    left.extend(allowed.iter().filter(|one| !used(one)).filter_map(|one| useless(one, has_error)));
    left
}

impl Allowed<'_> {
    fn is_about(&self, diagnostic: &Diagnostic) -> bool {
        let at = diagnostic.span().start;
        self.word == diagnostic.code.as_str() && (self.line.start..=self.line.end).contains(&at)
    }
}

/// The codes that a comment allows; what follows them is the reason.
fn read<'t>(text: &'t str, comment: Span, line: Span) -> Vec<Allowed<'t>> {
    let words = &text[comment.range()][1..];
    let Some(list) = words
        .trim_start()
        .strip_prefix("fdc:")
        .and_then(|rest| rest.trim_start().strip_prefix("allow"))
    else {
        return Vec::new();
    };
    let codes: Vec<&'t str> = list
        .split_whitespace()
        .take_while(|word| word.to_ascii_uppercase().starts_with("FDC"))
        .collect();
    let allowed = |word: &'t str| {
        let start = word.as_ptr() as usize - text.as_ptr() as usize;
        let span = Span::new(start, start + word.len());
        // The blank before it goes with it.
        let leftover = if codes.len() == 1 {
            whole(text, comment)
        } else {
            Span::new(start - 1, start + word.len())
        };
        Allowed { word, span, line, leftover }
    };
    codes.iter().copied().map(allowed).collect()
}

/// A comment with the blanks before it, and with its line if it stands alone.
fn whole(text: &str, comment: Span) -> Span {
    let start = text[..comment.start as usize].trim_end_matches([' ', '\t']).len();
    let is_alone = text[..start].is_empty() || text[..start].ends_with('\n');
    let line_break = usize::from(is_alone && text[comment.end as usize..].starts_with('\n'));
    Span::new(start, comment.end as usize + line_break)
}

/// The line that a comment is about: its own, or the next one with words if it stands alone.
fn line_of(text: &str, comment: Span) -> Span {
    let start = text[..comment.start as usize].rfind('\n').map_or(0, |end| end + 1);
    let mut line = Span::new(start, end_of_line(text, start));
    let is_alone = |line: Span| {
        let words = text[line.range()].trim();
        words.is_empty() || words.starts_with('#')
    };
    while is_alone(line) && (line.end as usize) < text.len() {
        let next = line.end as usize + 1;
        line = Span::new(next, end_of_line(text, next));
    }
    line
}

fn end_of_line(text: &str, start: usize) -> usize {
    text[start..].find('\n').map_or(text.len(), |length| start + length)
}

fn useless(one: &Allowed<'_>, has_error: bool) -> Option<Diagnostic> {
    let word = one.word;
    let found = |message: String, label: &str| {
        Diagnostic::new(Code::UselessAllow, message, one.span, label)
    };
    let known = Code::ALL.iter().find(|code| code.as_str() == word);
    Some(match known {
        None => unknown(one),
        Some(code) if code.severity() == Severity::Error => {
            found(format!("`{word}` is an error and cannot be allowed"), "silences nothing")
                .help(format!("an error has to be mended; `fdcc explain {word}` says how"))
                .fix(Fix::likely(format!("take `{word}` out")).remove(one.leftover))
        }
        Some(_) if has_error => return None,
        Some(_) => found(format!("there is no `{word}` to allow here"), "silences nothing")
            .help("take it out; it is for its own line, or for the next one if it stands alone")
            .fix(Fix::certain(format!("take `{word}` out")).remove(one.leftover)),
    })
}

fn unknown(one: &Allowed<'_>) -> Diagnostic {
    let message = format!("there is no diagnostic `{}`", one.word);
    let meant = one.word.parse().ok().map(Code::as_str);
    let near = meant
        .or_else(|| crate::syntax::closest(one.word, Code::ALL.iter().map(|code| code.as_str())));
    let found = Diagnostic::new(Code::UselessAllow, message, one.span, "silences nothing");
    match near {
        Some(near) => found
            .help(format!("did you mean `{near}`?"))
            .fix(Fix::likely(format!("write `{near}`")).replace(one.span, near)),
        None => found.help("a code looks like this: `FDC0404`"),
    }
}
