#!/usr/bin/env python3
"""Print the size of the package, beside another commit: modules, logical lines, tests, pages, names used twice."""
import argparse
import ast
import collections
import io
import pathlib
import subprocess
import sys
import tarfile
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOVED = '\n\nThis page has moved:\n'      # in a page that only leads to other pages


def python_files(folder):
    """The Python files below a folder, without links and __init__.py."""
    return sorted(path for path in folder.rglob('*.py') if path.name != '__init__.py' and not path.is_symlink())


def lines(paths):
    """The number of lines of these files."""
    return sum(len(path.read_text(encoding='utf-8').splitlines()) for path in paths)


def logical_lines(tree):
    """The number of statements, without docstrings."""
    return sum(isinstance(node, ast.stmt)
               and not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
                        and isinstance(node.value.value, str)) for node in ast.walk(tree))


def repeated(names):
    """The names that occur more than once, as text."""
    return ' '.join(sorted(name for name, count in collections.Counter(names).items() if count > 1)) or 'none'


def measure(root):
    """Return {figure: value} of the package in a folder."""
    modules = python_files(root / 'src')
    trees = {path: ast.parse(path.read_text(encoding='utf-8')) for path in modules}
    rooms = collections.Counter()
    for path, tree in trees.items():
        room = path.relative_to(root / 'src/rbx1_nav').parts[0]
        rooms[f'logical lines of {room}/' if not room.endswith('.py') else 'logical lines beside the rooms'] += (
            logical_lines(tree))
    documents, records = (
        [path for path in folder.glob('*.md') if MOVED not in path.read_text(encoding='utf-8')]
        for folder in (root / 'docs', root / 'docs/decisions'))
    return {
        'modules of src': len(modules),
        'logical lines of src': sum(rooms.values()),
        **dict(sorted(rooms.items())),
        'lines of src': lines(modules),
        'lines of Python in test': lines(python_files(root / 'test')),
        'rostests': len(list((root / 'test').rglob('*.test'))),
        'pages': len(documents),
        'decision records': len(records),
        'lines of pages and records': lines(documents + records),
        'file names used twice in src': repeated(path.name for path in modules),
        'class names used twice in src': repeated(node.name for tree in trees.values() for node in tree.body
                                                  if isinstance(node, ast.ClassDef)),
        'files over 300 lines': ' '.join(path.name for path in modules if lines([path]) > 300) or 'none',
    }


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--beside', metavar='COMMIT', help='print the figures of this commit in a second column')
    arguments = parser.parse_args()
    columns = [measure(ROOT)]
    if arguments.beside:
        archive = subprocess.run(['git', '-C', str(ROOT), 'archive', arguments.beside], stdout=subprocess.PIPE,
                                 check=False)
        if archive.returncode:      # git has printed the reason
            sys.exit(1)
        with tempfile.TemporaryDirectory() as folder:
            with tarfile.open(fileobj=io.BytesIO(archive.stdout)) as files:
                files.extractall(folder)
            columns.insert(0, measure(pathlib.Path(folder)))
    for name in dict.fromkeys(name for column in columns for name in column):
        print(f'{name:34}', *(f'{column.get(name, 0):>8}' for column in columns))


if __name__ == '__main__':
    main()
