"""Pages that need no ROS, followed in real terminals."""
import os
import signal
import subprocess

import pytest
from pages import blocks, processes
from pages.session import PageFailed, Session, is_harmless

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


def test_terminals_of_their_own(tmp_path):
    """Ctrl-C in one does not end the command in the other."""
    follow(tmp_path, run('echo one; cat', 'terminal: one') + shows('one') + run('echo two; cat', 'terminal: two') +
           shows('two') + '<!-- Ctrl-C: one -->\nCtrl-C\n' + run('tty; cat', 'terminal: one') + shows('/dev/pts/1') +
           '<!-- Ctrl-C: two -->\nCtrl-C\n')


def test_nothing_from_outside(tmp_path, monkeypatch):
    """Variables of the caller are not inherited."""
    monkeypatch.setenv('ROS_PACKAGE_PATH', '/somewhere')
    assert "echo ${ROS_PACKAGE_PATH?} ended with status 1" in failure(tmp_path, run('echo ${ROS_PACKAGE_PATH?}'))


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


def test_output_is_of_this_block(tmp_path):
    """Output of earlier commands does not count, nor does the command as typed."""
    assert "no line 'one'" in failure(tmp_path, run('echo one') + run('true') + shows('one'))
    assert "no line 'echo one'" in failure(tmp_path, run('echo one') + shows('echo one'))


def test_hangs(tmp_path):
    """The message contains the output so far."""
    trouble = failure(tmp_path, run('echo so far; cat'), limit=1)
    assert 'echo so far; cat does not exit after 1 s' in trouble and '\nso far\n' in trouble
    assert 'Ctrl-C does not stop it' in failure(tmp_path, run('''trap '' INT; echo up; sleep 60''', 'terminal: a') +
                                              shows('up'), limit=1)


def test_ends_too_early(tmp_path):
    assert 'true ended with status 0' in failure(tmp_path, run('true', 'terminal: a'))
    assert 'ended before Ctrl-C, with status 3' in failure(
        tmp_path, run('echo up; (exit 3)', 'terminal: a') + shows('up') + run('sleep 0.2') +
        '<!-- Ctrl-C: a -->\nCtrl-C\n')


def test_status_after_ctrl_c(tmp_path):
    assert 'status 3 after Ctrl-C' in failure(
        tmp_path, run('''bash -c 'trap "exit 3" INT; echo up; while sleep 0.1; do :; done' ''', 'terminal: a') +
        shows('up'))


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


def test_others_live_on(tmp_path):
    """A page that fails kills only its own processes."""
    with subprocess.Popen(['sleep', '1000'], env=dict(os.environ, HOME=f'{tmp_path!s}2')) as other:
        failure(tmp_path, run('false'))
        assert other.poll() is None
        other.send_signal(signal.SIGKILL)


@pytest.mark.parametrize('end, harmless', [("AttributeError: 'Thread' object has no attribute 'isAlive'", True),
                                           ("AttributeError: 'ProcessMonitor' object has no attribute 'isAlive'", True),
                                           ("AttributeError: 'Thread' object has no attribute 'is_alive'", False)])
def test_a_traceback_of_debian_11_is_harmless(end, harmless):
    lines = ['Traceback (most recent call last):', '[WARN] [1.0]: other node', '  File "a.py", line 1, in <module>',
             '    a', end, '$ ']
    assert is_harmless(lines) == harmless
    assert not is_harmless(lines[4:])
