//! Bounds of signals that the optimiser chooses, beside closed forms.

use fdcc::{Model, Options};

fn objective(text: &str) -> f64 {
    let model = Model::from_text("chosen", text).unwrap_or_else(|error| panic!("{text}\n{error}"));
    let solution = model.solve(&Options::default()).expect("it can be solved");
    assert!(solution.is_solved(), "{text}");
    solution.objective()
}

/// From rest to rest over the distance 1 in the time 1, with an acceleration of 8 at most: half a
/// speed `m` is lost for `m/8` at both ends, so `m (1 - m/8) = 1`.
#[test]
fn the_least_top_speed() {
    let text = "free m in [0, 5] guess 2\ntime t in [0, 1]\nstate x start 0\n\
                state v in [0, m] start 0\ncontrol u in [-8, 8]\ndynamics { x' = v\nv' = u }\n\
                end x == 1\nend v == 0\nminimize m\nmethod { grid N = 400 scheme midpoint }";
    let exact = 4.0 - 8.0_f64.sqrt();
    assert!((objective(text) - exact).abs() < 2e-3, "{} {exact}", objective(text));
}

/// The least force that moves from -1 to 1 in the time 1 is constant.
#[test]
fn the_least_force_of_a_vector() {
    let text = "free m in [0, 9] guess 1\ntime t in [0, 1]\nstate p(x, y) start (-1, 2)\n\
                control u(x, y) in [(-m, -2*m), (m, inf)]\ndynamics { p' = u }\nend p == (1, 0)\n\
                minimize m";
    assert!((objective(text) - 2.0).abs() < 1e-6, "{}", objective(text));
}
