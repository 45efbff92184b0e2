"""Models that are built in Python: classes of elements, checked keys, texts, runs."""

import json
import math
import os
import tempfile
import unittest

import numpy

import catena
from four_bar import FourBar, turned

SCHEMA = json.loads(catena._catena.schema())["$defs"]


def element_types(kind):
    return [one["properties"]["type"]["const"] for one in SCHEMA[kind]["anyOf"]]


class Classes(unittest.TestCase):
    def test_there_is_one_for_every_element(self):
        for kind in ("constraint", "force"):
            for element, schema in zip(element_types(kind), SCHEMA[kind]["anyOf"]):
                cls = getattr(catena, catena.elements.class_name(element))
                self.assertIn(cls.__name__, catena.__all__)
                self.assertEqual(cls.section, kind + "s")
                self.assertEqual(cls.can_be_driven, element in element_types("driver"))
                self.assertEqual(cls.__doc__, catena.explain(element))
                self.assertEqual({"type", *cls._keys}, set(schema["properties"]))
                self.assertEqual(list(cls.__signature__.parameters), list(cls._keys))

    def test_names_of_the_package_are_used_once(self):
        self.assertEqual(len(catena.__all__), len(set(catena.__all__)))

    def test_keys_are_checked(self):
        with self.assertRaisesRegex(TypeError, 'Revolute has no key "ii"; did you mean "i"'):
            catena.Revolute(ii="ground", j="a")
        with self.assertRaisesRegex(TypeError, "Revolute needs i"):
            catena.Revolute(j="a")
        for add in (catena.Model().add, catena.Model().drive):
            with self.assertRaisesRegex(TypeError, "3 is no constraint, driver or force"):
                add(3)
        pin = catena.Revolute(i="ground", j="a")
        with self.assertRaisesRegex(TypeError, "radius"):
            pin.radius = 1
        pin.name = "A"
        self.assertEqual(pin.to_dict(), {"type": "revolute", "name": "A", "i": "ground", "j": "a"})
        self.assertEqual(repr(pin), "Revolute(name='A', i='ground', j='a')")

    def test_every_example_of_the_library_can_be_built(self):
        for element in element_types("constraint") + element_types("force"):
            example = json.loads(catena.explain(element).rsplit("Example\n", 1)[1])
            kind = example.pop("type")
            made = getattr(catena, catena.elements.class_name(kind))(**example)
            self.assertEqual(made.to_dict(), {"type": kind, **example})


class Texts(unittest.TestCase):
    def test_what_is_wrong_is_told_where_it_is_written(self):
        model = catena.Model()
        with self.assertRaisesRegex(ValueError, 'body "a", mass: nan is not a finite number'):
            model.body("a", mass=math.nan)
        with self.assertRaisesRegex(ValueError, 'spring_damper "s", k: inf'):
            model.add(catena.SpringDamper(name="s", i="ground", j="a", k=numpy.inf))
        with self.assertRaisesRegex(TypeError, "cannot hold"):
            model.body("a", mass=object())
        with self.assertRaisesRegex(TypeError, 'Body has no key "mas"; did you mean "mass"'):
            model.body("a", mas=1)
        model.body("a")
        with self.assertRaisesRegex(ValueError, 'there is a body "a" already'):
            model.body("a")
        with self.assertRaisesRegex(TypeError, "Revolute cannot be a driver"):
            model.drive(catena.Revolute(i="ground", j="a"))
        with self.assertRaisesRegex(TypeError, "a driver needs a value"):
            model.drive(catena.AbsoluteAngle(i="a"))
        with self.assertRaisesRegex(TypeError, 'there is no analysis "kinematic"'):
            model.analyse("kinematic")
        with self.assertRaisesRegex(TypeError, 'the analysis kinematics has no key "untill"; did you mean "until"'):
            model.analyse("kinematics", untill=1)
        with self.assertRaisesRegex(TypeError, 'Model has no key "gravitation"; did you mean "gravity"'):
            catena.Model(gravitation=[0, -9.81])
        self.assertEqual(model.to_dict(), {"catena": 1, "name": "model", "bodies": {"a": {}}, "analyses": []})

    def test_what_the_library_finds_wrong_has_a_place_in_the_text(self):
        model = catena.Model("seesaw")
        model.body("a")
        model.add(catena.Revolute(i="ground", j="b"))
        model.analyse("check")
        with self.assertRaisesRegex(catena.SceneError, r'seesaw:\d+:\d+: error: .*"b"') as raised:
            model.run()
        place = raised.exception.diagnostics[0]
        self.assertEqual(place["file"], "seesaw")
        self.assertIn('"b"', model.text().splitlines()[place["line"] - 1])

    def test_numbers_of_numpy_are_numbers(self):
        model = catena.Model(gravity=numpy.array([0, -9.81]))
        model.body("a", mass=numpy.float64(2), position=numpy.array([1, 2]), points={"p": (numpy.int64(1), "=1+1")})
        self.assertEqual(model.to_dict()["bodies"]["a"], {"mass": 2, "position": [1, 2], "points": {"p": [1, "=1+1"]}})

    def test_underscores_stand_for_keys_that_python_has_no_name_for(self):
        model = catena.Model()
        model.analyse("assemble", from_="initial")
        self.assertEqual(model.to_dict()["analyses"], [{"type": "assemble", "from": "initial"}])

    def test_the_command_line_reads_them(self):
        model = FourBar(1).model()
        model.analyse("kinematics", until=1)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "four_bar.json")
            model.save(path)
            loaded, built = catena.load(path).run(), model.run()
        numpy.testing.assert_array_equal(loaded[0].table(), built[0].table())

    def test_blocks_are_repeated(self):
        model = catena.Model(gravity=[0, -10])
        links = model.repeat(3, first=1)
        links.body("link{k}", mass=1, inertia=0.01, position=["=k - 0.5", 0], points={"from": [-0.5, 0], "to": [0.5, 0]})
        links.add(catena.Revolute(name="pin{k}", i="link{k-1}.to", j="link{k}.from"))
        model.body("link0", fixed=True, points={"to": [0, 0]})
        model.analyse("equilibrium", outputs=["link3.to.y"])
        self.assertAlmostEqual(model.run()[0]["link3.to.y"][0], -3, 9)


class Runs(unittest.TestCase):
    def test_of_random_four_bars_are_those_of_the_closed_form(self):
        for seed in range(30):
            with self.subTest(seed=seed):
                bar = FourBar(seed)
                model = bar.model()
                model.analyse("kinematics", until=1, every=0.05,
                              outputs=["coupler.angle", "rocker.angle", "coupler.pen.x", "coupler.pen.y"])
                run = model.run()[0]
                self.assertEqual(run.status, "ok")
                for row, t in enumerate(run["t"]):
                    coupler, rocker, pen = bar.pose(bar.speed * t)
                    found = [run[name][row] for name in run.columns[1:]]
                    expected = [turned(coupler, found[0]), turned(rocker, found[1]), pen.real, pen.imag]
                    numpy.testing.assert_allclose(found, expected, rtol=0, atol=2e-11)


if __name__ == "__main__":
    unittest.main()
