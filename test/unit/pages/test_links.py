"""Broken links, in repositories of a few files."""
import pytest
from pages import links

README = """\
# Top [of](docs/a.md) `it_all`, and more!
## Twice
## Twice
[a](docs/a.md), [![picture](docs/p.png "title")](docs/a.md#part), [ref][r]
[own](#top-of-it_all-and-more), [2](#twice-1)
[folder](docs) <https://example.org/x_(y)> [site](https://example.org/a(b)?q=1#c) `[no](link)`
<a name="here"></a> [here](#here)

[r]: docs/b%20c.md
```sh
[no](link)
```
"""
FILES = {'README.md': README, 'docs/a.md': '## Part\n[back](../README.md#twice)\n', 'docs/b c.md': '', 'docs/p.png': ''}


def problems(folder, **changed):
    """The problems of a repository with FILES, some added or changed."""
    for path, text in {**FILES, **changed}.items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(text)
    return links.problems(str(folder))


def test_fine(tmp_path):
    assert problems(tmp_path) == []


@pytest.mark.parametrize('link, trouble', [
    ('[a](docs/none.md)', 'no such file'),
    ('[a](docs/A.md)', 'no such file'),
    ('![a](none.png)', 'no such file'),
    ('<img src="none.png">', 'no such file'),
    ('<a href="none.md">', 'no such file'),
    ('[x]: none.md', 'no such file'),
    ('[a](docs/a.md#none)', 'no such heading'),
    ('[a](#Twice)', 'no such heading'),
    ('[a](#twice-2)', 'no such heading'),
    ('[a](docs/p.png#L3)', 'expected an anchor in a Markdown page only'),
    ('[a](../other.md)', 'leads out of the repository'),
    ('[a](/docs/a.md)', 'leads out of the repository'),
    ('[a](http://example.org)', 'expected a relative link or https://host/...'),
    ('[a](https:/example.org)', 'expected a relative link or https://host/...'),
    ('[a](https://localhost)', 'expected a relative link or https://host/...'),
    ('<ftp://example.org>', 'expected a relative link or https://host/...'),
])
def test_broken(tmp_path, link, trouble):
    """In any Markdown file of the repository."""
    found, = problems(tmp_path, **{'CONTRIBUTING.md': f"Text\n{link}\n"})
    assert found.startswith('CONTRIBUTING.md:2: ') and found.endswith(f': {trouble}')


def test_a_page_that_has_moved(tmp_path):
    """No page leads to it, and none has to; its own links are checked."""
    moved = '# Old\n\nThis page has moved:\n\n- [Part](a.md#part)\n'
    assert problems(tmp_path, **{'docs/old.md': moved}) == []
    assert problems(tmp_path, **{'docs/old.md': moved, 'OTHER.md': '[old](docs/old.md)'}) == [
        'OTHER.md:1: docs/old.md: leads to a page that has moved']
    found, = problems(tmp_path, **{'docs/old.md': moved.replace('part', 'none'), 'OTHER.md': ''})
    assert found == 'docs/old.md:5: a.md#none: no such heading'


def test_out_of_reach(tmp_path):
    """Pages that only link each other, and a picture that is linked but not shown."""
    lost = {'docs/lost.md': '[too](lost_too.md) [q](q.png)', 'docs/lost_too.md': '[lost](lost.md)', 'docs/q.png': ''}
    assert problems(tmp_path, **lost) == [
        'docs/lost.md: README.md does not lead to this page', 'docs/lost_too.md: README.md does not lead to this page',
        'docs/q.png: no page shows this picture']
