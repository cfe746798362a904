"""Invalid sensor messages, sent to the filter."""
import math
import time

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from std_msgs.msg import Empty
from tf2_msgs.msg import TFMessage

import support
from sensors import Sensors, turn

FAULT = ('the filter receives NaN, invalid covariances and stamps, gaps, jumps, resets, messages from two senders, '
         'and wheel motion while the robot is held')
PROMISE = ('all published values are finite; at most 10 log lines per second; poses are published again afterwards')
FULL, SHORT = 130, 7
ROOT = ALONE = False

DURATION = 2.0      # s of a fault
LINES = 10          # per second
BAD = [math.nan, math.inf, -math.inf, 1e308, -1e7]


def faults(row):
    """All kinds of faults: (name, spoil(odom, imu), which returns what is sent of them)."""
    value, uniform = row.random.choice(BAD), row.random.uniform
    kinds = []

    def kind(name, *actions):
        def spoil(odom, imu):
            for action in actions:
                action(odom, imu)
            return odom, imu
        kinds.append((name, spoil))

    def shift(message, seconds):
        message.header.stamp = rospy.Time.from_sec(message.header.stamp.to_sec() + seconds)
    for field in 'x', 'y':
        kind(f'position.{field} = {value:g}', lambda o, i, f=field: setattr(o.pose.pose.position, f, value))
    for field in 'xyzw':
        kind(f'orientation.{field} = {value:g}', lambda o, i, f=field: setattr(o.pose.pose.orientation, f, value))
    kind(f'rate = {value:g}', lambda o, i: setattr(i.angular_velocity, 'z', value))
    kind('no orientation', lambda o, i: setattr(o.pose.pose.orientation, 'w', 0.0),
         lambda o, i: setattr(o.pose.pose.orientation, 'z', 0.0))
    for bad in 0.0, -1e-6, 5e-324, 1e308, math.nan, math.inf:
        kind(f'variances {bad:g} of pose and speed', lambda o, i, b=bad: setattr(o.pose, 'covariance', [b] * 36),
             lambda o, i, b=bad: setattr(o.twist, 'covariance', [b] * 36))
        kind(f'variance {bad:g} of speed', lambda o, i, b=bad: setattr(o.twist, 'covariance', [b] * 36))
        kind(f'variance {bad:g} of gyro', lambda o, i, b=bad: setattr(i, 'angular_velocity_covariance', [b] * 9))
    for seconds in -3600.0, -5.0, -0.1, 0.4, 3600.0, uniform(-20, 20):
        kind(f'odometry {seconds:+.3f} s', lambda o, i, s=seconds: shift(o, s))
        kind(f'gyro {seconds:+.3f} s', lambda o, i, s=seconds: shift(i, s))
    kind('random stamps', lambda o, i: shift(o, uniform(-2, 2)), lambda o, i: shift(i, uniform(-2, 2)))
    kind('stamps of 0', lambda o, i: [setattr(m.header, 'stamp', rospy.Time()) for m in (o, i)])
    start = rospy.Time.now()
    kind('the same stamp on all messages', lambda o, i: [setattr(m.header, 'stamp', start) for m in (o, i)])
    kind('jumps', lambda o, i: setattr(o.pose.pose.position, 'x', uniform(-100, 100)))
    kind('wheels that turn while the robot is held', lambda o, i: setattr(i.angular_velocity, 'z', 0.0))
    kind('a robot that is turned while its wheels are stationary', lambda o, i: setattr(o, 'pose', Odometry().pose),
         lambda o, i: turn(o, 0.0), lambda o, i: setattr(o.pose, 'covariance', [1e-6] * 36))
    kind('no frames', lambda o, i: setattr(o.header, 'frame_id', ''))
    kinds += [('no odometry', lambda o, i: (None, i)), ('no gyro', lambda o, i: (o, None)),
              ('no message', lambda o, i: (None, None)),
              ('occasional odometry', lambda o, i: (o if uniform(0, 1) < 0.02 else None, i))]
    return kinds


def numbers(message):
    """All floating-point numbers of a pose or of transforms."""
    poses = ([(t.transform.translation, t.transform.rotation) for t in message.transforms]
             if isinstance(message, TFMessage) else [(message.pose.pose.position, message.pose.pose.orientation)])
    return [getattr(part, name) for pose in poses for part in pose for name in part.__slots__] + (
        [] if isinstance(message, TFMessage) else list(message.pose.covariance))


def run(row):
    """See FAULT."""
    row.roscore()
    rospy.set_param('/robot_pose_ekf', dict(output_frame='odom_combined', surface='low_ply_carpet'))
    ekf = row.start('rosrun', 'rbx1_nav', 'ekf.py')
    support.init_node('faults')
    log, transforms = support.Watch('/rosout', Log), support.Watch('/tf', TFMessage)
    poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
    reset = rospy.Publisher('/reset_odometry', Empty, queue_size=10)
    sensors = Sensors()
    good = sensors.spoil
    sensors.start()
    poses.next()
    for number in range(row.times):
        kinds = faults(row) + [('resets', good), ('a second sender', good)]
        name, spoil = kinds[(number + row.random.randrange(len(kinds))) % len(kinds)]
        with row.fault(name):
            del poses.messages[:], transforms.messages[:], log.messages[:]
            second = row.start('rostopic', 'pub', '-r', '50', '-s', '/odom', 'nav_msgs/Odometry',
                               '{header: auto, child_frame_id: base_footprint, pose: {pose: {position: {x: 5}, '
                               'orientation: {w: 1}}}}') if name == 'a second sender' else None
            sensors.spoil, end = spoil, time.monotonic() + DURATION * (1 + bool(second))
            start = time.monotonic()
            while time.monotonic() < end:
                if name == 'resets':
                    reset.publish()
                time.sleep(0.05)
            sensors.spoil = good
            if second:
                second.kill()
            count = len(poses.messages)
            support.wait_for(lambda: len(poses.messages) > count + 3, 'a pose after the fault')
            lines = [m.msg for m in log.messages if m.name == '/robot_pose_ekf']
            row.figure('log lines per second', len(lines) / (time.monotonic() - start))
            most = LINES * (time.monotonic() - start + 1)       # a second may have begun
            assert len(lines) <= most, '%d lines: %s' % (len(lines), '\n'.join(lines[:8]))
            messages = poses.messages + transforms.messages
            assert all(map(math.isfinite, (n for m in messages for n in numbers(m)))), 'a value that is not finite'
            assert ekf.process.poll() is None and 'Traceback' not in ekf.output, ekf.output[-1500:]
