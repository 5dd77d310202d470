"""Makes runs in processes of this machine. If a process dies, the others are not affected."""

import collections
import multiprocessing
import multiprocessing.connection
import signal

from .run import failed, perform


def work(job, connection):
    """The main function of a process: makes the runs that it receives, until the connection is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes; the parent decides what happens
    try:
        while True:
            run = connection.recv()
            connection.send(perform(job, *run))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass


class Worker:
    """A process and its current run."""

    # Not "fork": a forked process would inherit the others' pipes, so that these would not notice when the parent dies.
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
            pass  # the process is dead, which outcome() reports

    def outcome(self):
        """The outcome of the current run; raises EOFError if the process has died."""
        try:
            return self.connection.recv()
        except OSError:  # the process died while it sent the outcome
            raise EOFError from None

    def death(self):
        """What ended the process, which must be dead."""
        self._process.join()
        code = self._process.exitcode
        return "signal %d" % -code if code < 0 else "exit status %d" % code

    def end(self):
        self._process.kill()
        self._process.join()
        self.connection.close()


def perform_all(job, runs, workers, retries):
    """Yields pairs (number of the run, Outcome) in the order in which runs end.

    runs: arguments of perform(), of which the number is the first. workers: number of processes.
    retries: how often a run is repeated if its process dies; after that the run has failed.
    """
    waiting = collections.deque(runs)
    deaths = collections.Counter()
    busy = {}  # workers by connection
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
    """Starts the next run on the worker, or ends the worker if no run is left."""
    if waiting:
        worker.begin(waiting.popleft())
        busy[worker.connection] = worker
    else:
        worker.end()
