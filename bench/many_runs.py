#!/usr/bin/env python3
"""Compare many runs on a Dask cluster, one of whose workers is killed, with local processes. See README.md."""
import argparse
import filecmp
import os
import subprocess
import sys
import tempfile
import time

FOLDER = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(FOLDER, '..', 'test'))

from cluster import Cluster
from processes import memory, tree

SIMULATE = os.path.join(FOLDER, '..', 'nodes', 'simulate.py')
SAMPLE = 1.0    # s between two looks at the memory


def resident(pid):
    """The resident memory of a process, MB; 0 if it does not run."""
    try:
        return memory(pid, 'status', 'VmRSS') / 1e6
    except OSError:
        return 0.0


def simulate(path, runs, place, pids, at_half=None):
    """Run simulate.py. Returns (s of wall time, {name: memory samples}). place: its options; pids(pid of simulate.py):
    {name: pid} of the processes that are watched; at_half(): called when half of the rows have been written."""
    samples = {}
    start = time.monotonic()
    with subprocess.Popen([sys.executable, SIMULATE, '--surface', 'low_ply_carpet', '--method', 'timed', '--runs',
                           str(runs), '--output', path, *place]) as process:
        while process.poll() is None:
            time.sleep(SAMPLE)
            for name, pid in pids(process.pid).items():
                samples.setdefault(name, []).append(resident(pid))
            if at_half and os.path.exists(path) and os.path.getsize(path) > runs * 85:
                at_half = at_half()
    took = time.monotonic() - start
    if process.returncode:
        sys.exit(process.returncode)
    return took, samples


def local_pids(client):
    """The processes of simulate.py by name."""
    return {'client': client, **{f'process {pid}': pid for pid in sorted(tree([client]) - {client})}}


def show(title, took, samples):
    """Print the time, and for each process its largest memory and the growth in the last half of its samples."""
    print(f'{title}: {took:.1f} s')
    for name, values in samples.items():
        half = [value for value in values[len(values) // 2:] if value]
        if half:
            print(f'    {name}: at most {max(values):.1f} MB; in the last half {min(half):.1f} to {max(half):.1f} MB '
                  f'(+{100 * (max(half) / min(half) - 1):.1f} %)')
    sys.stdout.flush()


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--runs', type=int, default=100000, help='default: 100000')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        local, clustered = (os.path.join(folder, name) for name in ('local.csv', 'cluster.csv'))
        first, samples = simulate(local, arguments.runs, ['--jobs', '2'], local_pids)
        show('two local processes', first, samples)
        cluster = Cluster(folder, DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED='False')

        def pids(client):
            return {'client': client, 'scheduler': cluster.scheduler.pid,
                    **{f'worker {worker.pid}': worker.pid for worker in cluster.workers}}

        def replace_a_worker():
            cluster.workers.pop(0).kill()
            cluster.workers.append(cluster.start_worker())
        try:
            second, samples = simulate(clustered, arguments.runs, ['--scheduler', cluster.address], pids,
                                       replace_a_worker)
            show('scheduler and two workers, one of them killed and replaced', second, samples)
        finally:
            cluster.stop()
        print(f"{first / second:.3f} times the speed of local processes; the files are "
              f"{'equal' if filecmp.cmp(local, clustered, shallow=False) else 'DIFFERENT'}")


if __name__ == '__main__':
    main()
