#!/usr/bin/python3
"""simulate.py on a Dask cluster of this machine: the file of local processes, whatever happens to a worker."""
import os
import re
import shutil
import tempfile
import unittest

import support
from cluster import Cluster

try:
    import distributed
except ImportError:
    distributed = None

COMMAND = ('--surface', 'low_ply_carpet', '--method', 'timed', '--method', 'ekf', '--runs', '300')


@unittest.skipUnless(distributed, 'needs the Debian package python3-distributed')
class TestTwoWorkers(support.Case):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.cluster = Cluster(cls.folder)
        cls.addClassCleanup(cls.cluster.stop)
        _, cls.output, cls.content = cls.simulate('local.csv', '--jobs', '2')

    @classmethod
    def start(cls, name, *arguments):
        """Start simulate.py with a file; return the Process and the path of the file."""
        path = os.path.join(cls.folder, name)
        return support.Process('rosrun', 'rbx1_nav', 'simulate.py', *COMMAND, '--output', path, *arguments), path

    @classmethod
    def simulate(cls, name, *arguments):
        """Run simulate.py; return the exit status, the output, and the content of the file."""
        return cls.wait(*cls.start(name, *arguments))

    @staticmethod
    def wait(process, path):
        """Wait for a Process; return what simulate() returns."""
        try:
            status = process.wait()
        finally:
            process.kill()
        with open(path, 'rb') as file:
            return status, process.output, file.read()

    def test_the_same_file_although_a_worker_is_killed_and_replaced(self):
        process, path = self.start('killed.csv', '--scheduler', self.cluster.address)
        support.wait_for(lambda: os.path.exists(path) and os.path.getsize(path) > 10000, 'rows')
        self.cluster.workers.pop(0).kill()
        self.assertIsNone(process.process.poll(), 'the runs were finished too early')
        self.cluster.workers.append(self.cluster.start_worker())
        status, output, content = self.wait(process, path)
        self.assertEqual(status, 0, output)
        self.assertEqual(content, self.content)
        self.assertEqual(len(content.splitlines()), 601)
        self.assertEqual(*(re.sub('(?m)^.*(run/s|s/run).*\n', '', text) for text in (output, self.output)))  # progress

    def copy_package(self):
        """Return a folder with another version of the package."""
        from rbx1_nav.base import units
        folder = tempfile.mkdtemp(dir=self.folder)
        shutil.copytree(os.path.dirname(os.path.dirname(units.__file__)), os.path.join(folder, 'rbx1_nav'))
        with open(os.path.join(folder, 'rbx1_nav', 'base', 'units.py'), 'a', encoding='utf-8') as file:
            file.write('# another version\n')
        return folder

    def test_a_worker_without_the_package_is_refused_before_the_first_run(self):
        worker = self.cluster.start_worker(PYTHONPATH='')
        self.addCleanup(worker.wait)
        self.addCleanup(worker.kill)
        status, output, _ = self.simulate(f'{worker.pid}.csv', '--scheduler', self.cluster.address)
        self.assertEqual(status, 1, output)
        self.assertRegex(output.splitlines()[-1],
                         r"^simulate.py: worker tcp://127.0.0.1:\d+: .*No module named 'rbx1_nav'")
        self.assertNotIn('Traceback', output)

    def test_a_worker_with_another_version_that_joins_later_ends_the_run(self):
        process, path = self.start('joined.csv', '--scheduler', self.cluster.address)
        support.wait_for(lambda: os.path.exists(path) and os.path.getsize(path) > 10000, 'rows')
        worker = self.cluster.start_worker(PYTHONPATH=self.copy_package())
        self.addCleanup(worker.wait)
        self.addCleanup(worker.kill)
        status, output, content = self.wait(process, path)
        self.assertEqual((status, self.content.startswith(content)), (1, True), output)
        self.assertRegex(output, r'(?m)^simulate.py: worker tcp://127.0.0.1:\d+: rbx1_nav [0-9a-f]+: expected .* lacks')

    def test_no_scheduler_and_an_address_that_is_none(self):
        for address, expected in (('tcp://127.0.0.1:1', 'the address of a Dask scheduler that runs'),
                                  ('nonsense://', 'tcp://HOST:PORT or tls://HOST:PORT')):
            status, output, _ = self.simulate('none.csv', '--scheduler', address)
            self.assertEqual(status, 1, output)
            self.assertIn(f'--scheduler: {address}: expected {expected}', output.splitlines()[-1])


if __name__ == '__main__':
    support.main(TestTwoWorkers)
