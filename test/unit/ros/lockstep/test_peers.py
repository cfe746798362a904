"""The process at the other end of a connection, and the process that listens, tested with real processes."""
import socket

from rbx1_nav.ros.lockstep.peers import listening_process, peer_process
from test_processes import make_start       # noqa: F401, a fixture


def test_the_process_at_the_other_end(start):
    with socket.socket() as server:
        server.bind(('127.0.0.1', 0))
        server.listen()
        child = start('s = socket.create_connection(("127.0.0.1", %d))\nsys.stdin.read()' % server.getsockname()[1])
        connection, _ = server.accept()
        with connection:
            assert peer_process(connection).folder == '/proc/%d/task/' % child.pid
        assert peer_process(connection) is None     # closed
        # this process itself must not be waited for
        with socket.create_connection(server.getsockname()) as own:
            accepted, _ = server.accept()
            with accepted:
                assert peer_process(own) is None and peer_process(accepted) is None


def test_the_process_that_listens(start):
    child = start('s = socket.socket()\ns.bind(("0.0.0.0", 0))\ns.listen()\nprint(s.getsockname()[1], flush=True)\n'
                  'sys.stdin.read()')
    port = int(child.stdout.readline())
    assert listening_process(port).folder == '/proc/%d/task/' % child.pid
    child.kill()
    child.wait()
    assert listening_process(port) is None
