/* A block on a table is pulled to x = 1 and held there, by a controller that knows its friction.
 *
 *     cc -Ic/include c/examples/closed_loop.c -Ltarget/release -lfdcc_c -lm
 *     LD_LIBRARY_PATH=target/release ./a.out
 */
#include "fdcc.h"
#include <math.h>
#include <stdio.h>

static const char *MODEL =
    "model block\n"
    "param goal = 1 [m]\n"
    "param mu = 0.2\n"
    "let m = 2 [kg]\n"
    "let g = 9.81 [m/s^2]\n"
    "time t in [0, 1] [s]\n"
    "state x [m] start 0\n"
    "state v [m/s] start 0\n"
    "control F in [-20, 20] [N]\n"
    "surface slip = v\n"
    "dynamics { x' = v   m * v' in F - mu * m * g * Sgn(slip) }\n"
    "minimize integral(100 [N^2/m^2] * (x - goal)^2 + 1 [N^2*s^2/m^2] * v^2 + 0.01 * F^2)\n"
    "method { sigma = 0.01 [m/s] }\n";

/* The true block for a short time: friction stops it, and holds it as long as it can. */
static void move(double x[2], double force, double step)
{
    const double m = 2, friction = 0.2 * 2 * 9.81, dt = 1e-5;
    for (int k = 0; k < (int)(step / dt + 0.5); k++) {
        double free = x[1] + dt * force / m, most = dt * friction / m;
        x[1] = fabs(free) <= most ? 0 : free - copysign(most, free);
        x[0] += dt * x[1];
    }
}

int main(void)
{
    char why[1000];
    fdcc_controller *controller = fdcc_new(MODEL, 25, why, sizeof why);
    if (!controller) {
        fprintf(stderr, "%s\n", why);
        return 1;
    }
    double x[2] = {0, 0}, force, most = 0;
    for (int k = 0; k < 60; k++) {
        int status = fdcc_step(controller, x, &force);
        if (status != FDCC_SOLVED) {
            fprintf(stderr, "step %d: status %d %s\n", k, status, fdcc_message(controller));
            return 1;
        }
        most = fmax(most, fabs(fdcc_violation(controller)));
        move(x, force, fdcc_time(controller)[1]);
    }
    printf("x = %.3f v = %.3f violation below 1e-6: %d\n", x[0], x[1], most < 1e-6);
    if (fdcc_set(controller, "gaol", 2) != FDCC_WRONG_CALL)
        return 1;
    printf("%s\n", fdcc_message(controller));
    if (fdcc_set(controller, "goal", 0.5) != FDCC_SOLVED)
        return 1;
    for (int k = 0; k < 60; k++) {
        fdcc_step(controller, x, &force);
        move(x, force, fdcc_time(controller)[1]);
    }
    printf("x = %.2f after another goal\n", x[0]);
    fdcc_free(controller);
    return 0;
}
