"""An emulated robot as a separate process, for the tests in this folder."""
import os
import signal
import tempfile

import rospy
import serial
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64, String
from std_srvs.srv import SetBool, Trigger

from rbx1_nav.extras.create.protocol import MODELS, command, packets_format, single_packets
import support


class EmulatedRobot:
    """fake_create.py, and a client on its serial port."""

    def __init__(self, case, robot_type, **params):
        """case: the TestCase, whose cleanup stops the process; params: parameters of the node."""
        self.model = MODELS[robot_type]
        folder = tempfile.TemporaryDirectory()
        case.addCleanup(folder.cleanup)
        self.link = os.path.join(folder.name, 'port')
        if rospy.has_param('/fake_create'):
            rospy.delete_param('/fake_create')
        self.process = support.Process('rosrun', 'rbx1_nav', 'fake_create.py', f'_link:={self.link}',
                                       f'_robot_type:={robot_type}', '_seed:=1',
                                       *('_%s:=%s' % item for item in params.items()))
        case.addCleanup(self.process.kill)
        self.ended = False
        self.process.wait_for_line('serial port')
        case.addCleanup(self.end)
        self.truth = support.Watch('/ground_truth', Odometry)
        self.line = support.Watch('/line', String)
        for watch in self.truth, self.line:
            support.wait_for(watch.subscriber.get_num_connections, watch.subscriber.name)
        self.truth.next()
        self.port = None
        self.publishers = []

    def end(self):
        """Stop the process, so that another one can use its name."""
        if self.ended:
            return
        self.ended = True
        self.process.signal(signal.SIGINT)
        assert self.process.wait() == 0, self.process.output
        assert 'Traceback' not in self.process.output, self.process.output
        for watch in self.truth, self.line:
            watch.subscriber.unregister()
        for publisher in self.publishers:       # otherwise the next robot receives what they have latched
            publisher.unregister()

    def open(self, baud=None):
        """Open the serial port."""
        self.port = serial.Serial(self.link, baud or self.model.baud, timeout=support.LIMIT)

    def send(self, *commands):
        """Send commands, and wait until they arrive. Returns the arrival time of the last one, in s of ROS time."""
        count = len(self.line.messages)

        def arrived():
            received = self.received()[count:]
            return [data for _, data in received[-len(commands):]] == list(commands) and received[-1][0]
        self.port.write(b''.join(commands))
        return support.wait_for(arrived, f'{commands} on /line')

    def wait_until_read(self):
        """Wait until the robot has read everything that was sent so far."""
        for _ in range(3):      # one message may be in transit, and one may be published while the robot reads
            self.truth.next()

    def received(self):
        """Return (s of ROS time, bytes) of each command that the robot has received."""
        return [(float(stamp), bytes.fromhex(data)) for stamp, data in (m.data.split() for m in self.line.messages)]

    def read(self, number):
        """Return the values of a packet or group, by packet name."""
        packets = single_packets(self.model, [number])
        form = packets_format(packets)
        self.port.reset_input_buffer()
        self.port.write(command('sensors', number))
        data = self.port.read(form.size)
        assert len(data) == form.size, data
        return dict(zip((packet.name for packet in packets), form.unpack(data)))

    def wait_for(self, number, value):
        """Wait until a packet has a value."""
        packet = self.model.packets[number]
        support.wait_for(lambda: self.read(number)[packet.name] == value, f'{packet.name} = {value!r}')

    def switch(self, service, on):
        """Call one of the SetBool services."""
        name = f'/fake_create/{service}'
        rospy.wait_for_service(name, support.LIMIT)
        assert rospy.ServiceProxy(name, SetBool)(on).success

    def power_cycle(self):
        """Remove the battery and insert it again."""
        assert rospy.ServiceProxy('/fake_create/power_cycle', Trigger)().success

    def publish(self, topic, value):
        """Publish a number to one of its topics."""
        publisher = rospy.Publisher(f'/fake_create/{topic}', Float64, queue_size=1, latch=True)
        self.publishers.append(publisher)
        support.wait_for(publisher.get_num_connections, f'the robot to subscribe to {topic}')
        publisher.publish(value)
        self.process.wait_for_line(f'{topic}: ')

    @property
    def position(self):
        """The true x, m."""
        return self.truth.next().pose.pose.position.x

    @property
    def moving(self):
        """Whether the robot moves according to the ground truth, after everything that it has received."""
        now = rospy.Time.now()
        truth = support.wait_for(lambda: self.truth.last.header.stamp > now and self.truth.last, 'the ground truth')
        twist = truth.twist.twist
        return bool(twist.linear.x or twist.angular.z)
