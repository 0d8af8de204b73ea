"""The page docs/method/random-optima.md."""

from collections import Counter
from statistics import median

HEAD = '''# Random optima

Models with friction, switches, `match`, `Dir` and jumps that nobody chose and that name no width, so that `fdcc solve` looks for their [true optimum](true-optimum.md) (`fdcc/src/solve/true_optimum/`). This page is written by the programs of `tests/peers/random_optima/`:

```sh
pip install numpy scipy
python3 tests/peers/random_optima/run.py target/release/fdcc --count {count} --seed {seed} --table docs/method/random-optima.md
```

and `tests/peers/random_problems/ci.sh` runs a sample. A certificate is called false where

- the controls of the document, simulated from event to event by SciPy (`tests/peers/random_optima/simulate.py`: DOP853 with dense output; a held surface by the selector that keeps psi' = 0), do not lead to the states at all grid times, the end conditions, the bounds or the objective of the document, to 1e-5 of their sizes; or
- a neighbour does better (`tests/peers/random_optima/descent.py`). Directions are hats on each control, short pieces with other controls (at each switch, those of its other side; there and elsewhere the bounds and their middle), longer or shorter time, other free starts. Derivatives are differences of simulations of the true system; steps down the slope with the end conditions kept, and random steps, are corrected by Newton's method until the conditions hold to 1e-8. A step counts if SciPy's simulation confirms that it is better by more than 1e-6 of the objective.

An answer is *late* if it is not there 20 s after a time limit of 60 s. Nothing of `fdcc` but its document is used. `tests/peers/random_optima/check_judge.py` changes certified documents and sees each change refused.

'''


def summary(rows):
    """One line."""
    certified = [row for row in rows if row['certified']]
    false = sum(bool(row['wrong']) for row in certified)
    without = sum(bool(row['wrong']) for row in rows) - false
    share = 100 * len(certified) / max(1, len(rows))
    return (f'{len(rows)} models: {len(certified)} certified ({share:.1f} %), {len(rows) - len(certified)} not, '
            f'{sum("figures" in row for row in rows)} checked, {false} false, {without} crashed or late')


def page(rows):
    """The whole page."""
    text = HEAD.format(count=len(rows), seed=rows[0]['seed']) + f'**{summary(rows)}.**\n\n' + families(rows)
    text += reasons(rows) + figures(rows) + listed('## False certificates, crashes, late answers',
                                                   [row for row in rows if row['wrong']],
                                                   lambda row: '; '.join(row['wrong']))
    unjudged = [row for row in rows if 'unjudged' in row]
    text += listed('## Certified, and not checked', unjudged, lambda row: row['unjudged'])
    return (text + slowest(rows)).rstrip() + '\n'


def families(rows):
    lines = ['| family | models | certified | not certified | checked | false | seconds: median, most |', '|' + '---|' * 7]
    names = sorted({row['family'] for row in rows})
    lines += [line(name, [row for row in rows if row['family'] == name]) for name in names]
    return '\n'.join(lines + [line('all', rows)]) + '\n\n'


def line(name, rows):
    certified = sum(row['certified'] for row in rows)
    seconds = [row['seconds'] for row in rows]
    cells = [name, len(rows), certified, len(rows) - certified, sum('figures' in row for row in rows),
             sum(bool(row['wrong']) for row in rows if row['certified']), f'{median(seconds):.2g}, {max(seconds):.2g}']
    return '| ' + ' | '.join(map(str, cells)) + ' |'


def reasons(rows):
    """Why answers are not certified: the status, and the checks that fail."""
    rest = [row for row in rows if not row['certified']]
    key = lambda row: (row['status'], ', '.join(row.get('failing', [])))
    found = Counter(map(key, rest))
    lines = ['## Not certified', '', '| status | checks that fail | models | of the families |', '|---|---|---|---|']
    for (status, failing), count in found.most_common():
        of = Counter(row['family'] for row in rest if key(row) == (status, failing)).most_common()
        of = ', '.join(f'{family} {number}' for family, number in of)
        lines.append(f'| {status} | {failing or "none was made"} | {count} | {of} |')
    return '\n'.join(lines) + '\n\n' if rest else ''


def figures(rows):
    """The largest figures of the checks of certified answers."""
    checked = [row['figures'] for row in rows if 'figures' in row]
    if not checked:
        return ''
    lines = ['## The largest figures', '', '| check | largest | allowed |', '|---|---|---|']
    for name in ('states', 'conditions', 'objective', 'controls', 'bounds', 'gain'):
        allowed = '1e-6' if name == 'gain' else '1e-5'
        lines.append(f'| {name} | {max(figure[name] for figure in checked):.1e} | {allowed} |')
    return '\n'.join(lines) + '\n\n'


def listed(title, rows, why):
    """A table of single models; `generate(seed, index)` makes each again."""
    if not rows:
        return f'{title}\n\nNone.\n\n'
    lines = [title, '', '| seed, index | family | status | objective | why |', '|---|---|---|---|---|']
    for row in rows:
        lines.append(f'| {row["seed"]}, {row["index"]} | {row["family"]} | {row["status"]} | '
                     f'{row.get("objective") or 0:.9g} | {why(row)} |')
    return '\n'.join(lines) + '\n\n'


def slowest(rows):
    """The longest solves, in seconds on the machine that wrote the page."""
    last = sorted(rows, key=lambda row: -row['seconds'])[:8]
    return listed('## The slowest', last, lambda row: f'{row["seconds"]:.1f} s')
