"""Drivers with feedback in lockstep: every run of a driver takes the same path."""
import rospy
from nav_msgs.msg import Odometry

import support
import feedback

FAULT = ('drivers with feedback at real_time_factor 20: in rospy and roscpp, at 10 to 50 Hz, with the latest /odom, '
         'transform or /odom_ekf, or in callbacks; in every second run beside four busy loops')
PROMISE = ('the end pose of a driver is the one of an ideal clock to a micrometer, and the same in every run to the '
           'last bit, except with /odom_ekf')
FULL, SHORT = 20, 2     # runs of each kind of driver
ROOT, ALONE = False, True

BASE = 'real_time_factor:=20', 'strict:=true', 'model:=none'
BUSY = 4        # loops
RATES = 10, 20, 50      # Hz


class Base:
    """The simulated base, with a filter if it is needed; started again after it has exited."""

    def __init__(self, row, filtered):
        self.row = row
        self.filtered = filtered
        self.launch = self.filter = None

    def start(self):
        """Start what does not run, and put the robot back."""
        if not self.runs():
            self.end()
            self.launch = self.row.base(*BASE)
            if self.filtered:
                self.filter = self.row.start('roslaunch', '--wait', 'rbx1_bringup', 'odom_ekf.launch')
                rospy.wait_for_message('/odom_ekf', Odometry, support.LIMIT)
        self.row.reset()

    def runs(self):
        """Return whether the base runs."""
        return self.launch is not None and self.launch.process.poll() is None

    def end(self):
        """End both."""
        if self.launch:
            self.row.end(*[each for each in (self.filter, self.launch) if each])


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for filtered, languages in (False, ('rospy', 'roscpp')), (True, ('filter', 'filter in roscpp')):
        base = Base(row, filtered)
        for language in languages:
            for kind in feedback.RATES[language.split()[0]]:
                ends = {}       # by rate
                for number in range(row.times):
                    rate = RATES[number // 2 % len(RATES)]
                    arguments = kind, str(rate)
                    loops = number % 2 * BUSY
                    text = f"{language}: {' '.join(arguments)}, {loops} busy loops"
                    with row.fault(text), row.busy(loops):
                        check(base, feedback.driver_in(language.split()[-1]), arguments, ends)
        base.end()


def check(base, driver, arguments, ends):
    """Run a driver, and compare its end pose. ends: the end poses of earlier runs, by rate."""
    kind, rate = arguments[0], int(arguments[1])
    base.start()
    process = base.row.start(driver, *arguments)
    try:
        support.wait_for(lambda: process.process.poll() is not None or not base.runs(), 'the end of the driver')
        assert base.runs(), [line for line in base.launch.lines if 'FATAL' in line]
        assert process.wait() == 0, process.output
    finally:
        process.kill()
    end = support.pose(rospy.wait_for_message('/ground_truth', Odometry, support.LIMIT))
    ideal = feedback.ideal_end(feedback.effective_rate(kind, rate))
    expected = ends.setdefault(rate, end)
    # the filter's estimate rounds differently after another time at rest
    assert repr(end) == repr(expected) or kind == 'latest_ekf', f'{end}, in an earlier run {expected}'
    # the base and this row round differently
    assert all(abs(a - b) < support.MICROMETRE for a, b in zip(end, ideal)), f'{end}, expected {ideal}'
