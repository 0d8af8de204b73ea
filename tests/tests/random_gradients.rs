//! Gradients of random systems: forward against adjoint to 1e-10, both against differences of
//! simulations, second derivatives against differences of gradients.
//!
//! A family of systems is compiled once, all its coefficients parameters; each system is a choice
//! of these. What differences cannot tell is skipped and counted: no trajectory to the end, other
//! events beside a system (where the start is on a surface that slides, the second derivatives of
//! both sides differ), differences with one and two steps that have nothing in common.
//!
//! `SYSTEMS=20 cargo test --release --test all random_gradients::` takes 20 times as many.

mod differences;
mod family;

use differences::{Seen, check};
use family::{Case, Family};
use fdcc_tests::random::Random;

/// So many systems of families that are compiled in turn.
fn check_all(families: &[Family], seed: u64, count: usize) -> Seen {
    check_along(families, seed, count, |case, _| case)
}

/// The same, each driven otherwise.
fn check_along(
    families: &[Family],
    seed: u64,
    count: usize,
    driven: impl Fn(Case, &mut Random) -> Case,
) -> Seen {
    let times =
        std::env::var("SYSTEMS").map_or(1, |times| times.parse().expect("SYSTEMS is a number"));
    let mut random = Random::new(seed);
    let mut seen = Seen::default();
    for case in 0..times * count {
        let case = driven(families[case % families.len()].random(&mut random), &mut random);
        check(&case, &mut random, &mut seen);
    }
    assert!(10 * seen.skipped < seen.compared, "skipping is rare: {seen:?}");
    assert!(2 * seen.events > seen.differentiated, "the systems are worth their while: {seen:?}");
    seen
}

/// Affine systems with so many surfaces, as many states and more.
fn check_affine(surfaces: usize, sizes: usize, count: usize) -> Seen {
    let families: Vec<Family> =
        (0..sizes).map(|more| Family::affine(surfaces, surfaces + more)).collect();
    check_all(&families, 2000 + surfaces as u64, count)
}

#[test]
fn gradients_of_affine_systems_with_a_surface() {
    check_affine(1, 3, 90);
}

#[test]
fn gradients_of_affine_systems_with_two_surfaces() {
    assert!(check_affine(2, 2, 60).held_together > 2);
}

#[test]
fn gradients_of_affine_systems_with_three_surfaces() {
    assert!(check_affine(3, 1, 40).held_together > 5);
}

#[test]
fn gradients_of_affine_systems_with_four_surfaces() {
    assert!(check_affine(4, 1, 20).held_together > 5);
}

#[test]
fn gradients_of_curved_systems_with_jumps() {
    let seen = check_all(&[Family::curved()], 77, 60);
    assert!(seen.jumps > 20, "{seen:?}");
}

#[test]
fn gradients_along_polynomial_controls() {
    let families = [Family::affine(1, 2), Family::affine(2, 2), Family::curved()];
    let seen = check_along(&families, 4711, 90, Case::with_polynomials);
    assert!(seen.jumps > 5 && seen.held_together > 0, "{seen:?}");
}
