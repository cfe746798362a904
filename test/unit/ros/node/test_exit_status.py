"""A mistake in a driving script is logged with its position, an error that this package detects without."""
import subprocess
import sys

import pytest
import rospy
from rbx1_nav.control.legs import whole_ticks
from rbx1_nav.ros.node import life as module

SCRIPT = """\
from math import sqrt
def speed(text):
    return float(text)
with exit_status():
    %s
"""


@pytest.mark.parametrize('statement, status, logged', [
    ("speed('a')", 1, "could not convert string to float: 'a' (square.py, line 3)"),
    ('sqrt(-1)', 1, 'math domain error (square.py, line 5)'),
    ("open('/nowhere')", 1, "[Errno 2] No such file or directory: '/nowhere' (square.py, line 5)"),
    ("whole_ticks(0.0, 'rate')", 1, None),
    ("raise rospy.ROSException('no base')", 1, 'no base'),
    ('raise rospy.ROSInterruptException()', 0, None),
    ('raise SystemExit(3)', 3, None),
    ("raise SystemExit('100 % wrong')", 1, '100 % wrong'),
    ('pass', 0, None),
])
def test_what_is_logged(monkeypatch, statement, status, logged):
    lines, statuses = [], []
    monkeypatch.setattr(rospy, 'logerr', lambda text, *values: lines.append(text % values))
    monkeypatch.setattr(module, 'leave', statuses.append)
    code = compile(SCRIPT % statement, '/home/someone/square.py', 'exec')
    exec(code, {'exit_status': module.exit_status, 'whole_ticks': whole_ticks, 'rospy': rospy})
    assert statuses == [status]
    if 'whole_ticks' in statement:
        assert len(lines) == 1 and 'square.py' not in lines[0]
    elif logged and 'sqrt' in statement:    # Python 3.14 words the error differently
        assert lines[0].endswith('(square.py, line 5)')
    else:
        assert lines == ([logged] if logged else [])


def test_closed_streams():
    code = 'import rbx1_nav.ros.node.early_interrupt, sys; print(sys.stdin.read()); assert open(0).fileno() == 0'
    assert subprocess.run(['sh', '-c', f'"{sys.executable}" -c "{code}" <&- >&- 2>&-']).returncode == 0
