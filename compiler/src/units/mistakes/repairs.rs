//! The most likely repair of a mistake with units.

use super::messages::{Speaker, unit_of};
use super::{Culprit, Mistake};
use crate::syntax::{scope, text, walk};
use crate::units::dimension::Dimension;
use crate::units::dimension::notation;
use crate::units::dimension::ratio::Ratio;
use crate::units::dimension::table;
use crate::units::inference::requirement::{Reason, Side};
use fdcc_grammar::ast::{BinaryOperator, Expr, ExprKind, ItemKind};
use fdcc_grammar::{Fix, Span};

/// A mistake and all that its repair may look at.
pub(crate) struct Repairs<'s, 'a> {
    /// Tree and notation.
    pub speaker: &'s Speaker<'a>,
    /// What is wrong.
    pub mistake: &'s Mistake<'a>,
    /// Whether the surroundings need of the wrong text what its argument is.
    pub wanted: bool,
}

/// A name that was given as a plain number, and the unit that would make both sides equal.
pub(crate) struct Blame<'a> {
    /// 0 for the left side, 1 for the right.
    pub side: usize,
    /// The name.
    pub culprit: Culprit<'a>,
    needed: Dimension,
}

impl<'a> Repairs<'_, 'a> {
    /// The name whose unit is most likely missing: one that would then have a meaning, on the right
    /// if on both sides.
    pub fn blame(&self) -> Option<Blame<'a>> {
        let of = |side: usize| {
            let culprit = *self.mistake.culprits[side].first()?;
            let (own, other) = self.sides(side);
            let needed = other.dimension.over(&own.dimension)?;
            Some(Blame { side, culprit, needed: needed.power(Ratio::ONE.over(culprit.power)?)? })
        };
        let all: Vec<Blame<'a>> = [1, 0].into_iter().filter_map(of).collect();
        let best = all.iter().position(|it| notation::noun(&it.needed).is_some()).unwrap_or(0);
        all.into_iter().nth(best)
    }

    /// A side and the other one.
    fn sides(&self, side: usize) -> (&Side<'a>, &Side<'a>) {
        let it = &self.mistake.requirement;
        if side == 0 { (&it.left, &it.right) } else { (&it.right, &it.left) }
    }

    pub fn help(&self, blame: Option<Blame<'a>>) -> Option<String> {
        if let Some(help) = blame.and_then(|blame| self.unit_for_a_name(&blame)) {
            return Some(help);
        }
        match self.mistake.requirement.reason {
            Reason::NoUnit(_) => Some(self.scaled_argument()),
            Reason::Plain(_) => Some("give it a number without a unit".into()),
            Reason::Exponent => {
                Some(format!("an exponent has no unit: divide it by {}", self.scale().0))
            }
            Reason::FixedPower => Some(format!(
                "the unit of the power would change with the exponent: write the exponent as a \
                 number or a `const`, or divide the base by {}",
                self.scale().0
            )),
            _ => self
                .other_unit()
                .map(|(_, text)| format!("its uses would fit `{text}`"))
                .or_else(|| self.unit_for_a_number())
                .or_else(|| self.known_factor())
                .or_else(|| self.missing_factor()),
        }
    }

    /// A change of the text: the unit behind the declaration, or behind the number.
    pub fn fix(&self, blame: Option<&Blame<'a>>) -> Option<Fix> {
        match blame {
            Some(blame) => {
                let (name, unit) = (blame.culprit.name, self.unit_of(blame));
                let title = format!("give `{}` the unit `[{unit}]`", name.name);
                let at = unit_place(&blame.culprit)?;
                Some(Fix::likely(title).insert(at, format!(" [{unit}]")))
            }
            None if self.other_unit().is_some() => {
                let (span, text) = self.other_unit()?;
                Some(Fix::likely(format!("change the unit: `{text}`")).replace(span, text))
            }
            None => {
                let (number, unit) = self.bare_number()?;
                let end = number.expr.filter(|it| matches!(it.kind, ExprKind::Number(_)))?.span.end;
                Some(Fix::likely("give the number its unit").insert(end, format!(" [{unit}]")))
            }
        }
    }

    /// The unit that would make both sides equal.
    fn unit_of(&self, blame: &Blame<'a>) -> String {
        let (own, other) = self.sides(blame.side);
        let notation = &self.speaker.notation;
        if own.plain && blame.culprit.power == Ratio::ONE {
            self.unit_beside(other)
        } else if blame.culprit.power == Ratio::ONE {
            notation.quotient(&other.dimension, &own.dimension)
        } else if blame.culprit.power == Ratio::whole(-1) {
            notation.quotient(&own.dimension, &other.dimension)
        } else {
            notation.unit(&blame.needed)
        }
    }

    /// The unit in which the names of a side are declared, if it has one, or that of SI.
    fn unit_beside(&self, side: &Side<'a>) -> String {
        let declared = side.declared.text(&side.dimension);
        declared.unwrap_or_else(|| self.speaker.notation.unit(&side.dimension))
    }

    /// The declaration of a name with that unit.
    fn unit_for_a_name(&self, blame: &Blame<'a>) -> Option<String> {
        let unit = self.unit_of(blame);
        let declaration = with_unit(&blame.culprit, &unit)?;
        Some(match notation::noun(&blame.needed) {
            Some(noun) => format!("{noun} would be `{declaration}`"),
            None => format!("`{}` needs a unit: `{declaration}`", blame.culprit.name.name),
        })
    }

    /// The defined number with the unit that its uses need.
    fn other_unit(&self) -> Option<(Span, String)> {
        let it = &self.mistake.requirement;
        let value = it.right.expr.filter(|_| matches!(it.reason, Reason::Uses(_)))?;
        let ExprKind::Quantity(number, _) = &value.kind else { return None };
        let unit = self.speaker.notation.unit(&it.left.dimension);
        Some((value.span, format!("{} [{unit}]", text::number(*number))))
    }

    /// A plain number beside something with a unit, and that unit.
    fn bare_number(&self) -> Option<(&Side<'a>, String)> {
        let it = &self.mistake.requirement;
        let is_number = |side: &Side<'a>| side.plain && side.dimension.is_none();
        let (number, other) = match (is_number(&it.left), is_number(&it.right)) {
            (true, _) => (&it.left, &it.right),
            (_, true) => (&it.right, &it.left),
            _ => return None,
        };
        Some((number, self.unit_beside(other)))
    }

    /// `1 [m]`
    fn unit_for_a_number(&self) -> Option<String> {
        let (number, unit) = self.bare_number()?;
        match &number.expr?.kind {
            ExprKind::Number(value) => {
                Some(format!("give the number its unit: `{} [{unit}]`", text::number(*value)))
            }
            _ => Some(format!("a factor such as `1 [{unit}]` gives it the unit")),
        }
    }

    /// A parameter or constant that makes up for the difference, such as a forgotten mass.
    fn known_factor(&self) -> Option<String> {
        let it = &self.mistake.requirement;
        if !matches!(it.reason, Reason::Equation(_) | Reason::Sum(_)) {
            return None;
        }
        let right = text::expr(it.right.expr?);
        let noun = self.speaker.notation.noun(&it.left.dimension);
        let excess = it.right.dimension.over(&it.left.dimension)?;
        let lack = it.left.dimension.over(&it.right.dimension)?;
        if let Some(name) = self.name_of(&excess) {
            return Some(match it.reason {
                Reason::Equation(state) => {
                    format!(
                        "divide the right side by `{name}`, or write `{name} * {}' ...`",
                        state.name
                    )
                }
                _ => format!("`{right}` divided by `{name}` would be {noun}"),
            });
        }
        self.name_of(&lack).map(|name| format!("`{right}` times `{name}` would be {noun}"))
    }

    fn name_of(&self, dimension: &Dimension) -> Option<&'a str> {
        let fits = |item: &&fdcc_grammar::ast::Item| {
            matches!(item.kind, ItemKind::Param { .. } | ItemKind::Const { .. })
                && unit_of(item).and_then(table::dimension).is_some_and(|it| it == *dimension)
        };
        let item = self.speaker.tree.items.iter().find(fits)?;
        scope::declared(item).map(|name| name.name.as_str())
    }

    fn missing_factor(&self) -> Option<String> {
        let it = &self.mistake.requirement;
        if it.left.span == it.right.span {
            return Some(
                "divide each part by a scale of its own, so that all have the same unit".into(),
            );
        }
        let unit = self.speaker.notation.quotient(&it.left.dimension, &it.right.dimension);
        let right = it.right.expr?;
        let needed = format!("`{}` would need a factor in `[{unit}]`", text::expr(right));
        Some(match &walk::spine(right).0.kind {
            ExprKind::Number(value) => {
                format!("{needed}; the number may carry it: `{} [{unit}]`", text::number(*value))
            }
            _ => needed,
        })
    }

    /// `sin(x / L)` with a length `L`.
    fn scaled_argument(&self) -> String {
        let it = &self.mistake.requirement;
        let (scale, name, unit) = self.scale();
        let Some(call) = it.left.expr.map(|argument| self.divided(argument, &name)) else {
            return format!("divide by {scale}");
        };
        let inside = it.calls.last().filter(|call| call.body.span == it.site);
        let call = match inside {
            Some(inside) => {
                let arguments: Vec<&str> =
                    inside.arguments.iter().map(|it| it.name.as_str()).collect();
                let factor = if self.wanted { format!("{name} * ") } else { String::new() };
                format!("fn {}({}) = {factor}{call}", inside.name.name, arguments.join(", "))
            }
            None => call,
        };
        format!("divide by {scale}: `{call}` with `const {name} = 1 [{unit}]`")
    }

    fn divided(&self, argument: &Expr, name: &str) -> String {
        let Reason::NoUnit(function) = self.mistake.requirement.reason else {
            return String::new();
        };
        let inner = text::expr(argument);
        match &argument.kind {
            ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, ..) => {
                format!("{function}(({inner}) / {name})")
            }
            _ => format!("{function}({inner} / {name})"),
        }
    }

    /// What to divide by: in words, as a name that is not taken, and its unit.
    fn scale(&self) -> (String, String, String) {
        let dimension = &self.mistake.requirement.left.dimension;
        let unit = self.speaker.notation.unit(dimension);
        let Some(noun) = notation::noun(dimension) else {
            return (format!("a scale in `[{unit}]`"), self.unused("scale"), unit);
        };
        let name = match noun {
            "a length" => "L",
            "a time" => "tau",
            "a mass" => "M",
            "a speed" => "V",
            _ => "scale",
        };
        (format!("{noun} scale"), self.unused(name), unit)
    }

    fn unused(&self, name: &str) -> String {
        let is_taken =
            self.speaker.tree.items.iter().filter_map(scope::declared).any(|it| it.name == name);
        if is_taken { format!("{name}_0") } else { name.into() }
    }
}

/// Where the unit of a plain number would stand: behind its value, or behind the name of a `let` or
/// a `signal`.
fn unit_place(culprit: &Culprit<'_>) -> Option<u32> {
    match &culprit.item.kind {
        ItemKind::Param { value: Some(value), .. } | ItemKind::Const { value, .. } => {
            Some(value.span.end)
        }
        ItemKind::Let { .. } | ItemKind::Signal { .. } => Some(culprit.name.span.end),
        ItemKind::Free { bounds: Some(bounds), .. } => Some(bounds.span.end),
        _ => None,
    }
}

/// The declaration of a plain number with a unit.
fn with_unit(culprit: &Culprit<'_>, unit: &str) -> Option<String> {
    let name = &culprit.name.name;
    let text = match &culprit.item.kind {
        ItemKind::Param { value: Some(value), .. } => {
            format!("param {name} = {}", text::expr(value))
        }
        ItemKind::Const { value, .. } => format!("const {name} = {}", text::expr(value)),
        ItemKind::Let { value, .. } => {
            return Some(format!("let {name} [{unit}] = {}", text::expr(value)));
        }
        ItemKind::Signal { value, .. } => {
            return Some(format!("signal {name} [{unit}] = {}", text::expr(value)));
        }
        ItemKind::Free { bounds: Some(it), .. } => {
            format!("free {name} in [{}, {}]", text::expr(&it.lower), text::expr(&it.upper))
        }
        ItemKind::Free { .. } => format!("free {name}"),
        _ => return None,
    };
    Some(format!("{text} [{unit}]"))
}
