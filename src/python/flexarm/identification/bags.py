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
                yield _seconds(stamp if stamp.to_nsec() else received), message
    except (OSError, rosbag.ROSBagException) as error:
        raise InputError("%s: cannot be read as a bag: %s" % (path, error)) from None


def _seconds(stamp):
    """The time of a stamp [s]. Bags have no time 0: the simulator writes the smallest time that they have."""
    return stamp.to_sec() if stamp.to_nsec() > 1 else 0.0


def columns_at(path, times):
    """Columns of the topics /tf and /sensors/NAME at some times, by names: frame/NAME/x to qw in the frame that carries
    all others, sensor/NAME/fx to mz. Frames are interpolated; sensors keep their last sample."""
    edges, wrenches = {}, {}
    with _rosbag(path).Bag(path) as bag:
        topics = [topic for topic in bag.get_type_and_topic_info().topics
                  if topic in ("/tf", "/tf_static") or topic.startswith("/sensors/")]
        for topic, message, _ in bag.read_messages(topics) if topics else ():
            if topic in ("/tf", "/tf_static"):
                for transform in message.transforms:
                    _, at, poses = edges.setdefault(transform.child_frame_id, (transform.header.frame_id, [], []))
                    place, turn = transform.transform.translation, transform.transform.rotation
                    at.append(_seconds(transform.header.stamp))
                    poses.append((place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w))
            elif hasattr(message, "wrench"):
                at, samples = wrenches.setdefault(topic[len("/sensors/"):], ([], []))
                at.append(_seconds(message.header.stamp))
                samples.append([getattr(getattr(message.wrench, field), axis) for field, axis in WRENCH.values()])
    columns = {}
    for name, poses in frames_at({child: (parent, numpy.array(at), numpy.array(poses))
                                  for child, (parent, at, poses) in edges.items()}, times).items():
        columns.update(("frame/%s/%s" % (name, part), poses[:, k])
                       for k, part in enumerate(("x", "y", "z", "qx", "qy", "qz", "qw")))
    for name, (at, samples) in wrenches.items():
        last = numpy.searchsorted(at, times + 1e-9, side="right") - 1
        held = numpy.where(last[:, None] >= 0, numpy.array(samples)[numpy.maximum(last, 0)], numpy.nan)
        columns.update(("sensor/%s/%s" % (name, part), held[:, k]) for k, part in enumerate(WRENCH))
    return columns


def frames_at(edges, times):
    """Poses x y z qx qy qz qw of frames at some times, shape (times, 7), by names, in the frame without a parent.

    edges: by names of frames, (name of the parent, times, poses in the parent, shape (times, 7)).
    """
    found = {}
    for start in edges:
        chain = [start]  # up to a frame that is known or has no parent; a circle of frames ends, too
        while chain[-1] in edges and chain[-1] not in found and edges[chain[-1]][0] not in chain:
            chain.append(edges[chain[-1]][0])
        here = found.setdefault(chain[-1], numpy.tile([0.0, 0, 0, 0, 0, 0, 1], (len(times), 1)))
        for name in reversed(chain[:-1]):
            _, at, poses = edges[name]
            here = found[name] = _composed(here, _interpolated(at, poses, times))
    return found


def _interpolated(at, poses, times):
    order = numpy.argsort(at, kind="stable")
    at, poses = at[order], poses[order].copy()
    signs = numpy.sign(numpy.einsum("ij,ij->i", poses[1:, 3:], poses[:-1, 3:]))
    poses[1:, 3:] *= numpy.cumprod(numpy.where(signs < 0, -1, 1))[:, None]
    out = numpy.transpose([numpy.interp(times, at, track) for track in poses.T])
    out[:, 3:] /= numpy.linalg.norm(out[:, 3:], axis=1)[:, None]
    return out


def _composed(first, second):
    """Poses that are given in other poses."""
    u, w, v, s = first[:, 3:6], first[:, 6:], second[:, 3:6], second[:, 6:]
    place = second[:, :3]
    turned = place + 2 * w * numpy.cross(u, place) + 2 * numpy.cross(u, numpy.cross(u, place))
    turn = numpy.hstack([w * v + s * u + numpy.cross(u, v), w * s - numpy.sum(u * v, axis=1, keepdims=True)])
    return numpy.hstack([first[:, :3] + turned, turn])


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
