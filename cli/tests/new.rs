//! `fdcc new` from outside: every template is right, in the canonical layout, and can be solved.

use crate::common::*;
use std::fs;

#[test]
fn templates_are_models_that_work() {
    for template in ["friction", "racecar", "switched", "fit", "bounce"] {
        let place = folder(&format!("new_{template}"), &[]);
        let file = format!("{template}.fdc");
        let written = fdcc(&place, &["new", template], "");
        expect_exit(&written, 0, template);
        assert!(
            stdout(&written).contains(&format!("fdcc check {file}")),
            "it says what to do next"
        );
        expect_exit(&fdcc(&place, &["check", "--deny", "warnings", &file], ""), 0, template);
        expect_exit(&fdcc(&place, &["fmt", "--check", &file], ""), 0, template);
        let result = fdcc(&place, &["solve", &file, "--json", "--log", "none"], "");
        expect_exit(&result, 0, template);
        assert_eq!(json(&result)["status"], "solved", "{template}");
    }
}

/// Not by chance: with one step more, and with coarser and finer grids, too.
#[test]
fn solutions_of_templates_hold_on_the_true_system() {
    for template in ["friction", "racecar", "switched", "fit", "bounce"] {
        let place = folder(&format!("new_confirmed_{template}"), &[]);
        let file = format!("{template}.fdc");
        expect_exit(&fdcc(&place, &["new", template], ""), 0, template);
        let own = json(&fdcc(&place, &["solve", &file, "--json", "--log", "none"], ""));
        let steps = own["method"]["N"].as_u64().expect("the method has steps");
        for steps in [steps, steps + 1, steps * 4 / 5, steps * 5 / 4] {
            let steps = format!("N={steps}");
            let solved = fdcc(&place, &["solve", &file, "--method", &steps, "--log", "none"], "");
            expect_exit(&solved, 0, &steps);
            let verdict = stdout(&solved) + &stderr(&solved);
            assert!(
                ["confirmed on the true system", "optimum of the true system"]
                    .iter()
                    .any(|it| verdict.contains(it)),
                "{template}, {steps}: {verdict}"
            );
        }
    }
}

#[test]
fn a_model_is_called_after_its_file_and_nothing_is_overwritten() {
    let place = folder("new_name", &[("taken.fdc", b"param a = 1\n")]);
    fs::create_dir(place.join("folder")).expect("a folder can be made");
    let read = |name: &str| fs::read_to_string(place.join(name)).expect("it is there");
    expect_exit(&fdcc(&place, &["new", "friction", "sled.fdc"], ""), 0, "a file");
    assert!(
        read("sled.fdc").contains("\nmodel sled\n")
            && read("sled.fdc").contains("fdcc solve sled.fdc")
    );
    expect_exit(&fdcc(&place, &["new", "friction", "my sled.fdc"], ""), 0, "no name of a model");
    assert!(read("my sled.fdc").contains("\nmodel friction\n"));
    expect_exit(&fdcc(&place, &["new", "fit", "folder"], ""), 0, "a folder");
    assert!(read("folder/fit.fdc").contains("\nmodel fit\n"));
    let refused = fdcc(&place, &["new", "friction", "taken.fdc"], "");
    expect_exit(&refused, 4, "taken");
    assert!(stderr(&refused).contains("taken.fdc exists already"));
    assert_eq!(read("taken.fdc"), "param a = 1\n");
    expect_exit(&fdcc(&place, &["new", "friction", "nowhere/x.fdc"], ""), 4, "no such folder");
    expect_exit(&fdcc(&place, &["new", "sandwich"], ""), 3, "no such template");
}

#[test]
fn without_a_template_they_are_listed() {
    let place = folder("new_list", &[]);
    let listed = fdcc(&place, &["new"], "");
    expect_exit(&listed, 3, "no template");
    for line in ["  friction  A slide with dry friction", "  bounce    A ball that bounces"] {
        assert!(stderr(&listed).contains(line), "{}", stderr(&listed));
    }
}
