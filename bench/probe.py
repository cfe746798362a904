"""The probe: a process that records the messages of one run, so that every run has a new ROS node.

It stores each message as bytes, with its arrival time on the monotonic clock, which all processes of a machine share.
It decodes the messages after the run, because a callback that does very little does not delay the next message.
"""
import gc
import multiprocessing
import os
import random
import signal
import sys
import time

import figures

SPEED = 0.1  # m/s, of the commands whose latency is measured


class Probe:
    """Parent side: starts the process, and sends requests to it."""

    def __init__(self, environment, cmd_vel, odom, publish=False):
        self.pipe, theirs = multiprocessing.Pipe()
        fork = multiprocessing.get_context('fork')
        self.process = fork.Process(target=run_probe, args=(self.pipe, theirs, environment, cmd_vel, odom, publish))
        self.process.start()
        theirs.close()

    def ask(self, *request):
        """Send a request (name, arguments...) and return the response. Raises the exception that it caused."""
        self.pipe.send(request)
        answer = self.pipe.recv()
        if isinstance(answer, Exception):
            raise answer
        return answer


def run_probe(ours, pipe, environment, cmd_vel, odom, publish):
    """The process: subscribes to odometry, subscribes to or publishes commands, and responds to requests."""
    ours.close()
    # Ctrl-C in the terminal reaches this process too, but the parent decides when to stop it.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    os.environ.update(environment)
    import rospy
    from geometry_msgs.msg import Twist
    # No ROS time: the base would have to serve an additional subscriber of /clock.
    rospy.init_node('bench_probe', anonymous=True, disable_rostime=True, disable_rosout=True, disable_signals=True)
    gc.disable()
    sys.setswitchinterval(1e-4)

    commands, odometry = [], []
    rospy.Subscriber(odom, rospy.AnyMsg, lambda m: odometry.append((time.monotonic(), m)), tcp_nodelay=True)
    if publish:
        publisher = rospy.Publisher(cmd_vel, Twist, queue_size=1, tcp_nodelay=True)
    else:
        rospy.Subscriber(cmd_vel, rospy.AnyMsg, lambda m: commands.append((time.monotonic(), m)), tcp_nodelay=True)

    def arrived():
        return bool(odometry and (not publish or publisher.get_num_connections()))

    def latency(count):
        return measure_latency(publisher, Twist, odometry, count)

    def record():
        return decode_commands(commands), decode_odometry(odometry)

    answers = {'arrived': arrived, 'latency': latency, 'record': record}
    while True:
        try:
            what, *arguments = pipe.recv()
            pipe.send(answers[what](*arguments))
        except EOFError:
            os._exit(0)  # rospy's shutdown would call a master that is shutting down
        except Exception as error:
            pipe.send(RuntimeError(f'{what}: {error}'))


def measure_latency(publisher, twist, odometry, count):
    """Alternately publish SPEED and 0, at random phases; returns the delays (s) until odometry shows each."""
    published = []
    for index in range(count):
        # Longer than odometry ever takes to show a command, and shorter than the command timeout of a base.
        time.sleep(random.uniform(0.3, 0.6))
        message = twist()
        message.linear.x = 0.0 if index % 2 else SPEED
        published.append((time.monotonic(), message.linear.x))
        publisher.publish(message)
    time.sleep(0.6)
    publisher.publish(twist())
    time.sleep(0.2)
    return figures.shown_after(published, decode_odometry(odometry))


def decode(received, kind):
    """The message in the received bytes. Raises TypeError if the type of the topic is not `kind`."""
    name = received._connection_header['type']
    if name != kind._type:
        raise TypeError(f'{name}: expected a topic of type {kind._type}')
    return kind().deserialize(received._buff)


def decode_commands(received):
    """(received, v, w) of each Twist."""
    from geometry_msgs.msg import Twist
    twists = [(arrival, decode(message, Twist)) for arrival, message in received]
    return [(arrival, twist.linear.x, twist.angular.z) for arrival, twist in twists]


def decode_odometry(received):
    """(received, stamp, x, y, heading, v, w) of each Odometry, or of each Drive Direct command on a serial line."""
    from nav_msgs.msg import Odometry
    from std_msgs.msg import String
    if received and received[0][1]._connection_header['type'] == String._type:
        # /line has the time at which its last byte was received, in ROS time, which equals the wall clock
        return figures.line_speeds([decode(message, String).data for _, message in received],
                                   time.monotonic() - time.time())
    records = []
    for arrival, message in received:
        odom = decode(message, Odometry)
        p, q, twist = odom.pose.pose.position, odom.pose.pose.orientation, odom.twist.twist
        records.append((arrival, odom.header.stamp.to_sec(), p.x, p.y, figures.yaw(q.x, q.y, q.z, q.w),
                        twist.linear.x, twist.angular.z))
    return records
