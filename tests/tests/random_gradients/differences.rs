//! Derivatives against central differences with Richardson's extrapolation, `(4 D(h) - D(2 h))/3`.

use super::family::Case;
use fdcc_runtime::sensitivity::{Quantity, Sensitivity, gradient, hessian, perturbed};
use fdcc_runtime::simulate::{
    Controls, EventKind, Mode, Options, Simulation, Status, System, simulate,
};
use fdcc_tests::random::Random;

const AGREEMENT: f64 = 1e-10;

/// The step of differences.
const STEP: f64 = 5e-5;

/// How much differences may be off, relative to `1 + |derivative|`.
const TOLERANCE: f64 = 1e-6;

/// Differences that change by more than this, relative, with the step say nothing.
const UNSETTLED: f64 = 1e-2;

/// So many quantities for each system.
const QUANTITIES: usize = 4;

/// What the systems had in them, and what became of them.
#[derive(Default, Debug)]
pub struct Seen {
    pub differentiated: usize,
    /// Without trajectory to the end.
    pub stopped: usize,
    /// Without derivative.
    pub troubled: usize,
    /// Derivatives of the first and second order, and how many of them could not be compared.
    pub compared: usize,
    pub skipped: usize,
    pub events: usize,
    pub jumps: usize,
    pub held_together: usize,
}

fn options() -> Options {
    Options { rtol: 1e-12, atol: Some(1e-13), max_steps: 20_000, ..Options::default() }
}

fn quantity(Case { system, controls }: &Case, random: &mut Random) -> Quantity {
    match random.below(8) {
        0 => Quantity::Start(random.below(system.layout.x - 1)),
        1 => Quantity::Control { row: random.below(controls.rows().len()), control: 0 },
        _ => {
            let is_width = |at: usize| system.parameters[at].name.starts_with("sigma(");
            let written = (0..system.layout.p).filter(|&at| !is_width(at)).collect::<Vec<_>>();
            Quantity::Parameter(written[random.below(written.len())])
        }
    }
}

/// Different ones.
fn quantities(case: &Case, random: &mut Random) -> Vec<Quantity> {
    let mut chosen = Vec::new();
    while chosen.len() < QUANTITIES {
        let next = quantity(case, random);
        if !chosen.contains(&next) {
            chosen.push(next);
        }
    }
    chosen
}

/// Everything about one system.
pub fn check(case: &Case, random: &mut Random, seen: &mut Seen) {
    let quantities = quantities(case, random);
    let Ok(found) = gradient(&case.system, &case.controls, &options(), &quantities) else {
        seen.stopped += 1;
        return;
    };
    let says = || {
        format!(
            "{:?}\n{:?}\n{quantities:?}\n{found:#?}",
            case.system.parameter_values(),
            case.controls
        )
    };
    assert!(
        found.agreement <= AGREEMENT,
        "forward is not adjoint: {}\n{}",
        found.agreement,
        says()
    );
    seen.note(&found.simulation);
    if !found.nondifferentiabilities.is_empty() {
        seen.troubled += 1;
        return;
    }
    let check = Check { case, quantities: &quantities, found: &found };
    let second = random.below(3) == 0;
    let wrong = check
        .first_order(seen)
        .and_then(|()| if second { check.second_order(seen) } else { Ok(()) });
    if let Err(wrong) = wrong {
        panic!(
            "{wrong}\n{:?}\n{}",
            found.simulation.events,
            case.system
                .parameters
                .iter()
                .map(|it| format!("param {} = {}\n", it.name, it.value))
                .collect::<String>()
        );
    }
}

impl Seen {
    fn note(&mut self, simulation: &Simulation) {
        self.differentiated += 1;
        self.events += simulation.events.len();
        self.jumps +=
            simulation.events.iter().filter(|it| matches!(it.kind, EventKind::Jump(_))).count();
        let tape = simulation.tape.as_ref().expect("it was asked for");
        let held = tape
            .regimes
            .iter()
            .map(|it| it.modes.iter().filter(|mode| **mode == Mode::Sliding).count());
        self.held_together += usize::from(held.max().unwrap_or(0) > 1);
    }
}

struct Check<'c> {
    case: &'c Case,
    quantities: &'c [Quantity],
    found: &'c Sensitivity,
}

/// Values at `-2 h, -h, h, 2 h`.
fn around<T>(mut at: impl FnMut(f64) -> Option<T>) -> Option<[T; 4]> {
    Some([at(-2.0 * STEP)?, at(-STEP)?, at(STEP)?, at(2.0 * STEP)?])
}

/// The derivative and how much it depends on the step.
fn extrapolated([far_below, below, above, far_above]: [f64; 4]) -> (f64, f64) {
    let (near, far) = ((above - below) / (2.0 * STEP), (far_above - far_below) / (4.0 * STEP));
    ((4.0 * near - far) / 3.0, (near - far).abs())
}

impl Check<'_> {
    fn moved(&self, quantity: &Quantity, by: f64) -> (System, Controls) {
        perturbed(&self.case.system, &self.case.controls, quantity, by)
    }

    fn compare(
        &self,
        name: &str,
        got: f64,
        values: [f64; 4],
        seen: &mut Seen,
    ) -> Result<(), String> {
        let (expected, change) = extrapolated(values);
        seen.compared += 1;
        if change > UNSETTLED * (1.0 + expected.abs()) {
            seen.skipped += 1;
            return Ok(());
        }
        let is_near = (got - expected).abs() <= TOLERANCE * (1.0 + expected.abs()) + 0.1 * change;
        if is_near { Ok(()) } else { Err(format!("{name} is {got}, not {expected} (+- {change})")) }
    }

    fn first_order(&self, seen: &mut Seen) -> Result<(), String> {
        for (quantity, got) in self.quantities.iter().zip(&self.found.adjoint) {
            let sides = around(|by| {
                let (system, controls) = self.moved(quantity, by);
                let simulation = simulate(&system, &controls, &options());
                matches!(simulation.status, Status::Completed).then_some(simulation)
            });
            match sides.filter(|sides| self.has_same_events(sides.each_ref())) {
                Some(sides) => {
                    let values = sides.map(|it| it.objective.expect("it has reached the end"));
                    self.compare(&format!("{quantity:?}"), *got, values, seen)?;
                }
                None => {
                    seen.compared += 1;
                    seen.skipped += 1;
                }
            }
        }
        Ok(())
    }

    /// One row of the Hessian.
    fn second_order(&self, seen: &mut Seen) -> Result<(), String> {
        let Case { system, controls } = self.case;
        let matrix = hessian(system, controls, &self.found.simulation, self.quantities);
        let sides = around(|by| {
            let (system, controls) = self.moved(&self.quantities[0], by);
            gradient(&system, &controls, &options(), self.quantities).ok()
        });
        let has_same_events = |sides: &[Sensitivity; 4]| {
            self.has_same_events(sides.each_ref().map(|it| &it.simulation))
        };
        let starts_sliding =
            self.found.simulation.events.iter().any(|it| it.kind == EventKind::StartsSliding);
        let Some((sides, matrix)) =
            sides.filter(has_same_events).filter(|_| !starts_sliding).zip(matrix)
        else {
            seen.compared += 1;
            seen.skipped += 1;
            return Ok(());
        };
        for (at, quantity) in self.quantities.iter().enumerate() {
            let values = sides.each_ref().map(|it| it.adjoint[at]);
            let name = format!("{:?} {quantity:?}", self.quantities[0]);
            self.compare(&name, matrix[0][at], values, seen)?;
        }
        Ok(())
    }

    /// Whether all have the events of the trajectory itself.
    fn has_same_events(&self, sides: [&Simulation; 4]) -> bool {
        let kinds =
            |it: &Simulation| it.events.iter().map(|it| (it.surface, it.kind)).collect::<Vec<_>>();
        let own = kinds(&self.found.simulation);
        sides.iter().all(|it| kinds(it) == own)
    }
}
