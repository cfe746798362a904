"""The files that a page shows are those in examples/."""
import os

import pytest
from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
LANGUAGES = ('xml', 'python', 'yaml', 'cmake')
# the folder of each page
EXAMPLES = {'docs/test_bench.md': 'my_robot', 'docs/answers.md': 'answers'}


def shown():
    """(page, line number, text) of the blocks of code in the pages."""
    return [(page, number, '\n'.join(lines) + '\n') for page in EXAMPLES for number, language, lines
            in markdown.split(markdown.read(ROOT, page)) if language in LANGUAGES]


def texts(folder):
    """The texts of all files of an example."""
    names = ('.py', '.test', '.yaml', '.xml', '.txt')
    folder = os.path.join(ROOT, 'examples', folder)
    return ['\n' + markdown.read(folder, path) for path in markdown.files(folder, names)]


def test_blocks_are_found():
    assert {page for page, _, _ in shown()} == set(EXAMPLES) and len(shown()) >= len(LANGUAGES)


@pytest.mark.parametrize('page, number, block', [
    pytest.param(*each, id='%s-line%d' % (os.path.basename(each[0]), each[1])) for each in shown()])
def test_a_block_is_a_part_of_a_file(page, number, block):
    assert any('\n' + block in text for text in texts(EXAMPLES[page])), f'{page}:{number} differs from each file'


def test_the_answer_is_the_exercise_filled_in():
    exercise, answer = ([line for line in markdown.read(ROOT, path).splitlines() if line]
                        for path in ('examples/square.py', 'examples/answers/square.py'))
    kept = [line for line in exercise if 'Fill this in' not in line and line.strip() != 'pass']
    assert kept == [line for line in answer if line in exercise]
