#!/usr/bin/env python3
"""Drives 1.000 m forward at 0.2 m/s for 5 s, then stops. Sends 20 commands per second."""
import rospy
from geometry_msgs.msg import Twist


def main():
    rospy.init_node('drive')
    publisher = rospy.Publisher('cmd_vel', Twist, queue_size=10)
    # commands that are sent before the base is connected are lost
    while not publisher.get_num_connections():
        rospy.sleep(0.1)
    # now there is a time: a Rate that was created before would not sleep after its first command
    rospy.sleep(1)

    rate = rospy.Rate(20)
    forward = Twist()
    forward.linear.x = 0.2
    for _ in range(5 * 20):
        publisher.publish(forward)
        rate.sleep()
    publisher.publish(Twist())
    # a message that a node sends just before it exits may be lost
    rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:     # Ctrl-C
        pass
