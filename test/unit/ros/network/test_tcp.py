"""The state of a TCP connection that the kernel reports, over the loopback interface."""


from rbx1_nav.ros.network.tcp import AcknowledgementTimer, Connection


def test_silence_begins_when_something_is_to_be_acknowledged_and_ends_with_an_acknowledgement():
    timer = AcknowledgementTimer()
    for now, unacknowledged, acknowledged, silence in ((10, 0, 100, 0), (11, 52, 100, 0), (11.5, 104, 100, 0.5),
                                                       (13, 104, 100, 2), (14, 52, 152, 0), (15, 52, 152, 0),
                                                       (16, 52, 152, 1), (17, 0, 204, 0)):
        assert timer.silence(now, Connection(True, unacknowledged, acknowledged, 65536)) == silence
