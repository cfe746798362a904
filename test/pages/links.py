"""Checks the links of Markdown pages, without the network."""
import os
import re
from urllib.parse import unquote, urlsplit

from . import markdown

HEADING = re.compile(r' {0,3}#{1,6} +(?P<text>.*?)(?: +#+)? *$')
ANCHOR = re.compile(r'<\w+ [^>]*?\b(?:id|name)="([^"]+)"')
TARGET = r'<?(?P<target>(?:[^()\s<>]|\([^()\s]*\))+)>?(?: +"[^"]*")?\)'
LINK = re.compile(r'\]\(' + TARGET + r'|^ {0,3}\[[^\]]+\]: *<?(?P<defined>[^\s>]+)'
                  r'|<a [^>]*href="(?P<html>[^"]+)"|<(?P<auto>\w[\w+.-]*:[^\s>]*)>')
IMAGE = re.compile(r'!\[[^\]]*\]\(' + TARGET + r'|<img [^>]*src="(?P<html>[^"]+)"')
PICTURES = ('.png', '.svg', '.jpg', '.jpeg', '.gif')


def slug(heading):
    """The anchor that GitHub generates for a heading."""
    text = re.sub(r'!?\[([^\]]*)\]\([^)]*\)', r'\1', heading)
    return re.sub(r'[^\w\- ]', '', text.strip().lower()).replace(' ', '-')


def anchors(text):
    """All anchors of a page."""
    found = set()
    for _, _, (line, ) in prose(text):
        heading = HEADING.match(line)
        if heading:
            first = name = slug(heading['text'])
            count = 0
            while name in found:
                count += 1
                name = '%s-%d' % (first, count)
            found.add(name)
        found.update(ANCHOR.findall(line))
    return found


def prose(text):
    """The lines outside fenced blocks, in the form of markdown.split."""
    return (each for each in markdown.split(text) if each[1] is None)


def targets(text):
    """Yield (line number, target, whether it is an image) for each link of a page."""
    for number, _, (line, ) in prose(text):
        line = markdown.CODE_SPAN.sub('``', line)
        for match in IMAGE.finditer(line):
            yield number, match['target'] or match['html'], True
        # with the image removed, [![text](image)](target) is a plain link
        line = IMAGE.sub('', line)
        for match in LINK.finditer(line):
            yield number, match['target'] or match['defined'] or match['html'] or match['auto'], False


def trouble(root, page, target):
    """The problem with a link of this page, or None."""
    url = urlsplit(target)
    if url.scheme or url.netloc:
        good = url.scheme == 'https' and re.fullmatch(r'([\w-]+\.)+[a-z]+', url.netloc or '')
        return None if good else 'expected a relative link or https://host/...'
    path = os.path.normpath(os.path.join(os.path.dirname(page), unquote(url.path))) if url.path else page
    if path.startswith(('/', '..')):
        return 'leads out of the repository'
    if not os.path.exists(os.path.join(root, path)):
        return 'no such file'
    if not path.endswith('.md'):
        return 'expected an anchor in a Markdown page only' if url.fragment else None
    good = not url.fragment or url.fragment in anchors(markdown.read(root, path))
    return None if good else 'no such heading'


def problems(root):
    """All problems in a repository, one line each.

    These are broken links, pages in docs/ that README.md does not lead to, and pictures that no page shows.
    """
    found, graph, shown = [], {}, set()
    for page in markdown.files(root, '.md'):
        graph[page] = set()
        for number, target, image in targets(markdown.read(root, page)):
            wrong = trouble(root, page, target)
            if wrong:
                found.append('%s:%d: %s: %s' % (page, number, target, wrong))
                continue
            path = os.path.normpath(os.path.join(os.path.dirname(page), unquote(urlsplit(target).path)))
            (shown if image else graph[page]).add(path)
    reached, ahead = set(), ['README.md']
    while ahead:
        page = ahead.pop()
        if page not in reached:
            reached.add(page)
            ahead.extend(graph.get(page, ()))
    found += [f'{page}: README.md does not lead to this page' for page in graph
              if page.startswith('docs/') and page not in reached]
    found += [f'{each}: no page shows this picture' for each in markdown.files(root, PICTURES) if each not in shown]
    return found
