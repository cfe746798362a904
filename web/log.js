// The last log messages of all nodes, the newest at the end. The list follows it unless the user has scrolled up.

const WARNING = 4, ERROR = 8;       // levels of rosgraph_msgs/Log

function makeLine([level, time, node, text]) {
  const line = document.createElement('li'), where = document.createElement('span');
  where.className = 'where';
  where.textContent = `${new Date(time * 1000).toLocaleTimeString([], {hour12: false})} ${node}`;
  line.append(where, text);
  line.className = level >= ERROR ? 'error' : level >= WARNING ? 'warning' : '';
  return line;
}

export class LogView {
  constructor(list) {
    this.list = list;
    this.shown = null;
    this.following = true;      // whether to scroll to each new message
    list.addEventListener('scroll', () => {
      this.following = list.scrollHeight - list.scrollTop - list.clientHeight < 30;
    });
    new ResizeObserver(() => this.follow()).observe(list);
  }

  follow() {
    if (this.following) {
      this.list.scrollTop = this.list.scrollHeight;
    }
  }

  draw(lines) {
    if (lines === this.shown) {
      return;
    }
    // keep the lines that are on the page, because a screen reader reads each line that is added
    const kept = this.shown ? lines.indexOf(this.shown[this.shown.length - 1]) + 1 : 0;
    this.shown = lines;
    const following = this.following;
    [...this.list.children].slice(0, this.list.children.length - kept).forEach(line => line.remove());
    this.list.append(...lines.slice(kept).map(makeLine));
    this.following = following;
    this.follow();
  }
}
