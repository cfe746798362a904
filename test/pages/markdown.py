"""Finds Markdown files, and splits their text into fenced blocks and prose."""
import os
import re

FENCE = re.compile(r'(?P<indent> *)(?P<fence>```+|~~~+) *(?P<language>\S*)')
CODE_SPAN = re.compile(r'(`+)(?!`).*?(?<!`)\1(?!`)')


def files(root, suffixes):
    """Sorted paths, relative to root, of all files with one of these suffixes, hidden directories excluded."""
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [each for each in folders if not each.startswith('.')]
        found += [os.path.relpath(os.path.join(folder, name), root) for name in names if name.endswith(suffixes)]
    return sorted(found)


def read(root, path):
    """The text of a page."""
    with open(os.path.join(root, path), encoding='utf-8') as file:
        return file.read()


def split(text):
    """Yield (line number, language, lines) for each fenced block, and (line number, None, [line]) for any other line.

    The indentation of the fence is removed from the lines of its block. Raises ValueError for an unclosed fence.
    """
    lines = enumerate(text.splitlines(), 1)
    for number, line in lines:
        fence = FENCE.match(line)
        if not fence:
            yield number, None, [line]
            continue
        body = []
        for _, inner in lines:
            if inner.strip() == fence['fence']:
                break
            body.append(inner[min(len(fence['indent']), len(inner) - len(inner.lstrip())):])
        else:
            raise ValueError('%d: this fence is not closed' % number)
        yield number, fence['language'], body


def documents(root):
    """The pages whose shell blocks are run: README.md and docs/*.md."""
    return [each for each in files(root, '.md') if each == 'README.md' or os.path.dirname(each) == 'docs']
