"""script/run_tests.py reports every test that fails, crashes, hangs, or leaves no result."""
import os
import signal
import sys
import time

import pytest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'script'))
import run_tests        # noqa: E402    found by the line above

PASSED = '<testcase name="a"/>'
FAILED = '<testcase name="b"><failure>1 != 2</failure></testcase>'


@pytest.fixture(name='make_job')
def fixture_make_job(tmp_path):
    return lambda name, target: run_tests.Job(name, str(tmp_path / f'{name}.log'), target)


def test_jobs(make_job, capsys):
    targets = {'good': lambda: None, 'bad': lambda: (os.write(1, b'why\n'), sys.exit(2)),
               'crashed': lambda: os.kill(os.getpid(), signal.SIGKILL), 'late': lambda: time.sleep(0.2)}
    names = run_tests.run_jobs([make_job(*each) for each in targets.items()], 2)
    assert sorted(names) == ['bad', 'crashed']
    output = capsys.readouterr().out
    assert 'bad: status 2\nwhy\n' in output and 'crashed: status -9\n' in output


def test_a_rostest_whose_base_exits(make_job, capsys):
    output = '[FATAL] [12.3]: strict: /driver\n' + 'Traceback\n' * 50 + ' * RESULT: SUCCESS\n * TESTS: 0\n'
    assert run_tests.run_jobs([make_job('a', lambda: os.write(1, output.encode()))], 1) == ['a']
    assert 'strict: /driver' in capsys.readouterr().out
    assert run_tests.run_jobs([make_job('a', lambda: os.write(1, b' * TESTS: 10'))], 1) == []


def test_a_job_that_hangs(make_job, monkeypatch):
    monkeypatch.setattr(run_tests, 'LIMIT', 0)
    monkeypatch.setattr(run_tests, 'LOOK', 0.1)
    assert run_tests.run_jobs([make_job('hangs', lambda: time.sleep(1000))], 1) == ['hangs']


def test_a_rostest_that_passes_when_it_is_repeated_is_flaky(make_job, monkeypatch, tmp_path, capsys):
    def run(name):
        if name == 'bad' or not (tmp_path / 'before').exists():
            (tmp_path / 'before').touch()
            os.write(1, b'first output')
            sys.exit(1)
        os.write(1, b'second output')
    monkeypatch.setattr(run_tests, 'run_rostest', run)
    jobs = [run_tests.Job(name, str(tmp_path / name), run, name) for name in ('flaky', 'bad')]
    jobs.append(make_job('unit-1', lambda: sys.exit(1)))
    failed = run_tests.run_jobs(jobs, 1)
    assert failed == ['flaky', 'bad', 'unit-1']
    assert run_tests.repeat(str(tmp_path), jobs, failed) == ['flaky']
    output = capsys.readouterr().out
    assert 'first output' in output and 'flaky has passed. Its output:\nsecond output' in output


def test_results(tmp_path, capsys):
    for name, text in [('rosunit-a', PASSED + PASSED), ('rostest-test_base_a', PASSED), ('rosunit-b', PASSED + FAILED),
                       ('rostest-test_c', FAILED), ('rosunit-set_create', PASSED), ('rostest-set_create', PASSED)]:
        (tmp_path / f'{name}.xml').write_text(f'<testsuite>{text}</testsuite>')
    # killed at its time limit, or not readable: rostest's result counts
    for name, text in ('d', ''), ('e', '<testsuite>\x1b</testsuite>'), ('f', '<?xml version="1.0" encoding="-"?><a/>'):
        (tmp_path / f'rosunit-{name}.xml').write_text(text)
        (tmp_path / f'rostest-test_{name}.xml').write_text(f'<testsuite>{FAILED}</testsuite>')
    passed, failed, names = run_tests.summarize(str(tmp_path))
    assert (passed, failed, len(names)) == (3, 5, 5)
    assert capsys.readouterr().out.count('FAILED: ') == 5
