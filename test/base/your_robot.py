#!/usr/bin/python3
"""A base names what does not belong to the model of its robot, and drives; what belongs together is not named."""
import os

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import rospkg
import rospy
import tf2_ros

import support

URDF = '''<robot name="two_wheels">
  <link name="base_link"/>
  <link name="left"/><joint name="left_joint" type="continuous"><parent link="base_link"/><child link="left"/></joint>
  <link name="right"/><joint name="right_joint" type="continuous"><parent link="base_link"/><child link="right"/>
  </joint>
  <link name="caster"/><joint name="caster_joint" type="continuous"><parent link="base_link"/><child link="caster"/>
  </joint>
</robot>'''
CONFIG = '''controllers:
  base_controller: {type: diff_controller, base_frame_id: %s, base_width: 0.3 %s}
  arm_controller: {type: follow_controller, joints: [arm]}'''
NAMES = ', left_wheel: left_joint, right_wheel: right_joint'
GROUP = '''<launch>
  <group ns="r1">
    <param name="tf_prefix" value="r1"/>
    <include file="$(find rbx1_bringup)/launch/fake_turtlebot.launch"/>
  </group>
</launch>'''
BESIDE = '''<launch>
  <include file="$(find rbx1_bringup)/launch/fake_turtlebot.launch">
    <arg name="config" value="{}"/>
    <arg name="model" value="{}"/>
  </include>
  <node name="joint_state_publisher" pkg="joint_state_publisher" type="joint_state_publisher"/>
</launch>'''
YOUR_ROBOT = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'examples', 'your_robot', 'your_robot.launch')
HAS_PUBLISHER = 'joint_state_publisher' in rospkg.RosPack().list()


class TestYourRobot(support.Case):
    def setUp(self):
        for name in 'robot_description', 'r1':
            if rospy.has_param(name):
                rospy.delete_param(name)
        self.model = self.file(URDF, '.urdf')

    def fake_turtlebot(self, frame='base_link', keys=NAMES):
        return self.start('roslaunch', 'rbx1_bringup', 'fake_turtlebot.launch', f'model:={self.model}',
                          f"config:={self.file(CONFIG % (frame, keys), '.yaml')}")

    def assert_named_once(self, launch, *patterns):
        """Check that each line appears, and stays the only one."""
        for pattern in patterns:
            launch.wait_for_line(pattern)
        # all lines are logged at the same time
        support.wait_for(lambda: self.model_status()[0] == DiagnosticStatus.WARN, 'the status')
        rospy.sleep(1)
        lines = [line for line in launch.output.splitlines() if '[WARN]' in line and 'Ignoring' not in line]
        self.assertEqual(len(lines), len(patterns), lines)

    def model_status(self):
        """The level and the text of the model in /diagnostics."""
        while True:
            for status in rospy.wait_for_message('/diagnostics', DiagnosticArray).status:
                if status.name.endswith('Robot model'):
                    return status.level if isinstance(status.level, int) else ord(status.level), status.message

    def test_names_of_wheels(self):
        launch = self.fake_turtlebot(keys='')
        self.assert_named_once(launch, 'nobody publishes left_joint, right_joint, caster_joint.*expected the wheels as '
                               'left_wheel and right_wheel of /arbotix/controllers/base_controller')
        self.assertIn('controllers/arm_controller (follow_controller)', launch.output)
        odom, commander = support.OdomWatch(), support.Commander()
        commander.send(0.1)
        odom.wait_for_twist(0.1)

    def test_base_frame(self):
        self.assert_named_once(
            self.fake_turtlebot('base_footprint'),
            '/arbotix/controllers/base_controller/base_frame_id: base_footprint: not a link.*root, base_link',
            'nobody publishes caster_joint')

    def test_a_create_has_the_same_check(self):
        launch = self.start('roslaunch', 'rbx1_bringup', 'fake_turtlebot_create.launch', f'model:={self.model}')
        self.assert_named_once(launch, '/turtlebot_node/base_frame: base_footprint: not a link',
                               'the wheels as left_wheel and right_wheel of /turtlebot_node')

    def test_a_prefix_of_a_group(self):
        launch = self.start('roslaunch', self.file(GROUP, '.launch'))
        launch.wait_for_line('tf_prefix: r1: .*expected robot:=r1')
        self.assertNotIn('Ready', launch.output.partition('tf_prefix: r1:')[0])

    def test_a_xacro_file_is_not_shown(self):
        self.model = self.file(URDF.replace('<robot ', '<robot xmlns:xacro="a" ').replace(
            '<link name="base_link"/>', '<xacro:include filename="links.xacro"/>'), '.xacro')
        launch = self.fake_turtlebot()
        launch.wait()
        self.assertRegex(launch.output, 'model: .*xacro')
        self.assertNotIn('Ready', launch.output)

    def test_robots_of_this_package(self):
        for name in 'fake_turtlebot', 'fake_pi_robot':
            launch = self.start('roslaunch', 'rbx1_bringup', f'{name}.launch')
            launch.wait_for_line('Ready')
            support.wait_for(lambda: self.model_status() == (DiagnosticStatus.OK, 'Consistent'), 'a check')
            self.assertNotIn('WARN', launch.output)
            launch.signal(2)
            launch.wait()

    def test_joint_state_publisher(self):
        if not HAS_PUBLISHER:
            self.skipTest('joint_state_publisher is not installed')
        config = self.file(CONFIG % ('base_link', NAMES), '.yaml')
        launch = self.start('roslaunch', self.file(BESIDE.format(config, self.model), '.launch'))
        self.assert_named_once(launch, '/joint_state_publisher and the base publish left_joint, right_joint')
        launch.signal(2)
        launch.wait()
        launch = self.start('roslaunch', YOUR_ROBOT, f'config:={config}', f'model:={self.model}', 'rviz_config:=none')
        launch.wait_for_line('Ready')
        commander, odom = support.Commander(), support.OdomWatch()
        buffer = tf2_ros.Buffer(debug=False)
        listener = tf2_ros.TransformListener(buffer)
        for link in 'left', 'right', 'caster':
            support.wait_for(lambda: buffer.can_transform('odom', link, rospy.Time(0)), f'a transform to {link}')
        commander.send(0.1)
        odom.wait_for_twist(0.1)
        support.wait_for(lambda: abs(buffer.lookup_transform('base_link', 'left', rospy.Time(0)).transform.rotation.y
                                     + buffer.lookup_transform('base_link', 'left', rospy.Time(0)).transform.rotation.x
                                     ) > 0.1, 'a wheel that turns')
        listener.unregister()
        support.wait_for(lambda: self.model_status() == (DiagnosticStatus.OK, 'Consistent'), 'a check')


if __name__ == '__main__':
    support.main(TestYourRobot)
