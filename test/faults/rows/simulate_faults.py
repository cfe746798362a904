"""simulate.py: killed workers, full disks, signals, closed pipes."""
import os
import re
import resource
import signal
import subprocess
import time

import rospkg

import processes
import support

FAULT = 'simulate.py: a killed worker, a full disk, signals, a closed pipe'
PROMISE = 'at most one line, a non-zero exit status, no process left after 1 s, and no incomplete picture'
FULL, SHORT = 100, 8
ROOT = ALONE = False

SIMULATE = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'nodes', 'simulate.py')
LONG = ['--surface', 'low_ply_carpet', '--runs', '5000', '--jobs', '2']     # takes minutes
FOLDER = 'pictures'
MARK = 'RBX1_NAV_FAULT'
EARLY = 'import rbx1_nav.node.early_interrupt'
HANGS = 40          # s of wall time without an end
FULL_AT = 8192      # bytes: no picture is that small


class Simulation:
    """A run of simulate.py, with its processes found by a mark."""

    count = 0

    def __init__(self, row, *arguments, limit=None, stdout=subprocess.PIPE):
        """limit: size that a file may reach, bytes."""
        Simulation.count += 1
        self.row = row
        self.mark = '%d.%d' % (os.getpid(), Simulation.count)

        def prepare():
            if limit:
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        self.process = subprocess.Popen(['/usr/bin/python3', SIMULATE, *arguments], stdout=stdout, text=True,
                                        stderr=subprocess.PIPE, preexec_fn=prepare,
                                        # as for a user: output that is buffered is lost in another way
                                        env=dict(os.environ, PYTHONUNBUFFERED='', **{MARK: self.mark}))

    def pids(self):
        """All its processes."""
        return processes.with_variable(MARK, self.mark)

    def workers(self):
        """Those that it started itself."""
        return [pid for pid in self.pids() if pid != self.process.pid]

    def check_end(self, *statuses):
        """It exits with one of these statuses and at most one line, and leaves no process behind."""
        try:
            _, errors = self.process.communicate(timeout=HANGS)
        except subprocess.TimeoutExpired:
            self.kill()
            raise AssertionError('simulate.py, or one of its processes, does not exit')
        try:
            assert self.process.returncode in statuses, 'status %d: %s' % (self.process.returncode, errors[-1500:])
            # unless Python was not yet as far as our first line
            assert EARLY in errors or errors.count('\n') <= 1 and 'Traceback' not in errors, errors[-1500:]
            self.row.figure('last child process exited after (s)', processes.wait_for_end(self.pids, 1.0))
        finally:
            self.kill()
        return errors

    def kill(self):
        """Kill all of it."""
        for pid in self.pids():
            os.kill(pid, signal.SIGKILL)


def full_disk(row):
    """The disk is full in the middle of a picture."""
    path = os.path.abspath(os.path.join(FOLDER, 'picture.png'))
    errors = Simulation(row, '--method', 'timed', '--runs', '20', '--surface', 'hard_floor', '--jobs', '1',
                        '--plot', path, limit=FULL_AT).check_end(1)
    assert errors.endswith(f"simulate.py: [Errno 27] File too large: '{path}'\n"), errors


def full_output(row):
    """The disk is full where the table is written to."""
    with open('/dev/full', 'w') as full:
        assert Simulation(row, '--method', 'timed', '--runs', '1', stdout=full).check_end(1)


def killed_worker(row):
    """One worker is killed, as by the kernel when memory runs out."""
    simulation = Simulation(row, *LONG)
    workers = support.wait_for(simulation.workers, 'workers')
    time.sleep(row.random.uniform(0, 0.5))
    os.kill(row.random.choice(workers), signal.SIGKILL)
    errors = simulation.check_end(1)
    assert re.match('simulate.py: a process was killed, .*: expected all of --jobs 2 to run$', errors), errors


def signalled(row, number):
    """A signal, at any moment: the parent's end takes the workers with it."""
    simulation = Simulation(row, *LONG)
    time.sleep(row.random.uniform(0, 4))
    simulation.process.send_signal(number)
    # its own status, or the one of a process that a signal ends: before it has handlers, or SIGKILL
    simulation.check_end(130, -number)


def closed_pipe(row):
    """The reader of its output has seen enough."""
    # it notices that when it writes, so with few runs
    simulation = Simulation(row, '--surface', 'low_ply_carpet', '--runs', '50', '--jobs', '2')
    simulation.process.stdout.close()
    simulation.process.stdout = None
    simulation.check_end(1)


def run(row):
    """See FAULT."""
    os.mkdir(FOLDER)
    # matplotlib makes a list of fonts at its first picture; in Debian 11, it cannot save this list on a full disk
    first = os.path.join(FOLDER, 'first.png')
    Simulation(row, '--method', 'timed', '--runs', '1', '--plot', first).check_end(0)
    os.remove(first)
    faults = [(full_disk,), (full_output,), (closed_pipe,)] + 3 * [(killed_worker,)]
    faults += 3 * [(signalled, number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)]
    while len(faults) < row.times:
        faults += row.random.sample(faults, min(len(faults), row.times - len(faults)))
    for fault, *arguments in row.random.sample(faults, row.times):
        with row.fault(' '.join([fault.__name__, *map(str, arguments)])):
            fault(row, *arguments)
            left = os.listdir(FOLDER)
            assert not left, f'left behind: {left}'
        for name in os.listdir(FOLDER):
            os.remove(os.path.join(FOLDER, name))
