#!/usr/bin/python3
"""A driver that does not wait for the time drives the same path in every run, however it waits for the base."""
import rospy
from nav_msgs.msg import Odometry
from std_srvs.srv import Empty

import support

RUNS = 4
DRIVER = '''
import sys, time, rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
rospy.init_node('early', anonymous=True)
first = rospy.Time.now()
cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=10)
rate = rospy.Rate(10)
if sys.argv[1] == 'sleep':
    time.sleep(1)
elif sys.argv[1] == 'connection':
    while not cmd_vel.get_num_connections():
        time.sleep(0.1)
else:
    poses = []
    rospy.Subscriber('odom', Odometry, poses.append)
    while not poses:
        rospy.sleep(0.01)
for k in range(20):
    move = Twist()
    move.linear.x = 0.1 + 0.01 * k
    cmd_vel.publish(move)
    rate.sleep()
cmd_vel.publish(Twist())
rospy.sleep(0.5)
print('first time', first.to_sec(), flush=True)
'''
# A Rate that was made at time 0 does not sleep after the first command: 0.11 to 0.29 m/s for 0.1 s each
DISTANCE = sum(0.1 + 0.01 * k for k in range(1, 20)) * 0.1


class TestEarlyDriver(support.Case):
    def drive(self, how):
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        driver = self.start('/usr/bin/python3', self.file(DRIVER, '.py'), how)
        self.assertEqual(driver.wait(), 0, driver.output)
        # rospy of Debian 11 prints an error of its own when a node exits
        first = next(line for line in driver.lines if line.startswith('first time'))
        return first, rospy.wait_for_message('/odom', Odometry).pose.pose.position.x

    def check(self, how):
        rospy.wait_for_service('/arbotix/reset')
        for _ in range(RUNS):
            first, x = self.drive(how)
            self.assertEqual(first, 'first time 0.0')
            self.assertAlmostEqual(x, DISTANCE, delta=support.MICROMETRE)

    def test_it_sleeps_by_the_wall_clock(self):
        self.check('sleep')

    def test_it_waits_for_its_connection(self):
        self.check('connection')

    def test_it_waits_for_odometry(self):
        self.check('odometry')


if __name__ == '__main__':
    support.main(TestEarlyDriver)
