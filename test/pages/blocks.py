"""Reads a Markdown page as a list of steps that a program can follow.

A comment directly above each shell block (sh, bash) defines how its commands are run:

    <!-- run -->                      one by one in one terminal, which keeps its directory; each exits with status 0
    <!-- run, status 1 -->            as above, but each exits with status 1
    <!-- terminals: base, rviz -->    a name for each command, which stays in the foreground of the terminal with this
                                      name. The name run is for a command that exits, as above
    <!-- every terminal -->           run first in every terminal; a page without this block uses the block of README.md
    <!-- not run: installation -->    not run; NOT_RUN lists the permitted reasons

A comment directly above each text block defines what it is compared with:

    <!-- output -->                   the output of the last block or Ctrl-C: these lines appear in this order, with
                                      other lines in between. A number matches any number, ... matches any text
    <!-- output of base -->           the output in that terminal, after the last compared line
    <!-- output, within 5 -->         each number differs by at most 5 units of its last decimal; exact: not at all
    <!-- not output -->               nothing

A comment directly above a line of prose that contains "Ctrl-C":

    <!-- Ctrl-C: base -->             press Ctrl-C in these terminals; their names can then be reused
"""
import re
from collections import namedtuple

from . import markdown

SHELL, OUTPUT = ('sh', 'bash', 'shell', 'console'), 'text'
NOT_RUN = ('installation', 'the two commands', 'needs root', 'needs two machines', 'needs a robot', 'needs a browser',
           'takes long')
RUN = 'run'     # name of the terminal for commands that exit
COMMENT = re.compile(r'\s*<!-- (?P<text>.*?) -->\s*$')
MARKERS = {kind: re.compile(pattern) for kind, pattern in {
    'run': r'run(?:, status (?P<status>\d+))?',
    'terminals': r'terminals?: (?P<names>[\w-]+(?:, [\w-]+)*)',
    'every terminal': r'every terminal',
    'not run': r'not run: (?P<reason>.+)',
    'output': r'output(?: of (?P<of>[\w-]+))?(?:, (?:within (?P<tolerance>\d+)|(?P<exact>exact)))?',
    'not output': r'not output',
    'Ctrl-C': r'Ctrl-C: (?P<names>[\w-]+(?:, [\w-]+)*)'}.items()}
# script/parameter_tables.py generates the table below, script/rooms.py the diagram
GENERATED = re.compile(r'(?:parameter|key)s: \S+(?: beyond \S+)?|imports')
KEY = re.compile(r'<!-- key: \w+ -->')     # behind a number: test/unit/pages/test_keys.py
FOR_SHELL, FOR_OUTPUT = ('run', 'terminals', 'every terminal', 'not run'), ('output', 'not output')

# The steps; line: number of the comment or the block; terminal None: last terminal used; tolerance None: any number
Setup = namedtuple('Setup', 'line commands')
Run = namedtuple('Run', 'line commands status')
Start = namedtuple('Start', 'line command terminal')
Output = namedtuple('Output', 'line lines terminal tolerance')
Interrupt = namedtuple('Interrupt', 'line terminal')


class PageError(ValueError):
    """A page that cannot be parsed; the text begins with the line number."""

    def __init__(self, line, text, *values):
        super().__init__('%d: %s' % (line, text % values))


def commands(lines):
    """The commands of a block, without empty lines and comments. A backslash continues a command on the next line."""
    found, begun = [], ''
    for line in lines:
        begun += line
        if begun.endswith('\\'):
            begun += '\n'
            continue
        if begun.strip() and not begun.lstrip().startswith('#'):
            found.append(begun)
        begun = ''
    return found


def parse(text):
    """The steps of a page. Raises ValueError, with the line number, if the page breaks the rules above."""
    reader = _Reader()
    for number, language, lines in markdown.split(text):
        if language is None:
            reader.line(number, lines[0])
        else:
            reader.block(number, language, lines)
    reader.line(0, '')
    return reader.steps


class _Reader:
    """Collects the steps of a page, line by line and block by block."""

    def __init__(self):
        self.steps = []
        self.marker = None              # (line, kind, values) of the comment directly above
        self.running = set()            # names of the terminals with a command in the foreground
        self.before, self.in_list = '', False

    def line(self, number, line):
        """Process a line outside of fenced blocks."""
        comment = COMMENT.match(line)
        if self.marker:
            self.end_marker(line)
        if comment and not GENERATED.fullmatch(comment['text']):
            self.marker = self.read_marker(number, comment['text'])
        elif not comment and '<!--' in KEY.sub('', markdown.CODE_SPAN.sub('', line)):
            raise PageError(number, 'expected a comment alone on its line')
        elif line.startswith(('    ', '\t')) and not self.before and not self.in_list:
            raise PageError(number, 'an indented code block, expected a fenced one')
        if line and not line[0].isspace():
            self.in_list = bool(re.match(r'[-*+] |\d+[.)] ', line))
        self.before = line.strip()

    def read_marker(self, number, text):
        """Parse a comment into (line, kind, values)."""
        for kind, pattern in MARKERS.items():
            match = pattern.fullmatch(text)
            if match:
                return number, kind, match.groupdict()
        raise PageError(number, 'unknown comment %r, expected one that test/pages/blocks.py lists', text)

    def end_marker(self, line):
        """Process the comment above this line of prose: only Ctrl-C is allowed there."""
        number, kind, values = self.marker
        self.marker = None
        if kind != 'Ctrl-C':
            raise PageError(number, '%r without a block directly below', kind)
        if 'Ctrl-C' not in line:
            raise PageError(number, 'Ctrl-C is missing in the line below')
        for name in values['names'].split(', '):
            if name not in self.running:
                raise PageError(number, 'no command runs in terminal %r', name)
            self.running.remove(name)
            self.steps.append(Interrupt(number, name))

    def block(self, number, language, lines):
        """Process a fenced block."""
        _, kind, values = self.marker or (None, None, None)
        self.marker, self.before = None, ''
        if language in SHELL and kind not in FOR_SHELL:
            raise PageError(number, 'a shell block without a comment directly above: one of %s', ', '.join(FOR_SHELL))
        if language == OUTPUT and kind not in FOR_OUTPUT:
            raise PageError(number, 'a text block without a comment directly above: one of %s', ', '.join(FOR_OUTPUT))
        if kind and language not in SHELL + (OUTPUT, ):
            raise PageError(number, '%r above a block that is neither shell nor text', kind)
        if not language:
            raise PageError(number, 'a block without a language')
        if kind == 'every terminal':
            self.steps.append(Setup(number, commands(lines)))
        elif kind == 'run':
            self.steps.append(Run(number, commands(lines), int(values['status'] or 0)))
        elif kind == 'terminals':
            self.terminals(number, values['names'].split(', '), commands(lines))
        elif kind == 'output':
            self.output(number, lines, values)
        elif kind == 'not run' and values['reason'] not in NOT_RUN:
            raise PageError(number, 'not run: %r: expected one of %s', values['reason'], ', '.join(NOT_RUN))

    def terminals(self, number, names, typed):
        """Process a block whose commands run in separate terminals."""
        if len(names) != len(typed):
            raise PageError(number, '%d names for %d commands', len(names), len(typed))
        for name, command in zip(names, typed):
            if name in self.running:
                raise PageError(number, 'a command runs in terminal %r already', name)
            if name == RUN:
                self.steps.append(Run(number, [command], 0))
            else:
                self.running.add(name)
                self.steps.append(Start(number, command, name))

    def output(self, number, lines, values):
        """Process a block of expected output."""
        if not any(isinstance(each, (Run, Start)) for each in self.steps):
            raise PageError(number, 'output without a command before')
        if values['of'] and not any(isinstance(each, Start) and each.terminal == values['of'] for each in self.steps):
            raise PageError(number, 'no terminal %r before', values['of'])
        tolerance = 0 if values['exact'] else int(values['tolerance']) if values['tolerance'] else None
        self.steps.append(Output(number, lines, values['of'], tolerance))
