//! The true system of a model with phases: one phase after the other, as links hand over.

use crate::error::Error;
use crate::model::Model;
use crate::record::Record;
use crate::replay::Replay;
use crate::simulation::Simulation;
use fdcc_compiler::{Course, Ends};
use fdcc_runtime::simulate::{Controls, Options as Accuracy, System, controls_at};

/// Simulations of phases, in the order of the model.
///
/// ```
/// let text = "phase fall { time t in [0, 1]  state h start 5  state v start 0
///     dynamics { h' = v  v' = -9.81 } }
/// phase brake { time t in [1, 2]  state h  state v  dynamics { h' = v  v' = 5 } }
/// link fall -> brake { same }";
/// let model = fdcc::Model::from_text("drop", text)?;
/// let phases = model.simulate_phases(None, &fdcc::Accuracy::default())?;
/// let v = phases.all[1].state("v").expect("it is declared");
/// assert!(phases.is_complete() && (v[0] + 9.81).abs() < 1e-9);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct SimulationOfPhases {
    /// Each phase with its simulation; the last one is the first that does not reach its last time.
    pub all: Vec<Simulation>,
    /// The phases as they were simulated, with the states at which they begin.
    pub models: Vec<Model>,
    /// The sum of the objectives of all phases and links; nothing where one is unknown.
    pub objective: Option<f64>,
    count: usize,
}

impl SimulationOfPhases {
    /// Whether all phases reached their last times.
    pub fn is_complete(&self) -> bool {
        self.all.len() == self.count && self.all.iter().all(Simulation::is_complete)
    }
}

impl Model {
    /// The model with the parameters and unknowns of a solution. Other values may be given to it
    /// before [`simulate_phases`](Model::simulate_phases) takes the rest of the record, which is
    /// [`without_values`](Record::without_values).
    ///
    /// ```
    /// let text = "free k in [0, 5] guess 1
    /// phase a { time t in [0, 1]  state x start 1  dynamics { x' = -k }  end x == 0 }
    /// phase b { time t in [1, 2]  state x  dynamics { x' = k } }
    /// link a -> b { same }  minimize b.x(end)^2";
    /// let model = fdcc::Model::from_text("turn", text)?;
    /// let solution = model.solve(&fdcc::Options::default())?;
    /// let other = model.with_values_of(&solution.record()).driven_with(&[("k", 2.0.into())])?;
    /// let record = solution.record().without_values();
    /// let found = other.simulate_phases(Some(&record), &fdcc::Accuracy::default())?;
    /// assert!((found.all[0].result.end[0] + 1.0).abs() < 1e-9);
    /// # Ok::<(), fdcc::Error>(())
    /// ```
    #[must_use]
    pub fn with_values_of(&self, record: &Record) -> Model {
        let mut meaning = self.meaning().clone();
        let params = record.params.iter().map(|(name, value)| ((*name).to_owned(), *value));
        meaning.restore_params(&params.collect::<Vec<_>>());
        record.free.iter().for_each(|(name, value)| meaning.set_free(name, *value));
        self.with_meaning(meaning)
    }

    /// Simulates the phases of the true system one after the other, with guessed controls or those
    /// of a solution; an open state begins where a link puts it, else as in the solution, else as
    /// it is guessed. That one does not reach its last time is no error: its status says so.
    ///
    /// # Errors
    ///
    /// A model that cannot be simulated; a phase whose time runs backwards; a record that does not
    /// belong to it.
    pub fn simulate_phases(
        &self,
        record: Option<&Record>,
        accuracy: &Accuracy,
    ) -> Result<SimulationOfPhases, Error> {
        let mut whole = self.meaning().clone();
        for (name, value) in record.iter().flat_map(|it| &it.free) {
            whole.set_free(name, *value);
        }
        let mut course = Course::new(&whole).map_err(Error::Model)?;
        let count = whole.phases.len();
        let mut found = SimulationOfPhases { all: vec![], models: vec![], objective: None, count };
        for (at, phase) in whole.phases.iter().enumerate() {
            let (mut own, mut controls) = (course.phase(at), Controls::Guess);
            if let Some(record) = record.and_then(|it| of_phase(it, &phase.place.name)) {
                let replay = Replay::new(record, &own).map_err(Error::Record)?;
                replay.check().map_err(Error::Record)?;
                replay.adapt(&mut own);
                controls = replay.controls;
            }
            let model = self.with_meaning(own);
            let system = model.system()?;
            if let Some(wrong) = system.wrong_times() {
                return Err(Error::Call(format!("phase `{}`: {wrong}", phase.place.name)));
            }
            let simulation = Simulation::new(&model, system, &controls, accuracy);
            note(&mut course, at, &simulation, &controls);
            found.all.push(simulation);
            found.models.push(model);
            if !found.all[at].is_complete() {
                return Ok(found);
            }
        }
        let terms = found.all.iter().filter_map(|it| it.result.objective);
        let objective = terms.sum::<f64>() + course.objective_of_links();
        let of_phases = whole.phases.iter().any(|it| it.model.objective.is_some());
        let has_objective = of_phases || whole.links.iter().any(|it| it.objective.is_some());
        found.objective = Some(objective).filter(|it| has_objective && it.is_finite());
        Ok(found)
    }
}

fn of_phase<'r, 's>(record: &'r Record<'s>, name: &str) -> Option<&'r Record<'s>> {
    record.phases.iter().find(|it| it.model == name)
}

fn note(course: &mut Course, at: usize, simulation: &Simulation, controls: &Controls) {
    let Simulation { system, result } = simulation;
    let System { interval, start, .. } = system;
    let controls = interval.map(|time| controls_at(system, controls, time));
    let states = [start.as_slice(), result.end.as_slice()];
    course.ended(at, &Ends { states, controls: [&controls[0], &controls[1]] });
}
