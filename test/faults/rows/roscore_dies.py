"""roscore dies and is restarted while the robot drives: the run in progress finishes where it should."""
import os
import signal
import time

import rosgraph
import rospy

import support

FAULT = 'SIGKILL to roscore and its children during a run; roscore is restarted on the same port after 0 to 2 s'
PROMISE = ('the run in progress finishes with status 0, exactly where it should; a base and a script that are '
           'restarted work')
FULL, SHORT = 16, 2
ROOT = ALONE = False

SCRIPTS = ('timed_out_and_back.py', 'odom_out_and_back.py')
FACTOR = 5


def run(row):
    """See FAULT."""
    core = row.roscore()
    support.init_node('faults')
    for count in range(row.times):
        script = SCRIPTS[count % 2]
        moment, pause = row.random.uniform(0, 18), row.random.uniform(0, 2)
        with row.fault('%s, roscore killed %.3f s after the start of the motion, restarted after %.3f s' % (
                script, moment, pause)):
            # what the page says is to be started again: the base, and whatever talks to it
            base = row.base('real_time_factor:=%d' % FACTOR)
            odom = support.OdomWatch()
            driver = row.node(script)
            start = odom.wait_for_twist(0.2).header.stamp
            support.wait_for(lambda: (odom.last.header.stamp - start).to_sec() >= moment, 'the moment')
            kill(core)
            time.sleep(pause)
            core = row.roscore()
            row.check_home(driver, odom)
            assert base.process.poll() is None, f'roslaunch exited:\n{base.output}'
            # the new master knows neither the base nor its topics
            state = rosgraph.Master('/faults').getSystemState()
            known = {node for kind in state for _, nodes in kind for node in nodes}
            row.figure('old nodes known to the new master', len(known - {'/rosout'}))
            row.end(driver, base)
            odom.subscriber.unregister()


def kill(core):
    """Kill a roscore, its master and its rosout, which are in sessions of their own."""
    pids = [rospy.get_master().getPid()[2], support.pid_of('/rosout')]
    core.kill()
    for pid in pids:
        os.kill(pid, signal.SIGKILL)
