#!/usr/bin/env python3
"""Connect clients to the web view that read every frame, as browsers do, and run a command meanwhile. See README.md."""
import argparse
import asyncio
import json
import sys

from tornado.websocket import websocket_connect

START = 30  # s of wall time for the first frame of a client


async def read(port, ready):
    """Read frames without end. ready: a Future that is completed at the first frame."""
    socket = await websocket_connect(f'ws://localhost:{port}/socket')
    await socket.write_message(json.dumps({'type': 'hello', 'token': ''}))
    while True:
        text = await socket.read_message()
        if text is None:
            raise ConnectionError(f'closed by the view: {socket.close_reason}')
        if json.loads(text)['type'] == 'frame' and not ready.done():
            ready.set_result(None)


async def main():
    """Returns the exit status of the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('count', type=int, help='number of clients; at most 60 may connect without the token')
    parser.add_argument('command', nargs=argparse.REMAINDER, metavar='COMMAND', help='shell command')
    parser.add_argument('--port', type=int, default=8080, help='port of the web view; default: 8080')
    arguments = parser.parse_args()
    loop = asyncio.get_running_loop()
    ready = [loop.create_future() for _ in range(arguments.count)]
    readers = [asyncio.ensure_future(read(arguments.port, each)) for each in ready]
    if readers:
        # a reader ends only with an error
        done, _ = await asyncio.wait([asyncio.gather(*ready), *readers], timeout=START,
                                     return_when=asyncio.FIRST_COMPLETED)
        for each in done:
            each.result()
        if not done:
            sys.exit(f'browsers: not all of {arguments.count} clients have received a frame after {START} s')
    process = await asyncio.create_subprocess_shell(' '.join(arguments.command))
    status = await process.wait()
    for reader in readers:
        if reader.done():
            reader.result()
        reader.cancel()
    return status


if __name__ == '__main__':
    sys.exit(asyncio.run(main()))
