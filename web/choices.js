// What a learner can choose for a simulated robot, as far as the node allows it: floor, seed, distance and speed.

import {WORDS} from './words.js';

export class Choices {
  // begin(): is called before a choice is sent
  constructor(parent, connection, begin = () => {}) {
    Object.assign(this, {parent, connection, begin, inputs: {}});
  }

  // enabled: whether the robot may be moved now
  draw(status, enabled) {
    const names = status.simulated && status.can_reset ? status.choices || [] : [];
    if (String(names) !== this.names) {
      this.names = String(names);
      this.parent.hidden = !names.length;
      this.inputs = Object.fromEntries(names.map(name => [name, this.makeInput(name, status)]));
      this.parent.replaceChildren(...Object.entries(this.inputs).map(([name, input]) => {
        const label = document.createElement('label');
        label.append(WORDS[name], ' ', input);
        return label;
      }));
    }
    for (const [name, input] of Object.entries(this.inputs)) {
      input.disabled = !enabled;
      if (input !== document.activeElement || !enabled) {
        input.value = status[name] ?? '';
      }
    }
  }

  makeInput(name, {surfaces}) {
    const input = document.createElement(name === 'surface' ? 'select' : 'input');
    if (name === 'surface') {
      input.append(...surfaces.map(surface => new Option(surface)));
    } else {
      input.size = 6;
      input.type = 'text';
      input.inputMode = name === 'seed' ? 'numeric' : 'decimal';
    }
    input.name = name;
    input.onchange = () => {
      this.begin();
      this.connection.send({type: 'choose', name, value: input.value.trim().replace(',', '.')});
      input.blur();
    };
    return input;
  }
}
