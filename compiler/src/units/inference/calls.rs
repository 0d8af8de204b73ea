//! What a call measures: the builtin functions, the special forms, and the model's own functions,
//! each time anew.

use super::declared::Declared;
use super::requirement::{Call, Reason};
use super::value::{Part, Value, pairwise};
use super::{Inference, Operand, side};
use crate::syntax::functions::is_function;
use crate::units::dimension::Dimension;
use crate::units::dimension::ratio::Ratio;
use fdcc_grammar::ast::{Argument, Expr, ExprKind, Ident, ItemKind};

/// Beyond so many different uses of functions the rest goes with everything.
const MOST_APPLICATIONS: usize = 5_000;

/// Functions inside functions inside functions.
const DEEPEST_CALL: usize = 48;

impl<'a> Inference<'a> {
    /// `callee(arguments)`.
    pub fn call(&mut self, expr: &'a Expr, callee: &'a Expr, arguments: &'a [Argument]) -> Value {
        if let [Argument::End(_) | Argument::Start(_)] = arguments {
            return self.evaluate(callee);
        }
        if let ExprKind::Call(_, given) = &callee.kind
            && let Some(Argument::Expr(function)) = given.first()
        {
            // `blend(f, width)(x)` measures what `f(x)` does.
            return self.blended(function, given.get(1), |it| it.call(expr, function, arguments));
        }
        let ExprKind::Name(name) = &callee.kind else { return self.at_a_row(callee, arguments) };
        let declared = self.scope.find(name);
        let Some(at) = declared.filter(|_| !is_function(name)) else {
            return self.builtin(name, expr, arguments);
        };
        let declaration = self.scope.declarations[at];
        let given: Vec<Operand<'a>> = self.given(arguments);
        match &declaration.item.kind {
            ItemKind::Fn { arguments: formal, body, .. } if !self.circular[at] => {
                let call =
                    Call { span: expr.span, name: declaration.name, arguments: formal, body };
                self.apply(call, given.into_iter().map(|it| it.0).collect())
            }
            ItemKind::Fn { .. } => Value::new(),
            _ => self.at_a_row(callee, arguments),
        }
    }

    /// `x(k.t)`: a state at the time of a measurement.
    fn at_a_row(&mut self, callee: &'a Expr, arguments: &'a [Argument]) -> Value {
        let name = match &callee.kind {
            ExprKind::Name(name) => name,
            ExprKind::Part(_, part) if self.sums > 0 => &part.name,
            _ => return Value::new(),
        };
        let (value, time) = (self.evaluate(callee), self.time());
        if let Some(at) = self.given(arguments).first() {
            self.compare(Reason::Together(name), at, &(time, at.1.clone()));
        }
        value
    }

    fn given(&mut self, arguments: &'a [Argument]) -> Vec<Operand<'a>> {
        let mut given = Vec::new();
        for argument in arguments {
            if let Argument::Expr(value) = argument {
                given.push(self.operand(value));
            }
        }
        given
    }

    /// A function of the model for these arguments; remembered, because functions build on each
    /// other.
    fn apply(&mut self, call: Call<'a>, values: Vec<Value>) -> Value {
        let key = (call.name.span, values, self.gaps.is_some());
        if let Some((value, gaps)) = self.applied.get(&key).cloned() {
            gaps.into_iter().for_each(|gap| self.gap(&gap));
            return value;
        }
        if self.calls.len() > DEEPEST_CALL || self.applied.len() > MOST_APPLICATIONS {
            return Value::new();
        }
        let outer = std::mem::replace(&mut self.frame, self.locals.len());
        let names = call.arguments.iter().map(|name| name.name.as_str());
        self.locals.extend(names.zip(key.1.clone()));
        self.calls.push(call);
        let around = self.gaps.clone();
        self.gaps = around.as_ref().map(|_| Value::new());
        let value = self.evaluate(call.body);
        let gaps = std::mem::replace(&mut self.gaps, around).unwrap_or_default();
        self.calls.pop();
        self.locals.truncate(self.frame);
        self.frame = outer;
        gaps.iter().for_each(|gap| self.gap(gap));
        self.applied.insert(key, (value.clone(), gaps));
        value
    }

    /// Something changes sides where this is 0.
    pub fn gap(&mut self, gap: &Part) {
        let gap = gap.clone().alone();
        if let Some(gaps) = self.gaps.as_mut().filter(|gaps| !gaps.contains(&gap)) {
            gaps.push(gap);
        }
    }

    /// Something changes sides where this is as large as something else; a plain number takes the
    /// unit of that.
    pub fn gaps_of(&mut self, side: &[Part]) {
        side.iter().filter(|part| !part.plain).for_each(|part| self.gap(part));
    }

    /// What `blend` rounds: its width is one of every gap in it.
    fn blended(
        &mut self,
        inner: &'a Expr,
        width: Option<&'a Argument>,
        evaluate: impl FnOnce(&mut Self) -> Value,
    ) -> Value {
        let around = self.gaps.replace(Value::new());
        let value = evaluate(self);
        let gaps = std::mem::replace(&mut self.gaps, around).unwrap_or_default();
        if let Some(Argument::Expr(width)) = width {
            let width = self.operand(width);
            for gap in &gaps {
                self.equate(Reason::Blend, &(vec![gap.clone()], side(inner)), &width);
            }
            self.read(&width, &(gaps, side(inner)));
        }
        value
    }

    fn builtin(&mut self, name: &'a str, expr: &'a Expr, arguments: &'a [Argument]) -> Value {
        if let [Argument::Iteration(row, data), Argument::Expr(term)] = arguments {
            return self.sum(row, data, term);
        }
        if let ("blend", [Argument::Expr(inner), width]) = (name, arguments) {
            return self.blended(inner, Some(width), |it| it.evaluate(inner));
        }
        let given = self.given(arguments);
        if let "abs" | "min" | "max" = name {
            given.iter().for_each(|side| self.gaps_of(&side.0));
        }
        match (name, &given[..]) {
            ("abs" | "selected", [only]) => only.0.clone(),
            ("sqrt", [only]) => self.powers(&only.0, Ratio::from_decimal(0.5)),
            ("min" | "max", [a, b]) => into_formula(self.equal(Reason::Together(name), a, b)),
            ("atan2", [a, b]) => {
                self.equal(Reason::Together(name), a, b);
                angle()
            }
            ("norm", [only]) => into_formula(self.one_unit(name, only)),
            ("normsq", [only]) => {
                let one = self.one_unit(name, only);
                self.powers(&one, Some(Ratio::whole(2)))
            }
            ("dot", [a, b]) => {
                let products = pairwise(&a.0, &b.0, Part::times);
                self.one_unit(name, &(products, a.1.clone()))
            }
            ("cross", [a, b]) => self.cross(a, b),
            ("Sgn" | "Dir", [only]) => self.set(name, only),
            ("integral", [only]) => self.integral(only),
            ("sliding", _) => self.time(),
            ("sensitivity", [of, by]) => pairwise(&of.0, &by.0, Part::over),
            ("interpolate", [times, values, at, ..]) => {
                self.compare(Reason::Together(name), at, times);
                values.0.clone()
            }
            (_, [only]) if crate::expressions::graph::builtins::find(name).is_some() => {
                self.without_unit(name, expr, only)
            }
            _ => Value::new(),
        }
    }

    /// `sin(x)` and all that are defined for numbers alone.
    fn without_unit(&mut self, name: &'a str, expr: &'a Expr, only: &Operand<'a>) -> Value {
        match self.need_none(Reason::NoUnit(name), expr.span, only) {
            true if matches!(name, "asin" | "acos" | "atan") => angle(),
            true => no_unit(std::slice::from_ref(only)),
            false => vec![self.free(expr.span)],
        }
    }

    /// Time is not named in it: the integral of a speed in m/s is a length in m, also over minutes.
    fn integral(&self, only: &Operand<'a>) -> Value {
        pairwise(&only.0, &self.time(), |part, time| match part.declared.is_si() {
            true => part.times(time).in_unit(Declared::SI).into_formula(),
            false => part.times(time),
        })
    }

    fn powers(&self, value: &[Part], exponent: Option<Ratio>) -> Value {
        value
            .iter()
            .map(|part| exponent.map_or(Part::ANY, |exponent| part.power(exponent)))
            .collect()
    }

    /// All parts must have one unit; which.
    fn one_unit(&mut self, name: &'a str, operand: &Operand<'a>) -> Value {
        let (value, side) = operand;
        let Some(first) = value.first() else { return Value::new() };
        let first = (vec![first.clone()], side.clone());
        let one = value[1..].iter().fold(first.0.clone(), |one, part| {
            self.equal(
                Reason::Together(name),
                &(one, side.clone()),
                &(vec![part.clone()], side.clone()),
            )
        });
        one.into_iter().map(Part::alone).collect()
    }

    /// `a_i b_j - a_j b_i`: a number in the plane, a vector in space.
    fn cross(&mut self, a: &Operand<'a>, b: &Operand<'a>) -> Value {
        let side = a.1.clone();
        let mut minor = |i: usize, j: usize| {
            let products = vec![a.0[i].times(&b.0[j]), a.0[j].times(&b.0[i])];
            self.one_unit("cross", &(products, side.clone())).pop().unwrap_or(Part::ANY)
        };
        match (a.0.len(), b.0.len()) {
            (2, 2) => vec![minor(0, 1)],
            (3, 3) => vec![minor(1, 2), minor(2, 0), minor(0, 1)],
            _ => Value::new(),
        }
    }

    /// `Sgn` and `Dir` take any unit and have none.
    fn set(&mut self, name: &'a str, only: &Operand<'a>) -> Value {
        let one = self.one_unit(name, only);
        self.switches.extend(one);
        only.0.iter().map(|part| Part::of(Dimension::none()).called_as(part)).collect()
    }

    /// `sum(k in data, term)`.
    fn sum(&mut self, row: &'a Ident, data: &'a Ident, term: &'a Expr) -> Value {
        let Some(at) = self.scope.find(&data.name) else { return Value::new() };
        let columns = self.row_of(self.scope.declarations[at].item);
        self.locals.push((&row.name, columns));
        self.sums += 1;
        let value = self.evaluate(term);
        self.sums -= 1;
        self.locals.pop();
        value
    }
}

fn into_formula(value: Value) -> Value {
    value.into_iter().map(Part::into_formula).collect()
}

/// In radians, also of plain numbers: an angle is no number that may count in degrees.
fn angle() -> Value {
    vec![Part::of(Dimension::none()).in_unit(Declared::radians())]
}

fn no_unit(arguments: &[Operand<'_>]) -> Value {
    let plain = arguments.iter().flat_map(|it| &it.0).all(|part| part.plain);
    vec![Part { plain, ..Part::of(Dimension::none()) }]
}
