"""Kinematics, Dynamics and Equilibrium stepped from Python: closed forms, runs of scenes, views, errors."""

import math
import os
import random
import signal
import subprocess
import sys
import threading
import unittest

import numpy

import catena
from four_bar import FourBar, turned

SCENES = os.path.join(os.environ["CATENA_DATA_DIR"], "scenes")
ANGLES = ["coupler.angle", "rocker.angle", "coupler.pen.x", "coupler.pen.y", "coupler.pen.vx", "coupler.pen.vy"]


def oscillator(mass, stiffness, damping, start):
    """A mass on a spring along x."""
    model = catena.Model(parameters={"k": stiffness, "push": 0})
    model.body("mass", mass=mass, position=[start, 0], particle=True)
    model.add(
        catena.AbsoluteY(i="mass", value=0),
        catena.SpringDamper(i=("ground", [-10, 0]), j="mass", k="k", c=damping, length=10),
        catena.PointForce(i="mass", force=["push", 0]),
    )
    return model


class KinematicsSteps(unittest.TestCase):
    def test_are_those_of_the_closed_form(self):
        for seed in range(30):
            with self.subTest(seed=seed):
                bar = FourBar(seed)
                numbers = random.Random(seed)
                kinematics = catena.Kinematics(bar.model().scene(), outputs=ANGLES)
                for _ in range(6):
                    t = numbers.uniform(0, 2)  # forwards and backwards
                    kinematics.move_to(t)
                    coupler, rocker, pen = bar.pose(bar.speed * t)
                    velocity = bar.pen_velocity(bar.speed * t)
                    found = [kinematics[name] for name in ANGLES]
                    expected = [turned(coupler, found[0]), turned(rocker, found[1]), pen.real, pen.imag,
                                velocity.real, velocity.imag]
                    numpy.testing.assert_allclose(found[:4], expected[:4], rtol=0, atol=2e-11)
                    numpy.testing.assert_allclose(found[4:], expected[4:], rtol=1e-9, atol=1e-9)
                    self.assertEqual(kinematics.time, t)

    def test_drivers_go_where_they_are_told_along_the_branch(self):
        for seed in range(30):
            with self.subTest(seed=seed):
                bar = FourBar(seed)
                kinematics = catena.Kinematics(bar.model().scene(), outputs=ANGLES)
                kinematics.move_to(0.3)
                numbers = random.Random(seed)
                for _ in range(4):
                    angle, rate = numbers.uniform(-6, 6), numbers.uniform(-3, 3)
                    kinematics.drive("drive", angle, rate)
                    _, rocker, pen = bar.pose(angle)
                    self.assertEqual(kinematics.time, 0.3)
                    self.assertAlmostEqual(kinematics["rocker.angle"], turned(rocker, kinematics["rocker.angle"]), 10)
                    self.assertAlmostEqual(kinematics["coupler.pen.x"], pen.real, 10)
                    velocity = bar.pen_velocity(angle) * rate / bar.speed
                    self.assertAlmostEqual(kinematics["coupler.pen.vx"], velocity.real, 8)
                kinematics.move_to(0.5)
                _, _, pen = bar.pose(angle + 0.2 * rate)
                self.assertAlmostEqual(kinematics["coupler.pen.y"], pen.imag, 10)

    def test_parameters_change_from_where_it_is(self):
        bar = FourBar(3)
        kinematics = catena.Kinematics(bar.model().scene(), outputs=ANGLES)
        kinematics.move_to(0.4)
        bar.b *= 1.02
        kinematics.set(b=bar.b)
        self.assertEqual(kinematics.parameters["b"], bar.b)
        # The columns are those of the changed mechanism at once, as after a step.
        self.assertAlmostEqual(kinematics["coupler.pen.x"], bar.pose(0.4 * bar.speed)[2].real, 10)
        kinematics.move_to(0.4)
        self.assertAlmostEqual(kinematics["coupler.pen.x"], bar.pose(0.4 * bar.speed)[2].real, 10)
        before = kinematics.q.copy()
        with self.assertRaisesRegex(catena.AnalysisError, "misses by") as raised:
            kinematics.set(b=50 * bar.b)
        self.assertEqual(raised.exception.status, "not_assembled")
        self.assertEqual(kinematics.parameters["b"], bar.b)
        numpy.testing.assert_array_equal(kinematics.q, before)

    def test_rows_are_those_of_a_run(self):
        model = FourBar(5).model()
        times = numpy.linspace(0, 1, 41)
        model.analyse("kinematics", at=times)
        run = model.run(outputs=ANGLES)[0]
        followed = catena.Kinematics(model.scene(), outputs=ANGLES).follow(times)
        self.assertEqual((followed.status, followed.columns), ("ok", run.columns))
        numpy.testing.assert_allclose(followed.table(), run.table(), rtol=0, atol=1e-10)
        self.assertTrue(numpy.shares_memory(followed["t"], followed.table()))
        with self.assertRaisesRegex(ValueError, "stepped from Python"):
            followed.animate()

    def test_rates_are_derivatives(self):
        kinematics = catena.Kinematics(FourBar(7).model().scene())
        h = 1e-4
        q, qd = [], []
        for t in (0.5 - h, 0.5 + h, 0.5):
            kinematics.move_to(t)
            q.append(kinematics.q.copy())
            qd.append(kinematics.qd.copy())
        numpy.testing.assert_allclose(kinematics.qd, (q[1] - q[0]) / (2 * h), rtol=0, atol=1e-5)
        numpy.testing.assert_allclose(kinematics.qdd, (qd[1] - qd[0]) / (2 * h), rtol=0, atol=1e-4)

    def test_arrays_follow_the_motion_and_outlive_it(self):
        kinematics = catena.Kinematics(FourBar(7).model().scene(), outputs=["crank.angle"])
        kinematics.move_to(0.1)
        q, row = kinematics.q, kinematics.row
        kinematics.move_to(0.2)
        self.assertEqual(row[0], 0.2)
        self.assertTrue(numpy.shares_memory(q, kinematics.q))
        self.assertEqual(q.shape, (3, 3))
        with self.assertRaises(ValueError):
            q[0, 0] = 1
        expected = q.copy()
        del kinematics
        numpy.testing.assert_array_equal(q, expected)

    def test_loads_of_drivers_are_columns(self):
        model = catena.Model(gravity=[0, -10])
        model.body("arm", mass=2, inertia=1, centroid=[0.5, 0])
        model.add(catena.Revolute(name="pin", i="ground", j="arm"))
        model.drive(catena.AbsoluteAngle(name="motor", i="arm", value={"polynomial": [0, 1]}))
        kinematics = catena.Kinematics(model.scene(), outputs=["motor.load", "motor.work"], inverse_dynamics=True)
        kinematics.move_to(0.5)
        self.assertAlmostEqual(kinematics["motor.load"], 10 * math.cos(0.5), 10)
        self.assertEqual(kinematics.columns, ["t", "motor.load"])
        self.assertRegex(" ".join(kinematics.notes), "work")

    def test_what_is_wrong_is_an_exception(self):
        kinematics = catena.Kinematics(FourBar(1).model().scene(), outputs=["crank.angle"])
        for error, message, call in [
            (RuntimeError, "step first", lambda: kinematics["crank.angle"]),
            (RuntimeError, "move_to, .*after set", lambda: kinematics.row),
            (RuntimeError, "step first", lambda: kinematics.qd),
            (ValueError, "not finite", lambda: kinematics.move_to(math.nan)),
            (ValueError, "not finite", lambda: kinematics.follow([0, math.inf])),
            (ValueError, "no instants", lambda: kinematics.follow([])),
            (IndexError, "no body number 3", lambda: kinematics.frame(3)),
            (IndexError, "no body number -2", lambda: kinematics.frame(-2)),
            (KeyError, 'no body .*"crnk".*did you mean .*"crank', lambda: kinematics.frame("crnk")),
            (KeyError, "no driver", lambda: kinematics.drive("A", 1)),
            (ValueError, "finite", lambda: kinematics.drive("drive", math.nan)),
            (catena.SceneError, "no parameter", lambda: kinematics.set(e=1)),
            (catena.SceneError, "finite", lambda: kinematics.set(a=math.nan)),
            (catena.SceneError, "crnk", lambda: catena.Kinematics(FourBar(1).model().scene(), outputs=["crnk.x"])),
            (catena.SceneError, "lenght", lambda: catena.Kinematics(FourBar(1).model().scene(), {"lenght": 1})),
            (catena.SceneError, "no/such", lambda: catena.Kinematics(catena.load("no/such.json"))),
            (ValueError, "tolerance", lambda: catena.Kinematics(FourBar(1).model().scene(), tolerance=-1)),
        ]:
            with self.subTest(message=message), self.assertRaisesRegex(error, message):
                call()
        kinematics.move_to(1)
        with self.assertRaisesRegex(KeyError, "crank.angel"):
            kinematics["crank.angel"]

    def test_mechanisms_that_nothing_drives_say_so(self):
        model = catena.Model()
        model.body("arm")
        model.add(catena.Revolute(i="ground", j="arm"))
        with self.assertRaisesRegex(catena.AnalysisError, "arm") as raised:
            catena.Kinematics(model.scene()).move_to(1)
        self.assertEqual(raised.exception.status, "under_driven")

    def test_two_threads_at_once_are_refused(self):
        kinematics = catena.Kinematics(FourBar(1).model().scene())
        seen = []

        def follow():
            try:
                kinematics.follow(numpy.linspace(0, 50, 200_000))
            except RuntimeError as error:
                seen.append(str(error))

        # On a busy machine one may be done before the other begins.
        for _ in range(20):
            threads = [threading.Thread(target=follow) for _ in range(2)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            if seen:
                break
        self.assertEqual(seen, ["it is being stepped by another thread"])
        kinematics.move_to(0)


class DynamicsSteps(unittest.TestCase):
    def test_are_those_of_damped_oscillators(self):
        for seed in range(25):
            with self.subTest(seed=seed):
                numbers = random.Random(seed)
                mass, omega, start = numbers.uniform(0.5, 2), numbers.uniform(1, 6), numbers.uniform(-1, 1)
                decay = omega * numbers.uniform(0, 0.5)
                model = oscillator(mass, mass * omega**2, 2 * mass * decay, start)
                dynamics = catena.Dynamics(model.scene(), outputs=["mass.x"], tolerance=1e-10)
                damped = math.sqrt(omega**2 - decay**2)
                t = 0
                for _ in range(8):
                    t += numbers.uniform(0.05, 1)
                    dynamics.advance_to(t)
                    expected = start * math.exp(-decay * t) * (
                        math.cos(damped * t) + decay / damped * math.sin(damped * t))
                    self.assertAlmostEqual(dynamics["mass.x"], expected, 8)
                    self.assertAlmostEqual(dynamics.q[0, 0], expected, 8)

    def test_a_force_is_controlled_from_python(self):
        dynamics = catena.Dynamics(oscillator(1, 4, 0, 0).scene(), outputs=["mass.x", "mass.vx"], tolerance=1e-11)
        x, v, omega, h = 0, 0, 2, 0.1
        for step in range(20):
            push = math.sin(step)
            dynamics.set(push=push)
            dynamics.advance_to(h * (step + 1))
            rest = push / omega**2  # a constant push moves the place of rest
            x, v = (rest + (x - rest) * math.cos(omega * h) + v / omega * math.sin(omega * h),
                    -(x - rest) * omega * math.sin(omega * h) + v * math.cos(omega * h))
            self.assertAlmostEqual(dynamics["mass.x"], x, 8)
            self.assertAlmostEqual(dynamics["mass.vx"], v, 8)

    def test_set_shows_the_forces_of_the_new_parameters(self):
        model = oscillator(2, 100, 0, 0.5)
        dynamics = catena.Dynamics(model.scene(), outputs=["mass.x", "mass.ax", "energy.potential"])
        dynamics.advance_to(0)
        row = dynamics.row
        dynamics.set(k=200)  # an array sees it, too
        numpy.testing.assert_allclose(row[1:], [0.5, -50, 25], rtol=1e-12)
        dynamics.advance_to(0.3)
        x = 0.5 * math.cos(10 * 0.3)
        dynamics.set(k=50, push=3)
        numpy.testing.assert_allclose(row[1:], [x, (3 - 50 * x) / 2, 25 * x * x - 3 * x], rtol=1e-6)
        dynamics.set(k=200, push=0)
        dynamics.advance_to(1)
        self.assertAlmostEqual(dynamics["mass.x"], 0.5 * math.cos(10), 6)

    def test_set_to_what_cannot_be_assembled_changes_nothing(self):
        bar = FourBar(3)
        model = bar.model(driven=False)
        dynamics = catena.Dynamics(model.scene(), outputs=["coupler.angle", "coupler.omega"])
        dynamics.advance_to(0.1)
        before, parameters = dynamics.row.copy(), dynamics.parameters
        with self.assertRaisesRegex(catena.AnalysisError, "misses by"):
            dynamics.set(b=50 * bar.b)
        self.assertEqual(dynamics.parameters, parameters)
        numpy.testing.assert_array_equal(dynamics.row, before)
        other = catena.Dynamics(model.scene(), outputs=["coupler.angle", "coupler.omega"])
        for machine in (dynamics, other):
            machine.advance_to(0.4)
        numpy.testing.assert_allclose(dynamics.row, other.row, rtol=0, atol=1e-6)

    def test_work_sums_up_over_steps(self):
        model = oscillator(1, 4, 0.4, 1)
        dynamics = catena.Dynamics(model.scene(), outputs=["energy"], tolerance=1e-10)
        for step in range(20):
            dynamics.advance_to(0.1 * (step + 1))
        lost = 2 - dynamics["energy.total"]
        self.assertAlmostEqual(dynamics["energy.dissipated"], lost, 7)
        self.assertAlmostEqual(dynamics["energy.balance"], 0, 7)

    def test_rows_are_those_of_a_run(self):
        scene = catena.load(os.path.join(SCENES, "bouncing_ball.json"))
        run = scene.run(outputs=["ball.y", "ball.vy", "floor.force"])["dynamics"]
        dynamics = catena.Dynamics(scene, outputs=["ball.y", "ball.vy", "floor.force"])
        followed = dynamics.follow(run["t"])
        self.assertEqual(followed.status, "ok")
        numpy.testing.assert_allclose(followed.table(), run.table(), rtol=0, atol=1e-6)

    def test_steps_meet_contacts(self):
        scene = catena.load(os.path.join(SCENES, "bouncing_ball.json"))
        last = scene.run(outputs=["ball.y"])["dynamics"]
        dynamics = catena.Dynamics(scene, outputs=["ball.y", "energy.dissipated"])
        for t in numpy.linspace(0, last["t"][-1], 30)[1:]:
            dynamics.advance_to(t)
        self.assertAlmostEqual(dynamics["ball.y"], last["ball.y"][-1], 5)
        self.assertNotIn("energy.dissipated", dynamics.columns)
        self.assertAlmostEqual(dynamics.frame("ball")[1], dynamics["ball.y"], 12)

    def test_what_is_wrong_is_an_exception(self):
        dynamics = catena.Dynamics(oscillator(1, 4, 0, 1).scene())
        dynamics.advance_to(1)
        with self.assertRaisesRegex(catena.AnalysisError, "forwards in time"):
            dynamics.advance_to(0.5)
        with self.assertRaisesRegex(ValueError, 'method is one of "auto".*not "euler"'):
            catena.Dynamics(oscillator(1, 4, 0, 1).scene(), method="euler")
        self.assertEqual(dynamics.time, 1)
        self.assertEqual(dynamics.method, "rk8")

    def test_ctrl_c_ends_a_step(self):
        code = (
            "import catena, sys; d = catena.Dynamics(catena.loads(sys.argv[1]), tolerance=1e-10)\n"
            "print('ready', flush=True); d.advance_to(1e5)"
        )
        # Two rods take two minutes.
        model = catena.Model(gravity=[0, -9.81])
        for k in range(2):
            model.body(f"rod{k}", mass=1, rod={"from": [k, 0], "to": [k + 1, 0]})
            model.add(catena.Revolute(i=f"rod{k - 1}.to" if k > 0 else "ground", j=f"rod{k}.from"))
        process = subprocess.Popen(
            [sys.executable, "-c", code, model.text()],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        process.stdout.readline()
        try:
            process.wait(0.5)
        except subprocess.TimeoutExpired:
            pass
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)


class Equilibria(unittest.TestCase):
    def test_follow_a_load(self):
        for seed in range(20):
            with self.subTest(seed=seed):
                numbers = random.Random(seed)
                stiffness = numbers.uniform(1, 100)
                equilibrium = catena.Equilibrium(oscillator(1, stiffness, 0, 0.3).scene(), outputs=["mass.x"])
                for _ in range(4):
                    push = numbers.uniform(-1, 1)
                    equilibrium.set(push=push)
                    report = equilibrium.solve()
                    self.assertAlmostEqual(equilibrium["mass.x"], push / stiffness, 9)
                    self.assertAlmostEqual(report["energy"], -(push**2) / (2 * stiffness), 9)
                    self.assertTrue(report["stable"])
                    self.assertAlmostEqual(report["softest_stiffness"], stiffness, 6)

    def test_functions_are_taken_at_an_instant(self):
        model = catena.Model()
        model.body("mass", mass=1, particle=True)
        model.add(catena.AbsoluteY(i="mass", value=0),
                  catena.SpringDamper(i=("ground", [-1, 0]), j="mass", k=2, length=1),
                  catena.PointForce(i="mass", force=[{"polynomial": [0, 3]}, 0]))
        equilibrium = catena.Equilibrium(model.scene(), outputs=["mass.x"])
        equilibrium.solve(0.1)
        self.assertAlmostEqual(equilibrium["mass.x"], 0.15, 10)
        self.assertEqual(equilibrium.time, 0.1)

    def test_bodies_that_nothing_holds_are_named(self):
        model = catena.Model(gravity=[0, -1])
        model.body("stone", mass=1, inertia=1)
        with self.assertRaisesRegex(catena.AnalysisError, "stone"):
            catena.Equilibrium(model.scene()).solve()
        with self.assertRaisesRegex(ValueError, "solver is one of"):
            catena.Equilibrium(model.scene(), solver="guess")


if __name__ == "__main__":
    unittest.main()
