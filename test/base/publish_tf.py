#!/usr/bin/python3
"""With publish_tf false, the base publishes odometry but no transform."""

from tf2_msgs.msg import TFMessage

import support


class TestPublishTF(support.Case):
    def test_odometry_without_a_transform(self):
        transforms = support.Watch('/tf', TFMessage)
        odom = support.OdomWatch()
        support.wait_for(lambda: len(odom.messages) > 50, 'fifty odometry messages')
        self.assertFalse(transforms.messages)


if __name__ == '__main__':
    support.main(TestPublishTF)
