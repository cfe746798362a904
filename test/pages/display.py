"""A virtual display."""
import contextlib
import os
import random
import shutil
import struct
import subprocess
import tempfile

from PIL import Image


def folder_of(display):
    """The folder of the file with the screen of a virtual display."""
    return os.path.join(tempfile.gettempdir(), f'rbx1_nav-display{display[1:]}')


def screenshot(display):
    """Return the screen of a virtual display as an Image; ImageGrab can do it only from Pillow 7.1 on."""
    with open(os.path.join(folder_of(display), 'Xvfb_screen0'), 'rb') as file:
        data = file.read()
    # xwd(1), XWDFile.h: the size of the header, ..., width, height, ..., bytes per line, ..., number of colors
    header = struct.unpack('>25I', data[:100])
    pixels = data[header[0] + 12 * header[19]:]
    return Image.frombuffer('RGB', header[4:6], pixels, 'raw', 'BGRX', header[12], 1)


@contextlib.contextmanager
def virtual_display():
    """A context with a running X server. The value is its DISPLAY."""
    ours, its = os.pipe()
    # Servers in different network namespaces would all choose number 0. It is also the name of a file in /tmp, so that
    # one that starts beside another would fail.
    number = random.randrange(100, 50000)
    folder = folder_of(f':{number}')
    os.mkdir(folder)
    # displayfd: the server reports the number when it is ready. noreset: it keeps running after its last client quits
    server = subprocess.Popen(
        ['Xvfb', f':{number}', '-displayfd', str(its), '-screen', '0', '1280x800x24', '+extension', 'GLX', '-nolisten',
         'tcp', '-noreset', '-fbdir', folder], pass_fds=[its], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
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
        shutil.rmtree(folder)
