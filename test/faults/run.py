#!/usr/bin/env python3
"""Runs the fault suite: the rows below rows/, each in a process and with a ROS master of its own.

A row that fails is repeated once, with the same seed, before it counts as failed. If it passes then, it is flaky: three
flaky rows fail the suite.
"""
import argparse
import importlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

FOLDER = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(FOLDER)
sys.path[:0] = [FOLDER, TESTS, os.path.join(TESTS, 'base'), os.path.join(TESTS, 'create')]

import processes
from ports import free_port
import results_table
from results_table import spread

FLAKY = 3           # flaky rows that fail the suite
LIMIT = 20 * 60     # s of wall time for a row: longer means that it hangs

ending = threading.Event()
running = {}        # the processes of the rows that run now, by their ROS_HOME


def read_arguments(names):
    """The command line."""
    parser = argparse.ArgumentParser(prog='script/test --faults', description=__doc__.split('\n')[0])
    parser.add_argument('rows', nargs='*', metavar='ROW', help=f"one of {', '.join(names)}; default: all")
    parser.add_argument('--short', action='store_true', help='fewer faults of each kind')
    parser.add_argument('--seed', type=int, default=random.randrange(10 ** 6), metavar='S',
                        help='repeats the same random faults; default: a new one')
    parser.add_argument('--times', type=int, metavar='N', help='how many faults of each row, whatever the row says')
    parser.add_argument('--table', action='store_true', help='update these rows of test/faults/results.md')
    arguments = parser.parse_args()
    for name in arguments.rows:
        if name not in names:
            parser.error(f"{name}: expected one of {', '.join(names)}")
    return arguments


def can_make_namespaces():
    """Whether ip(8) can make and use a network namespace here: some containers do not let root do it."""
    name = f'rbx1-{os.getpid()}'
    # a list, so that it is deleted in any case
    return all([subprocess.run(['ip', *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               check=False).returncode == 0
                for command in (('netns', 'add', name), ('netns', 'exec', name, 'true'), ('netns', 'delete', name))])


def run_row(name, module, times, seed):
    """Run a row in a process of its own. Returns its result as a dictionary, see Row.result()."""
    if module.ROOT and not can_make_namespaces():
        return dict(name=name, faults=times, skipped='needs root, and network namespaces', failures=[], figures={},
                    seconds=0)
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix='rbx1_nav-faults.') as folder:
        environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:%d' % free_port(), ROS_IP='127.0.0.1',
                           ROS_HOME=folder, ROS_LOG_DIR=os.path.join(folder, 'log'))
        environment.pop('ROS_NAMESPACE', None)
        process = running[folder] = subprocess.Popen(
            [sys.executable, os.path.join(FOLDER, 'row.py'), name, str(times), str(seed)],
            stdout=subprocess.PIPE, text=True, env=environment, start_new_session=True, cwd=folder)
        try:
            output, _ = process.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            output = ''
        finally:
            end_row(process, folder)
            del running[folder]
    try:
        result = json.loads(output.splitlines()[-1])
    except (IndexError, ValueError):
        result = dict(name=name, faults=0, skipped='', failures=['the row itself ended without a result'], figures={})
    return dict(result, seconds=round(time.monotonic() - start))


def end_row(process, folder):
    """End a row, and what it has left behind: roslaunch starts its nodes in sessions of their own, but all have the
    same ROS_HOME."""
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            pass
    for pid in processes.with_variable('ROS_HOME', folder):
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.wait()


def on_signal(number, _):
    """End all rows, and the suite."""
    ending.set()        # no worker is to start another row
    for folder, process in list(running.items()):
        end_row(process, folder)
        shutil.rmtree(folder, ignore_errors=True)
    os._exit(128 + number)


class Suite:
    """Runs rows side by side, and prints what came out."""

    def __init__(self, modules, arguments):
        self.modules = modules
        self.arguments = arguments
        self.results = {}
        self.lock = threading.Lock()

    def times(self, module):
        """How many faults a row is to try."""
        return self.arguments.times or (module.SHORT if self.arguments.short else module.FULL)

    def run(self):
        """Run all rows: two side by side, then those that measure durations, one at a time. Returns the results."""
        names = [name for name in self.modules if self.times(self.modules[name])]
        self.work([name for name in names if not self.modules[name].ALONE], 2)
        self.work([name for name in names if self.modules[name].ALONE], 1)
        return [self.results[name] for name in names]

    def work(self, names, jobs):
        """Run rows, so many at a time."""
        waiting = list(names)

        def worker():
            while True:
                with self.lock:
                    if not waiting or ending.is_set():
                        return
                    name = waiting.pop(0)
                self.run_twice(name)
        threads = [threading.Thread(target=worker) for _ in range(jobs)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    def run_twice(self, name):
        """Run a row; once more if it fails."""
        module = self.modules[name]
        result = run_row(name, module, self.times(module), self.arguments.seed)
        repeated = len(result['failures'])
        if ending.is_set():
            return
        if repeated:
            self.show(result, 'failed, and is repeated')
            result = run_row(name, module, self.times(module), self.arguments.seed)
        result['repeated'] = repeated
        self.results[name] = result
        self.show(result, f"skipped: {result['skipped']}" if result['skipped'] else
                  'FAILED' if result['failures'] else 'passed')

    def show(self, result, word):
        """Print the outcome of a row."""
        with self.lock:
            print('%-18s %5d faults in %4d s: %s' % (result['name'], result['faults'], result['seconds'], word))
            for text in result['failures'][:5]:
                print('    %s' % text.replace('\n', '\n    '))
            if len(result['failures']) > 5:
                print('    and %d more' % (len(result['failures']) - 5))
            for figure, values in sorted(result['figures'].items()):
                print(f'    {figure}: {spread(values)}')
            sys.stdout.flush()


def main():
    """Run the rows. Returns the exit status."""
    names = sorted(name[:-len('.py')] for name in os.listdir(os.path.join(FOLDER, 'rows')) if name.endswith('.py'))
    arguments = read_arguments(names)
    modules = {name: importlib.import_module(f'rows.{name}') for name in arguments.rows or names}
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, on_signal)
    print('Seed %d: `script/test --faults --seed %d%s ROW` repeats a row' % (
        arguments.seed, arguments.seed, ' --short' if arguments.short else ''), flush=True)
    start = time.monotonic()
    results = Suite(modules, arguments).run()
    if arguments.table:
        results_table.update(results_table.PATH, modules, results, arguments.seed)
    failed = [result['name'] for result in results if result['failures']]
    skipped = [result['name'] for result in results if result['skipped']]
    flaky = [result['name'] for result in results if result['repeated'] and not result['failures']]
    if flaky:
        print(f"{len(flaky)} flaky: {', '.join(flaky)}. Each needs a line in test/flaky.md.")
    print(f'Time: {time.monotonic() - start:.0f} s')
    print('%d faults in %d rows: %d passed, %d failed%s, %d skipped%s' % (
        sum(result['faults'] for result in results if not result['skipped']), len(results),
        len(results) - len(failed) - len(skipped), len(failed), ' (%s)' % ', '.join(failed) if failed else '',
        len(skipped), ' (%s)' % ', '.join(skipped) if skipped else ''))
    return 1 if failed or len(flaky) >= FLAKY or not results else 0


if __name__ == '__main__':
    sys.exit(main())
