"""Compares the terminal output that a page shows with the actual output."""
import re

NUMBER = r'[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?'
TOKEN = re.compile(r'(?P<any>\.\.\.)|(?P<number>' + NUMBER + r')|(?P<space>\s+)|.')


def pattern(expected):
    """The regular expression for a line of the page, and (value, unit of the last decimal) of each number in it."""
    parts, numbers = [], []
    for token in TOKEN.finditer(expected.strip()):
        if token['any']:
            parts.append('.*')
        elif token['number']:
            parts.append(f'({NUMBER})')
            decimals = len(token['number'].partition('e')[0].partition('.')[2])
            numbers.append((float(token['number']), 10 ** -decimals))
        else:
            parts.append(r'\s+' if token['space'] else re.escape(token[0]))
    return re.compile(r'\s*' + ''.join(parts) + r'\s*'), numbers


def same(expected, line, tolerance=None):
    """Whether a terminal line is as expected. ... matches any text, a number any number within the tolerance.

    tolerance: in units of the last decimal of each number; None for any number.
    """
    regex, numbers = pattern(expected)
    match = regex.fullmatch(line)
    return bool(match) and (tolerance is None or all(
        # 1e-9: rounding of decimals in binary
        abs(float(shown) - number) <= tolerance * unit + 1e-9
        for shown, (number, unit) in zip(match.groups(), numbers)))


def find(expected, lines, tolerance=None):
    """Search for the expected lines in order. Returns (indices of the lines found, the first missing line or None)."""
    found, ahead = [], iter(enumerate(lines))
    for wanted in expected:
        if wanted.strip() in ('', '...'):
            continue
        index = next((index for index, line in ahead if same(wanted, line, tolerance)), None)
        if index is None:
            return found, wanted
        found.append(index)
    return found, None
