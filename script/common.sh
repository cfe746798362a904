# Functions shared by the scripts. To be sourced by bash after `set -euo pipefail`.

# A program that ignores SIGINT, as under nohup or cron, passes this on to all its children. bash cannot undo it.
if [ "$(trap -p INT)" = "trap -- '' SIGINT" ] && [ -f "$0" ]; then
  exec env --default-signal=INT bash "$0" "$@"
fi

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

# ROS is installed for the system's Python, even if another Python comes first in the PATH.
export PATH=/usr/sbin:/usr/bin:/sbin:/bin:$PATH

# the prefix of the ROS that is sourced, or Noetic's; '' for the ROS packages of Debian's or Ubuntu's own archive
ros_name=noetic ros_root=${ROS_ROOT:-}
[ "${ROS_VERSION:-2}" = 2 ] || ros_name=${ROS_DISTRO:-noetic}
for ros in "${ros_root%/share/ros}" "/opt/ros/$ros_name" ''; do [ ! -f "$ros/setup.bash" ] || break; done

source_ros() { [ -z "$ros" ] || { set +u; source "$ros/setup.bash"; set -u; } }
source_ros

# packages needed to build and start the package
tool_packages=(catkin g++ make ros-environment)
# packages of the commands that the tutorial uses; the Debian packages depend on them
command_packages=(ros-core rosbash rospack-tools)
case $(. /etc/os-release; echo "${VERSION_ID:-14}") in   # as long as Debian 14 is not released, it has no number
  13) tool_packages+=(qt6-svg-plugins);;        # RViz uses Qt 6 and does not depend on the plugin that reads its icons
  14) command_packages=(python3-rosmsg python3-rosnode python3-rosparam python3-rosservice python3-rostopic rosbash
                        rospack-tools);;
esac
tool_packages+=("${command_packages[@]}")

dependencies() {        # KIND...: print the Debian packages of these kinds of dependencies in package.xml: exec, test
  local kind name
  for kind in "$@"; do
    sed -n "s,.*<${kind}_depend>\(.*\)</.*,\1,p" "$source_dir/package.xml" | while read -r name; do
      case $name in
        python3-*|rosbash|rosout|rviz) echo "$name";;
        robot_state_publisher) echo ros-robot-state-publisher;;
        roscpp) echo libroscpp-dev;;
        *) echo "python3-${name//_/-}";;
      esac
    done
  done
}

runtime_packages() {    # print the packages that the installed package needs
  { dependencies exec; printf '%s\n' "${command_packages[@]}"; } | sort -u
}

build_dependencies() {  # print the packages that debian/control lists as needed to build the Debian packages
  sed -n 's/^Build-Depends: //p' "$source_dir/debian/control" | sed 's/debhelper-compat ([^)]*)/debhelper/; s/, /\n/g'
}

package_version() {     # print the version of the Debian packages: it is higher after each commit and each uncommitted change
  local version; version=$(sed -n '1s/.*(\(.*\)).*/\1/p' "$source_dir/debian/changelog")
  if ! git -C "$source_dir" rev-parse --verify --quiet HEAD >/dev/null 2>&1; then echo "$version"
  elif [ -n "$(changed_files)" ]; then echo "$version+git$(date --utc +%Y%m%d%H%M%S)"
  else echo "$version+git$(TZ=UTC0 git -C "$source_dir" log -1 --date=format-local:%Y%m%d%H%M%S --format=%cd)"; fi
}

missing_packages() {    # PACKAGE...: print the packages that are not installed
  if [ -n "$ros" ]; then missing_in_ros "$@"; return; fi
  comm -23 <(printf '%s\n' "$@" | sort -u) <(dpkg-query -W -f '${binary:Package} ${db:Status-Status}\n' "$@" 2>/dev/null |
    sed -n 's/:[^ ]* installed$//p; s/ installed$//p' | sort -u)
}

missing_in_ros() {      # PACKAGE...: print those whose content cannot be found, by the names of ROS's archive
  local name key
  for name in "$@"; do
    key=${name#python3-}; key=${key#lib}; key=${key%-dev}; key=${key//-/_}
    case $name in
      python3-pil) key=PIL;; xvfb) key=Xvfb;; chromium-driver) key=chromedriver;; iproute2) key=ip;;
      ros-core) key=rostopic;; ros-robot-*) key=${key#ros_};; rospack-tools) key=rospack;;
      liburdfdom-tools) key=check_urdf;;
    esac
    { rospack find "$key" || command -v "$key" || /usr/bin/python3 -c "import $key"; } >/dev/null 2>&1 && continue
    case $key in catkin|ros_environment|rosbash|rospack) ;; *) grep -q ">$key<" "$source_dir/package.xml";; esac &&
      name=ros-$ros_name-${key//_/-}
    echo "$name"
  done | sort -u
}

available() {           # PACKAGE...: print the packages, without RViz and Chromium if the archive does not have them
  local name
  for name in "$@"; do
    [[ $name != *rviz && $name != chromium* ]] || apt-cache show "$name" >/dev/null 2>&1 || continue
    echo "$name"
  done
}

require_packages() {    # PACKAGE...: fail with one line if some are missing
  local missing; mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -eq 0 ] || { echo "These packages are missing: sudo apt-get install ${missing[*]}" >&2; return 1; }
}

install_missing() {     # PACKAGE...: install the missing packages
  local missing run=()
  [ -z "$ros" ] || echo "ROS $ros_name in $ros, $(/usr/bin/python3 --version)"
  mapfile -t missing < <(missing_packages "$@")
  # without the package lists, nothing is known to be unavailable
  ! apt-cache show g++ >/dev/null 2>&1 || mapfile -t missing < <(available "${missing[@]}")
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "These packages are missing: ${missing[*]}. Run this as root, or install sudo." >&2; return 1; }
    run=(sudo)
  fi
  echo "Installing ${missing[*]}"
  # One script at a time: a second one waits, and then finds nothing to do. If another apt is running, wait up to ten minutes.
  "${run[@]}" flock -o /run/lock env DEBIAN_FRONTEND=noninteractive bash -euc "$(declare -f available)"'
    log=$(mktemp)
    while sleep 10 >/dev/null 2>&1; do
      echo "Installing: $SECONDS s, $(grep -c ^Get: "$log") packages downloaded, $(grep -c "^Setting up" "$log") set up"
    done & trap "kill $!; rm -f $log" EXIT
    for try in $(seq 120); do
      { apt-get update -qq && apt-get install -y -q --no-install-recommends $(available "$@"); } >"$log" 2>&1 && exit
      grep -Eq "(Could not get|Unable to acquire).*lock" "$log" || break
      [ $try -gt 1 ] || echo "Waiting for another apt, which holds the lock"
      sleep 5
    done
    tail -20 "$log" >&2; exit 1
  ' install "${missing[@]}"
}

changed_files() {       # print the files with uncommitted changes
  git -C "$source_dir" status --porcelain --untracked-files=all 2>/dev/null | cut -c 4-
}

changed_tests() {       # print the unit tests of the changed modules, found by name, and the tests of lists, imports and scripts that pages show
  local path name
  changed_files | while read -r path; do
    printf 'test/unit/%s.py\n' test_rooms test_promises pages/test_parameter_tables pages/test_the_script
    [[ $path == *.py ]] || continue
    name=${path##*/}; name=${name%.py}
    find test/unit bench -name "test_*${name#test_}*.py"
  done | sort -u
}

changed_rooms() {       # print the folders of test/unit/ whose rooms have uncommitted changes
  changed_files | sed -n 's,^\(src/rbx1_nav\|test/unit\)/,,p' | while read -r path; do
    while [ "$path" != "${path%/*}" ]; do
      path=${path%/*}
      [ ! -d "$source_dir/test/unit/$path" ] || { echo "test/unit/$path"; break; }
    done
  done | sort -u
}

run() {                 # COMMAND...: run in its own process group, so that a signal to this script can stop the whole group
  set -m; "$@" </dev/null & set +m
  wait $!
}

end_all() {             # DIR: stop the processes of run(), and the nodes whose ROS_HOME is in DIR, which have their own sessions
  trap '' INT TERM HUP
  local job i
  for job in $(jobs -p); do
    kill -INT -- "-$job" 2>/dev/null || continue
    for ((i = 0; i < 100; i++)); do kill -0 -- "-$job" 2>/dev/null || break; sleep 0.1; done
    kill -KILL -- "-$job" 2>/dev/null || true
  done
  for i in $(grep -lsz "^ROS_HOME=$1/ros\$" /proc/[0-9]*/environ | cut -d / -f 3); do kill -KILL "$i" 2>/dev/null || true; done
}

make_workspace() {      # DIR [ARGUMENT...]: create a catkin workspace in DIR, and build it; ARGUMENT: for catkin_make
  local workspace=$1; shift
  mkdir -p "$workspace/src"
  ln -sfn "$source_dir" "$workspace/src/rbx1_nav"
  # catkin does not look for packages inside a package, hence the second link
  ln -sfn "$source_dir/rbx1_bringup" "$workspace/src/rbx1_bringup"
  clean_environment
  run build_workspace "$workspace" "$@"
  use_workspace "$workspace"
}

use_workspace() {       # DIR: set the environment as in a terminal in which only this workspace was sourced
  clean_environment
  set +u; source "$1/devel/setup.bash"; set -u
}

clean_environment() {   # remove other ROS installations from the environment, and keep bytecode out of the source tree
  unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_MASTER_URI ROS_HOSTNAME ROS_NAMESPACE PYTHONPATH
  export PYTHONDONTWRITEBYTECODE=1
  export CMAKE_POLICY_VERSION_MINIMUM=3.5       # for CMake 4, which rejects catkin's toplevel.cmake
  source_ros
}

build_workspace() {     # see make_workspace
  local workspace=$1; shift
  (cd "$workspace" && catkin_make -DPYTHON_EXECUTABLE=/usr/bin/python3 "$@") >"$workspace/build.log" 2>&1 ||
    { tail -40 "$workspace/build.log" >&2; return 1; }
}

loopback_only() {       # DIR: use the loopback interface only, and a directory for logs
  export ROS_IP=127.0.0.1 ROS_HOME=$1/ros ROS_LOG_DIR=$1/ros/log
  mkdir -p "$ROS_LOG_DIR"
}

free_port() {           # print a free TCP port of the loopback interface
  /usr/bin/python3 "$source_dir/test/ports.py"
}
