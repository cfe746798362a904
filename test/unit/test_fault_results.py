"""The table of results of the fault suite."""
import os
import sys

import pytest

FAULTS = os.path.join(os.path.dirname(__file__), '..', 'faults')
sys.path.insert(0, FAULTS)
import results_table        # noqa: E402    found by the line above


class Module:
    FAULT, PROMISE = 'what is done', 'what holds'


def result(**changed):
    return {**dict(name='sigkill', faults=60, skipped='', failures=[], repeated=0, figures={'gap (s)': [1, 3, 2]}),
            **changed}


@pytest.mark.parametrize('changed, text', [
    ({}, 'all held; gap (s): 1 to 3, median 2'),
    ({'repeated': 4}, 'failed once: 4 of 60; passed when repeated; gap (s): 1 to 3, median 2'),
    ({'repeated': 4, 'failures': ['a', 'b'], 'figures': {}}, 'failed: 2 of 60, also when repeated')])
def test_outcome(changed, text):
    assert results_table.outcome(result(**changed)) == text


def test_only_the_rows_that_were_run_change(tmp_path):
    path = tmp_path / 'results.md'
    modules = {name: Module for name in ('sigkill', 'soak', 'load')}
    results_table.update(path, modules, [result(name='soak', repeated=1), result()], 7)
    before = path.read_text().splitlines()
    results_table.update(path, modules, [result(name='soak'), result(name='sigkill', skipped='needs root'),
                                         result(name='load')], 8)
    after = path.read_text().splitlines()
    assert before[-2] in after and before[-2].startswith('| `sigkill` | what is done | what holds | 60 | all held')
    assert [line.split('`')[1] for line in after[-3:]] == ['load', 'sigkill', 'soak']
    assert 'failed once' in before[-1] and 'failed once' not in after[-1] and '| 8 | ' in after[-1]


def test_each_row_has_results():
    rows = {name[:-len('.py')] for name in os.listdir(os.path.join(FAULTS, 'rows')) if name.endswith('.py')}
    with open(results_table.PATH, encoding='utf-8') as file:
        lines = file.read().splitlines()
    assert {line.split('`')[1] for line in lines if line.startswith('| `')} == rows
