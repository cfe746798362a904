"""Asks the user for a value that no sensor measures."""
from __future__ import annotations

import os
import select
import sys
from typing import Callable, TypeVar

import rospy

from rbx1_nav.config import ConfigError
from rbx1_nav.ros.node.life import end_requested

Answer = TypeVar('Answer')


def ask(question: str, check: Callable[[str], Answer]) -> Answer | None:
    """Ask on the terminal until check(text) accepts the answer; return the result of check().

    check() raises ConfigError for an invalid answer. Returns None if there can be no answer: without a terminal, or at
    the end of its input. Raises ROSInterruptException as soon as shutdown is requested, which input() would not notice.
    """
    source, text = sys.stdin.fileno(), b''
    while True:
        print(question, end=' ', flush=True)
        while b'\n' not in text:
            if end_requested.is_set():
                print(flush=True)
                raise rospy.ROSInterruptException('shutdown requested')
            if not select.select([source], [], [], 0.05)[0]:
                continue
            try:
                read = os.read(source, 4096)
            except OSError:         # the terminal belongs to another session, as under roslaunch
                read = b''
            if not read:
                print(flush=True)
                return None
            text += read
        answer, _, text = text.partition(b'\n')
        try:
            return check(answer.decode(errors='replace').strip())
        except ConfigError as error:
            print(error, flush=True)
