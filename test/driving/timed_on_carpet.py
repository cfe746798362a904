#!/usr/bin/python3
"""On carpet, the timed script misses as in the picture in the tutorial, exactly like the simulation without ROS."""
import math

import rospy

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.many_runs.simulated_run import simulate
from rbx1_nav.node import resources
from rbx1_nav.simulation.slip import read_seed
import support


class TestTimedOnCarpet(support.Case):
    def test_it_misses_as_simulated(self):
        odom = support.OdomWatch()
        truth = support.Watch('/ground_truth', support.Odometry)
        support.wait_for(lambda: truth.last, '/ground_truth')
        driver = support.out_and_back()
        self.assertEqual(driver.wait(), 0, driver.output)
        odom.next()
        x, y, yaw = support.pose(truth.next())

        # as in the picture in the tutorial: about half a meter to the left of the start, with a different heading
        self.assertGreater(y, 0.35)
        self.assertLess(math.hypot(x, y), 0.65)
        self.assertTrue(20 < abs(math.degrees(support.wrapped(yaw))) < 90, math.degrees(yaw))
        # most of the error is visible in the odometry
        self.assertLess(math.hypot(x - odom.position()[0], y - odom.position()[1]), 0.20)

        # 1e-9 is far above the rounding in a thousand steps
        robot = load_robot(resources.path('config', 'turtlebot.yaml'))
        surface = load_surface('low_ply_carpet', resources.surfaces())
        end = simulate('timed', robot, surface, read_seed(rospy.get_param('/arbotix/seed'))).end
        for pose, simulated in (((x, y, yaw), end.truth), (support.pose(odom.last), end.odometry)):
            self.assertAlmostEqual(pose[0], simulated.x, delta=1e-9)
            self.assertAlmostEqual(pose[1], simulated.y, delta=1e-9)
            self.assertAlmostEqual(support.wrapped(pose[2] - simulated.yaw), 0, delta=1e-9)


if __name__ == '__main__':
    support.main(TestTimedOnCarpet)
