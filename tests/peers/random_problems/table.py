"""The page docs/random-problems.md: what each family ended as, wrong words, failures."""

from collections import Counter
from statistics import median

WORDS = ('solved', 'global', 'confirmed', 'infeasible', 'unbounded')
HEAD = '''# Random problems

What `fdcc solve` says about problems that nobody chose, all settings at their defaults, against IPOPT (`tol = 1e-10`) on the same discrete problem, closed forms, and SciPy's integrators for
"confirmed". This page is written by

```sh
pip install casadi numpy scipy
python3 tests/peers/random_problems/run.py target/release/fdcc --count {count} --seed {seed} --table docs/random-problems.md
```

and a sample of it runs in `.ci/run`. A word is wrong where

- *solved*: a condition is violated by more than 1e-6 of the size of its terms; or the objective is not what it is told to be; or it is worse by more than 1e-6 of the size of its terms than the optimum of a convex problem; or
  small steps from the answer lead down by more than that, or negative curvature does; or the problem is infeasible or unbounded by construction;
- *global*: anything better by 1e-6 is known;
- *confirmed*: the true system under these controls is off by more than twice of what was asked, relative to the movement of each state and to the terms of each condition; or the objective is 15 % above the true optimum, where that is known in closed form, and the field `optimality` says nothing;
- *infeasible*: a feasible trajectory is known, and the verdict is not limited to the guess;
- *unbounded*: the construction proves a bound.

'''


def summary(rows):
    """One line."""
    wrong = sum(1 for row in rows if row['wrong'])
    failed = sum(1 for row in rows if row['failed'])
    share = 100 * failed / max(1, len(rows))
    return f'{len(rows)} problems: {wrong} with a wrong word, {failed} failures where IPOPT succeeds ({share:.1f} %)'


def page(rows):
    """The whole page."""
    text = HEAD.format(count=len(rows), seed=rows[0]['seed']) + f'**{summary(rows)}.**\n\n'
    text += words(rows) + families(rows)
    text += listed('## Wrong words', [row for row in rows if row['wrong']],
                   lambda row: '; '.join(f'"{word}": {why}' for word, why in row['wrong']))
    text += listed('## Failures where IPOPT succeeds', [row for row in rows if row['failed']],
                   lambda row: f'IPOPT: {number(row.get("known"))}')
    return text + other_minima(rows)


def words(rows):
    """How often each word was said, and how often it was wrong."""
    said = Counter({
        'solved': sum(row['status'] in ('solved', 'acceptable') for row in rows),
        'global': sum(row.get('global', False) for row in rows),
        'confirmed': sum(row.get('confirmed', False) for row in rows),
        'infeasible': sum(row['status'] == 'infeasible' for row in rows),
        'unbounded': sum(row['status'] == 'unbounded' for row in rows)})
    wrong = Counter(word for row in rows for word in {word for word, _ in row['wrong']})
    lines = ['| word | said | wrong |', '|---|---|---|']
    return '\n'.join(lines + [f'| {word} | {said[word]} | {wrong[word]} |' for word in WORDS]) + '\n\n'


def families(rows):
    lines = ['| family | problems | solved | of these global | of these confirmed | infeasible | unbounded | other | wrong | failed where IPOPT succeeds | '
             'iterations: median, most | IPOPT: median, most | seconds: median, most |', '|' + '---|' * 13]
    for family in sorted({row['family'] for row in rows}):
        lines.append(line(family, [row for row in rows if row['family'] == family]))
    return '\n'.join(lines + [line('all', rows)]) + '\n\n'


def line(family, rows):
    status = Counter('solved' if row['status'] == 'acceptable' else row['status'] for row in rows)
    solved, infeasible, unbounded = (status.pop(word, 0) for word in ('solved', 'infeasible', 'unbounded'))
    counts = [len(rows), solved, sum(row.get('global', False) for row in rows),
              sum(row.get('confirmed', False) for row in rows), infeasible, unbounded, sum(status.values()),
              sum(bool(row['wrong']) for row in rows), sum(row['failed'] for row in rows)]
    spreads = [spread([row[key] for row in rows if row.get(key) is not None])
               for key in ('iterations', 'ipopt_iterations', 'seconds')]
    return '| ' + ' | '.join([family, *map(str, counts), *spreads]) + ' |'


def spread(values):
    """Median and largest."""
    return f'{number(median(values), 3)}, {number(max(values), 3)}' if values else ''


def number(value, digits=9):
    return '' if value is None else f'{value:.{digits}g}'


def listed(title, rows, last):
    """A table of single problems; `generate(seed, index)` makes each again."""
    if not rows:
        return f'{title}\n\nNone.\n\n'
    lines = [title, '', '| seed, index | family | status | objective | best known | why |', '|---|---|---|---|---|---|']
    for row in rows:
        lines.append(f'| {row["seed"]}, {row["index"]} | {row["family"]} | {row["status"]} | {number(row.get("objective"))} | '
                     f'{number(row.get("known"))} | {last(row)} |')
    return '\n'.join(lines) + '\n\n'


def other_minima(rows):
    count = sum('a local minimum' in note for row in rows for note in row['notes'])
    contradicted = sum(row.get('contradicted', False) for row in rows)
    unseen = sum('replay' in note for row in rows for note in row['notes'])
    return ('## Local minima\n\n'
            f'In {count} problems the answer is a local minimum, without the word "global", and another start of IPOPT finds a better one. '
            f'In {contradicted} the field `optimality` contradicts a solved answer, and {unseen} confirmations could not be replayed by SciPy.\n')
