"""Pages that need no ROS, followed in real terminals."""
import pytest
from pages import blocks, processes
from pages.session import PageFailed, Session

LIMIT = 60      # s, for a machine under load; each step takes less than one


def follow(home, page, limit=LIMIT):
    """Follow a page."""
    with Session('page.md', str(home), limit=limit) as session:
        session.follow(blocks.parse(page))
    assert processes.find(str(home)) == {}


def run(command, marker='run'):
    """A block."""
    return f'<!-- {marker} -->\n```sh\n{command}\n```\n'


def shows(*lines, marker='output'):
    """A text block."""
    return '<!-- %s -->\n```text\n%s\n```\n' % (marker, '\n'.join(lines))


def failure(home, page, limit=LIMIT):
    """The message with which this page fails; no process is left."""
    with pytest.raises(PageFailed) as caught:
        follow(home, page, limit)
    assert processes.find(str(home)) == {}
    return str(caught.value)


def test_in_order(tmp_path):
    """One of each kind of step; the terminal for commands that end keeps its directory."""
    follow(tmp_path, ''.join([
        run('mkdir a'), run('export WORD=hello', 'every terminal'), run('cd a\necho $WORD >file'), run('cat file'),
        shows('hello'), run('echo $WORD; tail -f a/file', 'terminal: watch'), shows('hello', 'hello'),
        run('test -t 0 && stty size\necho 0.5 >>file'), shows('40 120', marker='output, exact'),
        shows('0.6', marker='output of watch, within 1'),
        '<!-- Ctrl-C: watch -->\nPress Ctrl-C.\n', run('pwd; cat', 'terminal: watch'), shows(str(tmp_path))]))


def test_statuses(tmp_path):
    assert 'page.md:2: false ended with status 1, expected 0' in failure(tmp_path, run('false'))
    assert 'true ended with status 0, expected 1' in failure(tmp_path, run('true', 'run, status 1'))
    follow(tmp_path, run('false', 'run, status 1'))


def test_output_mismatch(tmp_path):
    """Of a command that has ended and of one that runs. The message contains the real output."""
    trouble = failure(tmp_path, run('echo one; echo three') + shows('one', 'two'))
    assert trouble.startswith("page.md:6: ended with status 0, and no line 'two'\n") and 'three' in trouble
    trouble = failure(tmp_path, run('echo three; cat', 'terminal: a') + shows('two'), limit=1)
    assert trouble.startswith('page.md:6: the output does not appear after 1 s\n') and 'three' in trouble


@pytest.mark.parametrize('line', ['[ERROR] [1.5]: no', '\033[31m[ERROR] [1.5]: no\033[0m', '[FATAL] [1.5]: no',
                                  'Traceback (most recent call last):', '[a-1] process has finished cleanly'])
def test_alarm(tmp_path, line):
    """Such a line fails the page unless the page shows it."""
    command = run("printf '%b' '" + line.replace('\033', '\\033') + "\\n'")
    assert 'the page does not show' in failure(tmp_path, command)
    assert 'the page does not show' in failure(tmp_path, command + run('true'))
    follow(tmp_path, command + shows(line.replace('\033[31m', '').replace('\033[0m', '')))


def test_left_behind(tmp_path):
    """A process that left its terminal is reported and killed."""
    trouble = failure(tmp_path, run('setsid -f sleep 1000 </dev/null >/dev/null 2>&1'), limit=1)
    assert 'processes left after the last step' in trouble and 'sleep 1000' in trouble
