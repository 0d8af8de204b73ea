//! `phase run for each csv("runs*.csv")`: a phase for each file that matches, with what is shared
//! and what is of each; which files match, and what is told of them, once.

use fdcc::language::Reading;
use fdcc::{Checked, DataFiles, Options};
use fdcc_grammar::{Code, ParseCache, Severity};
use std::fs;

/// A column moves at a speed that all runs share, from a place of its own.
const RUNS: &str = "free speed in [0, 9] guess 1
phase run for each csv(\"run*.csv\") columns t, x {
  free first in [-9, 9]
  time t in [0, run.t(end)]
  state x start first
  dynamics { x' = speed }
  fit run: x sd 0.1
}
method { grid N = 10 scheme gauss3 }";

/// Files by their names.
fn files(texts: &[(&str, &str)]) -> DataFiles {
    let own = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
    let texts: Vec<(String, String)> = texts.iter().map(own).collect();
    let names: Vec<String> = texts.iter().map(|it| it.0.clone()).collect();
    let text = move |name: &str| {
        let found = texts.iter().find(|it| it.0 == name);
        found.map(|it| it.1.clone()).ok_or_else(|| "it is not there".to_owned())
    };
    DataFiles::from(text).with_names(move |_| Ok(names.clone()))
}

const FIRST: (&str, &str) = ("run2.csv", "t,x\n0,1.1\n1,2.9\n2,5.1\n");
const SECOND: (&str, &str) = ("run10.csv", "t,x\n0,-0.9\n1,1.1\n2,2.8\n3,5.2\n4,7\n");

fn checked(text: &str, texts: &[(&str, &str)]) -> Checked {
    fdcc::check_with("runs", text.into(), Some(files(texts)))
}

/// The lines of code and message, and what is advised.
fn told(text: &str, texts: &[(&str, &str)]) -> Vec<(Code, String, String)> {
    let found = checked(text, texts).diagnostics;
    let line = |it: &fdcc_grammar::Diagnostic| {
        (it.code, it.message.clone(), it.help.clone().unwrap_or_default())
    };
    found.iter().map(line).collect()
}

/// Written out by hand it is the same problem, to the last bit.
#[test]
fn a_phase_for_each_file_is_as_many_phases() {
    let by_hand = "free speed in [0, 9] guess 1
        data a = csv(\"run2.csv\") columns t, x
        data b = csv(\"run10.csv\") columns t, x
        phase one {
          free first in [-9, 9]
          time t in [0, 2]
          state x start first
          dynamics { x' = speed }
          fit a: x sd 0.1
        }
        phase two like one {
          time t in [0, 4]
          fit b: x sd 0.1
        }
        method { grid N = 10 scheme gauss3 }";
    let solve = |text: &str| {
        let model = checked(text, &[SECOND, FIRST, ("other.csv", "")]).into_model();
        model.expect("it has no mistake").solve(&Options::default()).expect("it can be solved")
    };
    let (each, hand) = (solve(RUNS), solve(by_hand));
    assert!(each.is_solved() && hand.is_solved());
    assert_eq!(each.objective(), hand.objective());
    for (name, same) in
        [("speed", "speed"), ("run[1].first", "one.first"), ("run[2].first", "two.first")]
    {
        assert_eq!(each.value(name), hand.value(same), "{name}");
    }
    let residuals = each.estimates().expect("it is a fit").residuals;
    let of: Vec<(Option<&str>, &str)> =
        residuals.iter().map(|it| (it.phase.as_deref(), it.data.as_str())).collect();
    assert_eq!(of, [(Some("run[1]"), "run2.csv"), (Some("run[2]"), "run10.csv")]);
}

/// Least squares by hand: x_i = first_r + speed t_i, with the slope of both runs together.
#[test]
fn runs_share_what_is_declared_outside() {
    let model = checked(RUNS, &[FIRST, SECOND]).into_model().expect("it has no mistake");
    let solution = model.solve(&Options::default()).expect("it can be solved");
    let runs = [&[1.1, 2.9, 5.1][..], &[-0.9, 1.1, 2.8, 5.2, 7.0]];
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let sums = runs.map(|x| {
        let middle = (x.len() - 1) as f64 / 2.0;
        let off = |at: usize| at as f64 - middle;
        let squares: f64 = (0..x.len()).map(|at| off(at).powi(2)).sum();
        let products: f64 = (0..x.len()).map(|at| off(at) * (x[at] - mean(x))).sum();
        [squares, products, mean(x), middle]
    });
    let speed = (sums[0][1] + sums[1][1]) / (sums[0][0] + sums[1][0]);
    let value = |name: &str| solution.value(name).expect("it is declared");
    assert!((value("speed") - speed).abs() < 1e-8, "{}", value("speed"));
    for (name, sum) in ["run[1].first", "run[2].first"].iter().zip(sums) {
        assert!((value(name) - (sum[2] - speed * sum[3])).abs() < 1e-8, "{name}");
    }
}

#[test]
fn a_mistake_within_is_told_once_and_one_of_a_file_with_its_name() {
    let wrong = RUNS.replace("x' = speed", "x' = speeed");
    let found = told(&wrong, &[FIRST, SECOND]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].1.contains("`speeed`"));

    let bad = [FIRST, SECOND, ("run11.csv", "t,x\n0,1\n1,nan\n"), ("run12.csv", "t,x\n0,1\n2\n")];
    let found = told(RUNS, &bad);
    let messages: Vec<&str> = found.iter().map(|it| it.1.as_str()).collect();
    let [fields, number] = messages[..] else { panic!("{messages:?}") };
    assert!(fields.starts_with("`run12.csv`: line 3 has 1 fields"), "{fields}");
    assert!(number.starts_with("`run11.csv`: line 3: `nan` stands where `x`"), "{number}");
}

/// Files that lack the same column, and files each with another line that is wrong.
#[test]
fn of_many_files_a_few_are_told_and_how_many_more() {
    let names: Vec<String> = (1..=9).map(|at| format!("run{at}.csv")).collect();
    let texts = |text: fn(usize) -> String| -> Vec<String> { (1..=9).map(text).collect() };
    let of = |texts: &[String]| {
        let pairs: Vec<(&str, &str)> =
            names.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
        told(RUNS, &pairs)
    };
    let found = of(&texts(|_| "t,y\n0,1\n1,2\n".into()));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].1.starts_with("`run1.csv`: there is no column `x`"));
    assert!(found[0].2.ends_with("8 more files have the same mistake"), "{}", found[0].2);

    let found = of(&texts(|at| format!("t,x\n{}0,q\n", "0,1\n".repeat(at))));
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found[2].2.ends_with("6 more files have the same mistake"), "{}", found[2].2);

    let found = of(&texts(|_| "t,x\n1,1\n0,1\n2,1\n".into()));
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found[0].1.starts_with("line 3 of `run1.csv`"), "{}", found[0].1);
}

#[test]
fn a_row_beyond_the_time_of_its_phase_is_told_by_check() {
    let short = RUNS.replace("run.t(end)]", "3]");
    let found = told(&short, &[FIRST, SECOND]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(
        (found[0].0, &*found[0].1),
        (Code::RowBeyondTime, "line 6 of `run10.csv` is beyond the time of the model")
    );
}

#[test]
fn a_pattern_without_files_says_what_there_is() {
    let found = told(RUNS, &[("trial1.csv", ""), ("trial2.csv", ""), ("notes.txt", "")]);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!((found[0].0, &*found[0].1), (Code::DataFile, "no file matches `run*.csv`"));
    assert!(found[0].2.contains("`trial1.csv`, `trial2.csv`") && !found[0].2.contains("notes"));

    let unlisted = DataFiles::from(|_| Ok("t,x\n0,1\n".into()));
    let found = fdcc::check_with("runs", RUNS.into(), Some(unlisted)).diagnostics;
    assert_eq!(found.iter().map(|it| it.code).collect::<Vec<_>>(), [Code::DataFile]);

    let many = DataFiles::from(|_| Ok("t,x\n0,1\n".into()))
        .with_names(|_| Ok((0..501).map(|at| format!("run{at}.csv")).collect()));
    let found = fdcc::check_with("runs", RUNS.into(), Some(many)).diagnostics;
    assert_eq!(found.iter().map(|it| it.code).collect::<Vec<_>>(), [Code::DataFile]);
    assert_eq!(found[0].message, "501 files match `run*.csv`");
}

/// One file needs no list of names.
#[test]
fn a_name_that_is_no_pattern_is_one_file() {
    let one = RUNS.replace("run*.csv", "run2.csv");
    let files = DataFiles::from(|_| Ok(FIRST.1.into()));
    let model = fdcc::check_with("runs", one.into(), Some(files)).into_model();
    assert!(model.expect("it has no mistake").meaning().phases.len() == 1);
}

/// Without data files it waits, with as many phases as it speaks of.
#[test]
fn a_text_without_its_files_is_checked() {
    let text = format!("{RUNS}\nend run[3].x <= 9");
    let found = fdcc::check("runs", text.into());
    let severities: Vec<(Code, Severity)> =
        found.diagnostics.iter().map(|it| (it.code, it.severity)).collect();
    assert_eq!(severities, [(Code::NotYet, Severity::Advice)], "{:?}", found.diagnostics);
}

#[test]
fn editors_are_told_which_phase_has_which_file() {
    let files = files(&[SECOND, FIRST]);
    let reading = Reading::new(RUNS, &mut ParseCache::default(), Some(&files));
    assert_eq!(reading.files_of("run"), [("run[1]", "run2.csv"), ("run[2]", "run10.csv")]);
    let values = reading.information(Some("run"), "x").expect("it is known").values;
    assert!(!values.is_empty());
}

/// Names below the folder alone, also through links, folders and dots.
#[test]
fn only_what_lies_in_the_folder_matches() {
    let folder = std::env::temp_dir().join(format!("fdcc-experiments-{}", std::process::id()));
    let inner = folder.join("inner");
    for place in ["inner/one", "inner/two", "inner/.hidden", "outer"] {
        fs::create_dir_all(folder.join(place)).expect("a folder can be made");
        fs::write(folder.join(place).join("run1.csv"), FIRST.1).expect("a file can be written");
    }
    #[cfg(unix)]
    std::os::unix::fs::symlink(folder.join("outer"), inner.join("three")).expect("a link");
    let files = DataFiles::in_folder(&inner);
    let data = |pattern: &str| {
        let text = RUNS.replace("run*.csv", pattern);
        let checked = fdcc::check_with("runs", text.into(), Some(files.clone()));
        let errors = checked.diagnostics.iter().map(|it| it.code).collect::<Vec<_>>();
        let model = checked.into_model();
        let names = model.map(|it| it.data().expect("they are there"));
        (names.map_or(Vec::new(), |all| all.into_iter().map(|it| it.0).collect()), errors)
    };
    let found: Vec<String> = data("*/run?.csv").0;
    assert_eq!(found, ["one/run1.csv", "two/run1.csv"]);
    assert_eq!(data("two/r*").0, ["two/run1.csv"]);
    for outside in ["../outer/*.csv", "/*.csv", "*.csv", "three/*.csv", "inner/*/run1.csv"] {
        assert_eq!(data(outside), (Vec::new(), vec![Code::DataFile]), "{outside}");
    }
    fs::remove_dir_all(&folder).expect("it can be removed");
}
