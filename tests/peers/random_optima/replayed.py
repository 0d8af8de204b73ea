"""The first check: the controls of the document on the true system reach the same states, conditions and objective."""

import numpy as np

from simulate import Simulation

LIMIT = 1e-5


def sizes_of(answer):
    """How large each state becomes; at least 1e-5 of where the largest controls would lead, by two steps."""
    model, sizes = answer.model, np.abs(answer.states).max(axis=0)
    rates = model.function([model.rates[s.name] for s in model.states])
    highest = [c.high * c.si for c in model.controls]
    for selector in (0.0, 1.0):
        x = np.zeros(len(sizes))
        for _ in range(2):
            selectors = [selector] * len(model.selectors())
            x = answer.time[-1] * np.real(rates(0.0, list(x), highest, answer.unknowns, selectors))
            sizes = np.maximum(sizes, 1e-5 * np.abs(x))
    return np.maximum(sizes, 1e-300)


def starts(answer):
    """The states at the first time: those of the model, and the free ones of the document."""
    model, found = answer.model, []
    for k, state in enumerate(model.states):
        found.append(answer.states[0, k] if not isinstance(state.start, float) else state.start * state.si)
    return found


def outcome(model, unknowns, x, cost):
    """The objective; the residuals of the end conditions, with their senses and the sizes of both sides."""
    texts = [model.terminal] + [side for a, _, b in model.ends for side in (a, b)]
    nothing = [0.0] * len(model.controls)
    names = [u.name for u in model.unknowns]
    last = unknowns[names.index(model.duration)] if isinstance(model.duration, str) else 0.0
    values = model.function(texts)(last, x, nothing, unknowns, [0.0] * len(model.selectors()))
    values = [complex(v).real for v in values]
    gaps = [a - b for a, b in zip(values[1::2], values[2::2])]
    return values[0] + cost, gaps, [sense for _, sense, _ in model.ends], np.abs(values[1:]).reshape(-1, 2)


def violation(gap, sense):
    return abs(gap) if sense == '==' else max(0.0, gap if sense == '<=' else -gap)


def replayed(answer):
    """The largest relative differences: of states, of conditions, of the objective, of bounds; and what was seen."""
    model = answer.model
    sizes = sizes_of(answer)
    simulation = Simulation(model, answer.unknowns, answer.controls, list(answer.time), starts(answer), answer.planned,
                            answer.jumps, sizes)
    x = simulation.x
    objective, gaps, senses, _ = outcome(model, answer.unknowns, x[:-1], x[-1])
    jumped = np.isin(answer.time[1:], [time for _, time in answer.jumps])
    gaps_of_states = np.abs(np.array(simulation.nodes) - answer.states[1:])[~jumped] / sizes
    size = max(abs(answer.objective), abs(x[-1]), size_of_cost(answer))
    figures = {'states': float(gaps_of_states.max()), 'objective': abs(objective - answer.objective) / size,
               'controls': answer.excess(), 'bounds': beyond(model, simulation, sizes),
               'conditions': max((violation(g, s) / scale for g, s, scale in
                                  zip(gaps, senses, condition_sizes(model, sizes))), default=0.0)}
    return figures, simulation


def condition_sizes(model, sizes):
    """A condition is measured by the state that it is about."""
    names = [s.name for s in model.states]
    return [sizes[names.index(a.split(' ')[0])] if a.split(' ')[0] in names else 1.0 for a, _, _ in model.ends]


def size_of_cost(answer):
    """A size of the objective where it is about 0: what controls at a thousandth of their bounds cost."""
    if answer.model.running == '0':
        return 1e-300
    spans = [max(abs(c.high), abs(c.low)) * c.si for c in answer.model.controls]
    return 1e-6 * max(spans)**2 * answer.time[-1]


def beyond(model, simulation, sizes):
    """How far states leave their bounds anywhere, and path conditions, for the size of the state."""
    most, names = 0.0, [s.name for s in model.states]
    for t, y in simulation.samples:
        for k, s in enumerate(model.states):
            if s.low > -np.inf:
                most = max(most, (y[k].max() - s.high * s.si) / sizes[k], (s.low * s.si - y[k].min()) / sizes[k])
        for a, sense, b in model.paths:
            k = names.index(a)
            bound = complex(model.function([b])(0.0, y[:-1, 0], [0.0] * len(model.controls), simulation.system.p,
                                                simulation.system.none)[0]).real
            most = max(most, (y[k].max() - bound if sense == '<=' else bound - y[k].min()) / sizes[k])
    return float(most)


def wrong(figures):
    """What is off by more than the limit."""
    return [f'{name} by {value:.1e}' for name, value in figures.items() if not value <= LIMIT]
