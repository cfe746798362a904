#!/usr/bin/python3
"""A robot that transforms drive is in step, although the models of three robots publish transforms as well."""
import support


class TestFleetModels(support.Case):
    def test_a_robot_that_transforms_drive(self):
        driver = support.Process('rosrun', 'rbx1_nav', 'calibrate_linear.py', '_goal_distance:=0.1',
                                 ROS_NAMESPACE='robot1')
        driver.wait_for_line('The odometry reports')


if __name__ == '__main__':
    support.main(TestFleetModels)
