"""Nodes and programs as modules that need no master: parameters, topics, log and streams belong to the test."""
from contextlib import redirect_stderr, redirect_stdout
import importlib.util
import os
import sys

import rospy

from rbx1_nav.node import life, private_parameters
from rbx1_nav.node.config import Section
from rbx1_nav.node.parameters import read
from fake_topics import replace_topics

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))


def load(name):
    """The module of nodes/NAME.py."""
    spec = importlib.util.spec_from_file_location(f'{name}_node', os.path.join(ROOT, 'nodes', f'{name}.py'))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def without_master(monkeypatch, **params):
    """Let a node start with these private parameters; returns (its topics by name, its log: (level, line))."""
    log = []

    def init_node(name, usage, parameters=(), check=lambda _: None, **_):
        monkeypatch.setattr(rospy, 'get_name', lambda: f'/{name}')
        monkeypatch.setattr(private_parameters, '_values', read(parameters, Section(params)))
        check(params)
        log.append(('started', name))
    monkeypatch.setattr(life, 'init_node', init_node)
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)
    for level in 'info', 'warn', 'err', 'fatal':
        monkeypatch.setattr(rospy, f'log{level}', lambda form, *values, level=level: log.append((level, form % values)))
    return replace_topics(monkeypatch), log


def run_program(monkeypatch, folder, module, *arguments):
    """Run main() with a command line; returns (exit status, stdout, stderr), which are files in a folder."""
    monkeypatch.setattr(sys, 'argv', [module.__file__, *arguments])
    with open(str(folder / 'out'), 'w', 1) as out, open(str(folder / 'err'), 'w', 1) as err:
        with redirect_stdout(out), redirect_stderr(err):
            try:
                status = module.main()
            except SystemExit as exit:
                status = exit.code
    return status, (folder / 'out').read_text(), (folder / 'err').read_text()
