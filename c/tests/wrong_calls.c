/* Everything that a program can do wrong without leaving C. */
#include "fdcc.h"
#include <stdio.h>
#include <string.h>

#define CHECK(what) do { if (!(what)) { fprintf(stderr, "line %d: %s\n", __LINE__, #what); return 1; } } while (0)

static const char *HOP =
    "param goal = 0.5\ntime t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\n"
    "dynamics { x' = u }\nend x == goal\nminimize integral(u^2)\n";

static const char *FOLLOW =
    "time t in [0, 1]\nsignal r = 0\nstate x start 0\ncontrol u in [-5, 5]\n"
    "dynamics { x' = u }\nminimize integral((x - r)^2 + 0.001*u^2)\n";

int main(void)
{
    char why[200], little[8];
    double x = 0, u = 7, infinite = 1e308 * 10;
    CHECK(fdcc_new("time t in [0, 1]\nstate x start 0\ndynamics { x' = y }", 10, why, sizeof why) == NULL);
    CHECK(strstr(why, "line 3: nothing called `y` here"));
    CHECK(fdcc_new("state \xff", 10, why, sizeof why) == NULL && strstr(why, "UTF-8"));
    CHECK(fdcc_new(NULL, 10, little, sizeof little) == NULL && strlen(little) == 7);
    CHECK(fdcc_new(HOP, 0, NULL, 0) == NULL);
    CHECK(fdcc_new("time t in [0, 1]\nstate x start 0\nsurface s = x\ndynamics { x' in -Sgn(s) }",
                   10, why, sizeof why) == NULL && strstr(why, "names the width"));

    fdcc_controller *hop = fdcc_new(HOP, 10, why, sizeof why);
    CHECK(hop && fdcc_states(hop) == 1 && fdcc_controls(hop) == 1);
    CHECK(!strcmp(fdcc_state_name(hop, 0), "x") && !strcmp(fdcc_control_name(hop, 0), "u"));
    CHECK(fdcc_state_name(hop, 1) == NULL && fdcc_time(hop) == NULL && fdcc_points(hop) == 0);
    CHECK(fdcc_step(hop, NULL, &u) == FDCC_WRONG_CALL && strstr(fdcc_message(hop), "null"));
    CHECK(fdcc_step(hop, &infinite, &u) == FDCC_WRONG_CALL && u == 7);
    CHECK(strstr(fdcc_message(hop), "1 finite value"));
    CHECK(fdcc_set(hop, NULL, 1) == FDCC_WRONG_CALL && fdcc_set(hop, "goal", infinite) == FDCC_WRONG_CALL);

    /* The straight way costs the square of its length. */
    CHECK(fdcc_step(hop, &x, &u) == FDCC_SOLVED && u > 0.4999 && u < 0.5001);
    CHECK(!*fdcc_message(hop) && fdcc_objective(hop) > 0.2499 && fdcc_objective(hop) < 0.2501);
    CHECK(fdcc_points(hop) == 11 && fdcc_time(hop)[10] == 1 && fdcc_state(hop, 0)[0] == 0);
    CHECK(fdcc_control(hop, 1) == NULL && fdcc_control(hop, 0)[9] > 0.4999);
    CHECK(fdcc_set(hop, "goal", 5) == FDCC_SOLVED && fdcc_step(hop, &x, &u) == FDCC_NOT_SOLVED);
    CHECK(fdcc_set(hop, "goal", -0.5) == FDCC_SOLVED && fdcc_step(hop, &x, &u) == FDCC_SOLVED && u < -0.4999);
    CHECK(fdcc_signals(hop) == 0 && fdcc_signal_name(hop, 0) == NULL);
    CHECK(fdcc_set_signal(hop, "r", &x, 1) == FDCC_WRONG_CALL && strstr(fdcc_message(hop), "has none"));
    fdcc_free(hop);

    fdcc_controller *follow = fdcc_new(FOLLOW, 4, why, sizeof why);
    const double ahead[5] = {0, 0.2, 0.4, 0.6, 0.8}, below = -1;
    CHECK(follow && fdcc_signals(follow) == 1 && !strcmp(fdcc_signal_name(follow, 0), "r"));
    CHECK(fdcc_set_signal(follow, "q", ahead, 5) == FDCC_WRONG_CALL && strstr(fdcc_message(follow), "are r"));
    CHECK(fdcc_set_signal(follow, "r", ahead, 4) == FDCC_WRONG_CALL && strstr(fdcc_message(follow), "1 or 5"));
    CHECK(fdcc_set_signal(follow, "r", NULL, 1) == FDCC_WRONG_CALL);
    CHECK(fdcc_set_signal(follow, "r", &infinite, 1) == FDCC_WRONG_CALL);
    CHECK(fdcc_set_time(follow, infinite) == FDCC_WRONG_CALL);
    CHECK(fdcc_set_signal(follow, "r", ahead, 5) == FDCC_SOLVED && fdcc_step(follow, &x, &u) == FDCC_SOLVED);
    CHECK(fdcc_state(follow, 0)[2] > 0.38 && fdcc_state(follow, 0)[2] < 0.42);
    CHECK(fdcc_set_signal(follow, "r", &below, 1) == FDCC_SOLVED && fdcc_step(follow, &x, &u) == FDCC_SOLVED);
    CHECK(u < 0);
    fdcc_free(follow);

    CHECK(fdcc_step(NULL, &x, &u) == FDCC_WRONG_CALL && fdcc_states(NULL) == 0);
    fdcc_free(NULL);
    printf("all told\n");
    return 0;
}
