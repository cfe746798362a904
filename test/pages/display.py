"""A virtual display."""
import contextlib
import os
import random
import subprocess


@contextlib.contextmanager
def virtual_display():
    """A context with a running X server. The value is its DISPLAY."""
    ours, its = os.pipe()
    # Servers in different network namespaces would all choose number 0. It is also the name of a file in /tmp, so that
    # one that starts beside another would fail.
    number = random.randrange(100, 50000)
    # displayfd: the server reports the number when it is ready. noreset: it keeps running after its last client quits
    server = subprocess.Popen(
        ['Xvfb', f':{number}', '-displayfd', str(its), '-screen', '0', '1280x800x24', '+extension', 'GLX', '-nolisten',
         'tcp', '-noreset'], pass_fds=[its], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL)
    os.close(its)
    try:
        with open(ours) as answer:
            if not answer.readline():
                raise RuntimeError('Xvfb does not start')
        yield f':{number}'
    finally:
        server.terminate()
        server.wait()
