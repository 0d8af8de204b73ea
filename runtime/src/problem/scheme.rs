//! **The tables** of schemes: a row is the name, the order, the nodes and the constructor of one.

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

/// A scheme without stages of its own: name, scheme, order, and for each evaluation of the right
/// side its weight `b`, its time `c` and the blend `w` of old and new state
/// ([`transcribe`](crate::transcribe)).
type OneStep = (&'static str, Scheme, usize, &'static [[f64; 3]]);

const ONE_STEP: [OneStep; 5] = [
    ("euler", Scheme::Euler, 1, &[[1.0, 0.0, 0.0]]),
    ("implicit_euler", Scheme::ImplicitEuler, 1, &[[1.0, 1.0, 1.0]]),
    ("midpoint", Scheme::Midpoint, 2, &[[1.0, 0.5, 0.5]]),
    ("trapezoid", Scheme::Trapezoid, 2, &[[0.5, 0.0, 0.0], [0.5, 1.0, 1.0]]),
    ("rk4", Scheme::RungeKutta4, 4, &[[1.0, 0.0, 0.0]]),
];

/// A family of collocation schemes: the name before the number of stages, the constructor, and the
/// order with so many stages. Their nodes are in `transcribe/collocation.rs`.
type Family = (&'static str, fn(usize) -> Scheme, fn(usize) -> usize);

const COLLOCATION: [Family; 2] = [
    ("radau", Scheme::Radau, |stages| 2 * stages - 1),
    ("gauss", Scheme::Gauss, |stages| 2 * stages),
];

impl Scheme {
    /// The scheme of this name, such as `midpoint` or `radau3`; a family by itself has one stage.
    pub fn named(name: &str) -> Option<Self> {
        let one_step = ONE_STEP.iter().find(|row| row.0 == name).map(|row| row.1);
        one_step.or_else(|| {
            COLLOCATION.iter().find_map(|(family, scheme, _)| match name.strip_prefix(family)? {
                "" => Some(scheme(1)),
                number => {
                    let stages = number.parse().ok()?;
                    (1..=MOST_STAGES).contains(&stages).then(|| scheme(stages))
                }
            })
        })
    }

    /// Whether this is the name of a family, whose number of stages is open.
    pub fn is_family(name: &str) -> bool {
        COLLOCATION.iter().any(|row| row.0 == name)
    }

    /// The name, such as `radau3`.
    pub fn name(self) -> String {
        match (self.family(), self.one_step()) {
            (Some(family), _) => format!("{}{}", family.0, self.stages()),
            (_, row) => row.map(|row| row.0).unwrap_or_default().to_owned(),
        }
    }

    /// The power of the step length with which the error falls, where everything is smooth.
    pub fn order(self) -> usize {
        match (self.family(), self.one_step()) {
            (Some(family), _) => family.2(self.stages()),
            (_, row) => row.map_or(1, |row| row.2),
        }
    }

    /// Weight, time and blend of each evaluation of the right side; none of a collocation scheme.
    pub(crate) fn evaluations(self) -> &'static [[f64; 3]] {
        self.one_step().map_or(&[], |row| row.3)
    }

    fn one_step(self) -> Option<&'static OneStep> {
        ONE_STEP.iter().find(|row| row.1 == self)
    }

    fn family(self) -> Option<&'static Family> {
        COLLOCATION.iter().find(|row| row.1(self.stages()) == self)
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
        self.family().map_or(self, |row| row.1(stages))
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
