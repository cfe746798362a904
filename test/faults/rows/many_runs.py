"""simulate.py --output, interrupted at random moments and continued by the same command."""
import os
import re
import shutil
import signal
import time

from cluster import Cluster
import processes
import support
from rows.simulate_faults import Simulation

FAULT = ('simulate.py --output, with local processes or a Dask cluster: a signal, SIGKILL of the program, of a worker '
         'or of the scheduler, or a full disk, at a random moment; then the same command again')
PROMISE = ('complete chunks or none, one line with the number of missing runs, a non-zero exit status; then the same '
           'bytes as without the fault')
FULL, SHORT = 49, 7
ROOT = ALONE = False

COMMAND = ['--surface', 'low_ply_carpet', '--method', 'timed', '--runs', '20000', '--set', 'linear_speed=0.2,0.4']
FILE = 'runs.csv'
LONGEST = 3.0       # s of wall time that the command takes on two cores, roughly


class Faults:
    """The faults, and the file without a fault."""

    def __init__(self, row):
        self.row = row
        self.cluster = self.start_cluster()
        self.finish('--jobs', '2')
        with open(FILE, 'rb') as file:
            self.content = file.read()
        self.remove()

    @staticmethod
    def start_cluster():
        """Start a cluster with two workers."""
        folder = os.path.abspath('cluster')
        shutil.rmtree(folder, ignore_errors=True)
        os.mkdir(folder)
        return Cluster(folder)

    @staticmethod
    def remove():
        """Remove the file."""
        for name in FILE, f'{FILE}.json':
            if os.path.exists(name):
                os.remove(name)

    def place(self, on_cluster):
        """The arguments that select where the runs are computed."""
        return ['--scheduler', self.cluster.address] if on_cluster else ['--jobs', '2']

    def start(self, *arguments, limit=None):
        """Start the command."""
        return Simulation(self.row, *COMMAND, '--output', FILE, *arguments, limit=limit)

    def finish(self, *arguments):
        """Run the command to its end."""
        simulation = self.start(*arguments)
        _, errors = simulation.process.communicate(timeout=300)
        assert simulation.process.returncode == 0, errors[-1500:]

    def check_rows(self):
        """The file begins like the one without a fault, and has no incomplete row."""
        content = b''
        if os.path.exists(FILE):
            with open(FILE, 'rb') as file:
                content = file.read()
        assert self.content.startswith(content), 'another file'
        return len(content)

    def end(self, simulation, *statuses, says=True):
        """The command exits with one of these statuses, or was faster than the fault; says: whether it can print."""
        _, errors = simulation.process.communicate(timeout=120)
        status = simulation.process.returncode
        processes.wait_for_end(simulation.pids, 5.0)
        size = self.check_rows()
        if status == 0:
            assert size == len(self.content)
            return
        assert status in statuses, f'status {status}: {errors[-1500:]}'
        lines = [line for line in errors.splitlines() if not re.search('run/s|s/run', line)]     # without the progress
        # a signal before the command line was read leaves nothing to report
        assert 'Traceback' not in errors and len(lines) <= 1, errors[-1500:]
        if says and os.path.exists(f'{FILE}.json') and size > 1000:
            assert lines and f'{FILE} lacks ' in lines[0] and ' of 40000 runs' in lines[0], errors[-1500:]
        self.row.figure('rows when it was interrupted', self.content[:size].count(b'\n'))

    def sleep(self):
        """Wait for a random time."""
        time.sleep(self.row.random.uniform(0.2, LONGEST))

    def signalled(self, on_cluster, number):
        """A signal to the command."""
        simulation = self.start(*self.place(on_cluster))
        self.sleep()
        simulation.process.send_signal(number)
        self.end(simulation, 130, -number, says=number != signal.SIGKILL)

    def killed_process(self, _):
        """One of its processes is killed."""
        simulation = self.start('--jobs', '2')
        workers = support.wait_for(simulation.workers, 'workers')
        self.sleep()
        if simulation.process.poll() is None:
            try:
                os.kill(self.row.random.choice(workers), signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.end(simulation, 1)

    def killed_worker(self, _):
        """A worker is killed, and replaced: the command itself does not fail."""
        simulation = self.start(*self.place(True))
        self.sleep()
        self.cluster.workers.pop(self.row.random.randrange(2)).kill()
        self.cluster.workers.append(self.cluster.start_worker())
        self.end(simulation)

    def killed_scheduler(self, _):
        """The scheduler is killed, and its workers with it."""
        simulation = self.start(*self.place(True))
        self.sleep()
        self.cluster.stop()
        self.end(simulation, 1)
        self.cluster = self.start_cluster()

    def full_disk(self, on_cluster):
        """The file cannot grow beyond a random size."""
        limit = self.row.random.randrange(5000, len(self.content))
        simulation = self.start(*self.place(on_cluster), limit=limit)
        self.end(simulation, 1)


def run(row):
    """See FAULT."""
    faults = Faults(row)
    kinds = [(faults.signalled, number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)]
    kinds += [(faults.full_disk,), (faults.killed_process,), (faults.killed_worker,), (faults.killed_scheduler,)]
    try:
        for number in range(row.times):
            kind, *arguments = kinds[number % len(kinds)]
            on_cluster, again = row.random.random() < 0.5, row.random.random() < 0.5
            with row.fault(' '.join([kind.__name__, *map(str, arguments), 'on a cluster' if on_cluster else 'here'])):
                kind(on_cluster, *arguments)
                faults.finish(*faults.place(again))
                assert faults.check_rows() == len(faults.content)
            faults.remove()
    finally:
        faults.cluster.stop()
