//! **The tables** of schemes: a row is the name, the order, the nodes, the constructor and the text
//! of one.

use super::ControlShape;

/// The most stages of a collocation scheme.
pub const MOST_STAGES: usize = 5;

/// How the differential equation becomes algebraic equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Explicit Euler.
    Euler,
    /// Implicit Euler; states named in [`Method::lagged`](super::Method::lagged) are taken at the
    /// old time.
    ImplicitEuler,
    /// Implicit midpoint rule.
    Midpoint,
    /// Trapezoidal rule with a constant control on each interval.
    Trapezoid,
    /// The classical Runge-Kutta scheme; [`Problem::dynamics`](super::Problem::dynamics) has its
    /// increment, of which it is an explicit Euler step.
    RungeKutta4,
    /// Radau IIA collocation with so many stages, 1 to 5.
    Radau(usize),
    /// Gauss collocation with so many stages, 1 to 5.
    Gauss(usize),
}

/// A scheme without stages of its own.
struct OneStep {
    name: &'static str,
    scheme: Scheme,
    order: usize,
    /// For each evaluation of the right side its weight `b`, its time `c` and the blend `w` of old
    /// and new state ([`transcribe`](crate::transcribe)).
    evaluations: &'static [[f64; 3]],
    /// What editors say of it.
    doc: &'static str,
}

const ONE_STEP: [OneStep; 5] = [
    OneStep {
        name: "euler",
        scheme: Scheme::Euler,
        order: 1,
        evaluations: &[[1.0, 0.0, 0.0]],
        doc: "`x1 = x0 + h f(x0)`, order 1. Oscillates where a step is longer than the smoothed \
              layer.",
    },
    OneStep {
        name: "implicit_euler",
        scheme: Scheme::ImplicitEuler,
        order: 1,
        evaluations: &[[1.0, 1.0, 1.0]],
        doc: "`x1 = x0 + h f(x1)`, order 1. Never oscillates; `lagged (th)` takes the named states \
              at the old time.",
    },
    OneStep {
        name: "midpoint",
        scheme: Scheme::Midpoint,
        order: 2,
        evaluations: &[[1.0, 0.5, 0.5]],
        doc: "`x1 = x0 + h f((x0 + x1)/2)`, order 2.",
    },
    OneStep {
        name: "trapezoid",
        scheme: Scheme::Trapezoid,
        order: 2,
        evaluations: &[[0.5, 0.0, 0.0], [0.5, 1.0, 1.0]],
        doc: "`x1 = x0 + h (f(x0) + f(x1))/2`, order 2.",
    },
    OneStep {
        name: "rk4",
        scheme: Scheme::RungeKutta4,
        order: 4,
        evaluations: &[[1.0, 0.0, 0.0]],
        doc: "The classical Runge-Kutta scheme, order 4; its whole step is one compiled function, \
              so it costs no further unknowns.",
    },
];

/// Roots of the shifted Legendre polynomials `P_s(2c - 1)`, of order `2s`.
const GAUSS: [&[f64]; MOST_STAGES] = [
    &[0.5],
    &[0.211_324_865_405_187_1, 0.788_675_134_594_812_9],
    &[0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7],
    &[
        0.069_431_844_202_973_71,
        0.330_009_478_207_571_87,
        0.669_990_521_792_428_1,
        0.930_568_155_797_026_3,
    ],
    &[
        0.046_910_077_030_668_004,
        0.230_765_344_947_158_45,
        0.5,
        0.769_234_655_052_841_5,
        0.953_089_922_969_332,
    ],
];

/// Roots of `P_s(2c - 1) - P_{s-1}(2c - 1)`, of order `2s - 1`; the last is the end of the
/// interval.
pub(crate) const RADAU: [&[f64]; MOST_STAGES] = [
    &[1.0],
    &[1.0 / 3.0, 1.0],
    &[0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0],
    &[0.088_587_959_512_703_94, 0.409_466_864_440_734_7, 0.787_659_461_760_847, 1.0],
    &[
        0.057_104_196_114_517_68,
        0.276_843_013_638_123_8,
        0.583_590_432_368_916_8,
        0.860_240_135_656_219_5,
        1.0,
    ],
];

/// A family of collocation schemes.
struct Family {
    /// The name before the number of stages.
    name: &'static str,
    /// Whose nodes these are.
    author: &'static str,
    scheme: fn(usize) -> Scheme,
    order: fn(usize) -> usize,
    /// For each number of stages.
    nodes: [&'static [f64]; MOST_STAGES],
    /// What editors say of it where the number of stages is open.
    doc: &'static str,
}

const COLLOCATION: [Family; 2] = [
    Family {
        name: "radau",
        author: "Radau",
        scheme: Scheme::Radau,
        order: |stages| 2 * stages - 1,
        nodes: RADAU,
        doc: "Collocation of Radau, with `N = auto`: stages are added, up to 5, where that takes \
              fewer nodes than dividing intervals.",
    },
    Family {
        name: "gauss",
        author: "Gauss",
        scheme: Scheme::Gauss,
        order: |stages| 2 * stages,
        nodes: GAUSS,
        doc: "Collocation of Gauss, with `N = auto`: the number of stages is found like that of \
              `radau`.",
    },
];

impl Scheme {
    /// The scheme of this name, such as `midpoint` or `radau3`; a family by itself has one stage.
    pub fn named(name: &str) -> Option<Self> {
        let one_step = ONE_STEP.iter().find(|row| row.name == name).map(|row| row.scheme);
        one_step.or_else(|| {
            COLLOCATION.iter().find_map(|row| match name.strip_prefix(row.name)? {
                "" => Some((row.scheme)(1)),
                number => {
                    let stages = number.parse().ok()?;
                    (1..=MOST_STAGES).contains(&stages).then(|| (row.scheme)(stages))
                }
            })
        })
    }

    /// Whether this is the name of a family, whose number of stages is open.
    pub fn is_family(name: &str) -> bool {
        COLLOCATION.iter().any(|row| row.name == name)
    }

    /// All names, a family before its members: one list for each.
    pub fn names() -> impl Iterator<Item = Vec<String>> {
        let members = |row: &Family| (1..=MOST_STAGES).map(|it| (row.scheme)(it).name()).collect();
        let one_step = ONE_STEP.iter().map(|row| vec![row.name.to_owned()]);
        let families = COLLOCATION.iter().map(move |row| [vec![row.name.to_owned()], members(row)]);
        one_step.chain(families.flatten())
    }

    /// What editors say of a name.
    pub fn doc(name: &str) -> Option<String> {
        if let Some(family) = COLLOCATION.iter().find(|row| row.name == name) {
            return Some(family.doc.into());
        }
        let scheme = Scheme::named(name)?;
        scheme.one_step().map(|row| row.doc.into()).or_else(|| {
            Some(format!(
                "Collocation of {} with {} stages, order {}. Each stage has its own states as \
                 unknowns; a few intervals give many digits where all is smooth.",
                scheme.family()?.author,
                scheme.stages(),
                scheme.order()
            ))
        })
    }

    /// The name, such as `radau3`.
    pub fn name(self) -> String {
        match (self.family(), self.one_step()) {
            (Some(family), _) => format!("{}{}", family.name, self.stages()),
            (_, row) => row.map(|row| row.name).unwrap_or_default().to_owned(),
        }
    }

    /// The power of the step length with which the error falls, where everything is smooth.
    pub fn order(self) -> usize {
        match (self.family(), self.one_step()) {
            (Some(family), _) => (family.order)(self.stages()),
            (_, row) => row.map_or(1, |row| row.order),
        }
    }

    /// Weight, time and blend of each evaluation of the right side; none of a collocation scheme.
    pub(crate) fn evaluations(self) -> &'static [[f64; 3]] {
        self.one_step().map_or(&[], |row| row.evaluations)
    }

    /// The nodes of a collocation scheme; none of the others.
    pub(crate) fn nodes(self) -> &'static [f64] {
        self.family().map_or(&[], |row| row.nodes[self.stages() - 1])
    }

    /// Whether the states of an interval are a polynomial with nodes.
    pub fn is_collocation(self) -> bool {
        self.family().is_some()
    }

    fn one_step(self) -> Option<&'static OneStep> {
        ONE_STEP.iter().find(|row| row.scheme == self)
    }

    fn family(self) -> Option<&'static Family> {
        COLLOCATION.iter().find(|row| (row.scheme)(self.stages()) == self)
    }

    /// Stages of a collocation scheme; 1 of the others, which have none of their own.
    pub fn stages(self) -> usize {
        match self {
            Scheme::Radau(stages) | Scheme::Gauss(stages) => stages,
            _ => 1,
        }
    }

    /// The collocation scheme of the same kind with so many stages.
    pub fn with_stages(self, stages: usize) -> Self {
        self.family().map_or(self, |row| (row.scheme)(stages))
    }

    /// Whether controls of this shape mean anything to the scheme: it must see enough points of an
    /// interval.
    pub fn allows(self, shape: ControlShape) -> bool {
        match shape {
            ControlShape::Constant => true,
            ControlShape::Linear => {
                self == Scheme::Trapezoid || self.family().is_some() && self.stages() > 1
            }
            ControlShape::Polynomial => self.family().is_some(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_schemes() {
        let names = ["euler", "implicit_euler", "midpoint", "trapezoid", "rk4", "radau1", "gauss5"];
        for name in names {
            assert_eq!(Scheme::named(name).map(Scheme::name).as_deref(), Some(name));
        }
        assert_eq!(Scheme::named("radau"), Some(Scheme::Radau(1)));
        assert!(["radau6", "gauss0", "oiler"].iter().all(|name| Scheme::named(name).is_none()));
        assert_eq!([Scheme::Radau(3).order(), Scheme::Gauss(2).order()], [5, 4]);
    }
}
