#!/usr/bin/env python3
"""Write figures.md from figures.yaml, and mark figures whose files have changed since they were measured as stale."""
import functools
import os
import re
import subprocess
import textwrap

import yaml

FOLDER = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.dirname(FOLDER)
STALE = '†'
INTRODUCTION = """# Figures

`bench/evidence.py` writes this page from [figures.yaml](figures.yaml); do not edit it. Unless stated
otherwise, the machine was an idle virtual machine with Debian 12 and two cores. [bench](README.md) describes the
programs.

The last column has the date and the commit of the version that was measured. After ≤ is the first commit whose pages
had the value: the measured version is not later. † marks a figure as stale: files that are listed below its table have
changed since."""


def load():
    """Return the sections of figures.yaml."""
    with open(os.path.join(FOLDER, 'figures.yaml'), encoding='utf-8') as file:
        return yaml.safe_load(file)


@functools.lru_cache(None)
def changed(commit, files):
    """Whether one of the files has changed since the commit; None if git does not know."""
    result = subprocess.run(['git', 'log', '--max-count=1', '--format=%h', commit + '..HEAD', '--', *files],
                            cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    return bool(result.stdout) if result.returncode == 0 else None


def wrapped(text):
    """Text with lines of at most 120 characters."""
    return textwrap.fill(' '.join(text.split()), 120, break_long_words=False, break_on_hyphens=False)


def row(cells):
    """A row of a table; empty cells keep their bars apart."""
    return '|' + '|'.join(f' {cell} ' if cell != '' else ' ' for cell in cells) + '|'


def page(sections, is_stale):
    """Return the text of figures.md. is_stale(commit, files): whether to mark a figure."""
    parts = [INTRODUCTION]
    for section in sections:
        figures, files = section['figures'], tuple(section['files'])
        seeds = ['seeds'] if any('seeds' in figure for figure in figures) else []
        heads = ['figure', *section['columns'], *seeds, 'measured']
        table = [row(heads), '|---' * len(heads) + '|']
        for figure in figures:
            commit = str(figure['commit'])
            mark = STALE if is_stale(commit.lstrip('≤'), files) else ''
            table.append(row([figure['what'], *figure['values'], *(figure.get(each, '') for each in seeds),
                              f"{figure['date']} {commit}{mark}"]))
        names = ''.join(f'<a id="{name}"></a>\n' for name in section.get('ids', ()))
        parts += [names + '## ' + section['title'], wrapped(section.get('text', '')), '\n'.join(table),
                  wrapped('*How:* ' + section['how'].strip() + '.'),
                  wrapped('*Files:* ' + ', '.join(f'`{each}`' for each in files))]
    return '\n\n'.join(filter(None, parts)) + '\n'


def without_marks(text):
    """The page without what depends on the history of git."""
    return re.sub(re.escape(STALE) + r' \|$', ' |', text, flags=re.M)


def main():
    """Write the page."""
    with open(os.path.join(FOLDER, 'figures.md'), 'w', encoding='utf-8') as file:
        file.write(page(load(), changed))


if __name__ == '__main__':
    main()
