#!/usr/bin/python3
"""The base publishes its wheel joints under the names in another robot's URDF file, so the wheels have frames."""
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

import support


class TestWheelJoints(support.Case):
    def test_own_names(self):
        odom = support.OdomWatch()
        joints = support.Watch('/joint_states', JointState)
        transforms = support.Watch('/tf', TFMessage)
        support.Commander().send(0.0, 1.0)
        odom.wait_for_twist(0.0, 1.0, since=0)
        support.wait_for(lambda: joints.next().position[-1] > 0, 'the wheels to turn')
        self.assertEqual(list(joints.last.name), ['pan', 'wheel_left_joint', 'wheel_right_joint'])
        # a turn to the left
        left, right = joints.last.position[1:]
        self.assertEqual(left, -right)
        support.wait_for(lambda: {'wheel_left_link', 'wheel_right_link'} <= {
            each.child_frame_id for message in list(transforms.messages) for each in message.transforms},
                         'the frames of the wheels')


if __name__ == '__main__':
    support.main(TestWheelJoints)
