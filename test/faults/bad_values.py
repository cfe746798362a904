"""Mistakes that a configuration may contain: values, keys, and what only the text of a YAML file can hold."""
import copy
import math
import reprlib

# among them integers that neither a float nor XML-RPC holds, and one that Python refuses to print
VALUES = [0, -1, 1, 2 ** 31, 2 ** 63, 10 ** 400, -10 ** 400, 16 ** 5000, 0.0, -0.0, 1e-320, 5e-324, 1e-9, 1e-3, 1e9,
          1e308, math.nan, math.inf, -math.inf, True, False, None, '', ' ', '0.2', '1e-3', 'two\nlines', 'a\u2028b',
          '\0', '\ud800', 'nan', 'random', '/', '//', 'a b', 'é', b'\xff', [], [0.2], [[]], {}, {'a': {'b': {}}},
          {1: 2}, {None: 'a\nb'}, {'\n': 1}, 'long' * 1000, list(range(1000))]
KEYS = ['new\nline', '', '/', 'a/b', 7, None, True, 'rate ', '\x1b[31m', 'é', 'a\u2028b', '\ud800', 'long' * 1000]
# %s: a key of the file
TEXTS = ['%s: !!bool maybe', '%s: !!float ""', '%s: !!int ""', '%s: !!timestamp never', '%s: !!python/name:os.system',
         f"%s: 0x{'f' * 5000}", '%s: 2024-13-45', '%s: 1e400', '%s: "\\ud800"', f"%s: {'[' * 500}", '%s: &a [*a]',
         '%s: =', '%s: \t1', '%s: *missing', '? {%s: 1}\n: 1', '- %s', '%s: \0', '%s: 1\n%s: [',
         '%s: !!binary "/w=="', '%s: -']


def mutate(random, values):
    """A copy of a mapping with one mistake, and the key whose value was replaced: None if it was another mistake."""
    values = copy.deepcopy(values)
    mappings = [values]
    for mapping in mappings:
        mappings += [value for value in mapping.values() if isinstance(value, dict)]
    mapping, key = random.choice([(mapping, key) for mapping in mappings for key in mapping])
    kind = random.randrange(8)
    if kind == 0:
        mapping[random.choice(KEYS)] = mapping.pop(key)
    elif kind == 1:
        mapping[random.choice(KEYS)] = random.choice(VALUES)
    elif kind == 2:
        del mapping[key]
    else:
        mapping[key] = (random.choice(VALUES) if kind < 6 else
                        random.choice([-1, 1]) * 10 ** random.uniform(-330, 308))
        return values, key
    return values, None


def shown(value):
    """A value, in a few characters."""
    try:
        return reprlib.repr(value)
    except ValueError:
        return 'an integer of more digits than Python prints'
