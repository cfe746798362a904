#!/usr/bin/env python3
"""A simulated differential-drive base that ArbotiX users can put in the place of theirs.

Commands in on cmd_vel, odometry out on odom: config/ says which robot it is, the README lists topics and parameters.
"""
import random
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import Updater
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import Empty, Float64
from std_srvs.srv import Empty as EmptyService, EmptyResponse
from tf2_msgs.msg import TFMessage

from rbx1_nav import messages, node, resources
from rbx1_nav.base import SECOND, RefusedCommand
from rbx1_nav.config import WHEELS, ConfigError, positive, read_config
from rbx1_nav.lockstep import Lockstep
from rbx1_nav.schedule import Schedule
from rbx1_nav.simulation import make_robot
from rbx1_nav.surface import load_surface, read_seed
from rbx1_nav.wheels import IdealWheels

TICK = SECOND // 50     # ns, the step of the simulated clock


class FakeBase:
    """The core's Base, with ROS around it."""

    def __init__(self, config, base, gyro, factor):
        """factor: how much faster than real time, where the clock is this node's to advance; else None."""
        self.config = config
        self.base = base
        self.gyro = gyro
        self.factor = factor
        self.lock = threading.Lock()
        self.sim_time = 0       # ns, the latest /clock
        self.last_stamp = None
        self.last_reading = None    # ns, of the gyro
        self.last_joints = None
        self.odom_schedule = Schedule(config.rate)
        self.joint_schedule = Schedule(10)
        self.diagnostics_schedule = Schedule(1)
        self.lockstep = Lockstep(self.drive, rospy.logwarn)

        self.odom_pub = rospy.Publisher('odom', Odometry, queue_size=10, tcp_nodelay=True)
        self.imu_pub = rospy.Publisher('imu/data', Imu, queue_size=10, tcp_nodelay=True)
        self.truth_pub = rospy.Publisher('ground_truth', Odometry, queue_size=10)
        # tf2_ros' broadcaster does just this, and costs 5 MB more for all that comes with it
        self.tf_pub = rospy.Publisher('/tf', TFMessage, queue_size=100, tcp_nodelay=True)
        self.joint_pub = rospy.Publisher('joint_states', JointState, queue_size=10)
        self.diagnostics = Updater()
        self.diagnostics.setHardwareID('none')
        self.diagnostics.add(config.name, self.diagnose)

        if factor:
            self.clock_pub = rospy.Publisher('/clock', Clock, queue_size=10, tcp_nodelay=True)
        self.reset_pub = rospy.Publisher('reset_odometry', Empty, queue_size=1)
        rospy.Service('~reset', EmptyService, self.on_reset)
        for joint in config.joints:
            rospy.Subscriber(joint.name + '/command', Float64, self.on_joint, joint, queue_size=10)
        self.cmd_vel = None     # there may be a command before the next line is done
        self.cmd_vel = rospy.Subscriber('cmd_vel', Twist, self.on_twist, queue_size=None, tcp_nodelay=True)

    @staticmethod
    def simulated():
        """Whether ROS time is simulated."""
        return not rospy.rostime.is_wallclock()

    def now(self):
        """ns on the clock that motion is measured by: simulated time, or one that nobody can set."""
        return self.sim_time if self.simulated() else time.monotonic_ns()

    # what comes in

    def on_twist(self, twist):
        """A command arrives: in force from now on, or with the tick that it answers."""
        command = messages.from_twist(twist)
        if any(command[2]):
            rospy.logwarn_throttle(5, '%s: linear.y, linear.z, angular.x, angular.y = %s: a differential drive cannot '
                                      'follow these, expected 0; ignored' % (rospy.resolve_name('cmd_vel'), command[2]))
        if self.factor:
            header = twist._connection_header       # one object for each connection
            if not self.lockstep.knows(header) and self.cmd_vel:
                self.lockstep.keep([connection.header for connection in self.cmd_vel.impl.connections])
            self.lockstep.receive(header, header['callerid'], command)
        else:
            self.drive(command)

    def drive(self, command):
        """Pass a command through the gate."""
        topic = rospy.resolve_name('cmd_vel')
        try:
            with self.lock:
                cut = self.base.command(self.now(), *command)
        except RefusedCommand as error:
            rospy.logerr_throttle(1, '%s: %s; refused, and the base stopped' % (topic, error))
            return
        if cut:
            rospy.logwarn_throttle(5, '%s: %g m/s, %g rad/s: expected at most %g and %g; clamped'
                                   % ((topic,) + command[:2] + self.config.limits))

    def on_joint(self, message, joint):
        """A joint gets its goal."""
        try:
            with self.lock:
                joint.command(message.data)
        except RefusedCommand as error:
            rospy.logerr_throttle(1, '%s: %s; refused' % (rospy.resolve_name(joint.name + '/command'), error))

    def on_reset(self, _):
        """Back to the origin, at rest."""
        with self.lock:
            self.base.advance(self.now())
            self.base.reset()
            self.gyro.reset()
        self.reset_pub.publish()
        rospy.loginfo('Back at the origin.')
        return EmptyResponse()

    # what goes out

    def publish(self):
        """Say where the base is now, and all else that is due."""
        with self.lock:
            now = self.now()
            stamp = rospy.Time(0, now) if self.simulated() else rospy.Time.now()
            if stamp == self.last_stamp:
                return
            self.last_stamp = stamp
            timed_out = self.base.advance(now)
            base = self.base
            pose = base.odometry.pose
            odom = messages.odometry(stamp, self.config, pose, base.velocity, base.wheels.uncertainty)
            imu = self.read_gyro(now, stamp)
            truth = None
            if self.truth_pub.get_num_connections():
                truth = messages.odometry(stamp, self.config, base.wheels.truth.pose, base.true_velocity,
                                          IdealWheels.uncertainty)
            joints = self.joint_states(now, stamp) if self.joint_schedule.due(now) else None
        self.odom_pub.publish(odom)
        if self.config.publish_tf:
            self.tf_pub.publish([messages.transform(stamp, odom.header.frame_id, odom.child_frame_id, pose)])
        if imu:
            self.imu_pub.publish(imu)
        if truth:
            self.truth_pub.publish(truth)
        if joints:
            self.joint_pub.publish(joints)
        if timed_out:
            rospy.logwarn_throttle(10, '%s: no command for %g s: stopped'
                                   % (rospy.resolve_name('cmd_vel'), self.config.timeout / SECOND))
        if self.diagnostics_schedule.due(now):
            self.diagnostics.force_update()

    def read_gyro(self, now, stamp):
        """An Imu message; None where no time has passed to tell of."""
        last, self.last_reading = self.last_reading, now
        if last is None or now <= last:
            return None
        base = self.base
        reading = self.gyro.read(base.wheels.truth.pose.yaw, (now - last) / SECOND, base.standing)
        return messages.imu(stamp, self.config.base_frame_id, reading)

    def joint_states(self, now, stamp):
        """Move the joints, and say where they and the wheels are."""
        elapsed = max(0, now - self.last_joints) if self.last_joints is not None else 0
        self.last_joints = now
        for joint in self.config.joints:
            joint.advance(elapsed / SECOND)
        linear, angular = self.base.velocity
        difference = angular * self.config.base_width / 2
        radius = self.config.wheel_radius
        wheels = [(WHEELS[0], self.base.left / radius, (linear - difference) / radius),
                  (WHEELS[1], self.base.right / radius, (linear + difference) / radius)]
        return messages.joint_states(stamp, self.config.joints, wheels)

    def diagnose(self, status):
        """Fill in the DiagnosticStatus of the controller."""
        base = self.base
        age = 'never' if base.command_time is None else '%.3f' % ((base.now - base.command_time) / SECOND)
        status.summary(DiagnosticStatus.OK, 'Standing' if base.standing else 'Moving')
        status.add('dX', base.linear)
        status.add('dR', base.angular)
        status.add('Age of the last command (s)', age)
        status.add('Refused commands', base.refused)
        status.add('Clamped commands', base.clamped)
        return status

    # the three clocks

    def run(self):
        """Until the node is told to end."""
        if self.factor:
            self.run_own_clock()
        elif self.simulated():
            rospy.Subscriber('/clock', Clock, self.on_clock, queue_size=None, tcp_nodelay=True)
            node.end_requested.wait()
        else:
            self.run_real_time()

    def run_real_time(self):
        """An even beat on the monotonic clock, stamped with ROS time."""
        beat = time.monotonic()
        while not node.end_requested.is_set():
            self.publish()
            beat = self.wait_for_beat(beat, 1 / self.config.rate)

    @staticmethod
    def wait_for_beat(beat, period):
        """Wait for the beat that follows `beat` after `period` (s of the monotonic clock); returns it."""
        beat = max(beat + period, time.monotonic())
        while time.monotonic() < beat and not node.end_requested.is_set():
            node.sleep(beat - time.monotonic())
        return beat

    def on_clock(self, message):
        """Somebody else's simulated time."""
        self.sim_time = message.clock.to_nsec()
        if self.odom_schedule.due(self.sim_time):
            self.publish()

    def run_own_clock(self):
        """Advance simulated time tick by tick: never faster than asked, never past a command that is on its way."""
        beat = time.monotonic()
        while not node.end_requested.is_set():
            self.sim_time += TICK
            self.clock_pub.publish(rospy.Time(0, self.sim_time))
            if self.odom_schedule.due(self.sim_time):
                self.publish()
            beat = self.wait_for_beat(beat, TICK / SECOND / self.factor)
            self.lockstep.collect()


def read_factor():
    """The private parameter real_time_factor, or None where it is not set. Raises ConfigError."""
    factor = rospy.get_param('~real_time_factor', None)
    if factor is None:
        return None
    positive('real_time_factor', factor)
    if rospy.rostime.is_wallclock():
        raise ConfigError('real_time_factor: %r: expected /use_sim_time to be true' % factor)
    return factor


def read_robot(config):
    """(Base, gyro) on the surface, and from the seed, that the private parameters name. Raises ConfigError."""
    surface = load_surface(rospy.get_param('~surface', 'ideal'), resources.surfaces())
    seed = read_seed(rospy.get_param('~seed', random.randrange(10 ** 6)))
    if surface:
        rospy.loginfo('On %s; seed:=%d makes this run again', surface.name, seed)
    return make_robot(config, surface, seed)


def main():
    """Read the configuration, and run. Returns the exit status."""
    node.init_node('arbotix')
    try:
        config = read_config(rospy.get_param(rospy.get_name(), {}))
        robot = read_robot(config)
        factor = read_factor()
    except ConfigError as error:
        rospy.logfatal('%s/%s', rospy.get_name(), error)
        return 1
    if config.ignored:
        rospy.loginfo('Only hardware needs these, ignored: %s', ', '.join(config.ignored))
    if config.unknown:
        rospy.logwarn('Unknown, without effect: %s', ', '.join(config.unknown))
    base = FakeBase(config, *robot, factor)
    rospy.loginfo('%s at the origin of %s', config.base_frame_id, config.odom_frame_id)
    base.run()
    return 0


if __name__ == '__main__':
    node.run(main)
