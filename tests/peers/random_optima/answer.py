"""What a document of `fdcc solve --json` says, as functions of time."""

import numpy as np


class Answer:
    """Times, controls as polynomials on intervals, planned modes; all in SI."""

    def __init__(self, model, document):
        self.model, self.document = model, document
        self.time = np.array(document['time'])
        self.unknowns = [document['free'][u.name] for u in model.unknowns]
        self.states = np.array([document['states'][s.name] for s in model.states]).T
        self.objective = document['objective']
        self.jumps = [(jump['jump'], jump['time']) for jump in document.get('jumps', [])]
        self.pieces = self.polynomials()

    def polynomials(self):
        """For each interval and control the coefficients over the part of the interval, lowest power first."""
        nodes, count = self.document.get('control_nodes') or {}, len(self.time) - 1
        pieces = np.zeros((count, len(self.model.controls), 4))
        if not nodes:
            for j, control in enumerate(self.model.controls):
                pieces[:, j, 0] = self.document['controls'][control.name]
            return pieces
        times = np.array(nodes['time']).reshape(count, -1)
        for j, control in enumerate(self.model.controls):
            values = np.array(nodes['values'][control.name]).reshape(count, -1)
            for k in range(count):
                h = self.time[k + 1] - self.time[k]
                parts = (times[k] - self.time[k]) / h if h > 0 else np.linspace(0.1, 0.9, times.shape[1])
                pieces[k, j, :len(parts)] = np.linalg.solve(np.vander(parts, increasing=True), values[k])
        return pieces

    def interval(self, t):
        """The interval in which t lies; at its ends the later one."""
        return min(max(int(np.searchsorted(self.time, t, side='right')) - 1, 0), len(self.time) - 2)

    def controls(self, t, k=None):
        """The controls at t, by the polynomials of interval k."""
        k = self.interval(t) if k is None else k
        h = self.time[k + 1] - self.time[k]
        s = (t - self.time[k]) / h if h > 0 else 0.0
        return [float(c[0] + s * (c[1] + s * (c[2] + s * c[3]))) for c in self.pieces[k]]

    def excess(self):
        """How far controls leave their bounds anywhere in an interval, for the distance of these."""
        most = 0.0
        for j, control in enumerate(self.model.controls):
            low, high = control.low * control.si, control.high * control.si
            s = np.linspace(0, 1, 33)[:, None] ** np.arange(4)
            values = (self.pieces[:, j] @ s.T)[np.diff(self.time) > 1e-9 * self.time[-1]]
            most = max(most, (values - high).max() / (high - low), (low - values).max() / (high - low))
        return most

    def planned(self, name, t):
        """-1, 0, 1 as the document says of a surface at t; None if it says nothing."""
        for span in self.document['surfaces'].get(name, []):
            if span['from'] <= t <= span['to']:
                return {'below': -1, 'held': 0, 'above': 1, 'moving': 1}.get(span['mode'])
        return None

    def breaks(self):
        """Where controls may jump or bend: the ends of arcs, switches, jumps."""
        certificate = self.document.get('certificate') or {}
        times = [switch['time'] for switch in certificate.get('switches', [])]
        times += [arc['from'] for arcs in certificate.get('arcs', {}).values() for arc in arcs]
        times += [time for _, time in self.jumps]
        after = [self.controls(t, k) for k, t in enumerate(self.time[1:-1], 1)]
        before = [self.controls(t, k) for k, t in enumerate(self.time[1:-1])]
        spans = [max(c.high - c.low, 1e-300) * c.si for c in self.model.controls]
        rough = [t for t, a, b in zip(self.time[1:-1], before, after)
                 if any(abs(p - q) > 1e-7 * span for p, q, span in zip(a, b, spans))]
        return sorted({*times, *rough, self.time[0], self.time[-1]})
