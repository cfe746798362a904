"""On a line that loses most replies, the robot is stopped, and its drivers read why."""
import numpy
import pytest

from driven_create import started

CHI_SQUARE = 16.3       # 99.9 % quantile for 3 degrees of freedom


@pytest.mark.parametrize('corruption', [0.05, 0.1])
def test_a_robot_on_a_very_bad_line_is_stopped(corruption):
    for seed in range(8):
        driven = started('create', seed=seed, odom_linear_error=0.0, odom_angular_error=0.0, odom_heading_error=0.0)
        driven.drive(0.2, 0.0, 2.0)
        driven.line.corruption = corruption
        driven.drive(0.0, 1.0, 5.0)
        assert driven.speeds == (0, 0)
        assert any('% of the replies of the robot are lost or corrupted' in text or 'the robot does not answer' in text
                   or 'the robot did not answer' in text for text in driven.refusals), driven.refusals
        driven.line.corruption = 0.0
        driven.run(3.0)
        error = numpy.array(driven.pose) - driven.truth
        assert error @ numpy.linalg.solve(driven.driver.motion.odometry.covariance, error) < CHI_SQUARE, seed
        # a zero command allows it to be driven again
        driven.command_zero()
        driven.drive(0.2, 0.0, 1.0)
        assert driven.speeds == (200, 200)
