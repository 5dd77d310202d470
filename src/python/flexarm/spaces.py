"""Classes of gymnasium that environments use; if gymnasium is not installed, small replacements with these names."""

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
            """Seeds sample()."""
            self._random = numpy.random.default_rng(seed)

        def sample(self) -> numpy.ndarray:
            """A random array: uniform between two bounds, exponential with one bound, normal without bounds."""
            below, above = numpy.isfinite(self.low), numpy.isfinite(self.high)
            low, high = numpy.where(below, self.low, 0), numpy.where(above, self.high, 0)
            beyond = self._random.exponential(size=self.shape)
            one_sided = numpy.where(below, low + beyond, high - beyond)
            bounded = low + self._random.uniform(size=self.shape) * (high - low)
            free = self._random.normal(size=self.shape)
            sample = numpy.where(below & above, bounded, numpy.where(below | above, one_sided, free))
            return sample.astype(self.dtype)

        def contains(self, x: typing.Any) -> bool:
            """Whether the array `x` is in the space."""
            x = numpy.asarray(x)
            return x.shape == self.shape and bool(numpy.all((self.low <= x) & (x <= self.high)))

        __contains__ = contains

        def __eq__(self, other: object) -> bool:
            return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                    and bool(numpy.all(self.low == other.low) and numpy.all(self.high == other.high)))

        def __repr__(self) -> str:
            return "Box(%s, %s, %s, %s)" % (self.low.min(initial=0), self.high.max(initial=0), self.shape, self.dtype)

    class Env:  # type: ignore[no-redef]
        """The base class of environments."""

        metadata: typing.Dict[str, typing.Any] = {"render_modes": []}
        render_mode = None
        spec = None
        _random: typing.Optional[numpy.random.Generator] = None

        @property
        def np_random(self) -> numpy.random.Generator:
            """The random generator of `start`."""
            if self._random is None:
                self._random = numpy.random.default_rng()
            return self._random

        @property
        def unwrapped(self) -> "Env":
            """The environment itself, which has no wrapper."""
            return self

        def reset(self, *, seed: typing.Optional[int] = None, options: typing.Any = None) -> typing.Any:
            """Seeds the generator; None: the generator goes on."""
            if seed is not None:
                self._random = numpy.random.default_rng(seed)

        def close(self, **options: typing.Any) -> None:
            """Releases resources."""
            self.close_extras()

        def close_extras(self, **options: typing.Any) -> None:
            """Releases the resources of a subclass."""

    class VectorEnv(Env):  # type: ignore[no-redef]
        """Several environments as one."""

    def batch_space(space: Box, n: int = 1) -> Box:  # type: ignore[misc]
        """The space of n arrays, as the rows of one array."""
        return Box(space.low, space.high, (n, *space.shape), space.dtype)


# After an episode has ended, the next step begins a new one and ignores its action.
AUTORESET: typing.Dict[str, typing.Any] = {"autoreset_mode": "NextStep"}
if gymnasium is not None and hasattr(gymnasium.vector, "AutoresetMode"):
    AUTORESET = {"autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}


def register(name: str, one: str, several: str) -> None:
    """Registers classes ("module:Class") for gymnasium.make() and make_vec(), if gymnasium is installed."""
    if gymnasium is not None:
        gymnasium.register(id=name, entry_point=one, vector_entry_point=several)
