"""Imports the package from its source folder, so that these tests need no build."""
import os
import signal
import sys

from hypothesis import HealthCheck, settings
import pytest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'src'))
os.environ['ROS_PACKAGE_PATH'] = ROOT   # rospkg finds the surfaces in this clone, also where no workspace is sourced
# the modules that read and follow the Markdown pages
sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..'))

# no test here checks timing, and a busy machine is slow
settings.register_profile('any_machine', deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('any_machine')

LIMIT = 600     # s after which a test counts as hung, even on a busy machine


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_call(item):
    """Fail a test that hangs."""
    def fail(*_):
        pytest.fail(f'{item.name} hangs: not finished after {LIMIT} s')
    signal.signal(signal.SIGALRM, fail)
    signal.alarm(LIMIT)
    yield
    signal.alarm(0)
