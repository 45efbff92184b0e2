"""apps/python/pyproject.toml as scikit-build-core takes it: configured with its settings, its component installed as
the root of a wheel, and the package found there by an interpreter that knows nothing else of this tree. What the target
compiles is the module of the build under test, which stands in for it."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

import catena

PROJECT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "apps", "python")


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(os.path.join(PROJECT, "pyproject.toml"), "rb") as file:
            cls.project = tomllib.load(file)
        cls.settings = cls.project["tool"]["scikit-build"]
        cls.source = os.path.normpath(os.path.join(PROJECT, cls.settings["cmake"]["source-dir"]))
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.build, cls.root = os.path.join(folder.name, "build"), os.path.join(folder.name, "wheel")
        defined = cls.settings["cmake"]["define"] | {
            "CMAKE_BUILD_TYPE": cls.settings["cmake"]["build-type"],
            "Python_EXECUTABLE": sys.executable,
        }
        definitions = [f"-D{name}={value}" for name, value in defined.items()]
        cls.run_tool("cmake", "-S", cls.source, "-B", cls.build, "-G", "Ninja", *definitions)

    @classmethod
    def run_tool(cls, *command, **options):
        done = subprocess.run(command, capture_output=True, text=True, **options)
        if done.returncode != 0:
            raise AssertionError(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
        return done.stdout

    def test_version_is_that_of_the_project(self):
        metadata = self.project["tool"]["scikit-build"]["metadata"]["version"]
        with open(os.path.join(PROJECT, metadata["input"]), encoding="utf-8") as file:
            found = re.search(metadata["regex"], file.read(), re.MULTILINE)
        self.assertIsNotNone(found)
        self.assertIn(found["value"], self.run_tool(os.environ["CATENA_EXECUTABLE"], "--version").split())

    def test_targets_are_built_by_the_settings(self):
        targets = self.run_tool("ninja", "-C", self.build, "-t", "targets", "all")
        for target in self.settings["build"]["targets"]:
            self.assertRegex(targets, rf"(?m)^{target}: phony$")
        # The sources alone would be compiled, no tests and no command line.
        self.assertNotRegex(targets, r"(?m)^(catena_cli|catena_bench|design_test): phony$")

    def test_component_is_a_package(self):
        built = os.path.dirname(catena.__file__)
        made = os.path.join(self.build, "python", "catena")
        for name in os.listdir(built):
            if name.startswith("_catena") or name == "elements.pyi":
                shutil.copy(os.path.join(built, name), made)
        for component in self.settings["install"]["components"]:
            self.run_tool("cmake", "--install", self.build, "--prefix", self.root, "--component", component)
        self.assertEqual(os.listdir(self.root), ["catena"])
        files = set(os.listdir(os.path.join(self.root, "catena")))
        self.assertLessEqual({"__init__.py", "py.typed", "elements.pyi"}, files)
        code = (
            "import sys, catena; run = catena.load(sys.argv[1]).run(); print(catena.__file__); "
            "print(run.ok, len(run['kinematics']['t']) > 1)"
        )
        scene = os.path.join(os.environ["CATENA_DATA_DIR"], "scenes", "crank_rocker.json")
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | {"PYTHONPATH": self.root}
        told = self.run_tool(sys.executable, "-c", code, scene, env=environment, cwd=self.root).splitlines()
        self.assertEqual(os.path.dirname(told[0]), os.path.join(self.root, "catena"))
        self.assertEqual(told[1], "True True")


if __name__ == "__main__":
    unittest.main()
