"""Files of the UTIAS dataset are read, and bad files are rejected with a one-line message."""
import numpy
import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.fitting.recording import read_set

COMMANDS = '# time v w\n10.0\t0.1\t0.0\n10.5 0.1 0.5\n11 0.0 0.0\n'
TRUTH = '10.0 1.0 2.0 3.1\n10.5 1.1 2.0 -3.1\n11.0 1.2 2.0 -3.0\n'


def write(folder, commands=COMMANDS, truth=TRUTH, robot=1, number=6):
    for what, text in (('Odometry', commands), ('Groundtruth', truth)):
        if text is not None:
            path = folder / ('D%dR%d_%s.dat' % (number, robot, what))
            path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(folder)


def test_the_robots_of_a_set_are_read(tmp_path):
    write(tmp_path, robot=1)
    write(tmp_path, robot=2)
    write(tmp_path, number=7)
    recordings = read_set(str(tmp_path), 6)
    assert [recording.name for recording in recordings] == ['D6R1', 'D6R2']
    assert recordings[0].commands.angular.tolist() == [0.0, 0.5, 0.0]
    assert recordings[0].truth.x.tolist() == [1.0, 1.1, 1.2]
    # the heading is unwrapped
    assert recordings[0].truth.yaw == pytest.approx(numpy.array([3.1, 2 * numpy.pi - 3.1, 2 * numpy.pi - 3.0]))
    assert recordings[0].odometry is None


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
    write(tmp_path, commands, truth)
    with pytest.raises(ConfigError, match=text) as error:
        read_set(str(tmp_path), 6)
    assert str(error.value).isprintable()


@pytest.mark.parametrize('name', ['', 'none', 'a[b', 'two\nlines'])
def test_a_folder_without_files_of_the_set_is_rejected(tmp_path, name):
    write(tmp_path, number=7)
    text = r'no files D6R\*_Odometry.dat: expected the folder of an unpacked set'
    with pytest.raises(ConfigError, match=text) as error:
        read_set(str(tmp_path / name), 6)
    assert str(error.value).isprintable()
