"""The lights and songs of an emulated robot. All times are in ns."""
from __future__ import annotations

from rbx1_nav.base.units import SECOND


class Panel:
    """What an owner sees and hears. Each public method executes the command with its name."""

    def __init__(self, now: int) -> None:
        self.now = now
        self.lights = 0, 0, 0       # bits of the LEDs, color and brightness of the power LED
        self.songs: dict[int, bytes] = {}       # pairs of note and duration (1/64 s), by number
        self.number, self.end = 0, now      # the last song, and when it ends

    def leds(self, data: bytes) -> None:
        self.lights = data[0], data[1], data[2]

    def song(self, data: bytes) -> None:
        self.songs[data[0]] = data[2:]

    def play_song(self, data: bytes) -> None:
        """Play a song, unless one is playing (Create p. 12)."""
        if data[0] in self.songs and not self.is_playing:
            self.number, self.end = data[0], self.now + sum(self.songs[data[0]][1::2]) * SECOND // 64

    @property
    def is_playing(self) -> bool:
        return self.now < self.end
