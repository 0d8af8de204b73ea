//! Smoothing kernels: their limits, symmetry and order, and their derivatives as machine code.

use fdcc_compiler::builtins::Builtin;
use fdcc_compiler::graph::derivative;
use fdcc_compiler::graph::{ExprId, Graph, evaluate};
use fdcc_compiler::kernels::{self, KERNELS};
use fdcc_runtime::problem::Columns;
use fdcc_tests::functions::{check_differences, check_machine_code};
use fdcc_tests::random::Random;
use fdcc_tests::symbols::{compile, function, states_and_parameters, table};

/// Expressions of z and sigma at some values, with the derivatives by z.
fn at(graph: &Graph, expr: ExprId, z: f64, sigma: f64) -> f64 {
    evaluate(graph, &[expr], &[z, sigma], &[])[0]
}

#[test]
fn every_kernel_is_compiled_to_what_it_means_with_exact_derivatives() {
    for kernel in &KERNELS {
        let mut graph = Graph::new();
        let (z, sigma) = (graph.input(0), graph.input(1));
        let step = kernels::step(&mut graph, kernel, z, sigma);
        let absolute = kernels::absolute(&mut graph, kernel, z, sigma);
        let symbols = function(&mut graph, vec![step, absolute], states_and_parameters(1, 1));
        let compiled = compile(&graph, &symbols);
        let mut points = Columns::new(1, 7);
        // Not within a step of a difference of the ends of a compact kernel.
        points.column_mut(0).copy_from_slice(&[-3.0, -0.9, -0.4, 0.0, 0.3, 0.7, 2.5]);
        let multipliers = table(&mut Random::new(9), 2, 7, -1.0, 1.0);
        check_machine_code(&graph, &symbols, &*compiled, &points, &[1.5], &multipliers, 1e-14)
            .and_then(|()| {
                check_differences(&*compiled, &[0, 1], &points, &[1.5], &multipliers, 1e-8)
            })
            .unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
    }
}

#[test]
fn every_step_is_odd_rises_to_one_and_is_the_slope_of_its_absolute_value() {
    for kernel in &KERNELS {
        let mut graph = Graph::new();
        let (z, sigma) = (graph.input(0), graph.input(1));
        let step = kernels::step(&mut graph, kernel, z, sigma);
        let absolute = kernels::absolute(&mut graph, kernel, z, sigma);
        let slope = derivative(&mut graph, absolute, 0);
        let name = kernel.name;
        for sigma in [1.0, 0.1, 0.001] {
            assert_eq!(at(&graph, step, 0.0, sigma), 0.0, "{name}");
            for k in 1..200 {
                let z = 0.013 * sigma * f64::from(k);
                let value = at(&graph, step, z, sigma);
                assert!(
                    (value + at(&graph, step, -z, sigma)).abs() < 1e-15,
                    "{name} is odd at {z}"
                );
                assert!(
                    (at(&graph, slope, z, sigma) - value).abs() < 1e-12,
                    "{name}: slope at {z}"
                );
                assert!(
                    (at(&graph, slope, -z, sigma) + value).abs() < 1e-12,
                    "{name}: slope at -{z}"
                );
                assert!(value >= at(&graph, step, 0.99 * z, sigma), "{name} rises at {z}");
                assert!(value <= 1.0 + 1e-15, "{name} stays below 1 at {z}");
            }
        }
    }
}

/// `S(|z|/sigma) z/|z|` off 0, and through 0 with exact first and second derivatives.
#[test]
fn every_direction_is_the_step_along_its_vector() {
    for kernel in &KERNELS {
        let mut graph = Graph::new();
        let (x, y, sigma) = (graph.input(0), graph.input(1), graph.input(2));
        let direction = kernels::direction(&mut graph, kernel, &[x, y], sigma);
        let step = kernels::step(&mut graph, kernel, x, sigma);
        for length in [0.01, 0.13, 0.15, 0.7, 0.99, 1.01, 3.0] {
            let along = evaluate(&graph, &[step], &[0.2 * length, 0.0, 0.2], &[])[0];
            let values = evaluate(&graph, &direction, &[0.12 * length, -0.16 * length, 0.2], &[]);
            let error = (values[0] - 0.6 * along).hypot(values[1] + 0.8 * along);
            assert!(error < 1e-15, "{}: {values:?} at {length}", kernel.name);
        }
        let symbols = function(&mut graph, direction, states_and_parameters(2, 1));
        let compiled = compile(&graph, &symbols);
        let mut points = Columns::new(2, 6);
        points.column_mut(0).copy_from_slice(&[0.0, 0.2, -0.15, 0.5, 1.9, 0.0]);
        points.column_mut(1).copy_from_slice(&[0.0, 0.1, 0.14, -0.6, 0.3, 0.4]);
        let multipliers = table(&mut Random::new(9), 2, 6, -1.0, 1.0);
        check_machine_code(&graph, &symbols, &*compiled, &points, &[1.5], &multipliers, 1e-13)
            .and_then(|()| {
                check_differences(&*compiled, &[0, 1, 2], &points, &[1.5], &multipliers, 1e-8)
            })
            .unwrap_or_else(|error| panic!("{}: {error}", kernel.name));
    }
}

/// The distance to the sign at a fixed z shrinks with sigma as fast as each formula says.
#[test]
fn every_step_approaches_the_sign_at_its_own_order() {
    for kernel in &KERNELS {
        let mut graph = Graph::new();
        let (z, sigma) = (graph.input(0), graph.input(1));
        let step = kernels::step(&mut graph, kernel, z, sigma);
        let absolute = kernels::absolute(&mut graph, kernel, z, sigma);
        for width in [0.1_f64, 0.05, 0.025] {
            // 1 - tanh u = 2/(exp(2u) + 1); 1 - u/sqrt(u^2+1) <= 1/(2u^2); compact kernels are
            // exact.
            let bound = match kernel.name {
                "tanh" => 2.0 / ((2.0 / width).exp() + 1.0) + 1e-15,
                "sqrt" => 0.5 * width * width,
                _ => 0.0,
            };
            let error = 1.0 - at(&graph, step, 1.0, width);
            assert!((0.0..=bound).contains(&error), "{}: {error} at {width}", kernel.name);
            // |z|_sigma is exact far away, and off by sigma times a constant at 0: at most sigma.
            let far = at(&graph, absolute, -1.0, width) - 1.0;
            assert!((-1e-15..=0.5 * width * width + 1e-8).contains(&far), "{}: {far}", kernel.name);
            assert!((0.0..=width).contains(&at(&graph, absolute, 0.0, width)), "{}", kernel.name);
        }
    }
}

#[test]
fn smoothing_leaves_no_kink_and_tends_to_what_it_replaces() {
    for kernel in &KERNELS {
        let mut graph = Graph::new();
        let (x, y, sigma) = (graph.input(0), graph.input(1), graph.input(2));
        let magnitude = graph.abs(x);
        let smaller = graph.min(magnitude, y);
        let root = graph.max(smaller, x);
        let smoothed = kernels::smooth_nonsmooth(&mut graph, &[root], kernel, sigma)[0];
        let kinks = graph.reachable(&[smoothed]).into_iter().filter(|&id| {
            [Builtin::Abs, Builtin::Min, Builtin::Max]
                .iter()
                .any(|&kink| graph.as_call(id, kink).is_some())
        });
        assert_eq!(kinks.count(), 0, "{}", kernel.name);
        for z in [[-0.7, 0.2, 1e-6], [0.3, 0.9, 1e-6], [0.4, -0.8, 1e-6]] {
            let values = evaluate(&graph, &[root, smoothed], &z, &[]);
            assert!((values[0] - values[1]).abs() < 1e-5, "{}: {values:?}", kernel.name);
        }
    }
}
