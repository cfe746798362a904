"""A robot without errors that sends its messages to a filter."""
import pytest

from rbx1_nav.base.kinematics import Pose, arc
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.input_checks import Imu, Odom
from sample_priors import PRIORS

STEP = SECOND // 50


class Robot:
    """Sends the messages of a robot without errors every 0.02 s."""

    def __init__(self, prior=PRIORS, **options):
        self.warnings = []      # but not that the robot drives off without a rest, as in most tests
        self.combined = CombinedOdometry(prior, SECOND, warn=self.warn, **options)
        self.now = 1000 * SECOND
        self.pose = Pose(0.0, 0.0, 0.0)

    def send(self, ticks=1, linear=0.0, angular=0.0, odom=True, imu=True, bias=0.0):
        """Move for a number of ticks, and send what both sensors measure; return the last Estimate."""
        for _ in range(ticks):
            self.now += STEP
            self.pose = arc(self.pose, linear * 0.02, angular * 0.02)
            if imu:
                self.combined.add_imu(self.now, Imu(self.now, angular + bias, 3e-6))
            if odom:
                self.combined.add_odom(self.now, self.odom())
        return self.combined.estimate

    def warn(self, text):
        """Store a warning."""
        if not text.startswith('the robot has not been at rest yet'):
            self.warnings.append(text)

    def odom(self):
        """Return the present odometry."""
        return Odom(self.now, self.pose)


def exact(estimate, pose, abs=1e-9):
    """Return whether an Estimate is at a Pose."""
    return estimate.pose == pytest.approx(pose, abs=abs)
