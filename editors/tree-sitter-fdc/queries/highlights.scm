; Names that Neovim and Helix both know. Where two patterns are about the same word, the later one is the more exact.
; The line below `words:` is written by `tests/tests/editors.rs` from `editors/words.json`.

[
  ; words: items
"model" "param" "const" "let" "fn" "data" "free" "time" "state" "control" "surface" "dynamics" "metric" "jump" "start" "end" "path" "minimize" "maximize" "guess" "phase" "link" "method" "sweep" "report" "expect"
] @keyword

[
  ; words: keywords
"in" "match" "piecewise" "otherwise" "below" "above" "within"
] @keyword

[
  ; words: clauses
"csv" "columns" "on" "falling" "rising" "most" "then" "hold" "sd" "like" "for" "each" "same" "smooth" "kernel" "grid" "steps" "scheme" "lagged" "continue" "over" "with" "signal" "at" "fit" "plot"
] @keyword

(start_free "free" @keyword)

(comment) @comment
(documentation) @comment.documentation
(string) @string
(number) @constant.numeric

(parameter name: (name) @constant)
(constant name: (name) @constant)
(definition name: (name) @variable)
(signal name: (name) @variable)
(state name: (name) @variable)
(control name: (name) @variable)
(free name: (name) @variable)
(time name: (name) @variable)
(derivative name: (name) @variable)
(names (name) @variable.parameter)
(part part: (name) @variable.other.member)

(surface name: (name) @label)
(switch surface: (name) @label)
(jump surface: (name) @label)
(jump name: (name) @label)
(path name: (name) @label)
(plot name: (name) @label)
(border path: (name) @label)
(phase name: (name) @label)
(link (name) @label)
(model name: (name) @label)

(entry key: (name) @attribute)
(kernel value: (name) @constant.builtin)
(scheme value: (name) @constant.builtin)

(unit) @type
(unit_name) @type
(exponent) @constant.numeric

(function name: (name) @function)
(call function: (name) @function)
((call function: (name) @function.builtin)
  (#any-of? @function.builtin
    ; words: functions
"sqrt" "exp" "log" "sin" "cos" "tan" "asin" "acos" "atan" "atan2" "sinh" "cosh" "tanh" "abs" "min" "max" "dot" "norm" "normsq" "cross" "Sgn" "Dir" "selected" "integral" "sum" "interpolate" "blend" "sliding" "sensitivity"
  ))
((name) @constant.builtin
  (#any-of? @constant.builtin
    ; words: constants
"pi" "inf"
  ))

[ "<=" ">=" "==" "<" ">" "=" ":=" "=>" "->" "+" "-" "*" "/" "^" "'" ] @operator
[ "(" ")" "{" "}" "[" "]" ] @punctuation.bracket
[ "," ":" "." ] @punctuation.delimiter
