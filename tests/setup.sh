# Sourced by tests/run.sh, examples/run.sh and the other scripts: brings a fresh Debian 12 machine to
# where the project builds and runs, and builds it. Asks for nothing that is there already.
#
# Sets: root, build (folder), python_debian (Python with Debian's Gmsh 4.8.4), python_newest (Python
# with the newest Gmsh from PyPI) and libgmsh_debian, libgmsh_newest.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${MESHGROW_BUILD:-$root/build}

say() { printf '\n== %s\n' "$*"; }

fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# Peers of the benchmarks, for who sets with_benchmarks; compilers and tools of the checks beside the
# tests (sanitizers, fuzzing, clang-tidy, coverage), for who sets with_checks.
extra_packages=()
[ -z "${with_benchmarks:-}" ] || extra_packages+=(libcgal-dev libembree-dev libbenchmark-dev)
[ -z "${with_checks:-}" ] || extra_packages+=(clang clang-tidy llvm libomp-dev python3-coverage)

install_packages() {
  local wanted=(
    g++ cmake ninja-build pkgconf
    libeigen3-dev libcli11-dev nlohmann-json3-dev libxxhash-dev libgtest-dev
    gmsh libgmsh-dev gmsh-doc python3-gmsh python3-numpy python3-pytest python3-venv
    libglu1-mesa libxcursor1 libxfixes3 libxft2 libxinerama1
    xvfb xauth libgl1-mesa-dri fonts-dejavu-core chromium "${extra_packages[@]}")
  local missing=()
  local package
  for package in "${wanted[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  say "Installing Debian packages: ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      fail "these packages are missing: ${missing[*]}; install them as root, then run this again."
    sudo=(sudo env DEBIAN_FRONTEND=noninteractive)
  fi
  # The documentation of gmsh-doc holds the example models; slim images leave documentation out.
  export DEBIAN_FRONTEND=noninteractive
  "${sudo[@]}" apt-get update -qq &&
    "${sudo[@]}" apt-get install -qq -y --no-install-recommends \
      -o Dpkg::Options::=--path-include=/usr/share/doc/gmsh-doc/* "${missing[@]}" >/dev/null ||
    fail "apt-get could not install: ${missing[*]}"
}

make_python() {
  python_debian=/usr/bin/python3
  python_newest=$build/venv/bin/python
  local complete=$build/venv/complete-4  # another number when other packages are wanted
  if [ ! -e "$complete" ]; then
    say "Installing the newest Gmsh from PyPI into $build/venv"
    mkdir -p "$build"
    "$python_debian" -m venv "$build/venv" &&
      "$build/venv/bin/pip" install --quiet --disable-pip-version-check gmsh numpy pytest pillow \
        pygmsh meshio distributed matplotlib jinja2 mypy ||
      fail "the newest gmsh could not be installed from PyPI."
    touch "$complete"
  fi
  libgmsh_newest=$(ls "$build"/venv/lib/libgmsh.so.* | head -n 1)
  libgmsh_debian=$(ls /usr/lib/*/libgmsh.so.4.8 | head -n 1)
}

build_project() {
  say "Building meshgrow in $build"
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DMESHGROW_BUILD_TESTS=ON >"$build/configure.log" ||
    fail "cmake failed: see $build/configure.log"
  cmake --build "$build" -j2 || fail "the build failed."
}

install_packages
make_python
# Who sets without_build builds in a way and place of its own.
[ -n "${without_build:-}" ] || build_project
export PYTHONPATH=$build/python
