"""The exercise in real time on a busy machine."""
import support
from geometry_msgs.msg import Twist

FAULT = 'the exercise in real time while four busy loops run; one run without them for comparison'
PROMISE = '500 forward commands and 314 turn commands arrive, and the base neither times out nor stops in between'
FULL, SHORT = 5, 1
ROOT = False
ALONE = True

LOOPS = 4


def drive(row, odom, commands, loops):
    """One run, with so many busy loops beside it as soon as it moves. Returns how long it took by the stamps, s."""
    del commands.messages[:]
    odom.wait_for_twist(0.0)
    del odom.messages[:-1]
    driver = row.start('rosrun', 'rbx1_nav', 'timed_out_and_back.py')
    odom.wait_for_twist(0.2)
    with row.busy(loops):
        status = driver.wait()
    assert status == 0, driver.output
    odom.next()
    kinds = [(m.linear.x, m.angular.z) for m in commands.messages]
    forward, turns = kinds.count((0.2, 0.0)), kinds.count((0.0, 1.0))
    assert (forward, turns) == (500, 314), '%d and %d commands' % (forward, turns)
    velocities = [(m.twist.twist.linear.x, m.twist.twist.angular.z) for m in odom.messages]
    # what the odometry reports, without repetitions: a stop in between would be one more
    changes = [new for old, new in zip([None] + velocities, velocities) if new != old]
    expected = [(0.0, 0.0)] + 2 * [(0.2, 0.0), (0.0, 0.0), (0.0, 1.0), (0.0, 0.0)]
    assert changes == expected, f'reported velocities: {changes}'
    moving = [m.header.stamp for m, velocity in zip(odom.messages, velocities) if any(velocity)]
    return (moving[-1] - moving[0]).to_sec()


def run(row):
    """See FAULT."""
    row.roscore()
    base = row.base()
    support.init_node('faults')
    odom, commands = support.OdomWatch(), support.Watch('/cmd_vel', Twist)
    if row.times > 1:
        row.figure('duration without load (s)', drive(row, odom, commands, 0))
    for number in range(row.times):
        with row.fault('run %d' % (number + 1)):
            row.figure('duration with load (s)', drive(row, odom, commands, LOOPS))
            assert 'no command for' not in base.output, base.output
