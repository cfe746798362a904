# What script/demo and script/test share. Sourced by bash, after `set -euo pipefail`.

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

# ROS lives in the system's Python, whatever else the PATH puts first.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin:$PATH

# Debian 13's RViz uses Qt 6 and does not depend on the plugin that reads its icons.
rviz_packages=(rviz)
if . /etc/os-release; [ "${VERSION_ID:-0}" = 13 ]; then rviz_packages+=(qt6-svg-plugins); fi

install_missing() {     # PACKAGE...: install those that are missing
  local missing=() package run=()
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "These packages are missing: ${missing[*]}. Run this as root, or install sudo." >&2; return 1; }
    run=(sudo)
  fi
  echo "Installing ${missing[*]}"
  # one at a time: a second script waits, and then finds nothing to do
  "${run[@]}" flock /run/lock env DEBIAN_FRONTEND=noninteractive bash -euc '
    log=$(mktemp); trap "rm -f $log" EXIT
    { apt-get update -qq && apt-get install -y -qq --no-install-recommends "$@"; } >"$log" 2>&1 || { tail -20 "$log" >&2; exit 1; }
  ' install "${missing[@]}"
}

make_workspace() {      # DIR [CMAKE_ARGUMENT...]: make and build a catkin workspace there
  local workspace=$1; shift
  mkdir -p "$workspace/src"
  ln -sfn "$source_dir" "$workspace/src/rbx1_nav"
  # catkin does not look for packages inside a package, hence the second link
  ln -sfn "$source_dir/rbx1_bringup" "$workspace/src/rbx1_bringup"
  # settings of another ROS installation must not be inherited
  unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_MASTER_URI ROS_HOSTNAME ROS_NAMESPACE PYTHONPATH
  # no bytecode beside the sources
  export PYTHONDONTWRITEBYTECODE=1
  (cd "$workspace" && catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3 "$@") >"$workspace/build.log" 2>&1 ||
    { tail -40 "$workspace/build.log" >&2; return 1; }
  set +u; source "$workspace/devel/setup.bash"; set -u
}

loopback_only() {       # DIR: use the loopback interface only, and a directory for logs
  export ROS_IP=127.0.0.1 ROS_HOME=$1/ros ROS_LOG_DIR=$1/ros/log
  mkdir -p "$ROS_LOG_DIR"
}

free_port() {           # print a free TCP port of the loopback interface
  /usr/bin/python3 "$source_dir/test/ports.py"
}
