/* Calls kernels of an emitted file on what the standard input has, and writes what they give. The
 * test includes the file before this one and defines CALLS. */
#include <stdio.h>
#include <stdlib.h>

static double *numbers(size_t count) {
    double *all = calloc(count + 1, sizeof *all);
    if (!all) exit(3);
    return all;
}

static void get(double *to, size_t count) {
    if (count && fread(to, sizeof *to, count, stdin) != count) exit(4);
}

static void put(const double *from, size_t count) {
    if (count && fwrite(from, sizeof *from, count, stdout) != count) exit(5);
}

#define BEGIN(nz, np, nl, ny, nj, nh)                                                             \
    double *z = numbers(nz), *p = numbers(np), *l = numbers(nl);                                  \
    double *y = numbers(ny), *j = numbers(nj), *h = numbers(nh);                                  \
    get(z, nz), get(p, np), get(l, nl);
#define END                                                                                       \
    free(z), free(p), free(l), free(y), free(j), free(h);

#define VALUES(f, nz, np, nl, ny)                                                                 \
    {                                                                                             \
        BEGIN(nz, np, nl, ny, 0, 0)                                                               \
        f##_value(z, p, y), put(y, ny);                                                           \
        END                                                                                       \
    }
#define DERIVATIVES(f, nz, np, nl, ny, nj, nh)                                                    \
    {                                                                                             \
        BEGIN(nz, np, nl, ny, nj, nh)                                                             \
        f##_value(z, p, y), put(y, ny);                                                           \
        f##_jacobian(z, p, y, j), put(y, ny), put(j, nj);                                         \
        f##_hessian(z, p, l, y, j, h), put(y, ny), put(j, nj), put(h, nh);                        \
        END                                                                                       \
    }

int main(void) {
    int point;
    for (point = 0; point < POINTS; ++point) {
        CALLS
    }
    return 0;
}
