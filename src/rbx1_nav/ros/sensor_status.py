"""The state of one of the filter's sensors, for /diagnostics."""
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import Updater


def make_diagnostics(sensors, diagnose):
    """An Updater of the sensors with these names. diagnose(sensor, status): fills in the DiagnosticStatus of one."""
    diagnostics = Updater()
    diagnostics.setHardwareID('none')
    for sensor in sensors:
        diagnostics.add(sensor, lambda status, sensor=sensor: diagnose(sensor, status))
    return diagnostics


class SensorStatus:
    """Counts a sensor's messages, and fills in its DiagnosticStatus."""

    def __init__(self, timeout):
        """timeout: age of the last message from which on the sensor has timed out, s."""
        self.timeout = timeout
        self.received = None    # rospy.Time of the last message
        self.rejected = 0

    def diagnose(self, status, timed_out, contradicts):
        """Fill in a DiagnosticStatus. timed_out: whether the filter does not use this sensor; contradicts: whether
        wheels and gyro contradict each other."""
        age = None if self.received is None else (rospy.Time.now() - self.received).to_sec()
        # below 0: the clock has jumped back since
        if timed_out or age is None or not -1 <= age <= self.timeout:
            status.summary(DiagnosticStatus.WARN, 'No message yet' if age is None else 'Timed out, not used')
        elif contradicts:
            status.summary(DiagnosticStatus.WARN, 'Wheels and gyro contradict each other')
        else:
            status.summary(DiagnosticStatus.OK, 'Used')
        status.add('Age of the last message (s)', 'never' if age is None else '%.3f' % age)
        status.add('Rejected messages', self.rejected)
