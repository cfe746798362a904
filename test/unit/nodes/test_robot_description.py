"""robot_description.py prints a URDF file with prefixed links and faint colors, expands xacro, and names a bad file."""
import os
import subprocess
import sys

import pytest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
XACRO = '<robot name="a" xmlns:xacro="a"><xacro:property name="b" value="1"/></robot>'


def run(*arguments, path='/usr/bin:/bin'):
    return subprocess.run([sys.executable, os.path.join(ROOT, 'nodes', 'robot_description.py'), *map(str, arguments)],
                          env={'PATH': path, 'PYTHONPATH': os.path.join(ROOT, 'src')}, encoding='utf-8',
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def test_only_links_and_colors_are_changed():
    path = os.path.join(ROOT, 'urdf', 'turtlebot.urdf')
    with open(path, encoding='utf-8') as file:
        text = file.read()
    assert run(path).stdout == text
    changed = run('--prefix', 'r1/', '--alpha', '0.3', path).stdout
    assert '<link name="r1/base_footprint"/>' in changed and '<joint name="base_l_wheel_joint"' in changed
    assert changed.count('"r1/') == text.count('<link ') + text.count('<parent ') + text.count('<child ')
    assert changed.count(' 0.3"') == text.count('rgba=')
    assert changed.replace('"r1/', '"').replace(' 0.3"', ' 1"') == text


def test_a_xacro_file_is_expanded_by_xacro(tmp_path):
    # Debian has no xacro
    (tmp_path / 'xacro').write_text('#!/bin/sh\nsed "s,<xacro.*/>,<link name=\'$2\'/>," "$1"\n')
    (tmp_path / 'xacro').chmod(0o755)
    (tmp_path / 'a.xacro').write_text(XACRO)
    result = run('--prefix', 'r1/', tmp_path / 'a.xacro', 'b', path=f'/usr/bin:/bin:{tmp_path}')
    assert result.returncode == 0 and "<link name='r1/b'/>" in result.stdout


@pytest.mark.parametrize('text, expected', [
    (XACRO, 'a xacro file, not a URDF file: expected one'), ('<robot', 'not a URDF file: unclosed token'),
    (b'\xff\xfe', 'not a URDF file'), (None, 'No such file')])
def test_a_bad_file_is_one_line(tmp_path, text, expected):
    if text is not None:
        (tmp_path / 'a').write_bytes(text if isinstance(text, bytes) else text.encode())
    result = run(tmp_path / 'a')
    assert result.returncode == 1 and result.stdout == ''
    assert result.stderr.startswith(f"model: {tmp_path / 'a'}: ") and result.stderr.count('\n') == 1
    assert expected in result.stderr
