"""Analyses that are stepped from Python.

>>> import catena
>>> model = catena.Model(parameters={"reach": 2})
>>> arm = model.body("arm", points={"tip": ["reach", 0]})
>>> model.add(catena.Revolute(i="ground", j=arm))
>>> model.drive(catena.AbsoluteAngle(name="motor", i=arm, value={"polynomial": [0, 1]}))
>>> kinematics = catena.Kinematics(model.scene(), outputs=["arm.tip.x"])
>>> kinematics.move_to(1.5)
>>> round(kinematics["arm.tip.x"], 6)
0.141474
>>> kinematics.drive("motor", 0)
>>> kinematics["arm.tip.x"]
2.0

Arrays show where the bodies are now: they follow the motion, and `.copy()` keeps what they show.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _catena
from .results import Analysis
from .scenes import Scene, Value

if TYPE_CHECKING:
    import numpy as np


class Machine:
    """What Kinematics, Dynamics and Equilibrium have in common. Numbers are in SI and radians."""

    _machine: _catena.Machine

    def follow(self, times: Iterable[float]) -> Analysis:
        """Goes to these instants, one after the other; a row at each. How that ended is told by the status."""
        return Analysis(self._machine.follow([float(t) for t in times]))

    def set(self, parameters: Mapping[str, float] | None = None, /, **more: float) -> None:
        """Changes parameters of the scene from the present state on: `set(length=0.2)`.

        Where the scene allows no such values SceneError is raised; where the mechanism cannot be assembled with them
        near where it is, AnalysisError; nothing is changed then.
        """
        self._machine.set({name: float(value) for name, value in {**(parameters or {}), **more}.items()})

    @property
    def parameters(self) -> dict[str, float]:
        """The present values of all parameters."""
        return dict(self._machine.parameters)

    @property
    def time(self) -> float:
        """The present instant, s."""
        return self._machine.time

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies, in the order of q."""
        return self._machine.bodies

    @property
    def q(self) -> np.ndarray[Any, Any]:
        """[x, y, angle] of the centroid of every body, m and rad; a view, which follows the motion."""
        return self._machine.q

    def frame(self, body: str | int) -> tuple[float, float, float]:
        """x, y and angle of the frame in which the points of a body are given; "ground" and -1 are the ground."""
        return self._machine.frame(body)

    @property
    def row(self) -> np.ndarray[Any, Any]:
        """Values of the columns after the last step; a view, which follows the motion."""
        return self._machine.row

    def __getitem__(self, column: str) -> float:
        """The value of a column after the last step."""
        return self._machine[column]

    @property
    def columns(self) -> list[str]:
        """Names of the columns; empty before the first step."""
        return self._machine.columns

    @property
    def notes(self) -> list[str]:
        """Why columns that were asked for are left out."""
        return self._machine.notes

    @property
    def warnings(self) -> list[str]:
        """Of the last step."""
        return self._machine.warnings

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self.bodies)} bodies, t = {self.time:.6g} s>"


class Kinematics(Machine):
    """A driven mechanism that is moved through time, forwards and backwards, from its given configuration at t = 0.

    outputs           columns; those of the scene unless they are named
    tolerance         of the equations of constraints
    inverse_dynamics  loads of drivers and reactions of joints are columns as well
    branch            which one is taken wherever several meet; 0: the motion continues along its own
    """

    _machine: _catena.Kinematics

    def __init__(
        self,
        scene: Scene,
        parameters: Mapping[str, Value] | None = None,
        *,
        outputs: Sequence[str] = (),
        tolerance: float = 1e-12,
        inverse_dynamics: bool = False,
        branch: int = 0,
    ) -> None:
        self._machine = _catena.Kinematics(
            *scene.source(parameters), list(outputs), tolerance, inverse_dynamics, branch
        )

    def move_to(self, t: float) -> None:
        """Follows the motion to an instant, forwards or backwards. AnalysisError where it cannot go there."""
        self._machine.move_to(t)

    def drive(self, driver: str, value: float, rate: float = 0.0) -> None:
        """Takes a driver to a value while time stands still, along the branch that the mechanism is on.

        From then on the driver's value changes at this rate, in place of the scene's function of time.
        """
        self._machine.drive(driver, value, rate)

    @property
    def qd(self) -> np.ndarray[Any, Any]:
        """[vx, vy, omega] of the centroid of every body, m/s and rad/s; a view, which follows the motion."""
        return self._machine.qd

    @property
    def qdd(self) -> np.ndarray[Any, Any]:
        """[ax, ay, alpha] of the centroid of every body, m/s^2 and rad/s^2, computed when asked for."""
        return self._machine.qdd


class Dynamics(Machine):
    """A motion that follows from forces, from the given configuration at t = 0.

    outputs    columns; those of the scene unless they are named
    method     of integration: see catena.explain("dynamics")
    tolerance  of the integration
    step       a fixed step, s; 0: chosen by the integrator

    Where contacts or friction take part every step begins anew with what touches then: columns of work and energy
    balance, which sum up since the start, are left out there. Events of the scene's own analyses take no part.
    """

    _machine: _catena.Dynamics

    def __init__(
        self,
        scene: Scene,
        parameters: Mapping[str, Value] | None = None,
        *,
        outputs: Sequence[str] = (),
        method: str = "auto",
        tolerance: float = 1e-8,
        step: float = 0.0,
    ) -> None:
        self._machine = _catena.Dynamics(*scene.source(parameters), list(outputs), method, tolerance, step)

    def advance_to(self, t: float) -> None:
        """Integrates to an instant, which is not before the present one. AnalysisError where no step can be made."""
        self._machine.advance_to(t)

    @property
    def method(self) -> str:
        """The method of integration in use."""
        return self._machine.method

    @property
    def qd(self) -> np.ndarray[Any, Any]:
        """[vx, vy, omega] of the centroid of every body, m/s and rad/s; a view, which follows the motion."""
        return self._machine.qd


class Equilibrium(Machine):
    """A mechanism at rest under its forces.

    outputs    columns; those of the scene unless they are named
    solver     "auto", "newton", "ipopt" or "nlopt"
    tolerance  of residual forces, relative to the largest force
    accept     "stable", or "stationary" for balances that are no minimum of the energy as well
    """

    _machine: _catena.Equilibrium

    def __init__(
        self,
        scene: Scene,
        parameters: Mapping[str, Value] | None = None,
        *,
        outputs: Sequence[str] = (),
        solver: str = "auto",
        tolerance: float = 1e-11,
        accept: str = "stable",
    ) -> None:
        self._machine = _catena.Equilibrium(*scene.source(parameters), list(outputs), solver, tolerance, accept)

    def solve(self, t: float | None = None) -> dict[str, Any]:
        """The equilibrium from where it is now, and what is known of it: energy, stable, residual and more.

        t  the instant at which functions of time are taken; the present one unless it is given

        AnalysisError where there is none.
        """
        self._machine.solve_at(self.time if t is None else t)
        return self._machine.report

    @property
    def report(self) -> dict[str, Any]:
        """Energy, stability and accuracy of the last equilibrium."""
        return self._machine.report
