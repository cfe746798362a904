#!/usr/bin/python3
"""Five robots on one simulated clock: each ends as one alone, while others are added, removed, or lose their driver."""
from diagnostic_msgs.srv import AddDiagnostics
import rospy

from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.many_runs.simulated_run import simulate
from rbx1_nav.node import resources
from rbx1_nav.node.config import load_yaml
import support

SURFACE = 'low_ply_carpet'


class TestFleet(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.truth = {f'robot{i}': support.Watch(f'/robot{i}/ground_truth', support.Odometry) for i in range(1, 7)}
        cls.robot = load_yaml(resources.path('config', 'turtlebot.yaml'))

    def request(self, service, name):
        """Call a service of the fleet; return (success, message)."""
        answer = rospy.ServiceProxy(f'/fleet/{service}', AddDiagnostics)(name)
        return answer.success, answer.message

    def drive(self, name, *arguments):
        """Start a script that drives a robot; return its Process."""
        return support.Process('rosrun', 'rbx1_nav', 'timed_out_and_back.py', *arguments, ROS_NAMESPACE=name)

    def assert_end(self, name, seed):
        """Check that a robot has the same end pose as one that is simulated alone, without ROS."""
        surface = load_surface(SURFACE, resources.surfaces())
        end = simulate('timed', read_robot(self.robot), surface, seed).end.truth
        x, y, yaw = support.pose(self.truth[name].next())
        for value, expected in zip((x, y, support.wrapped(yaw - end.yaw)), (end.x, end.y, 0)):
            self.assertAlmostEqual(value, expected, delta=1e-9)

    def test_each_ends_as_one_alone(self):
        drivers = {name: self.drive(name) for name in ('robot1', 'robot2', 'robot3')}
        removed, killed = self.drive('robot4'), self.drive('robot5')
        for name in 'robot4', 'robot5':
            truth = self.truth[name]
            support.wait_for(lambda: truth.last and truth.last.pose.pose.position.x > 0.3, f'{name} to drive')
        # in the middle of the runs: a robot is removed, another driver is killed, and a robot is added
        self.assertEqual(self.request('remove', 'robot4'), (True, 'robot4: removed'))
        killed.kill()
        rospy.set_param('/robot6/arbotix', dict(self.robot, surface=SURFACE, seed=12))
        self.assertEqual(self.request('add', 'robot6'), (True, 'robot6: added'))
        drivers['robot6'] = self.drive('robot6')
        for seed, (name, driver) in zip((7, 8, 9, 12), drivers.items()):
            self.assertEqual(driver.wait(), 0, driver.output)
            self.assertIn(f'run: ROS_NAMESPACE=/{name} rosrun rbx1_nav pose.py', driver.output)
            self.assert_end(name, seed)
        self.assertEqual(removed.wait(), 1, removed.output)
        self.assertIn('/robot4/cmd_vel', removed.output)

    def test_a_script_in_the_wrong_namespace_names_the_robots(self):
        driver = self.drive('', '_wait_timeout:=3')
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertIn('a base that subscribes to /cmd_vel. Bases exist in other namespaces: /robot1, ', driver.output)
        pose = support.Process('rosrun', 'rbx1_nav', 'pose.py')
        self.assertEqual(pose.wait(), 1, pose.output)
        self.assertIn('expected a running base. Bases exist in other namespaces: /robot1, ', pose.output)


if __name__ == '__main__':
    support.main(TestFleet)
