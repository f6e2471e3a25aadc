#!/usr/bin/env bash
# Builds the wheel as `pip install .` does, looks into it, installs it into two fresh virtual
# environments, with the newest Gmsh from PyPI and with Debian's, and meshes in both. Needs PyPI.
# Usage: wheel.sh BUILD_FOLDER PYTHON
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$1
python=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset MESHGROW_GMSH_LIB MESHGROW_LIB MESHGROW_PROGRAM LD_LIBRARY_PATH PYTHONPATH
export PIP_DISABLE_PIP_VERSION_CHECK=1

fail() {
  printf 'FAILED: %s\n' "$*" >&2
  exit 1
}

"$python" -m venv "$work/newest"
"$work/newest/bin/pip" wheel --no-deps --wheel-dir "$work" \
  --config-settings=build-dir="$build/wheel" "$root" >"$work/wheel.log" 2>&1 ||
  { cat "$work/wheel.log"; fail "the wheel could not be built"; }
wheel=$(ls "$work"/meshgrow-*-py3-none-*.whl)

"$python" -m zipfile -l "$wheel" | awk 'NR > 1 {print $1}' >"$work/content.txt"
for file in meshgrow/__init__.py meshgrow/py.typed meshgrow/libmeshgrow.so meshgrow/bin/meshgrow; do
  grep -qx "$file" "$work/content.txt" || fail "$file is not in the wheel"
done
! grep -iE 'gmsh|\.h$|\.hpp$|\.a$|\.cmake$|\.pc$' "$work/content.txt" || fail "not for a wheel"

"$work/newest/bin/pip" install --quiet "$wheel" gmsh || fail "the wheel beside gmsh from PyPI"
"$python" -m venv --system-site-packages "$work/debian"
"$work/debian/bin/pip" install --quiet --no-index "$wheel" || fail "the wheel beside python3-gmsh"
for environment in newest debian; do
  # From a folder where the sources are not found instead.
  (cd "$work" && "$work/$environment/bin/python" "$here/use_wheel.py") ||
    fail "the wheel does not work in the environment $environment"
done
