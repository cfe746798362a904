"""A stationary robot, for tests that need no base."""
import threading

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu


def make_odom():
    """Return the odometry of a stationary robot, with the current time."""
    message = Odometry()
    message.header.stamp = rospy.Time.now()
    message.header.frame_id, message.child_frame_id = '/odom', '/base_footprint'    # slashes as from old senders
    message.pose.pose.position.x = 0.5
    message.pose.pose.orientation.w = 1.0
    message.pose.covariance[::7] = message.twist.covariance[::7] = [1e-6] * 6
    return message


def make_imu():
    """Return the gyro reading of a stationary robot, with the current time."""
    message = Imu()
    message.header.stamp = rospy.Time.now()
    message.angular_velocity_covariance[8] = 1e-6
    return message


class Sender(threading.Thread):
    """Sends the valid messages of a sensor at about 50 Hz, and others on request."""

    def __init__(self, topic, make):
        """make(): returns the next valid message."""
        super().__init__(daemon=True)
        self.publisher = rospy.Publisher(topic, type(make()), queue_size=100)
        self.make = make
        self.lock = threading.Lock()
        self.active = True
        self.done = threading.Event()
        self.start()

    def run(self):
        while not self.done.wait(0.02):
            with self.lock:
                if self.active:
                    self.publisher.publish(self.make())

    def send(self, change):
        """Send one more message, after change(message)."""
        with self.lock:
            message = self.make()
            change(message)
            self.publisher.publish(message)

    def end(self):
        """Unregister the publisher."""
        self.done.set()
        self.join()
        self.publisher.unregister()
