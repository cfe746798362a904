"""A driving script stalls in a motion, in real time: the delay is made up for, or the script fails."""
import math
import signal
import time

import support

FAULT = 'the timed script is suspended for 0.1, 0.3 or 0.9 s at a random moment of a motion, in real time'
PROMISE = ('the robot is within 2 mm and 0.2 degrees of the exact end pose, or the last line is a warning that names '
           'the delay, or the exit status is 1')
FULL, SHORT = 60, 6
ROOT = False
ALONE = True

STALLS = (0.1, 0.3, 0.9)    # s
DISTANCE, SPEED, TURN = 0.3, 0.2, 2.0   # m, m/s, rad
ARGUMENTS = (f'_goal_distance:={DISTANCE}', f'_linear_speed:={SPEED}', f'_goal_angle:={TURN}')
# of the exact run, in which each turn is 100 ticks of 0.02 rad
X, Y, YAW = DISTANCE * (1 + math.cos(TURN)), DISTANCE * math.sin(TURN), 2 * TURN


def run(row):
    """See FAULT."""
    row.roscore()
    row.base()
    support.init_node('faults')
    odom = support.OdomWatch()
    for count in range(row.times):
        stall, moment = STALLS[count % 3], row.random.uniform(0, DISTANCE / SPEED + 1 + TURN)
        with row.fault(f'{stall:g} s, {moment:.3f} s after the first command'):
            row.reset()
            driver = row.node('timed_out_and_back.py', *ARGUMENTS)
            odom.wait_for_twist(SPEED, since=len(odom.messages))
            time.sleep(moment)
            driver.signal(signal.SIGSTOP)
            time.sleep(stall)
            driver.signal(signal.SIGCONT)
            status = driver.wait()
            x, y, yaw = support.pose(odom.next())
            off, turned = math.hypot(x - X, y - Y), abs(math.degrees(support.wrapped(yaw - YAW)))
            assert 'Traceback' not in driver.output, driver.output
            row.figure(f'runs with status 1 after {stall:g} s (0 or 1)', status)
            assert status in (0, 1), driver.output
            if status == 0:
                row.figure('distance from the exact end pose with status 0 (m)', off)
                warned = 'more than a period' in driver.lines[-1]
                assert warned or off < 0.002 and turned < 0.2, (
                    f'{off:.4f} m and {turned:.2f} degrees off\n{driver.output}')
