// All words of the page in English. index.html and the other files name them; the node sends answers and log lines.

export const WORDS = {
  // header
  title: 'Out and back', robots: 'Robots', facts: 'Robot and floor', connecting: 'Connecting',
  stop: 'Stop', stopOne: robot => `Stop ${robot}`, escape: 'Esc',
  robot: 'Robot', simulated: 'simulated', real: 'real', surface: 'Surface', seed: 'Seed', time: 'Time',
  factor: factor => factor ? `simulated, ${factor} times real time` : 'simulated',
  connected: 'Connected', watching: 'Connected, watching only',
  silent: 'No answer: the page does not show where the robot is now',
  lost: reason => `Not connected${reason ? ` (${reason})` : ''}; retrying`,

  // methods; the node sends their titles
  drive: 'Methods', method: title => title[0].toUpperCase() + title.slice(1),
  intro: 'Each method drives the robot out, turns it round, drives it back, and turns it round again, so that it should ' +
    'finish where it started. Timed moves for fixed durations. With odometry stops each motion when the wheels have ' +
    'measured it, but wheels slip; the gyro also measures how far the robot has turned.',
  missed: (distance, angle, known) =>
    `${known ? 'missed' : 'by its odometry, missed'} the start by ${distance} m and ${angle}°`,
  needsFilter: method => `${method} needs the filter: roslaunch rbx1_bringup odom_ekf.launch.`,
  noReset: 'Only a simulated robot can be reset.',
  noToken: 'This page cannot drive the robot. To drive, ask for an address: in a page that can drive, "Another browser" makes one.',
  masterSilent: 'The ROS master does not answer. Start roscore, the base and the web view again.',
  masterRestarted: 'The ROS master was restarted. Start the web view again.',
  noBase: 'Waiting for a base. Start one: roslaunch rbx1_bringup fake_turtlebot.launch',
  running: name => `Running: ${name}. Stop it to use the other buttons.`,
  keysDrive: 'The arrow keys drive the robot.',
  stoppedElsewhere: 'stopped, not from this page',
  outcome: (name, outcome) => `${name}: ${outcome}`,
  said: text => text,     // a sentence of the node
  run: (name, stopped) => stopped ? `${name}, stopped` : name,

  // Stop and other messages
  stopping: 'Stopping.',
  notReached: 'Not connected: Stop did not reach the robot. Stop it by hand. This page repeats Stop until it is answered.',
  noAnswer: 'No answer: the robot may still be moving. Stop it by hand. This page repeats Stop until it is answered.',
  refused: reason => `Refused: ${reason}.`,
  rejected: {
    token: 'This browser may no longer drive, because the web view was started again: open the address that it has printed.',
    code: 'This address has been used already, is not complete, or is from an earlier start of the web view.'},
  invite: 'Another browser', inviteHelp: 'Make an address with which one more browser can drive',
  invited: address => `For one more browser, which can then drive: ${address}`,
  realRobot: 'This robot is real', cancel: 'Cancel', allow: 'Allow motion',
  confirmRun: 'It will drive 1 m forward and back. It needs 1.5 m of free floor ahead and 1 m on either side.',
  confirmHand: 'It will follow the arrow keys, and stop when you release them.',

  // floor
  floor: 'Floor', floorHelp: 'Floor seen from above, x to the right. Arrow keys move the view, + and - zoom.',
  zoomIn: 'Zoom in (+)', zoomOut: 'Zoom out (-)', fit: 'Fit view', fitHelp: 'Show the start and all paths (0)',
  follow: 'Follow', followHelp: 'Keep the robot in the middle (F)',
  arrows: 'Arrows', arrowsHelp: 'Show or hide the arrows (A)',
  clear: 'Clear', clearHelp: 'Remove the paths from this page (C)',
  save: 'Save', saveHelp: 'Save the picture, and the numbers of the run as CSV',
  large: 'Projector', largeHelp: 'Large floor and numbers',
  legend: 'Paths to show', truth: 'truth', odometry: 'odometry', estimate: 'estimate',
  meaning: {
    truth: 'Where the robot really is, which only a simulation knows', odometry: 'Where the robot is by its wheels',
    estimate: 'Where the robot is by its wheels and its gyro'},
  earlier: 'Earlier runs to show', showRun: number => `Show run ${number}`,
  mean: (name, number) => `${name}, mean of ${number} runs`,
  withSeed: (surface, seed) => `${surface}, seed ${seed}`,
  earlierRuns: (kind, numbers) => `Earlier runs (${kind}): ${numbers}`,
  numbers: (source, [x, y, heading, distance]) =>
    `${source}: x ${x} m, y ${y} m, heading ${heading}°, ${distance} m from the start`,

  // further controls
  more: 'Floor, reset and driving by hand', resetFirst: 'Reset before each run', reset: 'Reset', byHand: 'Drive by hand',
  distance: 'Distance (m)', speed: 'Speed (m/s)',
  pad: 'Hold to drive', forward: 'Forward', backward: 'Backward', left: 'Turn left', right: 'Turn right',

  // tables, plots, log
  poses: 'Where the robot is', thisRun: name => `This run${name ? `: ${name}` : ''}`, none: '–',
  poseHead: ['', 'x (m)', 'y (m)', 'heading (°)', 'from start (m)'],
  runHead: ['', 'run', 'floor', 'from start (m)', 'heading (°)'],
  speeds: 'Speed over time', window: 'Window', until: 'Until', linear: 'Forward speed', angular: 'Turn rate',
  linearAxis: 'forward (m/s)', angularAxis: 'turning (rad/s), left is up',
  commanded: 'commanded', reported: 'reported by the wheels', true: 'true',
  log: 'Log', logHelp: 'Last log messages',

  // the page of the teacher
  seats: 'Seats', seat: number => `Seat ${number}`, stopAll: 'Stop all', floorOf: seat => `Floor of ${seat}`,
  idle: 'Idle', driving: name => `Driving: ${name}`, seatsConnected: (number, all) => `${number} of ${all} seats connected`,
  teacherAddress: 'Open the address for the teacher that seats.py printed last. It is valid for the first browser that opens it.',

  // the page without ROS
  script: 'Script', scriptHelp: 'Script, which you can edit', runScript: 'Run the script', restore: 'Restore',
  play: 'Play', paces: ['in real time', '5 times as fast', '20 times as fast', 'at once'],
  manyRuns: number => `${number} runs`, manyHelp: 'Method of the runs',
  noPython: reason => `Python cannot be loaded: ${reason}`,
  onlyScripts: 'only scripts drive the robot of this page',
  tooLong: seconds => `The script was ended, because its run was not computed within ${seconds} s.`};
