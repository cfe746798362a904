"""The lists of parameters, surfaces and methods are up to date with what is declared, and with config/surfaces/."""
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
    for pattern, places in (tables.SURFACES, 6), (tables.FLEET, 2), (tables.BUTTONS, 1):
        assert sum(len(pattern.findall(text)) for text in texts.values()) == places
    outdated = [path for path, text in texts.items() if tables.filled_in(text) != text]
    assert not outdated, 'run script/parameter_tables.py'
