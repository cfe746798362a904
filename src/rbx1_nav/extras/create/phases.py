"""The phases of the contact with a robot, and what may be sent in each: one table, which Sender.send() asks.

The guardian is a process of its own: it sends only its stop, after the node has died or while it hangs.
"""
from __future__ import annotations

from enum import Enum


class Kind(Enum):
    """What is sent, and who sends it."""

    SEARCH = 'bytes that no receiver can mistake for another command'       # Search
    STOP = 'a stop, alone or with the change to passive mode at the end'    # Driver, Contact
    START = 'a stop and the start of the interface'                         # Contact
    QUERY = 'a query'                                                       # Queries
    MODE = 'the request for the mode in which the robot is driven'          # Supervisor
    PANEL = 'lights and songs'                                              # Orders
    DOCK = 'a stop and the start of docking'                                # Orders
    SPEEDS = 'wheel speeds other than 0'                                    # Driver, from the CommandGate


class Phase(Enum):
    """What is known of the robot."""

    NO_LINE = 'no line'
    SEARCHING = 'robot or rate unknown'
    SILENT = 'known, does not answer'
    STARTED = 'known, was started, and has not answered since'
    WAITING = 'answers, is not in the mode in which it is driven'
    DRIVEN = 'answers, is in the mode in which it is driven'
    DOCKING = 'answers, drives itself onto its dock, in passive mode'
    LEAVING = 'the node exits'
    LEFT = 'the node exits, and the robot has confirmed that it stopped'


MAY_SEND: dict[Phase, set[Kind]] = {
    Phase.NO_LINE: set(),
    Phase.SEARCHING: {Kind.SEARCH},
    Phase.SILENT: {Kind.STOP, Kind.QUERY, Kind.START},
    Phase.STARTED: {Kind.STOP, Kind.QUERY},
    Phase.WAITING: {Kind.STOP, Kind.QUERY, Kind.MODE, Kind.DOCK},
    Phase.DRIVEN: {Kind.STOP, Kind.QUERY, Kind.MODE, Kind.DOCK, Kind.PANEL, Kind.SPEEDS},
    Phase.DOCKING: {Kind.STOP, Kind.QUERY, Kind.MODE, Kind.DOCK},
    Phase.LEAVING: {Kind.STOP, Kind.QUERY},
    Phase.LEFT: set()}
ANSWERING = {Phase.WAITING, Phase.DRIVEN, Phase.DOCKING}
