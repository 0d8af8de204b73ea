//! Arrays of states, such as temperatures along a rod, as maps of colours.

use crate::common::*;
use serde_json::Value;
use std::f64::consts::PI;
use std::path::Path;

/// A rod of so many cells without a flow through its ends, in its first mode: the cosine over the
/// cells decays, and keeps its shape.
pub fn rod(cells: usize) -> String {
    let states: String = (1..=cells)
        .map(|at| {
            let start = (PI * (at as f64 - 0.5) / cells as f64).cos();
            format!("state T{at} [K] start {start}\n")
        })
        .collect();
    let equation = |at: usize| {
        let [before, after] = [at.max(2) - 1, (at + 1).min(cells)];
        format!("  T{at}' = (T{before} - 2*T{at} + T{after})*1[1/s]\n")
    };
    let equations: String = (1..=cells).map(equation).collect();
    format!("model rod\ntime t in [0, 2] [s]\n{states}dynamics {{\n{equations}}}\n")
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn drawing(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"page\">").expect("what is drawn");
    serde_json::from_str(rest.split_once("</script>").expect("it ends").0).expect("JSON")
}

#[test]
fn eight_components_are_a_map_and_seven_are_plots() {
    for cells in [7, 8] {
        let rod = rod(cells);
        let folder = folder(&format!("arrays_{cells}"), &[("rod.fdc", rod.as_bytes())]);
        expect_exit(&fdcc(&folder, &["simulate", "rod.fdc", "--out", "."], ""), 0, "simulate");
        let page = read(&folder, "rod.sim.html");
        let has_map = cells == 8;
        assert_eq!(page.contains("data-map=\"0\""), has_map);
        assert_eq!(page.contains("<summary>each of the 8</summary>"), has_map);
        let drawn = drawing(&page);
        assert_eq!(drawn["arrays"].as_array().map(Vec::len), Some(usize::from(has_map)));
        if has_map {
            let array = &drawn["arrays"][0];
            assert_eq!((&array["name"], &array["first"]), (&"T".into(), &1.into()));
            // The mode is largest at the first time and at the ends of the rod.
            let [low, high] = [0, 1].map(|at| number(&array["range"][at]));
            let most = (PI / 16.0).cos();
            assert!((high - most).abs() < 1e-6 && (low + most).abs() < 1e-6, "{low} {high}");
            assert!(page.contains("-0.98079 <i style="), "the scale says what colours are");
            assert!(page.contains("></i> 0.98079 K</span>"));
        }
    }
}

/// Yellow is the highest value and dark violet the lowest; in the middle of a rod both are one.
#[test]
fn an_array_is_drawn_for_papers() {
    let folder = folder("arrays_plot", &[("rod.fdc", rod(9).as_bytes())]);
    expect_exit(&fdcc(&folder, &["simulate", "rod.fdc", "--out", "."], ""), 0, "simulate");
    let plot = |arguments: &[&str]| {
        fdcc(&folder, &[&["plot", "rod.sim.json"][..], arguments].concat(), "")
    };
    expect_exit(&plot(&["--signal", "T", "--out", "T.svg"]), 0, "plot");
    let svg = read(&folder, "T.svg");
    assert!(svg.contains("T [K]") && svg.contains("index of T"), "{svg}");
    let colours = |hex: &str| svg.matches(&format!("fill=\"{hex}\"")).count();
    assert!(colours("#FDE725") > 0 && colours("#440154") > 0, "both ends of the scale");
    // The middle stays at 0: half way between them, one rectangle over all times.
    assert_eq!(colours("#21918C"), 1);
    expect_exit(&plot(&["--out", "all.svg"]), 0, "all states are one map");
    assert_eq!(read(&folder, "all.svg"), svg);
    expect_exit(&plot(&["--signal", "T3", "--out", "T3.svg"]), 0, "one of them");
    assert!(!read(&folder, "T3.svg").contains("index of"));
    expect_exit(&plot(&["--signal", "T", "--out", "T.pdf"]), 0, "PDF");
    let over = plot(&["--signal", "T", "--over", "T1", "--out", "over.svg"]);
    expect_exit(&over, 3, "a map is over the time");
    assert!(stderr(&over).contains("`--over`"), "{}", stderr(&over));
    let missing = plot(&["--signal", "U", "--out", "U.svg"]);
    assert!(stderr(&missing).contains("there are: T, T1, T2"), "{}", stderr(&missing));
}
