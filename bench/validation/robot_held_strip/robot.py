"""Kinematics of the robot (Franka Emika Panda), and what its logs say about the strip."""

import numpy

# Modified Denavit-Hartenberg parameters of the maker's documentation, and the flange [m, rad].
LENGTHS = 0, 0, 0, 0.0825, -0.0825, 0, 0.088
OFFSETS = 0.333, 0, 0.316, 0, 0.384, 0, 0
TWISTS = 0, -numpy.pi / 2, numpy.pi / 2, numpy.pi / 2, -numpy.pi / 2, numpy.pi / 2, numpy.pi / 2
FLANGE = 0.107


def joint_frames(angles):
    """Frames of the seven joints in the base, shape (7, 4, 4). angles: shape (7,) [rad]."""
    frames, frame = [], numpy.eye(4)
    for length, offset, twist, angle in zip(LENGTHS, OFFSETS, TWISTS, angles):
        c, s, ct, st = numpy.cos(angle), numpy.sin(angle), numpy.cos(twist), numpy.sin(twist)
        frame = frame @ [[c, -s, 0, length], [s * ct, c * ct, -st, -offset * st], [s * st, c * st, ct, offset * ct],
                         [0, 0, 0, 1]]
        frames.append(frame)
    return numpy.array(frames)


class Log:
    """A log of the robot with the strip.

    times: from its first row on, a row each millisecond, without lost ones [s]
    position: of the flange along the strip's thickness, from the start on [m]
    rest: the time after which the robot stands still [s]
    force: of the strip on the flange, through the thickness, apart from a constant, from the torque of `joint` [N]
    """

    def __init__(self, path, joint):
        table = numpy.genfromtxt(path, delimiter=",", skip_header=1)
        recorded = 1e-3 * (table[:, 0] - table[0, 0])
        self.times = numpy.arange(0, recorded[-1], 1e-3)
        angles, rates, torques = (
            numpy.column_stack([numpy.interp(self.times, recorded, column) for column in table[:, part].T])
            for part in (slice(2, 9), slice(16, 23), slice(30, 37)))
        frames = joint_frames(angles[-1])
        through = -frames[-1, :3, 2]  # the thickness is the flange's axis; x' = -x of the strip's frame, so z' = -z
        self.position = numpy.array([self._flange(row) for row in angles[::10]]) @ through
        self.position -= self.position[0]
        self.rest = self.times[numpy.flatnonzero(abs(rates).max(axis=1) > 0.05)[-1]]
        axis, origin = frames[joint - 1, :3, 2], frames[joint - 1, :3, 3]
        lever = numpy.cross(axis, self._flange(angles[-1]) - origin) @ through
        self.force = -torques[:, joint - 1] / lever

    @staticmethod
    def _flange(angles):
        frame = joint_frames(angles)[-1]
        return frame[:3, 3] + FLANGE * frame[:3, 2]

    def write_motion(self, path):
        """Writes the flange's motion for the scene, smoothed over 50 ms."""
        from scipy.signal import savgol_filter
        times = self.times[::10]
        position, rate = (savgol_filter(self.position, 5, 3, deriv=order, delta=times[1]) for order in (0, 1))
        rate[0] = rate[-1] = 0
        numpy.savetxt(path, numpy.column_stack([times, position, rate]), "%.9g", ",", header="time,position,rate",
                      comments="")
