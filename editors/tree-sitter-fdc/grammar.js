// The syntax of `.fdc` models for editors. Its rules have the names of those in `grammar/src/fdc.pest`, which says what a model is;
// every model of the repository is read by both. Words of items stand in `../words.json`, which the compiler writes.

const { items, keywords, clauses } = require("../words.json");

const PRECEDENCE = { sum: 1, product: 2, sign: 3, power: 4, quantity: 5, derivative: 6 };

const list = (rule) => seq(rule, repeat(seq(",", rule)));
const block = (rule) => seq("{", repeat(rule), "}");

// An item of the language: a rule whose first word is one of the list.
const item = (word, ...rest) => {
  if (!items.includes(word) && !clauses.includes(word)) throw new Error(`${word} is no item of the language`);
  return seq(word, ...rest);
};

const keyword = (word) => {
  if (!keywords.includes(word)) throw new Error(`${word} is no keyword of the language`);
  return word;
};

module.exports = grammar({
  name: "fdc",
  word: ($) => $.name,
  extras: ($) => [/[ \t\r\n\uFEFF\u00A0]/, $.comment, $.documentation],
  // `src/scanner.c` looks ahead: a suffix stays on the line of its value, so that an equation may begin with a parenthesis;
  // and a value may be missing in front of a line that begins an item, as it is while the value is being written.
  externals: ($) => [$._suffix, $._prime, $.missing, $._recovering],
  // `start`, `guess`, `kernel`, `steps` and `scheme` may go on with what stands before or begin the next; what follows decides.
  conflicts: ($) => [[$.state], [$.control], [$.free], [$.smooth], [$.grid]],

  rules: {
    file: ($) => seq(optional($.model), repeat($._item)),

    model: ($) => item("model", field("name", $.name)),

    _item: ($) =>
      choice(
        $.parameter, $.constant, $.definition, $.signal, $.function, $.data, $.free, $.time, $.state, $.control, $.surface,
        $.dynamics, $.metric, $.jump, $.start, $.end, $.at, $.path, $.objective, $.fit, $.guess, $.phase, $.link, $.method, $.sweep,
        $.report, $.plot, $.expect,
      ),

    // ---- Declarations ----

    parameter: ($) =>
      item("param", field("name", $.name), optional(seq("=", $._expression, optional($.unit))), optional($.bounds)),
    constant: ($) => item("const", field("name", $.name), "=", $._expression, optional($.unit)),
    definition: ($) => item("let", field("name", $.name), optional($.unit), "=", $._expression),
    signal: ($) => item("signal", field("name", $.name), optional($.unit), "=", $._expression),
    function: ($) => item("fn", field("name", $.name), $.names, "=", $._expression),
    names: ($) => seq("(", list($.name), ")"),
    data: ($) =>
      item("data", field("name", $.name), "=", $._table),
    _table: ($) => seq("csv", "(", $.string, ")", "columns", list($.column)),
    // Where nothing but a name can stand, here and behind a dot, a reserved word is one.
    column: ($) => seq(field("name", $.name), optional($.unit)),
    free: ($) => item("free", field("name", $.name), optional($._range), optional($.guess_value)),
    time: ($) => item("time", field("name", $.name), $.bounds, optional($.unit)),
    state: ($) =>
      item("state", field("name", $.name), optional($.names), optional($._range), optional(choice($.start_value, $.start_free))),
    start_value: ($) => seq("start", $._expression),
    start_free: ($) => seq("start", "free", optional($.bounds)),
    control: ($) =>
      item("control", field("name", $.name), optional($.names), optional($._range), optional($.guess_value)),
    guess_value: ($) => seq("guess", $._expression),
    _range: ($) => choice(seq($.unit, optional($.bounds)), seq($.bounds, optional($.unit))),
    bounds: ($) => seq(keyword("in"), $.interval),
    interval: ($) => seq("[", $._expression, ",", $._expression, "]"),

    // ---- Dynamics ----

    surface: ($) => item("surface", field("name", $.name), "=", $._expression),
    dynamics: ($) => item("dynamics", block($.equation)),
    equation: ($) => seq(optional(seq(field("factor", $._expression), "*")), $.derivative, choice("=", keyword("in")), $._expression),
    // In front of an equation `v'` is always what the equation is about.
    derivative: ($) => prec(PRECEDENCE.derivative, seq(field("name", $.name), $._prime, "'")),
    metric: ($) => item("metric", list($.weight)),
    weight: ($) => seq($.name, ":", $._expression),
    jump: ($) =>
      item(
        "jump", field("name", $.name), "on", field("surface", $.name), choice("falling", "rising"),
        optional(seq("at", "most", $._expression)), optional(seq("then", "hold", field("surface", $.name))), block($.assignment),
      ),
    assignment: ($) => seq(choice($.name, alias("same", $.name)), optional(seq(".", field("part", $.name))), ":=", $._expression),

    // ---- Conditions and objective ----

    start: ($) => item("start", $.condition),
    end: ($) => item("end", $.condition),
    at: ($) => item("at", field("time", $._expression), ":", $.condition),
    path: ($) => item("path", optional(seq(field("name", $.name), ":")), $.condition),
    condition: ($) => seq($._expression, $.relation, $._expression, optional(seq($.relation, $._expression))),
    relation: (_) => choice("<=", ">=", "=="),
    objective: ($) => choice(item("minimize", $._expression), item("maximize", $._expression)),

    fit: ($) => item("fit", field("data", $.name), ":", list($.fitted)),
    fitted: ($) => seq($._expression, optional(seq("=", field("column", $.name))), "sd", $._expression),

    // ---- Guess, phases, method, report, expect ----

    guess: ($) => item("guess", block($.binding)),
    binding: ($) => seq($.name, "=", $._expression),
    phase: ($) => item("phase", field("name", $.name), optional($.like), optional($.each), block($._item)),
    like: ($) => seq("like", $.name),
    each: ($) => seq("for", "each", $._table),
    link: ($) => item("link", $.name, "->", $.name, block(choice($.same, $.assignment))),
    same: (_) => "same",
    method: ($) => item("method", block($._setting)),
    _setting: ($) => choice($.smooth, $.grid, $.continuation, $.kernel, $.steps, $.scheme, $.entry),
    // What may belong to the setting before does so, as much of it as there is; `scheme = radau` is a setting of its own.
    smooth: ($) => seq("smooth", $.entry, optional(prec.dynamic(1, $.kernel))),
    grid: ($) => seq("grid", $.entry, optional(prec.dynamic(1, $.steps)), optional(prec.dynamic(2, $.scheme))),
    continuation: ($) => seq("continue", alias("sigma", $.name), "=", list($._expression), optional($.unit)),
    kernel: ($) => seq("kernel", field("value", $.name)),
    steps: ($) => seq("steps", $._expression),
    scheme: ($) => seq("scheme", field("value", $.name), optional($.lagged)),
    lagged: ($) => seq("lagged", $.names),
    entry: ($) => seq(field("key", $._key), "=", $._expression, optional($.unit)),
    _key: ($) => choice($.name, alias(choice("kernel", "steps", "scheme"), $.name)),
    sweep: ($) => item("sweep", block($.swept)),
    swept: ($) => seq($.name, "=", list($._expression)),
    report: ($) => item("report", block($.binding)),
    plot: ($) =>
      item("plot", field("name", $.name), ":", list($._expression), "over", field("over", $._expression), optional($.border)),
    border: ($) => seq("with", list(field("path", $.name))),
    expect: ($) => item("expect", block($.check)),
    check: ($) => seq($._expression, $.relation, $._expression, optional($.within)),
    within: ($) => seq(keyword("within"), $._expression, optional($.unit)),

    // ---- Expressions ----

    _expression: ($) => choice($._value, $.number, $.negation, $.operation, $.missing),
    _value: ($) =>
      choice($.name, $.quantity, $.group, $.piecewise, $.switch, $.call, $.part, $.index, $.rate),
    negation: ($) => prec(PRECEDENCE.sign, seq("-", $._expression)),
    operation: ($) =>
      choice(
        prec.left(PRECEDENCE.sum, seq($._expression, choice("+", "-"), $._expression)),
        prec.left(PRECEDENCE.product, seq($._expression, choice("*", "/"), $._expression)),
        prec.right(PRECEDENCE.power, seq($._expression, "^", $._expression)),
      ),
    call: ($) => seq(field("function", $._value), $._suffix, "(", optional(list($._argument)), ")"),
    _argument: ($) => choice("start", "end", $.iteration, $._expression),
    iteration: ($) => seq($.name, keyword("in"), $.name),
    part: ($) => seq($._value, $._suffix, ".", field("part", $.name)),
    index: ($) => seq($._value, $._suffix, "[", alias($.digits, $.number), "]"),
    digits: (_) => /[0-9]+/,
    // The derivative of a guess by time.
    rate: ($) => seq($._value, $._prime, "'"),
    group: ($) => seq("(", list($._expression), ")"),
    piecewise: ($) =>
      seq(keyword("piecewise"), "{", repeat1($.arm), keyword("otherwise"), "=>", $._expression, "}"),
    arm: ($) => seq($.guard, "=>", $._expression),
    guard: ($) => seq($._expression, choice("<=", ">=", "==", "<", ">"), $._expression),
    switch: ($) =>
      seq(
        keyword("match"), field("surface", $.name), "{", keyword("below"), "=>", $._expression, ",",
        keyword("above"), "=>", $._expression, optional(","), "}",
      ),
    quantity: ($) => prec(PRECEDENCE.quantity, seq($.number, $.unit)),
    unit: ($) => seq("[", $.unit_factor, repeat(seq(optional(choice("*", "/")), $.unit_factor)), "]"),
    unit_factor: ($) => seq(choice($.unit_name, "1"), optional(seq("^", $.exponent))),
    unit_name: (_) => token(new RustRegex("[\\p{XID_Start}°%]\\p{XID_Continue}*")),
    exponent: (_) => /-?[0-9]+/,

    // ---- Tokens ----

    number: (_) => /([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?/,
    string: (_) => /"[^"\r\n]*"/,
    // Unicode lets a middle dot stand in a name; here it is a slip for `*`.
    name: (_) => new RustRegex("[\\p{XID_Start}_][\\p{XID_Continue}--·]*"),
    comment: (_) => /#([^!\r\n][^\r\n]*)?/,
    documentation: (_) => /#![^\r\n]*/,
  },
});
