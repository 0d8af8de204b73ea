/* Optimal control of systems with friction and switches, in closed loop.
 *
 * A controller is a model with values: it is read and compiled once, and solved for each state that
 * it is told, from the solution before. All numbers are in SI, but for those of fdcc_set.
 *
 * Nothing here throws, prints or ends the process. Different controllers may be used by different
 * threads; one controller by one thread at a time.
 */
#ifndef FDCC_H
#define FDCC_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How a call ended. */
enum fdcc_status {
    FDCC_SOLVED = 0,      /* solved, or nearly as accurate as asked for */
    FDCC_TIME_LIMIT = 1,  /* the best iterate when the time was over */
    FDCC_NOT_SOLVED = 2,  /* nothing was found from this state; the best iterate */
    FDCC_WRONG_CALL = 3,  /* fdcc_message says why; nothing has changed */
    FDCC_INTERNAL = 4     /* a mistake of the library; the controller is of no use any more */
};

typedef struct fdcc_controller fdcc_controller;

/* A controller for the text of a model, with so many intervals; NULL if the model is wrong, and then
 * why is in `message`, which has room for `size` bytes (cut there, and ended by 0). */
fdcc_controller *fdcc_new(const char *model, size_t intervals, char *message, size_t size);

void fdcc_free(fdcc_controller *controller);

/* Numbers of states, controls and signals; their names are the controller's. NULL beyond the last. */
size_t fdcc_states(const fdcc_controller *controller);
size_t fdcc_controls(const fdcc_controller *controller);
size_t fdcc_signals(const fdcc_controller *controller);
const char *fdcc_state_name(const fdcc_controller *controller, size_t index);
const char *fdcc_control_name(const fdcc_controller *controller, size_t index);
const char *fdcc_signal_name(const fdcc_controller *controller, size_t index);

/* Another value of a parameter, in its declared unit, from the next step on. */
int fdcc_set(fdcc_controller *controller, const char *parameter, double value);

/* The values of a signal from the next step on: one for each point of the grid, which has one more
 * than there are intervals, or one for all of them. */
int fdcc_set_signal(fdcc_controller *controller, const char *signal, const double *values, size_t count);

/* Signals that were not given have the values of the text from this time on. */
int fdcc_set_time(fdcc_controller *controller, double now);

/* Each step ends after so many microseconds with its best iterate; 0, as at first, for no limit. */
int fdcc_set_budget(fdcc_controller *controller, unsigned long long microseconds);

/* Solves from a state, one number for each; the first value of each control goes to `controls`. */
int fdcc_step(fdcc_controller *controller, const double *state, double *controls);

/* Of the last step; 0 or NULL before the first. The grid has one point more than there are intervals;
 * a state has a value at each point, a control on each interval. They belong to the controller, and
 * are good until its next call. */
double fdcc_objective(const fdcc_controller *controller);
double fdcc_violation(const fdcc_controller *controller);
size_t fdcc_iterations(const fdcc_controller *controller);
size_t fdcc_points(const fdcc_controller *controller);
const double *fdcc_time(const fdcc_controller *controller);
const double *fdcc_state(const fdcc_controller *controller, size_t index);
const double *fdcc_control(const fdcc_controller *controller, size_t index);

/* Why the last call was wrong; "" if it was not. Good until the next call. */
const char *fdcc_message(const fdcc_controller *controller);

#ifdef __cplusplus
}
#endif

#endif
