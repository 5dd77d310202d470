# What scripts/run and scripts/test share; sourced by them.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
devel=$root/devel # not inside build/, where rosrun does not look

say() { printf '== %s\n' "$*" >&2; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# The system's tools only: a Python, a compiler prefix or a workspace of the user's would shadow what Debian's ROS needs.
clean_environment() {
  export PATH=/usr/bin:/bin:/usr/sbin:/sbin LC_ALL=C.UTF-8
  unset PYTHONPATH PYTHONHOME PYTHONSTARTUP VIRTUAL_ENV CONDA_PREFIX LD_LIBRARY_PATH LD_PRELOAD CPATH C_INCLUDE_PATH \
    CPLUS_INCLUDE_PATH LIBRARY_PATH CMAKE_PREFIX_PATH CMAKE_GENERATOR DESTDIR PKG_CONFIG_PATH ROS_PACKAGE_PATH ROS_ROOT \
    ROS_DISTRO ROS_IP ROS_NAMESPACE ROS_MASTER_URI CATKIN_SETUP_UTIL_ARGS BASH_ENV CDPATH
  export ROS_HOSTNAME=localhost ROS_HOME=$build/ros ROS_LOG_DIR=$build/ros/log
  if [[ -z ${HOME:-} || ! -w ${HOME:-} ]]; then
    export HOME=$build/home
  fi
  mkdir -p "$ROS_LOG_DIR" "$HOME"
}

# install_dependencies run|test: installs the Debian packages of dependencies.txt that are missing, and nothing else.
install_dependencies() {
  local purpose=$1 package missing=()
  while read -r package _; do
    [[ $package == \#---- && $purpose == run ]] && break
    [[ -z $package || $package == \#* ]] && continue
    dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed ||
      missing+=("$package")
  done <"$root/scripts/dependencies.txt"
  ((${#missing[@]})) || return 0

  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "these packages are missing, and only root can install them: ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  "${as_root[@]}" apt-get update -qq >&2 || say "apt-get update failed; going on with the package lists at hand"
  "${as_root[@]}" apt-get install --yes --quiet --no-install-recommends "${missing[@]}" </dev/null >&2 ||
    die "could not install ${missing[*]}: flexarm needs Debian 12 and, once, its package archive"
}

# build TARGET...: configures and builds; says little unless something is wrong.
build() {
  local log=$build/build.log
  say "building in $build (details: $log)"
  {
    # A build directory that was moved along with the tree cannot be used.
    if [[ -f $build/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
      rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles"
    fi
    # From nothing, files are compiled by eights, and by Ninja, which compiles a program's files while a library that it
    # links is not complete yet: no processor waits. A folder goes on as it was configured first.
    local from_nothing=()
    [[ -f $build/CMakeCache.txt ]] || from_nothing=(-G Ninja -DFLEXARM_FILES_TOGETHER=ON)
    cmake -S "$root" -B "$build" \
      -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_DEVEL_PREFIX="$devel" "${from_nothing[@]}" &&
      cmake --build "$build" --parallel "$(nproc)" --target "$@"
  } >"$log" 2>&1 </dev/null || {
    grep -E -B2 -A8 'error|Error' "$log" | tail -n 60 >&2 || tail -n 60 "$log" >&2
    die "the build failed: see $log"
  }
}

# Makes ROS find the package where it was built.
enter_workspace() {
  set +eu # the generated script heeds neither
  # shellcheck source=/dev/null
  source "$devel/setup.sh"
  set -eu
}

# free_port FIRST: the first port from FIRST on that nobody listens to.
free_port() {
  local port=$1
  while (: <"/dev/tcp/localhost/$port") 2>/dev/null; do
    port=$((port + 1))
  done
  printf '%s\n' "$port"
}
