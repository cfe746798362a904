"""Random drives of robots that keep or drop fractions of a degree, with pushes by hand and blocked wheels."""
from math import degrees, radians
import random

import pytest


from driven_create import NO_ERRORS, started

DRIVES = range(15)
STEP = 0.05     # s


class Hand:
    """Blocks the wheels of a robot, or turns it."""

    def __init__(self, body):
        self.free_travel, self.width = body.wheels.travel, body.model.wheel_separation
        self.blocks, self.rate = False, 0.0     # rad/s
        body.wheels.travel = self.travel

    def travel(self, linear, angular, duration):
        """Return the travel of the wheels like Wheels.travel()."""
        left, right = self.free_travel(*((0.0, 0.0) if self.blocks else (linear, angular)), duration)
        push = self.rate * duration * self.width / 2
        return left - push, right + push


def random_drive(seed, drops):
    """Return (error, sigma, sum of the absolute turns) in degrees at the end of a random drive."""
    choose = random.Random(seed)
    driven = started('create', drops_fractions=drops, **NO_ERRORS)
    hand, angle = Hand(driven.body), driven.body.angle
    before, true, turned = driven.pose.yaw, angle.total, 0.0

    def run(seconds, velocity):
        nonlocal turned
        for _ in range(max(1, round(seconds / STEP))):
            last = angle.total
            driven.velocity = velocity
            driven.run(STEP)
            turned += abs(angle.total - last)
    for _ in range(choose.choice([6, 12, 20])):
        rate = choose.choice([-1, 1]) * 0.1 * 30 ** choose.random()     # 0.1 to 3 rad/s
        velocity = choose.choice([0, choose.uniform(-0.1, 0.15)]), rate
        event = choose.random()
        hand.blocks = event < 0.08
        if 0.08 < event < 0.16:
            hand.rate = choose.choice([-1, 1]) * radians(choose.uniform(20, 120))
            run(choose.uniform(0.2, 1), choose.choice([None, velocity]))
            hand.rate = 0.0
        run(choose.uniform(0.3, 4), velocity)
        hand.blocks = False
        if choose.random() < 0.4:
            driven.command_zero()
            run(choose.uniform(0.2, 3), None)
    driven.command_zero()
    run(2, None)
    error = degrees(driven.pose.yaw - before) - (angle.total - true)
    return error, degrees(driven.driver.motion.odometry.covariance[2][2] ** 0.5), turned


@pytest.mark.parametrize('drops, share', [(False, 0.007), (True, 0.015)])
def test_the_odometry_reports_the_turns(drops, share):
    squares = []
    for seed in DRIVES:
        error, sigma, turned = random_drive(seed, drops)
        assert abs(error) < share * turned + 1, seed
        squares.append((error / sigma) ** 2)
    assert 0.05 < sum(squares) / len(squares) < 8      # of 15 drives
