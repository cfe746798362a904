"""Provides a clock, and nodes that drive by it."""
import pytest

from lockstep_world import World


@pytest.fixture
def world():
    return World()
