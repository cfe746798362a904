"""Declares each parameter once: checks, usage texts and the tables in docs/ are generated from the declaration."""
from __future__ import annotations

from functools import partial
from itertools import groupby
from math import pi
import re
import textwrap
from typing import Any, Callable, Iterable, NamedTuple, Sequence

from rbx1_nav.node.config import Scalar, Section, YamlValue

POSITIVE = 1e-6, 1e6    # the default range of a number
WIDTH = 120             # characters per line of a usage text
# a line of list_parameters(): name, text, unit, range, default
LISTED = re.compile(r'    ~(\w+) +(.*) \((?:(\S+); )?(?:(\S+ to \S+); )?default: (.*)\)')


class Parameter(NamedTuple):
    """A parameter of a node, or a key of a YAML file."""

    name: str
    default: str        # as shown in a usage text; '' for none
    unit: str
    range: str | Callable[[], str]      # callable: called when it is shown
    text: str
    note: str = ''      # text for the table of the reference only, in Markdown
    read: Callable[[Section], Any] | None = None    # returns the checked value; None if read() skips the parameter


def number(name: str, default: float | None, unit: str, text: str, low: float = POSITIVE[0], high: float = POSITIVE[1],
           what: str = 'a number', required: bool = False, shown: str = '', note: str = '') -> Parameter:
    """Declare a number from `low` to `high`.

    what: for the error message. For the other arguments, see flag().
    """
    as_text = '' if (low, high) == POSITIVE else f'{low:.7g} to {high:.7g}'
    return Parameter(name, shown or ('' if default is None else f'{default:g}'), unit, as_text, text, note, _reader(
        name, default is None and not required, lambda section: section.number(name, low, high, default, what, unit)))


def flag(name: str, default: bool | None, text: str, shown: str = '', note: str = '') -> Parameter:
    """Declare a parameter that is true or false.

    default: value if the parameter is not set, which may be None; shown: text shown instead of the default.
    """
    return Parameter(name, shown or str(default).lower(), '', '', text, note, _reader(
        name, default is None, lambda section: section.flag(name, bool(default))))


def choice(name: str, choices: Sequence[Scalar], default: Scalar | None, text: str, unit: str = '', shown: str = '',
           note: str = '') -> Parameter:
    """Declare a parameter with one of several values. default, shown: see flag()."""
    as_text = ', '.join(str(each).lower() for each in choices)
    return Parameter(name, shown or str(default).lower(), unit, as_text, text, note, _reader(
        name, default is None, lambda section: section.choice(name, choices, default or '')))


def frame(name: str, default: str | None, text: str, shown: str = '', note: str = '') -> Parameter:
    """Declare the name of a frame. default, shown: see flag()."""
    return Parameter(name, shown or default or '', '', '', text, note, _reader(
        name, default is None, lambda section: section.frame(name, default or '')))


def _reader(name: str, optional: bool, read: Callable[[Section], Any]) -> Callable[[Section], Any]:
    return lambda section: None if optional and name not in section.values else read(section)


def custom(name: str, default: YamlValue, text: str, check: Callable[[Any], Any], shown: str = '', note: str = '',
           range: str | Callable[[], str] = '') -> Parameter:
    """Declare a parameter with any value.

    check(value): returns the result of read() for this value, or raises ConfigError.
    """
    return Parameter(name, shown or str(default), '', range, text, note,
                     lambda section: check(section.get(name, default)))


def elsewhere(name: str, text: str, shown: str = '', note: str = '') -> Parameter:
    """Declare a parameter that is read elsewhere, or ignored."""
    return Parameter(name, shown, '', '', text, note)


def read(parameters: Iterable[Parameter], section: Section) -> dict[str, Any]:
    """Return the checked values by name, in the order of the parameters.

    Raises ConfigError for the first invalid value.
    """
    return {each.name: each.read(section) for each in parameters if each.read}


def list_parameters(parameters: Sequence[Parameter]) -> str:
    """Return the lines of a usage text, or '' if there is no parameter."""
    if not parameters:
        return ''
    indent = 6 + max(len(each.name) for each in parameters) + 2
    wrap = partial(textwrap.fill, width=WIDTH, subsequent_indent=' ' * indent, break_long_words=False,
                   break_on_hyphens=False)
    lines = (wrap(f'    ~{each.name}'.ljust(indent) + _described(each)) for each in parameters)
    return 'Parameters:\n' + '\n'.join(lines)


def split_usage(docstring: str) -> tuple[str, list[Parameter]]:
    """Return (the text before the list of parameters, the parameters), for a script whose docstring is its usage text.

    The list is as list_parameters() prints it, each parameter in one line. A parameter with a unit is a number; a
    parameter whose name ends in _frame is the name of a frame; any other value is not checked. A list of another form
    counts as text.
    """
    usage, _, lines = docstring.partition('\nParameters:\n')
    try:
        return usage, [_listed(line) for line in lines.splitlines() if line.strip()]
    except ValueError:
        return docstring, []


def _listed(line: str) -> Parameter:
    """Return the parameter in a line. Raises ValueError."""
    match = LISTED.fullmatch(line)
    if not match:
        raise ValueError(line)
    name, text, unit, limits, default = match.groups()
    if name.endswith('_frame'):
        return frame(name, None if ' ' in default else default, text, shown=default)
    if unit is None:
        return elsewhere(name, text, default)
    low, high = map(float, limits.split(' to ')) if limits else POSITIVE
    return number(name, pi if default == 'pi' else float(default), unit, text, low, high, shown=default)


def _described(parameter: Parameter) -> str:
    default = parameter.default and f'default: {parameter.default}'
    details = '; '.join(filter(None, [parameter.unit, _range(parameter), default]))
    return f'{parameter.text} ({details})' if details else parameter.text


def _range(parameter: Parameter) -> str:
    return parameter.range() if callable(parameter.range) else parameter.range


def _cells(parameter: Parameter) -> tuple[str, str]:
    """Return the default and the text of a parameter in a table; the unit stands once."""
    default, unit, limits = parameter.default, parameter.unit, _range(parameter)
    if re.fullmatch(r'pi|-?[\d.]+', default):
        default, unit = f'{default} {unit}'.strip(), ''
    limits = ' '.join(filter(None, [limits, unit]))
    text = f'{parameter.text} ({limits})' if limits else parameter.text
    return default, f'{text}; {parameter.note}' if parameter.note else text


def table(parameters: Iterable[Parameter], kind: str = 'parameter') -> list[str]:
    """Return the lines of a table in Markdown.

    kind: title of the column of names; if it is `parameter`, the names begin with ~. Neighbors that differ only in
    their names share a line.
    """
    prefix = '~' if kind == 'parameter' else ''
    rows = groupby(parameters, _cells)
    head = [f'| {kind} | default | |', '|---|---|---|']
    return head + ['| %s | %s |' % (', '.join(f'`{prefix}{each.name}`' for each in named), ' | '.join(row))
                   for row, named in rows]
