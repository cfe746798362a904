"""bench/figures.md is what bench/evidence.py writes from bench/figures.yaml."""
import datetime
import os
import re
import subprocess
import sys

import pytest
from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'bench'))

import evidence  # noqa: E402

SECTIONS = evidence.load()


def test_the_page_is_up_to_date():
    """The marks depend on the history of git, so they are not compared."""
    written = evidence.without_marks(markdown.read(ROOT, 'bench/figures.md'))
    assert written == evidence.page(SECTIONS, lambda commit, files: False)


@pytest.mark.parametrize('section', SECTIONS, ids=lambda section: section['title'])
def test_each_figure_is_complete(section):
    for path in section['files']:
        assert os.path.exists(os.path.join(ROOT, path)), path
    for figure in section['figures']:
        assert len(figure['values']) == len(section['columns']), figure['what']
        assert isinstance(figure['date'], datetime.date), figure['what']
        assert re.fullmatch('≤?[0-9a-f]{8}', str(figure['commit'])), figure['what']


def test_a_figure_is_stale_if_one_of_its_files_has_changed(tmp_path, monkeypatch):
    def git(*arguments):
        return subprocess.run(['git', '-c', 'user.name=x', '-c', 'user.email=x', *arguments], cwd=tmp_path, check=True,
                              stdout=subprocess.PIPE, universal_newlines=True).stdout.strip()

    git('init', '-q')
    commits = []
    for name in 'first', 'second':
        (tmp_path / name).write_text('')
        git('add', name)
        git('commit', '-q', '-m', name)
        commits.append(git('rev-parse', '--short=8', 'HEAD'))
    monkeypatch.setattr(evidence, 'ROOT', str(tmp_path))
    figures = [{'what': 'a', 'values': [1], 'date': '', 'commit': '≤' + commits[0]},
               {'what': 'b', 'values': [2], 'date': '', 'commit': commits[1]},
               {'what': 'c', 'values': [3], 'date': '', 'commit': '0' * 8}]
    section = {'title': 'T', 'columns': ['value'], 'how': 'x', 'files': ['second'], 'figures': figures}
    text = evidence.page([section], evidence.changed)
    assert [line.count(evidence.STALE) for line in text.splitlines() if line.startswith('| ')] == [0, 1, 0, 0]
    assert evidence.without_marks(text) == evidence.page([section], lambda commit, files: False)
