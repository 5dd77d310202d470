"""Runs on the workers of a Dask scheduler, on any number of machines that see the same files."""

import collections
import itertools

from .input import InputError
from .run import failed, perform

# Runs that the scheduler has at a time: more than workers of any cluster, few enough to be kept in mind.
IN_FLIGHT = 2000


def connect(address):
    """`address`: tcp://HOST:PORT, or the file FILE.json that a scheduler writes, which is waited for."""
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
    """Dask's own text of a death has names that differ from sweep to sweep."""
    if type(error).__name__ == "KilledWorker":
        return "its worker died more often than the scheduler allows"
    return "%s: %s" % (type(error).__name__, error)


def perform_all(job, runs, address, retries):
    """Yields pairs of the number of a run and its Outcome, as they come.

    runs: arguments of perform(), the number being the first. A run whose worker dies is repeated by the scheduler, as
    often as its setting `allowed-failures` says; it counts all that wait for that worker. It is given them again
    `retries` times; then that is the outcome.
    """
    with connect(address) as client:
        from distributed import KilledWorker, as_completed

        submitted, deaths = {}, collections.Counter()
        runs = iter(runs)

        def submit(run):
            # Arguments are small, and go along with each run: what is scattered dies with its worker.
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
