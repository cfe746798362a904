// All words of the page in Chinese. words_zh_tw.js is made from words_zh.js by script/traditional.py.

const RUNS = {'timed': '定時', 'with odometry': '用里程計', 'with odometry and gyro': '用里程計和陀螺儀', script: '腳本'};

// The sentences of the node that a learner needs: [the English one, the Chinese one]. Other sentences stay English.
const SENTENCES = [
  [/^Out and back$/, '往返運動'], [/^finished$/, '完成'], [/^stopped$/, '已停止'], [/^failed; see the log$/, '失敗，原因見日誌'],
  [/^failed with exit status (\d+); see the log$/, '失敗（退出狀態 $1），原因見日誌'],
  [/^not started: /, '沒有啟動：'], [/^reset failed: /, '重設失敗：'], [/^Seat (\d+)$/, '座位 $1'],
  [/Stopped ([^.]+)\. ?/, '已停止 $1。'], [/Stopped\. ?/, '已停止。'], [/Zero commands were sent\. ?/, '已發送零速度命令。'],
  [/No answer from ([^:]+): the robot may move again\. ?/, '$1 沒有回應：機器人可能會再動起來。'],
  [/The robot is stationary\./, '機器人靜止不動。'],
  [/The robot was stationary ([\d.]+) s after Stop\./, '按下「停止」後 $1 s，機器人已經靜止。'],
  [/The robot was still moving ([\d.]+) s after Stop\./, '按下「停止」後 $1 s，機器人還在動。'],
  [/There is no odometry later than ([\d.]+) s after Stop: the robot may still be moving\./,
    '按下「停止」$1 s 以後沒有收到里程計：機器人可能還在動。'],
  [/^a run is in progress: stop it first$/, '正在執行，請先停止'],
  [/^(.+) is driving the robot: stop it first$/, '$1 正在驅動機器人，請先停止它'],
  [/^this page cannot drive the robot$/, '這個頁面不能驅動機器人'],
  [/^another browser is driving the robot, or driving by hand is off$/, '另一個瀏覽器正在驅動機器人，或者手動駕駛沒有開啟'],
  [/^a real robot moves only after you have confirmed that its path is free$/, '要先確認前方沒有障礙，真實的機器人才會動'],
  [/^the request was more than 2 s old, so nothing was started: try again$/, '請求晚到了 2 s 以上，所以什麼也沒有啟動，請再試一次'],
  [/^Stop needs the token here, and this page has none$/, '在這裡停止機器人也需要權限，這個頁面沒有']];

export const WORDS = {
  // header
  title: '往返運動', robots: '機器人', facts: '機器人和地面', connecting: '正在連線',
  stop: '停止', stopOne: robot => `停止 ${robot}`, escape: 'Esc',
  robot: '機器人', simulated: '模擬', real: '真實', surface: '地面', seed: '隨機種子', time: '時間',
  factor: factor => factor ? `模擬，實際時間的 ${factor} 倍` : '模擬',
  connected: '已連線', watching: '已連線，只能看',
  silent: '沒有回應：頁面顯示的不是機器人現在的位置',
  lost: reason => `未連線${reason ? `（${reason}）` : ''}，正在重試`,

  // methods; the node sends their titles
  drive: '方法', method: title => RUNS[title] || title,
  intro: '每種方法都讓機器人前進，掉頭，返回，再掉頭，這樣它應該回到出發時的位姿。「定時」按固定的時間運動。' +
    '「用里程計」等輪子測得的距離或角度達到目標才停下，但是輪子會打滑；陀螺儀還測量機器人轉了多少。',
  missed: (distance, angle, known) => `${known ? '' : '按照里程計，'}離起點 ${distance} m，航向差 ${angle}°`,
  needsFilter: method => `「${method}」需要濾波器：roslaunch rbx1_bringup odom_ekf.launch。`,
  noReset: '只有模擬的機器人才能重設。',
  noToken: '這個頁面不能驅動機器人。要驅動，需要一個網址：在能驅動機器人的頁面裡，按「再加一個瀏覽器」就會產生。',
  masterSilent: 'ROS 節點管理器（master）沒有回應。請重新啟動 roscore、底盤和 web_view.launch。',
  masterRestarted: 'ROS 節點管理器（master）重新啟動過。請重新啟動 web_view.launch。',
  noBase: '正在等待底盤。啟動一個：roslaunch rbx1_bringup fake_turtlebot.launch',
  running: name => `正在執行：${RUNS[name] || name}。先停止它，才能用其他按鈕。`,
  keysDrive: '方向鍵驅動機器人。',
  stoppedElsewhere: '已停止，不是從這個頁面停止的',
  outcome: (name, outcome) => `${name}：${outcome}`,
  said: text => SENTENCES.reduce((said, [english, chinese]) => said.replace(english, chinese), text),
  run: (name, stopped) => `${RUNS[name] || name}${stopped ? '，已停止' : ''}`,

  // Stop and other messages
  stopping: '正在停止。',
  notReached: '未連線：「停止」沒有送到機器人。請用手讓它停下。頁面會一直重發「停止」，直到有回應。',
  noAnswer: '沒有回應：機器人可能還在動。請用手讓它停下。頁面會一直重發「停止」，直到有回應。',
  refused: reason => `被拒絕：${reason}。`,
  rejected: {
    token: 'web_view.launch 重新啟動過，所以這個瀏覽器不能再驅動機器人：請開啟它印出的網址。',
    code: '這個網址已經用過，或者不完整，或者是 web_view.launch 以前某次啟動時印出的。'},
  invite: '再加一個瀏覽器', inviteHelp: '產生一個網址，讓另一個瀏覽器也能驅動機器人',
  invited: address => `給另一個瀏覽器的網址，開啟以後，那個瀏覽器也能驅動機器人：${address}`,
  realRobot: '這是真實的機器人', cancel: '取消', allow: '允許運動',
  confirmRun: '它會前進 1 m，再返回。前方要有 1.5 m 的空地，左右各要有 1 m。',
  confirmHand: '它會按方向鍵運動，鬆開就停。',

  // floor
  floor: '地面', floorHelp: '從上方看到的地面，x 軸向右。方向鍵移動畫面，+ 和 - 縮放。',
  zoomIn: '放大（+）', zoomOut: '縮小（-）', fit: '全部顯示', fitHelp: '顯示起點和所有路徑（0）',
  follow: '跟隨', followHelp: '讓機器人保持在中央（F）',
  arrows: '箭頭', arrowsHelp: '顯示或隱藏箭頭（A）',
  clear: '清除', clearHelp: '清除頁面上的路徑（C）',
  save: '儲存', saveHelp: '儲存圖片，並把這次執行的數值存成 CSV',
  large: '投影', largeHelp: '把地面和數字放大',
  legend: '要顯示的路徑', truth: '真值', odometry: '里程計', estimate: '估計值',
  meaning: {
    truth: '機器人真實的位姿，只有模擬才知道', odometry: '由輪子得到的位姿', estimate: '由輪子和陀螺儀得到的位姿'},
  earlier: '要顯示的以前的執行', showRun: number => `顯示第 ${number} 次執行`,
  mean: (name, number) => `${name}，${number} 次執行的平均`,
  withSeed: (surface, seed) => `${surface}，隨機種子 ${seed}`,
  earlierRuns: (kind, numbers) => `以前的執行（${kind}）：${numbers}`,
  numbers: (source, [x, y, heading, distance]) =>
    `${source}：x ${x} m，y ${y} m，航向 ${heading}°，離起點 ${distance} m`,

  // further controls
  more: '地面、重設和手動駕駛', resetFirst: '每次執行前重設', reset: '重設', byHand: '手動駕駛',
  distance: '距離（m）', speed: '速度（m/s）',
  pad: '按住以駕駛', forward: '前進', backward: '後退', left: '左轉', right: '右轉',

  // tables, plots, log
  poses: '機器人在哪裡', thisRun: name => `這次執行${name ? `：${RUNS[name] || name}` : ''}`, none: '–',
  poseHead: ['', 'x（m）', 'y（m）', '航向（°）', '離起點（m）'],
  runHead: ['', '執行', '地面', '離起點（m）', '航向（°）'],
  speeds: '速度隨時間的變化', window: '時間視窗', until: '截止', linear: '前進速度', angular: '角速度',
  linearAxis: '前進（m/s）', angularAxis: '轉動（rad/s），向左為正',
  commanded: '命令的', reported: '輪子報告的', true: '真實的',
  log: '日誌', logHelp: '最近的日誌',

  // the page of the teacher
  seats: '座位', seat: number => `座位 ${number}`, stopAll: '全部停止', floorOf: seat => `${seat} 的地面`,
  idle: '空閒', driving: name => `正在行駛：${RUNS[name] || name}`,
  seatsConnected: (number, all) => `${all} 個座位，已連線 ${number} 個`,
  teacherAddress: '請開啟 seats.py 最近一次印出的教師網址。第一個開啟它的瀏覽器才能使用。',

  // the page without ROS
  script: RUNS.script, scriptHelp: '腳本，可以修改', runScript: '執行腳本', restore: '恢復原樣',
  play: '播放', paces: ['實際速度', '5 倍速度', '20 倍速度', '立即顯示'],
  manyRuns: number => `執行 ${number} 次`, manyHelp: '多次執行的方法',
  noPython: reason => `無法載入 Python：${reason}`,
  onlyScripts: '在這個頁面裡，只有腳本驅動機器人',
  tooLong: seconds => `這次執行在 ${seconds} s 內沒有算完，所以腳本被終止了。`};

// script/traditional.py: 92a235b1
