"""What others can reach, what external files can do, and what is left behind."""
import ast
import glob
import os
import signal
import stat
import time

import rospkg

import processes
import support

FAULT = ('sockets, temporary files, YAML that contains code, and parent processes that are stopped by each kind of '
         'signal')
PROMISE = ('the nodes of this package listen on loopback only; temporary files are private; no external code runs; '
           'child processes exit within 1 s of their parent, except the nodes of a roslaunch that is killed by '
           'SIGKILL')
FULL, SHORT = 30, 3
ROOT = ALONE = False

PACKAGE = rospkg.RosPack().get_path('rbx1_nav')
MARK = 'RBX1_NAV_FAULT'
CODE = '!!python/object/apply:os.system ["touch %s"]'
# in calls, names that evaluate text or bytes; subprocess and shells are looked at as `shell=True`
EVALUATE = {'eval', 'exec', 'compile', '__import__', 'system', 'popen', 'unsafe_load', 'full_load', 'load_all',
            'FullLoader', 'UnsafeLoader', 'Unpickler'}
# runs the script that a user has typed, in a browser
RUNNER = 'extras/page/runner.py'
MODULES = {'pickle', 'marshal', 'shelve', 'dill', 'cloudpickle'}


def marked(row):
    """A new mark, and a function that finds the processes that have it."""
    mark = '%d.%d' % (os.getpid(), row.faults)
    return {MARK: mark}, lambda: processes.with_variable(MARK, mark)


def sockets(row):
    """Who listens where, while both scripts drive on a surface."""
    base = row.start('roslaunch', '--wait', 'rbx1_nav', 'fake_turtlebot.launch', 'surface:=hard_floor',
                     'real_time_factor:=5')
    base.wait_for_line('Ready: ')
    ekf = row.start('roslaunch', '--wait', 'rbx1_bringup', 'odom_ekf.launch')
    ekf.wait_for_line('Publishing /odom_ekf')
    found = {}
    for script in 'timed_out_and_back.py', 'odom_out_and_back.py':
        driver = row.start('rosrun', 'rbx1_nav', script)
        driver.wait_for_line('forward')
        # roslaunch passes its master on with a slash at the end
        for pid in {pid for end in ('', '/') for pid in
                    processes.with_variable('ROS_MASTER_URI', os.environ['ROS_MASTER_URI'] + end)}:
            for protocol, address in processes.listening(pid):
                found.setdefault((processes.is_python(pid), processes.is_loopback(address)), set()).add(
                    f'{protocol} {address}: {processes.commands([pid])}')
        assert driver.wait() == 0, driver.output
    row.end(base, ekf)
    row.figure('open Python sockets on loopback', len(found.get((True, True), ())))
    # its XML-RPC server: roscpp asks ROS_IP for its name only
    row.figure('open roscpp sockets on all interfaces', len(found.get((False, False), ())))
    assert (True, False) not in found, '\n'.join(found[True, False])
    assert len(found.get((True, True), ())) >= 10, 'only these: %s' % {k: sorted(v) for k, v in found.items()}


def temporary_files(row):
    """script/demo, interrupted by a signal while it builds."""
    folder = os.path.abspath('tmp.%d' % row.faults)
    os.mkdir(folder)
    variables, find = marked(row)
    demo = row.start('bash', '-c', f'umask 0; exec {PACKAGE}/script/demo --fast', TMPDIR=folder, **variables)
    support.wait_for(lambda: len(os.listdir(folder)) >= 2, 'temporary folders')
    time.sleep(row.random.uniform(0, 15))
    for name in os.listdir(folder) + ['..']:
        mode = stat.S_IMODE(os.stat(os.path.join(folder, name)).st_mode)
        assert mode & 0o077 == 0, f'{name} has the mode {mode:o}'
    os.killpg(demo.process.pid, row.random.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP]))
    demo.wait()
    processes.wait_for_end(find, 1.0)
    assert not glob.glob(f'{folder}/rbx1_nav-scratch.*'), os.listdir(folder)


def foreign_code(row):
    """Tags that make an unsafe YAML loader run a command."""
    with open('code.yaml', 'w', encoding='ascii') as file:
        file.write('lag: %s\ncontrollers: %s\nrate: %s\n' % (3 * (CODE % os.path.abspath('ran'),)))
    path = os.path.abspath('code.yaml')
    for command in (['rosrun', 'rbx1_nav', 'simulate.py', '--runs', '1', '--config', path],
                    ['rosrun', 'rbx1_nav', 'simulate.py', '--runs', '1', '--surface', path],
                    ['roslaunch', '--wait', 'rbx1_nav', 'fake_turtlebot.launch', f'config:={path}'],
                    ['rosparam', 'load', path, '/robot_pose_ekf'],
                    ['rosrun', 'rbx1_nav', 'ekf.py', f'_surface:={path}'],
                    ['rosrun', 'rbx1_nav', 'timed_out_and_back.py', f"_rate:={CODE % os.path.abspath('ran')}"]):
        process = row.start(*command)
        assert process.wait() != 0, f'{command}: {process.output}'
        assert not os.path.exists('ran'), f'{command} ran a command'


def sources(_):
    """No source evaluates what it has read."""
    files = [path for folder in ('src', 'nodes', 'script')
             for path in glob.glob(f'{PACKAGE}/{folder}/**/*.py', recursive=True)]
    assert len(files) > 40
    for path in files:
        with open(path, encoding='utf-8') as file:
            for node in ast.walk(ast.parse(file.read())):
                where = f"{path}:{getattr(node, 'lineno', '')}"
                if isinstance(node, (ast.Import, ast.ImportFrom)):
                    names = {alias.name.split('.')[0] for alias in node.names} | {getattr(node, 'module', None)}
                    assert not names & MODULES, where
                elif isinstance(node, ast.Call):
                    name = getattr(node.func, 'attr', getattr(node.func, 'id', None))
                    module = getattr(getattr(node.func, 'value', None), 'id', None)
                    regular = (module, name) == ('re', 'compile')
                    runs = path.endswith(RUNNER) and name in ('compile', 'exec')
                    assert name not in EVALUATE or regular or runs, f'{where}: {name}'
                    assert (module, name) != ('yaml', 'load'), where
                    assert not any(keyword.arg == 'shell' for keyword in node.keywords), where


def orphans(row):
    """A parent ends, by any signal; its children too."""
    variables, find = marked(row)
    number = row.random.choice([signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
    launch = row.start('roslaunch', '--wait', 'rbx1_nav', 'fake_turtlebot.launch', **variables)
    launch.wait_for_line('Ready: ')
    time.sleep(row.random.uniform(0, 1))
    launch.signal(number)
    launch.wait()
    if number == signal.SIGKILL:        # roslaunch's nodes are not its to end then
        row.figure('processes left after SIGKILL to roslaunch', len(find()))
        for pid in find():
            os.kill(pid, signal.SIGKILL)
    else:
        row.figure('last child of roslaunch exited after (s)', processes.wait_for_end(find, 1.0))


def run(row):
    """See FAULT."""
    row.roscore()
    kinds = [sources, sockets, orphans, foreign_code, temporary_files]
    for number in range(row.times):
        fault = kinds[number] if number < len(kinds) else row.random.choice([orphans, orphans, temporary_files])
        with row.fault(fault.__name__):
            fault(row)
