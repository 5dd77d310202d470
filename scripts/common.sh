# What scripts/run and scripts/test share; sourced by them.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build
devel=$root/devel # not inside build/, where rosrun does not look
ros_prefix=/opt/ros

say() { printf '== %s\n' "$*" >&2; }
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# The system's tools only: a Python, a compiler prefix or a workspace of the user's would shadow what ROS needs. A ROS
# of its own folder, as /opt/ros/noetic, that the user has sourced is the only one kept, without workspaces above it.
clean_environment() {
  local own_ros=''
  [[ -n ${ROS_DISTRO:-} && -f $ros_prefix/$ROS_DISTRO/setup.sh ]] && own_ros=$ros_prefix/$ROS_DISTRO
  export PATH=/usr/bin:/bin:/usr/sbin:/sbin LC_ALL=C.UTF-8
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

# source_setup FILE: catkin's scripts heed neither -e nor -u.
source_setup() {
  set +eu
  # shellcheck source=/dev/null
  source "$1"
  set -eu
}

# candidates NAME|NAME... [KEY...]: the packages that do for a line of dependencies.txt, the best one first: of a ROS that
# is sourced those of the keys. `-` stays: it may be missing.
candidates() {
  local key
  if [[ -n ${ROS_DISTRO:-} ]]; then
    for key in "${@:2}"; do
      [[ $key == - ]] || printf '%s\n' "ros-$ROS_DISTRO-${key//_/-}"
    done
  fi
  printf '%s\n' "${1//|/$'\n'}"
}

# is_installed NAME...: whether one of these packages is.
is_installed() {
  local states # it fails if it does not know one of them
  states=$(dpkg-query --show --showformat='${db:Status-Status}\n' "$@" 2>/dev/null) || true
  grep -qx installed <<<"$states"
}

# first_known NAME...: the first one that the package lists have; nothing if it may be missing, and is.
first_known() {
  local name
  for name; do
    [[ $name == - ]] && return
    apt-cache show "$name" >/dev/null 2>&1 && printf '%s\n' "$name" && return
  done
  die "the package archive has none of: $*"
}

# install_dependencies run|test: installs the packages of dependencies.txt that are missing, and nothing else.
install_dependencies() {
  local purpose=$1 line words names name missing=() packages=()
  while read -ra words; do
    [[ ${words[0]:-} == \#---- && $purpose == run ]] && break
    [[ -z ${words[0]:-} || ${words[0]} == \#* ]] && continue
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
  source_setup "$devel/setup.sh"
}

# free_port FIRST: the first port from FIRST on that nobody listens to.
free_port() {
  local port=$1
  while (: <"/dev/tcp/localhost/$port") 2>/dev/null; do
    port=$((port + 1))
  done
  printf '%s\n' "$port"
}
