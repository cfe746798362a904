"""A virtual display."""
import contextlib
import os
import random
import subprocess


@contextlib.contextmanager
def virtual_display():
    """A context with a running X server. The value is its DISPLAY."""
    ours, its = os.pipe()
    # The number is also the name of a file in /tmp: servers in different network namespaces would all choose 0, and one
    # that starts at the same time as another fails. displayfd: it reports the number when it is ready.
    # noreset: it keeps running after its last client quits
    server = subprocess.Popen(
        ['Xvfb', f':{random.randrange(100, 50000)}', '-displayfd', str(its), '-screen', '0', '1280x800x24',
         '+extension', 'GLX', '-nolisten', 'tcp', '-noreset'],
        pass_fds=[its], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(its)
    try:
        with open(ours) as answer:
            number = answer.readline().strip()
        if not number:
            raise RuntimeError('Xvfb does not start')
        yield f':{number}'
    finally:
        server.terminate()
        server.wait()
