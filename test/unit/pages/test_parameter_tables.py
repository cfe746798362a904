"""The tables of the reference are those of the parameters that the nodes declare."""
import importlib.util
import os

from pages import markdown

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..')


def load(*path):
    spec = importlib.util.spec_from_file_location('loaded', os.path.join(ROOT, *path))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_tables_are_up_to_date(monkeypatch):
    tables = load('script', 'parameter_tables.py')
    monkeypatch.setenv('ROS_PACKAGE_PATH', os.path.realpath(ROOT))
    page = markdown.read(ROOT, 'docs/reference.md')
    assert len(tables.TABLE.findall(page)) == 11
    assert tables.filled_in(page) == page, 'run script/parameter_tables.py'
