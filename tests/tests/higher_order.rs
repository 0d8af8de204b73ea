//! Slope and curvature are 0 at the guess, and so are all derivatives of higher order along each
//! single control: it is a saddle all the same, and is left.

use fdcc::{Model, Options, Solution};

/// A form of two numbers `a` and `b`, and its least value where both are in [-1, 1]. By calculus:
/// each is a polynomial of squares, or least at a corner; Peano's falls along a parabola only.
const FORMS: [(&str, f64); 6] = [
    ("a*b^3", -1.0),
    ("a^3*b", -1.0),
    ("a^4 - 3*a^2*b^2 + b^4", -1.0),
    ("a^4 - b^4", -1.0),
    ("a^4 - a^2*b^2 + b^6", -1.0 / 432.0),
    ("(a^2 - b)*(a^2 - 3*b)", -1.0 / 3.0),
];

fn solved(text: &str) -> Solution {
    let model = Model::from_text("higher_order", text).expect("a model");
    model.solve(&Options::default()).expect("an answer")
}

/// The form with other names for its numbers.
fn of(form: &str, [a, b]: [&str; 2]) -> String {
    form.replace('a', "A").replace('b', b).replace('A', a)
}

fn of_controls(form: &str, method: &str) -> String {
    let cost = of(form, ["u", "w"]);
    format!(
        "time t in [0, 1] state x start 0 control u in [-1, 1] control w in [-1, 1]\n\
         dynamics {{ x' = u + w }} minimize integral({cost}) {method}"
    )
}

#[test]
fn a_saddle_of_several_controls_is_left() {
    for (form, least) in FORMS {
        for intervals in [1, 10] {
            let text = of_controls(form, &format!("method {{ N = {intervals} scheme midpoint }}"));
            let solution = solved(&text);
            let above = solution.objective() - least;
            assert!(solution.status().is_solved(), "{form}: {:?}", solution.status());
            assert!((-1e-6..1e-6).contains(&above), "{form}: {}", solution.objective());
        }
    }
}

#[test]
fn a_saddle_of_end_states_is_left() {
    // The Hamiltonian says nothing: all costates are 0.
    for (form, least) in FORMS.iter().take(4) {
        let cost = of(form, ["x(end)", "y(end)"]);
        let solution = solved(&format!(
            "time t in [0, 1] state x start 0 state y start 0\n\
             control u in [-1, 1] control w in [-1, 1]\n\
             dynamics {{ x' = u  y' = w }} minimize {cost} method {{ N = 5 }}"
        ));
        assert!(solution.status().is_solved(), "{form}: {:?}", solution.status());
        assert!((solution.objective() - least).abs() < 1e-6, "{form}: {}", solution.objective());
    }
}

/// Without a grid: what is certified is the least value, and no saddle.
#[test]
fn a_saddle_is_not_certified() {
    for (form, least) in FORMS {
        let solution = solved(&of_controls(form, ""));
        let is_least = (solution.objective() - least).abs() < 1e-6;
        assert!(is_least || !solution.is_certified(), "{form}: {}", solution.objective());
    }
}
