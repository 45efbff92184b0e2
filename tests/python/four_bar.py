"""Random four-bar linkages, and their positions in closed form: nothing of catena is in the latter."""

import cmath
import math
import random

import catena


class FourBar:
    """A crank-rocker: crank a from the origin, coupler b, rocker c from (d, 0), open assembly; pen at (u, v)."""

    def __init__(self, seed):
        numbers = random.Random(seed)
        while True:
            self.a, self.b, self.c, self.d = (numbers.uniform(0.1, 1) for _ in range(4))
            lengths = sorted([self.a, self.b, self.c, self.d])
            # Grashof's condition with room to spare: no position comes near to a dead point of the rocker.
            if lengths[0] == self.a and lengths[0] + lengths[3] < 0.9 * (lengths[1] + lengths[2]):
                break
        self.u, self.v = numbers.uniform(-0.3, 0.3), numbers.uniform(-0.3, 0.3)
        self.speed = numbers.choice([-1, 1]) * numbers.uniform(1, 10)

    def pose(self, angle):
        """Angles of coupler and rocker, place of the pen, for an angle of the crank."""
        crank = self.a * cmath.exp(1j * angle)
        line = self.d - crank
        along = (self.b**2 - self.c**2 + abs(line) ** 2) / (2 * abs(line))
        across = math.sqrt(self.b**2 - along**2)
        coupler = (along + 1j * across) * line / abs(line)
        pen = crank + complex(self.u, self.v) * coupler / abs(coupler)
        return cmath.phase(coupler), cmath.phase(crank + coupler - self.d), pen

    def pen_velocity(self, angle, h=1e-3):
        """Of the pen, by differences of the order h^6: its error is about 1e-13."""
        pens = [self.pose(angle + k * h)[2] for k in (-3, -2, -1, 1, 2, 3)]
        weights = [-1 / 60, 3 / 20, -3 / 4, 3 / 4, -3 / 20, 1 / 60]
        return self.speed * sum(w * p for w, p in zip(weights, pens)) / h

    def model(self, driven=True):
        """The same in catena, its given configuration a little off; under gravity alone where it is not driven."""
        coupler, rocker, _ = self.pose(0)
        parameters = {"a": self.a, "b": self.b, "c": self.c, "d": self.d, "speed": self.speed}
        model = catena.Model("four-bar", parameters=parameters, gravity=[0, 0 if driven else -9.81])
        model.body("crank", points={"end": ["a", 0]}, mass=1, inertia=0.1)
        model.body("coupler", position=["a", 0], angle=coupler + 0.02, mass=1, inertia=0.1,
                   points={"end": ["b", 0], "pen": [self.u, self.v]})
        model.body("rocker", position=["d", 0], angle=rocker - 0.01, mass=1, inertia=0.1, points={"end": ["c", 0]})
        model.add(
            catena.Revolute(name="O", i="ground", j="crank"),
            catena.Revolute(name="A", i="crank.end", j="coupler"),
            catena.Revolute(name="B", i="coupler.end", j="rocker.end"),
            catena.Revolute(name="C", i=("ground", ["d", 0]), j="rocker"),
        )
        if driven:
            model.drive(catena.AbsoluteAngle(name="drive", i="crank", value={"polynomial": [0, "speed"]}))
        return model


def turned(angle, near):
    """The angle with as many whole turns as bring it near to another one."""
    return angle + 2 * math.pi * round((near - angle) / (2 * math.pi))


def arm(cls=catena.Scene):
    """A driven arm whose tip has x = length cos(0.5), as a scene of the class given."""
    model = catena.Model(parameters={"length": 1})
    model.body("arm", points={"tip": ["length", 0]})
    model.add(catena.Revolute(i="ground", j="arm"))
    model.drive(catena.AbsoluteAngle(i="arm", value=0.5))
    model.analyse("kinematics", measures={"x": {"final": "arm.tip.x"}})
    return cls("arm", model.text())
