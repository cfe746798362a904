"""A Dask scheduler with workers for tests: on the loopback interface, with random ports, as children of the test."""
import os
import re
import signal
import subprocess
import sys
import time

from ports import free_port

LIMIT = 60      # s for a process to start


class Cluster:
    """A scheduler and workers, which stop with the test."""

    def __init__(self, folder, workers=2, **environment):
        """folder: for their files and output; environment: variables to set for all of them."""
        self.folder = folder
        self.environment = dict(os.environ, OPENBLAS_NUM_THREADS='1', **environment)
        self.processes = []
        self.port = free_port()
        self.scheduler = self.start_scheduler()
        self.workers = [self.start_worker() for _ in range(workers)]

    @property
    def address(self):
        """The address of the scheduler."""
        return f'tcp://127.0.0.1:{self.port}'

    def _start(self, module, ready, *arguments, **environment):
        log = os.path.join(self.folder, f'dask-{len(self.processes)}.log')
        with open(log, 'w', encoding='utf-8') as output:
            process = subprocess.Popen(
                [sys.executable, '-m', f'distributed.cli.{module}', *arguments, '--no-dashboard',
                 '--dashboard-address', '127.0.0.1:0'],
                stdout=output, stderr=output, cwd=self.folder, env=dict(self.environment, **environment))
        self.processes.append(process)
        end = time.monotonic() + LIMIT
        while True:
            with open(log, encoding='utf-8', errors='replace') as output:
                text = output.read()
            if re.search(ready, text):
                return process
            assert process.poll() is None and time.monotonic() < end, f'{module} does not start:\n{text[-2000:]}'
            time.sleep(0.05)

    def start_scheduler(self):
        """Start a scheduler at the port; return its process."""
        return self._start('dask_scheduler', r'Scheduler at:', '--host', '127.0.0.1', '--port', str(self.port))

    def start_worker(self, **environment):
        """Start a worker with one thread; return its process. environment: variables to set."""
        return self._start('dask_worker', r'Registered to:', self.address, '--host', '127.0.0.1', '--nthreads', '1',
                           '--no-nanny', '--local-directory', self.folder, **environment)

    def stop(self):
        """Kill all processes."""
        for process in self.processes:
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.wait()
