use fdcc_tests::models::*;
#[test] fn dbg() {
    for text in ["time t in [0, 1] state x start 0 control u in [-1, 0] dynamics { x' = u } minimize integral(-u^2)", 
     "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics { x' = u*x + u } minimize x(end)^2", &text_of("coulomb_energy")] {
        let p = problem(text, &[], &[("solver","interior_point")]);
    let mut last = String::new();
    let outcome = fdcc_runtime::homotopy::solve(&p, None, &mut |p, _| {println!("{} {} {:.8} {:.2e} {:.2e} {:.2e} d{:.1e} reg{:.1e} {:.2e} {:.2e} {}", p.iteration, p.restoration, p.objective, p.primal_infeasibility, p.dual_infeasibility, p.mu, p.step, p.regularization, p.alpha_dual, p.alpha_primal, p.trials); std::ops::ControlFlow::Continue(())}).unwrap();
    last.push('a');
    println!("{:?} {} {:?} {:?}", outcome.solution.status, outcome.solution.objective, outcome.convex, outcome.solution.counts);
    }
}
