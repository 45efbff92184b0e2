"""The Python package: runs, views of columns, parameters, gradients, errors."""

import os
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy

import catena

SCENES = os.path.join(os.environ["CATENA_DATA_DIR"], "scenes")

# A crank of length 1 that is driven with 2 rad/s.
CRANK = """{"catena": 1, "parameters": {"length": 1, "speed": 2},
  "bodies": {"crank": {"points": {"tip": ["length", 0]}}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "crank"}],
  "drivers": [{"type": "absolute_angle", "name": "drive", "i": "crank", "value": {"polynomial": [0, "speed"]}}],
  "outputs": ["crank.tip.x", "crank.tip.y"],
  "analyses": [%s]}"""
MOTION = """{"type": "kinematics", "until": 1, "every": 0.25,
  "measures": {"end": {"final": "crank.tip.x"}, "top": {"max": "crank.tip.y"}}}"""


class Columns(unittest.TestCase):
    def setUp(self):
        self.analysis = catena.loads(CRANK % MOTION).run()["kinematics"]

    def test_have_the_values_of_the_run(self):
        t = self.analysis["t"]
        numpy.testing.assert_allclose(t, [0, 0.25, 0.5, 0.75, 1], rtol=0, atol=1e-15)
        numpy.testing.assert_allclose(self.analysis["crank.tip.x"], numpy.cos(2 * t), rtol=0, atol=1e-14)
        self.assertEqual(self.analysis.columns, ["t", "crank.tip.x", "crank.tip.y"])
        self.assertEqual(self.analysis.units, {"t": "s", "crank.tip.x": "m", "crank.tip.y": "m"})
        self.assertEqual(len(self.analysis), 5)

    def test_are_views(self):
        x, table = self.analysis["crank.tip.x"], self.analysis.table()
        self.assertTrue(numpy.shares_memory(x, table))
        self.assertEqual(table.shape, (5, 3))
        with self.assertRaises(ValueError):
            x[0] = 1

    def test_outlive_the_run(self):
        x = self.analysis["crank.tip.x"]
        expected = x.copy()
        del self.analysis
        numpy.testing.assert_array_equal(x, expected)

    def test_that_do_not_exist(self):
        with self.assertRaisesRegex(KeyError, "crank.tip.z"):
            self.analysis["crank.tip.z"]


class Runs(unittest.TestCase):
    def test_change_parameters(self):
        scene = catena.loads(CRANK % MOTION)
        scene.parameters["length"] = 3
        self.assertEqual(scene.run()["kinematics"]["crank.tip.x"][0], 3)
        self.assertEqual(scene.run({"length": "50 cm"})["kinematics"]["crank.tip.x"][0], 0.5)
        self.assertEqual(scene.run().parameters, {"length": 3, "speed": 2})

    def test_give_measures(self):
        measures = catena.loads(CRANK % MOTION).run()[0].measures
        self.assertAlmostEqual(measures["end"]["value"], numpy.cos(2), 14)
        self.assertAlmostEqual(measures["top"]["value"], 1, 12)
        self.assertAlmostEqual(measures["top"]["t"], numpy.pi / 4, 7)
        self.assertEqual(measures["top"]["unit"], "m")

    def test_are_sequences(self):
        run = catena.loads(CRANK % ('{"type": "check"}, ' + MOTION)).run()
        self.assertEqual([a.type for a in run], ["check", "kinematics"])
        self.assertTrue(run.ok)
        with self.assertRaisesRegex(KeyError, "dynamics"):
            run["dynamics"]

    def test_of_files(self):
        run = catena.load(os.path.join(SCENES, "crank_rocker.json")).run(outputs=["rocker.angle"])
        kinematics = run["kinematics"]
        self.assertEqual(kinematics.status, "ok")
        self.assertTrue(numpy.isfinite(kinematics["rocker.angle"]).all())


class Gradients(unittest.TestCase):
    SCENE = CRANK % (
        '{"type": "sensitivity", "parameters": ["length", "speed"], "of": ' + MOTION + "}"
    )

    def test_come_with_values(self):
        function = catena.loads(self.SCENE).value_and_grad("end")
        value, gradient = function([1.5, 2.5])
        self.assertAlmostEqual(value, 1.5 * numpy.cos(2.5), 13)
        numpy.testing.assert_allclose(gradient, [numpy.cos(2.5), -1.5 * numpy.sin(2.5)], rtol=0, atol=1e-12)

    def test_of_some_parameters(self):
        value, gradient = catena.loads(self.SCENE).value_and_grad("end", ["speed"])([2.5])
        numpy.testing.assert_allclose(gradient, [-numpy.sin(2.5)], rtol=0, atol=1e-12)

    def test_designs_that_cannot_be_analysed_are_no_numbers(self):
        scene = catena.loads(
            CRANK.replace('"constraints": [', '"constraints": [{"type": "absolute_distance", "i": "crank.tip",'
                          ' "ground": [3, 0], "value": "=1.5*length"}, ').replace('"drivers"', '"forces": [], "drivers"')
            % ('{"type": "sensitivity", "parameters": ["length"], "of": {"type": "kinematics", "at": [0], '
               '"measures": {"x": {"final": "crank.tip.x"}}}}')
        )
        self.assertTrue(numpy.isnan(scene.function("x", ["length"])([0.1])))
        value, gradient = scene.value_and_grad("x", ["length"])([0.1])
        self.assertTrue(numpy.isnan(value) and numpy.isnan(gradient).all())
        with self.assertRaises(ValueError):
            scene.function("x", ["length"])([0.1, 2])

    def test_values_alone(self):
        function = catena.loads(CRANK % MOTION).function("end", ["length"])
        self.assertAlmostEqual(function([2]), 2 * numpy.cos(2), 13)


class Files(unittest.TestCase):
    def test_npz_is_read_by_numpy(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(folder, "crank.json")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(CRANK % MOTION)
            command = [os.environ["CATENA_EXECUTABLE"], "run", scene, "-o", folder, "--format", "npz", "-q"]
            subprocess.run(command, check=True)
            analysis = catena.load(scene).run()["kinematics"]
            with numpy.load(os.path.join(folder, "kinematics.npz")) as columns:
                self.assertEqual(columns.files, analysis.columns)
                for name in columns.files:
                    numpy.testing.assert_array_equal(columns[name], analysis[name])


class Statuses(unittest.TestCase):
    def test_are_words(self):
        sweep = '{"type": "sweep", "of": %s, "over": {"length": [1, 2]}}' % MOTION
        self.assertEqual(list(catena.loads(CRANK % sweep).run()["sweep"]["status"]), ["ok", "ok"])


class Errors(unittest.TestCase):
    def test_of_texts_name_the_place(self):
        with self.assertRaisesRegex(catena.SceneError, r"crank:2:\d+: error: .*revolut"):
            catena.loads('{"catena": 1, "bodies": {"b": {}},\n"constraints": [{"type": "revolut"}]}', "crank").run()

    def test_of_parameters(self):
        with self.assertRaisesRegex(catena.SceneError, "lenght"):
            catena.loads(CRANK % MOTION).run({"lenght": 1})
        with self.assertRaisesRegex(ValueError, "length"):
            catena.loads(CRANK % MOTION).run({"length": float("nan")})

    def test_of_files(self):
        with self.assertRaisesRegex(catena.SceneError, "no/such/scene.json"):
            catena.load("no/such/scene.json").run()

    def test_analyses_that_fail_say_so(self):
        text = (CRANK % '{"type": "kinematics", "until": 1}').split('"drivers"')[0]
        run = catena.loads(text + '"analyses": [{"type": "kinematics", "until": 1}]}').run()
        self.assertFalse(run.ok)
        self.assertEqual(run[0].status, "under_driven")
        self.assertIn("crank", run[0].message)

    def test_ctrl_c_ends_a_run(self):
        self.interrupt('{"type": "kinematics", "until": 1e5, "every": 0.001}')

    def test_ctrl_c_ends_an_optimisation(self):
        self.interrupt(
            '{"type": "optimise", "of": {"type": "kinematics", "until": 1e5, "every": 0.001,'
            ' "measures": {"end": {"final": "crank.tip.x"}}}, "variables": {"length": {"min": 1, "max": 2}},'
            ' "minimise": "end"}'
        )

    def interrupt(self, analysis):
        code = "import catena, sys; print('ready', flush=True); catena.loads(sys.argv[1]).run()"
        long = CRANK % analysis
        process = subprocess.Popen(
            [sys.executable, "-c", code, long], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        process.stdout.readline()
        try:
            process.wait(0.5)
        except subprocess.TimeoutExpired:
            pass
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)


if __name__ == "__main__":
    unittest.main()
