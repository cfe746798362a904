"""What /proc says about the processes of a fault: found by a variable in their environment."""
import os
import time


def with_variable(name, value):
    """The ids of all processes that have this environment variable, except zombies, sorted."""
    found = []
    for pid in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open(f'/proc/{pid}/environ', 'rb') as file:      # empty for a zombie
                if (f'{name}={value}').encode() in file.read().split(b'\0'):
                    found.append(int(pid))
        except OSError:     # it has ended, or is somebody else's
            pass
    return sorted(found)


def commands(pids):
    """The command lines of processes, as text."""
    texts = []
    for pid in pids:
        try:
            with open('/proc/%d/cmdline' % pid, 'rb') as file:
                texts.append('%d %s' % (pid, file.read().replace(b'\0', b' ').decode(errors='replace')[:160]))
        except OSError:
            pass
    return '\n'.join(texts)


def wait_for_end(find, limit):
    """Wait until find() has no processes any more; returns how long that took, s. Raises AssertionError."""
    start = time.monotonic()
    while True:
        pids = find()
        if not pids:
            return time.monotonic() - start
        assert time.monotonic() < start + limit, f'still there after {limit:g} s:\n{commands(pids)}'
        time.sleep(0.02)


def is_python(pid):
    """Whether a process runs Python: rospy, roslaunch, the master. Other nodes are of roscpp."""
    return os.path.basename(os.readlink('/proc/%d/exe' % pid)).startswith('python')


def listening(pid):
    """The addresses that a process accepts TCP connections or UDP datagrams at, as (protocol, address in hex)."""
    inodes = set()
    for descriptor in os.listdir('/proc/%d/fd' % pid):
        try:
            inodes.add(os.readlink('/proc/%d/fd/%s' % (pid, descriptor)))
        except OSError:
            pass
    found = []
    for protocol in 'tcp', 'tcp6', 'udp', 'udp6':
        with open('/proc/%d/net/%s' % (pid, protocol), encoding='ascii') as file:
            for line in list(file)[1:]:
                fields = line.split()
                # TCP: 0A is LISTEN; UDP: 07 is not connected
                if f'socket:[{fields[9]}]' in inodes and fields[3] == ('0A' if protocol[:3] == 'tcp' else '07'):
                    found.append((protocol, fields[1].split(':')[0]))
    return found


def is_loopback(address):
    """Whether an address of /proc/net, hexadecimal in the machine's order (little-endian), is of this machine only."""
    if len(address) == 32 and address[:24] in (24 * '0', f"{16 * '0'}FFFF0000"):
        address = address[24:]
        if address == '01000000':       # ::1
            return True
    return len(address) == 8 and address.endswith('7F')
