//! The state of inference, and how two sides are made to agree.
//!
//! One walk over the text collects [`Requirement`]s; solving them comes afterwards. A text that was
//! found wrong is passed over in the next walk and counts as unknown: so a mistake is told once,
//! and nothing follows from it.

mod calls;
pub(super) mod columns;
pub(super) mod declare;
pub(super) mod declared;
mod expression;
mod items;
pub(super) mod readings;
pub(super) mod requirement;
pub(super) mod solve;
pub(super) mod value;
pub(super) mod walk;

use super::dimension::{Atom, Dimension};
use super::inference::columns::Column;
use super::inference::declared::Declared;
use super::inference::readings::{Bare, Readings};
use super::inference::requirement::{Call, Reason, Requirement, Side};
use super::inference::value::{Part, Value, pairwise};
use crate::syntax::scope::Scope;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Expr, Ident, Item};
use std::collections::{HashMap, HashSet};

/// An operand: its value and the text of it.
pub(crate) type Operand<'a> = (Value, Side<'a>);

/// A name that was given as a plain number, or the stretch of a guessed curve.
#[derive(Clone)]
pub(crate) struct PlainNumber<'a> {
    /// The name with its item.
    pub declared: Option<(&'a Ident, &'a Item)>,
    /// The unit that its place gives it.
    pub place: Option<Dimension>,
}

/// Everything that is known while the text is walked.
pub(crate) struct Inference<'a> {
    /// The names in scope.
    pub scope: Scope<'a>,
    /// Which of them need themselves.
    pub circular: Vec<bool>,
    /// What each declared name measures, by the place of the name.
    pub values: HashMap<Span, Value>,
    /// How many names, or parts of them, have no unit.
    pub unknowns: usize,
    /// What was given as a plain number.
    pub numbers: Vec<PlainNumber<'a>>,
    /// Arguments of the function we are in, from `frame` on, and rows of data.
    pub locals: Vec<(&'a str, Value)>,
    /// Where the visible locals begin.
    pub frame: usize,
    /// How many sums over rows of data we are in.
    pub sums: usize,
    /// Columns of data that are declared without a unit.
    pub columns: Vec<Column<'a>>,
    /// The functions we are in.
    pub calls: Vec<Call<'a>>,
    /// Results of functions, by function, arguments and whether their gaps are asked for, with
    /// these.
    pub applied: HashMap<(Span, Vec<Value>, bool), (Value, Value)>,
    /// What is 0 where something within a `blend` has a knot or a kink; none outside of one.
    pub gaps: Option<Value>,
    /// How deep we are.
    pub depth: usize,
    /// What switches, for the width of smoothing.
    pub switches: Vec<Part>,
    /// The names of each phase.
    pub phases: HashMap<&'a str, Scope<'a>>,
    /// By what each plain number is multiplied.
    pub readings: Readings,
    /// Plain numbers in sums with something else.
    pub terms: HashSet<Span>,
    /// Plain numbers that may be refused.
    pub bare: Vec<Bare<'a>>,
    /// What must hold.
    pub requirements: Vec<Requirement<'a>>,
    /// What is known to be wrong.
    pub wrong: HashSet<Span>,
    /// The names whose unit is that of their uses.
    pub suspects: HashSet<Span>,
    /// Whether this walk is to find out what the surroundings of the wrong texts need.
    pub listening: bool,
    /// The unknowns that stand for them then.
    pub freed: HashMap<Span, u32>,
}

impl<'a> Inference<'a> {
    /// Nothing known but what is wrong.
    pub fn new(wrong: HashSet<Span>, suspects: HashSet<Span>, listening: bool) -> Self {
        Inference {
            scope: Scope::default(),
            circular: Vec::new(),
            values: HashMap::new(),
            unknowns: 0,
            numbers: Vec::new(),
            locals: Vec::new(),
            frame: 0,
            sums: 0,
            columns: Vec::new(),
            calls: Vec::new(),
            applied: HashMap::new(),
            gaps: None,
            depth: 0,
            switches: Vec::new(),
            phases: HashMap::new(),
            readings: Readings::new(),
            terms: HashSet::new(),
            bare: Vec::new(),
            requirements: Vec::new(),
            wrong,
            suspects,
            listening,
            freed: HashMap::new(),
        }
    }

    /// A unit that is to be found.
    pub fn unknown(&mut self) -> Part {
        self.unknowns += 1;
        Part::of(Dimension::atom(Atom::Unknown(self.unknowns as u32 - 1)))
    }

    /// What stands for a text that was found wrong: it goes with everything.
    pub fn free(&mut self, site: Span) -> Part {
        if !self.listening {
            return Part::ANY;
        }
        self.freed.insert(site, self.unknowns as u32);
        self.unknown()
    }

    /// The unit of a name that is given as a plain number.
    pub fn number(&mut self, name: &'a Ident, item: &'a Item) -> Part {
        self.numbers.push(PlainNumber { declared: Some((name, item)), place: None });
        let atom = Atom::Number(self.numbers.len() as u32 - 1);
        Part { plain: true, ..Part::of(Dimension::atom(atom)) }
    }

    /// A curve such as `t/T` may be guessed for a length: it goes up to 1 in the unit of what is
    /// guessed.
    pub fn stretched(&mut self, curve: &[Part], subject: &[Part]) -> Value {
        pairwise(curve, subject, |curve, subject| {
            self.numbers.push(PlainNumber { declared: None, place: subject.dimension.clone() });
            let atom = Atom::Number(self.numbers.len() as u32 - 1);
            let dimension =
                curve.dimension.as_ref().and_then(|it| it.times(&Dimension::atom(atom)));
            Part { dimension, ..curve.clone() }
        })
    }

    /// An expression with its text.
    pub fn operand(&mut self, expr: &'a Expr) -> Operand<'a> {
        (self.evaluate(expr), side(expr))
    }

    /// Both must have one unit; what they have then.
    pub fn equal(&mut self, reason: Reason<'a>, left: &Operand<'a>, right: &Operand<'a>) -> Value {
        let site = left.1.span.to(right.1.span);
        pairwise(&left.0, &right.0, |a, b| {
            self.equal_parts(reason, site, (a, &left.1), (b, &right.1))
        })
    }

    /// The same, but a plain number takes the unit of the other side, and a name that is one keeps
    /// it.
    pub fn compare(&mut self, reason: Reason<'a>, left: &Operand<'a>, right: &Operand<'a>) {
        self.equate(reason, left, right);
        self.read(left, right);
        self.read(right, left);
        self.read_sum(left, right);
        self.read_sum(right, left);
    }

    /// Both sides measure the same.
    pub fn equate(&mut self, reason: Reason<'a>, left: &Operand<'a>, right: &Operand<'a>) {
        let site = left.1.span.to(right.1.span);
        pairwise(&left.0, &right.0, |a, b| {
            if a.plain || b.plain {
                self.place(a, b);
                self.place(b, a);
            } else {
                self.equal_parts(reason, site, (a, &left.1), (b, &right.1));
            }
            Part::ANY
        });
    }

    /// Where the other side is not in SI, the number is only multiplied: it is not that quantity
    /// elsewhere.
    fn place(&mut self, number: &Part, other: &Part) {
        if let (Some(at), Some(dimension), false) =
            (number.as_number(), &other.dimension, other.plain || !other.declared.is_si())
        {
            self.numbers[at as usize].place.get_or_insert_with(|| dimension.clone());
        }
    }

    fn equal_parts(
        &mut self,
        reason: Reason<'a>,
        site: Span,
        left: (&Part, &Side<'a>),
        right: (&Part, &Side<'a>),
    ) -> Part {
        let plain = left.0.plain && right.0.plain;
        if !matches!(reason, Reason::Uses(_)) {
            self.read_term(left, right);
        }
        let called = left.0.called.clone().or_else(|| right.0.called.clone());
        let declared = left.0.sum_with(right.0);
        let sum = Part { plain, declared, called, ..left.0.clone() };
        match (&left.0.dimension, &right.0.dimension) {
            _ if self.wrong.contains(&site) => self.free(site).called_as(&sum),
            (Some(a), Some(b)) if a == b => sum,
            // Names for numbers keep what their place may make of them.
            (Some(a), Some(b)) if plain => {
                Part { dimension: Some(if a.is_none() { b.clone() } else { a.clone() }), ..sum }
            }
            (Some(_), Some(_)) => {
                self.require(reason, site, described(left), described(right));
                sum
            }
            (a, b) => Part { dimension: a.clone().or_else(|| b.clone()), ..sum },
        }
    }

    /// Something that must have no unit; whether it is not known to have one.
    pub fn need_none(&mut self, reason: Reason<'a>, site: Span, operand: &Operand<'a>) -> bool {
        for part in &operand.0 {
            if !part.plain && part.dimension.as_ref().is_some_and(|it| !it.is_none()) {
                if self.wrong.contains(&site) {
                    return false;
                }
                let right = Side { plain: true, ..named(site) };
                self.require(reason, site, described((part, &operand.1)), right);
            }
        }
        true
    }

    fn require(&mut self, reason: Reason<'a>, site: Span, left: Side<'a>, right: Side<'a>) {
        let calls = self.calls.clone();
        self.requirements.push(Requirement { reason, site, left, right, calls });
    }
}

/// An expression as a side; what it measures is filled in where it is compared.
pub(crate) fn side(expr: &Expr) -> Side<'_> {
    Side { expr: Some(expr), ..named(expr.span) }
}

/// A declared name as a side.
pub(crate) fn named<'a>(span: Span) -> Side<'a> {
    Side { span, expr: None, dimension: Dimension::none(), plain: false, declared: Declared::SI }
}

fn described<'a>((part, side): (&Part, &Side<'a>)) -> Side<'a> {
    Side {
        dimension: part.dimension.clone().unwrap_or_default(),
        plain: part.plain,
        declared: part.declared.clone(),
        ..side.clone()
    }
}
