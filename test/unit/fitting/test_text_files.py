"""The text files of the UTIAS dataset."""
import numpy
import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.fitting.mrclam import is_commands_file, read_robot, read_set, truth_file

COMMANDS = '# time v w\n0.0 0.1 0.0\n1.0 0.1 0.5\n2.0 0.0 0.0\n'
TRUTH = '0.0 1.0 2.0 3.0\n1.0 1.1 2.0 3.1\n2.0 1.2 2.0 -3.1\n'


@pytest.fixture(name='write')
def write_files(tmp_path):
    def write(commands=COMMANDS, truth=TRUTH):
        paths = [str(tmp_path / ('D1R1_%s.dat' % name)) for name in ('Odometry', 'Groundtruth')]
        for path, text in zip(paths, (commands, truth)):
            with open(path, 'w', encoding='utf-8') as file:
                file.write(text)
        return paths
    return write


def test_commands_and_truth(write, tmp_path):
    paths = write()
    assert is_commands_file(paths[0]) and truth_file(paths[0]) == paths[1] and not is_commands_file('run.bag')
    run, = read_set(str(tmp_path), 1)
    assert run == run._replace(name='D1R1', odometry=None, gyro=None, end=None)
    assert run.commands.angular.tolist() == [0.0, 0.5, 0.0] and run.truth.x.tolist() == [1.0, 1.1, 1.2]
    # not wrapped
    assert run.truth.yaw[2] == pytest.approx(2 * numpy.pi - 3.1)


@pytest.mark.parametrize('commands, truth, text', [
    ('', TRUTH, 'D1R1_Odometry.dat: 0 columns: expected 3'),
    (COMMANDS, '0 1 2\n', 'D1R1_Groundtruth.dat: 3 columns: expected 4'),
    ('0 a 0\n', TRUTH, 'D1R1_Odometry.dat: expected a text file of numbers'),
    (COMMANDS.replace('0.5', 'nan'), TRUTH, 'D1R1: commands: angular of message 2: nan: expected a finite number'),
    ('0 0 0\n1 0 0\n', TRUTH, 'D1R1: no motion: expected commands other than 0'),
    (COMMANDS, TRUTH.replace('2.0 1.2', '0.5 1.2'), 'D1R1: truth: stamp of message 3: 0.500 s before'),
    (COMMANDS, TRUTH.replace('0.0 1.0', '9.0 1.0', 1).replace('1.0 1.1', '10.0 1.1').replace('2.0 1.2', '11.0 1.2'),
     'D1R1: truth from 9.0 to 11.0 s, but commands from 0.0 to 2.0 s')])
def test_one_line_for_a_mistake(write, commands, truth, text):
    with pytest.raises(ConfigError) as error:
        read_robot(*write(commands, truth))
    assert text in str(error.value) and '\n' not in str(error.value)


def test_a_file_that_is_missing(write, tmp_path):
    commands, truth = write()
    with pytest.raises(ConfigError, match='D2R'):
        read_set(str(tmp_path), 2)
    with pytest.raises(ConfigError, match='nothing.dat'):
        read_robot(commands, truth.replace('D1R1_Groundtruth', 'nothing'))
