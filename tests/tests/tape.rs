//! The tape of a simulation tells all of it: its pieces meet, and its changes are the events.

use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{
    Controls, Instant, Options, Piece, Simulation, Status, Tape, simulate,
};
use fdcc_tests::documents;
use fdcc_tests::models::changed;

fn taped(text: &str, controls: &Controls) -> (Simulation, Tape) {
    let system = compile_simulation(&changed(text, &[], &[])).expect("the model can be simulated");
    let options = Options { tape: true, ..Options::default() };
    let mut simulation = simulate(&system, controls, &options);
    let tape = simulation.tape.take().expect("a tape is asked for");
    (simulation, tape)
}

/// Times and states before and after a piece, with the regimes there.
fn ends(piece: &Piece) -> [(f64, &[f64], usize); 2] {
    let of = |at: &'_ Instant| (at.time, at.regime);
    match piece {
        Piece::Step { start, h, end, .. } => {
            let (time, regime) = of(start);
            [(time, &start.state, regime), (time + h, end, regime)]
        }
        Piece::Event { before, after, .. } => {
            let [(first, old), (last, new)] = [of(before), of(after)];
            [(first, &before.state, old), (last, &after.state, new)]
        }
    }
}

#[test]
fn the_pieces_of_a_tape_meet() {
    for (name, text) in documents("tests/simulations", "fdc") {
        let (simulation, tape) = taped(&text, &Controls::Guess);
        for pair in tape.pieces.windows(2) {
            let ([_, before], [after, _]) = (ends(&pair[0]), ends(&pair[1]));
            let is_near = (before.0 - after.0).abs() <= 1e-12 * before.0.abs().max(1.0);
            assert!(
                is_near && before.1 == after.1 && before.2 == after.2,
                "{name}: {before:?}, {after:?}"
            );
        }
        if matches!(simulation.status, Status::Completed) {
            let last = ends(tape.pieces.last().expect("a simulation has pieces"))[1];
            assert_eq!(last.1, simulation.end, "{name}");
        }
    }
}

#[test]
fn the_changes_of_a_tape_are_the_events() {
    for (name, text) in documents("tests/simulations", "fdc") {
        let (simulation, tape) = taped(&text, &Controls::Guess);
        let changes = tape.pieces.iter().flat_map(|piece| match piece {
            Piece::Event { changes, .. } => changes.as_slice(),
            Piece::Step { .. } => &[],
        });
        let changes: Vec<_> = changes.map(|it| (it.after.time, it.surface, it.kind)).collect();
        let events: Vec<_> =
            simulation.events.iter().map(|it| (it.time, it.surface, it.kind)).collect();
        if matches!(simulation.status, Status::Completed) {
            assert_eq!(changes, events, "{name}");
        }
    }
}

#[test]
fn a_tape_makes_no_difference() {
    for (name, text) in documents("tests/simulations", "fdc") {
        let (taped, _) = taped(&text, &Controls::Guess);
        let system = compile_simulation(&changed(&text, &[], &[])).expect("it can be simulated");
        let bare = simulate(&system, &Controls::Guess, &Options::default());
        let [with, without] = [&taped, &bare].map(|trajectory| {
            let events = trajectory.events.iter().map(|event| (event.time, event.surface));
            (trajectory.end.clone(), events.collect::<Vec<_>>(), trajectory.counts.steps)
        });
        assert_eq!(with, without, "{name}");
    }
}

#[test]
fn regimes_name_the_segment_of_the_controls() {
    let text = documents("tests/simulations", "fdc").into_iter().find(|(name, _)| name == "sticks");
    let rows = vec![vec![2.0], vec![0.0], vec![-3.0]];
    let controls = Controls::Held { times: vec![0.0, 1.0, 2.5], rows, is_stretched: true };
    let (_, tape) = taped(&text.expect("a model").1, &controls);
    let mut segments: Vec<_> = tape.regimes.iter().map(|regime| regime.segment).collect();
    segments.dedup();
    assert_eq!(segments, [Some(0), Some(1), Some(2)]);
}
