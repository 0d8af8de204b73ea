#!/usr/bin/env python3
"""Models of tests/classics/switched, cut into two phases: `cut_in_two.py target/release/fdcc 0.37 0.61`.

Time is cut at each of the parts that are named; states, controls and the objective stand outside of both phases, surfaces, equations,
path conditions and jumps in them. Nothing else changes, so that the optimum is that of the whole model, in true_optimum.csv beside
this file; but `at most` counts anew in each phase, so that more jumps may be better. Prints a line for each model that is not
certified, or certified at another objective, and counts; the exit code is 1 if any without `at most` is certified at another
objective. Models in which something outside reads the time or a surface are left out.
"""

import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
MODELS = HERE.parent / 'classics' / 'switched'
WITHIN = ('surface', 'dynamics', 'path', 'jump')
WHOLE = ('phase', 'link', 'at', 'sweep', 'fit', 'data')
SAME = 1e-6


def items(text):
    """The items of a model: each begins at the first column."""
    item, depth = '', 0
    for line in re.sub(r'#.*', '', text).split('\n'):
        if depth == 0 and re.match(r'\S', line) and item.strip():
            yield item.strip()
            item = ''
        item += line + '\n'
        depth += line.count('{') - line.count('}')
    yield item.strip()


def cut(text, part):
    """The model in two phases; nothing where it cannot be cut."""
    within, outside, time = [], [], None
    for item in items(text):
        word = item.split()[0] if item else ''
        if word in WHOLE:
            return None
        if word == 'time':
            time = re.match(r'time (\w+) in \[(.+),(.+?)\]\s*(\[[^\]]*\])?', item)
        elif word != 'expect':
            (within if word in WITHIN else outside).append(item)
    if not time:
        return None
    name, first, last, unit = (it and it.strip() for it in time.groups())
    middle = f'{first} + {part}*({last} - ({first}))' if first != '0' else f'{part}*({last})'
    begin, end = (f'time {name} in [{a}, {b}] {unit or ""}' for a, b in ((first, middle), (middle, last)))
    return '\n'.join([*outside, 'phase one {', begin, *within, '}', 'phase two like one {', end, '}', 'link one -> two { }', ''])


def main(fdcc, parts):
    """Solves all of them."""
    with open(HERE / 'true_optimum.csv', newline='') as file:
        known = {row[0]: row[1] for row in csv.reader(file)}
    is_wrong = False
    with tempfile.TemporaryDirectory() as folder:
        for part in parts:
            counts = {'cut': 0, 'certified': 0, 'other': 0}
            for path in sorted(MODELS.glob('*.fdc')):
                text, objective = cut(path.read_text(), part), known.get(f'switched/{path.stem}')
                if text is None or not objective:
                    continue
                model = Path(folder) / path.name
                model.write_text(text)
                command = [fdcc, 'solve', str(model), '--json', '--log', 'none', '--no-verify', '--time-limit', '120']
                output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
                if not output:
                    continue
                found = json.loads(output)
                certificate = found.get('certificate') or {'certified': False, 'checks': []}
                is_other = abs(found['objective'] - float(objective)) > SAME * max(1, abs(float(objective)))
                counts['cut'] += 1
                counts['certified'] += certificate['certified']
                counts['other'] += certificate['certified'] and is_other
                is_wrong |= certificate['certified'] and is_other and 'at most' not in text
                if is_other or not certificate['certified']:
                    failed = ', '.join(it['check'] for it in certificate['checks'] if not it['passes'])
                    print(part, path.stem, found['status'], found['objective'], objective, failed, flush=True)
            print(part, *(f'{count} {word}' for word, count in counts.items()), flush=True)
    return int(is_wrong)


if __name__ == '__main__':
    sys.exit(main(sys.argv[1], sys.argv[2:]))
