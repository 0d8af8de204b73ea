#!/usr/bin/env bash
# A sample of random models whose true optimum is looked for, judged by SciPy: `ci.sh target/release/fdcc 60`.
# Skipped where NumPy and SciPy cannot be had.
set -euo pipefail
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
here=$(dirname "$0") python=python3
if ! "$python" -c 'import numpy, scipy' 2>/dev/null; then
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  python=$folder/venv/bin/python
  if ! { python3 -m venv "$folder/venv" && timeout 300 "$folder/venv/bin/pip" install --quiet numpy scipy; } >/dev/null 2>&1; then
    echo "skipped: python3 with numpy and scipy cannot be had"
    exit 0
  fi
fi
"$python" "$here/check_judge.py" "$1"
"$python" "$here/run.py" "$1" --seconds "$2" --seed 7
