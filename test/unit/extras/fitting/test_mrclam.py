"""Files of the UTIAS dataset are read, and bad files are rejected with a one-line message."""
import numpy
import pytest

from rbx1_nav.extras.fitting.recording import read_robot, truth_file
from rbx1_nav.node.config import ConfigError

COMMANDS = '# time v w\n10.0\t0.1\t0.0\n10.5 0.1 0.5\n11 0.0 0.0\n'
TRUTH = '10.0 1.0 2.0 3.1\n10.5 1.1 2.0 -3.1\n11.0 1.2 2.0 -3.0\n'


def read(folder, commands=COMMANDS, truth=TRUTH):
    """Write the two files of a robot, and read them."""
    for what, text in (('Odometry', commands), ('Groundtruth', truth)):
        if text is not None:
            (folder / f'D6R1_{what}.dat').write_bytes(text if isinstance(text, bytes) else text.encode())
    path = str(folder / 'D6R1_Odometry.dat')
    return read_robot(path, truth_file(path))


def test_a_robot_is_read(tmp_path):
    recording = read(tmp_path)
    assert recording.name == 'D6R1' and recording.odometry is None
    assert recording.commands.angular.tolist() == [0.0, 0.5, 0.0]
    assert recording.truth.x.tolist() == [1.0, 1.1, 1.2]
    # the heading is unwrapped
    assert recording.truth.yaw == pytest.approx(numpy.array([3.1, 2 * numpy.pi - 3.1, 2 * numpy.pi - 3.0]))


@pytest.mark.parametrize('commands, truth, text', [
    (COMMANDS, None, 'Groundtruth.dat: expected a text file of numbers: .*[Nn]o such file|not found'),
    ('', TRUTH, 'Odometry.dat: 0 columns: expected 3'),
    (TRUTH, TRUTH, 'Odometry.dat: 4 columns: expected 3'),
    ('time v w\n1 2 3\n', TRUTH, 'Odometry.dat: expected a text file of numbers'),
    (b'\xff\xfe\x00 1 2\n', TRUTH, 'Odometry.dat: expected a text file of numbers'),
    ('1 nan 0\n', TRUTH, 'D6R1: commands: linear of message 1: nan: expected a finite number'),
    (COMMANDS, f"{TRUTH}12 0 0 inf\n", 'D6R1: truth: yaw of message 4: inf: expected a finite number'),
    (f"{COMMANDS}10.5 0 0\n", TRUTH, 'D6R1: commands: stamp of message 4: 0.500 s before message 3'),
    ('10 0 0\n11 0 0\n', TRUTH, 'D6R1: no motion: expected commands other than 0'),
])
@pytest.mark.filterwarnings('error')
def test_a_bad_file_is_rejected_with_one_line(tmp_path, commands, truth, text):
    with pytest.raises(ConfigError, match=text) as error:
        read(tmp_path, commands, truth)
    assert str(error.value).isprintable()
