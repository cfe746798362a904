"""The files that a page shows are those in examples/."""
import os

import pytest
from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
EXAMPLE = os.path.join(ROOT, 'examples', 'my_robot')
LANGUAGES = ('xml', 'python', 'yaml', 'cmake')


def shown():
    """(line number, text) of the blocks of code in the page."""
    return [(number, '\n'.join(lines) + '\n') for number, language, lines
            in markdown.split(markdown.read(ROOT, 'docs/test_bench.md')) if language in LANGUAGES]


def texts():
    """The texts of all files of the example."""
    names = ('.py', '.test', '.yaml', '.xml', '.txt')
    return ['\n' + markdown.read(EXAMPLE, path) for path in markdown.files(EXAMPLE, names)]


def test_blocks_are_found():
    assert len(shown()) >= len(LANGUAGES)


@pytest.mark.parametrize('number, block', [pytest.param(*each, id='line%d' % each[0]) for each in shown()])
def test_a_block_is_a_part_of_a_file(number, block):
    assert any('\n' + block in text for text in texts()), 'docs/test_bench.md:%d differs from each file' % number
