//! What stands above and below the functions of a file.

/// The words of CasADi's generated code, which a compiler may define otherwise.
pub(super) const HEAD: &str = "\
#include <math.h>

#ifdef __cplusplus
extern \"C\" {
#endif

#ifndef casadi_real
#define casadi_real double
#endif
#ifndef casadi_int
#define casadi_int long long int
#endif
#ifndef CASADI_SYMBOL_EXPORT
#if defined(_WIN32) || defined(__CYGWIN__)
#define CASADI_SYMBOL_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define CASADI_SYMBOL_EXPORT __attribute__((visibility(\"default\")))
#else
#define CASADI_SYMBOL_EXPORT
#endif
#endif

/* a b + c with one rounding, as the machine code has it; for a processor that cannot do it:
 * -D'FDCC_FMA(a,b,c)=((a)*(b)+(c))' */
#ifndef FDCC_FMA
#define FDCC_FMA(a, b, c) fma((a), (b), (c))
#endif

";

/// Below everything.
pub(super) const FOOT: &str = "
#ifdef __cplusplus
}
#endif
";

/// A name with the function that it is of.
type Helper = (&'static str, &'static str);

const HELPERS: &[Helper] = &[
    ("fdcc_log_cosh", LOG_COSH),
    ("fdcc_min", MIN),
    ("fdcc_max", MAX),
    ("fdcc_read", READ),
    ("fdcc_write", WRITE),
    ("fdcc_pick", PICK),
    ("fdcc_adjoint", ADJOINT),
];

/// The formula of the builtin, see `log_cosh` in the table of builtins.
const LOG_COSH: &str = "\
static double fdcc_log_cosh(double x) {
    if (fabs(x) < 1.0) {
        double half = sinh(0.5 * x);
        return log1p(2.0 * half * half);
    }
    return fabs(x) + log1p(exp(-2.0 * fabs(x))) - 0.6931471805599453;
}
";

const MIN: &str = "\
static double fdcc_min(double a, double b) { return a <= b || isnan(a) ? a : b; }
";

const MAX: &str = "\
static double fdcc_max(double a, double b) { return b <= a || isnan(a) ? a : b; }
";

const READ: &str = "\
/* an input that is not given is 0 */
static void fdcc_read(double *to, const double *from, int offset, int count) {
    int i;
    for (i = 0; i < count; ++i) to[i] = from ? from[offset + i] : 0.0;
}
";

const WRITE: &str = "\
/* an output that nobody wants is left out */
static void fdcc_write(double *to, const double *from, int count) {
    int i;
    for (i = 0; to && i < count; ++i) to[i] = from[i];
}
";

const PICK: &str = "\
static void fdcc_pick(double *to, const double *from, const int *which, int count) {
    int i;
    for (i = 0; to && i < count; ++i) to[i] = from[which[i]];
}
";

const ADJOINT: &str = "\
/* to = J' l, with entries which[0], which[1], ... of J in these rows and columns */
static void fdcc_adjoint(double *to, int size, const double *l, const double *j,
                         const int *which, const int *row, const int *column, int count) {
    int i;
    for (i = 0; to && i < size; ++i) to[i] = 0.0;
    for (i = 0; to && i < count; ++i) to[column[i]] += l[row[i]] * j[which[i]];
}
";

/// Those that a text calls: a compiler warns of the others.
pub(super) fn helpers(text: &str) -> String {
    let called = HELPERS.iter().filter(|(name, _)| text.contains(&format!("{name}(")));
    called.map(|(_, helper)| format!("{helper}\n")).collect()
}
