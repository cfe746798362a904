"""Where the package's own files are, in a source tree as in an install space."""
import os

import rospkg


def path(*parts):
    """The path of a file or folder of this package."""
    return os.path.join(rospkg.RosPack().get_path('rbx1_nav'), *parts)


def surfaces():
    """The folder of the known surfaces."""
    return path('config', 'surfaces')
