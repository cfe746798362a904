"""Waits for what another thread or process does; conftest.py ends a test that hangs."""
import time


def wait_for(condition):
    """Wait until condition() is true, and return its result."""
    while not (value := condition()):
        time.sleep(0.002)
    return value
