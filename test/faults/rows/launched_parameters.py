"""Invalid files and parameters, passed to real processes."""
import os
import re

import rospy
import yaml

FAULT = 'the actual base, filter, script or simulation is started with an invalid file or parameter'
PROMISE = 'a one-line error that names the key, and a non-zero exit status'
FULL, SHORT = 20, 8
ROOT = ALONE = False

HUGE = f"1{400 * '0'}"
# (the base reads a file, the filter and the scripts parameters, simulate.py files), each rejected by its node
BASE = 'controllers: {base: {type: diff_controller, %s}}'
# all of them are rejected; roslaunch itself has no line for an integer that XML-RPC cannot hold, so no base gets HUGE
REAL = [('base', BASE % 'base_width: .nan'), ('base', BASE % 'base_width: 0.26, rate: 1.0e-320'),
        ('base', BASE % 'base_width: 0.26, wheel_radius: 1.0e-320'), ('base', '"two\\nlines": 1'),
        ('base', BASE % 'base_width: 0.26, odom_frame_id: "two\\nlines"'),
        ('filter', 'freq: 1.0e-320'), ('filter', 'sensor_timeout: .nan'), ('filter', 'output_frame: "two\\nlines"'),
        ('filter', 'imu_used: [1]'), ('filter', 'surface: {a: "two\\nlines"}'),
        ('script', f'rate: {HUGE}'), ('script', 'rate: 1.0e-320'), ('script', 'linear_speed: .nan'),
        ('script', 'goal_distance: 1.0e+308'), ('script', 'goal_angle: [1, 2'),
        ('--config', f"controllers: {500 * '['}"), ('--config', BASE % (f'base_width: {HUGE}')),
        ('--surface', 'lag: !!bool maybe'), ('--surface', f'lag: {HUGE}'), ('--surface', '\0')]


def check(row, kind, text):
    """One process."""
    path = os.path.abspath('bad.yaml')
    with open(path, 'w', encoding='utf-8') as file:
        file.write(text)
    if kind == 'base':
        process = row.start('roslaunch', '--wait', 'rbx1_nav', 'fake_turtlebot.launch', f'config:={path}')
        process.wait()
        # roslaunch's own status is 0 whatever happened to its nodes
        assert 'exit code 1, ' in process.output, process.output
    elif kind.startswith('--'):
        process = row.start('rosrun', 'rbx1_nav', 'simulate.py', '--runs', '1', kind, path)
        assert process.wait() == 1 and len(process.lines) == 1, process.output[-1500:]
    elif kind == 'filter':
        rospy.set_param('/robot_pose_ekf', yaml.safe_load(text))
        process = row.start('rosrun', 'rbx1_nav', 'ekf.py')
        assert process.wait() == 1, process.output
        rospy.delete_param('/robot_pose_ekf')
    else:
        process = row.start('rosrun', 'rbx1_nav', 'timed_out_and_back.py', f"_{text.replace(': ', ':=')}")
        assert process.wait() in (1, 2), process.output
    assert 'Traceback' not in process.output, process.output[-1500:]
    # roslaunch lists all parameters before it starts a process, each as it is
    first = next((number for number, line in enumerate(process.lines) if 'process[' in line), 0)
    assert not any(line.startswith('lines') for line in process.lines[first:]), process.output[-1500:]
    errors = [line for line in process.lines if re.search(r'\[(ERROR|FATAL)\]|^simulate.py: |: error: ', line)]
    assert len(errors) == 1 and 'expected' in errors[0], process.output[-1500:]


def run(row):
    """See FAULT."""
    row.roscore()
    for kind, text in row.random.sample(REAL, min(row.times, len(REAL))):
        with row.fault(f'{kind}, {text[:100]}'):
            check(row, kind, text)
