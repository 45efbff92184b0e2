"""Planar multibody systems: kinematics, dynamics, statics, modes, sensitivities.

A scene comes from a file, a text, or a model that is built here:

>>> import catena
>>> model = catena.Model(parameters={"length": 0.1, "speed": 2})
>>> crank = model.body("crank", points={"tip": ["length", 0]})
>>> model.add(catena.Revolute(name="pin", i="ground", j=crank))
>>> model.drive(catena.AbsoluteAngle(name="drive", i=crank, value={"polynomial": [0, "speed"]}))
>>> model.analyse("kinematics", until=1, every=0.25, outputs=["crank.tip.x"])
>>> scene = model.scene()
>>> run = scene.run({"length": 0.2})
>>> run["kinematics"]["crank.tip.x"].round(4)
array([ 0.2   ,  0.1755,  0.1081,  0.0141, -0.0832])

Numbers are in SI units and radians. What is wrong with a scene raises SceneError, with file, line and column; an
analysis that was not solved says so by its status. The tutorial is apps/manual/python.md.
"""

from ._catena import AnalysisError, FigureError, SceneError, explain
from . import elements
from .elements import *
from .batches import Batch, batch
from .machines import Dynamics, Equilibrium, Kinematics
from .models import Block, Model
from .results import Analysis, Run
from .scenes import Scene, load, loads
from .sweeps import Failure, Sweep, sweep

__all__ = [
    "Analysis",
    "AnalysisError",
    "Batch",
    "Block",
    "Dynamics",
    "Equilibrium",
    "Failure",
    "FigureError",
    "Kinematics",
    "Model",
    "Run",
    "Scene",
    "SceneError",
    "Sweep",
    "batch",
    "explain",
    "load",
    "loads",
    "sweep",
]
__all__ += elements.__all__
