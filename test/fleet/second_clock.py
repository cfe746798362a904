#!/usr/bin/python3
"""A second robot joins in real time; a second clock, and a launch that would change the clock, are refused."""
import os
import signal

import rosgraph
import rospy
import tf2_ros

import support

SIMULATED = 'real_time_factor:=5'


class TestSecondClock(support.Case):
    def launch(self, robot, *arguments):
        """Start a robot."""
        return self.start('roslaunch', 'rbx1_nav', 'fake_turtlebot.launch', f'robot:={robot}', *arguments)

    def test_two_robots_in_real_time_are_apart(self):
        for robot in 'robot1', 'robot2':
            self.launch(robot).wait_for_line('Ready: ')
        odometry = {robot: support.Watch(f'/{robot}/odom', support.Odometry) for robot in ('robot1', 'robot2')}
        support.wait_for(lambda: odometry['robot2'].last, 'odometry')
        driver = support.Process('rosrun', 'rbx1_nav', 'odom_out_and_back.py', '_goal_distance:=0.1',
                                 '_goal_angle:=0.1', ROS_NAMESPACE='robot1')
        self.assertEqual(driver.wait(), 0, driver.output)
        self.assertGreater(max(message.pose.pose.position.x for message in odometry['robot1'].messages), 0.09)
        self.assertEqual(support.pose(odometry['robot2'].next()), (0, 0, 0))
        buffer = tf2_ros.Buffer(debug=False)
        self.listener = tf2_ros.TransformListener(buffer)
        for robot in odometry:
            support.wait_for(lambda: buffer.can_transform(f'{robot}/odom', f'{robot}/laptop_link', rospy.Time(0)),
                             f'the links of {robot}')
        self.assertFalse(buffer.can_transform('robot1/odom', 'robot2/odom', rospy.Time(0)))
        # robot0 runs on a host that has no address here
        with support.ServerProxy(rosgraph.get_master_uri()) as master:
            for register, *topic in (('registerPublisher', '/robot0/odom', 'nav_msgs/Odometry'),
                                     ('registerSubscriber', '/robot0/cmd_vel', 'geometry_msgs/Twist')):
                getattr(master, register)('/robot0/arbotix', *topic, 'http://robot0.invalid:1/')
        refused = self.launch('robot3', SIMULATED)
        self.assertEqual(refused.wait(), 1)
        self.assertIn('/use_sim_time: true: expected no robot in real time, but /robot0/arbotix, /robot1/arbotix, '
                      '/robot2/arbotix runs', refused.output)
        refused = support.Process('roslaunch', 'rbx1_nav', 'fleet.launch', 'n:=1', 'model:=none')
        refused.wait()
        self.assertIn('/robot1/arbotix: expected the name of a robot that is not simulated by another', refused.output)
        self.assertIs(rospy.get_param('/use_sim_time'), False)
        refused = self.launch('robot-3')
        self.assertEqual(refused.wait(), 1)
        self.assertIn("robot: 'robot-3': expected a name of letters", refused.output)

    def test_a_second_clock_is_refused(self):
        first, second = (self.launch(robot, 'model:=none', SIMULATED) for robot in ('robot1', 'robot2'))
        outputs = support.wait_for(lambda: [each for each in (first, second) if 'publishes /clock' in each.output],
                                   'a refusal')
        self.assertEqual(len(outputs), 1)
        loser, winner, name = (first, second, 'robot2') if outputs[0] is first else (second, first, 'robot1')
        loser.wait()
        self.assertIn(f'expected no other clock, but /{name}/arbotix publishes /clock', loser.output)
        self.assertNotIn('publishes /clock', winner.output)
        # as rosbag play --clock does
        other = self.start('rostopic', 'pub', '/clock', 'rosgraph_msgs/Clock', '{}')
        winner.wait_for_line('/rostopic_.* publishes /clock, too')
        other.signal(signal.SIGINT)
        other.wait()
        winner.wait_for_line('Ready: ')
        # the registration of a killed base refuses nobody
        self.assertEqual(support.wait_for(lambda: rospy.get_param('/use_sim_time'), 'simulated time'), True)
        third = self.launch('robot3', 'model:=none', SIMULATED)
        third.wait_for_line('publishes /clock')
        third.wait()
        os.kill(support.pid_of(f'/{name}/arbotix'), signal.SIGKILL)
        winner.wait()
        self.launch('robot3', 'model:=none', SIMULATED).wait_for_line('Ready: ')
        # a restart under the same name takes over
        self.launch('robot3', 'model:=none', SIMULATED).wait_for_line('Ready: ')


if __name__ == '__main__':
    support.main(TestSecondClock)
