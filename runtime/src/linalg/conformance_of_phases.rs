//! The recursion over several phases on random chains that are tied together.

use super::conformance::Case;
use super::riccati::PhasedRiccati;
use super::structure::factor::{Factor, Inertia};
use super::structure::phases::PhaseStages;
use super::structure::stages::Stages;
use super::structure::triplets::{Family, Triplets};
use crate::random::Random;

/// Phases of different sizes. Each has unknowns of its own and one that it shares with the next;
/// one is shared by all. A last state is tied to the next first one, whose size may differ, and a
/// row holds at the end of each phase alone; `cyclic`: the last one is tied to the first, too.
struct Tied {
    phases: Vec<PhaseStages>,
    whole: Case,
}

fn sizes(at: usize, random: &mut Random) -> Stages {
    Stages {
        intervals: 2 + random.below(5),
        states: 1 + random.below(3),
        controls: random.below(3),
        inner: if at.is_multiple_of(2) { random.below(3) } else { 0 },
        globals: 3,
        local_constraints: random.below(3),
        coupling_constraints: random.below(2),
    }
}

fn tied(count: usize, is_cyclic: bool, is_indefinite: bool, random: &mut Random) -> Tied {
    let all: Vec<Stages> = (0..count).map(|at| sizes(at, random)).collect();
    let own: Vec<Case> =
        all.iter().map(|it| Case::new(*it, false, false, is_indefinite, random)).collect();
    let first_unknown: usize = all.iter().map(|it| it.globals().start).sum();
    let phases = places(&all, first_unknown);
    let mut whole = untied(&phases, &own, first_unknown + count + 2);
    whole.sigma.extend((0..count + 2).map(|_| 1.0 + 0.5 * random.next()));
    whole.fixed.extend(vec![false; count + 2]);
    // Only the first state of the first phase is given.
    for phase in &phases[1..] {
        whole.fixed[phase.first()].fill(false);
    }
    for j in 1..count {
        tie(&phases[j - 1], &phases[j], first_unknown + j, random, &mut whole);
    }
    if is_cyclic {
        let (first, last) = (phases[0].first().end - 1, phases[count - 1].last().start);
        condition(vec![(first, 1.0), (last, -1.0), (first_unknown, 1.0)], &mut whole);
    }
    whole.stages.coupling_constraints = whole.d.len();
    Tied { phases, whole }
}

/// Where phases of these sizes have their variables, unknowns and rows.
fn places(all: &[Stages], first_unknown: usize) -> Vec<PhaseStages> {
    let (mut phases, mut variables, mut rows) = (Vec::new(), 0, 0);
    for (j, stages) in all.iter().enumerate() {
        let end = variables + stages.globals().start;
        phases.push(PhaseStages {
            stages: *stages,
            variables: variables..end,
            globals: [j, j + 1, all.len() + 1].map(|at| first_unknown + at).to_vec(),
            rows: rows..rows + stages.rows(),
        });
        (variables, rows) = (end, rows + stages.rows());
    }
    phases
}

/// Nothing yet, of so many variables.
fn empty(variables: usize) -> Case {
    let stages = Stages {
        intervals: 0,
        states: 0,
        controls: 0,
        inner: 0,
        globals: variables,
        local_constraints: 0,
        coupling_constraints: 0,
    };
    Case {
        stages,
        hessian: Triplets::default(),
        jacobian: Triplets::default(),
        hessian_values: Vec::new(),
        jacobian_values: Vec::new(),
        sigma: Vec::new(),
        d: Vec::new(),
        fixed: Vec::new(),
    }
}

/// All phases, each by itself, as one case; of the unknowns their entries alone.
fn untied(phases: &[PhaseStages], own: &[Case], variables: usize) -> Case {
    let mut whole = empty(variables);
    for (phase, case) in phases.iter().zip(own) {
        let stages = phase.variables.len();
        let place = |at: usize| phase.place(at);
        whole.hessian.families.extend(case.hessian.families.iter().map(|it| Family {
            row: place(it.row),
            column: place(it.column),
            ..*it
        }));
        whole.jacobian.families.extend(case.jacobian.families.iter().map(|it| Family {
            row: phase.rows.start + it.row,
            column: place(it.column),
            ..*it
        }));
        whole.hessian_values.extend(&case.hessian_values);
        whole.jacobian_values.extend(&case.jacobian_values);
        whole.sigma.extend(&case.sigma[..stages]);
        whole.fixed.extend(&case.fixed[..stages]);
        whole.d.extend(&case.d);
    }
    whole
}

/// One more row: the coefficients of its variables.
fn condition(columns: Vec<(usize, f64)>, case: &mut Case) {
    let row = case.d.len();
    for (column, value) in columns {
        case.jacobian.families.push(Family::single(row, column));
        case.jacobian_values.push(value);
    }
    case.d.push(0.0);
}

/// Ties a phase to the one before it.
fn tie(
    before: &PhaseStages,
    behind: &PhaseStages,
    unknown: usize,
    random: &mut Random,
    whole: &mut Case,
) {
    for state in behind.first() {
        let mut columns: Vec<(usize, f64)> = before.last().map(|it| (it, random.next())).collect();
        columns.extend([(state, 1.0), (unknown, random.next())]);
        condition(columns, whole);
    }
    let end = before.last().map(|it| (it, random.next()));
    condition(end.chain([(unknown, 2.0)]).collect(), whole);
    // Curvature of a link.
    let (a, b) = (behind.first().start, before.last().start);
    for (row, column) in [(a, b), (unknown, a), (unknown, b)] {
        whole.hessian.families.push(Family::single(row, column));
        whole.hessian_values.push(0.1 * random.next());
    }
}

/// Experiments: phases beside each other that share an unknown. Each begins at one of its own,
/// which nothing but its start reads, and another one is read by its stages.
fn apart(count: usize, random: &mut Random) -> Tied {
    let size = Stages {
        intervals: 4,
        states: 1,
        controls: 0,
        inner: 0,
        globals: 2,
        local_constraints: 0,
        coupling_constraints: 0,
    };
    let all = vec![size; count];
    let own: Vec<Case> = all.iter().map(|it| Case::new(*it, false, false, false, random)).collect();
    let first_unknown: usize = all.iter().map(|it| it.globals().start).sum();
    let mut phases = places(&all, first_unknown);
    for (j, phase) in phases.iter_mut().enumerate() {
        phase.globals = [j, 2 * count].map(|at| first_unknown + at).to_vec();
    }
    let mut whole = untied(&phases, &own, first_unknown + 2 * count + 1);
    whole.sigma.extend((0..2 * count + 1).map(|_| 1.0 + 0.5 * random.next()));
    whole.fixed.extend(vec![false; 2 * count + 1]);
    for (j, phase) in phases.iter().enumerate() {
        whole.fixed[phase.first()].fill(false);
        let start = (first_unknown + count + j, -1.0);
        condition(vec![(phase.first().start, 1.0), start], &mut whole);
    }
    whole.stages.coupling_constraints = whole.d.len();
    Tied { phases, whole }
}

/// However many there are: two unknowns.
#[test]
fn phases_beside_each_other_carry_nothing_of_the_others() {
    let mut random = Random(7);
    for count in [2, 3, 20] {
        let Tied { phases, whole } = apart(count, &mut random);
        assert!(whole.is_regular());
        let equality: Vec<bool> = whole.d.iter().map(|d| *d == 0.0).collect();
        let matrices = (&whole.hessian, &whole.jacobian);
        let mut factor = PhasedRiccati::new(&phases, matrices, &whole.fixed, &equality)
            .unwrap_or_else(|why| panic!("{count} phases: {why}"));
        whole.check("beside each other", &mut factor, 1, &mut random);
        let borders: Vec<usize> = (0..count).map(|j| factor.border(j)).collect();
        assert!(borders.iter().all(|it| *it <= 2), "{borders:?}");
    }
}

#[test]
fn phases_are_solved_as_the_whole_and_their_inertia_is_known() {
    let mut random = Random(5);
    let (mut both, mut narrow) = ([0, 0], 0);
    for case in 0..120 {
        let count = 2 + case % 5;
        let Tied { phases, whole } = tied(count, case % 4 == 1, case % 2 == 0, &mut random);
        // Phases without controls may have more rows than they can meet.
        if !whole.is_regular() {
            continue;
        }
        let equality: Vec<bool> = whole.d.iter().map(|d| *d == 0.0).collect();
        let matrices = (&whole.hessian, &whole.jacobian);
        let mut factor = PhasedRiccati::new(&phases, matrices, &whole.fixed, &equality)
            .unwrap_or_else(|why| panic!("case {case}: {why}"));
        whole.check("phases", &mut factor, 1, &mut random);
        let inertia =
            factor.factor(&whole.hessian_values, &whole.jacobian_values, &whole.sigma, &whole.d);
        both[usize::from(inertia == Inertia::Correct)] += 1;
        // Two unknowns of its own and one that all share, the row at its end, and rows that tie the
        // ends of a phase together.
        if case % 4 != 1 && phases.iter().all(|phase| phase.stages.controls > 0) {
            let most = (0..phases.len()).map(|j| factor.border(j)).max();
            let rows: usize = phases.iter().map(|it| it.stages.coupling_constraints).sum();
            assert!(most <= Some(4 + rows), "case {case}: {most:?}");
            narrow += 1;
        }
    }
    assert!(narrow > 5, "{narrow}");
    assert!(both[0] > 20 && both[1] > 40, "the cases must be of both kinds: {both:?}");
}
