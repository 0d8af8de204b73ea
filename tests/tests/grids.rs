//! Fine grids are reached over coarse ones, with every scheme and every shape of controls: few
//! iterations are left for the grid of the model.

use fdcc_runtime::nlp::Status;
use fdcc_runtime::solve;
use fdcc_tests::models::load;
use std::ops::ControlFlow;

/// Iterations on each grid of the race car, the coarsest first.
fn iterations(method: &[(&str, &str)]) -> Vec<(usize, usize)> {
    let problem = load("racecar", &[], method);
    let mut grids: Vec<(usize, usize)> = Vec::new();
    let mut watch = |_: &_, level: solve::Level| {
        match grids.last_mut() {
            Some((intervals, count)) if *intervals == level.intervals => *count += 1,
            _ => grids.push((level.intervals, 1)),
        }
        ControlFlow::Continue(())
    };
    let outcome = solve::solve(&problem, None, &mut watch).expect("it is not refused");
    assert_eq!(outcome.solution.status, Status::Solved, "{method:?}");
    grids
}

#[test]
fn few_iterations_are_left_for_the_grid_of_the_model() {
    for (scheme, controls) in [
        ("implicit_euler", "constant"),
        ("radau2", "constant"),
        ("radau3", "linear"),
        ("gauss2", "constant"),
        ("gauss2", "polynomial"),
    ] {
        let grids = iterations(&[("scheme", scheme), ("controls", controls), ("N", "500")]);
        let intervals: Vec<usize> = grids.iter().map(|grid| grid.0).collect();
        assert_eq!(intervals, [125, 250, 500], "{scheme} {controls}");
        let all: usize = grids.iter().map(|grid| grid.1).sum();
        assert!(2 * grids[2].1 < all, "{scheme}, {controls}: {grids:?}");
    }
}
