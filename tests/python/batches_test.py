"""Batches: arrays of designs against closed forms and single runs; what is wrong with a table."""

import copy
import math
import random
import threading
import unittest

import numpy

import catena
from four_bar import FourBar, arm, turned

LENGTHS = ["a", "b", "c", "d"]


def around(bar, numbers):
    """A four-bar whose lengths are a few per cent off."""
    other = copy.copy(bar)
    for name in LENGTHS:
        setattr(other, name, getattr(bar, name) * numbers.uniform(0.98, 1.02))
    return other


def scene_of(bar):
    model = bar.model()
    model.analyse("check")
    model.analyse("kinematics", until="=1/abs(speed)", every="=1/abs(speed)/12",
                  measures={"angle": {"final": "rocker.angle"}, "x": {"final": "coupler.pen.x"},
                            "y": {"final": "coupler.pen.y"}, "swing": {"range": "rocker.angle"}})
    return model.scene()


class Batches(unittest.TestCase):
    def test_are_random_four_bars_in_closed_form(self):
        for seed in range(4):
            bar, numbers = FourBar(seed), random.Random(seed)
            bars = [around(bar, numbers) for _ in range(37)]
            table = numpy.array([[getattr(one, name) for name in LENGTHS] for one in bars])
            result = catena.batch(scene_of(bar), table, LENGTHS, threads=2)
            self.assertTrue(result.ok.all(), result.failures)
            self.assertEqual(result.values.shape, (37, 4))
            self.assertEqual(result.measures, ["angle", "x", "y", "swing"])
            self.assertGreater(result.in_lanes, 30)
            numpy.testing.assert_array_equal(result.designs, table)
            for one, (angle, x, y, _) in zip(bars, result.values):
                _, rocker, pen = one.pose(math.copysign(1, bar.speed))
                self.assertAlmostEqual(angle, turned(rocker, angle), delta=1e-11)
                self.assertAlmostEqual(x, pen.real, delta=1e-11)
                self.assertAlmostEqual(y, pen.imag, delta=1e-11)

    def test_are_those_of_single_runs_and_failures_are_told(self):
        bar = FourBar(2)
        scene = scene_of(bar)
        table = numpy.array([[bar.b, bar.c], [100, bar.c], [1.01 * bar.b, 1.01 * bar.c]])
        result = catena.batch(scene, table, ["b", "c"])
        self.assertEqual(list(result.status), ["ok", "not_assembled", "ok"])
        self.assertEqual(list(result.ok), [True, False, True])
        self.assertEqual([failure.number for failure in result.failures], [1])
        self.assertEqual(result.failures[0].design, {"b": 100, "c": bar.c})
        self.assertIn("misses by", result.failures[0].message)
        self.assertTrue(numpy.isnan(result.values[1]).all())
        for k in (0, 2):
            alone = scene.run({"b": table[k, 0], "c": table[k, 1]}, only="kinematics")[0].measures
            for name in result.measures:
                self.assertAlmostEqual(result[name][k], alone[name]["value"], delta=1e-12)
        self.assertIn("3 designs, 1 without", repr(result))

    def test_take_strides_orders_and_lists(self):
        table = numpy.arange(1.0, 9.0).reshape(4, 2)
        expected = table[::2, 1] * math.cos(0.5)
        for designs in (table[::2, 1:], numpy.asfortranarray(table[::2, 1:]), [[2], [6]]):
            result = catena.batch(arm(), designs, ["length"])
            numpy.testing.assert_allclose(result["x"], expected, rtol=1e-15)
            numpy.testing.assert_array_equal(result["length"], [2, 6])

    def test_leave_the_interpreter_to_others(self):
        bar = FourBar(1)
        table = numpy.linspace(0.99, 1.01, 20000)[:, None] * bar.b
        seen = []
        done = threading.Event()

        def count():
            while not done.wait(0.001):
                seen.append(1)

        other = threading.Thread(target=count)
        other.start()
        catena.batch(scene_of(bar), table, ["b"])
        done.set()
        other.join()
        self.assertGreater(len(seen), 20)

    def test_what_is_wrong_is_told_before_anything_runs(self):
        for designs, names, told in (
            ([1, 2], ["length"], r"a table, a row for each: this array has the shape \(2,\)"),
            ([[1, 2]], ["length"], "2 columns, and 1 names"),
            ([[1], [math.nan]], ["length"], 'design 1: parameter "length" is nan'),
            ([[1], [-math.inf]], ["length"], 'design 1: parameter "length" is -inf'),
            ([[1]], ["lenght"], 'unknown parameter "lenght".*did you mean "length"'),
            ([[1, 2]], ["length", "length"], '"length" is named twice'),
            ([[1]], "length", "a list of parameters"),
            (numpy.empty((0, 1)), ["length"], "no rows"),
            (numpy.empty((3, 0)), [], "no parameters"),
            ([["long"]], ["length"], "could not convert"),
        ):
            with self.subTest(told), self.assertRaisesRegex(ValueError, told):
                catena.batch(arm(), designs, names)
        with self.assertRaisesRegex(ValueError, "0 threads"):
            catena.batch(arm(), [[1]], ["length"], threads=0)
        with self.assertRaisesRegex(catena.SceneError, "no analysis of the scene has measures"):
            catena.batch(FourBar(1).model().scene(), [[1]], ["a"])
        with self.assertRaisesRegex(KeyError, "reach"):
            catena.batch(arm(), [[1]], ["length"])["reach"]


if __name__ == "__main__":
    unittest.main()
