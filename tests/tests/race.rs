//! The table and figures of `docs/method/racecar.md`: the race car of Section 7, planned and
//! driven.

use fdcc_runtime::simulate::{EventKind, Piece, Simulation};
use fdcc_tests::pages::{check_file, check_tables};
use fdcc_tests::race::{HALF_WIDTH, Race, Run, STEPS, centre_line};
use fdcc_tests::svg::{Axis, Figure};

/// When the plan changes the side to which it slips.
fn turns(run: &Run) -> Vec<f64> {
    let slip = |k: usize| run.velocity(k)[1];
    // From rest the car rolls, nearly; the sign means nothing there.
    let changes = (1..run.points()).filter(|k| run.time[*k] > 0.5 && slip(k - 1) * slip(*k) < 0.0);
    changes.map(|k| run.time[k]).collect()
}

fn events(race: &Race, wanted: &[EventKind]) -> Vec<f64> {
    race.replay.events.iter().filter(|it| wanted.contains(&it.kind)).map(|it| it.time).collect()
}

fn shown(times: &[f64]) -> String {
    times.iter().map(|time| format!("{time:.3}")).collect::<Vec<_>>().join(", ")
}

/// Objective and duration of the plan, miss, then objective, miss and violation of the track of the
/// replay.
fn numbers(race: &Race) -> [f64; 6] {
    let (planned, driven) = (&race.planned, &race.driven);
    let [missed, truly] = [planned.miss(), driven.miss()].map(|[x, y]| x.hypot(y));
    [
        planned.objective(),
        planned.time[STEPS],
        missed,
        driven.objective(),
        truly,
        driven.outside().0,
    ]
}

/// Conditions of optimality, to first order in the step; what is known of the controls.
fn check_optimality(race: &Race, mean: f64) {
    assert!((race.transversality() + 1.0).abs() < 5e-3 && (mean + 1.0).abs() < 2e-3);
    assert!(race.at_bound("a") > 0.97 && (race.at_bound("s") - 0.51).abs() < 0.03);
}

fn column(race: &Race) -> Vec<String> {
    let [objective, duration, miss, truly, missed, outside] = numbers(race);
    let mean = (0..STEPS).map(|k| race.hamiltonian(k)).sum::<f64>() / STEPS as f64;
    check_optimality(race, mean);
    let apart = [0.5, 1.0, 2.0, 4.0].map(|time| format!("{:.3}", race.apart(time)));
    vec![
        format!("{objective:.6}"),
        format!("{duration:.6}"),
        format!("{miss:.4}"),
        format!("{:.4}", race.transversality()),
        format!("{mean:.4}"),
        format!("{:.1} %, {:.1} %", 100.0 * race.at_bound("a"), 100.0 * race.at_bound("s")),
        shown(&turns(&race.planned)),
        format!("{truly:.3}"),
        format!("{missed:.3}"),
        format!("{outside:.3} at {:.2}", race.driven.outside().1),
        shown(&events(race, &[EventKind::LeavesDown, EventKind::LeavesUp])),
        shown(&events(race, &[EventKind::EntersSliding])),
        shown(&events(race, &[EventKind::CrossesUp, EventKind::CrossesDown])),
        apart.join(", "),
    ]
}

const ROWS: [&str; 14] = [
    "objective",
    "T",
    "distance from the target at the end",
    "`2 alpha (x(T) - target) . v(T)`, -1 where optimal",
    "mean of `lambda^T f`, -1 where optimal",
    "throttle, steering at a bound",
    "slips to the other side at",
    "**replay:** objective",
    "distance from the target at the end",
    "track left by",
    "rolls until, breaks away",
    "rolls again from",
    "slips to the other side at",
    "distance from the plan at t = 0.5, 1, 2, 4",
];

#[test]
fn the_table_is_what_is_computed() {
    // From an independent program; the replay at 0.025 amplifies what two solvers differ by.
    let known = [
        (0.1, [5.552178, 5.541108, 0.0333, 7.00006, 0.38196, 0.34622], 1e-4),
        (0.025, [5.353907, 5.342921, 0.0331, 5.57815, 0.15337, 0.14859], 1e-3),
    ];
    let mut rows: Vec<Vec<String>> = ROWS.iter().map(|name| vec![(*name).to_owned()]).collect();
    for (sigma, known, tolerance) in known {
        let race = Race::new(sigma);
        for (found, known) in numbers(&race).into_iter().zip(known) {
            assert!((found - known).abs() < tolerance, "sigma = {sigma}: {found}, not {known}");
        }
        // With both controls at 2 the car rolls until s v_t^2 = muN, where v_t = 2 t.
        let first = events(&race, &[EventKind::LeavesDown, EventKind::LeavesUp])[0];
        assert!(sigma == 0.1 || (first - 0.125_f64.sqrt()).abs() < 5e-6, "breaks away at {first}");
        rows.iter_mut().zip(column(&race)).for_each(|(row, cell)| row.push(cell));
    }
    check_tables("docs/method/racecar.md", &[("race", rows)]);
}

#[test]
fn the_figures_are_what_is_computed() {
    let races = [0.1, 0.025].map(Race::new);
    let last = &races[1];
    let figures = [
        ("path", path(&races)),
        ("throttle", control(&races, "a", "throttle a")),
        ("steering", control(&races, "s", "steering s")),
        ("velocities", velocities(last)),
        ("friction", friction(&races)),
        ("costates", costates(last)),
    ];
    for (name, figure) in figures {
        check_file(&format!("docs/method/figures/racecar-{name}.svg"), &figure.svg());
    }
}

/// A curve over the points of a run, not more than needed.
fn curve(run: &Run, point: impl Fn(usize) -> [f64; 2]) -> Vec<[f64; 2]> {
    let every = run.points() / 250;
    (0..run.points()).step_by(every).map(point).collect()
}

/// To scale.
fn path(races: &[Race]) -> Figure {
    let mut figure =
        Figure::new(Axis::new("x").between(-0.3, 10.2), Axis::new("y").between(-4.6, 2.52));
    for race in races {
        let place = |run: &Run, k: usize| [run.at(k)[0], run.at(k)[1]];
        figure = figure
            .line(
                &format!("planned, {}", race.sigma),
                &curve(&race.planned, |k| place(&race.planned, k)),
            )
            .line(
                &format!("driven, {}", race.sigma),
                &curve(&race.driven, |k| place(&race.driven, k)),
            );
    }
    let border = |side: f64| -> Vec<[f64; 2]> {
        let xs = (0..=210).map(|k| -0.3 + 0.05 * f64::from(k));
        xs.map(|x| [x, centre_line(x) + side * HALF_WIDTH]).collect()
    };
    figure.dashed("track", &[border(1.0), vec![[f64::NAN; 2]], border(-1.0)].concat())
}

/// Held on each interval.
fn control(races: &[Race], name: &str, label: &str) -> Figure {
    let mut figure = Figure::new(Axis::new("t"), Axis::new(label).between(-2.2, 2.2));
    for race in races {
        let (time, values) = (&race.planned.time, race.solved.control(name));
        // Where nothing changes there is nothing to draw.
        let changes = |k: &usize| *k == 0 || (values[*k] - values[k - 1]).abs() > 1e-3;
        let steps = (0..STEPS).filter(changes).flat_map(|k| {
            let before = values[k.saturating_sub(1)];
            [[time[k], before], [time[k], values[k]]]
        });
        let points: Vec<[f64; 2]> = steps.chain([[time[STEPS], values[STEPS - 1]]]).collect();
        figure = figure.line(&format!("sigma = {}", race.sigma), &points);
    }
    figure
}

/// What the paper's Figure 7.3 shows, and the same of the replay.
fn velocities(race: &Race) -> Figure {
    let mut figure = Figure::new(Axis::new("t"), Axis::new("velocity"));
    for (part, name) in ["along", "across"].into_iter().enumerate() {
        for (run, who) in [(&race.planned, "planned"), (&race.driven, "driven")] {
            figure = figure.line(
                &format!("{name}, {who}"),
                &curve(run, |k| [run.time[k], run.velocity(k)[part]]),
            );
        }
    }
    figure
}

/// The selector while the car rolls and breaks away: smoothed, and what the true system takes.
fn friction(races: &[Race]) -> Figure {
    let axis = Axis::new("Sgn(v . n)").between(-1.1, 1.1);
    let mut figure = Figure::new(Axis::new("t").between(0.0, 1.4), axis);
    for race in races {
        let run = &race.planned;
        let smoothed = |k: usize| run.velocity(k)[1] / run.velocity(k)[1].hypot(race.sigma);
        let points: Vec<[f64; 2]> = (0..run.points()).map(|k| [run.time[k], smoothed(k)]).collect();
        let early = |points: Vec<[f64; 2]>| {
            points.into_iter().filter(|it| it[0] < 1.45).collect::<Vec<_>>()
        };
        figure = figure
            .line(&format!("planned, {}", race.sigma), &early(points))
            .line(&format!("driven, {}", race.sigma), &early(selectors(&race.replay)));
    }
    figure
}

/// On both sides of every piece of a simulation.
fn selectors(replay: &Simulation) -> Vec<[f64; 2]> {
    let pieces = &replay.tape.as_ref().expect("it was asked for").pieces;
    let ends = pieces.iter().flat_map(|piece| match piece {
        Piece::Step { start, .. } => vec![[start.time, start.selectors[0]]],
        Piece::Event { before, after, .. } => {
            vec![[before.time, before.selectors[0]], [after.time, after.selectors[0]]]
        }
    });
    ends.collect()
}

fn costates(race: &Race) -> Figure {
    let mut figure = Figure::new(Axis::new("t"), Axis::new("lambda"));
    for name in ["pos.x", "pos.y", "vel.x", "vel.y", "th"] {
        let values = race.solved.costate(name);
        figure = figure.line(name, &curve(&race.planned, |k| [race.planned.time[k], values[k]]));
    }
    figure
}
