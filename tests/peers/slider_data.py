"""The measurements of models/slider_fit.fdc: the true system, simulated by fdcc, with normal noise that has a seed.

    python3 tests/peers/slider_data.py target/release/fdcc > models/slider.csv
"""
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

SEED = 19
SD_X, SD_V = 0.01, 0.03
TIMES = [0.2 * k for k in range(21)]
TRUTH = """model slider
param mu = 0.3
param m  = 2 [kg]
const g  = 9.81 [m/s^2]
time t in [0, 4] [s]
state x [m]   start 0
state v [m/s] start 0
let pull = 10 [N] - 2.5 [N/s] * t
surface slip = v
dynamics {
  x' = v
  m * v' in pull - mu*m*g*Sgn(slip)
}
"""


def simulated(fdcc):
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / 'slider.fdc'
        model.write_text(TRUTH)
        times = ','.join(f'{t:.1f}' for t in TIMES)
        command = [fdcc, 'simulate', str(model), '--times', times, '--json']
        found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return found['states']['x'], found['states']['v']


def main():
    noise = random.Random(SEED)
    print('t,x,v,F')
    for t, x, v in zip(TIMES, *simulated(sys.argv[1])):
        x, v = x + SD_X * noise.gauss(0, 1), v + SD_V * noise.gauss(0, 1)
        print(f'{t:.1f},{x:.4f},{v:.4f},{10 - 2.5 * t:.1f}')


if __name__ == '__main__':
    main()
