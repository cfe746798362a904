#!/usr/bin/python3
"""/diagnostics contains the current case of the filter, the errors that it has estimated, and counts; the readings of
an IMU that is mounted upside down are rotated."""
import math

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import TransformStamped
import rospy
from tf2_msgs.msg import TFMessage

from still_robot import Sender, make_imu, make_odom
import support

BIAS = 2.0      # degrees/s


class TestFilterDiagnostics(support.Case):
    def test_cases_bias_and_counts(self):
        diagnostics = support.Watch('/diagnostics', DiagnosticArray)

        def status():
            """Return (level, message, values) of the filter in the latest message that contains its status."""
            for message in reversed(list(diagnostics.messages)):
                for each in message.status:
                    if each.name.endswith(': filter'):
                        return each.level, each.message, {pair.key: pair.value for pair in each.values}
            return None, None, {}

        def wait_for_case(case, level, text):
            support.wait_for(lambda: status()[2].get('Case') == case, f'the case {case}')
            self.assertEqual(status()[:2], (level, text))
        wait_for_case('none', DiagnosticStatus.WARN, 'No estimate yet')
        self.assertEqual(status()[2]['Gyro bias (degrees/s)'], 'unknown')

        rate, heading = [math.radians(BIAS)], [0.0, 0.0]     # rad/s; rad, and rad per message

        def imu():
            message = make_imu()
            message.header.frame_id, message.angular_velocity.z = 'imu_link', -rate[0]      # it is upside down
            return message

        def odom():
            message = make_odom()
            heading[0] += heading[1]
            message.pose.pose.orientation.z = math.sin(heading[0] / 2)
            message.pose.pose.orientation.w = math.cos(heading[0] / 2)
            return message
        mounting = TransformStamped()
        mounting.header.frame_id, mounting.child_frame_id = 'base_footprint', 'imu_link'
        mounting.transform.rotation.x = 1.0
        transforms = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        transforms.publish([mounting])
        Sender('odom', odom)
        Sender('imu_data', imu)
        wait_for_case('standstill', DiagnosticStatus.OK, 'Standstill')
        support.wait_for(lambda: abs(float(status()[2]['Gyro bias (degrees/s)'].split(' +- ')[0]) - BIAS) < 0.05,
                         'the bias')
        self.assertEqual(status()[2]['Doubted'], 'nothing')

        rate[0] += 0.5
        heading[1] = 0.5 * 0.02     # only about as fast, because the rates of the senders are not exact
        wait_for_case('agreement', DiagnosticStatus.OK, 'Wheels and gyro agree')
        heading[1] = -0.5 * 0.02
        wait_for_case('contradiction', DiagnosticStatus.WARN, 'Wheels and gyro contradict each other')
        support.wait_for(lambda: status()[2]['Doubted'] == 'gyro', 'the doubt')
        heading[1] = 0.0
        wait_for_case('carried', DiagnosticStatus.WARN, 'Carried, or turned by hand')
        rate[0] -= 0.5
        wait_for_case('standstill', DiagnosticStatus.OK, 'Standstill')
        self.assertGreater(int(status()[2]['Poses published']), 30)


if __name__ == '__main__':
    support.main(TestFilterDiagnostics)
