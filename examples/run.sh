#!/usr/bin/env bash
# Sets up a fresh machine, builds meshgrow and runs the examples. Arguments pick some of them, for
# example: examples/run.sh figure8
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/setup.sh

all=(figure8 assembly two_faces volume_in_volume real_parts callbacks plain_gmsh with_pygmsh
  size_functions stock_gmsh_serve stock_gmsh_view sweep_dask)
export MESHGROW_EXAMPLES_OUT=${MESHGROW_EXAMPLES_OUT:-$PWD/examples/out}
mkdir -p "$MESHGROW_EXAMPLES_OUT"

# Those in .geo: by the program meshgrow, and by Debian's gmsh as it is.
run_geo() {
  local PATH=$build/bin:$PATH
  local -x MESHGROW_GMSH_LIB=$libgmsh_debian
  cp "examples/$1.geo" "$MESHGROW_EXAMPLES_OUT"
  cd "$MESHGROW_EXAMPLES_OUT"
  case $1 in
    size_functions) meshgrow mesh "$1.geo" -3 -o "$1.msh" ;;
    stock_gmsh_view)
      rm -f sizes.pos
      meshgrow field "$1.geo" -o sizes.pos --size-function \
        'curvature source Surface{:} attach Volume{1} angle 15 growth 1.3 limit 0.4'
      gmsh -3 -v 2 "$1.geo" -o "$1.msh"
      ;;
    *) gmsh -v 2 - "$1.geo" ;;
  esac
  meshgrow report "$1.msh" --dim "$([ "$1" = stock_gmsh_serve ] && echo 2 || echo 3)"
}

for example in "${@:-${all[@]}}"; do
  if [ -e "examples/$example.geo" ]; then
    say "Meshing examples/$example.geo"
    (run_geo "$example")
    continue
  fi
  [ -e "examples/$example.py" ] || fail "there is no example '$example': give one of ${all[*]}."
  say "Running examples/$example.py"
  "$python_newest" "examples/$example.py"
done
say "Done. Look at the pictures in examples/out, or open a mesh: gmsh $(ls -t "$MESHGROW_EXAMPLES_OUT"/*.msh | head -n 1)"
