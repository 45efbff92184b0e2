"""Data frames, HTML of notebooks, plots and animations."""

import html.parser
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest

import numpy

import catena
from four_bar import FourBar

SCENES = os.path.join(os.environ["CATENA_DATA_DIR"], "scenes")


def needs(package):
    return unittest.skipUnless(importlib.util.find_spec(package), f"{package} is not installed")


def run_of_four_bar(**options):
    model = FourBar(4).model()
    model.analyse("kinematics", until=1, every=0.02, measures={"top": {"max": "coupler.pen.y"}},
                  outputs=["rocker.angle", "crank.angle", "coupler.pen.x", "coupler.pen.y", "crank.omega"])
    return model.run(**options)


class Checker(html.parser.HTMLParser):
    """Tags that are open; names of all."""

    def __init__(self):
        super().__init__()
        self.open, self.seen, self.text = [], [], ""

    def handle_starttag(self, tag, attributes):
        self.seen.append(tag)
        self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.seen.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.open)
        self.open.pop()

    def handle_data(self, data):
        self.text += data


def checked(text):
    checker = Checker()
    checker.feed(text)
    assert not checker.open, checker.open
    return checker


class Frames(unittest.TestCase):
    @needs("pandas")
    def test_have_columns_and_units(self):
        analysis = run_of_four_bar()[0]
        frame = analysis.to_pandas()
        self.assertEqual(list(frame.columns), analysis.columns)
        numpy.testing.assert_array_equal(frame["rocker.angle"], analysis["rocker.angle"])
        self.assertEqual(frame.attrs["units"]["coupler.pen.x"], "m")
        frame.loc[0, "t"] = 5  # a copy: the results stay
        self.assertEqual(analysis["t"][0], 0)

    @needs("pandas")
    def test_have_words_for_statuses(self):
        model = FourBar(4).model()
        model.analyse("sweep", of={"type": "kinematics", "measures": {"x": {"final": "coupler.pen.x"}}},
                      over={"b": [FourBar(4).b, 100]})
        frame = model.run()[0].to_pandas()
        self.assertEqual(list(frame["status"]), ["ok", "not_assembled"])

    @needs("pandas")
    def test_of_sweeps(self):
        bar = FourBar(4)
        model = bar.model()
        model.analyse("kinematics", measures={"x": {"final": "coupler.pen.x"}})
        frame = catena.sweep(model.scene(), {"b": [bar.b, 100]}).to_pandas()
        self.assertEqual(list(frame.columns), ["b", "x", "status"])
        self.assertEqual(list(frame["status"]), ["ok", "not_assembled"])


class Html(unittest.TestCase):
    def test_of_all_scenes_is_well_formed(self):
        for name in sorted(os.listdir(SCENES)):
            if not name.endswith(".json") or name == "linkage_100000.json":
                continue
            with self.subTest(name=name):
                page = checked(catena.load(os.path.join(SCENES, name))._repr_html_())
                self.assertIn("svg", page.seen)
                self.assertNotIn("script", page.seen)

    def test_of_results_shows_measures_and_rows(self):
        run = run_of_four_bar()
        page = checked(run._repr_html_())
        self.assertIn("top", page.text)
        self.assertIn("coupler.pen.x [m]", page.text)
        self.assertIn("…", page.text)
        self.assertEqual(page.seen.count("tr"), 2 + 12)

    def test_names_are_escaped(self):
        model = catena.Model("<b>", description="a & b")
        model.body("<i>")
        page = checked(model._repr_html_())
        self.assertNotIn("b", page.seen)
        self.assertIn("a & b", page.text)

    def test_of_a_wrong_scene_is_the_message(self):
        page = checked(catena.loads('{"catena": 1, "bodies": {"<a>": {"mas": 1}}}')._repr_html_())
        self.assertEqual(page.seen, ["pre"])
        self.assertIn('unknown key "mas"', page.text)


@needs("matplotlib")
class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        import matplotlib

        matplotlib.use("Agg")

    def tearDown(self):
        import matplotlib.pyplot

        matplotlib.pyplot.close("all")

    def test_have_a_panel_for_every_unit(self):
        analysis = run_of_four_bar()[0]
        figure = analysis.plot()
        self.assertEqual([len(axis.lines) for axis in figure.axes], [2, 2, 1])
        line = figure.axes[0].lines[0]
        numpy.testing.assert_array_equal(line.get_xdata(), analysis["t"])
        numpy.testing.assert_array_equal(line.get_ydata(), analysis["rocker.angle"])
        self.assertEqual(figure.axes[-1].get_xlabel(), "t [s]")
        self.assertEqual(figure.axes[-1].get_ylabel(), "crank.omega [rad/s]")

    def test_of_one_column_over_another(self):
        figure = run_of_four_bar()[0].plot("coupler.pen.y", x="coupler.pen.x")
        self.assertEqual(figure.axes[0].get_xlabel(), "coupler.pen.x [m]")

    def test_of_what_is_not_there(self):
        analysis = run_of_four_bar()[0]
        with self.assertRaisesRegex(KeyError, "pen.z"):
            analysis.plot("pen.z")
        model = FourBar(4).model()
        model.analyse("check")
        with self.assertRaisesRegex(ValueError, "no rows"):
            model.run()[0].plot()

    def test_animations_show_the_true_places(self):
        run = run_of_four_bar()
        film = catena._catena.film(*catena.Scene.source(run_scene(run)), "", 1, 11, ["coupler.pen"], 460.0)
        bar = FourBar(4)
        self.assertEqual(len(film), 11)
        numpy.testing.assert_allclose(film.times, numpy.linspace(0, 1, 11), rtol=0, atol=1e-12)
        left, right, low, high = film.extent
        for number, t in enumerate(film.times):
            corners = film.picture(number)[0]
            points = numpy.concatenate(corners)
            self.assertTrue((points[:, 0] > left).all() and (points[:, 0] < right).all())
            self.assertTrue((points[:, 1] > low).all() and (points[:, 1] < high).all())
            # The trace is drawn last: it begins and is where the pen is, and the coupler's pin is among the corners.
            pen = bar.pose(bar.speed * t)[2]
            trace = corners[-1]
            self.assertLess(numpy.hypot(*(trace - [pen.real, pen.imag]).T).min(), 1e-9)
            pin = bar.a * numpy.exp(1j * bar.speed * t)
            circles = [c for c in corners if len(c) == 73]
            centres = numpy.array([c[:-1].mean(axis=0) for c in circles])
            self.assertLess(numpy.hypot(*(centres - [pin.real, pin.imag]).T).min(), 1e-9)
        with self.assertRaisesRegex(IndexError, "no picture number 11"):
            film.picture(11)

    def test_animations_are_saved(self):
        animation = run_of_four_bar()[0].animate(pictures=5, traces=["coupler.pen"], speed=0.5)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "motion.gif")
            animation.save(path, writer="pillow")
            self.assertGreater(os.path.getsize(path), 1000)

    def test_animations_of_what_cannot_be(self):
        run = run_of_four_bar()
        for error, message, options in [
            (ValueError, "at least one picture", {"pictures": 0}),
            (ValueError, "speed", {"speed": 0}),
            (catena.FigureError, 'called "coupler.pne"; did you mean "coupler.pen"', {"traces": ["coupler.pne"]}),
        ]:
            with self.subTest(message=message), self.assertRaisesRegex(error, message):
                run[0].animate(**options)

    def test_matplotlib_and_pandas_are_imported_only_when_asked_for(self):
        code = "import catena, sys; sys.exit(bool({'matplotlib', 'pandas'} & set(sys.modules)))"
        subprocess.run([sys.executable, "-c", code], check=True)


def run_scene(run):
    """The scene that was run."""
    origin = run[0]._origin
    return catena.loads(origin.text, origin.path)


if __name__ == "__main__":
    unittest.main()
