#!/usr/bin/env python3
"""What Python costs: the same runs from Python and from C++, processor time of one run, the least of many, in turns.

    PYTHONPATH=build/release/python OPENBLAS_NUM_THREADS=1 apps/bench/beside_python.py build/release/bin/catena_bench
"""

import os
import subprocess
import sys
import tempfile
import time

import catena

#: Other programs slow down both alike only if these take turns.
ROUNDS = 8


def four_bar():
    """37 positions of a crank-rocker, a measure, its gradient by four lengths."""
    model = catena.Model("four-bar", parameters={"a": 0.1, "b": 0.25, "c": 0.2, "d": 0.3})
    model.body("crank", points={"end": ["a", 0]}, angle=1)
    model.body("coupler", points={"end": ["b", 0]}, position=["=a*cos(1)", "=a*sin(1)"], angle=0.4)
    model.body("rocker", points={"end": ["c", 0]}, position=["d", 0], angle=1.6)
    model.add(
        catena.Revolute(i="ground", j="crank"),
        catena.Revolute(i="crank.end", j="coupler"),
        catena.Revolute(i="coupler.end", j="rocker.end"),
        catena.Revolute(i=("ground", ["d", 0]), j="rocker"),
    )
    model.drive(catena.AbsoluteAngle(i="crank", value={"polynomial": [1, 1]}))
    motion = {"type": "kinematics", "until": "=2*pi", "every": "=pi/18", "outputs": ["rocker.angle"],
              "measures": {"swing": {"range": "rocker.angle"}}}
    model.analyse("sensitivity", parameters=["a", "b", "c", "d"], of=motion)
    return model


def many_rows():
    """10^6 rows of five columns."""
    model = catena.Model("rows")
    model.body("crank", points={"tip": [1, 0]})
    model.add(catena.Revolute(i="ground", j="crank"))
    model.drive(catena.AbsoluteAngle(i="crank", value={"polynomial": [0, 1]}))
    model.analyse("kinematics", until=1000, every=0.001,
                  outputs=["crank.angle", "crank.tip.x", "crank.tip.y", "crank.omega"])
    return model


def least(repeats, call):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return min(times)


def compare(what, model, analysis, repeats, call, aim):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.json")
        model.save(path)
        command = [sys.argv[1], "--run", path, analysis, str(repeats)]
        compiled, python = float("inf"), float("inf")
        for _ in range(ROUNDS):
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            compiled = min(compiled, float(done.stdout.split()[0]))
            python = min(python, least(repeats, call))
    ratio = python / compiled
    print(f"{what}: C++ {1e3 * compiled:.4g} ms, Python {1e3 * python:.4g} ms, ratio {ratio:.3f} (aim {aim})")


def main():
    model = four_bar()
    function = model.scene().value_and_grad("swing", ["a", "b", "c", "d"])
    compare("one design of a four-bar, 37 positions, value and gradient", model, "sensitivity", 60,
            lambda: function([0.1, 0.25, 0.2, 0.3]), 1.5)
    rows = many_rows()
    scene = rows.scene()

    def arrays():
        kinematics = scene.run()[0]
        return [kinematics[name] for name in kinematics.columns]

    compare("10^6 rows of 5 columns as arrays", rows, "kinematics", 2, arrays, 1.1)
    kinematics = catena.Kinematics(four_bar().scene())
    steps = 20_000
    seconds = least(5, lambda: [kinematics.move_to(1e-3 * k) for k in range(steps)])
    print(f"one step of a four-bar by move_to: {1e6 * seconds / steps:.3g} us")


if __name__ == "__main__":
    main()
