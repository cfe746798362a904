// All words of the page in Chinese. words_zh_tw.js is made from words_zh.js by script/traditional.py.

const RUNS = {'timed': '定时', 'with odometry': '用里程计', 'with odometry and gyro': '用里程计和陀螺仪', script: '脚本'};

// The sentences of the node that a learner needs: [the English one, the Chinese one]. Other sentences stay English.
const SENTENCES = [
  [/^Out and back$/, '往返运动'], [/^finished$/, '完成'], [/^stopped$/, '已停止'], [/^failed; see the log$/, '失败，原因见日志'],
  [/^failed with exit status (\d+); see the log$/, '失败（退出状态 $1），原因见日志'],
  [/^not started: /, '没有启动：'], [/^reset failed: /, '复位失败：'], [/^Seat (\d+)$/, '座位 $1'],
  [/Stopped ([^.]+)\. ?/, '已停止 $1。'], [/Stopped\. ?/, '已停止。'], [/Zero commands were sent\. ?/, '已发送零速度命令。'],
  [/No answer from ([^:]+): the robot may move again\. ?/, '$1 没有应答：机器人可能会再动起来。'],
  [/The robot is stationary\./, '机器人静止不动。'],
  [/The robot was stationary ([\d.]+) s after Stop\./, '按下“停止”后 $1 s，机器人已经静止。'],
  [/The robot was still moving ([\d.]+) s after Stop\./, '按下“停止”后 $1 s，机器人还在动。'],
  [/There is no odometry later than ([\d.]+) s after Stop: the robot may still be moving\./,
    '按下“停止”$1 s 以后没有收到里程计：机器人可能还在动。'],
  [/^a run is in progress: stop it first$/, '正在运行，请先停止'],
  [/^(.+) is driving the robot: stop it first$/, '$1 正在驱动机器人，请先停止它'],
  [/^this page cannot drive the robot$/, '这个页面不能驱动机器人'],
  [/^another browser is driving the robot, or driving by hand is off$/, '另一个浏览器正在驱动机器人，或者手动驾驶没有打开'],
  [/^a real robot moves only after you have confirmed that its path is free$/, '要先确认前方没有障碍，真实的机器人才会动'],
  [/^the request was more than 2 s old, so nothing was started: try again$/, '请求晚到了 2 s 以上，所以什么也没有启动，请再试一次'],
  [/^Stop needs the token here, and this page has none$/, '在这里停止机器人也需要权限，这个页面没有']];

export const WORDS = {
  // header
  title: '往返运动', robots: '机器人', facts: '机器人和地面', connecting: '正在连接',
  stop: '停止', stopOne: robot => `停止 ${robot}`, escape: 'Esc',
  robot: '机器人', simulated: '仿真', real: '真实', surface: '地面', seed: '随机种子', time: '时间',
  factor: factor => factor ? `仿真，实际时间的 ${factor} 倍` : '仿真',
  connected: '已连接', watching: '已连接，只能看',
  silent: '没有应答：页面显示的不是机器人现在的位置',
  lost: reason => `未连接${reason ? `（${reason}）` : ''}，正在重试`,

  // methods; the node sends their titles
  drive: '方法', method: title => RUNS[title] || title,
  intro: '每种方法都让机器人前进，掉头，返回，再掉头，这样它应该回到出发时的位姿。“定时”按固定的时间运动。' +
    '“用里程计”等轮子测得的距离或角度达到目标才停下，但是轮子会打滑；陀螺仪还测量机器人转了多少。',
  missed: (distance, angle, known) => `${known ? '' : '按照里程计，'}离起点 ${distance} m，航向差 ${angle}°`,
  needsFilter: method => `“${method}”需要滤波器：roslaunch rbx1_bringup odom_ekf.launch。`,
  noReset: '只有仿真的机器人才能复位。',
  noToken: '这个页面不能驱动机器人。要驱动，需要一个网址：在能驱动机器人的页面里，按“再加一个浏览器”就会生成。',
  masterSilent: 'ROS 节点管理器（master）没有应答。请重新启动 roscore、底盘和 web_view.launch。',
  masterRestarted: 'ROS 节点管理器（master）重新启动过。请重新启动 web_view.launch。',
  noBase: '正在等待底盘。启动一个：roslaunch rbx1_bringup fake_turtlebot.launch',
  running: name => `正在运行：${RUNS[name] || name}。先停止它，才能用其他按钮。`,
  keysDrive: '方向键驱动机器人。',
  stoppedElsewhere: '已停止，不是从这个页面停止的',
  outcome: (name, outcome) => `${name}：${outcome}`,
  said: text => SENTENCES.reduce((said, [english, chinese]) => said.replace(english, chinese), text),
  run: (name, stopped) => `${RUNS[name] || name}${stopped ? '，已停止' : ''}`,

  // Stop and other messages
  stopping: '正在停止。',
  notReached: '未连接：“停止”没有送到机器人。请用手让它停下。页面会一直重发“停止”，直到有应答。',
  noAnswer: '没有应答：机器人可能还在动。请用手让它停下。页面会一直重发“停止”，直到有应答。',
  refused: reason => `被拒绝：${reason}。`,
  rejected: {
    token: 'web_view.launch 重新启动过，所以这个浏览器不能再驱动机器人：请打开它打印的网址。',
    code: '这个网址已经用过，或者不完整，或者是 web_view.launch 以前某次启动时打印的。'},
  invite: '再加一个浏览器', inviteHelp: '生成一个网址，让另一个浏览器也能驱动机器人',
  invited: address => `给另一个浏览器的网址，打开以后，那个浏览器也能驱动机器人：${address}`,
  realRobot: '这是真实的机器人', cancel: '取消', allow: '允许运动',
  confirmRun: '它会前进 1 m，再返回。前方要有 1.5 m 的空地，左右各要有 1 m。',
  confirmHand: '它会按方向键运动，松开就停。',

  // floor
  floor: '地面', floorHelp: '从上方看到的地面，x 轴向右。方向键移动画面，+ 和 - 缩放。',
  zoomIn: '放大（+）', zoomOut: '缩小（-）', fit: '全部显示', fitHelp: '显示起点和所有路径（0）',
  follow: '跟随', followHelp: '让机器人保持在中央（F）',
  arrows: '箭头', arrowsHelp: '显示或隐藏箭头（A）',
  clear: '清除', clearHelp: '清除页面上的路径（C）',
  save: '保存', saveHelp: '保存图片，并把这次运行的数值存成 CSV',
  large: '投影', largeHelp: '把地面和数字放大',
  legend: '要显示的路径', truth: '真值', odometry: '里程计', estimate: '估计值',
  meaning: {
    truth: '机器人真实的位姿，只有仿真才知道', odometry: '由轮子得到的位姿', estimate: '由轮子和陀螺仪得到的位姿'},
  earlier: '要显示的以前的运行', showRun: number => `显示第 ${number} 次运行`,
  mean: (name, number) => `${name}，${number} 次运行的平均`,
  withSeed: (surface, seed) => `${surface}，随机种子 ${seed}`,
  earlierRuns: (kind, numbers) => `以前的运行（${kind}）：${numbers}`,
  numbers: (source, [x, y, heading, distance]) =>
    `${source}：x ${x} m，y ${y} m，航向 ${heading}°，离起点 ${distance} m`,

  // further controls
  more: '地面、复位和手动驾驶', resetFirst: '每次运行前复位', reset: '复位', byHand: '手动驾驶',
  distance: '距离（m）', speed: '速度（m/s）',
  pad: '按住以驾驶', forward: '前进', backward: '后退', left: '左转', right: '右转',

  // tables, plots, log
  poses: '机器人在哪里', thisRun: name => `这次运行${name ? `：${RUNS[name] || name}` : ''}`, none: '–',
  poseHead: ['', 'x（m）', 'y（m）', '航向（°）', '离起点（m）'],
  runHead: ['', '运行', '地面', '离起点（m）', '航向（°）'],
  speeds: '速度随时间的变化', window: '时间窗口', until: '截止', linear: '前进速度', angular: '角速度',
  linearAxis: '前进（m/s）', angularAxis: '转动（rad/s），向左为正',
  commanded: '命令的', reported: '轮子报告的', true: '真实的',
  log: '日志', logHelp: '最近的日志',

  // the page of the teacher
  seats: '座位', seat: number => `座位 ${number}`, stopAll: '全部停止', floorOf: seat => `${seat} 的地面`,
  idle: '空闲', driving: name => `正在行驶：${RUNS[name] || name}`,
  seatsConnected: (number, all) => `${all} 个座位，已连接 ${number} 个`,
  teacherAddress: '请打开 seats.py 最近一次打印的教师网址。第一个打开它的浏览器才能使用。',

  // the page without ROS
  script: RUNS.script, scriptHelp: '脚本，可以修改', runScript: '运行脚本', restore: '恢复原样',
  play: '播放', paces: ['实际速度', '5 倍速度', '20 倍速度', '立即显示'],
  manyRuns: number => `运行 ${number} 次`, manyHelp: '多次运行的方法',
  noPython: reason => `无法加载 Python：${reason}`,
  onlyScripts: '在这个页面里，只有脚本驱动机器人',
  tooLong: seconds => `这次运行在 ${seconds} s 内没有算完，所以脚本被终止了。`};
