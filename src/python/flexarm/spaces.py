"""What environments take from gymnasium; where it is not installed, small equals of the same names."""

import typing

import numpy

__all__ = ["AUTORESET", "Box", "Env", "VectorEnv", "batch_space", "gymnasium", "register"]

try:
    import gymnasium
    from gymnasium import Env
    from gymnasium.spaces import Box
    from gymnasium.vector import VectorEnv
    from gymnasium.vector.utils import batch_space
except ImportError:
    gymnasium = None  # type: ignore[assignment]

    class Box:  # type: ignore[no-redef]
        """Arrays of the shape `shape` between `low` and `high`, which may be infinite."""

        def __init__(self, low: typing.Any, high: typing.Any, shape: typing.Sequence[int], dtype: typing.Any) -> None:
            self.shape, self.dtype = tuple(shape), numpy.dtype(dtype)
            self.low = numpy.broadcast_to(numpy.asarray(low, dtype), self.shape)
            self.high = numpy.broadcast_to(numpy.asarray(high, dtype), self.shape)
            self.seed()

        def seed(self, seed: typing.Optional[int] = None) -> None:
            """Of sample()."""
            self._random = numpy.random.default_rng(seed)

        def sample(self) -> numpy.ndarray:
            """Uniform between bounds, exponential beyond one of them, normal where there is none."""
            below, above = numpy.isfinite(self.low), numpy.isfinite(self.high)
            low, high = numpy.where(below, self.low, 0), numpy.where(above, self.high, 0)
            beyond = self._random.exponential(size=self.shape)
            one_sided = numpy.where(below, low + beyond, high - beyond)
            bounded = low + self._random.uniform(size=self.shape) * (high - low)
            free = self._random.normal(size=self.shape)
            sample = numpy.where(below & above, bounded, numpy.where(below | above, one_sided, free))
            return sample.astype(self.dtype)

        def contains(self, x: typing.Any) -> bool:
            """Whether an array is one of them."""
            x = numpy.asarray(x)
            return x.shape == self.shape and bool(numpy.all((self.low <= x) & (x <= self.high)))

        __contains__ = contains

        def __eq__(self, other: object) -> bool:
            return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                    and bool(numpy.all(self.low == other.low) and numpy.all(self.high == other.high)))

        def __repr__(self) -> str:
            return "Box(%s, %s, %s, %s)" % (self.low.min(initial=0), self.high.max(initial=0), self.shape, self.dtype)

    class Env:  # type: ignore[no-redef]
        """What both kinds of environments have."""

        metadata: typing.Dict[str, typing.Any] = {"render_modes": []}
        render_mode = None
        spec = None
        _random: typing.Optional[numpy.random.Generator] = None

        @property
        def np_random(self) -> numpy.random.Generator:
            """The generator that `start` is given."""
            if self._random is None:
                self._random = numpy.random.default_rng()
            return self._random

        @property
        def unwrapped(self) -> "Env":
            """Itself."""
            return self

        def reset(self, *, seed: typing.Optional[int] = None, options: typing.Any = None) -> typing.Any:
            """Seeds the generator, None: it goes on."""
            if seed is not None:
                self._random = numpy.random.default_rng(seed)

        def close(self, **options: typing.Any) -> None:
            """Lets go of what it holds."""
            self.close_extras()

        def close_extras(self, **options: typing.Any) -> None:
            """Of a class that holds something."""

    class VectorEnv(Env):  # type: ignore[no-redef]
        """Several environments as one."""

    def batch_space(space: Box, n: int = 1) -> Box:  # type: ignore[misc]
        """Of an array for each of n."""
        return Box(space.low, space.high, (n, *space.shape), space.dtype)


# An environment that has ended begins anew by the next step, whose action counts for nothing.
AUTORESET: typing.Dict[str, typing.Any] = {"autoreset_mode": "NextStep"}
if gymnasium is not None and hasattr(gymnasium.vector, "AutoresetMode"):
    AUTORESET = {"autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}


def register(name: str, one: str, several: str) -> None:
    """Makes classes ("module:Class") known to gymnasium.make() and make_vec(), where there is one."""
    if gymnasium is not None:
        gymnasium.register(id=name, entry_point=one, vector_entry_point=several)
