"""Sweeps over executors: the same rows on each, dead workers, pickled scenes."""

import concurrent.futures
import math
import multiprocessing
import os
import pickle
import tempfile
import unittest

import numpy

import catena
from four_bar import FourBar, arm


def measured(seed=2):
    """A four-bar whose pen reaches so far."""
    model = FourBar(seed).model()
    model.analyse("kinematics", until="=2*pi/abs(speed)", every="=pi/abs(speed)/24",
                  measures={"reach": {"range": "coupler.pen.x"}, "end": {"final": "rocker.angle"}})
    return model.scene()


class DyingScene(catena.Scene):
    """Its worker dies at one of the designs."""

    def run(self, parameters=None, **options):
        if parameters["length"] == 3:
            os._exit(1)
        return super().run(parameters, **options)


class Sweeps(unittest.TestCase):
    def test_are_the_same_on_every_executor(self):
        scene = measured()
        bar = FourBar(2)
        parameters = {"b": numpy.linspace(0.98, 1.02, 6) * bar.b, "c": [bar.c, 1.01 * bar.c]}
        here = catena.sweep(scene, parameters)
        self.assertEqual(len(here), 12)
        self.assertTrue(here.ok)
        spawn = multiprocessing.get_context("spawn")
        for executor in (
            concurrent.futures.ThreadPoolExecutor(2),
            concurrent.futures.ProcessPoolExecutor(2, mp_context=spawn),
        ):
            with executor, self.subTest(executor=type(executor).__name__):
                seen = []
                there = catena.sweep(scene, parameters, executor=executor, at_once=5,
                                     progress=lambda done, of: seen.append((done, of)))
                self.assertEqual(there.designs, here.designs)
                self.assertEqual(there.status, here.status)
                for name in ("reach", "end", "b", "c"):
                    numpy.testing.assert_array_equal(there[name], here[name])
                self.assertEqual((len(seen), seen[-1]), (3, (12, 12)))

    def test_are_those_of_single_runs(self):
        scene = measured()
        bar = FourBar(2)
        result = catena.sweep(scene, [{"b": bar.b}, {"b": 1.01 * bar.b, "c": 1.01 * bar.c}])
        alone = scene.run({"b": 1.01 * bar.b, "c": 1.01 * bar.c})[0].measures["reach"]["value"]
        self.assertEqual(result["reach"][1], alone)

    def test_designs_that_fail_are_told_and_the_others_count(self):
        bar = FourBar(2)
        result = catena.sweep(measured(), {"b": [bar.b, 100, "no", 1.01 * bar.b]})
        self.assertEqual([result.status[k] for k in (0, 2, 3)], ["ok", "invalid", "ok"])
        self.assertEqual(result.status[1], "not_assembled")
        self.assertEqual([failure.number for failure in result.failures], [1, 2])
        self.assertIn("misses by", result.failures[0].message)
        self.assertIn("no", result.failures[1].message)
        self.assertEqual(list(numpy.isnan(result["reach"])), [False, True, True, False])
        self.assertEqual(result.lost, [])

    def test_designs_of_a_dead_worker_are_reported_and_can_be_run_again(self):
        lengths = list(range(1, 7))
        with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
            result = catena.sweep(arm(DyingScene), {"length": lengths}, executor=executor, at_once=1)
        self.assertEqual(len(result), 6)
        self.assertEqual(result.status[2], "lost")
        self.assertFalse(result.ok)
        self.assertEqual([failure.number for failure in result.failures],
                         [k for k, status in enumerate(result.status) if status != "ok"])
        self.assertIn("did not answer: BrokenProcessPool", result.failures[-1].message)
        for length, x, status in zip(lengths, result["x"], result.status):
            self.assertTrue(math.isnan(x) if status == "lost" else abs(x - length * math.cos(0.5)) < 1e-12)
        again = catena.sweep(arm(), result.lost)
        self.assertTrue(again.ok)
        numpy.testing.assert_allclose(again["x"], again["length"] * math.cos(0.5), rtol=0, atol=1e-12)

    def test_together(self):
        result = catena.sweep(arm(), {"length": [1, 2]}, together=True)
        self.assertEqual(result.designs, [{"length": 1}, {"length": 2}])
        with self.assertRaisesRegex(ValueError, "one length"):
            catena.sweep(arm(), {"length": [1, 2], "width": [1]}, together=True)

    def test_what_is_wrong_is_told_before_anything_runs(self):
        with self.assertRaisesRegex(ValueError, "design 1: parameter length is nan"):
            catena.sweep(arm(), {"length": [1, math.nan]})
        with self.assertRaisesRegex(catena.SceneError, 'no parameter "lenght".*did you mean "length"'):
            catena.sweep(arm(), {"length": [1, 2], "lenght": [1, 2]})
        with self.assertRaisesRegex(catena.SceneError, '^catena: parameters: unknown parameter "lenght"'):
            arm().run({"lenght": 1})
        with self.assertRaisesRegex(ValueError, "1000000000 designs are asked for"):
            catena.sweep(arm(), {"length": range(10**5), "width": range(10**4)})
        with self.assertRaisesRegex(ValueError, "parameter length needs a list of values, not 5"):
            catena.sweep(arm(), {"length": 5})
        with self.assertRaisesRegex(ValueError, "parameter length is inf, not a finite number"):
            arm().run({"length": math.inf})
        with self.assertRaisesRegex(ValueError, "patience is 0"):
            catena.sweep(arm(), {"length": [1]}, patience=0)
        with self.assertRaisesRegex(ValueError, "at least one design"):
            catena.sweep(arm(), {"length": [1]}, at_once=0)
        with self.assertRaisesRegex(KeyError, "reach"):
            catena.sweep(arm(), {"length": [1]})["reach"]


class Pickles(unittest.TestCase):
    def test_of_files_go_without_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "arm.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write(arm()._text)
            scene = catena.load(path)
            scene.parameters["length"] = 2
            kept = pickle.dumps(scene)
        self.assertAlmostEqual(pickle.loads(kept).run()[0].measures["x"]["value"], 2 * math.cos(0.5), 12)
        with self.assertRaisesRegex(catena.SceneError, "arm.json"):
            pickle.dumps(catena.load(path))

    def test_of_scenes_that_name_files_find_them(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "path.csv"), "w", encoding="utf-8") as file:
                file.write("0,0\n1,2\n2,4\n")
            model = catena.Model()
            model.body("arm")
            model.add(catena.Revolute(i="ground", j="arm"))
            path = {"spline": {"points": {"file": "path.csv", "columns": [1, 2]}}}
            model.drive(catena.AbsoluteAngle(i="arm", value=path))
            model.analyse("kinematics", at=[1.5], outputs=["arm.angle"])
            model.save(os.path.join(folder, "arm.json"))
            before = os.getcwd()
            try:
                os.chdir(folder)
                kept = pickle.dumps(catena.load("arm.json"))
            finally:
                os.chdir(before)
            self.assertAlmostEqual(pickle.loads(kept).run()[0]["arm.angle"][0], 3, 12)


if __name__ == "__main__":
    unittest.main()
