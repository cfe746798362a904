"""A node that is started with closed streams can still open files and print."""
import os
import subprocess
import sys

SOURCE = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'src')


def test_closed_streams():
    code = 'import rbx1_nav.node.early_interrupt, sys; print(sys.stdin.read()); assert open(0).fileno() == 0'
    environment = dict(os.environ, PYTHONPATH=SOURCE)
    assert subprocess.run(['sh', '-c', f'"{sys.executable}" -c "{code}" <&- >&- 2>&-'], env=environment).returncode == 0
