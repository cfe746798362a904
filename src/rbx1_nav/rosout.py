"""Logging that does not depend on the master."""
import logging
import logging.handlers
import queue

from rospy.impl.rosout import RosOutHandler


def decouple():
    """Let a thread of its own pass what the node says on to /rosout. Call after init_node.

    rospy asks the master for a parameter on the way there, so that a master that hangs would hang whoever says
    something: a robot must not depend on that. What is printed on the terminal is not touched.
    """
    logger = logging.getLogger('rosout')
    for handler in [each for each in logger.handlers if isinstance(each, RosOutHandler)]:
        records = queue.SimpleQueue()
        logger.removeHandler(handler)
        logger.addHandler(logging.handlers.QueueHandler(records))
        logging.handlers.QueueListener(records, handler).start()
