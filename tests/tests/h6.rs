use fdcc_tests::models::*;
#[test] fn dbg() {
    let un = "time t in [0, 1] state x start 0 control u dynamics { x' = u } maximize x(end) method { grid N = 10 }";
    for p in [problem(un, &[], &[("solver","interior_point")]), problem(un, &[], &[]), load("racecar", &[("w", "-0.02")], &[("N", "100")]), load("racecar", &[("w", "-0.02")], &[("N", "100"),("linear","sparse_ldl")])] {
    let outcome = fdcc_runtime::homotopy::solve(&p, None, &mut |p, _| {if p.iteration%5==0 && (p.iteration<40 || p.iteration%500==0) {println!("{} {} {:.8} {:.2e} {:.2e} {:.2e} d{:.1e} reg{:.1e} {:.2e} {:.2e} {}", p.iteration, p.restoration, p.objective, p.primal_infeasibility, p.dual_infeasibility, p.mu, p.step, p.regularization, p.alpha_dual, p.alpha_primal, p.trials)}; std::ops::ControlFlow::Continue(())}).unwrap();
    println!("{:?} {} {:?} {:?} {:?}", outcome.solution.status, outcome.solution.objective, outcome.convex, outcome.solution.counts, outcome.limiting);
    }
}
