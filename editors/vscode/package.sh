#!/usr/bin/env bash
# Makes `target/editors/fdc.vsix`, for `code --install-extension`. With a path, that `fdcc` is put into it.
# usage: editors/vscode/package.sh [FDCC]
set -euo pipefail
cd "$(dirname "$0")"

out=../../target/editors
mkdir -p "$out"
rm -rf out
[ -d node_modules ] || npm ci --ignore-scripts --silent
npm run --silent types
npm run --silent build
if [ $# -gt 0 ]; then install -m 755 "$1" out/fdcc; fi
# The licence and the page of the extension are those of the project.
cp ../../LICENSE-MIT out/LICENSE.txt
npx vsce package --no-dependencies --allow-missing-repository --skip-license --out "$out/fdc.vsix"
