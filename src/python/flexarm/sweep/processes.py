"""Runs in processes of this machine, each of which may die without harm to the others."""

import collections
import multiprocessing
import multiprocessing.connection
import signal

from .run import failed, perform


def work(job, connection):
    """What a process does: performs what it is sent, until there is nothing more or nobody."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to all; who has started this one decides
    try:
        while True:
            run = connection.recv()
            connection.send(perform(job, *run))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass


class Worker:
    """A process and the run that it has."""

    # A fork would have the other processes' ends of pipes: they would not notice the death of this one.
    _context = multiprocessing.get_context("spawn")

    def __init__(self, job):
        self.connection, other = self._context.Pipe()
        self._process = self._context.Process(target=work, args=(job, other), daemon=True)
        self._process.start()
        other.close()
        self.run = None

    def begin(self, run):
        self.run = run
        try:
            self.connection.send(run)
        except (BrokenPipeError, ConnectionResetError):
            pass  # it is dead: outcome() says so

    def outcome(self):
        """Of its run; raises EOFError if the process has died."""
        try:
            return self.connection.recv()
        except OSError:  # in the middle of it
            raise EOFError from None

    def death(self):
        """What ended a process that is dead."""
        self._process.join()
        code = self._process.exitcode
        return "signal %d" % -code if code < 0 else "exit status %d" % code

    def end(self):
        self._process.kill()
        self._process.join()
        self.connection.close()


def perform_all(job, runs, workers, retries):
    """Yields pairs of the number of a run and its Outcome, as they come.

    runs: arguments of perform(), the number being the first. workers: how many processes.
    retries: how often a run is repeated whose process has died, before that is its outcome.
    """
    waiting = collections.deque(runs)
    deaths = collections.Counter()
    busy = {}  # workers by their connections
    try:
        for _ in range(min(workers, len(waiting))):
            start(Worker(job), waiting, busy)
        while busy:
            for connection in multiprocessing.connection.wait(list(busy)):
                worker = busy.pop(connection)
                run, number = worker.run, worker.run[0]
                try:
                    outcome = worker.outcome()
                except EOFError:
                    reason = worker.death()
                    worker.end()
                    worker = Worker(job)
                    deaths[number] += 1
                    if deaths[number] <= retries:
                        waiting.appendleft(run)
                        outcome = None
                    else:
                        outcome = failed(job, "its process died of %s, %d times" % (reason, deaths[number]))
                start(worker, waiting, busy)
                if outcome:
                    yield number, outcome
    finally:
        for worker in busy.values():
            worker.end()


def start(worker, waiting, busy):
    """The next run, or the end of the process."""
    if waiting:
        worker.begin(waiting.popleft())
        busy[worker.connection] = worker
    else:
        worker.end()
