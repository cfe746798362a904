"""The tables of parameters in docs/ are up to date with what the nodes declare."""
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
    pages = [markdown.read(ROOT, page) for page in markdown.documents(ROOT)]
    assert sum(len(tables.TABLE.findall(page)) for page in pages) == 12
    assert [tables.filled_in(page) for page in pages] == pages, 'run script/parameter_tables.py'
