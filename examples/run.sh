#!/usr/bin/env bash
# Sets up a fresh machine, builds meshgrow, runs the examples and makes a page of their pictures and
# numbers, examples/out/index.html. Arguments pick some of them, for example:
# examples/run.sh airfoil
set -euo pipefail
cd "$(dirname "$0")/.."

# In the order of the paper's figures; then real parts, then ways to use it.
all=(airfoil volume_in_volume figure8 two_faces imported_face assembly real_parts scanned_surface
  terrain crack earlier_run callbacks plain_gmsh with_pygmsh size_functions stock_gmsh_serve
  stock_gmsh_serve_3d stock_gmsh_view sweep_dask)
for example in "$@"; do
  if [[ " ${all[*]} " != *" $example "* ]]; then
    printf "error: there is no example '%s': give one of %s.\n" "$example" "${all[*]}" >&2
    exit 1
  fi
done
. tests/setup.sh
export MESHGROW_EXAMPLES_OUT=${MESHGROW_EXAMPLES_OUT:-$PWD/examples/out}
mkdir -p "$MESHGROW_EXAMPLES_OUT"

# Those for stock gmsh: by Debian's gmsh as it is.
run_stock() {
  local PATH=$build/bin:$PATH
  local -x MESHGROW_GMSH_LIB=$libgmsh_debian
  cp "examples/$1.geo" "$MESHGROW_EXAMPLES_OUT" || return
  (
    cd "$MESHGROW_EXAMPLES_OUT" || exit
    if [ "$1" = stock_gmsh_view ]; then
      rm -f sizes.pos
      meshgrow field "$1.geo" -o sizes.pos --size-function \
        'curvature source Surface{:} attach Volume{1} angle 15 growth 1.3 limit 0.4' &&
        gmsh -3 -v 2 "$1.geo" -o "$1.msh"
    else
      gmsh -v 2 - "$1.geo"
    fi
  ) || return
  "$build/bin/meshgrow" report "$MESHGROW_EXAMPLES_OUT/$1.msh" \
    --dim "$([ "$1" = stock_gmsh_serve ] && echo 2 || echo 3)"
}

# A .geo that `meshgrow mesh` meshes, by the first command of its heading.
run_geo() {
  local PATH=$build/bin:$PATH
  local -x MESHGROW_GMSH_LIB=$libgmsh_newest
  local command
  read -ra command < <(sed -n 's|^// *\(meshgrow mesh .*\)|\1|p' "examples/$1.geo")
  printf '%s\n' "${command[*]}"
  cp "examples/$1.geo" "$MESHGROW_EXAMPLES_OUT" || return
  (cd "$MESHGROW_EXAMPLES_OUT" && "${command[@]}")
}

run_example() {
  if [ -e "examples/$1.py" ]; then
    say "Running examples/$1.py"
    "$python_newest" "examples/$1.py" || return
  fi
  if [ -e "examples/$1.geo" ]; then
    say "Meshing examples/$1.geo"
    case $1 in
      stock_gmsh_*) run_stock "$1" || return ;;
      *) run_geo "$1" || return ;;
    esac
  fi
  if [ -e "examples/$1.cpp" ]; then
    say "Running examples/$1.cpp"
    "$build/bin/examples/${1}_newest" "$MESHGROW_EXAMPLES_OUT/${1}_cpp.msh" || return
  fi
}

# Cases of examples that are no more must not stay on the page.
[ $# -gt 0 ] || rm -f "$MESHGROW_EXAMPLES_OUT"/*.case.json "$MESHGROW_EXAMPLES_OUT"/*.png
failed=()
for example in "${@:-${all[@]}}"; do
  run_example "$example" || failed+=("$example")
done

say "Making the page"
"$python_newest" examples/page/make_page.py
[ ${#failed[@]} = 0 ] || fail "these examples failed, see above: ${failed[*]}."
say "Done. Open $MESHGROW_EXAMPLES_OUT/index.html, or a mesh: gmsh $(ls -t "$MESHGROW_EXAMPLES_OUT"/*.msh | head -n 1)"
