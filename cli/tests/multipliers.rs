//! What located optima say between their nodes and at their contacts: the Hamiltonian, the
//! multipliers of bounds that are touched, and how they move; and how pages show it.

use crate::common::*;
use serde_json::Value;

fn solved(folder: &std::path::Path, arguments: &[&str]) -> Value {
    let output = fdcc(folder, &[&["solve", "--json", "--log", "none"], arguments].concat(), "");
    expect_exit(&output, 0, &stderr(&output));
    let document = json(&output);
    assert_eq!(document["certificate"]["certified"], true);
    document
}

fn numbers(it: &Value) -> Vec<f64> {
    it.as_array().expect("a list").iter().map(number).collect()
}

/// Where the last time is free and time itself does not matter, the Hamiltonian is minus what the
/// objective gains by it: -1 of a shortest time, 0 of a running cost (Bryson & Ho, 1975, 2.7).
#[test]
fn the_hamiltonian_of_a_located_optimum_is_constant() {
    let fast = "model fast
free T in [0.1, 10] guess 2
time t in [0, T]
state x start 0
state v start 0
control u in [-1, 1]
dynamics { x' = v  v' = u }
end x == 1
end v == 0
minimize T";
    let cheap = fast.replace("minimize T", "minimize integral(1 + u^2)");
    let files = [("fast.fdc", fast.as_bytes()), ("cheap.fdc", cheap.as_bytes())];
    let folder = folder("hamiltonian_located", &files);
    let (reverse, car) = (model("coulomb_reverse"), model("racecar"));
    // The race car touches its surface for a moment; its figure is that of its certificate.
    for (file, expected, off) in [
        ("fast.fdc", -1.0, 1e-8),
        ("cheap.fdc", 0.0, 1e-8),
        (&reverse, -1.0, 1e-8),
        (&car, -1.0, 1e-4),
    ] {
        let document = solved(&folder, &[file]);
        let values = numbers(&document["hamiltonian"]);
        assert_eq!(values.len() + 1, numbers(&document["time"]).len(), "{file}");
        let wrong = values.iter().find(|it| (*it - expected).abs() > off);
        assert!(wrong.is_none(), "{file}: {wrong:?}");
    }
}

/// The same in each phase of a model with phases.
#[test]
fn each_phase_of_a_located_optimum_has_its_hamiltonian() {
    let text = "model two
free T1 in [0.1, 5] guess 1
free T2 in [0.2, 9] guess 2
phase go { time t in [0, T1]  state x start 0  state v start 0  control u in [-1, 1]
  dynamics { x' = v  v' = u }  end x == 0.25 }
phase stop { time t in [T1, T2]  state x  state v  control u in [-1, 1]
  dynamics { x' = v  v' = u }  end x == 1  end v == 0 }
link go -> stop { same }
minimize T2";
    let folder = folder("hamiltonian_phases", &[("two.fdc", text.as_bytes())]);
    let document = solved(&folder, &["two.fdc"]);
    for phase in ["go", "stop"] {
        let own = &document["phases"][phase];
        let values = numbers(&own["hamiltonian"]);
        assert_eq!(values.len() + 1, numbers(&own["time"]).len());
        assert!(values.iter().all(|it| (it + 1.0).abs() < 1e-7), "{phase}: {values:?}");
    }
}

/// Bryson and Denham, 1963, of the integral of u^2: above 1/6 the bound is touched once and the
/// least value is 4 + 12*(1 - 4*l)^2, below there is an arc from 3*l to 1 - 3*l, and it is 8/(9*l).
pub const DENHAM: &str = "model denham
param l = 20 [cm]
time t in [0, 1] [s]
state x [m] start 0
state v [m/s] start 1
control u [m/s^2]
dynamics { x' = v  v' = u }
path top: x <= l
end x == 0
end v == -1[m/s]
minimize integral(u^2)
";

#[test]
fn a_bound_that_is_touched_has_a_multiplier_at_that_time() {
    let top = |document: &Value| {
        let own = &document["certificate"]["impulses"]["top"];
        (numbers(&own["time"]), numbers(&own["values"]))
    };
    let folder = folder("impulses", &[("denham.fdc", DENHAM.as_bytes())]);
    let near = |found: &[f64], expected: &[f64], off: f64| {
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= off * b.abs();
        assert!(
            found.len() == expected.len() && found.iter().zip(expected).all(is_near),
            "{found:?}"
        );
    };
    let (time, values) = top(&solved(&folder, &["denham.fdc"]));
    near(&time, &[0.5], 1e-6);
    near(&values, &[-96.0 * (1.0 - 4.0 * 0.2)], 1e-6);
    let arc = solved(&folder, &["denham.fdc", "--set", "l=0.1[m]"]);
    let (time, values) = top(&arc);
    near(&time, &[0.3, 0.7], 1e-5);
    near(&values, &[-4.0 / 9.0 / 0.01; 2], 1e-4);
    // Together they are what the bound is worth.
    near(&[number(&arc["sensitivities"]["l"])], &[values[0] + values[1]], 1e-4);
    // Of what is maximised they have the other sign; the bound of a state has one, too.
    let other = DENHAM.replace("minimize integral(u^2)", "maximize -integral(u^2)");
    let other =
        other.replace("state x [m]", "state x [m] in [-1, 0.2]").replace("x <= l", "x <= 2*l");
    std::fs::write(folder.join("denham.fdc"), other).expect("written");
    let document = solved(&folder, &["denham.fdc"]);
    near(&numbers(&document["certificate"]["impulses"]["x"]["values"]), &[19.2], 1e-6);
    assert!(document["certificate"]["impulses"]["top"].is_null());
}

#[test]
fn a_page_shows_the_hamiltonian_the_stems_and_how_the_optimum_moves() {
    let folder = folder("multipliers_page", &[("denham.fdc", DENHAM.as_bytes())]);
    let solve = ["solve", "denham.fdc", "--wrt", "l", "--out", ".", "--log", "none"];
    expect_exit(&fdcc(&folder, &solve, ""), 0, "solve");
    let page = std::fs::read_to_string(folder.join("denham.html")).expect("it was written");
    assert!(page.contains("<h2>Hamiltonian: running cost, and costates times right side</h2>"));
    assert!(page.contains("<h2>Multipliers of bounds at one time</h2>"), "a plot and a table");
    assert!(page.contains("<td>top</td><td class=\"number\">0.5 s</td>"), "{page}");
    // The touch stays at 1/2: nothing else has a time that moves.
    let table = page.split("<h2>How the optimum moves</h2>").nth(1).expect("a table");
    let table = table.split("</table>").next().expect("it ends");
    assert!(
        table.contains("<td>junction 1</td><td class=\"number\">0.5 s</td><td>l</td>"),
        "{table}"
    );
    let signal = ["--signal", "impulse(top)", "--signal", "hamiltonian", "--out", "p.svg"];
    let plot = fdcc(&folder, &[&["plot", "denham.sol.json"][..], &signal].concat(), "");
    expect_exit(&plot, 0, &stderr(&plot));
    let svg = std::fs::read_to_string(folder.join("p.svg")).expect("it was written");
    assert!(svg.contains("impulse(top)") && svg.contains("<circle"), "{svg}");
}
