#!/usr/bin/env python3
"""Measure any base with any driver from outside, given the shell commands that start them. See README.md.

Each run starts a roscore on a free port of the loopback interface, the base, and a probe that records every command and
every odometry message. All processes are cleaned up, even after Ctrl-C.
"""
import argparse
import contextlib
import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

sys.path.append(os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'test'))

import figures
from ports import free_port
import processes
import table
from probe import Probe

START = 30  # s of wall time for a roscore or a base to come up
SETTLE = 3  # s of wall time after the driver has exited, for the robot to come to a standstill
SAMPLE = 0.25  # s between two samples of CPU time and memory
LIMIT = 120  # s of wall time for a run
SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
# End pose of the exercise if each command is in force for exactly 1/50 s: out 1 m, 3.14 rad, back 1 m, 3.14 rad.
TUTORIAL = figures.arc(figures.arc(figures.arc(figures.arc((0, 0, 0), 1, 0, 1), 0, 1, 3.14), 1, 0, 1), 0, 1, 3.14)


class Failure(Exception):
    """A run that could not be measured; the text gives the reason."""


class Interrupted(BaseException):
    """A signal interrupted the program."""


class Transport(xmlrpc.client.Transport):
    """XML-RPC with a timeout of 5 s: a node that hangs must not block the benchmark."""

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = 5
        return connection


class Session:
    """A roscore and the commands that were started with it. Leaving the context stops all of them."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix='bench_')
        self.started = []
        port = free_port()
        self.changes = {'ROS_MASTER_URI': f'http://127.0.0.1:{port}', 'ROS_IP': '127.0.0.1', 'ROS_LOG_DIR': self.folder}
        self.environment = {**os.environ, **self.changes}
        self.environment.pop('ROS_HOSTNAME', None)  # it would take precedence over ROS_IP
        try:
            self.start(f'roscore -p {port}')
            # rosout is the last node that roscore starts
            self.wait(lambda: self.node_uri('/rosout'), 'the roscore')
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Stop all commands in reverse order, with SIGINT, or with SIGKILL if a command does not exit."""
        for process, command, _ in reversed(self.started):
            if not processes.stop(process):
                print(f'bench: "{command}" did not exit on SIGINT: killed', file=sys.stderr)
        processes.kill_rest()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, command):
        """Start a shell command, with its output in a file for error messages."""
        log = os.path.join(self.folder, f'output_{len(self.started)}')
        process = processes.start(command, self.environment, log)
        self.started.append((process, command, log))
        return process

    def wait(self, condition, what):
        """Return the first true value of condition(). Raises Failure after START seconds, or if a command exits."""
        end = time.monotonic() + START
        while True:
            value = condition()
            if value:
                return value
            ended = [command for process, command, _ in self.started if process.poll() is not None]
            if ended or time.monotonic() > end:
                reason = f'"{ended[0]}" exited' if ended else f'timed out after {START} s'
                raise Failure(f'waiting for {what}: {reason}\n{self.output()}')
            time.sleep(0.05)

    def output(self):
        """The last lines of output of the most recently started command."""
        with open(self.started[-1][2], errors='replace') as file:
            return ''.join(file.readlines()[-15:])

    def call(self, uri, method, *arguments):
        """The result of an XML-RPC call to the master or a node; None if it fails."""
        try:
            with xmlrpc.client.ServerProxy(uri, Transport()) as server:
                code, _, value = getattr(server, method)('/bench', *arguments)
        except (OSError, xmlrpc.client.Error):
            return None
        return value if code == 1 else None

    def node_uri(self, name):
        """The XML-RPC address of a node; None if it is not registered."""
        return self.call(self.changes['ROS_MASTER_URI'], 'lookupNode', name)

    def node_process(self, name):
        """The process id of a node, once it is running."""
        uri = self.wait(lambda: self.node_uri(name), f'the node {name}')
        return self.wait(lambda: self.call(uri, 'getPid'), f'the process id of {name}')


def interrupt(number, _):
    """Signal handler that raises an exception, so that all commands are stopped; the next signals are ignored."""
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise Interrupted(f'interrupted by {signal.Signals(number).name}')


@contextlib.contextmanager
def cleaned_up():
    """Kill all processes that are left at the end of this context. A Failure or a signal ends the program."""
    if not importlib.util.find_spec('rospy'):
        sys.exit(f'bench: {sys.executable} has no rospy: expected the Python of your ROS, as in\n'
                 f'  /usr/bin/python3 {sys.argv[0]} ...')
    processes.adopt_orphans()
    for number in SIGNALS:
        signal.signal(number, interrupt)
    try:
        yield
    except Failure as failure:
        sys.exit(f'bench: {failure}')
    except Interrupted as signalled:
        print(f'bench: {signalled}', file=sys.stderr)
        sys.exit(130)
    finally:
        processes.kill_rest()


def bring_up(session, args, publish=False):
    """Start base and probe, and wait for odometry; returns the probe and the process ids of the nodes of the base."""
    session.start(args.base)
    probe = Probe(session.changes, args.cmd_vel, args.odom, publish)
    pids = [session.node_process(name) for name in args.base_node]
    session.wait(lambda: probe.ask('arrived'), args.odom)
    return probe, pids


def measure_run(args, load):
    """Measure one run with `load` busy loops in parallel; returns its figures, its command periods (s) for pooling, and
    remarks."""
    with Session() as session:
        probe, pids = bring_up(session, args)
        simulated = bool(session.call(session.changes['ROS_MASTER_URI'], 'getParam', '/use_sim_time'))
        loops = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(load)]
        driver = session.start(args.driver)
        end = time.monotonic() + LIMIT
        samples = []
        while driver.poll() is None:
            samples.append(processes.sample(pids))
            if time.monotonic() > end:
                raise Failure(f'the driver did not exit within {LIMIT} s\n{session.output()}')
            if session.started[1][0].poll() is not None:
                raise Failure(f'"{args.base}" exited during the run')
            time.sleep(SAMPLE)
        proportional = processes.proportional(pids)
        time.sleep(SETTLE)
        for loop in loops:
            loop.kill()
        commands, odometry = probe.ask('record')
        if driver.returncode:
            print(f'bench: the driver exited with status {driver.returncode}:\n{session.output()}', file=sys.stderr)
    row, periods = figures.run_figures(commands, odometry, samples, args.timeout, TUTORIAL if simulated else None)
    row.update(rss_mb=max(s[2] for s in samples) / 1e6, pss_mb=proportional and proportional / 1e6)
    remarks = [f'{load} loops'] if load else []
    remarks += [f'driver exit status {driver.returncode}'] if driver.returncode else []
    return row, periods, ', '.join(remarks)


def measure_latency(args):
    """The delays from commands at random phases to the first odometry that shows them, starting at rest; None for a
    command that is never shown."""
    with Session() as session:
        probe, _ = bring_up(session, args, publish=True)
        time.sleep(1)
        return probe.ask('latency', args.latency)


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--base', required=True, help='shell command that starts the base, without a roscore')
    parser.add_argument('--driver', help='shell command that drives the base, and exits')
    parser.add_argument('--runs', type=int, default=10, help='number of runs (default 10)')
    parser.add_argument('--latency', type=int, default=0, metavar='N',
                        help='after the runs, measure the latency of N commands')
    parser.add_argument('--load', type=int, default=0, metavar='N', help='run N busy loops during every second run')
    parser.add_argument('--timeout', type=float, default=1.0,
                        help='timeout of a command in the base, s (default 1.0; 0: none)')
    parser.add_argument('--cmd-vel', default='/cmd_vel', help='topic of the commands (default /cmd_vel)')
    parser.add_argument('--odom', default='/odom', help='topic of the odometry (default /odom)')
    parser.add_argument('--base-node', nargs='+', default=['/arbotix'],
                        help='nodes whose CPU time and memory are measured')
    args = parser.parse_args()
    if args.runs and not args.driver:
        parser.error('--driver: missing: expected a shell command, or --runs 0')
    return args


def measure(args):
    """Measure and print what the command line requests."""
    rows, periods = [], []
    print(f'load average {os.getloadavg()[0]:.2f}\n{table.header()}', flush=True)
    for number in range(args.runs):
        row, new, remarks = measure_run(args, args.load if number % 2 else 0)
        rows.append(row)
        periods += new
        print(table.line(number + 1, row, remarks), flush=True)
    for line in table.summary(rows) if rows else ():
        print(line)
    table.print_spread('command period', periods)
    if args.latency:
        delays = measure_latency(args)
        shown = [delay for delay in delays if delay is not None]
        table.print_spread('command to odometry', shown)
        print(f'{len(delays) - len(shown)} of {len(delays)} commands were never shown by the odometry')


def main():
    args = arguments()
    with cleaned_up():
        measure(args)


if __name__ == '__main__':
    main()
