"""The file of many runs: complete chunks or none, and only the same command continues it."""
import errno
import json
import os
import resource
import signal

import pytest

from rbx1_nav.extras.many_runs.cases import RESULTS, chunks, combine
from rbx1_nav.extras.many_runs import runs_file
from rbx1_nav.extras.many_runs.runs_file import RunsFile
from rbx1_nav.node.config import ConfigError

COMMAND = {'runs': 250, 'lag': [0.1], 'surface': {'a': {'delay': 0.2, 'lag': 0.3}}}
VERSIONS = {'Python': '3.8.2'}
CHUNKS = list(chunks(combine({'ideal': None}, {}), ['timed', 'ekf'], range(7, 257)))[1:]     # of 2 runs each


def rows(chunk):
    """Return results for the runs of a chunk, without a filter."""
    return [tuple(None if name.startswith(('estimate', 'covariance')) else seed / 3 for name in RESULTS)
            for seed in chunk.seeds]


def write(path, number, command=None):
    """Continue a file until it has a number of chunks; return the number that it had."""
    file = RunsFile(str(path), command or COMMAND, [], VERSIONS)
    before = list(file.read(CHUNKS, None))
    assert all(found == rows(chunk) for chunk, found in before)
    for chunk in CHUNKS[len(before):number]:
        file.append(chunk, rows(chunk))
    file.file.close()
    return len(before)


def test_a_file_that_is_continued_at_any_byte_is_equal_to_one_that_was_never_interrupted(tmp_path):
    assert len(CHUNKS) == 125 and [len(chunk.seeds) for chunk in CHUNKS[:2]] == [2, 2]
    whole = tmp_path / 'whole.csv'
    assert write(whole, len(CHUNKS)) == 0
    content = whole.read_bytes()
    header = content.index(b'\n') + 1
    assert content[header:].startswith(b'ekf,ideal,7,2.3333333333333335,') and content.count(b'\n') == 251
    for size in (0, 10, header - 1, header, header + 5, header + 70, 2000, len(content) - 1, len(content)):
        part = tmp_path / f'{size}.csv'
        part.write_bytes(content[:size])
        (tmp_path / f'{size}.csv.json').write_bytes((tmp_path / 'whole.csv.json').read_bytes())
        complete = max(0, content[header:size].count(b'\n')) // 2
        assert write(part, len(CHUNKS)) == complete
        assert part.read_bytes() == content


@pytest.mark.parametrize('command, text', [
    (dict(COMMAND, runs=251), 'written with another runs: 250: expected 251, or a new file'),
    (dict(COMMAND, lag=[0.2]), r'written with another lag: \[0.1\]: expected \[0.2\]'),
    (dict(COMMAND, surface={'a': {'delay': 0.2, 'lag': 0.4}}), 'with another surface/a/lag: 0.3: expected 0.4, or'),
    ({'runs': 250, 'surface': COMMAND['surface']}, r'another lag: \[0.1\]: expected None'),
    (dict(COMMAND, delay=[0.2]), 'another delay: None')])
def test_another_command_is_refused_with_the_key_that_differs(tmp_path, command, text):
    write(tmp_path / 'a.csv', 3)
    before = (tmp_path / 'a.csv').read_bytes()
    with pytest.raises(ConfigError, match=text):
        write(tmp_path / 'a.csv', 4, command)
    assert (tmp_path / 'a.csv').read_bytes() == before


def test_a_file_of_something_else_is_not_overwritten(tmp_path):
    path = tmp_path / 'a.csv'
    path.write_text('precious\n')
    with pytest.raises(ConfigError, match='no record of its command in a.csv.json'):
        write(path, 1)
    (tmp_path / 'a.csv.json').write_text(json.dumps(COMMAND))
    with pytest.raises(ConfigError, match='other columns'):
        write(path, 1)
    assert path.read_text() == 'precious\n'


def test_rows_of_other_runs_are_refused(tmp_path):
    path = tmp_path / 'a.csv'
    write(path, 2)
    path.write_bytes(path.read_bytes().replace(b'ideal,8', b'ideal,9'))
    with pytest.raises(ConfigError, match="'ekf,ideal,9.*expected the run ekf, ideal, 8, or a new file"):
        write(path, 3)


def test_rows_that_somebody_has_appended_are_not_cut_off(tmp_path):
    path = tmp_path / 'a.csv'
    write(path, len(CHUNKS))
    with open(path, 'a', encoding='utf-8') as file:
        file.write('another row\n')
    content = path.read_bytes()
    with pytest.raises(ConfigError, match='more rows than this command writes: expected a new file'):
        write(path, len(CHUNKS))
    assert path.read_bytes() == content


@pytest.mark.parametrize('path, reason', [
    ('/dev/null', 'a regular file, or a new one'), ('', 'a file that can be written'),
    ('/none/a.csv', 'a file that can be written: No such file or directory')])
def test_a_path_that_is_no_file(path, reason):
    with pytest.raises(ConfigError, match=f'^--output: {path}: expected {reason}'):
        RunsFile(path, COMMAND, [], VERSIONS)


def test_two_programs_do_not_write_one_file_and_the_record_belongs_to_the_first(tmp_path):
    first = RunsFile(str(tmp_path / 'a.csv'), COMMAND, [], VERSIONS)
    record = (tmp_path / 'a.csv.json').read_bytes()
    with pytest.raises(ConfigError, match='another program is writing it'):
        RunsFile(str(tmp_path / 'a.csv'), {**COMMAND, 'runs': 7}, [], VERSIONS)
    assert (tmp_path / 'a.csv.json').read_bytes() == record
    first.file.close()


def test_a_full_disk_leaves_complete_chunks(tmp_path):
    path = tmp_path / 'a.csv'
    write(path, len(CHUNKS))
    content = path.read_bytes()
    path.unlink()
    limits, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, limits[1]))
    try:
        with pytest.raises(OSError) as error:
            write(path, len(CHUNKS))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert error.value.errno == errno.EFBIG
    left = path.read_bytes()
    assert 2000 < len(left) <= 3000 and content.startswith(left) and left.count(b'\n') % 2 == 1
    assert not [name for name in os.listdir(tmp_path) if name not in ('a.csv', 'a.csv.json')]


@pytest.mark.parametrize('old, new, text', [
    (b',3.0,', b',3.5,', r"row 4: true_x \(m\): '3.5': altered: expected 3.0, or a new file"),
    (b',3.3333333333333335,', b',8.3333333333333335,', "row 5: true_x .m.: '8.3333333333333335': altered: .* 3.333"),
    (b',CHECK', b',0badf00d', "row 2: check: '0badf00d': altered: expected CHECK")])
def test_an_altered_digit_is_refused_with_its_row_and_column(tmp_path, monkeypatch, old, new, text):
    path = tmp_path / 'a.csv'
    write(path, 3)
    content = path.read_bytes()
    check = content.split(b'\n')[1].rpartition(b',')[2]        # of the first run
    old, text = old.replace(b'CHECK', check), text.replace('CHECK', check.decode())
    assert old in content
    path.write_bytes(content.replace(old, new, 1))
    # the run is repeated, to find the column
    monkeypatch.setattr(runs_file, 'simulate_row', lambda _, seed: rows(CHUNKS[(seed - 7) // 2])[(seed - 7) % 2])
    monkeypatch.setattr(type(CHUNKS[0]), 'case', lambda *_: None)
    with pytest.raises(ConfigError, match=f'^--output: {path}: {text}'):
        write(path, 3)


def test_the_record_is_json_for_all_programs_and_another_version_of_python_continues(tmp_path):
    write(tmp_path / 'a.csv', 1)
    record = json.loads((tmp_path / 'a.csv.json').read_text(), parse_constant=pytest.fail)
    assert record == {'versions': VERSIONS, **COMMAND}
    (tmp_path / 'a.csv.json').write_text(json.dumps({**record, 'versions': {'Python': '3.8.3'}}))
    assert write(tmp_path / 'a.csv', 2) == 1
    with pytest.raises(ValueError, match='not JSON compliant'):
        RunsFile(str(tmp_path / 'b.csv'), {'limit': float('inf')}, [], VERSIONS)


def test_the_disk_is_synchronized_at_most_once_a_second(tmp_path, monkeypatch):
    now, calls = [0.0], []
    monkeypatch.setattr(runs_file.time, 'monotonic', lambda: now[0])
    file = RunsFile(str(tmp_path / 'a.csv'), COMMAND, [], VERSIONS)
    monkeypatch.setattr(runs_file.os, 'fsync', calls.append)
    list(file.read(CHUNKS, None))
    for chunk in CHUNKS[:40]:       # 10 s
        now[0] += 0.25
        file.append(chunk, rows(chunk))
    assert len(calls) == 8      # after 1.25 s each
    file.synchronize()
    assert len(calls) == 9
    file.file.close()
