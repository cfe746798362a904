#!/usr/bin/python3
"""A robot at 3 m/s is estimated along its whole path; with a lower ~max_speed, its odometry counts as jumped."""
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from rosgraph_msgs.msg import Log

from still_robot import Sender, make_imu, make_odom
import support

SPEED = 3.0     # m/s
IGNORED = 'Odometry ignored: faster than ~max_speed or ~max_turn_rate'


class TestSpeedLimit(support.Case):
    def test_a_fast_robot(self):
        log = support.Watch('/rosout', Log)
        poses = {node: support.Watch(f'/{node}/odom_combined', PoseWithCovarianceStamped)
                 for node in ('standard', 'slow')}
        diagnostics = support.Watch('/diagnostics', DiagnosticArray)
        start, driving = [], []

        def make():
            message = make_odom()
            message.header.stamp = rospy.Time.now()
            if driving:
                start.append(message.header.stamp)
                message.pose.pose.position.x = 0.5 + SPEED * (message.header.stamp - start[0]).to_sec()
            return message
        Sender('odom', make)
        Sender('imu_data', make_imu)
        support.wait_for(lambda: all(each.last for each in poses.values()), 'both filters')
        driving.append(True)
        support.wait_for(lambda: start and rospy.Time.now() - start[0] > rospy.Duration(3), '3 s at 3 m/s')

        def lines(node):
            return [m.msg for m in list(log.messages) if m.name == f'/{node}' and (
                'is too far from' in m.msg or 'jumped' in m.msg)]
        support.wait_for(lambda: lines('slow'), 'a line of the filter with the lower limit')
        support.wait_for(lambda: {('slow: odom', IGNORED), ('slow: filter', IGNORED)} <= {
            (each.name, each.message) for message in list(diagnostics.messages) for each in message.status}, IGNORED)
        self.assertEqual(lines('standard'), [])
        # two poses are never much farther apart than 0.1 m, the distance at 30 Hz, even on a busy machine
        positions = [m.pose.pose.position.x for m in list(poses['standard'].messages)]
        self.assertGreater(positions[-1], 8.0)
        self.assertLess(max(b - a for a, b in zip(positions, positions[1:])), 1.5)


if __name__ == '__main__':
    support.main(TestSpeedLimit)
