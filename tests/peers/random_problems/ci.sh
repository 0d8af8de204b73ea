#!/usr/bin/env bash
# Two minutes of random problems, judged by CasADi with IPOPT, and random events, judged by SciPy:
# `ci.sh target/release/fdcc`. Skipped where these cannot be had.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if ! { python3 -m venv "$folder/venv" && timeout 300 "$folder/venv/bin/pip" install --quiet casadi numpy scipy; } >/dev/null 2>&1; then
  echo "skipped: python3 with casadi, numpy and scipy cannot be had"
  exit 0
fi
"$folder/venv/bin/python" "$(dirname "$0")/check_judge.py"
"$folder/venv/bin/python" "$(dirname "$0")/run.py" "$1" --seconds 80 --seed 7
"$folder/venv/bin/python" "$(dirname "$0")/../events.py" "$1" --seconds 40 --seed 7
