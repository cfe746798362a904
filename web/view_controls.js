// Controls for the view of the floor: buttons, keys, mouse and touch.

const ZOOM = 1.25, PAN = 60;        // a factor; pixels

export function connectView(floor, model, redraw) {
  const svg = floor.svg, button = id => document.getElementById(id);
  const follow = on => {
    floor.following = on;
    floor.touched = floor.touched || on;
    button('follow').setAttribute('aria-pressed', on);
    redraw();
  };
  const arrows = on => {
    floor.arrows.style.display = on ? '' : 'none';
    button('arrows').setAttribute('aria-pressed', on);
  };
  const pressed = id => button(id).getAttribute('aria-pressed') === 'true';
  const clear = () => {
    model.clear();
    model.earlier = [];
    redraw();
  };
  const all = () => {
    follow(false);
    floor.fit();
  };
  button('zoom-in').onclick = () => floor.zoom(ZOOM);
  button('zoom-out').onclick = () => floor.zoom(1 / ZOOM);
  button('home').onclick = all;
  button('follow').onclick = () => follow(!pressed('follow'));
  button('arrows').onclick = () => arrows(!pressed('arrows'));
  button('clear').onclick = clear;

  const keys = {
    '+': () => floor.zoom(ZOOM), '=': () => floor.zoom(ZOOM), '-': () => floor.zoom(1 / ZOOM), '0': all,
    'f': () => follow(!pressed('follow')), 'a': () => arrows(!pressed('arrows')), 'c': clear};
  const moves = {ArrowLeft: [PAN, 0], ArrowRight: [-PAN, 0], ArrowUp: [0, PAN], ArrowDown: [0, -PAN]};
  // only while the floor has the focus, so that a key that is pressed by mistake elsewhere has no effect
  svg.addEventListener('keydown', event => {
    if (!event.ctrlKey && !event.altKey && !event.metaKey) {
      keys[event.key.toLowerCase()]?.();
    }
    // while driving by hand is on, the arrow keys drive the robot, and drive.js has handled this event
    if (moves[event.key] && !event.defaultPrevented) {
      follow(false);
      floor.pan(...moves[event.key]);
      event.preventDefault();
    }
  });

  svg.addEventListener('wheel', event => {
    const box = svg.getBoundingClientRect();
    floor.zoom(Math.exp(-Math.max(-100, Math.min(100, event.deltaY)) / 400), event.clientX - box.left, event.clientY - box.top);
    event.preventDefault();
  }, {passive: false});

  // one pointer moves the view, two also zoom
  const pointers = new Map();
  const middle = () => {
    const [first, second = first] = [...pointers.values()];
    return {x: (first.x + second.x) / 2, y: (first.y + second.y) / 2, apart: Math.hypot(first.x - second.x, first.y - second.y)};
  };
  svg.addEventListener('pointerdown', event => {
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener('pointermove', event => {
    if (!pointers.has(event.pointerId)) {
      return;
    }
    const before = middle();
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    const now = middle();
    if (floor.following) {
      follow(false);
    }
    floor.pan(now.x - before.x, now.y - before.y);
    if (before.apart && now.apart) {
      const box = svg.getBoundingClientRect();
      floor.zoom(now.apart / before.apart, now.x - box.left, now.y - box.top);
    }
  });
  for (const name of ['pointerup', 'pointercancel']) {
    svg.addEventListener(name, event => pointers.delete(event.pointerId));
  }
}
