#!/usr/bin/env bash
# Two minutes of random problems, judged by CasADi with IPOPT, random events, judged by SciPy, and random models with
# switches, whose certified answers SciPy judges: `ci.sh target/release/fdcc`. Skipped where these cannot be had.
set -euo pipefail
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
peers=$(dirname "$0")/..
python=$("$peers/environment") || { echo "skipped: python3 with casadi, numpy and scipy cannot be had"; exit 0; }
"$python" "$peers/random_problems/check_judge.py"
"$python" "$peers/random_problems/run.py" "$1" --seconds 50 --seed 7
"$python" "$peers/events.py" "$1" --seconds 30 --seed 7
"$python" "$peers/random_optima/check_judge.py" "$1"
"$python" "$peers/random_optima/run.py" "$1" --seconds 40 --seed 7
