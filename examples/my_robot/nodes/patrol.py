#!/usr/bin/env python3
"""Drives 1 m forward and 1 m backward until it is stopped."""
import rospy
from geometry_msgs.msg import Twist


def main():
    rospy.init_node('patrol')
    publisher = rospy.Publisher('cmd_vel', Twist, queue_size=10)
    rospy.on_shutdown(lambda: publisher.publish(Twist()))
    while not publisher.get_num_connections():
        rospy.sleep(0.1)
    rospy.sleep(1)

    rate = rospy.Rate(20)
    move = Twist()
    move.linear.x = 0.2
    while not rospy.is_shutdown():
        for _ in range(5 * 20):
            publisher.publish(move)
            rate.sleep()
        move.linear.x = -move.linear.x


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:     # Ctrl-C
        pass
