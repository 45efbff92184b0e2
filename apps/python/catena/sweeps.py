"""Many designs of one scene, on any executor of concurrent.futures.

>>> import catena
>>> model = catena.Model(parameters={"length": 1})
>>> arm = model.body("arm", points={"tip": ["length", 0]})
>>> model.add(catena.Revolute(i="ground", j=arm))
>>> model.drive(catena.AbsoluteAngle(i=arm, value={"polynomial": [0, 1]}))
>>> model.analyse("kinematics", until=1, measures={"end": {"final": "arm.tip.x"}})
>>> result = catena.sweep(model.scene(), {"length": [1, 2, 3]})
>>> result["end"].round(4)
array([0.5403, 1.0806, 1.6209])

Threads share the processors of a machine, since the interpreter is free while scenes run; processes may be elsewhere.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence, Sized
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from . import _catena
from ._catena import SceneError
from .scenes import Scene, Value

if TYPE_CHECKING:
    import numpy as np
    import pandas

Design = dict[str, Value]

#: As many are kept in memory: two gigabytes.
MOST_DESIGNS = 10_000_000
_ELSEWHERE = "the analysis `sweep` of scenes has no list of them in memory"

#: Status of a design whose worker did not answer.
LOST = "lost"
#: Status of a design that is no scene: a length below zero, say.
INVALID = "invalid"


@dataclass(frozen=True)
class Failure:
    """A design without results: its number, its parameters, a status, and what is wrong."""

    number: int
    design: Design
    status: str
    message: str


@dataclass
class Sweep:
    """The designs of a sweep and what became of them, in the order of the designs."""

    designs: list[Design]
    #: "ok", the status of the analysis that was not solved, "invalid", or "lost" where a worker died.
    status: list[str]
    #: Measures by name; not a number where a design has none.
    measures: dict[str, np.ndarray[Any, Any]]
    failures: list[Failure] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.designs)

    def __getitem__(self, name: str) -> np.ndarray[Any, Any]:
        """The values of a measure, or of a parameter, by design."""
        import numpy

        if name in self.measures:
            return self.measures[name]
        if self.designs and name in self.designs[0]:
            return numpy.array([design[name] for design in self.designs])
        raise KeyError(f'no measure or parameter "{name}"; there are: {[*self.measures, *(self.designs or [{}])[0]]}')

    @property
    def ok(self) -> bool:
        """Whether all designs have results."""
        return not self.failures

    @property
    def lost(self) -> list[Design]:
        """Designs whose worker died: `sweep(scene, result.lost, executor=...)` runs them again."""
        return [failure.design for failure in self.failures if failure.status == LOST]

    def to_pandas(self) -> pandas.DataFrame:
        """A line for each design: parameters, measures, status."""
        import pandas

        frame = pandas.DataFrame(self.designs)
        for name, values in self.measures.items():
            frame[name] = values
        frame["status"] = self.status
        return frame

    def __repr__(self) -> str:
        return f"<Sweep: {len(self)} designs, {len(self.failures)} without results>"


#: Status, message and measures of one design.
_Answer = tuple[str, str, dict[str, float]]


def _run_one(scene: Scene, design: Design, only: str) -> _Answer:
    try:
        run = scene.run(design, only=only)
    except SceneError as error:
        return INVALID, str(error), {}
    measures = {}
    for analysis in run:
        for name, measure in analysis.measures.items():
            measures[name] = math.nan if measure["value"] is None else measure["value"]
    for analysis in run:
        if not analysis.ok:
            return analysis.status, analysis.message, measures
    return "ok", "", measures


def _run_some(scene: Scene, designs: Sequence[Design], only: str) -> list[_Answer]:
    """What a worker does."""
    return [_run_one(scene, design, only) for design in designs]


def designs_of(
    parameters: Mapping[str, Sequence[Value]] | Iterable[Mapping[str, Value]], together: bool
) -> list[Design]:
    """The designs that `parameters` stands for."""
    if not isinstance(parameters, Mapping):
        designs = [dict(design) for design in itertools.islice(parameters, MOST_DESIGNS + 1)]
        if len(designs) > MOST_DESIGNS:
            raise ValueError(f"more than {MOST_DESIGNS} designs are asked for: {_ELSEWHERE}")
        return designs
    for name, given in parameters.items():
        if isinstance(given, str) or not isinstance(given, Iterable):
            raise ValueError(f"parameter {name} needs a list of values, not {given!r}")
    values: dict[str, Any] = {
        name: given if isinstance(given, Sized) else list(itertools.islice(given, MOST_DESIGNS + 1))
        for name, given in parameters.items()
    }
    count = max(map(len, values.values()), default=0) if together else math.prod(map(len, values.values()))
    if count > MOST_DESIGNS:
        raise ValueError(f"{count} designs are asked for, more than {MOST_DESIGNS}: {_ELSEWHERE}")
    if together:
        lengths = {name: len(given) for name, given in values.items()}
        if len(set(lengths.values())) > 1:
            raise ValueError(f"parameters that change together need lists of one length: {lengths}")
        return [dict(zip(values, row, strict=True)) for row in zip(*values.values(), strict=True)]
    return [dict(zip(values, row, strict=True)) for row in itertools.product(*values.values())]


def sweep(
    scene: Scene,
    parameters: Mapping[str, Sequence[Value]] | Iterable[Mapping[str, Value]],
    *,
    executor: Executor | None = None,
    together: bool = False,
    only: str = "",
    at_once: int | None = None,
    patience: float | None = None,
    progress: Callable[[int, int], Any] | None = None,
) -> Sweep:
    """Runs a scene for many designs and collects the measures of its analyses.

    parameters  name -> values: every combination of them, or with `together` the first of each, the second ...; or a
                list of designs, name -> value each
    executor    concurrent.futures.ThreadPoolExecutor, ProcessPoolExecutor, mpi4py.futures.MPIPoolExecutor, that of
                dask (`client.get_executor()`), or any other with `submit`; none: here
    only        type of the analyses to run
    at_once     designs that a worker gets at once; chosen by itself unless it is given
    patience    seconds without any answer after which designs that are still out count as lost, for executors that do
                not notice that a worker died, as mpi4py's; none: there is no such limit
    progress    called with the number of designs done and the number of all

    A design that cannot be analysed, or whose worker died twice, is one of `.failures`, with the reason; the others
    count.
    """
    designs = designs_of(parameters, together)
    for number, design in enumerate(designs):
        for name, value in design.items():
            if not isinstance(value, str) and not math.isfinite(float(value)):
                raise ValueError(f"design {number}: parameter {name} is {value}, not a finite number")
    # One that is misspelt would be wrong in every design.
    names = dict.fromkeys(itertools.chain(scene.parameters, *designs))
    _catena.check_names(*scene.source()[:2], list(names))
    if at_once is None:
        # Some hundred parts of a sweep keep all workers busy to its end, and answers few.
        at_once = max(1, min(100, len(designs) // 200))
    if at_once < 1:
        raise ValueError("a worker gets at least one design at once")
    if patience is not None and not patience > 0:
        raise ValueError(f"patience is {patience}, not a time above zero")
    answers: list[_Answer | None] = [None] * len(designs)
    parts = [range(first, min(first + at_once, len(designs))) for first in range(0, len(designs), at_once)]
    done = 0

    def take(part: range, found: list[_Answer]) -> None:
        nonlocal done
        for number, answer in zip(part, found, strict=True):
            answers[number] = answer
        done += len(part)
        if progress:
            progress(done, len(designs))

    def lose(part: range, error: BaseException) -> None:
        reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        take(part, [(LOST, f"the worker that had this design did not answer: {reason}", {})] * len(part))

    if executor is None:
        for part in parts:
            take(part, _run_some(scene, [designs[number] for number in part], only))
    else:
        running: dict[Future[list[_Answer]], range] = {}

        def submit(to: Executor, part: range) -> Future[list[_Answer]] | None:
            try:
                future = to.submit(_run_some, scene, [designs[number] for number in part], only)
            except Exception as error:  # an executor that is broken takes no more
                lose(part, error)
                return None
            running[future] = part
            return future

        again: list[range] = []
        try:
            for part in parts:
                submit(executor, part)
            pending = set(running)
            while pending:
                finished, pending = wait(pending, timeout=patience, return_when=FIRST_COMPLETED)
                for future in finished:
                    problem = CancelledError() if future.cancelled() else future.exception()
                    if problem is None:
                        take(running[future], future.result())
                    else:
                        again.append(running[future])
                if not finished:
                    silence = TimeoutError(f"no answer from any worker in {patience} s")
                    for future in pending:
                        future.cancel()
                        lose(running[future], silence)
                    break
            # A worker that dies takes those that wait behind with it: each is tried once more, alone.
            for number in itertools.chain.from_iterable(again):
                one = range(number, number + 1)
                repeated = submit(executor, one)
                if repeated is None:
                    continue
                try:
                    take(one, repeated.result(patience))
                except (Exception, CancelledError) as error:
                    repeated.cancel()
                    lose(one, error)
        except BaseException:
            for future in running:
                future.cancel()
            raise
    return _collected(designs, [answer for answer in answers if answer is not None])


def _collected(designs: list[Design], answers: list[_Answer]) -> Sweep:
    import numpy

    names = dict.fromkeys(name for _, _, measures in answers for name in measures)
    measures = {name: numpy.array([found.get(name, math.nan) for _, _, found in answers]) for name in names}
    failures = [
        Failure(number, design, status, message)
        for number, (design, (status, message, _)) in enumerate(zip(designs, answers, strict=True))
        if status != "ok"
    ]
    return Sweep(designs, [status for status, _, _ in answers], measures, failures)
