"""Makes runs on the workers of a Dask scheduler, on any number of machines with a common file system."""

import collections
import itertools

from .input import InputError
from .run import failed, perform

# Number of runs that the scheduler has at a time: more than any cluster has workers, but few enough for its memory.
IN_FLIGHT = 2000


def connect(address):
    """Connects to `address`: tcp://HOST:PORT, or a file FILE.json that a scheduler writes; waits for that file."""
    try:
        from distributed import Client
    except ImportError:
        raise InputError("--scheduler needs Debian's python3-distributed, which is not installed") from None
    try:
        if address.endswith(".json"):
            return Client(scheduler_file=address, timeout=10)
        return Client(address, timeout=10)
    except (OSError, ValueError) as error:
        raise InputError("--scheduler: cannot connect to '%s': %s" % (address, error)) from None


def reason_of(error):
    """Why a run failed. Dask's own text for a dead worker contains names that differ from sweep to sweep."""
    if type(error).__name__ == "KilledWorker":
        return "its worker died more often than the scheduler allows"
    return "%s: %s" % (type(error).__name__, error)


def perform_all(job, runs, address, retries):
    """Yields pairs (number of the run, Outcome) in the order in which runs end.

    runs: arguments of perform(), of which the number is the first. If a worker dies, the scheduler repeats its run, as
    often as its setting `allowed-failures` allows; it counts each run that waits for that worker. After that the run
    is submitted again, up to `retries` times. Then the run has failed.
    """
    with connect(address) as client:
        from distributed import as_completed
        from distributed.scheduler import KilledWorker

        submitted, deaths = {}, collections.Counter()
        runs = iter(runs)

        def submit(run):
            # Arguments are small, so each run gets its own. Data that is scattered would die with its worker.
            future = client.submit(perform, job, *run, pure=False)
            submitted[future.key] = run
            return future

        completed = as_completed([submit(run) for run in itertools.islice(runs, IN_FLIGHT)])
        for future in completed:
            run = submitted.pop(future.key)
            if future.status == "cancelled":
                raise ConnectionError("the scheduler at '%s' is gone" % address)
            error = future.exception()
            if isinstance(error, KilledWorker) and deaths[run[0]] < retries:
                deaths[run[0]] += 1
                completed.add(submit(run))
                continue
            for following in itertools.islice(runs, 1):
                completed.add(submit(following))
            yield run[0], failed(job, reason_of(error)) if error else future.result()
