//! The table of operators and functions: one row says everything about one of them.
//!
//! The interpreter uses `value`, differentiation `partial`, machine code `lowering`, the manual
//! `doc` and `domain`, the checks `smoothness`. A new function is a new row here and nothing else;
//! the conformance tests walk the table.

use super::{ExprId, Graph};

/// Everything about one builtin.
pub struct Row {
    /// Its name in the language: a word, or an operator.
    pub name: &'static str,
    /// How it is written.
    pub notation: Notation,
    /// Number of operands.
    pub arity: usize,
    /// What it is, with an example.
    pub doc: &'static str,
    /// Where it has a finite value.
    pub domain: Domain,
    /// How smooth it is inside its domain.
    pub smoothness: Smoothness,
    /// What a change of sign of the only operand does.
    pub parity: Parity,
    /// The meaning.
    pub value: fn(&[f64]) -> f64,
    /// The derivative by one operand, given the call itself and its operands.
    pub partial: fn(&mut Graph, ExprId, &[ExprId], usize) -> ExprId,
    /// How it becomes machine code.
    pub lowering: Lowering,
}

/// How a builtin is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Notation {
    /// Between its operands; a higher number binds more tightly.
    Infix(u8),
    /// In front of its operand.
    Prefix,
    /// `name(operands)`.
    Function,
    /// Not written by users.
    Internal,
}

/// Which operands give finite values; the number is the operand that matters.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Domain {
    /// All numbers.
    All,
    /// At least zero.
    NonNegative(usize),
    /// Above zero.
    Positive(usize),
    /// Not zero.
    NonZero(usize),
    /// Between -1 and 1.
    Unit(usize),
}

impl Domain {
    /// Whether the operands are inside.
    pub fn contains(self, operands: &[f64]) -> bool {
        match self {
            Domain::All => true,
            Domain::NonNegative(operand) => operands[operand] >= 0.0,
            Domain::Positive(operand) => operands[operand] > 0.0,
            Domain::NonZero(operand) => operands[operand] != 0.0,
            Domain::Unit(operand) => operands[operand].abs() <= 1.0,
        }
    }
}

/// How often a builtin can be differentiated inside its domain.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Smoothness {
    /// May jump.
    Jump,
    /// Continuous with kinks.
    Kink,
    /// All derivatives exist.
    Analytic,
}

/// Symmetry of a function of one operand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Parity {
    /// f(-x) = f(x).
    Even,
    /// f(-x) = -f(x).
    Odd,
    /// No symmetry that simplification should use.
    Neither,
}

/// How a builtin becomes machine code.
#[derive(Clone, Copy, Debug)]
pub enum Lowering {
    /// Instructions written out in place.
    Inline(Inline),
    /// A call for each point.
    Call1(extern "C" fn(f64) -> f64),
    /// A call for each point, with two operands.
    Call2(extern "C" fn(f64, f64) -> f64),
}

/// What the code generator can write out in place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // the names say it
pub enum Inline {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Sqrt,
    Abs,
    Min,
    Max,
    SelectLe,
    Sin,
    Cos,
    Exp,
    Tanh,
}

/// Makes the enum, the list of all and the table out of one list of rows.
macro_rules! table {
    ($($(#[$doc:meta])* $id:ident = $row:expr;)+) => {
        /// An operator or a function of the language.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
        #[allow(missing_docs)] // each row has a `doc`
        pub enum Builtin { $($id),+ }

        /// All builtins in the order of the table.
        pub const ALL: &[Builtin] = &[$(Builtin::$id),+];

        static ROWS: &[Row] = &[$($row),+];
    };
}

impl Builtin {
    /// Everything about it.
    pub fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }
}

/// The function that users write as `name`.
pub fn find(name: &str) -> Option<Builtin> {
    ALL.iter().copied().find(|builtin| {
        let row = builtin.row();
        row.notation == Notation::Function && row.name == name
    })
}

/// Most functions: one operand, written `name(x)`, analytic everywhere, one call for each point.
const FUNCTION: Row = Row {
    name: "",
    notation: Notation::Function,
    arity: 1,
    doc: "",
    domain: Domain::All,
    smoothness: Smoothness::Analytic,
    parity: Parity::Neither,
    value: |_| f64::NAN,
    partial: |g, _, _, _| g.number(f64::NAN),
    lowering: Lowering::Inline(Inline::Neg),
};

/// What all operators share.
const OPERATOR: Row = Row { arity: 2, notation: Notation::Infix(1), ..FUNCTION };

table! {
    Add = Row {
        name: "+",
        doc: "Sum. `1 + 2 = 3`.",
        value: |a| a[0] + a[1],
        partial: |g, _, _, _| g.number(1.0),
        lowering: Lowering::Inline(Inline::Add),
        ..OPERATOR
    };
    Sub = Row {
        name: "-",
        doc: "Difference. `3 - 2 = 1`.",
        value: |a| a[0] - a[1],
        partial: |g, _, _, which| g.number(if which == 0 { 1.0 } else { -1.0 }),
        lowering: Lowering::Inline(Inline::Sub),
        ..OPERATOR
    };
    Mul = Row {
        name: "*",
        notation: Notation::Infix(2),
        doc: "Product. `2 * 3 = 6`.",
        value: |a| a[0] * a[1],
        partial: |_, _, a, which| a[1 - which],
        lowering: Lowering::Inline(Inline::Mul),
        ..OPERATOR
    };
    Div = Row {
        name: "/",
        notation: Notation::Infix(2),
        doc: "Quotient. `6 / 3 = 2`.",
        domain: Domain::NonZero(1),
        value: |a| a[0] / a[1],
        // d(a/b) = da/b - (a/b)/b db
        partial: |g, call, a, which| {
            let quotient = g.div(call, a[1]);
            if which == 0 { g.reciprocal(a[1]) } else { g.neg(quotient) }
        },
        lowering: Lowering::Inline(Inline::Div),
        ..OPERATOR
    };
    Neg = Row {
        name: "-",
        notation: Notation::Prefix,
        doc: "Change of sign. `-(2) = 0 - 2`.",
        parity: Parity::Odd,
        value: |a| -a[0],
        partial: |g, _, _, _| g.number(-1.0),
        lowering: Lowering::Inline(Inline::Neg),
        ..FUNCTION
    };
    Pow = Row {
        name: "^",
        notation: Notation::Infix(4),
        doc: "Power. `2^3 = 8`. A power with a whole exponent is a product; any other needs a \
              positive base.",
        domain: Domain::Positive(0),
        value: |a| a[0].powf(a[1]),
        // d(a^b) = b a^(b-1) da + a^b log(a) db
        partial: |g, call, a, which| {
            if which == 0 {
                let one = g.number(1.0);
                let exponent = g.sub(a[1], one);
                let power = g.pow(a[0], exponent);
                g.mul(a[1], power)
            } else {
                let logarithm = g.log(a[0]);
                g.mul(call, logarithm)
            }
        },
        lowering: Lowering::Call2(powf),
        ..OPERATOR
    };
    Sqrt = Row {
        name: "sqrt",
        doc: "Square root. `sqrt(9) = 3`. Its derivative is infinite at 0.",
        domain: Domain::NonNegative(0),
        value: |a| a[0].sqrt(),
        partial: |g, call, _, _| {
            let reciprocal = g.reciprocal(call);
            g.scale(0.5, reciprocal)
        },
        lowering: Lowering::Inline(Inline::Sqrt),
        ..FUNCTION
    };
    Exp = Row {
        name: "exp",
        doc: "Exponential function. `exp(0) = 1`.",
        value: |a| a[0].exp(),
        partial: |_, call, _, _| call,
        lowering: Lowering::Inline(Inline::Exp),
        ..FUNCTION
    };
    Log = Row {
        name: "log",
        doc: "Natural logarithm. `log(1) = 0`.",
        domain: Domain::Positive(0),
        value: |a| a[0].ln(),
        partial: |g, _, a, _| g.reciprocal(a[0]),
        lowering: Lowering::Call1(log),
        ..FUNCTION
    };
    Sin = Row {
        name: "sin",
        doc: "Sine of an angle in radians. `sin(0) = 0`.",
        parity: Parity::Odd,
        value: |a| a[0].sin(),
        partial: |g, _, a, _| g.cos(a[0]),
        lowering: Lowering::Inline(Inline::Sin),
        ..FUNCTION
    };
    Cos = Row {
        name: "cos",
        doc: "Cosine of an angle in radians. `cos(0) = 1`.",
        parity: Parity::Even,
        value: |a| a[0].cos(),
        partial: |g, _, a, _| {
            let sine = g.sin(a[0]);
            g.neg(sine)
        },
        lowering: Lowering::Inline(Inline::Cos),
        ..FUNCTION
    };
    Tan = Row {
        name: "tan",
        doc: "Tangent of an angle in radians. `tan(0) = 0`.",
        parity: Parity::Odd,
        value: |a| a[0].tan(),
        // tan' = 1 + tan^2
        partial: |g, call, _, _| {
            let square = g.square(call);
            let one = g.number(1.0);
            g.add(one, square)
        },
        lowering: Lowering::Call1(tan),
        ..FUNCTION
    };
    Asin = Row {
        name: "asin",
        doc: "Angle in [-pi/2, pi/2] whose sine is given. `asin(0) = 0`.",
        domain: Domain::Unit(0),
        parity: Parity::Odd,
        value: |a| a[0].asin(),
        partial: |g, _, a, _| {
            let cosine = unit_circle(g, a[0]);
            g.reciprocal(cosine)
        },
        lowering: Lowering::Call1(asin),
        ..FUNCTION
    };
    Acos = Row {
        name: "acos",
        doc: "Angle in [0, pi] whose cosine is given. `acos(1) = 0`.",
        domain: Domain::Unit(0),
        value: |a| a[0].acos(),
        partial: |g, _, a, _| {
            let sine = unit_circle(g, a[0]);
            let reciprocal = g.reciprocal(sine);
            g.neg(reciprocal)
        },
        lowering: Lowering::Call1(acos),
        ..FUNCTION
    };
    Atan = Row {
        name: "atan",
        doc: "Angle in (-pi/2, pi/2) whose tangent is given. `atan(0) = 0`.",
        parity: Parity::Odd,
        value: |a| a[0].atan(),
        partial: |g, _, a, _| {
            let square = g.square(a[0]);
            let one = g.number(1.0);
            let denominator = g.add(one, square);
            g.reciprocal(denominator)
        },
        lowering: Lowering::Call1(atan),
        ..FUNCTION
    };
    Atan2 = Row {
        name: "atan2",
        arity: 2,
        doc: "Angle of the point (x, y): `atan2(y, x)`. `atan2(0, 1) = 0`.",
        value: |a| a[0].atan2(a[1]),
        // d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)
        partial: |g, _, a, which| {
            let (y2, x2) = (g.square(a[0]), g.square(a[1]));
            let distance2 = g.add(x2, y2);
            let other = if which == 0 { a[1] } else { g.neg(a[0]) };
            g.div(other, distance2)
        },
        lowering: Lowering::Call2(atan2),
        ..FUNCTION
    };
    Sinh = Row {
        name: "sinh",
        doc: "Hyperbolic sine. `sinh(0) = 0`.",
        parity: Parity::Odd,
        value: |a| a[0].sinh(),
        partial: |g, _, a, _| g.call(Builtin::Cosh, a),
        lowering: Lowering::Call1(sinh),
        ..FUNCTION
    };
    Cosh = Row {
        name: "cosh",
        doc: "Hyperbolic cosine. `cosh(0) = 1`.",
        parity: Parity::Even,
        value: |a| a[0].cosh(),
        partial: |g, _, a, _| g.call(Builtin::Sinh, a),
        lowering: Lowering::Call1(cosh),
        ..FUNCTION
    };
    Tanh = Row {
        name: "tanh",
        doc: "Hyperbolic tangent. `tanh(0) = 0`.",
        parity: Parity::Odd,
        value: |a| a[0].tanh(),
        // tanh' = 1 - tanh^2
        partial: |g, call, _, _| {
            let square = g.square(call);
            let one = g.number(1.0);
            g.sub(one, square)
        },
        lowering: Lowering::Inline(Inline::Tanh),
        ..FUNCTION
    };
    LogCosh = Row {
        name: "log_cosh",
        notation: Notation::Internal,
        doc: "`log(cosh(x))` without overflow: the antiderivative of tanh, for smoothing `abs`.",
        parity: Parity::Even,
        value: |a| log_cosh(a[0]),
        partial: |g, _, a, _| g.tanh(a[0]),
        lowering: Lowering::Call1(log_cosh),
        ..FUNCTION
    };
    Abs = Row {
        name: "abs",
        doc: "Absolute value. `abs(-2) = 2`. It has a kink at 0.",
        smoothness: Smoothness::Kink,
        parity: Parity::Even,
        value: |a| a[0].abs(),
        partial: |g, _, a, _| sign(g, a[0]),
        lowering: Lowering::Inline(Inline::Abs),
        ..FUNCTION
    };
    Min = Row {
        name: "min",
        arity: 2,
        doc: "The smaller of two. `min(1, 2) = 1`. It has a kink where they are equal, and no \
              value where one of them has none.",
        smoothness: Smoothness::Kink,
        value: |a| if a[0] <= a[1] || a[0].is_nan() { a[0] } else { a[1] },
        partial: |g, _, a, which| indicator(g, a[0], a[1], which == 0),
        lowering: Lowering::Inline(Inline::Min),
        ..FUNCTION
    };
    Max = Row {
        name: "max",
        arity: 2,
        doc: "The larger of two. `max(1, 2) = 2`. It has a kink where they are equal, and no value \
              where one of them has none.",
        smoothness: Smoothness::Kink,
        value: |a| if a[1] <= a[0] || a[0].is_nan() { a[0] } else { a[1] },
        partial: |g, _, a, which| indicator(g, a[1], a[0], which == 0),
        lowering: Lowering::Inline(Inline::Max),
        ..FUNCTION
    };
    SelectLe = Row {
        name: "select_le",
        notation: Notation::Internal,
        arity: 4,
        doc: "`select_le(a, b, x, y)` is x where a <= b, else y; what `piecewise` is made of.",
        smoothness: Smoothness::Jump,
        value: |a| if a[0] <= a[1] { a[2] } else { a[3] },
        partial: |g, _, a, which| match which {
            2 => indicator(g, a[0], a[1], true),
            3 => indicator(g, a[0], a[1], false),
            _ => g.number(0.0),
        },
        lowering: Lowering::Inline(Inline::SelectLe),
        ..FUNCTION
    };
}

/// 1 where `(a <= b) == holds`, else 0.
fn indicator(graph: &mut Graph, a: ExprId, b: ExprId, holds: bool) -> ExprId {
    let (yes, no) = (graph.number(f64::from(holds)), graph.number(f64::from(!holds)));
    graph.select_le(a, b, yes, no)
}

/// -1, 0 or 1: the derivative of |x| with the middle of its subgradient at 0.
fn sign(graph: &mut Graph, x: ExprId) -> ExprId {
    let [minus, zero, plus] = [-1.0, 0.0, 1.0].map(|value| graph.number(value));
    let not_positive = graph.select_le(zero, x, zero, minus);
    graph.select_le(x, zero, not_positive, plus)
}

/// sqrt(1 - x^2).
fn unit_circle(graph: &mut Graph, x: ExprId) -> ExprId {
    let square = graph.square(x);
    let one = graph.number(1.0);
    let rest = graph.sub(one, square);
    graph.sqrt(rest)
}

/// log(cosh(x)) = log(1 + 2 sinh(x/2)^2) near 0, and |x| + log((1 + exp(-2|x|)) / 2) where cosh
/// might overflow.
extern "C" fn log_cosh(x: f64) -> f64 {
    if x.abs() < 1.0 {
        let half = (0.5 * x).sinh();
        (2.0 * half * half).ln_1p()
    } else {
        x.abs() + (-2.0 * x.abs()).exp().ln_1p() - std::f64::consts::LN_2
    }
}

/// Functions of the standard library with the calling convention of machine code.
macro_rules! library {
    ($($name:ident $method:ident ($($operand:ident),*);)+) => {
        $(extern "C" fn $name(x: f64, $($operand: f64),*) -> f64 { x.$method($($operand),*) })+
    };
}

library! {
    log ln();
    tan tan();
    asin asin();
    acos acos();
    atan atan();
    sinh sinh();
    cosh cosh();
    powf powf(y);
    atan2 atan2(y);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_found_by_name_and_operators_are_not() {
        assert_eq!(find("atan2"), Some(Builtin::Atan2));
        assert_eq!(find("+"), None);
        assert_eq!(find("select_le"), None);
        assert_eq!(find("sine"), None);
    }

    #[test]
    fn every_row_has_a_name_and_a_doc_with_an_example() {
        for builtin in ALL {
            let row = builtin.row();
            assert!(!row.name.is_empty());
            assert!(row.doc.contains('`'), "{}", row.name);
        }
    }

    #[test]
    fn parity_holds() {
        for row in
            ALL.iter().map(|builtin| builtin.row()).filter(|row| row.parity != Parity::Neither)
        {
            let sign = if row.parity == Parity::Odd { -1.0 } else { 1.0 };
            assert_eq!((row.value)(&[-0.6]), sign * (row.value)(&[0.6]), "{}", row.name);
        }
    }

    #[test]
    fn minimum_and_maximum_pass_on_what_is_not_a_number() {
        for operands in [[f64::NAN, 1.0], [1.0, f64::NAN]] {
            assert!((Builtin::Min.row().value)(&operands).is_nan());
            assert!((Builtin::Max.row().value)(&operands).is_nan());
        }
    }
}
