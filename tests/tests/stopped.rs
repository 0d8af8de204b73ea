//! Solves that are stopped, after so many questions whether to go on.

use fdcc::{Cases, Model, Options};
use fdcc_runtime::nlp::{Status, Stop};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

const SLIDE: &str = "param mu = 1\ntime t in [0, 2]\nstate x start 0\nstate v start 0
control u in [-9, 9]\nsurface slip = v\ndynamics { x' = v  v' in u - mu*Sgn(slip) }
end x == 1\nend v == 0\nminimize integral(u^2)";

fn slide() -> Model {
    Model::from_text("slide", SLIDE).expect("it is right")
}

/// Goes on so often.
struct Questions {
    asked: AtomicUsize,
    most: usize,
}

impl Questions {
    fn at_most(most: usize) -> Self {
        Questions { asked: AtomicUsize::new(0), most }
    }

    fn go_on(&self) -> ControlFlow<Stop> {
        match self.asked.fetch_add(1, Ordering::Relaxed) < self.most {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(Stop::Interrupted),
        }
    }

    fn asked(self) -> usize {
        self.asked.into_inner()
    }
}

/// Wherever it is stopped: certified, or interrupted; never a failed certificate, whose checks were
/// not made.
#[test]
fn a_search_for_the_true_optimum_that_is_stopped_says_so() {
    let model = slide();
    let whole = Questions::at_most(usize::MAX);
    let options = Options { stop: &|| whole.go_on(), ..Options::default() };
    assert!(model.solve(&options).expect("it can be solved").is_certified());
    let count = whole.asked();
    let mut located = 0;
    for most in (0..100).step_by(4).chain([count / 2, count - 1]) {
        let questions = Questions::at_most(most);
        let options = Options { stop: &|| questions.go_on(), ..Options::default() };
        let found = model.solve(&options).expect("it can be solved");
        let is_stopped = *found.status() == Status::Interrupted;
        assert!(is_stopped || found.is_certified(), "{most} of {count}: {}", found.status_name());
        located += usize::from(is_stopped && found.certificate.is_some());
    }
    assert!(located > 2, "the search itself was stopped {located} times");
}

/// What all cases begin at is not solved in the time of the first of them.
#[test]
fn a_case_does_not_pay_for_what_all_begin_at() {
    let asked = |is_prepared: bool| {
        let case = Cases::new(&slide()).case(&[("mu", 0.9.into())]).expect("it is a parameter");
        if is_prepared {
            case.prepare(&Options::default());
        }
        let questions = Questions::at_most(usize::MAX);
        let options = Options { stop: &|| questions.go_on(), ..Options::default() };
        let objective = case.solve(&options).expect("it can be solved").objective();
        (questions.asked(), objective)
    };
    let [(alone, one), (after, other)] = [asked(false), asked(true)];
    assert!(after < alone, "{after} and {alone}");
    assert_eq!(one, other);
}
