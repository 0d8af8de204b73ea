//! The table of reserved words, and of those that begin an item but may be names elsewhere: what
//! each is for, and what to write instead of it as a name.

/// A reserved word, or one that begins an item.
pub struct Word {
    /// The word.
    pub text: &'static str,
    /// "it ..."
    pub role: &'static str,
    /// A name that may stand in its place.
    pub instead: &'static str,
    /// What the item is that it introduces, if it introduces one.
    pub item: Option<Form>,
    /// Whether it can be no name.
    pub is_reserved: bool,
}

/// An item as messages speak of it.
pub struct Form {
    /// With its article.
    pub noun: &'static str,
    /// The right form.
    pub example: &'static str,
}

const fn item(
    text: &'static str,
    role: &'static str,
    instead: &'static str,
    noun: &'static str,
    example: &'static str,
) -> Word {
    Word { text, role, instead, item: Some(Form { noun, example }), is_reserved: true }
}

/// A word that begins an item, and may be a name elsewhere.
const fn soft(
    text: &'static str,
    role: &'static str,
    noun: &'static str,
    example: &'static str,
) -> Word {
    Word { is_reserved: false, ..item(text, role, text, noun, example) }
}

const fn inner(text: &'static str, role: &'static str, instead: &'static str) -> Word {
    Word { text, role, instead, item: None, is_reserved: true }
}

/// Every reserved word, and every word that begins an item.
#[rustfmt::skip]
pub const WORDS: &[Word] = &[
    item("model", "names the model", "model_1", "a model line", "model block"),
    item("param", "introduces a parameter", "p", "a parameter", "param m = 2.0 [kg]"),
    item("const", "introduces a constant", "c", "a constant", "const g = 9.81 [m/s^2]"),
    item("let", "gives an expression a name", "l", "a definition", "let drag = c * v^2"),
    soft("signal", "introduces a signal", "a signal", "signal r [m] = sin(t)"),
    item("fn", "introduces a function", "f", "a function", "fn along(th) = (cos(th), sin(th))"),
    item("data", "introduces measurements", "samples", "a data set", "data obs = \
        csv(\"slider.csv\") columns t [s], x [m]"),
    item("free", "introduces a free quantity", "unknown", "a free quantity", "free T in [0.1, 10] \
        guess 2"),
    item("time", "introduces the time", "t", "a time", "time t in [0, 4] [s]"),
    item("state", "introduces a state", "x", "a state", "state v [m/s] start 0"),
    item("control", "introduces a control", "u", "a control", "control F in [-12, 12] [N]"),
    item("surface", "introduces a switching surface", "area", "a surface", "surface slip = v"),
    item("dynamics", "introduces the equations of motion", "motion", "a dynamics block", "dynamics \
        { x' = v }"),
    item("metric", "introduces weights", "weight", "a metric", "metric v1: m1, v2: m2"),
    item("jump", "introduces a state reset", "step", "a jump", "jump bounce on ground falling at \
        most 1 { v := -e * v }"),
    item("start", "introduces a condition at the initial time", "t_start", "a start \
        condition", "start x >= 0"),
    item("end", "introduces a condition at the final time", "t_end", "an end condition", "end x == \
        1"),
    soft("at", "introduces a condition at a time", "a condition at a time", "at 1.5: x <= 3"),
    item("path", "introduces a condition at all times", "route", "a path constraint", "path track: \
        abs(y) <= w/2"),
    item("minimize", "introduces the objective", "smallest", "an objective", "minimize \
        integral(F^2)"),
    item("maximize", "introduces the objective", "largest", "an objective", "maximize h(end)"),
    soft("fit", "introduces what was measured", "a fit", "fit obs: x sd 0.1"),
    item("guess", "introduces a first trajectory", "first", "a guess", "guess { x = t/T }"),
    item("phase", "introduces a phase", "stage", "a phase", "phase boost { time t in [0, 1]  state \
        h start 0 }"),
    item("link", "connects two phases", "joint", "a link", "link boost -> coast { h := h }"),
    item("method", "says how to solve", "how", "a method block", "method { grid N = 100 scheme \
        implicit_euler }"),
    item("sweep", "lists values for several runs", "strokes", "a sweep", "sweep { sigma = 0.1, \
        0.05  N = 1000, 8000 }"),
    item("report", "lists curves to write out", "output", "a report", "report { power = F * v }"),
    soft("plot", "introduces a picture", "a plot", "plot path: pos.y over pos.x"),
    item("expect", "lists what the answer must satisfy", "expected", "an expect block", "expect { \
        x(end) == 1 within 1e-6 }"),
    inner("in", "introduces a range or a set", "inside"),
    inner("match", "tells the sides of a surface apart", "fit"),
    inner("piecewise", "introduces a function in pieces", "pieces"),
    inner("otherwise", "introduces the last piece", "rest"),
    inner("below", "is one side of a surface", "under"),
    inner("above", "is one side of a surface", "over"),
    inner("within", "introduces a tolerance", "tolerance"),
];

/// The words that begin items, in the order of the language.
pub fn items() -> impl Iterator<Item = &'static Word> {
    WORDS.iter().filter(|word| word.item.is_some())
}

/// The entry of a reserved word.
pub(crate) fn reserved(text: &str) -> Option<&'static Word> {
    WORDS.iter().find(|word| word.is_reserved && word.text == text)
}

/// The form of the item that a word introduces.
pub(crate) fn form(text: &str) -> Option<&'static Form> {
    items().find(|word| word.text == text).and_then(|word| word.item.as_ref())
}

/// Whether an item begins with a word wherever it stands.
pub(crate) fn always_begins(text: &str) -> bool {
    reserved(text).is_some_and(|word| word.item.is_some())
}

/// An entry of a block, as messages speak of it; an item that is no block has none.
pub(crate) fn entry_form(block: &str) -> Option<&'static Form> {
    match block {
        "dynamics" => Some(&Form { noun: "an equation", example: "x' = v" }),
        "guess" => Some(&Form { noun: "a guess", example: "x = t/T" }),
        "sweep" => Some(&Form { noun: "a list of values", example: "sigma = 0.1, 0.05" }),
        "report" => Some(&Form { noun: "a report", example: "power = F * v" }),
        "jump" | "link" => Some(&Form { noun: "an assignment", example: "v := -e * v" }),
        "method" => {
            Some(&Form { noun: "a setting", example: "grid N = 100 scheme implicit_euler" })
        }
        "expect" => Some(&Form { noun: "a check", example: "x(end) == 1 within 1e-6" }),
        _ => None,
    }
}

/// Words that mean something inside one kind of item only, and may be names elsewhere.
pub fn inner_words(item: &str) -> &'static [&'static str] {
    match item {
        "jump" => &["on", "falling", "rising", "at", "most", "then", "hold"],
        "data" => &["csv", "columns"],
        "fit" => &["sd"],
        "plot" => &["over", "with"],
        "phase" => &["like", "for", "each", "csv", "columns"],
        "link" => &["same"],
        "method" => &["smooth", "kernel", "grid", "steps", "scheme", "lagged", "continue"],
        "state" => &["start", "in", "free"],
        "control" | "free" => &["guess", "in"],
        "time" | "param" => &["in"],
        "expect" => &["within"],
        _ => &[],
    }
}

/// Whether a word may stand behind a name: it is reserved, or means something inside some item.
pub(crate) fn goes_on(text: &str) -> bool {
    reserved(text).is_some() || items().any(|item| inner_words(item.text).contains(&text))
}

/// What other languages call an item.
const ELSEWHERE: &[(&str, &str)] = &[
    ("parameter", "param"),
    ("constant", "const"),
    ("variable", "state"),
    ("var", "state"),
    ("input", "control"),
    ("function", "fn"),
    ("def", "fn"),
    ("min", "minimize"),
    ("max", "maximize"),
    ("objective", "minimize"),
    ("constraint", "path"),
    ("initial", "start"),
    ("final", "end"),
    ("equations", "dynamics"),
    ("ode", "dynamics"),
    ("output", "report"),
    ("options", "method"),
];

/// The item word that a word is nearly, or that it stands for elsewhere.
pub(crate) fn closest_item(word: &str) -> Option<&'static str> {
    // So short a name is near to many that are no slips.
    let may_be_meant = |known: &&Word| {
        known.is_reserved || known.text.len() > 2 || word.eq_ignore_ascii_case(known.text)
    };
    let items = items().filter(may_be_meant).map(|known| known.text);
    let elsewhere = || ELSEWHERE.iter().find(|(other, _)| *other == word).map(|(_, meant)| *meant);
    elsewhere().or_else(|| closest(word, items))
}

/// The word of a list that is most like another, if it is like enough to have been meant.
pub(crate) fn closest<'w>(word: &str, among: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    let length = word.chars().count();
    let allowed = (length / 3).clamp(1, 2);
    let similar = among.into_iter().filter(|known| known.len().abs_diff(length) <= allowed);
    let distances = similar.map(|known| (known, strsim::osa_distance(word, known)));
    let (best, _) = distances
        .filter(|(_, distance)| *distance <= allowed)
        .min_by_key(|(_, distance)| *distance)?;
    Some(best)
}
