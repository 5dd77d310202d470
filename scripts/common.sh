# Functions that several scripts of this folder use, which source this file.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
devel=$root/devel # beside build/, not in it, because rosrun does not look into build/
ros_prefix=/opt/ros

say() { printf '== %s\n' "$*" >&2; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# Leaves only the system's tools in the environment: a Python, a compiler or a workspace of the user's would hide what ROS
# needs. Only a sourced ROS in a folder of its own, such as /opt/ros/noetic, is kept, without workspaces on top of it.
clean_environment() {
  local own_ros=''
  [[ -n ${ROS_DISTRO:-} && -f $ros_prefix/$ROS_DISTRO/setup.sh ]] && own_ros=$ros_prefix/$ROS_DISTRO
  export PATH=/usr/bin:/bin:/usr/sbin:/sbin LC_ALL=C.UTF-8 PYTHONNOUSERSITE=1
  unset PYTHONPATH PYTHONHOME PYTHONSTARTUP VIRTUAL_ENV CONDA_PREFIX LD_LIBRARY_PATH LD_PRELOAD CPATH C_INCLUDE_PATH \
    CPLUS_INCLUDE_PATH LIBRARY_PATH CMAKE_PREFIX_PATH CMAKE_GENERATOR DESTDIR PKG_CONFIG_PATH ROS_PACKAGE_PATH ROS_ROOT \
    ROS_DISTRO ROS_IP ROS_NAMESPACE ROS_MASTER_URI CATKIN_SETUP_UTIL_ARGS BASH_ENV CDPATH
  export ROS_HOSTNAME=localhost ROS_HOME=$build/ros ROS_LOG_DIR=$build/ros/log
  if [[ -z ${HOME:-} || ! -w ${HOME:-} ]]; then
    export HOME=$build/home
  fi
  mkdir -p "$ROS_LOG_DIR" "$HOME"
  if [[ -n $own_ros ]]; then
    source_setup "$own_ros/setup.sh"
  fi
}

# source_setup FILE: catkin's scripts do not work with `set -eu`.
source_setup() {
  set +eu
  # shellcheck source=/dev/null
  source "$1"
  set -eu
}

# candidates NAME|NAME... [KEY...]: prints the packages that can serve a line of dependencies.txt, the best one first. If
# a ROS is sourced, its packages of the keys come first. `-` stays, which means that the package may be missing.
candidates() {
  local key
  if [[ -n ${ROS_DISTRO:-} ]]; then
    for key in "${@:2}"; do
      [[ $key == - ]] || printf '%s\n' "ros-$ROS_DISTRO-${key//_/-}"
    done
  fi
  printf '%s\n' "${1//|/$'\n'}"
}

# is_installed NAME...: whether one of these packages is installed.
is_installed() {
  local states # dpkg-query fails if it does not know one of the packages
  states=$(dpkg-query --show --showformat='${db:Status-Status}\n' "$@" 2>/dev/null) || true
  grep -qx installed <<<"$states"
}

# first_known NAME...: prints the first package that the package lists contain; nothing if `-` comes before it. apt-cache
# shows nothing, and does not fail, for packages that others only mention.
first_known() {
  local name
  for name; do
    [[ $name == - ]] && return
    [[ -n $(apt-cache show "$name" 2>/dev/null) ]] && printf '%s\n' "$name" && return
  done
  die "the package archive has none of: $*"
}

# install_dependencies run|test [LEFT_OUT...]: installs the packages of dependencies.txt that are missing, and nothing else.
# Lines of a key in LEFT_OUT are left out.
install_dependencies() {
  local purpose=$1 line words names name missing=() packages=()
  while read -ra words; do
    [[ ${words[0]:-} == \#---- && $purpose == run ]] && break
    [[ -z ${words[0]:-} || ${words[0]} == \#* || " ${*:2} " == *" ${words[1]} "* ]] && continue
    mapfile -t names < <(candidates "${words[@]}")
    is_installed "${names[@]}" || missing+=("${names[*]}")
  done <"$root/scripts/dependencies.txt"
  ((${#missing[@]})) || return 0

  local as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null || die "these packages are missing, and only root can install them: ${missing[*]}"
    as_root=(sudo)
  fi
  export DEBIAN_FRONTEND=noninteractive
  "${as_root[@]}" apt-get update -qq >&2 || say "apt-get update failed; going on with the package lists at hand"
  for line in "${missing[@]}"; do
    read -ra names <<<"$line"
    name=$(first_known "${names[@]}") || exit
    packages+=(${name:+"$name"})
  done
  ((${#packages[@]})) || return 0
  say "installing ${packages[*]}"
  "${as_root[@]}" apt-get install --yes --quiet --no-install-recommends "${packages[@]}" </dev/null >&2 ||
    die "could not install ${packages[*]}: docs/portability.md says which systems have them"
}

# build TARGET...: configures and builds; prints errors only.
build() {
  local log=$build/build.log
  say "building in $build (details: $log)"
  {
    # A build folder that was moved together with the tree cannot be used.
    if [[ -f $build/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
      rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles"
    fi
    # A fresh build compiles files in groups of eight, with Ninja. Ninja compiles a program's files before the library to
    # which they are linked is complete, so that no processor waits. Other build folders stay configured as they are.
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

# Lets ROS find the package in the folder where it was built.
enter_workspace() {
  source_setup "$devel/setup.sh"
}

# After the demo, for which only the node is built: says how to build the rest.
say_what_is_missing() {
  [[ -x $devel/lib/flexarm/flexarm ]] || say "scripts/build builds the rest: the program flexarm and the Python module"
}

# free_port FIRST: prints the first port, from FIRST on, on which nobody listens.
free_port() {
  local port=$1
  while (: <"/dev/tcp/localhost/$port") 2>/dev/null; do
    port=$((port + 1))
  done
  printf '%s\n' "$port"
}
