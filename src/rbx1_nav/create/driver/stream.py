"""Decodes bytes from the robot to readings."""
from __future__ import annotations

from operator import le
from typing import Dict, Iterable, Sequence, Tuple

from rbx1_nav.create import protocol

Reading = Dict[str, int]        # values by the name of the packet
Numbers = Tuple[int, ...]       # of packets and groups


class Ranges:
    """The ranges of the values of Packets."""

    def __init__(self, packets: Iterable[protocol.Packet]) -> None:
        packets = list(packets)
        self.low = [packet.low for packet in packets]
        self.high = [packet.high for packet in packets]

    def contain(self, values: Sequence[int]) -> bool:
        """Return whether each value is within the range of its Packet."""
        return all(map(le, self.low, values)) and all(map(le, values, self.high))


class FrameReader:
    """Finds the frames of the stream. After a failed checksum, it searches for the next frame byte by byte."""

    def __init__(self, model: protocol.Model, numbers: Numbers) -> None:
        """numbers: requested packets and groups."""
        self.format = protocol.frame_format(model, numbers)
        packets: list[protocol.Packet] = []
        self.indices: list[int] = []                # indices of the values in a frame
        self.markers: list[tuple[int, int]] = []    # (index, packet or group number) in a frame
        index = 2
        for number in numbers:
            self.markers.append((index, number))
            index += 1
            for packet in protocol.single_packets(model, [number]):
                packets.append(packet)
                self.indices.append(index)
                index += 1
        self.names = [packet.name for packet in packets]
        self.ranges = Ranges(packets)
        self.start = bytes((protocol.FRAME_HEADER, self.format.size - 3))
        self.buffer = bytearray()
        self.in_step = False    # whether the bytes before the buffer were a good frame
        self.rejected = 0       # number of corrupted frames
        self.skipped = 0        # number of bytes outside good frames

    def clear(self) -> None:
        """Discard an incomplete frame."""
        self.buffer.clear()
        self.in_step = False

    @property
    def missing(self) -> int:
        """The number of bytes that complete the next frame."""
        return self.format.size - len(self.buffer)

    def feed(self, data: bytes) -> list[Reading]:
        """Return the readings that these bytes complete."""
        buffer = self.buffer
        readings: list[Reading] = []
        buffer += data
        while True:
            begin = buffer.find(self.start)
            if begin < 0:       # keep the last byte if a frame may begin with it
                begin = len(buffer) - (1 if buffer.endswith(self.start[:1]) else 0)
            self._skip(begin)
            if len(buffer) < self.format.size:
                return readings
            reading = self.decode(bytes(buffer[:self.format.size]))
            if reading is None:
                self.in_step = True     # count this frame as corrupted
                self._skip(1)
            else:
                readings.append(reading)
                del buffer[:self.format.size]
                self.in_step = True

    def _skip(self, count: int) -> None:
        """Drop bytes. Up to the next good frame or the next header, they count as one corrupted frame."""
        if count:
            if self.in_step:
                self.rejected += 1
            self.skipped += count
            self.in_step = False
            del self.buffer[:count]

    def decode(self, frame: bytes) -> Reading | None:
        """Return the reading in a frame; None if the frame is corrupted."""
        fields = self.format.unpack(frame)
        values = [fields[index] for index in self.indices]
        if sum(frame) & 0xff or any(fields[index] != number for index, number in self.markers) or (
                not self.ranges.contain(values)):
            return None
        return dict(zip(self.names, values))


class Layout:
    """The layout of the reply to a query."""

    def __init__(self, model: protocol.Model, numbers: Numbers) -> None:
        packets = protocol.single_packets(model, numbers)
        self.names = [packet.name for packet in packets]
        self.ranges = Ranges(packets)
        self.format = protocol.packets_format(packets)


class ReplyReader:
    """Decodes the reply to a query.

    A reply has neither header nor checksum. It is checked only by its length and the ranges of its values.
    """

    def __init__(self, model: protocol.Model, *queries: Numbers) -> None:
        """queries: the packets and groups of each possible query."""
        self.layouts = {numbers: Layout(model, numbers) for numbers in queries}
        self.layout = self.layouts[queries[0]]  # layout of the expected reply
        self.buffer = bytearray()
        self.waiting = False    # whether a reply is expected
        self.rejected = 0       # number of rejected replies
        self.skipped = 0        # number of bytes outside replies

    def clear(self) -> None:
        """Discard an incomplete reply, and stop expecting one."""
        self.skipped += len(self.buffer)
        self.buffer.clear()
        self.waiting = False

    def expect(self, numbers: Numbers) -> None:
        """Expect the reply to a query that was sent: the next bytes. numbers: one of `queries`."""
        self.clear()
        self.layout = self.layouts[numbers]
        self.waiting = True

    @property
    def missing(self) -> int:
        """The number of bytes that complete the reply."""
        return self.layout.format.size - len(self.buffer) if self.waiting else 0

    def feed(self, data: bytes) -> list[Reading]:
        """Return the readings, at most one, that these bytes complete."""
        self.buffer += data
        layout = self.layout
        if not self.waiting or len(self.buffer) < layout.format.size:
            return []
        values = layout.format.unpack(bytes(self.buffer[:layout.format.size]))
        reading = dict(zip(layout.names, values))
        if layout.ranges.contain(values) and len(self.buffer) == layout.format.size and (
                protocol.MIN_VOLTAGE <= reading['voltage'] <= protocol.MAX_VOLTAGE):
            self.buffer.clear()
            self.waiting = False
            return [reading]
        self.rejected += 1
        self.clear()
        return []
