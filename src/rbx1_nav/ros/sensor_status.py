"""The state of one of the filter's sensors, for /diagnostics."""
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import Updater

MAX_OUTLIERS = 5    # steps between two diagnoses: now and then a wheel may slip


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
        self.outliers = 0       # at the last diagnosis

    def diagnose(self, status, timed_out, outliers):
        """Fill in a DiagnosticStatus. timed_out: whether the filter does not use this sensor; outliers: steps so far in
        which wheels and gyro disagreed."""
        disagree = outliers - self.outliers > MAX_OUTLIERS
        self.outliers = outliers
        age = None if self.received is None else (rospy.Time.now() - self.received).to_sec()
        # below 0: the clock has jumped back since
        if timed_out or age is None or not -1 <= age <= self.timeout:
            status.summary(DiagnosticStatus.WARN, 'No message yet' if age is None else 'Timed out, not used')
        elif disagree:
            status.summary(DiagnosticStatus.WARN, 'Wheels and gyro disagree')
        else:
            status.summary(DiagnosticStatus.OK, 'Used')
        status.add('Age of the last message (s)', 'never' if age is None else '%.3f' % age)
        status.add('Rejected messages', self.rejected)
        status.add('Steps in which wheels and gyro disagreed', outliers)
