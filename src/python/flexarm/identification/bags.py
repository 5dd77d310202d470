"""Reads measurements and commands from ROS bags."""

import contextlib
import os
import shutil
import struct
import tempfile

import numpy

from .inputs import InputError

JOINT_FIELDS = {"position": "position", "velocity": "velocity", "effort": "effort"}
WRENCH = {"%s%s" % (short, axis): (field, axis) for short, field in (("f", "force"), ("m", "torque")) for axis in "xyz"}


def is_bag(path):
    return os.path.splitext(path)[1] == ".bag"


def _rosbag(path):
    try:
        import rosbag
    except ImportError:
        raise InputError("%s: bags are read by Debian's package python3-rosbag, which is missing" % path) from None
    return rosbag


def messages(path, topic):
    """Pairs (time [s], message) of a topic. The time is the message's stamp or, if it has none, the time of recording.

    Raises InputError if the bag has no messages on the topic.
    """
    rosbag = _rosbag(path)
    wanted = "/" + topic.lstrip("/")
    try:
        with rosbag.Bag(path) as bag:
            topics = sorted(bag.get_type_and_topic_info().topics)
            if wanted not in topics:
                raise InputError("%s: expected messages on '%s', got %s" % (
                    path, wanted, "the topics " + ", ".join(topics) if topics else "none"))
            for _, message, received in bag.read_messages(wanted):
                stamp = message.header.stamp if hasattr(message, "header") else received
                yield (stamp if stamp.to_nsec() else received).to_sec(), message
    except (OSError, rosbag.ROSBagException) as error:
        raise InputError("%s: cannot be read as a bag: %s" % (path, error)) from None


def _has_lost_its_end(path):
    rosbag = _rosbag(path)
    try:
        with rosbag.Bag(path):
            return False
    except rosbag.ROSBagUnindexedException:
        return True
    except (OSError, rosbag.ROSBagException):  # told when it is read
        return False


@contextlib.contextmanager
def whole(path, losses):
    """A path at which the bag can be read: its own, or that of a copy with a new index if it has lost its end.

    losses: a sentence about that is appended; None: the bag's own path in any case.
    """
    if losses is None or not _has_lost_its_end(path):
        yield path
        return
    rosbag = _rosbag(path)
    with tempfile.TemporaryDirectory(prefix="flexarm_") as folder:
        copy = os.path.join(folder, os.path.basename(path))
        shutil.copyfile(path, copy)
        try:
            with rosbag.Bag(copy, "a", allow_unindexed=True) as bag:
                for _ in bag.reindex():
                    pass
        except (OSError, ValueError, struct.error, rosbag.ROSBagException) as error:
            raise InputError("%s: has lost its end, and nothing can be read: %s" % (path, error)) from None
        losses.append("%s has lost its end: messages are missing" % path)
        yield copy


def origin(path):
    """The fields `scene` and `scene_options` that `flexarm simulate` writes; None where they are missing."""
    found = {}

    def take(topic, datatype, md5sum, definition, header):
        found.update(header)
        return False

    with _rosbag(path).Bag(path) as bag:
        for _ in bag.read_messages("/tf_static", connection_filter=take):
            pass
    return [value.decode() if isinstance(value, bytes) else value
            for value in map(found.get, ("scene", "scene_options"))]


def read_columns(path, columns, topic):
    """Reads columns of a plan: joint/NAME/position, velocity or effort from the topic of joint states;
    sensor/NAME/strain and sensor/NAME/fx to mz from the topics /sensors/NAME.

    Returns a dictionary of pairs (times, values) by names of columns.
    """
    series = {}
    joints = {}
    for column in columns:
        kind, _, rest = column.data.partition("/")
        name, _, quantity = rest.rpartition("/")
        if kind == "joint" and quantity in JOINT_FIELDS:
            joints[column.name] = (column.entry, name, quantity)
        elif kind == "sensor" and (quantity == "strain" or quantity in WRENCH):
            series[column.name] = _sensor(path, name, quantity)
        else:
            raise column.entry.error("a bag has joint/NAME/position, velocity and effort, sensor/NAME/strain and "
                                     "sensor/NAME/fx to mz, not '%s'" % column.data)
    if joints:
        series.update(_joints(path, topic, joints))
    return series


def _joints(path, topic, wanted):
    series = {column: ([], []) for column in wanted}
    for time, message in messages(path, topic):
        for column, (_, joint, quantity) in wanted.items():
            values = getattr(message, JOINT_FIELDS[quantity])
            if joint in message.name and len(values) == len(message.name):
                series[column][0].append(time)
                series[column][1].append(values[message.name.index(joint)])
    for column, (entry, joint, quantity) in wanted.items():
        if not series[column][0]:
            raise entry.error("expected messages on '%s' with the %s of '%s', got none in '%s'"
                              % (topic, quantity, joint, path))
    return {column: (numpy.array(times), numpy.array(values)) for column, (times, values) in series.items()}


def _sensor(path, name, quantity):
    rows = []
    for time, message in messages(path, "/sensors/" + name):
        try:
            value = message.strain if quantity == "strain" else getattr(getattr(message.wrench, WRENCH[quantity][0]),
                                                                        WRENCH[quantity][1])
        except AttributeError:
            raise InputError("%s: expected messages on '/sensors/%s' with '%s', got %s"
                             % (path, name, quantity, message._type)) from None
        rows.append((time, value))
    times, values = numpy.array(rows).T
    return times, values


def read_efforts(path, topic, entry):
    """Reads efforts from a topic of joint states or of joint force commands.

    Returns a dictionary of (times, efforts, lifetimes) by names of joints. For joint states, the lifetimes are None.
    """
    found = {}
    for time, message in messages(path, topic):
        is_command = message._type == "flexarm/JointForceCommand"
        if not is_command and message._type != "sensor_msgs/JointState":
            raise entry.error("expected messages of flexarm/JointForceCommand or sensor_msgs/JointState on '%s', got %s"
                              % (topic, message._type))
        names, efforts = (message.names, message.efforts) if is_command else (message.name, message.effort)
        lifetime = (message.duration.to_sec() or numpy.inf) if is_command else None
        for name, effort in zip(names, efforts):
            times, values, lifetimes = found.setdefault(name, ([], [], [] if is_command else None))
            times.append(time)
            values.append(effort)
            if is_command:
                lifetimes.append(lifetime)
    if not found:
        raise entry.error("expected efforts on '%s', got none in '%s'" % (topic, path))
    return found
