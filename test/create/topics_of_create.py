#!/usr/bin/python3
"""A subscriber sees sensors, buttons and battery of the robot, and a publisher reaches its lights, songs and dock."""
import rospy
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Empty, Float32, Float32MultiArray, UInt8, UInt8MultiArray

from driven import DrivenRobot
from rbx1_nav.extras.create.protocol import command
import support


class TestCreateTopics(support.Case):
    def setUp(self):
        self.robot = DrivenRobot(self, 'create2', oi_mode_workaround=False)

    def watch(self, topic, kind):
        watch = support.Watch(topic, kind)
        self.addCleanup(watch.subscriber.unregister)
        watch.wait_for_publisher('/turtlebot_node')
        return watch

    def publish(self, topic, kind, **fields):
        """Publish a message to the node."""
        publisher = rospy.Publisher(topic, kind, queue_size=1)
        self.addCleanup(publisher.unregister)
        support.wait_for(publisher.get_num_connections, f'the node to subscribe to {topic}')
        publisher.publish(**fields)

    def test_sensors(self):
        for setting, bit, topic, kind in (
                ('switches', 2, 'bumper/left', Bool), ('switches', 4, 'wheeldrop', Empty),
                ('cliffs', 8, 'cliff/right', Bool), ('buttons', 4, 'dock_button', Empty)):
            watch = self.watch(topic, kind)
            self.robot.publish(setting, bit)
            support.wait_for(lambda: watch.last and getattr(watch.last, 'data', True), topic)
            self.robot.publish(setting, 0)

    def test_battery_and_dock(self):
        battery, voltage = self.watch('battery_state', BatteryState), self.watch('battery/voltage', Float32)
        self.robot.publish('charge', 0.5)
        support.wait_for(lambda: battery.next().percentage < 0.51, 'half a charge')
        self.assertEqual(battery.last.power_supply_status, BatteryState.POWER_SUPPLY_STATUS_DISCHARGING)
        # 14.75 V at half a charge, which the robot uses up
        self.assertAlmostEqual(voltage.next().data, 14.75, delta=0.05)

        self.publish('dock', Empty)
        self.robot.wait_for_status('Not driven: docking')
        support.wait_for(lambda: self.robot.moving, 'the robot to look for its dock')
        self.robot.switch('dock', True)
        support.wait_for(lambda: battery.last.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING, 'it')
        self.robot.node.wait_for_line('The robot is on its dock')
        start = support.pose(self.robot.truth.next())

        self.publish('undock', Empty)
        self.robot.node.wait_for_line('The robot has left its dock')
        self.robot.wait_for_standstill()
        end = support.pose(self.robot.truth.next())
        # a busy machine may stop it later, or before 0.2 m with the time that it has
        distance = ((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2) ** 0.5
        self.assertTrue(0.19 < distance < 0.5, distance)
        self.robot.wait_for_mode('safe')
        self.assertIn(command('full'), self.robot.commands_since(0))
        self.robot.wait_for_motion()

    def test_lights_and_songs(self):
        for topic, kind, data, expected in (
                ('spot_led', Bool, True, command('leds', 2, 0, 255)),
                ('power_led', UInt8MultiArray, b'\x80\x40', command('leds', 2, 0x80, 0x40)),
                ('set_ascii', UInt8MultiArray, b'Go', command('digit_leds_ascii', *b'Go  ')),
                ('define_song', Float32MultiArray, [1, 72, 0.5], command('song', 1, 1, 72, 32)),
                ('play_song', UInt8, 1, command('play_song', 1))):
            count = len(self.robot.received())
            self.publish(topic, kind, data=data)
            self.robot.wait_for_command(count, lambda _, sent, wanted=expected: sent == wanted)


if __name__ == '__main__':
    support.main(TestCreateTopics)
