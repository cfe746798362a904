"""Whether a picture can be written is known before it is drawn."""
import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.plots import check_picture


@pytest.mark.parametrize('name', ['a.png', 'a.PNG', 'a.svg', 'a.pdf', 'a.b.jpg'])
def test_a_good_path_is_left_as_it_was(tmp_path, name):
    check_picture(str(tmp_path / name))
    assert list(tmp_path.iterdir()) == []
    (tmp_path / name).write_bytes(b'an older picture')
    check_picture(str(tmp_path / name))
    assert (tmp_path / name).read_bytes() == b'an older picture'


@pytest.mark.parametrize('name', ['', 'a', 'png', '.png', 'a.doc', 'a.png.txt', 'a.pgf'])
def test_a_name_that_says_no_format(tmp_path, name):
    with pytest.raises(ConfigError, match=r'expected a name that ends in one of .*\.pdf, \.png, '):
        check_picture(str(tmp_path) + '/' + name)


def test_a_folder_that_does_not_exist(tmp_path):
    with pytest.raises(ConfigError, match='expected a folder that exists'):
        check_picture(str(tmp_path / 'nowhere' / 'a.png'))


def test_a_folder_in_place_of_a_file(tmp_path):
    (tmp_path / 'a.png').mkdir()
    with pytest.raises(ConfigError, match='expected a file that can be written: Is a directory'):
        check_picture(str(tmp_path / 'a.png'))


def test_a_folder_in_which_nobody_can_write():
    # where not even root can, whom permissions do not stop
    with pytest.raises(ConfigError, match='expected a file that can be written: '):
        check_picture('/proc/a.png')
