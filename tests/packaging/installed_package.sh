#!/usr/bin/env bash
# Installs the build tree, moves what was installed, and builds and runs the C and C++ examples against
# it as a user would: with CMake and with pkg-config, with Debian's Gmsh.
# Usage: installed_package.sh BUILD_FOLDER
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset MESHGROW_GMSH_LIB MESHGROW_LIB MESHGROW_PROGRAM LD_LIBRARY_PATH

fail() {
  printf 'FAILED: %s\n' "$*" >&2
  exit 1
}

expect_in() {  # part, file
  grep -qF -- "$1" "$2" || { cat "$2"; fail "no '$1' in $(basename "$2")"; }
}

cmake --install "$build" --prefix "$work/installed" >"$work/install.log"
mv "$work/installed" "$work/moved"
prefix=$work/moved
! grep -rIl "$work/installed\|$root" "$prefix" || fail "these files name the folder they came from"
version=$(sed -n 's/^project(meshgrow VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")

# The library: a name of its own, no libgmsh, no symbols but those of the C interface.
library=$prefix/lib/libmeshgrow.so
[ -e "$library" ] || library=$(ls "$prefix"/lib/*/libmeshgrow.so)
readelf -d "$library" >"$work/library.txt"
expect_in "soname: [libmeshgrow.so.${version%%.*}]" "$work/library.txt"
! grep -i 'NEEDED.*gmsh' "$work/library.txt" || fail "the library is linked to a libgmsh"
! nm -D --defined-only "$library" | grep -v ' meshgrow_' || fail "these symbols are exported as well"

# The program.
"$prefix/bin/meshgrow" --version >"$work/version.txt" || fail "the program ran"
expect_in "meshgrow $version" "$work/version.txt"

# C++, with CMake; what only meshgrow's own build needs must not be looked for.
cmake -S "$root/examples/cpp_project" -B "$work/cpp" -DCMAKE_PREFIX_PATH="$prefix" \
  --no-warn-unused-cli -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON \
  >"$work/configure.log" || { cat "$work/configure.log"; fail "find_package(meshgrow)"; }
cmake --build "$work/cpp" >"$work/build.log" || { cat "$work/build.log"; fail "the C++ example"; }
"$work/cpp/box_in_box" "$work/box_in_box.msh" >"$work/cpp.txt" || fail "the C++ example ran"
expect_in "outer, grown" "$work/cpp.txt"
expect_in "Elements" "$work/box_in_box.msh"

# The version is asked for: one that is not there yet is refused.
mkdir "$work/later"
cat >"$work/later/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.18)
project(later LANGUAGES CXX)
find_package(meshgrow 77 REQUIRED)
END
! cmake -S "$work/later" -B "$work/later/build" -DCMAKE_PREFIX_PATH="$prefix" \
  >"$work/later.log" 2>&1 || fail "version 77 was found"
expect_in "77" "$work/later.log"

# C, with pkg-config.
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name meshgrow.pc)")
[ "$(pkg-config --modversion meshgrow)" = "$version" ] || fail "version of meshgrow.pc"
read -r -a flags <<<"$(pkg-config --cflags --libs meshgrow)"
cc -std=c99 -Wall -Wextra -Werror "$root/examples/c_project/cavity.c" "${flags[@]}" -lgmsh \
  -Wl,-rpath,"$(dirname "$library")" -o "$work/cavity"
"$work/cavity" "$work/cavity.msh" >"$work/c.txt" || fail "the C example ran"
expect_in '"ratio_99"' "$work/c.txt"
expect_in "Elements" "$work/cavity.msh"
printf 'The installed package works: meshgrow %s\n' "$version"
