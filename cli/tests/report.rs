//! The page of a solution: what it says, and that it needs nothing else.

use crate::common::*;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A page, and the document that it draws.
struct Page {
    text: String,
    document: Value,
    path: PathBuf,
}

/// Solves a model with some options.
fn page(test: &str, files: &[(&str, &[u8])], name: &str, options: &[&str]) -> Page {
    let folder = folder(test, files);
    let own = format!("{name}.fdc");
    let file = if files.is_empty() { model(name) } else { own };
    let solve = [&["solve", &file, "--log", "none", "--out", "out"], options].concat();
    expect_exit(&fdcc(&folder, &solve, ""), 0, name);
    read(&folder.join(format!("out/{name}.html")))
}

fn read(path: &Path) -> Page {
    let text = std::fs::read_to_string(path).expect("the page was written");
    let document = text.split("id=\"solution-0\">").nth(1).expect("the page has its document");
    let document = document.split("</script>").next().expect("it ends");
    let document = serde_json::from_str(document).expect("it is JSON");
    Page { text, document, path: path.to_owned() }
}

/// What stands between the tags of a page but for scripts and styles.
fn without(page: &str, element: &str) -> String {
    let (open, close) = (format!("<{element}"), format!("</{element}>"));
    let mut pieces = page.split(&open);
    let first = pieces.next().unwrap_or_default().to_owned();
    let rest = pieces.map(|piece| piece.split_once(&close).expect("it is closed").1);
    first + &rest.collect::<String>()
}

impl Page {
    fn markup(&self) -> String {
        without(&without(&self.text, "script"), "style")
    }

    fn headline(&self) -> &str {
        let heading = self.text.split("<h1 ").nth(1).expect("there is a headline");
        heading.split("</h1>").next().and_then(|it| it.split_once('>')).expect("it is closed").1
    }
}

#[test]
fn the_page_is_well_formed_and_needs_nothing_else() {
    let page = page("page", &[], "block", &["--method", "N=40", "--method", "sigma=0.01"]);
    for outside in ["src=", "href=", "@import", "url(", "fetch(", "XMLHttpRequest", "import("] {
        assert!(!page.text.contains(outside), "{outside}");
    }
    let markup = page.markup();
    for wrong in ["NaN", "inf ", "undefined"] {
        assert!(!markup.contains(wrong), "{wrong}");
    }
    let mut open = Vec::new();
    for tag in markup.split('<').skip(1).map(|rest| rest.split('>').next().expect("a tag")) {
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name), "closed out of order"),
            None if tag.starts_with('!') || tag.ends_with('/') => {}
            None => open.push(tag.split(' ').next().expect("a name")),
        }
    }
    assert!(open.is_empty(), "{open:?} is not closed");
    assert_eq!(
        page.headline(),
        "A local optimum of the smoothed problem, not confirmed on the true system"
    );
    assert!(markup.contains("0.01 m/s around slip, kernel"), "{markup}");
}

#[test]
fn a_certified_optimum_is_told_with_its_switches_and_costates_on_both_sides() {
    let page = page("page_certified", &[], "block", &[]);
    // It may rest at first, too: waiting costs nothing.
    assert!(page.headline().starts_with("Local optimum of the true system, "));
    assert!(page.headline().ends_with(" located"));
    let switches = page.document["certificate"]["switches"].as_array().expect("switches");
    let last = number(&switches[switches.len() - 1]["time"]);
    let told = format!("<td>slip</td><td class=\"number\">{}", &last.to_string()[..5]);
    assert!(page.markup().contains(&told), "{told}: {}", page.markup());
    let strips = page.text.split("id=\"page\">").nth(1).expect("what is drawn");
    assert!(strips.contains("slip: above to held"), "a mark at each switch");
    // While it rests a push is lost at once: the costate of the velocity jumps where it begins to
    // slide, and nowhere else (Stewart & Anitescu, section 5, with the errata).
    let sides = |switch: usize, name: &str| {
        let time = page.document["time"].as_array().expect("times");
        let at = time.iter().position(|it| it == &switches[switch]["time"]);
        let at = at.expect("the grid has the time of a switch");
        let before = number(&page.document["costates_before"][switch]["values"][name]);
        [before, number(&page.document["costates"][name][at])]
    };
    let jump = |switch: usize, name: &str| {
        let [before, after] = sides(switch, name);
        (before - after).abs()
    };
    let exit = (0..switches.len()).find(|at| switches[*at]["from"] == "held").expect("it slides");
    for switch in 0..switches.len() {
        assert!(jump(switch, "x") < 1e-6 * sides(switch, "x")[1].abs());
        assert_eq!(jump(switch, "v") > 1.0, switch == exit, "{switches:?}");
    }
}

#[test]
fn what_is_not_certified_is_called_smoothed_with_the_reason() {
    // Across a surface that repels there is an infimum and no optimum.
    let ridge: &[u8] = include_bytes!("../../tests/classics/switched/ridge.fdc");
    let folder = folder("page_uncertified", &[("ridge.fdc", ridge)]);
    let solve = ["solve", "ridge.fdc", "--log", "none", "--out", "out"];
    expect_exit(&fdcc(&folder, &solve, ""), 2, "uncertified");
    let page = read(&folder.join("out/ridge.html"));
    assert!(page.headline().starts_with("Not certified: a local optimum of the smoothed problem"));
    assert!(page.markup().contains("looked for and is not certified: "), "{}", page.markup());
}

/// Impacts: states before and after, and where a condition is active.
#[test]
fn jumps_have_both_sides_and_path_conditions_their_limits() {
    let page = page("page_bounce", &[], "bounce", &["--method", "scheme=midpoint"]);
    assert!(page.markup().contains("<td>bounce</td><td class=\"number\">0.5487089 s</td>"));
    let jump = &page.document["jumps"][0];
    assert!(number(&jump["before"]["v"]) < -1.0 && number(&jump["after"]["v"]) > 1.0, "{jump}");
    let airborne = &page.document["path"]["airborne"];
    assert_eq!(airborne["bounds"], serde_json::json!([0, null]));
    let [values, heights] = [&airborne["values"], &page.document["states"]["h"]];
    let [values, heights] = [values, heights].map(|it| it.as_array().expect("a list"));
    assert_eq!(values.len(), heights.len());
    assert!(values[1..].iter().zip(&heights[1..]).all(|(a, b)| number(a) == number(b)));
    assert_eq!(values[0], Value::Null, "a condition holds after the start");
}

/// Section 7 of the paper: what the controls do on the true system is drawn beside what was
/// planned, and a page of a thousand intervals is small enough to be sent.
#[test]
fn the_page_of_the_race_car_has_its_replay_and_is_small() {
    let page = page("page_racecar", &[], "racecar", &["--method", "sigma=0.1"]);
    assert!(page.text.len() < 400_000, "{} bytes", page.text.len());
    let replay = &page.document["verification"]["replay"];
    let last = |of: &Value| number(of.as_array().and_then(|it| it.last()).expect("a value"));
    let gap = last(&replay["states"]["pos.y"]) - last(&page.document["states"]["pos.y"]);
    let told = number(&page.document["verification"]["differs"]["difference"]);
    assert!((gap.abs() - told).abs() < 1e-5 * told, "{gap} is drawn, {told} is told");
    assert!(page.text.contains("key-replay\">replay on the true system"));
    assert!(number(&page.document["convergence"]["N"][0]) == 125.0);
}

/// The page runs what was run, not what the model would be without its options.
#[test]
fn the_page_says_how_it_is_run_again() {
    let text = RAMP.replace("model ramp", "model odd");
    let files: [(&str, &[u8]); 1] = [("odd.fdc", text.as_bytes())];
    let page = page("page_again", &files, "odd", &["--set", "goal=0.5", "--method", "N=12"]);
    let again = "<pre>fdcc solve odd.fdc --set goal=0.5 --method N=12 --out results\n\
                 fdcc verify results/odd.sol.json odd.fdc</pre>";
    assert!(page.markup().contains(again), "{}", page.markup());
    let command = &page.document["command"];
    let given = ["solve", "odd.fdc", "--set", "goal=0.5", "--method", "N=12"];
    assert_eq!(*command, serde_json::json!(given));
}

/// What was measured, over the curve of the model; what remains; what the estimates are worth.
#[test]
fn the_page_of_a_fit_has_its_data_and_its_estimates() {
    let page = page("page_fit", &[], "slider_fit", &[]);
    for told in ["<h2>Estimates</h2>", "0.3022114", "± 0.00136", "-0.9987", "key-points\">measured"]
    {
        assert!(page.markup().contains(told), "{told}: {}", page.markup());
    }
    let estimates = page.text.find("<h2>Estimates</h2>").expect("a table");
    assert!(estimates < page.text.find("<h2>States</h2>").expect("states"), "they come first");
    let x = &page.document["residuals"][0];
    let [data, deviation, value] =
        ["measured", "deviation", "values"].map(|key| number(&x[key][2]));
    // The third row of slider.csv.
    assert_eq!([data, deviation], [0.1246, 0.01]);
    let time = page.document["time"].as_array().expect("times");
    let at = time.iter().position(|it| number(it) >= 0.4).expect("the row is within");
    let model = number(&page.document["states"]["x"][at]);
    assert!((model - (data + value * deviation)).abs() < 2e-3, "{model}");
    let drawn = page.text.split("id=\"page\">").nth(1).expect("what is drawn");
    assert!(drawn.contains("\"kind\":\"points\"") && drawn.contains("\"kind\":\"stems\""));
    let svg = page.path.with_file_name("x.svg");
    let plot = ["plot", "slider_fit.sol.json", "--signal", "x", "--out", "x.svg"];
    let folder = page.path.parent().expect("a folder");
    expect_exit(&fdcc(folder, &plot, ""), 0, "plot");
    let svg = std::fs::read_to_string(svg).expect("it was written");
    assert_eq!(svg.matches("<circle").count(), 21, "{svg}");
}

/// Both are written in other ways: what was measured is found all the same.
#[test]
fn measurements_of_sums_and_of_deviations_that_are_formulas_are_found() {
    let text = |what: &str| {
        format!(
            "model drift\ndata obs = csv(\"obs.csv\") columns t, x\nparam s = 0.1\n\
             free v in [0, 5] guess 1\ntime t in [0, 2]\nstate x start 0\n\
             dynamics {{ x' = v*s*10 }}\n{what}\n"
        )
    };
    let residual = |test: &str, what: &str| {
        let text = text(what);
        let files: [(&str, &[u8]); 2] =
            [("drift.fdc", text.as_bytes()), ("obs.csv", b"t,x\n0,0.3\n1,0.9\n2,2.5\n")];
        page(test, &files, "drift", &[]).document["residuals"][0].clone()
    };
    let third = |it: &Value, key: &str| number(&it[key][2]);
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    let fit = residual("page_formula", "fit obs: x sd s + 0.1*abs(obs.x)");
    near(third(&fit, "measured"), 2.5);
    near(third(&fit, "deviation"), 0.35);
    let sum = residual("page_sum", "minimize sum(k in obs, 4*(2*k.x - x(k.t))^2)");
    near(third(&sum, "measured"), 5.0);
    near(third(&sum, "deviation"), 0.5);
    // v is the sum of t*2x over that of t^2: 11.8/5, so that x(2) is 4.72, 0.28 below.
    near(third(&sum, "values"), -0.56);
}

#[test]
fn names_of_a_model_and_its_text_are_no_markup() {
    let text = "model odd # </script><b>&\ntime t in [0, 1]\nstate x start 0\n\
                control u in [-1, 1]\ndynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)\n";
    let page = page("page_markup", &[("odd.fdc", text.as_bytes())], "odd", &[]);
    assert!(page.markup().contains("odd # &lt;/script&gt;&lt;b&gt;&amp;"));
    assert_eq!(page.document["source"].as_str(), Some(text));
}

fn solutions(test: &str) -> PathBuf {
    let folder = folder(test, &[("ramp.fdc", RAMP.as_bytes())]);
    let sweep =
        ["sweep", "ramp.fdc", "goal=1,2", "--out", "all", "--trajectories", "--log", "none"];
    expect_exit(&fdcc(&folder, &sweep, ""), 0, "sweep");
    folder
}

#[test]
fn several_solutions_stand_side_by_side() {
    let folder = solutions("page_report");
    let report = ["report", "all/ramp.1.sol.json", "all/ramp.2.sol.json"];
    let output = fdcc(&folder, &report, "");
    expect_exit(&output, 0, "report");
    assert_eq!(stdout(&output), " wrote report.html\n");
    let page = read(&folder.join("report.html"));
    assert_eq!(page.text.matches("<h1 ").count(), 2);
    assert!(page.text.contains("<dt>goal</dt><dd>2</dd>"), "what differs is told");
    assert!(page.text.contains("key-0\">ramp.1") && page.text.contains("key-1\">ramp.2"));
    for name in ["ramp.1", "ramp.2"] {
        let heading = format!("<h2>How it was solved <span class=\"of\">{name}</span></h2>");
        assert!(page.text.contains(&heading), "{heading}");
    }
    let drawn = page.text.split("id=\"page\">").nth(1).expect("what is drawn");
    let drawn: Value = serde_json::from_str(drawn.split("</script>").next().expect("it ends"))
        .expect("it is JSON");
    let curves = drawn["figures"][0]["curves"].as_array().expect("curves");
    let of: Vec<_> = curves.iter().map(|it| (it["of"].as_u64(), it["kind"].as_str())).collect();
    assert_eq!(of, [(Some(0), Some("line")), (Some(1), Some("line"))]);
}

/// The letters of a PDF are in it.
#[test]
fn pictures_for_papers_are_svg_or_pdf() {
    let folder = solutions("page_pdf");
    for (name, begin) in [("x.svg", "<svg"), ("x.pdf", "%PDF-")] {
        let plot = ["plot", "all/ramp.1.sol.json", "--signal", "x", "--out", name];
        expect_exit(&fdcc(&folder, &plot, ""), 0, name);
        let bytes = std::fs::read(folder.join(name)).expect("it was written");
        assert!(bytes.starts_with(begin.as_bytes()), "{name}");
        let has_letters = String::from_utf8_lossy(&bytes).contains("DejaVuSans");
        assert_eq!(has_letters, name == "x.pdf");
    }
}

#[test]
fn what_is_no_solution_is_refused() {
    let folder = solutions("page_refused");
    std::fs::write(folder.join("empty.json"), "{}").expect("it can be written");
    for (arguments, exit, says) in [
        (&["report", "missing.sol.json"][..], 4, "missing.sol.json cannot be read"),
        (&["report", "ramp.fdc"], 4, "ramp.fdc is not a solution"),
        (&["report", "empty.json"], 4, "empty.json is not a solution: it has no `time`"),
        (&["report", "x"].repeat(9)[1..], 3, ""),
        (&["report"], 3, "<SOLUTION>"),
        (&["plot", "all/ramp.1.sol.json", "--out", "x.png"], 3, "ends in .svg or .pdf"),
        (
            &["plot", "all/ramp.1.sol.json", "--signal", "y", "--out", "x.svg"],
            3,
            "no signal `y`; there are: x, u, double, costate(x), hamiltonian",
        ),
        (
            &[
                "plot",
                "all/ramp.1.sol.json",
                "--signal",
                "x",
                "--signal",
                "u",
                "--over",
                "x",
                "--out",
                "x.svg",
            ],
            3,
            "`--over` is for one `--signal`",
        ),
    ] {
        let output = fdcc(&folder, arguments, "");
        expect_exit(&output, exit, &format!("{arguments:?}"));
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    }
    assert!(!folder.join("x.svg").exists() && !folder.join("x.pdf").exists());
}

/// The corners of a straight line from (0, 0) to (1, 2), and of a constant: 2.
#[test]
fn signals_are_drawn_as_svg() {
    let folder = solutions("page_plot");
    let drawn = |more: &[&str]| {
        let plot = [&["plot", "all/ramp.2.sol.json", "--out", "p.svg"], more].concat();
        expect_exit(&fdcc(&folder, &plot, ""), 0, "plot");
        std::fs::read_to_string(folder.join("p.svg")).expect("it was written")
    };
    let lines = |svg: &str| -> Vec<Vec<[f64; 2]>> {
        let lines = svg.split("<polyline").skip(1).filter(|it| it.contains("#1F5FA8"));
        let points = |line: &str| {
            let points = line.split("points=\"").nth(1).and_then(|it| it.split('"').next());
            let place = |it: &str| {
                let (x, y) = it.split_once(',').expect("a pair");
                [x, y].map(|it| it.parse().expect("a number"))
            };
            points.expect("points").split_whitespace().map(place).collect()
        };
        lines.map(points).collect()
    };
    let both = drawn(&[]);
    assert!(both.contains("width=\"640\" height=\"420\" viewBox=\"0 0 2560 1680\""), "{both}");
    let all = lines(&both);
    assert_eq!(all.len(), 2, "a state and a control: {both}");
    let [state, control] = [&all[0], &all[1]];
    let slope = |a: [f64; 2], b: [f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let (first, last) = (state[0], state[state.len() - 1]);
    assert!(first[0] < last[0] && first[1] > last[1], "it rises: {state:?}");
    for pair in state.windows(2) {
        assert!((slope(pair[0], pair[1]) / slope(first, last) - 1.0).abs() < 0.01, "{state:?}");
    }
    assert!(control.iter().all(|it| it[1] == control[0][1]), "it is constant: {control:?}");
    let portrait = drawn(&["--signal", "u", "--over", "x"]);
    assert!(portrait.contains("viewBox=\"0 0 2560 1600\""));
    let costate = drawn(&["--signal", "costate(x)"]);
    assert!(costate.contains("viewBox=\"0 0 2560 840\""));
}
