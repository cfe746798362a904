// The other robots of a fleet: each has its own connection, is drawn on the same floor, and can be selected.

import {Connection} from './connection.js';
import {Model} from './model.js';
import {WORDS} from './words.js';

export class Fleet {
  // selected: the name of the robot of this page, '' for the first one.
  constructor(floor, selected) {
    Object.assign(this, {floor, selected});
    this.links = document.getElementById('robots');
    this.names = '';        // of all robots, as text
  }

  // status: of the selected robot, which names all robots.
  update({robots = [''], spacing = 1}) {
    if (robots.length < 2 || this.names === String(robots)) {
      return;
    }
    this.names = String(robots);
    this.selected = this.selected || robots[0];
    const own = robots.indexOf(this.selected);
    this.links.hidden = false;
    this.links.replaceChildren(...robots.map((name, index) => {
      const link = document.createElement('a'), query = new URLSearchParams(location.search);
      query.set('robot', name);
      link.textContent = name;
      link.href = `?${query}`;
      link.className = `robot-${index % 5}`;
      if (index === own) {
        link.setAttribute('aria-current', 'true');
      }
      return link;
    }));
    document.getElementById('stop').firstChild.textContent = WORDS.stopOne(this.selected);
    robots.forEach((name, index) => index !== own && this.watch(name, index, (own - index) * spacing));
  }

  // Draws another robot, `offset` meters to the left of the selected one.
  watch(name, index, offset) {
    const model = new Model(), connection = new Connection(name);
    connection.addEventListener('welcome', () => model.forget());
    connection.addEventListener('frame', ({detail}) => {
      model.add(detail);
      this.floor.drawOther(name, index, offset, model);
    });
  }
}
