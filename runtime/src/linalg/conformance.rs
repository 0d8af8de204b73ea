//! What every factorisation must do, on random chains of stages: solve its system, and know its
//! inertia.

use super::products::Products;
use super::riccati::Riccati;
use super::sparse_ldl::SparseLdl;
use super::structure::factor::{Factor, Inertia};
use super::structure::stages::Stages;
use super::structure::triplets::{Family, Triplets};
use crate::random::Random;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// A random problem: structure, values and diagonals.
pub(super) struct Case {
    pub(super) stages: Stages,
    pub(super) hessian: Triplets,
    pub(super) jacobian: Triplets,
    pub(super) hessian_values: Vec<f64>,
    pub(super) jacobian_values: Vec<f64>,
    pub(super) sigma: Vec<f64>,
    pub(super) d: Vec<f64>,
    pub(super) fixed: Vec<bool>,
}

impl Case {
    /// Full blocks; curvature of both signs, strong enough to matter if `indefinite`.
    pub(super) fn new(
        stages: Stages,
        coupled_ends: bool,
        penalised: bool,
        indefinite: bool,
        random: &mut Random,
    ) -> Self {
        let hessian = hessian_structure(stages, coupled_ends);
        let jacobian = jacobian_structure(stages);
        let scale = if indefinite { 1.0 } else { 0.05 };
        let hessian_values =
            random.vector(hessian.len()).iter().map(|value| scale * value).collect();
        let jacobian_values = diagonally_dominant(&jacobian, stages, random);
        let sigma =
            random.vector(stages.variables()).iter().map(|value| 1.0 + 0.5 * value).collect();
        let d =
            (0..stages.rows()).map(|row| row_diagonal(stages, row, penalised, random)).collect();
        let mut fixed = vec![false; stages.variables()];
        fixed[0] = true;
        if stages.controls > 1 {
            fixed[stages.control(1 % stages.intervals).start] = true;
        }
        Case { stages, hessian, jacobian, hessian_values, jacobian_values, sigma, d, fixed }
    }

    fn dense(&self) -> DMatrix<f64> {
        let (variables, size) =
            (self.stages.variables(), self.stages.variables() + self.stages.rows());
        let mut matrix = DMatrix::zeros(size, size);
        for ((i, j), value) in self.hessian.entries().zip(&self.hessian_values) {
            matrix[(i, j)] += value;
            if i != j {
                matrix[(j, i)] += value;
            }
        }
        for ((i, j), value) in self.jacobian.entries().zip(&self.jacobian_values) {
            matrix[(variables + i, j)] += value;
            matrix[(j, variables + i)] += value;
        }
        for i in 0..variables {
            matrix[(i, i)] += self.sigma[i];
        }
        for row in 0..self.stages.rows() {
            matrix[(variables + row, variables + row)] -= self.d[row];
        }
        for i in (0..variables).filter(|i| self.fixed[*i]) {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1.0;
        }
        matrix
    }

    /// Whether it has a solution and an inertia to speak of.
    pub(super) fn is_regular(&self) -> bool {
        let eigenvalues = SymmetricEigen::new(self.dense()).eigenvalues;
        eigenvalues.iter().all(|value| value.abs() > 1e-10)
    }

    /// `[H J'; J 0] x`, entry by entry.
    fn times(&self, x: &[f64]) -> Vec<f64> {
        let (variables, mut y) = (self.stages.variables(), vec![0.0; x.len()]);
        let mut add = |row: usize, column: usize, value: f64| {
            y[row] += value * x[column];
            if row != column {
                y[column] += value * x[row];
            }
        };
        let hessian = self.hessian.entries().zip(&self.hessian_values);
        hessian.for_each(|((row, column), value)| add(row, column, *value));
        let jacobian = self.jacobian.entries().zip(&self.jacobian_values);
        jacobian.for_each(|((row, column), value)| add(variables + row, column, *value));
        y
    }

    /// The law: `K x = b` and inertia = signs of the eigenvalues.
    pub(super) fn check(
        &self,
        name: &str,
        factor: &mut dyn Factor,
        refinements: usize,
        random: &mut Random,
    ) {
        let dense = self.dense();
        let eigenvalues = SymmetricEigen::new(dense.clone()).eigenvalues;
        let positive = eigenvalues.iter().filter(|value| **value > 0.0).count();
        let expected =
            if positive == self.stages.variables() { Inertia::Correct } else { Inertia::Wrong };
        let found =
            factor.factor(&self.hessian_values, &self.jacobian_values, &self.sigma, &self.d);
        assert_eq!(found, expected, "{name}: inertia of {:?}", self.stages);
        if found != Inertia::Correct {
            return;
        }
        let mut right = DVector::from_vec(random.vector(dense.nrows()));
        (0..self.fixed.len()).filter(|i| self.fixed[*i]).for_each(|i| right[i] = 0.0);
        let mut solution = DVector::zeros(dense.nrows());
        for _ in 0..=refinements {
            let mut correction = (&right - &dense * &solution).as_slice().to_vec();
            factor.solve(&mut correction);
            solution += DVector::from_vec(correction);
        }
        let residual = (&dense * &solution - &right).amax();
        assert!(
            residual < 1e-9 * (1.0 + solution.amax()),
            "{name}: residual {residual} for {:?}",
            self.stages
        );
    }
}

fn hessian_structure(stages: Stages, coupled_ends: bool) -> Triplets {
    let (n, step, globals) = (stages.states, stages.variable_step(), stages.globals());
    let mut families = Vec::new();
    for i in 0..step + n {
        for j in 0..=i {
            families.push(Family {
                row: i,
                column: j,
                row_step: step,
                column_step: step,
                count: stages.intervals,
            });
        }
    }
    for g in globals.clone() {
        for j in 0..step + n {
            families.push(Family {
                row: g,
                column: j,
                row_step: 0,
                column_step: step,
                count: stages.intervals,
            });
        }
        for other in globals.start..=g {
            families.push(Family {
                row: g,
                column: other,
                row_step: 0,
                column_step: 0,
                count: stages.intervals,
            });
        }
    }
    let ends: Vec<usize> = stages.state(stages.intervals).chain(globals).collect();
    for (i, &row) in ends.iter().enumerate() {
        families.extend(ends[..=i].iter().map(|&column| Family::single(row, column)));
        if coupled_ends {
            families.extend(stages.state(0).map(|column| Family::single(row, column)));
        }
    }
    Triplets { families }
}

fn jacobian_structure(stages: Stages) -> Triplets {
    let (n, step) = (stages.states, stages.variable_step());
    let mut families = Vec::new();
    for row in 0..stages.row_step() {
        let family = |column, column_step| Family {
            row,
            column,
            row_step: stages.row_step(),
            column_step,
            count: stages.intervals,
        };
        families.extend((0..step + n).map(|column| family(column, step)));
        families.extend(stages.globals().map(|column| family(column, 0)));
    }
    for row in stages.coupling() {
        let columns = stages.state(0).chain(stages.state(stages.intervals)).chain(stages.globals());
        families.extend(columns.map(|column| Family::single(row, column)));
    }
    Triplets { families }
}

/// Random values; the blocks `E` get a strong diagonal so that the chain is well conditioned.
fn diagonally_dominant(jacobian: &Triplets, stages: Stages, random: &mut Random) -> Vec<f64> {
    let strong = |i: usize, j: usize| {
        let k = i / stages.row_step();
        k < stages.intervals
            && i % stages.row_step() < stages.defect_rows()
            && j == stages.inner(k).start + i % stages.row_step()
    };
    jacobian
        .entries()
        .map(|(i, j)| 0.5 * random.next() + if strong(i, j) { 2.0 } else { 0.0 })
        .collect()
}

fn row_diagonal(stages: Stages, row: usize, penalised: bool, random: &mut Random) -> f64 {
    let local = row < stages.coupling().start && row % stages.row_step() >= stages.defect_rows();
    if local || penalised { 1.0 + 0.5 * random.next() } else { 0.0 }
}

#[test]
fn both_factorisations_solve_their_system_and_know_its_inertia() {
    let mut random = Random(7);
    let mut both = [0, 0];
    for case in 0..240 {
        // Sizes that are compiled as constants, and any.
        let (states, controls, globals, coupling_constraints) = match case % 10 {
            7 => (5, 2, 1, 0),
            8 => (4, 1, 1, 2),
            _ => (1 + case % 3, case % 4, case % 3, if case % 4 == 0 { 0 } else { (case / 3) % 2 }),
        };
        let (intervals, local_constraints) = (1 + (case / 10) % 5, (case / 2) % 3);
        let inner = if case % 3 == 1 { (case / 6) % 4 } else { 0 };
        let stages = Stages {
            intervals,
            states,
            controls,
            inner,
            globals,
            local_constraints,
            coupling_constraints,
        };
        let case = Case::new(stages, case % 5 == 0, case % 7 == 0, case % 2 == 0, &mut random);
        let equality: Vec<bool> = case.d.iter().map(|d| *d == 0.0).collect();
        let riccati = || {
            Riccati::new(stages, &case.hessian, &case.jacobian, &case.fixed, &equality)
                .expect("a chain")
        };
        let (mut plain, mut riccati) = (riccati().without_fused(), riccati());
        let mut ldl = SparseLdl::new(&case.hessian, &case.jacobian, &case.fixed, stages.rows());
        case.check("riccati", &mut riccati, 1, &mut random);
        case.check("riccati on an older machine", &mut plain, 1, &mut random);
        case.check("sparse LDL", &mut ldl, 1, &mut random);
        both[usize::from(
            riccati.factor(&case.hessian_values, &case.jacobian_values, &case.sigma, &case.d)
                == Inertia::Correct,
        )] += 1;
    }
    assert!(both[0] > 20 && both[1] > 100, "the cases must be of both kinds: {both:?}");
}

/// Of chains whose last batch is full and not, and of what is no chain.
#[test]
fn products_are_those_of_all_entries() {
    let mut random = Random(11);
    for case in 0..48 {
        let (intervals, inner) = ([1, 2, 5, 15, 16, 17, 32, 40][case % 8], case % 2);
        let stages = Stages {
            intervals,
            states: 1 + case % 3,
            controls: case % 3,
            inner,
            globals: case / 8 % 2,
            local_constraints: 1,
            coupling_constraints: 1,
        };
        let is_linear = case % 7 == 0;
        let mut case = Case::new(stages, case % 5 == 0, false, true, &mut random);
        if is_linear {
            (case.hessian, case.hessian_values) = (Triplets::default(), Vec::new());
        }
        let x = random.vector(stages.variables() + stages.rows());
        let (v, w) = x.split_at(stages.variables());
        let expected = case.times(&x);
        let products = |stages| Products::new(stages, &case.hessian, &case.jacobian);
        for mut products in
            [products(Some(stages)), products(Some(stages)).without_fused(), products(None)]
        {
            let mut found = vec![0.0; x.len()];
            let (a, b) = found.split_at_mut(stages.variables());
            products.multiply_add((&case.hessian_values, &case.jacobian_values), (v, w), (a, b));
            let worst = found
                .iter()
                .zip(&expected)
                .fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
            assert!(worst < 1e-13, "{worst} for {stages:?}");
            let mut gradient = vec![0.0; v.len()];
            products.transposed_multiply_add(&case.jacobian_values, w, &mut gradient);
            let mut expected = vec![0.0; v.len()];
            case.jacobian.transposed_multiply_add(&case.jacobian_values, w, &mut expected);
            let worst = gradient
                .iter()
                .zip(&expected)
                .fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
            assert!(worst < 1e-13, "transposed: {worst} for {stages:?}");
        }
    }
}
