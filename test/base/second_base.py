#!/usr/bin/python3
"""A base that is started while another one is running replaces it, and one complete robot remains."""
import rosnode
import rospy
import tf2_ros

import support

# like a user's own launch file, with the usual name for the node that publishes the links
OTHER_NAME = '''<launch>
  <rosparam command="load" file="$(find rbx1_nav)/config/turtlebot.yaml" ns="my_base"/>
  <param name="robot_description" textfile="$(find rbx1_nav)/urdf/turtlebot.urdf"/>
  <node name="my_base" pkg="rbx1_nav" type="fake_base.py"/>
  <node name="robot_state_publisher" pkg="robot_state_publisher" type="robot_state_publisher"/>
</launch>'''


class TestSecondBase(support.Case):
    def launch(self, *arguments):
        """Start a roslaunch and wait for its nodes."""
        process = self.start('roslaunch', *arguments)
        process.wait_for_line('at the origin of odom' if arguments[0] == 'rbx1_nav' else 'process\\[my_base-')
        return process

    def assert_whole(self, *links):
        """Check that a new subscriber, such as RViz, receives the transforms of all links."""
        buffer = tf2_ros.Buffer(debug=False)
        listener = tf2_ros.TransformListener(buffer)
        for link in links:
            support.wait_for(lambda: buffer.can_transform('odom', link, rospy.Time(0)), f'a transform to {link}')
        listener.unregister()

    def test_the_same_base_twice(self):
        first = self.launch('rbx1_nav', 'fake_turtlebot.launch')
        self.launch('rbx1_nav', 'fake_turtlebot.launch', 'surface:=low_ply_carpet')
        first.wait()
        self.assert_whole('base_l_wheel_link', 'laptop_link')
        publishers = [name for name in rosnode.get_node_names() if 'robot_state_publisher' in name]
        self.assertEqual(len(publishers), 1)

    def test_a_base_of_another_name(self):
        self.launch('rbx1_nav', 'fake_turtlebot.launch')
        self.launch(self.file(OTHER_NAME, '.launch'))
        support.wait_for(lambda: '/robot_state_publisher' in rosnode.get_node_names(), 'the second publisher')
        self.assert_whole('base_l_wheel_link', 'laptop_link')
        # the first publisher continues
        self.assertEqual(len([name for name in rosnode.get_node_names() if 'robot_state_publisher' in name]), 2)


if __name__ == '__main__':
    support.main(TestSecondBase)
