#!/usr/bin/env python3
"""Runs rostests and unit tests, several at a time, and prints the results.

The last line has two numbers: how many tests have passed, and how many have failed.

usage: run_tests.py --results DIR [--jobs N] [--repeat] TESTS...

--repeat: rostests that fail are repeated once, one at a time. Those that pass then are flaky; three fail the run.

TESTS: a rostest, such as test/base/feedback.test, or unit tests for one process, such as test/unit/base,test/unit/node

Each rostest runs in a copy of this process: in a new process, the imports of rostest would take longer than most tests.
"""
import argparse
import multiprocessing
from multiprocessing.connection import wait
import os
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

import roslaunch.parent         # noqa: F401
import rostest.rostest_main
import rostest.runner           # noqa: F401

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
sys.path.insert(0, os.path.join(ROOT, 'test'))

from ports import own_loopback
from results import SETS, failed_tests, failures_of_sets, summarize

PACKAGE = 'rbx1_nav'
LIMIT = 3600        # s after which a job counts as hung, even on a busy machine
LOOK = 60       # s between two checks for jobs that hang
LINES = 40      # of the output of a job that has failed
LISTED = 10     # jobs in the list of the slowest ones
FLAKY = 3       # flaky rostests that fail the run
# the longest first, so that none of them is still running when the others have finished
LONGEST = ['documents', 'in_step', 'calibration_without_gyro', *SETS, 'unit-1', 'unit-2', 'unit-3', 'unit-4',
           'browser_page']
# use more than a core each, and fail if they get less: one at a time, when the others have finished
ALONE = ['fleet_models', 'five_robots', 'browser_comparison', 'feedback_roscpp']


def run_rostest(results, name, path):
    """Run a rostest. name: of its result. Exits with its status."""
    sys.argv = ['rostest', f'--pkgdir={ROOT}', f'--package={PACKAGE}', f'--results-filename={name}.xml',
                f'--results-base-dir={results}', path]
    rostest.rostest_main.rostestmain()


def run_unit_tests(results, name, paths):
    """Run unit tests. Exits with their status."""
    sys.exit(subprocess.call([sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', *paths,
                              f'--junit-xml={results}/{PACKAGE}/pytest-{name}.xml']))


class Job:
    """A process that runs tests. Its output goes to a file."""

    def __init__(self, name, log, target, *arguments):
        """log: path for the output; target(*arguments): runs the tests."""
        self.name = name
        self.log = log
        self.task = target, *arguments
        self.used = multiprocessing.Value('d', 0.0)     # CPU time of the process and its children, s
        self.process = multiprocessing.get_context('fork').Process(target=self.run, args=(target, *arguments))

    def run(self, target, *arguments):
        """Run the tests in the new process."""
        output = os.open(self.log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(output, 1)
        os.dup2(output, 2)
        own_loopback()
        try:
            target(*arguments)
        finally:
            self.used.value = sum(os.times()[:4])

    def start(self):
        """Start the process."""
        self.start_time = time.monotonic()
        self.process.start()

    def join(self):
        """Wait for the end of the process."""
        self.process.join()
        self.duration = time.monotonic() - self.start_time

    def hangs(self):
        """Whether the process has been running for too long; if so, it is stopped."""
        if time.monotonic() < self.start_time + LIMIT:
            return False
        self.process.terminate()
        self.process.join(10)
        self.process.kill()
        return True

    def output(self):
        """Return the lines of the output."""
        if not os.path.exists(self.log):    # the process was killed at its start
            return []
        with open(self.log, encoding='utf-8', errors='replace') as file:
            return file.read().splitlines()

    def trouble(self):
        """Return the end of the output if the process has failed, or ''."""
        lines = self.output()
        # if a required node exits, roslaunch interrupts the test; rostest then counts no tests, and succeeds
        if self.process.exitcode == 0 and ' * TESTS: 0' not in lines:
            return ''
        reasons = [line for line in lines[:-LINES] if '[FATAL]' in line]
        return '\n'.join([f'{self.name}: status {self.process.exitcode}', *reasons, *lines[-LINES:]])


def read_setup(path):
    """Return the set-up of a rostest, as text, and its test, an XML element. Raises ParseError."""
    root = ElementTree.parse(path).getroot()
    test = root.find('test')
    root.remove(test)
    return ElementTree.tostring(root, encoding='unicode'), test


def share_setups(results, paths):
    """Return the paths of rostests, with a single rostest in place of the members of each set."""
    left = {os.path.splitext(os.path.basename(path))[0]: path for path in paths}
    for name, members in SETS.items():
        setups = {}
        for member in left.keys() & set(members):
            try:
                setups[member] = read_setup(left[member])
            except ElementTree.ParseError:      # rostest reports it
                pass
        if len(setups) < 2:
            continue
        scripts = []
        for member in [member for member in members if member in setups]:
            path, (setup, test) = left.pop(member), setups[member]
            script = os.path.join(os.path.dirname(path), test.get('type'))
            scripts.append(','.join([test.get('test-name'), script, *test.get('args', '').split()]))
        left[name] = os.path.join(results, f'{name}.test')
        root = ElementTree.fromstring(setup)
        root.append(ElementTree.Element('test', {'test-name': name, 'pkg': PACKAGE, 'type': 'together.py',
                                                 'args': ' '.join(scripts), 'time-limit': str(LIMIT)}))
        ElementTree.ElementTree(root).write(left[name])
    return list(left.values())


def make_jobs(results, tests):
    """Return the Jobs of these tests, in the order in which they should begin."""
    jobs = []
    for path in share_setups(results, [os.path.realpath(each) for each in tests if each.endswith('.test')]):
        name = os.path.splitext(os.path.basename(path))[0]
        folder = os.path.basename(os.path.dirname(path))
        # for a rostest of its own, as CMake's add_rostest names it
        result = name if name in SETS else f'test_{name}' if folder == 'test' else f'test_{folder}_{name}'
        jobs.append(Job(name, os.path.join(results, f'{name}.log'), run_rostest, results, result, path))
    for number, each in enumerate([each for each in tests if not each.endswith('.test')], 1):
        name = f'unit-{number}'
        jobs.append(Job(name, os.path.join(results, f'{name}.log'), run_unit_tests, results, name, each.split(',')))
    return sorted(jobs, key=lambda job: LONGEST.index(job.name) if job.name in LONGEST else len(LONGEST))


def run_jobs(jobs, count):
    """Run Jobs, `count` at a time. Returns the names of those that failed."""
    waiting, running, failed = list(jobs), [], []
    while waiting or running:
        while waiting and len(running) < count:
            running.append(waiting.pop(0))
            running[-1].start()
        wait([job.process.sentinel for job in running], LOOK)
        for job in list(running):
            if job.process.is_alive() and not job.hangs():
                continue
            job.join()
            running.remove(job)
            if job.trouble():
                failed.append(job.name)
                print(job.trouble())
    return failed


def repeat(results, jobs, failed):
    """Run the rostests that have failed once more, one at a time. Returns the names of those that passed.

    Their environment has the names of all tests that have failed, for a rostest that can repeat only these.
    """
    of_sets = failures_of_sets(results)
    os.environ['FAILED_TESTS'] = ' '.join(sorted(failed_tests(results)))
    again = []
    for job in jobs:
        if job.task[0] is run_rostest and job.name in [*failed, *of_sets]:
            print('\n'.join([f'{job.name} has failed, and is repeated.', *of_sets.get(job.name, [])]))
            again.append(Job(job.name, job.log, *job.task))
    bad = [*run_jobs(again, 1), *failures_of_sets(results)]
    flaky = [job for job in again if job.name not in bad]
    for job in flaky:
        print('\n'.join([f'{job.name} has passed. Its output:', *job.output()[-LINES:]]))
    return [job.name for job in flaky]


def print_slowest(jobs):
    """Print the jobs that used the most CPU time: with more jobs than cores, it decides how long all of them take."""
    slowest = sorted(jobs, key=lambda job: -job.used.value)
    total = sum(job.used.value for job in jobs)
    print(f'CPU time of {len(jobs)} jobs: {total:.0f} s; the longest, and how long they ran:')
    for job in slowest[:LISTED]:
        print(f'{job.used.value:7.1f} s {job.duration:7.1f} s  {job.name}')


def main():
    """Run the tests; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('tests', nargs='+', metavar='TESTS')
    parser.add_argument('--results', required=True, metavar='DIR')
    parser.add_argument('--jobs', type=int, default=1, metavar='N')
    parser.add_argument('--repeat', action='store_true')
    arguments = parser.parse_args()
    results = os.path.realpath(arguments.results)
    os.makedirs(os.path.join(results, PACKAGE), exist_ok=True)
    jobs = make_jobs(results, arguments.tests)
    try:
        troubled = [*run_jobs([job for job in jobs if job.name not in ALONE], arguments.jobs),
                    *run_jobs([job for job in jobs if job.name in ALONE], 1)]
        flaky = repeat(results, jobs, troubled) if arguments.repeat else []
    except KeyboardInterrupt:       # rostest would take 10 s to stop its nodes; script/test kills them
        for process in multiprocessing.active_children():
            process.kill()
        return 130
    passed, failed, names = summarize(results)
    print_slowest(jobs)
    troubled = [name for name in troubled if name not in flaky]
    if flaky:
        print(f"{len(flaky)} flaky: {', '.join(flaky)}. Each needs a line in test/flaky.md.")
    if len(flaky) >= FLAKY:
        troubled.append(f'{len(flaky)} rostests are flaky')
    for name in names + troubled:   # once more, because the output above may be long
        print('Failed:', name)
    # a job can also fail without a result
    failed = max(failed, len(troubled))
    print(passed, failed)
    return 1 if failed or not passed else 0


if __name__ == '__main__':
    sys.exit(main())
