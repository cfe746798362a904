#!/usr/bin/python3
"""The launch file of a robot starts its base, its frames and its joints, in real time."""
import sys

import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage

import support

WHEELS = ['base_l_wheel_joint', 'base_r_wheel_joint']
SERVOS = {'turtlebot': [],
          'pi_robot': ['arm_shoulder_pan_joint', 'arm_shoulder_lift_joint', 'arm_elbow_flex_joint',
                       'arm_wrist_flex_joint', 'gripper_joint', 'head_pan_joint', 'head_tilt_joint']}
BASE_FRAME = {'turtlebot': 'base_footprint', 'pi_robot': 'base_link'}


class TestFakeRobot(support.Case):
    def test_base_frames_and_joints(self):
        robot = next(name for name in SERVOS if name in sys.argv)
        self.assertIs(rospy.get_param('/use_sim_time'), False)
        odom = support.OdomWatch()
        transforms = support.Watch('/tf', TFMessage)
        joints = support.Watch('/joint_states', JointState)
        self.assertEqual(odom.last.child_frame_id, BASE_FRAME[robot])
        self.assertEqual(odom.position(), (0.0, 0.0))

        # robot_state_publisher connects the frames of base and wheels
        frames = set()

        def has_wheels():
            frames.update(t.child_frame_id for m in list(transforms.messages) for t in m.transforms)
            return {'base_l_wheel_link', 'base_r_wheel_link', BASE_FRAME[robot]} <= frames
        support.wait_for(has_wheels, 'the frames of the wheels')
        self.assertFalse([frame for frame in frames if frame.startswith('/')])

        joints.next()
        self.assertEqual(list(joints.last.name), SERVOS[robot] + WHEELS)
        if SERVOS[robot]:
            self.check_servos(joints)

    def check_servos(self, joints):
        goals = {'head_pan_joint': (0.5, 0.5), 'head_tilt_joint': (9.0, 1.0471975511965976)}   # its limit is 60 degrees
        for name, (goal, _) in goals.items():
            command = rospy.Publisher(f'/{name}/command', Float64, queue_size=1, latch=True)
            command.publish(goal)
        for name, (_, end) in goals.items():
            index = joints.last.name.index(name)
            support.wait_for(lambda i=index, e=end: abs(joints.last.position[i] - e) < 1e-9, f'{name} at its goal')
            # 90 degrees per second, and rounding
            self.assertLessEqual(max(abs(m.velocity[index]) for m in joints.messages), 1.5708)


if __name__ == '__main__':
    support.main(TestFakeRobot)
