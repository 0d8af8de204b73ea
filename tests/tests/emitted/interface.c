/* Asks the functions of an emitted file what they are and calls them, as CasADi does. `jac_f` has
 * to be the difference quotients of `f`, `adj1_f` the product with `jac_f`, and `jac_adj1_f` the
 * difference quotients of `adj1_f`. The test includes the file before this one and defines CHECKS. */
#include <stdio.h>
#include <stdlib.h>

typedef casadi_int integer;

typedef struct {
    const char *name;
    int (*call)(const double **, double **, integer *, double *, int);
    integer (*n_in)(void), (*n_out)(void);
    const integer *(*in)(integer), *(*out)(integer);
    int (*work)(integer *, integer *, integer *, integer *);
} function;

#define FUNCTION(f) { #f, f, f##_n_in, f##_n_out, f##_sparsity_in, f##_sparsity_out, f##_work }
#define MOST 4096

static double in[40][MOST], out[400][MOST], other[400][MOST];
static double memory[200000];
static int failures;

static integer entries(const integer *pattern) { return pattern[2 + pattern[1]]; }

static void run(const function *f, double to[][MOST]) {
    const double *arg[40];
    double *res[400];
    integer i, sizes[4];
    f->work(&sizes[0], &sizes[1], &sizes[2], &sizes[3]);
    if (sizes[0] > 40 || sizes[1] > 400 || sizes[3] > 200000) exit(3);
    for (i = 0; i < f->n_in(); ++i) arg[i] = in[i];
    for (i = 0; i < f->n_out(); ++i) res[i] = to[i];
    if (f->call(arg, res, 0, memory, 0)) exit(4);
}

static double number(void) { return 0.4 + 0.4 * (double)rand() / RAND_MAX; }

static void expect(const function *f, double found, double wanted, double tolerance) {
    if (fabs(found - wanted) > tolerance * (1.0 + fabs(wanted))) {
        printf("%s: %.17g instead of %.17g\n", f->name, found, wanted);
        ++failures;
    }
}

/* The outputs of `derivative` are blocks, for each output of `f` one for each of its inputs. */
static void differences(const function *f, const function *derivative, const int *active) {
    static double found[400][MOST], low[400][MOST];
    const double step = 1e-6;
    integer i, o, k, column, inputs = f->n_in();
    run(derivative, found);
    for (i = 0; i < inputs; ++i) {
        if (!active[i]) continue;
        for (column = 0; column < entries(f->in(i)); ++column) {
            double kept = in[i][column];
            in[i][column] = kept - step, run(f, low);
            in[i][column] = kept + step, run(f, other);
            in[i][column] = kept;
            for (o = 0; o < f->n_out(); ++o) {
                const integer *pattern = derivative->out(o * inputs + i);
                double dense[MOST] = { 0 };
                for (k = pattern[2 + column]; k < pattern[3 + column]; ++k)
                    dense[pattern[3 + pattern[1] + k]] = found[o * inputs + i][k];
                for (k = 0; k < entries(f->out(o)); ++k)
                    expect(derivative, dense[k], (other[o][k] - low[o][k]) / (2 * step), 1e-5);
            }
        }
    }
}

/* Seeds stand behind the inputs and the outputs of `f`. */
static void products(const function *f, const function *jacobian, const function *adjoint) {
    integer i, o, k, column, inputs = f->n_in(), outputs = f->n_out();
    run(jacobian, out);
    run(adjoint, other);
    for (i = 0; i < inputs; ++i) {
        double sum[MOST] = { 0 };
        for (o = 0; o < outputs; ++o) {
            const integer *pattern = jacobian->out(o * inputs + i);
            for (column = 0; column < pattern[1]; ++column)
                for (k = pattern[2 + column]; k < pattern[3 + column]; ++k)
                    sum[column] += out[o * inputs + i][k]
                                   * in[inputs + outputs + o][pattern[3 + pattern[1] + k]];
        }
        for (k = 0; k < entries(adjoint->out(i)); ++k) expect(adjoint, other[i][k], sum[k], 1e-12);
    }
}

static void check(const function *all, int (*diff_in)(integer)) {
    int active[40] = { 0 };
    integer i, k, inputs = all[0].n_in(), outputs = all[0].n_out();
    for (i = 0; i < inputs + 2 * outputs; ++i)
        for (k = 0; k < MOST; ++k) in[i][k] = number();
    for (i = 0; i < inputs; ++i) active[i] = diff_in(i);
    differences(&all[0], &all[1], active);
    products(&all[0], &all[1], &all[2]);
    for (i = 0; i < outputs; ++i) active[inputs + outputs + i] = 1;
    differences(&all[2], &all[3], active);
}

#define CHECK(f)                                                                                  \
    {                                                                                             \
        const function all[4] = { FUNCTION(f), FUNCTION(jac_##f), FUNCTION(adj1_##f),             \
                                  FUNCTION(jac_adj1_##f) };                                       \
        check(all, f##_diff_in);                                                                  \
    }

int main(void) {
    CHECKS
    return failures != 0;
}
