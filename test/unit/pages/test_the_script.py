"""docs/the_script.md shows the scripts as they are."""
import ast
import os

from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))


def code_of(script):
    """The lines of a node below its usage text, without the empty ones."""
    text = markdown.read(ROOT, os.path.join('nodes', script))
    usage = ast.parse(text).body[0]
    return [line for line in text.splitlines()[usage.end_lineno:] if line]


def shown():
    """The python blocks of the page, each a list of lines without the empty ones."""
    page = markdown.read(ROOT, 'docs/the_script.md')
    return [[line for line in lines if line] for _, language, lines in markdown.split(page) if language == 'python']


def test_the_whole_timed_script_is_shown_in_its_order():
    script, blocks = code_of('timed_out_and_back.py'), shown()
    assert [line for block in blocks for line in block][:len(script)] == script, 'docs/the_script.md: expected it'


def test_what_is_shown_of_the_other_script_is_in_it():
    script = code_of('odom_out_and_back.py')
    timed = len(code_of('timed_out_and_back.py'))
    others, count = [], 0
    for block in shown():
        if count >= timed:
            others.append(block)
        count += len(block)
    assert others
    for block in others:
        assert any(script[start:start + len(block)] == block for start in range(len(script))), block
