//! What expectations ask of the true system: for how long a surface is held, and exact derivatives,
//! along the replay of a solution.

use crate::error::Error;
use crate::gradient::exact::Exact;
use crate::gradient::quantities::is_computed;
use crate::replay::Replay;
use crate::solve::Solution;
use crate::verification::Verification;
use crate::verification::modes::held;
use fdcc_compiler::graph::ExprId;
use fdcc_compiler::model::{Simulated, Symbol};
use fdcc_runtime::sensitivity::Quantity;
use fdcc_runtime::simulate::Options;

/// The answers, each a number or the reason why there is none.
pub(super) struct Replayed(Vec<Result<f64, String>>);

impl Replayed {
    /// Asks the true system; nothing is simulated if nothing is asked.
    pub fn new(solution: &Solution, asked: &[Simulated]) -> Self {
        if asked.is_empty() {
            return Replayed(Vec::new());
        }
        let verified = solution.verify().map_err(|error| error.to_string()).and_then(whole);
        let answer = |asked: &Simulated| match (&verified, *asked) {
            (Err(why), _) => Err(why.clone()),
            (Ok(verified), Simulated::Sliding(surface)) => Ok(held(&verified.stays[surface])),
            (Ok(_), Simulated::Sensitivity { of, by }) => sensitivity(solution, of, by),
        };
        Replayed(asked.iter().map(answer).collect())
    }

    /// All answers; what has none is not a number.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|answer| *answer.as_ref().unwrap_or(&f64::NAN))
    }

    /// Why there is no answer.
    pub fn why_not(&self, asked: usize) -> Option<String> {
        self.0[asked].as_ref().err().cloned()
    }
}

fn whole(verified: Verification) -> Result<Verification, String> {
    let end = verified.simulation.end_time;
    if verified.is_whole {
        Ok(verified)
    } else {
        Err(format!("the replay on the true system ends at t = {end}"))
    }
}

/// The derivative of a number along the replay.
fn sensitivity(solution: &Solution, of: ExprId, by: Symbol) -> Result<f64, String> {
    let mut model = solution.model().meaning().with_objective(of);
    let replay = Replay::new(&solution.record(), &model)?;
    replay.adapt(&mut model);
    let compiled = fdcc_compiler::compile_sensitivities(&model);
    let system = compiled.map_err(|diagnostics| Error::Model(diagnostics).to_string())?;
    let quantity = match by {
        Symbol::Param(at) if is_computed(&model.params[at].place.name, &model) => {
            return Err(format!(
                "`{}` is computed from other parameters",
                model.params[at].place.name
            ));
        }
        Symbol::Param(at) => Quantity::Parameter(at),
        Symbol::Free(at) => Quantity::Parameter(model.params.len() + at),
        Symbol::AtStart(at) => Quantity::Start(at),
        other => unreachable!("the compiler lets no sensitivity by {other:?} through"),
    };
    let exact = Exact::new(&system, &replay.controls, &Options::default(), &[quantity]);
    let exact =
        exact.map_err(|it| format!("the replay on the true system ends at t = {}", it.end_time))?;
    if exact.is_trusted() {
        Ok(exact.gradient[0])
    } else {
        Err("there is no derivative that can be trusted".into())
    }
}
