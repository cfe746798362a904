"""The lists of parameters and surfaces are up to date with what the nodes declare, and with config/surfaces/."""
import importlib.util
import os

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..')


def load(*path):
    spec = importlib.util.spec_from_file_location('loaded', os.path.join(ROOT, *path))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_lists_are_up_to_date():
    tables = load('script', 'parameter_tables.py')
    texts = {}
    for path in tables.files():
        with open(path, encoding='utf-8') as file:
            texts[path] = file.read()
    assert sum(len(tables.TABLE.findall(text)) for text in texts.values()) == 14
    assert sum(len(tables.SURFACES.findall(text)) for text in texts.values()) == 6
    outdated = [path for path, text in texts.items() if tables.filled_in(text) != text]
    assert not outdated, 'run script/parameter_tables.py'
